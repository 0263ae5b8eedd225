/* All that a runtime does by itself can be switched off (docs/embedding.md): then a process has the
 * threads, the binding and the signal handlers that it had. Run under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <dirent.h>
#include <sched.h>
#include <signal.h>
#include <stdint.h>
#include <string.h>

/* The process as a program sees it. */
struct itself {
    int threads;
    cpu_set_t binding;
    struct sigaction segv;
};

static struct itself look(void)
{
    struct itself seen;
    DIR *tasks = opendir("/proc/self/task");

    memset(&seen, 0, sizeof seen);
    while (tasks && readdir(tasks))
        seen.threads++;
    if (tasks)
        closedir(tasks);
    sched_getaffinity(0, sizeof seen.binding, &seen.binding);
    sigaction(SIGSEGV, NULL, &seen.segv);
    return seen;
}

static int is_same(const struct itself *a, const struct itself *b)
{
    return a->threads == b->threads && !memcmp(&a->binding, &b->binding, sizeof a->binding) &&
           a->segv.sa_handler == b->segv.sa_handler;
}

/* Starts, runs a task, stops; what is seen in between goes to *during. */
static int run(const duite_options *options, struct itself *during)
{
    int32_t value = 0;
    duite *rt = misuse_start_with(options);

    if (!rt)
        return 0;
    const duite_object object = misuse_new(rt, 1);
    int code = DUITE_FORK(rt, &SET, DUITE_ARGS(int32_t, 5), object);
    code |= duite_get(rt, object, &value);
    *during = look();
    code |= duite_free(rt, object);
    return !(code | duite_stop(&rt)) && value == 5;
}

RANKS_CASE(itself)
{
    struct itself during, after;

    misuse_mpi();
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.threads = 1;
    options.bind = 0;
    options.stuck_seconds = options.lost_seconds = 0;
    run(&options, &during); /* whatever MPI begins with its first messages */
    const struct itself before = look();
    tap_case(run(&options, &during) && is_same(&before, &during), "nothing by itself");
    options.threads = 3;
    options.stuck_seconds = 60;
    const int right = run(&options, &during);
    after = look();
    tap_case(right && during.threads == before.threads + 3, "two workers and the monitor");
    tap_case(is_same(&before, &after), "which go with the runtime");
    return tap_done();
}
