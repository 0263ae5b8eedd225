/* Pins that move, and those that leave their vertices free along sliders: lines or planes. Before
 * the forces the vertices get, as far as they are held, the velocity that ends the step at their
 * prescribed place. Forces and solve see it as that of any other vertex. A row that is held keeps
 * it (b - A z of Ascher & Boxerman 2003, with the change z made beforehand). After the step they
 * are put exactly there, so that nothing adds up. In the step a slider is where it is at its end.
 */
#include "cloth/base/order.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"

#include "cloth/physics/motion.h"

void flow_pins_begin(const duite_call *call, const struct flow_table *t, double time,
                     struct flow_pins *pins)
{
    const struct flow *flow = flow_of(call);
    *pins =
        (struct flow_pins){.model = flow->model, .anchor = flow->anchor, .table = t, .time = time};
}

/* The pose of a motion, by number from 1, at the time of the pins. */
static const struct phys_pose *pose_of(struct flow_pins *pins, uint32_t motion)
{
    const struct model_motion *m = pins->model->motions + motion - 1;
    if (pins->motion != motion)
        phys_pose_at(m->n, pins->model->keys + m->first, m->about, pins->time, &pins->pose);
    if (pins->motion != motion && m->follow)
        phys_pose_at(m->n, pins->model->keys + m->first, m->about, 0, &pins->begin);
    pins->motion = motion;
    return &pins->pose;
}

void flow_pins_place(struct flow_pins *pins, uint32_t motion, const phys_vec *x, phys_vec *to)
{
    const uint32_t n = pins->model->n_motions;
    if (motion > n) {
        flow_anchor_place(pins->model, pins->anchor + (motion - n - 1), pins->time, to);
        return;
    }
    *to = *x;
    if (!pins->model->motions[motion - 1].n)
        return; /* it follows an obstacle at rest */
    const struct phys_pose *pose = pose_of(pins, motion);
    if (pins->model->motions[motion - 1].follow)
        phys_pose_back(&pins->begin, to, to);
    phys_pose_point(pose, to, to);
}

void flow_pins_slider(struct flow_pins *pins, uint32_t i, struct flow_slider *slider)
{
    const uint32_t *row = pins->table->sliding[i];
    const struct model_slider *is = pins->model->sliders + row[1] - 1;
    phys_vec d = PHYS_VEC(is->direction);
    slider->at = pins->table->position[row[0]];
    if (is->motion) {
        const struct phys_pose *pose = pose_of(pins, is->motion);
        phys_pose_point(pose, &slider->at, &slider->at);
        phys_pose_direction(pose, &d, &d);
    }
    slider->filter = d;
    slider->filter[3] = is->kind == MODEL_PLANE;
}

const phys_vec *flow_pins_filter(struct flow_pins *pins, uint32_t row)
{
    const struct flow_table *t = pins->table;
    pins->next = cloth_first_from(t->sliding, 2, t->n_sliding, row);
    if (pins->next == t->n_sliding || t->sliding[pins->next][0] != row)
        return NULL;
    flow_pins_slider(pins, pins->next, &pins->slider);
    return &pins->slider.filter;
}

void flow_sliders_filter(const duite_call *call, const struct flow_table *t, double time,
                         phys_vec *y)
{
    struct flow_pins pins;
    struct flow_slider slider;
    flow_pins_begin(call, t, time, &pins);
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        flow_pins_slider(&pins, i, &slider);
        solve_filter(&slider.filter, y + t->sliding[i][0]);
    }
}

void flow_sliders_keep(const duite_call *call, const struct flow_table *t, double time,
                       const phys_vec *before, phys_vec *y)
{
    struct flow_pins pins;
    struct flow_slider slider;
    flow_pins_begin(call, t, time, &pins);
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        const uint32_t row = t->sliding[i][0];
        flow_pins_slider(&pins, i, &slider);
        flow_slider_keep(&slider, before + row, y + row);
    }
}

/* ---- A step ---- */

/* Forks a kernel on the blocks with such pins. */
static int fork_moved(struct flow_state *state, const struct flow_kernel *kernel)
{
    struct flow_step_args args = flow_attempt_args(state);
    for (; args.block < state->flow->tables.n_blocks; args.block++) {
        const struct flow_table *t = state->flow->tables.block + args.block;
        if (t->n_moved || t->n_sliding)
            flow_fork_one(state, kernel, &args);
    }
    return state->code;
}

FLOW_KERNEL(prescribe_velocity, FLOW_VELOCITY, struct flow_step_args,
            (R(table), R(x), RW(v), W(halo_v)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const double h = on->args->h;
    const phys_vec *x = on->x;
    phys_vec *v = on->v;
    struct flow_pins pins;
    struct flow_slider slider;
    flow_pins_begin(call, t, on->args->time, &pins);
    for (uint32_t i = 0; i < t->n_moved; i++) {
        const uint32_t row = t->moved[i][0];
        phys_vec to;
        flow_pins_place(&pins, t->moved[i][1], t->position + row, &to);
        v[row] = (to - x[row]) / h;
    }
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        const uint32_t row = t->sliding[i][0];
        flow_pins_slider(&pins, i, &slider);
        const phys_vec due = (slider.at - x[row]) / h;
        flow_slider_keep(&slider, &due, v + row);
    }
    flow_write_halo(t, v, on->halo_v);
    return 0;
}

int flow_pins_prescribe_velocity(struct flow_state *state)
{
    return fork_moved(state, &flow_kernel_prescribe_velocity);
}

FLOW_KERNEL(prescribe_position, FLOW_POSITION, struct flow_step_args, (R(table), RW(x), W(halo_x)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    phys_vec *x = on->x;
    struct flow_pins pins;
    struct flow_slider slider;
    flow_pins_begin(call, t, on->args->time, &pins);
    for (uint32_t i = 0; i < t->n_moved; i++) {
        const uint32_t row = t->moved[i][0];
        flow_pins_place(&pins, t->moved[i][1], t->position + row, x + row);
    }
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        flow_pins_slider(&pins, i, &slider);
        flow_slider_keep(&slider, &slider.at, x + t->sliding[i][0]);
    }
    flow_write_halo(t, x, on->halo_x);
    return 0;
}

int flow_pins_prescribe_position(struct flow_state *state)
{
    return fork_moved(state, &flow_kernel_prescribe_position);
}

/* ---- Accelerations, for reactions ---- */

/* At the end of the later step, at its begin and at that of the step before. */
static void pins_of(const duite_call *call, const struct flow_two_steps *steps,
                    struct flow_pins pins[3])
{
    const double back[3] = {0, steps->h, steps->h + steps->before};
    for (int i = 0; i < 3; i++)
        flow_pins_begin(call, NULL, steps->end - back[i], pins + i);
}

/* The acceleration of a point that was at x[2], x[1], x[0] in turn. */
static void second_difference(const struct flow_two_steps *steps, const phys_vec x[3], phys_vec *a)
{
    *a = ((x[0] - x[1]) / steps->h - (x[1] - x[2]) / steps->before) / steps->h;
}

void flow_due_acceleration(const duite_call *call, const struct flow_two_steps *steps,
                           uint32_t motion, const phys_vec *start, phys_vec *a)
{
    struct flow_pins pins[3];
    phys_vec x[3];
    pins_of(call, steps, pins);
    for (int i = 0; i < 3; i++)
        flow_pins_place(pins + i, motion, start, x + i);
    second_difference(steps, x, a);
}

/* The acceleration of the slider's point at the vertex, plus twice dR/dt RT times its velocity
 * along the slider (Coriolis). R: the slider's rotation. */
void flow_slider_acceleration(const duite_call *call, const struct flow_two_steps *steps,
                              uint32_t slider, const phys_vec *x, const phys_vec *v, phys_vec *a)
{
    const struct model *model = flow_of(call)->model;
    const uint32_t motion = model->sliders[slider - 1].motion;
    struct flow_pins pins[3];
    struct phys_pose pose[3];
    phys_vec at[3], turned[2], own, along;
    *a = (phys_vec){0};
    if (!motion)
        return;
    pins_of(call, steps, pins);
    for (int i = 0; i < 3; i++)
        pose[i] = *pose_of(pins + i, motion);
    phys_pose_back(pose, x, &own);
    for (int i = 0; i < 3; i++)
        phys_pose_point(pose + i, &own, at + i);
    second_difference(steps, at, a);
    const phys_vec slip = *v - (at[0] - at[1]) / steps->h;
    phys_pose_direction_back(pose, &slip, &along);
    for (int i = 0; i < 2; i++)
        phys_pose_direction(pose + i, &along, turned + i);
    *a += 2 * (turned[0] - turned[1]) / steps->h;
}
