/* Forces, matrix and energy of timed joints: of springs that are in no table of a block
 * (cloth/flow/joints/ties.h). A joint is a spring from the point of its corners with positive
 * weights to that of the others. All its blocks compute it in this direction, to the same bits. */
#include "cloth/flow/state/bodies.h"

#include "cloth/physics/spring.h"

/* A joint as a spring from point 0 to point 1; it points to itself. */
struct one_joint {
    struct phys_springs spring;
    phys_vec x[2], v[2];
};

/* Returns false if tie i is no joint. */
static bool see_joint(const struct flow *flow, const struct flow_ties *ties,
                      const struct flow_view *view, uint32_t i, struct one_joint *one)
{
    static const uint32_t end[1][2] = {{0, 0}};
    if (ties->of[i] >= flow->n_ties)
        return false;
    const struct flow_tie *joint = flow->tie + ties->of[i];
    one->spring = (struct phys_springs){
        1, end, &joint->stiffness, &joint->damping, &joint->length, flow->model->full_slope};
    for (int side = 0; side < 2; side++)
        one->x[side] = one->v[side] = (phys_vec){0};
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const double weight = ties->weight[i][k], share = weight < 0 ? -weight : weight;
        const int side = weight < 0;
        if (weight == 0)
            continue;
        one->x[side] += share * *flow_tie_x(ties, view, ties->corner[i][k]);
        if (view->v)
            one->v[side] += share * *flow_tie_v(ties, view, ties->corner[i][k]);
    }
    return true;
}

/* Adds a spring's effect on its first point to the rows of the block, by their weights. */
static void scatter(const struct flow_ties *ties, uint32_t i, const phys_vec *add, phys_vec *y)
{
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
        if (ties->weight[i][k] != 0 && ties->corner[i][k] < ties->n_rows)
            y[ties->corner[i][k]] += ties->weight[i][k] * *add;
}

void flow_ties_force(const struct flow *flow, const struct flow_view *view, phys_vec *f)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    for (uint32_t i = 0; i < ties.n; i++) {
        struct one_joint one;
        phys_vec add = {0};
        if (!see_joint(flow, &ties, view, i, &one))
            continue;
        phys_springs_force(&one.spring, one.x, one.v, one.x + 1, one.v + 1, &add);
        scatter(&ties, i, &add, f);
    }
}

void flow_ties_system(const struct flow *flow, const struct flow_view *view, double h, double push,
                      phys_vec *b, phys_vec *value)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    memset(value, 0, ties.room.ties * sizeof *value);
    for (uint32_t i = 0; i < ties.n; i++) {
        struct one_joint one;
        phys_vec add = {0};
        if (!see_joint(flow, &ties, view, i, &one))
            continue;
        if (b)
            phys_springs_system(&one.spring, h, push, one.x, one.v, one.x + 1, one.v + 1, &add,
                                value + i);
        else
            phys_springs_matrix(&one.spring, h, one.x, one.x + 1, value + i);
        if (b)
            scatter(&ties, i, &add, b);
    }
}

/* The part of a tie's corners that the block has. */
static double share_of(const struct flow_ties *ties, uint32_t i)
{
    double own = 0, all = 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        all += ties->weight[i][k] != 0;
        own += ties->weight[i][k] != 0 && ties->corner[i][k] < ties->n_rows;
    }
    return own / all;
}

double flow_ties_energy(const struct flow *flow, const struct flow_view *view)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    double sum = 0;
    for (uint32_t i = 0; i < ties.n; i++) {
        struct one_joint one;
        if (!see_joint(flow, &ties, view, i, &one))
            continue;
        sum += share_of(&ties, i) * phys_energy_springs(&one.spring, one.x, one.x + 1);
    }
    return sum;
}

/* dv of held rows is zero. All N dv of a tie between free rows cancel if the weights sum to
 * zero. */
void flow_ties_lost(const unsigned char *tie_table, const phys_vec *value, const phys_vec *dv,
                    double lost[3])
{
    const struct flow_ties ties = flow_ties_open(tie_table);
    for (uint32_t i = 0; i < ties.n; i++) {
        double free = 0;
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
            free += ties.held[i] >> k & 1 ? 0 : ties.weight[i][k];
        for (int k = 0; k < SOLVE_TIE_CORNERS && free != 0; k++) {
            const uint32_t row = ties.corner[i][k];
            phys_vec y;
            if (ties.weight[i][k] == 0 || row >= ties.n_rows || ties.held[i] >> k & 1)
                continue;
            solve_spring_times(value + i, dv + row, &y);
            for (int c = 0; c < 3; c++)
                lost[c] -= free * ties.weight[i][k] * y[c];
        }
    }
}
