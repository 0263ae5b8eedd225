/* Contact after a step: vertices inside an obstacle are put on it. */
#include "cloth/contact/meet.h"
#include "cloth/flow/step/guides.h"

#define ARGS sizeof(struct flow_args)

/* Rows that a guide holds leave an obstacle along it. Returns how many rows of the block met it. */
static size_t obstacle_meets(const duite_call *call, const struct flow_table *t,
                             const struct contact_shape *obstacle, phys_vec *x, phys_vec *v)
{
    struct contact_pose pose;
    struct contact_hit hit;
    struct flow_pins pins;
    struct flow_guide guide;
    uint32_t from = 0;
    size_t touched = 0;
    flow_obstacle_pose(call, obstacle, &pose);
    flow_pins_begin(call, t, &pins);
    for (uint32_t i = 0; i < t->n_guided; i++) {
        const uint32_t row = t->guided[i][0];
        touched += contact_project(obstacle, &pose, row - from, t->free + from, x + from, v + from);
        from = row + 1;
        contact_closest(obstacle, &pose, 1, x + row, &hit);
        flow_pins_guide(&pins, i, &guide);
        phys_vec way = hit.normal;
        if (flow_guide_way(&guide.filter, &way))
            touched += contact_leave(&hit, &way, x + row, v + row);
    }
    return touched +
           contact_project(obstacle, &pose, t->n - from, t->free + from, x + from, v + from);
}

static int collide(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const struct model *model = flow_of(call)->model;
    phys_vec *x = duite_out(call, 1, phys_vec), *v = duite_out(call, 2, phys_vec);
    double *status = duite_out(call, 5, double);
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        status[FLOW_TOUCHED] += (double)obstacle_meets(call, t, model->obstacles + i, x, v);
    flow_write_rim(t, x, duite_out(call, 3, phys_vec));
    flow_write_rim(t, v, duite_out(call, 4, phys_vec));
    return flow_check(call, t, x, "position", status);
}
FLOW_TIMED(collide, FLOW_COLLIDE)
const duite_kernel flow_collide = {
    .name = "collide",
    .body = collide_timed,
    .access = {DUITE_R, DUITE_RW, DUITE_RW, DUITE_W, DUITE_W, DUITE_CW},
    .args_size = ARGS};
