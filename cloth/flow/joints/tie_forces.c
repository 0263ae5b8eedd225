/* Forces, matrix and energy of timed joints: of springs that are in no table of a block
 * (cloth/flow/joints/ties.h). A joint is a spring from the point of its corners with positive
 * weights to that of the others. All its blocks compute it in this direction, to the same bits. */
#include "cloth/flow/state/bodies.h"

#include "cloth/physics/energy.h"

/* Some joints as springs from points x[0] to x[1]. */
enum { AT_ONCE = 32 };
struct some_joints {
    uint32_t n, next;      /* how many; the tie behind them */
    uint32_t tie[AT_ONCE]; /* their numbers in the table */
    uint32_t end[AT_ONCE][2];
    double stiffness[AT_ONCE], damping[AT_ONCE], length[AT_ONCE];
    phys_vec x[2][AT_ONCE], v[2][AT_ONCE];
};

static struct phys_springs springs_of(const struct some_joints *some, int full)
{
    return (struct phys_springs){some->n,         (const uint32_t(*)[2])some->end,
                                 some->stiffness, some->damping,
                                 some->length,    full};
}

static void append_joint(const struct flow_ties *ties, const struct flow_view *view, uint32_t i,
                         const struct flow_tie *joint, struct some_joints *some)
{
    const uint32_t at = some->n++;
    some->tie[at] = i;
    some->end[at][0] = some->end[at][1] = at;
    some->stiffness[at] = joint->stiffness;
    some->damping[at] = joint->damping;
    some->length[at] = joint->length;
    for (int end = 0; end < 2; end++)
        some->x[end][at] = some->v[end][at] = (phys_vec){0};
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const double weight = ties->weight[i][k], share = weight < 0 ? -weight : weight;
        const int end = weight < 0;
        if (weight == 0)
            continue;
        some->x[end][at] += share * *flow_tie_x(ties, view, ties->corner[i][k]);
        if (view->v)
            some->v[end][at] += share * *flow_tie_v(ties, view, ties->corner[i][k]);
    }
}

/* Takes the next joints among the ties before `to`. Returns whether there are any. */
static bool take_joint(const struct flow *flow, const struct flow_ties *ties,
                       const struct flow_view *view, uint32_t to, struct some_joints *some)
{
    uint32_t i = some->next;
    some->n = 0;
    for (; i < to && some->n < AT_ONCE; i++)
        if (ties->of[i] < flow->n_ties)
            append_joint(ties, view, i, flow->tie + ties->of[i], some);
    some->next = i;
    return some->n > 0;
}

/* Adds the springs' effects on their first points to the rows of the block, by their weights. */
static void scatter(const struct flow_ties *ties, const struct some_joints *some,
                    const phys_vec *add, phys_vec *y)
{
    for (uint32_t i = 0; i < some->n; i++) {
        const uint32_t *corner = ties->corner[some->tie[i]];
        const double *weight = ties->weight[some->tie[i]];
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
            if (weight[k] != 0 && corner[k] < ties->n_rows)
                y[corner[k]] += weight[k] * add[i];
    }
}

void flow_ties_force(const struct flow *flow, const struct flow_view *view, phys_vec *f)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    struct some_joints some = {0};
    while (take_joint(flow, &ties, view, ties.n, &some)) {
        const struct phys_springs springs = springs_of(&some, 0);
        phys_vec add[AT_ONCE] = {{0}};
        phys_springs_force_cut(&springs, some.x[0], some.v[0], some.x[1], some.v[1], add);
        scatter(&ties, &some, add, f);
    }
}

void flow_ties_system(const struct flow *flow, const struct flow_view *view, double h, double push,
                      phys_vec *b, phys_vec *value)
{
    const struct flow_ties ties = flow_ties_open(view->tie_table);
    struct some_joints some = {0};
    memset(value, 0, ties.room.ties * sizeof *value);
    while (take_joint(flow, &ties, view, ties.n, &some)) {
        const struct phys_springs springs = springs_of(&some, flow->model->full_slope);
        phys_vec add[AT_ONCE] = {{0}}, made[AT_ONCE];
        if (b)
            phys_springs_system_cut(&springs, h, push, some.x[0], some.v[0], some.x[1], some.v[1],
                                    add, made);
        else
            phys_springs_matrix(&springs, h, some.x[0], some.x[1], made);
        if (b)
            scatter(&ties, &some, add, b);
        for (uint32_t i = 0; i < some.n; i++)
            value[some.tie[i]] = made[i];
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
    struct some_joints some = {0};
    double sum = 0;
    while (take_joint(flow, &ties, view, ties.n, &some))
        for (uint32_t i = 0; i < some.n; i++) {
            struct phys_springs one = springs_of(&some, 0);
            one.n = 1;
            one.end += i;
            one.stiffness += i;
            one.length += i;
            sum += share_of(&ties, some.tie[i]) * phys_energy_springs(&one, some.x[0], some.x[1]);
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
