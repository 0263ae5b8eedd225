/* The springs of contact in a state's system: those whose value the matrix has. One that is near
 * but does not press has a row, and the value zero. */
#include "bench/cg/cg.h"

#include "bench/tasks/tasks.h"
#include "cloth/flow/state/bodies.h"

#include <stdlib.h>

/* An object of any type, copied; freed by whom it is given to. */
static int copy_object(duite *rt, duite_object object, void **copy)
{
    enum { LINE = 64, LARGEST = 8 }; /* bytes: to which it is aligned; of an element */
    size_t n;
    *copy = NULL;
    int code = tasks_code(duite_get_count(rt, object, &n));
    if (!code)
        *copy = aligned_alloc(LINE, (LARGEST * n / LINE + 1) * LINE);
    if (!code && !*copy)
        code = serve_no_memory();
    return code ? code : tasks_code(duite_get(rt, object, *copy));
}

/* True if no corner of a tie is in a block before this one. */
static bool is_lowest(const struct flow_ties *ties, uint32_t block, uint32_t tie)
{
    bool lowest = true;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const uint32_t corner = ties->corner[tie][k];
        if (corner >= ties->n_rows)
            lowest = lowest && ties->other[ties->ghost_other[corner - ties->n_rows]] > block;
    }
    return lowest;
}

/* The springs of a block, each counted by its lowest block. */
static size_t count(const struct flow *flow, uint32_t block, const void *tie_table,
                    const phys_vec *matrix, const uint32_t *obstacle, bool self)
{
    const struct flow_table *t = flow->tables.block + block;
    const struct flow_ties ties = flow_ties_open(tie_table);
    const size_t filter = model_is_filtered(flow->model) ? t->n : 0;
    const phys_vec *value = flow_tie_values(t, matrix + flow_diagonal_rows(t) + filter);
    size_t n = 0;
    for (uint32_t i = 0; i < ties.n; i++) {
        const phys_vec one = value[i];
        const bool presses = phys_dot(&one, &one) + one[3] > 0;
        n += presses && is_lowest(&ties, block, i) && !(self && obstacle[i]);
    }
    return n;
}

static int count_block(struct cg_session *s, uint32_t block, bool self, double *all)
{
    const struct flow_objects *of = s->run.block + block;
    void *table = NULL, *matrix = NULL, *obstacle = NULL;
    int code = copy_object(s->rt, of->tie_table, &table);
    if (!code)
        code = copy_object(s->rt, of->a, &matrix);
    if (!code)
        code = copy_object(s->rt, of->contact_obstacles, &obstacle);
    if (!code)
        *all += (double)count(s->flow, block, table, matrix, obstacle, self);
    free(table);
    free(matrix);
    free(obstacle);
    return code;
}

int cg_touch(void *context, struct serve_request *request, double *value)
{
    struct cg_session *s = context;
    const bool self = serve_number(request, "self") != 0;
    int code = cg_ready(s, request);
    if (!code && !model_promise(&s->plan.model).apart)
        return serve_fail("%s has no contacts", s->state.name);
    *value = 0;
    for (uint32_t b = 0; !code && b < s->flow->tables.n_blocks; b++)
        code = count_block(s, b, self, value);
    return code;
}
