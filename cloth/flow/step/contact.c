/* Slider constraints and contact in the solve. A row that a slider holds is filtered by it. A
 * vertex that lies on an obstacle, or comes to it in the step by the velocity it has, is held along
 * the normal by the filter of the solve. Before the forces the vertex gets, along the normal, the
 * velocity that ends the step on the surface. Forces and the right side see it (b - A z of Ascher &
 * Boxerman 2003, with the change z made beforehand, as for pins). A vertex that lies there is
 * released when the forces on it pull it off. */
#include "cloth/contact/meet.h"
#include "cloth/flow/step/sliders.h"
#include "cloth/flow/step/step.h"

/* Whether a row can leave an obstacle with the normal *way, which becomes the way along which it
 * does.
 */
static bool can_leave(struct flow_pins *pins, uint32_t row, phys_vec *way)
{
    const phys_vec *filter = flow_pins_filter(pins, row);
    return pins->table->free[row] != 0 && (!filter || flow_slider_way(filter, way));
}

/* Gives rows the velocity that ends the step on the obstacle. */
static void predict_obstacle(const duite_call *call, const struct flow_table *t,
                             const struct flow_step_args *step,
                             const struct contact_shape *obstacle, const phys_vec *x, phys_vec *v)
{
    struct contact_pose pose;
    struct flow_pins pins;
    flow_obstacle_pose(call, step, obstacle, &pose);
    flow_pins_begin(call, t, step->time, &pins);
    for (uint32_t i = 0; i < t->n; i++) {
        struct contact_hit hit;
        double speed, due;
        contact_ahead(obstacle, &pose, x + i, &hit);
        phys_vec way = hit.normal;
        if (can_leave(&pins, i, &way) && contact_meet(&hit, step->h, v + i, &speed, &due))
            v[i] += (due - speed) * way;
    }
}

FLOW_KERNEL(predict_contact, FLOW_COLLIDE, struct flow_step_args,
            (R(table), R(x), RW(v), W(halo_v)))
static int predict_contact_body(const duite_call *call, const struct predict_contact_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct model *model = flow_of(call)->model;
    for (uint32_t p = 0; p < model->n_obstacles; p++)
        predict_obstacle(call, &table, on->args, model->obstacles + p, on->x, on->v);
    flow_write_halo(&table, on->v, on->halo_v);
    return 0;
}

int flow_contact_predict(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    return flow_fork_each(state, &flow_kernel_predict_contact, &args);
}

/* ---- The filter of the solve ---- */

FLOW_KERNEL(contact, FLOW_COLLIDE, struct flow_step_args, (R(table), R(x), R(v), R(f), W(filter)))

/* Holds the rows that an obstacle holds. */
static void constrain_rows(const duite_call *call, const struct flow_table *t,
                           const struct contact_shape *obstacle, const struct contact_fields *on)
{
    struct contact_pose pose;
    struct flow_pins pins;
    flow_obstacle_pose(call, on->args, obstacle, &pose);
    flow_pins_begin(call, t, on->args->time, &pins);
    for (uint32_t i = 0; i < t->n; i++) {
        struct contact_hit hit;
        double speed, due;
        contact_ahead(obstacle, &pose, on->x + i, &hit);
        phys_vec way = hit.normal;
        if (!can_leave(&pins, i, &way))
            continue;
        const enum contact_meeting how = contact_meet(&hit, on->args->h, on->v + i, &speed, &due);
        if (how == CONTACT_LANDS || (how == CONTACT_LIES && phys_dot(on->f + i, &way) <= 0))
            solve_constrain(&hit.normal, on->filter + i);
    }
}

/* The program's part. */
static int filter_own(const duite_call *call, const struct flow_table *t,
                      const struct contact_fields *on)
{
    const struct flow_filter *own = &flow_of(call)->filter;
    const struct flow_rows rows = {.n = t->n,
                                   .vertex = t->vertex,
                                   .x = on->x,
                                   .v = on->v,
                                   .time = on->args->time,
                                   .h = on->args->h,
                                   .filter = on->filter};
    if (!own->rows)
        return duite_fail(call, FLOW_NO_FILTER,
                          "the model has a filter of the program's own, but this rank was given no "
                          "function; call flow_filter_by on every rank");
    own->rows(own->context, &rows);
    return 0;
}

static int contact_body(const duite_call *call, const struct contact_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct model *model = flow_of(call)->model;
    phys_vec *filter = on->filter;
    struct flow_pins pins;
    struct flow_slider slider;
    flow_pins_begin(call, t, on->args->time, &pins);
    for (uint32_t i = 0; i < t->n; i++)
        filter[i] = (phys_vec){0, 0, 0, 1};
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        flow_pins_slider(&pins, i, &slider);
        filter[t->sliding[i][0]] = slider.filter;
    }
    for (uint32_t p = 0; model_solves_contact(model) && p < model->n_obstacles; p++)
        constrain_rows(call, t, model->obstacles + p, on);
    return model->own_filter ? filter_own(call, t, on) : 0;
}

int flow_contact_filter(struct flow_state *state, struct flow_step_args args)
{
    return flow_fork_each(state, &flow_kernel_contact, &args);
}

/* Filters the right side, and gives the matrix its filter. */
FLOW_KERNEL(constrain, FLOW_COLLIDE, struct flow_block_args, (R(table), R(filter), RW(f), RW(a)))
static int constrain_body(const duite_call *call, const struct constrain_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    for (uint32_t i = 0; i < t->n; i++) {
        solve_filter(on->filter + i, on->f + i);
        solve_filter(on->filter + i, on->f + i); /* once leaves a rounding of what it takes away */
    }
    memcpy(on->a + flow_diagonal_rows(t), on->filter, t->n * sizeof *on->filter);
    return 0;
}

int flow_contact_constrain(struct flow_state *state)
{
    struct flow_block_args args;
    return flow_fork_each(state, &flow_kernel_constrain, &args);
}

/* ---- After a step: what is inside an obstacle is put on it ---- */

/* Rows that a slider holds leave an obstacle along it. Returns how many rows of the block met it.
 */
static size_t obstacle_meets(const duite_call *call, const struct flow_table *t,
                             const struct flow_step_args *step,
                             const struct contact_shape *obstacle, phys_vec *x, phys_vec *v)
{
    struct contact_pose pose;
    struct contact_hit hit;
    struct flow_pins pins;
    struct flow_slider slider;
    uint32_t from = 0;
    size_t touched = 0;
    flow_obstacle_pose(call, step, obstacle, &pose);
    flow_pins_begin(call, t, step->time, &pins);
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        const uint32_t row = t->sliding[i][0];
        touched += contact_project(obstacle, &pose, row - from, t->free + from, x + from, v + from);
        from = row + 1;
        contact_closest(obstacle, &pose, 1, x + row, &hit);
        flow_pins_slider(&pins, i, &slider);
        phys_vec way = hit.normal;
        if (flow_slider_way(&slider.filter, &way))
            touched += contact_leave(&hit, &way, x + row, v + row);
    }
    return touched +
           contact_project(obstacle, &pose, t->n - from, t->free + from, x + from, v + from);
}

FLOW_KERNEL(collide, FLOW_COLLIDE, struct flow_step_args,
            (R(table), RW(x), RW(v), W(halo_x), W(halo_v), SUM(status)))
static int collide_body(const duite_call *call, const struct collide_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct model *model = flow_of(call)->model;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        on->status[FLOW_TOUCHED] +=
            (double)obstacle_meets(call, t, on->args, model->obstacles + i, on->x, on->v);
    flow_write_halo(t, on->x, on->halo_x);
    flow_write_halo(t, on->v, on->halo_v);
    return flow_check(call, t, on->args, on->x, "position", on->status);
}

int flow_contact_project(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    return flow_fork_each(state, &flow_kernel_collide, &args);
}
