#ifndef CLOTH_FLOW_STATE_BODIES_H
#define CLOTH_FLOW_STATE_BODIES_H

#include "cloth/base/clock.h"
#include "cloth/flow/state/state.h"
#include "cloth/physics/tiny.h"

#include <math.h>
#include <string.h>

/* Functions that the bodies of kernels share. Local. */

static inline struct flow *flow_of(const duite_call *call)
{
    return call->context;
}

/* The block of a task: the arguments of every kernel begin with it. Bodies pass shared functions
 * all else from `on->args`: an argument that the kernel lacks does not compile. */
static inline uint32_t flow_block_of(const duite_call *call)
{
    return *(const uint32_t *)call->args;
}

/* The number, counted from 1, of the step of length h that a tick is in. */
static inline double flow_step_number(double tick)
{
    return floor(tick / FLOW_TICKS) + 1;
}

/* The block of a task without its table. */
static inline const struct flow_table *flow_shape_of(const duite_call *call)
{
    return flow_of(call)->tables.block + flow_block_of(call);
}

/* The block with its table, the object of the field. */
static inline struct flow_table flow_table_in(const duite_call *call, const unsigned char *layout)
{
    struct flow_table table = *flow_shape_of(call);
    flow_table_open(&table, layout);
    return table;
}

/* x and v as the task of a block sees them: its own rows, the halos of its neighbours, the other
 * ends of its ties. Without velocities v is NULL. */
struct flow_view {
    const phys_vec *x, *v;
    const duite_param *halo_x, *halo_v;
    const unsigned char *tie_table;         /* NULL: the run has no ties */
    const duite_param *tie_halo;            /* of each block that it shares ties with */
    const struct contact_row *contact_rows; /* of those ties that are contacts; NULL: none is asked
                                             * for, or the run has none */
};
/* The view of a body whose kernel declares x, v, the neighbours' halos of both, ties and contacts.
 */
#define FLOW_VIEW(on)                                                                              \
    {                                                                                              \
        (on)->x, (on)->v, (on)->halo_x, (on)->halo_v, (on)->tie_table, (on)->tied_tie_halo,        \
            (on)->contact_rows                                                                     \
    }

/* Fails if a row diverged, naming it by the input's number; if the step can be made again, notes it
 * in the status instead. Notes there, too, that a stop is asked for. what: "position" or
 * "velocity". */
int flow_check(const duite_call *call, const struct flow_table *table,
               const struct flow_step_args *step, const phys_vec *y, const char *what,
               double *status);

/* The matrix of a step as its object has it: the diagonal, the filter if there is one, then the
 * values of the entries. */
static inline size_t flow_diagonal_rows(const struct flow_table *t)
{
    return ((size_t)t->n + 3) / 4;
}

/* Gives the table the diagonal of the matrix and returns the values. */
static inline const phys_vec *flow_matrix_in(const duite_call *call, struct flow_table *t,
                                             const phys_vec *a)
{
    const phys_vec *filter = a + flow_diagonal_rows(t);
    const bool filtered = model_is_filtered(flow_of(call)->model);
    t->matrix.diagonal = (const double *)a;
    t->matrix.filter = filtered ? filter : NULL;
    return filtered ? filter + t->n : filter;
}

/* The values of ties, behind those of the matrix. */
static inline const phys_vec *flow_tie_values(const struct flow_table *t, const void *values)
{
    return (const phys_vec *)values + flow_value_rows(t);
}

/* Ties that add something, side by side in their order behind those values: a solve reads them in
 * every pass, and most contacts of a pile do not press. The rows that they take: */
static inline size_t flow_acting_rows(uint32_t room)
{
    return room ? 1 + 2 * (size_t)room + (room + 1) / 2 : 0;
}
/* Writes them (solver/ties.c). value: of all ties; the rows follow. */
void flow_ties_gather(const struct flow_ties *ties, phys_vec *value);
/* The ties as a solve sees them. p_other: p of the ghosts of ties, in a pass. */
struct solve_ties flow_ties_solved(const struct flow_ties *ties, const phys_vec *value,
                                   const phys_vec *p_other);

/* A corner of a tie: a row of the block, or one that a block shows which shares ties with it.
 * shown: TIED of a field whose rows are those shown, once (part 0) or twice (0, 1). */
static inline const phys_vec *flow_tie_row(const struct flow_ties *ties, uint32_t corner,
                                           const phys_vec *own, const duite_param *shown, int part)
{
    if (corner < ties->n_rows)
        return own + corner;
    const uint32_t ghost = corner - ties->n_rows, k = ties->ghost_other[ghost];
    const size_t half = part ? shown[k].count / 8 : 0; /* numbers of two rows */
    return flow_rows_of(shown, k) + half + ties->place[k] + (ghost - ties->start[k]);
}

/* x and v of a corner. */
static inline const phys_vec *flow_tie_x(const struct flow_ties *ties, const struct flow_view *view,
                                         uint32_t corner)
{
    return flow_tie_row(ties, corner, view->x, view->tie_halo, 0);
}
static inline const phys_vec *flow_tie_v(const struct flow_ties *ties, const struct flow_view *view,
                                         uint32_t corner)
{
    return flow_tie_row(ties, corner, view->v, view->tie_halo, 1);
}

/* Timed joints of a block (joints/tie_forces.c). Adds their forces, N. Their part of the system of
 * a step, as phys_springs_system has it; of the matrix alone where b is NULL; values of other ties
 * become zero. Their energy, J, half of it where an end is in another block. */
void flow_ties_force(const struct flow *flow, const struct flow_view *view, phys_vec *f);
void flow_ties_system(const struct flow *flow, const struct flow_view *view, double h, double push,
                      phys_vec *b, phys_vec *value);
double flow_ties_energy(const struct flow *flow, const struct flow_view *view);
/* Contacts of a block (contact/rows.c). Adds their forces at the time of the step, N. Adds their
 * part of a system: at x + h v if push is h; at x, with - h^2 K v on the right side, if it is 0.
 * Only the matrix if b is NULL. */
void flow_contact_force(const struct flow *flow, const struct flow_view *view,
                        const struct flow_step_args *step, phys_vec *f);
/* Adds to f the forces that they had in the step that ended at x, N. value: of the solve's matrix,
 * obstacle: of each, from 1, or 0. Adds the forces of an obstacle on rows of this block to its
 * vector, too. */
void flow_contact_solved(const struct flow *flow, const struct flow_view *view,
                         const uint32_t *obstacle, const phys_vec *value, phys_vec *f,
                         phys_vec *by_obstacle);
void flow_contact_system(const struct flow *flow, const struct flow_view *view, double h,
                         double push, phys_vec *b, phys_vec *value);
/* Takes N dv of ties that lead to held ends out of lost[3]: solve_lost cannot know it. */
void flow_ties_lost(const unsigned char *tie_table, const phys_vec *value, const phys_vec *dv,
                    double lost[3]);

/* Elements of a block (elements.c). Their sight of a view; one at a time on a worker, until its
 * task ends. */
bool flow_has_elements(const struct flow_table *t);
struct phys_sight flow_elements_see(const duite_call *call, const struct flow_table *t,
                                    const struct flow_view *view);
/* Adds their forces at a time, s; beside: only of kinds whose matrix does not come with the right
 * side. */
void flow_elements_force(const duite_call *call, const struct flow_table *t, double now,
                         bool beside, const struct phys_sight *sight, phys_vec *f);
/* y -= scale K v of the same. */
void flow_elements_stiffness(const duite_call *call, const struct flow_table *t, double scale,
                             const struct phys_sight *sight, phys_vec *y);
/* Adds their part of the matrix to the sums of its entries. Unless b is NULL, adds the right side
 * of the other kinds (system in cloth/element/kind.h). */
void flow_elements_assemble(const duite_call *call, const struct flow_table *t, double h,
                            double push, const struct phys_sight *sight, phys_vec *b,
                            struct phys_pair *sums);
/* The energy, J, of the elements that count here. Adds the torque, N m, of uncorrected forces. */
double flow_elements_energy(const duite_call *call, const struct flow_table *t,
                            const struct flow_view *view, double torque[3]);

/* Loads that vary (run/loads.c), as they are at a time, s: adds them (N) to f; their energy (J) at
 * x, zero at the origin. */
void flow_varying_add(const duite_call *call, const struct flow_table *t, double now, phys_vec *f);
double flow_varying_energy(const duite_call *call, const struct flow_table *t, double now,
                           const phys_vec *x);

/* Soft pins (pins/soft.c), as they are at a step's `now`. Their forces (N), added to f; of one row,
 * added to *sum. Their part of the diagonal of the step's matrix, kg; y -= h^2 K v. Their energy,
 * J. */
void flow_soft_force(const duite_call *call, const struct flow_table *t,
                     const struct flow_step_args *step, const phys_vec *x, const phys_vec *v,
                     phys_vec *f);
void flow_soft_pull(const duite_call *call, const struct flow_table *t,
                    const struct flow_step_args *step, uint32_t row, const phys_vec *x,
                    const phys_vec *v, phys_vec *sum);
void flow_soft_diagonal(const duite_call *call, const struct flow_table *t,
                        const struct flow_step_args *step, double *diagonal);
void flow_soft_stiffness(const duite_call *call, const struct flow_table *t,
                         const struct flow_step_args *step, const phys_vec *v, phys_vec *y);
double flow_soft_energy(const duite_call *call, const struct flow_table *t,
                        const struct flow_step_args *step, const phys_vec *x);

/* All forces on the block's rows at a time of a step, its `now`, in N, with the drag or without.
 * (forces.c) */
void flow_forces(const duite_call *call, const struct flow_table *t,
                 const struct flow_step_args *step, const struct flow_view *view, bool drag,
                 phys_vec *f);

/* Copies the rows that neighbours need. halo: n_halo rows; a single unread one if there are none.
 */
static inline void flow_write_halo(const struct flow_table *table, const phys_vec *y,
                                   phys_vec *halo)
{
    for (uint32_t i = 0; i < table->n_halo; i++)
        halo[i] = y[table->halo[i]];
    if (!table->n_halo)
        halo[0] = (phys_vec){0};
}

/* A halo of the solve: three numbers a row; a single unread row if there are none. */
static inline void flow_pack_halo(const struct flow_table *t, const phys_vec *y, double *halo)
{
    solve_pack(t->n_halo, t->halo, y, halo);
    if (!t->n_halo)
        halo[0] = halo[1] = halo[2] = 0;
}

/* The number of dots that a pass sums: without a preconditioner r.z is r.r, and the rest is for
 * stops by norms. */
static inline size_t flow_dots(const struct flow *flow)
{
    return flow_is_preconditioned(flow) || model_stops_by_norms(flow->model) ? SOLVE_DOTS
                                                                             : SOLVE_RZ;
}

/* In a body: counts its seconds since it began, or since the last call, for this part of the step.
 */
static inline void flow_part_ends(const duite_call *call, enum flow_part part)
{
    struct flow_clock *clock = flow_of(call)->clock + call->worker;
    const double now = cloth_seconds();
    clock->seconds[part] += now - clock->from;
    clock->from = now;
}

/* Runs a body without subnormal numbers, and adds its seconds to a part of the step, on this
 * worker's line. */
static inline int flow_timed(const duite_call *call, duite_body *body, enum flow_part part)
{
    flow_of(call)->clock[call->worker].from = cloth_seconds();
    const phys_tiny before = phys_tiny_off();
    const int code = body(call);
    phys_tiny_back(before);
    flow_part_ends(call, part);
    return code;
}

#endif
