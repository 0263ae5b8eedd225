/* Ranks that make different calls are told so by every call that blocks, even where one waits for
 * data that no other one thinks of sending; and ranks that are merely slow are not. */

#include "runtime/comm/internal.h"
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

static int answers_late;

/* The last rank has no core for a while when it is asked what it did. */
int MPI_Isend(const void *buffer, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
              MPI_Request *request)
{
    const struct data_packet *packet = buffer;
    if (answers_late && rank == ranks - 1 && tag == COMM_PACKETS && packet->kind == COMM_ANSWER)
        usleep(1500000);
    return PMPI_Isend(buffer, count, type, to, tag, comm, request);
}

/* Adds 1, slowly. */
KERNEL(SLOW, "slow", .access = {DUITE_RW})
{
    usleep(700000);
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

static const duite_kernel *const KERNELS[] = {&SET, &COPY, &ADD, &SLOW, NULL};

static duite *begin(void)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    return misuse_start_with(&options);
}

static int build(duite *rt, void *context)
{
    return duite_fork_at(rt, 0, &ADD, NULL, 1, context);
}

enum call { GET, GET_AT, COUNT, WAIT, COUNT_ALL, REPLAY_WHILE, STOP, N_CALLS, WAIT_FOR, TEST };

static int make(enum call call, duite **rt, duite_object object)
{
    int32_t value = 0;
    int there;
    size_t count;
    duite_counters counters;
    duite_graph graph;

    switch (call) {
    case GET:
        return duite_get(*rt, object, &value);
    case GET_AT:
        return duite_get_at(*rt, object, ranks - 1, &value);
    case COUNT:
        return duite_get_count(*rt, object, &count);
    case WAIT_FOR:
        return duite_wait_for(*rt, 1, &object);
    case TEST:
        return duite_test(*rt, 1, &object, &there);
    case WAIT:
        return duite_wait(*rt);
    case COUNT_ALL:
        return duite_count_all(*rt, &counters);
    case REPLAY_WHILE:
        duite_graph_new(*rt, build, &object, &graph);
        duite_replay_while(*rt, graph, object, 3);
        return duite_wait(*rt);
    default:
        return duite_stop(rt);
    }
}

/* Rank 0 forks a task more than the others, which writes where it did not live; then all make one
 * call, or the last rank another. */
static void differ(enum call call, enum call of_last, const char *name)
{
    duite *rt = begin();
    const duite_object object = misuse_new(rt, 1);
    const enum call mine = rank == ranks - 1 ? of_last : call;
    char line[120], text[120];
    int code = 0;

    duite_fork_at(rt, ranks - 1, &SET, &(int32_t){3}, 1, &object);
    if (call == of_last && rank == 0)
        duite_fork_at(rt, 0, &SET, &(int32_t){4}, 1, &object);
    if (call == GET && mine == WAIT)
        usleep(500000); /* what the others asked meanwhile is kept */
    for (int i = 0; i < 3 && !code && rt; i++)
        code = make(mine, &rt, object);
    if (!code && rt) /* a rank that always had what it asked for learns of it now */
        code = duite_wait(rt);
    misuse_keep_message();
    if (rt)
        duite_stop(&rt);
    snprintf(text, sizeof text,
             call == of_last ? "ranks differ at fork 2: rank 0 forked \"set\", "
                             : "ranks differ after fork 1: %s ",
             misuse_first_ranks(ranks - 1));
    snprintf(line, sizeof line, "%s: all ranks are told", name);
    tap_case(misuse_all_told(text) && code == DUITE_E_DIFFERENT && !rt, line);
}

/* Slow ranks are not blamed: questions are asked, and find nothing. */
static void slow(void)
{
    duite *rt = begin();
    const duite_object a = misuse_new(rt, 1), b = misuse_new(rt, 1);
    int32_t value = -1;
    int right = 1;

    for (int i = 0; i < 3; i++) {
        duite_fork_at(rt, i % ranks, &SLOW, NULL, 1, &a);
        right &= !duite_get_at(rt, b, (i + 1) % ranks, &value);
        right &= !duite_get(rt, a, &value) && value == i + 1;
    }
    duite_fork_at(rt, 0, &SLOW, NULL, 1, &b);
    if (rank == ranks - 1)
        usleep(500000); /* the others wait in a call that this rank has not come to */
    right &= !duite_get(rt, b, &value) && value == 1;
    tap_case(right, "slow ranks");
    duite_free(rt, a);
    duite_free(rt, b);
    tap_case(duite_stop(&rt) == DUITE_OK, "and nothing is left when they stop");
}

/* More calls than are logged. */
static void many(int differs)
{
    duite *rt = begin();
    const duite_object a = misuse_new(rt, 1);
    int32_t value = 0;
    int right = 1, code = 0;

    for (int i = 0; i < 2500; i++) {
        duite_fork_at(rt, i % 100 ? 0 : ranks - 1, &ADD, NULL, 1, &a);
        if (i % 50 == 0)
            right &= !duite_get(rt, a, &value) && value == i + 1;
        right &= !duite_get_at(rt, a, 0, &value);
    }
    tap_case(right, "many calls");
    if (differs && rank == 0)
        duite_fork_at(rt, 0, &SET, &(int32_t){3}, 1, &a);
    for (int i = 0; i < 2500 && differs && !code; i++)
        code = duite_get(rt, a, &value);
    if (differs)
        tap_case(code == DUITE_E_DIFFERENT, "that differ after many");
    duite_free(rt, a);
    code = duite_stop(&rt);
    tap_case(code == (differs ? DUITE_E_DIFFERENT : DUITE_OK), "and stop");
}

RANKS_CASE(blocking)
{
    static const char *const NAMES[] = {"get",       "get_at",       "get_count", "wait",
                                        "count_all", "replay_while", "stop"};
    char name[60];

    misuse_mpi();
    for (int call = 0; call < N_CALLS; call++)
        differ((enum call)call, (enum call)call, NAMES[call]);
    for (int call = 0; call < N_CALLS; call++)
        for (int other = 0; other < N_CALLS; other++) {
            if (call == other || (call >= WAIT && other >= WAIT && call + other == WAIT + STOP))
                continue; /* a stop begins with a wait */
            if ((call + other + ranks) % 2)
                continue; /* half of the pairs on 2 ranks, the others on 3 */
            snprintf(name, sizeof name, "%s, and %s on the last rank", NAMES[call], NAMES[other]);
            differ((enum call)call, (enum call)other, name);
        }
    differ(WAIT_FOR, WAIT_FOR, "wait_for");
    differ(TEST, TEST, "test");
    differ(WAIT_FOR, WAIT, "wait_for, and wait on the last rank");
    differ(TEST, WAIT_FOR, "test, and wait_for on the last rank");
    answers_late = 1;
    differ(GET, GET, "get, and the last rank answers late");
    answers_late = 0;
    slow();
    many(0);
    many(1);
    return tap_done();
}
