/* Forces, matrix and energy of ties: of springs that are in no table of a block
 * (cloth/flow/state/ties.h). */
#include "cloth/flow/bodies.h"

#include "cloth/physics/energy.h"

/* x and v of the other ends of ties into the k-th other block. */
static const phys_vec *x_there(const struct flow_ties *ties, const struct flow_view *view,
                               uint32_t k)
{
    return flow_rows_of(view->tie_halo, k) + ties->place[k];
}

static const phys_vec *v_there(const struct flow_ties *ties, const struct flow_view *view,
                               uint32_t k)
{
    const size_t rows = view->tie_halo[k].count / 4;
    return x_there(ties, view, k) + rows / 2;
}

void flow_ties_force(const struct flow_view *view, phys_vec *f)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    const struct phys_springs inner = flow_ties_springs(&ties, 0, ties.n_inner);
    phys_springs_force(&inner, view->x, view->v, f);
    for (uint32_t k = 0; k < ties.n_others; k++) {
        const struct phys_springs into = flow_ties_into(&ties, k);
        phys_springs_force_cut(&into, view->x, view->v, x_there(&ties, view, k),
                               v_there(&ties, view, k), f);
    }
}

static void add_matrix(const struct flow_ties *ties, const struct flow_view *view, double h,
                       int full, phys_vec *value)
{
    struct phys_springs springs = flow_ties_springs(ties, 0, ties->n_inner);
    springs.full = full;
    phys_springs_matrix(&springs, h, view->x, view->x, value);
    for (uint32_t k = 0; k < ties->n_others; k++) {
        springs = flow_ties_into(ties, k);
        springs.full = full;
        phys_springs_matrix(&springs, h, view->x, x_there(ties, view, k),
                            value + ties->n_inner + ties->start[k]);
    }
}

static void add_system(const struct flow_ties *ties, const struct flow_view *view, double h,
                       double push, int full, phys_vec *b, phys_vec *value)
{
    struct phys_springs springs = flow_ties_springs(ties, 0, ties->n_inner);
    springs.full = full;
    phys_springs_system(&springs, h, push, view->x, view->v, b, value);
    for (uint32_t k = 0; k < ties->n_others; k++) {
        springs = flow_ties_into(ties, k);
        springs.full = full;
        phys_springs_system_cut(&springs, h, push, view->x, view->v, x_there(ties, view, k),
                                v_there(ties, view, k), b, value + ties->n_inner + ties->start[k]);
    }
}

void flow_ties_system(const struct flow_view *view, double h, double push, int full, phys_vec *b,
                      phys_vec *value)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    memset(value, 0, ties.room * sizeof *value);
    if (b)
        add_system(&ties, view, h, push, full, b, value);
    else
        add_matrix(&ties, view, h, full, value);
}

double flow_ties_energy(const struct flow_view *view)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    struct phys_springs springs = flow_ties_springs(&ties, 0, ties.n_inner);
    double sum = phys_energy_springs(&springs, view->x, view->x);
    for (uint32_t k = 0; k < ties.n_others; k++) {
        springs = flow_ties_into(&ties, k);
        sum += 0.5 * phys_energy_springs(&springs, view->x, x_there(&ties, view, k));
    }
    return sum;
}

/* dv of what is held is zero. Of a tie between free rows the two N dv cancel. */
void flow_ties_lost(const unsigned char *tie_table, const phys_vec *value, const phys_vec *dv,
                    double lost[3])
{
    const struct flow_ties ties = flow_ties_open(tie_table);
    for (uint32_t i = 0; i < ties.n; i++) {
        const int here = i < ties.n_inner && ties.held[i] == 1; /* the end that is free */
        phys_vec y;
        if (ties.held[i] != 2 && !here)
            continue;
        solve_spring_times(value + i, dv + ties.end[i][here], &y);
        for (int c = 0; c < 3; c++)
            lost[c] -= y[c];
    }
}
