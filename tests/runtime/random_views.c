/* Views in random programs: which elements they name, and how they are made. */

#include "tests/runtime/random_make.h"

#include <stdlib.h>
#include <string.h>

void prog_indices(const struct prog *prog, const struct prog_op *op, size_t *indices)
{
    const size_t count = prog->objects[op->objects[0]].count;
    uint64_t random = op->seed;

    for (size_t i = 0; i < op->count; i++)
        indices[i] = op->seed % 4 ? duite_random(&random) % count : i % count;
}

int prog_make_view(duite *rt, const struct prog *prog, const struct prog_op *op,
                   duite_object parent, duite_object *view)
{
    size_t *indices = calloc(op->count, sizeof *indices);

    if (!indices)
        return DUITE_E_MEMORY;
    prog_indices(prog, op, indices);
    const int code = duite_view(rt, parent, op->count, indices, view);

    memset(indices, 0xee, op->count * sizeof *indices); /* the runtime has its copy */
    free(indices);
    return code;
}

int prog_is_view(const struct prog *prog, unsigned object)
{
    return prog->objects[object].parent >= 0;
}

void make_view(struct maker *m)
{
    struct prog *prog = m->prog;
    const unsigned parent = make_draw_object(m);
    const struct prog_object of = prog->objects[parent];

    if (of.max || prog_is_view(prog, parent) || m->n_live == MAX_LIVE ||
        prog->n_objects == MAX_MADE)
        return;
    struct prog_op *op = make_push(m, PROG_VIEW, (unsigned)prog->n_objects);

    op->objects[0] = parent;
    op->n = 1;
    op->count = make_one_in(m, 4) ? of.count : 1 + make_below(m, 40);
    prog->objects[prog->n_objects] = (struct prog_object){
        .type = of.type, .count = op->count, .leader = -1, .parent = (int)parent};
    m->live[m->n_live++] = (unsigned)prog->n_objects++;
}
