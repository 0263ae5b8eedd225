#ifndef CLOTH_FLOW_PINS_SLIDERS_H
#define CLOTH_FLOW_PINS_SLIDERS_H

#include "cloth/contact/shape.h"
#include "cloth/flow/state/bodies.h"
#include "cloth/physics/motion.h"

/* In bodies of tasks: the freedom that pins leave their vertices at the end of the step under way.
 * Local functions. */

/* The slider of a row: its part of S (solve_filter) and a point of the line or plane. */
struct flow_slider {
    phys_vec filter, at;
};

/* Keeps only the free part of y - from: y = from + S (y - from). */
PHYS_INLINE void flow_slider_keep(const struct flow_slider *slider, const phys_vec *from,
                                  phys_vec *y)
{
    phys_vec free = *y - *from;
    solve_filter(&slider->filter, &free);
    *y = *from + free;
}

/* up, of length 1, becomes the way along which a row leaves a plane with this normal at the same
 * pace: that of S up. Returns false if it cannot. */
PHYS_INLINE bool flow_slider_way(const phys_vec *filter, phys_vec *up)
{
    phys_vec way = *up;
    solve_filter(filter, &way);
    const double pace = phys_dot(&way, up);
    *up = way / pace;
    return pace > 1e-12;
}

/* The pins of a block at one time. */
struct flow_pins {
    const struct model *model;
    const struct flow_anchor *anchor;
    const struct flow_table *table; /* for sliders */
    double time;
    uint32_t motion;              /* that the pose is of; 0: none yet */
    struct phys_pose pose, begin; /* now; where the run starts, of one that follows an obstacle */
    uint32_t next;                /* sliding row that was found last */
    struct flow_slider slider;
};
/* At a time, s: in a step its end. */
void flow_pins_begin(const duite_call *call, const struct flow_table *t, double time,
                     struct flow_pins *pins);
/* The place then of a vertex that starts at x, by a motion or by an anchor, numbered behind all
 * motions. */
void flow_pins_place(struct flow_pins *pins, uint32_t motion, const phys_vec *x, phys_vec *to);
/* The slider of sliding row i. */
void flow_pins_slider(struct flow_pins *pins, uint32_t i, struct flow_slider *slider);
/* The part of S of a row, NULL without a slider. Valid until the next call. */
const phys_vec *flow_pins_filter(struct flow_pins *pins, uint32_t row);

/* An obstacle in a step. */
static inline void flow_obstacle_pose(const duite_call *call, const struct flow_step_args *step,
                                      const struct contact_shape *obstacle,
                                      struct contact_pose *pose)
{
    const struct model *model = flow_of(call)->model;
    contact_pose_over(obstacle, model->keys, &model->bodies, step->begin * model->h / FLOW_TICKS,
                      step->time, pose);
}

/* y = S y of the sliding rows; y = before + S (y - before) of them. S is that of a time, s. */
void flow_sliders_filter(const duite_call *call, const struct flow_table *t, double time,
                         phys_vec *y);
void flow_sliders_keep(const duite_call *call, const struct flow_table *t, double time,
                       const phys_vec *before, phys_vec *y);

/* Two steps, s: when the later one ends, its length, and the length of the one before it. */
struct flow_two_steps {
    double end, h, before;
};
/* The acceleration that a motion gives a vertex that begins at `start`: the change of its mean
 * velocity between the two steps over the later one's length. */
void flow_due_acceleration(const duite_call *call, const struct flow_two_steps *steps,
                           uint32_t motion, const phys_vec *start, phys_vec *a);
/* The acceleration that a slider gives a vertex at x, v; only the part that S removes counts. */
void flow_slider_acceleration(const duite_call *call, const struct flow_two_steps *steps,
                              uint32_t slider, const phys_vec *x, const phys_vec *v, phys_vec *a);

#endif
