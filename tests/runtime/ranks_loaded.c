/* Two ranks that answer each other in a replay, beside loops that never end on the same two cores:
 * a rank that waits must not give its core away again and again. The time in which sched_yield did
 * is at most a part of the whole: the runtime means to lose a hundredth so, and lost most of it
 * when it always yielded. Run under mpirun. */
#include "tests/support/kernel.h"
#include "tests/support/rank.h"
#include "tests/support/ranks.h"

#include <duite.h>
#include <sched.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

enum { CORES = 2, LOOPS = 8, ROUNDS = 400, WORK = 50000 };

/* A part of the time. */
#define MOST_GIVEN 0.25

static pid_t loop[LOOPS];
static double given; /* s */
static int counts;

static long switches(void)
{
    struct rusage usage;

    return getrusage(RUSAGE_THREAD, &usage) ? 0 : usage.ru_nivcsw;
}

static double now(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Instead of the C library's: adds up the calls in which another program got the core. */
int sched_yield(void)
{
    if (!counts)
        return (int)syscall(SYS_sched_yield);
    const long before = switches();
    const double began = now();
    const int code = (int)syscall(SYS_sched_yield);

    if (switches() > before)
        given += now() - began;
    return code;
}

/* This process, and the loops that it starts, use two cores only. */
static int share_cores(void)
{
    cpu_set_t all, some;
    int n = 0;

    CPU_ZERO(&some);
    if (sched_getaffinity(0, sizeof all, &all))
        return 0;
    for (size_t core = 0; core < CPU_SETSIZE && n < CORES; core++)
        if (CPU_ISSET(core, &all)) {
            CPU_SET(core, &some);
            n++;
        }
    return n == CORES && !sched_setaffinity(0, sizeof some, &some);
}

static int start_loops(void)
{
    const pid_t parent = getpid();

    for (int i = 0; i < LOOPS; i++) {
        loop[i] = fork();
        if (loop[i] < 0)
            return 0;
        if (loop[i])
            continue;
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent)
            _exit(0);
        for (volatile int on = 1; on;)
            ;
        _exit(0);
    }
    return 1;
}

static void end_loops(void)
{
    for (int i = 0; i < LOOPS; i++)
        if (loop[i] > 0)
            kill(loop[i], SIGKILL);
}

/* Takes some 100 us, so that the rounds take many slices of the loops. */
KERNEL(NEXT, "next", .access = {DUITE_W, DUITE_R})
{
    for (volatile int i = 0; i < WORK; i++)
        ;
    duite_out(call, 0, int32_t)[0] = 1 + duite_in(call, 1, int32_t)[0];
    return 0;
}

/* There and back. */
static int answer(duite *rt, void *context)
{
    const duite_object *object = context;
    int code = duite_fork_at(rt, 1, &NEXT, NULL, 2, (duite_object[]){object[1], object[0]});

    return code | duite_fork_at(rt, 0, &NEXT, NULL, 2, (duite_object[]){object[0], object[1]});
}

static int run(duite *rt, double *seconds)
{
    duite_object object[2];
    duite_graph graph;
    int32_t value = 0;
    int code = duite_new(rt, DUITE_I32, 1, &object[0]) | duite_new(rt, DUITE_I32, 1, &object[1]);

    code |= duite_graph_new(rt, answer, object, &graph);
    code |= duite_replay(rt, graph, 1) | duite_wait(rt);
    counts = 1;
    *seconds = now();
    code |= duite_replay(rt, graph, ROUNDS) | duite_wait(rt);
    *seconds = now() - *seconds;
    counts = 0;
    code |= duite_get(rt, object[0], &value) || value != 2 * (ROUNDS + 1);
    code |= duite_graph_free(rt, graph);
    return code | duite_free(rt, object[0]) | duite_free(rt, object[1]);
}

RANKS_CASE(loaded)
{
    static const duite_kernel *const KERNELS[] = {&NEXT, NULL};
    const char *rank = rank_said();
    duite_options options = duite_options_default();
    duite *rt;

    if (!share_cores()) {
        fprintf(stderr, "fewer than %d cores\n", CORES);
        return 77;
    }
    options.kernels = KERNELS;
    options.threads = 1;
    if (duite_start(&rt, &options)) {
        fprintf(stderr, "%s\n", duite_message());
        return 3;
    }
    const int loaded = !rank || *rank != '0' || start_loops();
    double seconds;
    const int code = run(rt, &seconds);
    end_loops();
    fprintf(stderr, "# rank %d gave its core away for %.3f s of %.3f s\n", duite_rank(rt), given,
            seconds);
    const int stopped = duite_stop(&rt);
    return !loaded || code || stopped || given > MOST_GIVEN * seconds;
}
