/* What holds rows in the solve, and what puts them out of obstacles after it. A row that a slider
 * holds is filtered by it. Then the program's own filter has its part. */
#include "cloth/contact/meet.h"
#include "cloth/flow/step/sliders.h"
#include "cloth/flow/step/step.h"

/* ---- The filter of the solve ---- */

FLOW_KERNEL(filter, FLOW_COLLIDE, struct flow_step_args, (R(table), R(x), R(v), W(filter)))

/* The program's part. */
static int own_rows(const duite_call *call, const struct flow_table *t,
                    const struct filter_fields *on)
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

static int filter_body(const duite_call *call, const struct filter_fields *on)
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
    return model->own_filter ? own_rows(call, t, on) : 0;
}

int flow_contact_filter(struct flow_state *state, struct flow_step_args args)
{
    return flow_fork_each(state, &flow_kernel_filter, &args);
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

/* Bodies with frames move here: tasks of the step before are done, since it has been settled. */
int flow_contact_project(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    const struct model *model = state->flow->model;
    contact_bodies_move(&model->bodies, args.begin * model->h / FLOW_TICKS, args.time);
    return flow_fork_each(state, &flow_kernel_collide, &args);
}
