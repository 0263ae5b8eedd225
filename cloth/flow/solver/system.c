/* The system of an implicit step, block by block: the right side b = h (f - h K v) and the matrix
 * (Baraff & Witkin 1998, equation 16). Elements and springs are computed once for both. In half
 * storage each worker sums entries up in room of its own, which stays in its cache. */
#include "cloth/flow/state/bodies.h"

#include "cloth/physics/particle.h"
#include "cloth/solve/assemble.h"

#include <string.h>

/* The making of a system in a body. */
struct making {
    const duite_call *call;
    const struct flow_table *t;
    const struct flow_step_args *step;
    double push;
    struct flow_view view;  /* without v: the matrix alone */
    phys_vec *b;            /* NULL: the matrix alone */
    void *values;           /* of the entries */
    struct phys_pair *sums; /* NULL: springs are the entries */
};

/* Writes the diagonal of the matrix and an open filter, which the step's filter replaces
 * (flow_contact_constrain). Returns the place of the values. */
static void *begin_matrix(const duite_call *call, const struct flow_table *t,
                          const struct flow_step_args *step, phys_vec *matrix)
{
    double *diagonal = (double *)matrix;
    phys_vec *value = matrix + flow_diagonal_rows(t);
    const bool filtered = model_is_filtered(flow_of(call)->model);
    for (uint32_t a = 0; a < t->n; a++)
        diagonal[a] = t->mass[a] + step->h * t->drag[a];
    flow_soft_diagonal(call, t, step, diagonal);
    for (size_t a = t->n; a < 4 * flow_diagonal_rows(t); a++)
        diagonal[a] = 0;
    for (size_t a = 0; filtered && a < t->n; a++)
        value[a] = (phys_vec){0, 0, 0, 1};
    return filtered ? value + t->n : value;
}

/* ---- Springs ---- */

/* Puts springs of a block, all or some, into values. s: the neighbour that they lead to;
 * UINT32_MAX: inner ones. */
static void some_springs(const struct making *m, const struct phys_springs *springs, uint32_t s,
                         phys_vec *value)
{
    const bool inner = s == UINT32_MAX;
    const phys_vec *x = m->view.x, *x_other = inner ? x : flow_rows_of(m->view.halo_x, s);
    if (!m->b)
        phys_springs_matrix(springs, m->step->h, x, x_other, value);
    else
        phys_springs_system(springs, m->step->h, m->push, x, m->view.v, inner ? NULL : x_other,
                            inner ? NULL : flow_rows_of(m->view.halo_v, s), m->b, value);
}

/* Springs from .. to - 1; in half storage so many at once that they stay in the nearest cache. */
static void springs_from(const struct making *m, uint32_t from, uint32_t to, uint32_t s)
{
    enum { AT_ONCE = 64 };
    phys_vec room[AT_ONCE];
    while (from < to) {
        const uint32_t n = m->sums && to - from > AT_ONCE ? AT_ONCE : to - from;
        struct phys_springs springs = flow_table_springs(m->t, from, from + n);
        springs.full = flow_of(m->call)->model->full_slope;
        some_springs(m, &springs, s, m->sums ? room : (phys_vec *)m->values + from);
        if (m->sums)
            solve_assemble_springs(n, m->t->at + from, room, m->sums);
        from += n;
    }
}

static void all_springs(const struct making *m)
{
    const struct flow_table *t = m->t;
    if (!t->n_stiff && m->sums)
        return;
    springs_from(m, 0, t->n_inner, UINT32_MAX);
    for (uint32_t s = 0; s < t->n_neighbours; s++)
        springs_from(m, t->n_inner + t->cut[s], t->n_inner + t->cut[s + 1], s);
}

/* ---- Both ---- */

/* Begins b with the forces that do not come with the matrix, unless b has them: loads, drag,
 * soft pins, and element kinds without a system. */
static void begin_right_side(const struct making *m, const struct phys_sight *sight)
{
    const struct flow_table *t = m->t;
    if (m->push > 0) {
        phys_outside(t->n, t->load, t->drag, m->view.v, m->b);
        flow_varying_add(m->call, t, m->step->now, m->b);
        flow_soft_force(m->call, t, m->step, m->view.x, m->view.v, m->b);
        if (sight->x)
            flow_elements_force(m->call, t, m->step->now, true, sight, m->b);
    }
    for (uint32_t i = 0; i < t->n; i++)
        m->b[i] = m->step->h * m->b[i];
    if (sight->x)
        flow_elements_stiffness(m->call, t, m->step->h * m->step->h, sight, m->b);
    flow_soft_stiffness(m->call, t, m->step, m->view.v, m->b);
}

/* Makes the values from the sums. The object also has room for double entries: zeros. */
static void end_matrix(const struct making *m, const struct solve_cut *cut)
{
    const struct flow_table *t = m->t;
    const size_t entries = t->matrix.row[t->n] + cut->n;
    const size_t n = solve_format_doubles(t->format, entries);
    double *value = m->values;
    solve_assembled(entries, m->sums, value);
    memset(value + n, 0, (4 * flow_value_rows(t) - n) * sizeof *value);
}

static void gather_ties(const struct making *m)
{
    const struct flow_ties ties = flow_ties_open(m->view.tie_table);
    flow_ties_gather(&ties, (phys_vec *)m->values + flow_value_rows(m->t));
}

static void make_block(const struct making *m)
{
    const struct flow_table *t = m->t;
    const struct solve_cut cut = flow_table_cut_entries(t);
    struct phys_sight sight = {0};
    if (flow_has_elements(t))
        sight = flow_elements_see(m->call, t, &m->view);
    if (m->sums)
        memset(m->sums, 0, (t->matrix.row[t->n] + cut.n) * sizeof *m->sums);
    if (m->b)
        begin_right_side(m, &sight);
    if (sight.x)
        flow_elements_assemble(m->call, t, m->step->h, m->push, &sight, m->b, m->sums);
    all_springs(m);
    if (m->view.tie_table)
        flow_ties_system(flow_of(m->call), &m->view, m->step->h, m->push, m->b,
                         (phys_vec *)m->values + flow_value_rows(m->t));
    if (m->view.contact_rows)
        flow_contact_system(flow_of(m->call), &m->view, m->step->h, m->push, m->b,
                            (phys_vec *)m->values + flow_value_rows(m->t));
    if (m->view.tie_table)
        gather_ties(m);
    if (m->sums)
        end_matrix(m, &cut);
}

/* The room of the worker that runs a body. */
static struct phys_pair *sums_of(const duite_call *call, const struct flow_table *t)
{
    const struct flow *flow = flow_of(call);
    return t->format == SOLVE_SPRINGS ? NULL : flow->sums + call->worker * flow->n_sums;
}

/* push: h, or 0 if b has the forces. b: NULL, and push 0: the matrix alone. */
static void make_system(const duite_call *call, const struct flow_table *t,
                        const struct flow_step_args *step, double push,
                        const struct flow_view *view, phys_vec *b, phys_vec *matrix)
{
    const struct making making = {.call = call,
                                  .t = t,
                                  .step = step,
                                  .push = push,
                                  .view = *view,
                                  .b = b,
                                  .values = begin_matrix(call, t, step, matrix),
                                  .sums = sums_of(call, t)};
    make_block(&making);
}

FLOW_KERNEL(system, FLOW_MATRIX, struct flow_step_args,
            (R(table), R(x), R(v), W(f), W(a), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v),
             IF_MADE(tie_table), IF_MADE(contact_rows), TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    make_system(call, &table, on->args, on->args->h, &view, on->f, on->a);
    return 0;
}

/* The system, if f has the forces. */
FLOW_KERNEL(system_of_forces, FLOW_MATRIX, struct flow_step_args,
            (R(table), R(x), R(v), RW(f), W(a), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v),
             IF_MADE(tie_table), IF_MADE(contact_rows), TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    make_system(call, &table, on->args, 0, &view, on->f, on->a);
    return 0;
}

/* The matrix alone. */
FLOW_KERNEL(matrix, FLOW_MATRIX, struct flow_step_args,
            (R(table), R(x), W(a), NEIGHBOURS(halo_x), IF_MADE(tie_table), IF_MADE(contact_rows),
             TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = {.x = on->x,
                                   .halo_x = on->halo_x,
                                   .tie_table = on->tie_table,
                                   .tie_halo = on->tied_tie_halo,
                                   .contact_rows = on->contact_rows};
    make_system(call, &table, on->args, 0, &view, NULL, on->a);
    return 0;
}
