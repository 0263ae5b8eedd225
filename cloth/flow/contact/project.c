/* The filter by which sliders hold rows in the solve, and the projection out of obstacles after it.
 */
#include "cloth/contact/meet.h"
#include "cloth/flow/contact/image.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"

/* ---- The filter of the solve ---- */

FLOW_KERNEL(filter, FLOW_COLLIDE, struct flow_step_args, (R(table), W(filter)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
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
    return 0;
}

int flow_contact_filter(struct flow_state *state, struct flow_step_args args)
{
    return flow_fork_each(state, &flow_kernel_filter, &args);
}

/* Filters the right side, and gives the matrix its filter. */
FLOW_KERNEL(constrain, FLOW_COLLIDE, struct flow_block_args, (R(table), R(filter), RW(f), RW(a)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    for (uint32_t i = 0; i < t->n; i++) {
        solve_filter(on->filter + i, on->f + i);
        solve_filter(on->filter + i, on->f + i); /* one pass would leave a rounding error */
    }
    memcpy(on->a + flow_diagonal_rows(t), on->filter, t->n * sizeof *on->filter);
    return 0;
}

int flow_contact_constrain(struct flow_state *state)
{
    return flow_fork_each(state, &flow_kernel_constrain, NULL);
}

/* ---- After a step: rows inside an obstacle are put on it ---- */

/* An obstacle as the rows of a block meet it. */
struct meeting {
    const struct flow_table *table;
    const struct contact_apart *apart;
    uint32_t other; /* the obstacle there */
    const struct contact_shape *obstacle;
    struct contact_pose pose;
    struct contact_image image; /* that the pose has, if it has any */
    phys_vec *x, *v;
};

/* True if a row's cloth meets the obstacle. The search begins at the cloth of the row before. */
static bool project_is_met(const struct meeting *m, uint32_t row, uint32_t *cloth)
{
    if (!m->apart->apart)
        return true;
    *cloth = contact_apart_cloth(m->apart, m->table->vertex[row], *cloth);
    return !contact_are_apart(m->apart, *cloth, m->other);
}

/* Puts out rows from .. to - 1 of cloths that meet the obstacle. Returns how many it moved. */
static size_t project_rows(const struct meeting *m, uint32_t from, uint32_t to)
{
    size_t touched = 0;
    uint32_t cloth = 0;
    while (from < to) {
        const bool met = project_is_met(m, from, &cloth);
        uint32_t end = m->apart->apart ? from + 1 : to;
        while (end < to && project_is_met(m, end, &cloth) == met)
            end++;
        if (met)
            touched += contact_project(m->obstacle, &m->pose, end - from, m->table->free + from,
                                       m->x + from, m->v + from);
        from = end;
    }
    return touched;
}

/* Rows that a slider holds leave an obstacle along it. Returns how many rows of the block met it.
 */
static size_t obstacle_meets(const duite_call *call, const struct flow_step_args *step,
                             struct meeting *m)
{
    const struct flow_table *t = m->table;
    struct contact_hit hit;
    struct flow_pins pins;
    struct flow_slider slider;
    uint32_t from = 0, cloth = 0;
    size_t touched = 0;
    flow_obstacle_pose(call, step, m->obstacle, &m->pose);
    m->pose.image = m->image.body ? &m->image : NULL;
    flow_pins_begin(call, t, step->time, &pins);
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        const uint32_t row = t->sliding[i][0];
        touched += project_rows(m, from, row);
        from = row + 1;
        if (!project_is_met(m, row, &cloth))
            continue;
        contact_closest(m->obstacle, &m->pose, 1, m->x + row, &hit);
        flow_pins_slider(&pins, i, &slider);
        phys_vec way = hit.normal;
        if (flow_slider_way(&slider.filter, &way))
            touched += contact_leave(&hit, &way, m->x + row, m->v + row);
    }
    return touched + project_rows(m, from, t->n);
}

FLOW_KERNEL(collide, FLOW_COLLIDE, struct flow_step_args,
            (R(table), RW(x), RW(v), W(halo_x), W(halo_v), SUM(status), ALL(maps)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct model *model = flow_of(call)->model;
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        struct meeting meeting = {.table = t,
                                  .apart = &model->contact.apart,
                                  .other = flow_of(call)->n_cloths + i,
                                  .obstacle = model->obstacles + i,
                                  .x = on->x,
                                  .v = on->v};
        flow_map_open(flow_of(call), i, on->maps, &meeting.image);
        on->status[FLOW_TOUCHED] += (double)obstacle_meets(call, on->args, &meeting);
    }
    flow_write_halo(t, on->x, on->halo_x);
    flow_write_halo(t, on->v, on->halo_v);
    return flow_check(call, t, on->args, on->x, "position", on->status);
}

double flow_project_move(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_step_args args = flow_attempt_args(state);
    const double from = args.begin * model->h / FLOW_TICKS;
    contact_bodies_move(&model->bodies, from, args.time);
    return from;
}

int flow_project(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    return flow_fork_each(state, &flow_kernel_collide, &args);
}

static int settle_project(struct flow_state *state)
{
    flow_project_move(state);
    return flow_project(state);
}

static bool has_obstacles(const struct model *model)
{
    return model->n_obstacles > 0;
}

const struct flow_contact_mode flow_contact_project = {.is = has_obstacles,
                                                       .settle = settle_project};
