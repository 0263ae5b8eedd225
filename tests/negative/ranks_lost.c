/* A rank that is lost: rank 1 stops for good (SIGSTOP) while the others are in, or come to, a call
 * that blocks. Each rank that is left prints a line; then rank 0 ends the job by killing the
 * stopped one. Also ranks that are not lost: all workers of one are inside bodies for long, and one
 * rank is stopped for a while. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { LONG = 1 << 22 }; /* elements of the last object: sent when its reader asks for it */

static void nap(double seconds)
{
    struct timespec left = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
    while (nanosleep(&left, &left))
        ;
}

KERNEL(NAP, "nap", .access = {DUITE_RW}, .args_size = sizeof(double))
{
    nap(*(const double *)call->args);
    duite_out(call, 0, int32_t)[0]++;
    return 0;
}

/* Waits in vain for what its child reads. */
KERNEL(ASK, "ask", .access = {DUITE_RP, DUITE_WP})
{
    int32_t value;
    duite_fork(call->rt, &COPY, NULL, 2,
               (duite_object[]){call->param[0].object, call->param[1].object});
    return duite_get(call->rt, call->param[1].object, &value) ? 5 : 6;
}

/* With all that it forks it runs anywhere. */
KERNEL(TREE, "tree", .access = {DUITE_WP})
{
    return duite_fork(call->rt, &SET, &(int32_t){1}, 1, &call->param[0].object);
}

static duite *start(const char *how)
{
    static const duite_kernel *const LIST[] = {&NAP, &ASK, &TREE, &SET, &COPY, &ADD, &MANY, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = LIST;
    options.lost_seconds = rank                     ? 1e9
                           : strcmp(how, "stopped") ? 0.5
                                                    : 2; /* what rank 0 says counts */
    options.window = strcmp(how, "window") ? 0 : 2;
    if (!strcmp(how, "replay")) /* which waits for all ranks, to move objects */
        options.balance = duite_balancer_find("migrate");
    if (!strcmp(how, "subtree"))
        options.balance = duite_balancer_find("scatter");
    return misuse_start_with(&options);
}

/* The tasks of rank 1 never run. */
static int fork_all(duite *rt, const duite_object *object)
{
    int code = duite_fork_at(rt, 1, &SET, &(int32_t){7}, 1, &object[0]);
    for (int i = 0; i < 20 && !code; i++)
        code = duite_fork_at(rt, (i % 2) * (ranks - 1), &COPY, NULL, 2, object);
    return code;
}

/* Rank 1 does not take what it is sent, which is too long to be sent without it; a task of this
 * rank waits until the object is sent. */
static int wait_behind_a_send(duite *rt, const duite_object *object)
{
    int code = duite_fork_at(rt, 0, &SET, &(int32_t){7}, 1, object);
    if (!code)
        code = duite_fork_at(rt, 1, &MANY, NULL, 1, object);
    if (!code)
        code = duite_fork_at(rt, 0, &SET, &(int32_t){8}, 1, object);
    return code ? code : duite_wait(rt);
}

static int build_nothing(duite *rt, void *context)
{
    (void)rt;
    (void)context;
    return 0;
}

/* The second replay waits. */
static int replay_twice(duite *rt)
{
    duite_graph graph;
    int code = duite_graph_new(rt, build_nothing, NULL, &graph);
    for (int i = 0; i < 2 && !code; i++)
        code = duite_replay(rt, graph, 1);
    return code;
}

/* The code of the call that waits. */
static int wait_for_it(duite **rt, const char *how, const duite_object *object)
{
    int32_t value;
    duite_counters counters;
    if (!strcmp(how, "send"))
        return wait_behind_a_send(*rt, &object[2]);
    for (int i = 0; i < 20 && !strcmp(how, "subtree"); i++)
        duite_fork(*rt, &TREE, NULL, 1, &object[0]);
    int code = fork_all(*rt, object);
    if (code || !strcmp(how, "window"))
        return code ? code : duite_fork(*rt, &ADD, NULL, 1, &object[0]);
    if (!strcmp(how, "replay"))
        return replay_twice(*rt);
    if (!strcmp(how, "get"))
        return duite_get(*rt, object[0], &value);
    if (!strcmp(how, "count"))
        return duite_count_all(*rt, &counters);
    if (!strcmp(how, "stop"))
        return duite_stop(rt);
    if (!strcmp(how, "body"))
        duite_fork_at(*rt, 0, &ASK, NULL, 2, (duite_object[]){object[0], object[2]});
    return duite_wait(*rt);
}

/* All that is left to do, and that nothing else is. */
static int leave(duite **rt, const duite_object *object)
{
    char before[1000];
    int32_t value;
    snprintf(before, sizeof before, "%s", duite_message());
    if (!strstr(before, "rank 1 on host ") || !strstr(before, " is lost"))
        return 0;
    if (*rt &&
        (duite_wait(*rt) != DUITE_E_LOST || duite_get(*rt, object[0], &value) != DUITE_E_LOST ||
         duite_fork(*rt, &ADD, NULL, 1, &object[0]) != DUITE_E_LOST ||
         strcmp(before, duite_message()) || duite_abandon(rt)))
        return 0;
    return !*rt && duite_abandon(rt) == DUITE_E_ARGUMENT;
}

static void one_lost(duite *rt, const char *how, const duite_object *object, const int *process)
{
    if (rank == 1) {
        raise(SIGSTOP);
        return;
    }
    const int code = wait_for_it(&rt, how, object);
    char message[1000];
    snprintf(message, sizeof message, "%s", duite_message());
    const int right = code == DUITE_E_LOST && leave(&rt, object);
    printf("rank %d %s: %s: code %d, %s\n", rank, right ? "is right" : "is wrong", how, code,
           message);
    fflush(stdout);
    nap(2); /* the others end, too */
    if (rank == 0)
        kill(process[1], SIGKILL);
    nap(30); /* until mpirun ends the job */
}

/* Communication broke for another reason before rank 1 is lost; stop returns all the same. */
static void one_lost_later(duite *rt, const duite_object *object, const int *process)
{
    duite_fork(rt, &SET, &(int32_t){1}, 1, &object[rank == 0]);
    const int code = duite_wait(rt);
    if (rank == 1) {
        raise(SIGSTOP);
        return;
    }
    const int right = code == DUITE_E_DIFFERENT && duite_stop(&rt) == DUITE_E_DIFFERENT && !rt;
    printf("rank %d %s: later: code %d, %s\n", rank, right ? "is right" : "is wrong", code,
           duite_message());
    fflush(stdout);
    nap(2);
    if (rank == 0)
        kill(process[1], SIGKILL);
    nap(30);
}

/* Signs of life come from a rank whose workers all nap, and from one that is continued after a
 * while. */
static int none_lost(duite *rt, const char *how, const duite_object *object, const int *process)
{
    const double length = 1.5;
    if (!strcmp(how, "stopped") && rank == 0) {
        kill(process[1], SIGSTOP);
        nap(0.25);
        kill(process[1], SIGCONT);
    }
    for (int i = 0; i < 2 && !strcmp(how, "bodies"); i++)
        duite_fork_at(rt, 1, &NAP, &length, 1, &object[i]);
    const int early = duite_abandon(&rt) != DUITE_E_STATE;
    int32_t value = 0;
    int code = duite_get(rt, object[0], &value);
    if (!code)
        code = duite_wait(rt);
    if (code || early)
        printf("rank %d is wrong: %s: code %d, %s\n", rank, how, code, duite_message());
    for (int i = 0; i < 3; i++)
        duite_free(rt, object[i]);
    return duite_stop(&rt) || code || early;
}

/* ranks_lost get|send|later|subtree|wait|replay|count|stop|window|body|bodies|stopped, on 3 ranks
 */
RANKS_CASE(lost)
{
    const char *how = argc > 1 ? argv[1] : "";
    int process[3], own = getpid();
    duite_object object[3];
    misuse_mpi();
    if (ranks != 3)
        return 2;
    MPI_Allgather(&own, 1, MPI_INT, process, 1, MPI_INT, MPI_COMM_WORLD);
    duite *rt = start(how);
    if (!rt)
        return 2;
    for (int i = 0; i < 3; i++)
        object[i] = misuse_new(rt, i < 2 ? 1 : LONG);
    if (duite_wait(rt))
        return 2;
    if (!strcmp(how, "bodies") || !strcmp(how, "stopped"))
        return none_lost(rt, how, object, process);
    if (!strcmp(how, "later"))
        one_lost_later(rt, object, process);
    else
        one_lost(rt, how, object, process);
    return 1;
}
