/* Where a program's tasks ran and its objects live, against what its forks and hints say. */

#include "tests/runtime/random_run.h"

#include <stdlib.h>
#include <string.h>

static int writes(duite_mode mode)
{
    return mode == DUITE_W || mode == DUITE_RW || mode == DUITE_WP || mode == DUITE_RWP;
}

/* The rank on which a task must have run. */
static int owner(const struct run *run, const struct prog_op *op)
{
    const duite_kernel *kernel = &run->prog->kernel[op->kernel];

    if (op->rank >= 0)
        return op->rank;
    for (unsigned i = 0; i < op->n; i++)
        if (writes(prog_mode(kernel, i)))
            return run->home[op->objects[i]];
    for (unsigned i = 0; i < op->n; i++)
        if (prog_mode(kernel, i) == DUITE_R || prog_mode(kernel, i) == DUITE_RP)
            return run->home[op->objects[i]];
    return 0;
}

/* Returns whether a task ran so often; in checking mode a body that forks nothing runs twice. */
static int is_times(const struct run *run, int ran, int runs)
{
    return ran == runs || (run->check && ran >= runs && ran <= 2 * runs) ||
           (run->check && 2 * runs > 255);
}

/* A task ran where it should as often as it should; if it may be moved, so often on all ranks
 * together. Those of a replicated kernel run everywhere, or, in a graph, where the result is
 * read. */
static void check_place(struct run *run, const struct prog_op *op, int ran, int everywhere)
{
    const int runs = run->answers->runs[op->number];
    const int should = everywhere || owner(run, op) == run->main.rank ? runs : 0;

    if (everywhere && op->kind == PROG_GRAPH_FORK ? ran > 2 * should : !is_times(run, ran, should))
        prog_found(run, "task %u ran %d times here, expected %d", op->number, ran, should);
}

static void check_runs(struct run *run, const struct prog_op *op, int ran)
{
    const int runs = run->answers->runs[op->number];

    if (!is_times(run, ran, runs))
        prog_found(run, "task %u ran %d times, expected %d", op->number, ran, runs);
}

/* How often each task ran on all ranks, modulo 256. */
static unsigned char *count_runs(const struct run *run, const struct prog_context *context,
                                 MPI_Comm comm)
{
    const size_t n = run->prog->n_forks + 1;
    unsigned char *all = prog_memory(n, 1);

    for (size_t i = 0; i < n; i++)
        all[i] = atomic_load(&context->ran[i]);
    MPI_Allreduce(MPI_IN_PLACE, all, (int)n, MPI_UNSIGNED_CHAR, MPI_SUM, comm);
    return all;
}

/* Returns whether two objects that live together have other homes, as far as that is known. */
static int are_apart(const struct run *run, const struct prog_op *op)
{
    const int home = run->home[op->object], other = run->home[op->objects[0]];

    return home != other && !(run->moves && (home < 0 || other < 0));
}

/* Tasks of a graph whose objects were exchanged may run on several ranks. */
static int is_rebound(const struct run *run)
{
    int rebound = 0;

    for (size_t i = 0; i < run->prog->n_graphs; i++)
        rebound |= run->graph[i].rebound;
    return rebound && run->prog->n_ranks > 1;
}

void prog_check_places(struct run *run, const struct prog_context *context,
                       const struct prog_setup *setup)
{
    const struct prog *prog = run->prog;
    const int moves = run->moves || strcmp(setup->balance, "none") != 0;
    unsigned char *all = count_runs(run, context, setup->comm);

    for (run->at = 0; run->at < prog->n_ops; run->at++) {
        const struct prog_op *op = &prog->ops[run->at];
        const int everywhere = prog->kernel[op->kernel].replicated;

        if (op->kind == PROG_FOLLOW && are_apart(run, op))
            prog_found(run, "object %u does not live with %u", op->object, op->objects[0]);
        if (!prog_is_fork(op))
            continue;
        if (moves && !everywhere && op->rank < 0)
            check_runs(run, op, all[op->number]);
        else if (op->kind == PROG_FORK || !is_rebound(run))
            check_place(run, op, atomic_load(&context->ran[op->number]), everywhere);
    }
    run->at = prog->n_ops;
    for (size_t i = 0; i < prog->n_inner; i++)
        if (prog->inner[i].kind == PROG_FORK)
            check_runs(run, &prog->inner[i], all[prog->inner[i].number]);
    free(all);
}
