/* Programs that stand still for a while, on any number of ranks: the task that all wait for sleeps,
 * or what comes from other ranks is held up on the last one. Messages go to standard error. */
#include "tests/support/kernel.h"
#include "tests/support/ranks.h"

#include <duite.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static _Atomic double held_until;

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Instead of MPI's own: what was sent is not seen yet. */
int MPI_Improbe(int source, int tag, MPI_Comm comm, int *flag, MPI_Message *message,
                MPI_Status *status)
{
    *flag = 0;
    return seconds() < held_until ? MPI_SUCCESS
                                  : PMPI_Improbe(source, tag, comm, flag, message, status);
}

KERNEL(NAP, "nap", .access = {DUITE_W, DUITE_R}, .args_size = sizeof(double))
{
    const double length = *(const double *)call->args;
    struct timespec left = {(time_t)length, (long)(1e9 * (length - (double)(time_t)length))};

    while (nanosleep(&left, &left))
        ;
    duite_out(call, 0, int32_t)[0] = 1 + duite_in(call, 1, int32_t)[0];
    return 0;
}

KERNEL(TAKE, "take", .access = {DUITE_W, DUITE_R})
{
    duite_out(call, 0, int32_t)[0] = 10 * duite_in(call, 1, int32_t)[0];
    return 0;
}

KERNEL(OVER, "over", .access = {DUITE_W})
{
    duite_out(call, 0, int32_t)[0] = 7;
    return 0;
}

struct program {
    duite_object object[4];
    double nap;
};

/* Task 1 makes object 1 and reads 4; 2 and 3 read 1, on the last rank and the first; 4 overwrites
 * 4. */
static int fork_all(duite *rt, void *context)
{
    const struct program *program = context;
    const duite_object *object = program->object;
    const int last = duite_ranks(rt) - 1;
    int code = 0;

    code |= duite_fork_at(rt, 0, &NAP, &program->nap, 2, (duite_object[]){object[0], object[3]});
    code |= duite_fork_at(rt, last, &TAKE, NULL, 2, (duite_object[]){object[1], object[0]});
    code |= duite_fork_at(rt, 0, &TAKE, NULL, 2, (duite_object[]){object[2], object[0]});
    return code | duite_fork_at(rt, 0, &OVER, NULL, 1, &object[3]);
}

static int replay(duite *rt, struct program *program)
{
    duite_graph graph;
    int code = duite_graph_new(rt, fork_all, program, &graph);

    code |= duite_replay(rt, graph, 1);
    code |= duite_wait(rt);
    return code | duite_graph_free(rt, graph);
}

static int run(duite *rt, double length, const char *wait)
{
    struct program program = {.nap = length};
    int32_t value = 0;
    int code = 0;

    for (int i = 0; i < 4; i++)
        code |= duite_new(rt, DUITE_I32, 1, &program.object[i]);
    code |= strcmp(wait, "replay") ? fork_all(rt, &program) : replay(rt, &program);
    if (!strcmp(wait, "get"))
        code |= duite_get(rt, program.object[1], &value) || value != 10;
    else if (!strcmp(wait, "wait"))
        code |= duite_wait(rt);
    for (int i = 0; i < 4; i++)
        code |= duite_free(rt, program.object[i]);
    return code;
}

/* ranks_stuck THREADS WINDOW NAP HELD get|wait|stop|replay: seconds that the first task naps, and
 * that messages are held up. */
RANKS_CASE(stuck)
{
    static const duite_kernel *const KERNELS[] = {&NAP, &TAKE, &OVER, NULL};
    duite_options options = duite_options_default();
    duite *rt;

    if (argc < 6)
        return 2;
    options.kernels = KERNELS;
    options.threads = (unsigned)atoi(argv[1]);
    options.window = (size_t)atoi(argv[2]);
    if (duite_start(&rt, &options)) {
        fprintf(stderr, "%s\n", duite_message());
        return 3;
    }
    if (duite_rank(rt) == duite_ranks(rt) - 1)
        held_until = seconds() + atof(argv[4]);
    int code = run(rt, atof(argv[3]), argv[5]);

    code |= duite_stop(&rt);
    return code ? 1 : 0;
}
