/* Where a program's tasks ran and its objects live, against what its forks and hints say. */

#include "tests/runtime/random_run.h"

#include <stdlib.h>
#include <string.h>

/* The rank on which a task must have run. */
static int owner(const struct run *run, const struct prog_op *op)
{
    const duite_kernel *kernel = &run->prog->kernel[op->kernel];

    if (op->rank >= 0)
        return op->rank;
    for (unsigned i = 0; i < op->n; i++)
        if (prog_mode(kernel, i) == DUITE_W || prog_mode(kernel, i) == DUITE_RW)
            return run->home[op->objects[i]];
    for (unsigned i = 0; i < op->n; i++)
        if (prog_mode(kernel, i) == DUITE_R)
            return run->home[op->objects[i]];
    return 0;
}

/* A task ran once where it should, or, if it may be moved (`all` is not NULL), once on all ranks
 * together. A replicated kernel's runs everywhere, or, in a graph, where its result is read. */
static void check_place(struct run *run, const struct prog_op *op, int ran,
                        const unsigned char *all)
{
    const int runs = run->answers->runs[op->number];
    const int everywhere = run->prog->kernel[op->kernel].replicated;
    const int should = everywhere || owner(run, op) == run->rank ? runs : 0;

    if (all && !everywhere && op->rank < 0) {
        if (all[op->number] != runs)
            prog_found(run, "task %u ran %d times, expected %d", op->number, all[op->number], runs);
        return;
    }
    if (everywhere && op->kind == PROG_GRAPH_FORK ? ran > should : ran != should)
        prog_found(run, "task %u ran %d times here, expected %d", op->number, ran, should);
}

/* How often each task ran on all ranks, modulo 256; NULL without memory. */
static unsigned char *count_runs(const struct run *run, const struct prog_context *context,
                                 MPI_Comm comm)
{
    const size_t n = run->prog->n_forks + 1;
    unsigned char *here = malloc(2 * n);

    for (size_t i = 0; i < n && here; i++)
        here[i] = atomic_load(&context->ran[i]);
    if (here)
        MPI_Allreduce(here, here + n, (int)n, MPI_UNSIGNED_CHAR, MPI_SUM, comm);
    if (here)
        memmove(here, here + n, n);
    return here;
}

/* Whether two objects that live together have other homes, as far as that is known. */
static int are_apart(const struct run *run, const struct prog_op *op)
{
    const int home = run->home[op->object], other = run->home[op->objects[0]];

    return home != other && !(run->moves && (home < 0 || other < 0));
}

void prog_check_places(struct run *run, const struct prog_context *context,
                       const struct prog_setup *setup)
{
    const int moves = run->moves || strcmp(setup->balance, "none") != 0;
    unsigned char *all = moves ? count_runs(run, context, setup->comm) : NULL;
    int rebound = 0; /* then its tasks may run on several ranks */

    for (size_t i = 0; i < run->prog->n_graphs; i++)
        rebound |= run->graph[i].rebound;
    for (size_t i = 0; i < run->prog->n_ops; i++) {
        const struct prog_op *op = &run->prog->ops[i];

        run->at = i;
        if (op->kind == PROG_FOLLOW && are_apart(run, op))
            prog_found(run, "object %u does not live with %u", op->object, op->objects[0]);
        if (op->kind != PROG_FORK && op->kind != PROG_GRAPH_FORK)
            continue;
        if (op->kind == PROG_GRAPH_FORK && run->prog->n_ranks > 1 && rebound)
            continue;
        check_place(run, op, atomic_load(&context->ran[op->number]), all);
    }
    free(all);
}
