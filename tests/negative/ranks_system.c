/* Refusals by the system and a program's policies: threads that cannot be started on one rank, and
 * mappings that fail or name a rank there is not. The linker puts the function below in place of
 * that of the C library (module.mk). */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <duite_policy.h>
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>

static int threads_left; /* until one is refused */
static int full;         /* there is no room for a stack either */

int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*body)(void *), void *context);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*body)(void *), void *context);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*body)(void *), void *context)
{
    return threads_left-- > 0 ? __real_pthread_create(thread, attributes, body, context) : EAGAIN;
}

void *__real_mmap(void *at, size_t bytes, int protection, int flags, int file, off_t offset);
void *__wrap_mmap(void *at, size_t bytes, int protection, int flags, int file, off_t offset);

void *__wrap_mmap(void *at, size_t bytes, int protection, int flags, int file, off_t offset)
{
    if (!full)
        return __real_mmap(at, bytes, protection, flags, file, offset);
    errno = ENOMEM;
    return MAP_FAILED;
}

/* All ranks are told that there is no memory, for what, and how much it would be. */
static void no_room_for_a_thread(void)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;

    options.threads = 4;
    full = rank == ranks - 1;
    for (int granted = 0; granted < 3; granted++) {
        threads_left = full ? granted : 1000;
        tap_case(duite_start(&rt, &options) == DUITE_E_MEMORY && !rt,
                 "memory for a thread is refused on the last rank");
        tap_case(strstr(duite_message(), "out of memory for ") &&
                     strstr(duite_message(), ": pthread_create cannot map its stack of ") &&
                     (full || strstr(duite_message(), "duite_start failed on rank ")),
                 "with a sentence on every rank");
    }
    full = 0;
}

static void threads_refused(void)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;

    options.threads = 4;
    for (int granted = 0; granted < 3; granted++) {
        threads_left = rank == ranks - 1 ? granted : 1000;
        const int code = duite_start(&rt, &options);
        const int expected = rank == ranks - 1 ? DUITE_E_SYSTEM : DUITE_E_DIFFERENT;

        tap_case(code == expected && !rt, "a thread is refused on the last rank");
        tap_case(strstr(duite_message(), "cannot start ") &&
                     strstr(duite_message(), ": pthread_create: "),
                 "with a sentence on every rank");
    }
    threads_left = 1000;
    tap_case(duite_start(&rt, &options) == DUITE_OK && duite_threads(rt) == 4, "then all start");
    tap_case(duite_stop(&rt) == DUITE_OK, "and stop");
}

static int answer;

/* Home number `answer` if it is >= 0, or the code -answer. */
static int map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)n_ranks;
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = answer;
    return answer < 0 ? -answer : 0;
}

/* Forks are refused while objects have no home, and only stop is left. */
static void wrong_mapping(int wrong, int code, const char *name)
{
    const duite_mapping mapping = {.size = sizeof(duite_mapping), .name = "wrong", .map = map};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    int32_t value = -1;
    duite *rt;

    options.mapping = &mapping;
    tap_case(duite_start(&rt, &options) == DUITE_OK, name);
    const duite_object object = misuse_new(rt, 1);

    answer = wrong;
    tap_case(duite_fork(rt, &ADD, NULL, 1, &object) == code, "a fork returns its code");
    tap_case(duite_set(rt, object, &value) == code && duite_home(rt, object) == -1, "others too");
    answer = 0;
    tap_case(duite_get(rt, object, &value) == code && value == -1, "and the next get");
    tap_case(duite_stop(&rt) == code && !rt, "stops, and says it once more");
}

RANKS_CASE(system)
{
    misuse_mpi();
    no_room_for_a_thread();
    threads_refused();
    if (ranks > 1) { /* one rank needs no mapping */
        wrong_mapping(ranks, DUITE_E_ARGUMENT, "a mapping to a rank there is not");
        wrong_mapping(-7, 7, "a mapping that fails");
    }
    return tap_done();
}
