/* Where contacts with obstacles are: their normals and gaps at an end of a step, whatever the cloth
 * does in it. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"

#include "cloth/contact/solid.h"

/* The normal and the gap of a place, at an end of a step. */
static void find_place(const struct flow *flow, double from, double to, enum contact_end end,
                       const struct flow_contact *contact, struct contact_row *row,
                       phys_vec *velocity)
{
    const struct model *model = flow->model;
    const struct contact_shape *shape =
        model->obstacles + (contact->side[1] - flow->tables.n_blocks);
    const phys_vec x[3] = {row->origin, row->origin, row->origin};
    struct contact_solid solid;
    struct contact_pose pose;
    struct contact_solid_point on;
    contact_pose_over(shape, model->keys, &model->bodies, from, to, &pose);
    contact_solid_make(shape, &pose, &solid);
    contact_solid_nearest(&solid, end, x, &on);
    row->normal = on.normal;
    row->gap = on.gap;
    *velocity = on.velocity;
}

void flow_contact_end(const struct flow *flow, double from, double to,
                      const struct flow_contact *contact, struct contact_row *row)
{
    phys_vec velocity;
    find_place(flow, from, to, CONTACT_END, contact, row, &velocity);
}

void flow_contact_ahead(const struct flow *flow, double from, double to,
                        const struct flow_contact *contact, struct contact_row *row)
{
    phys_vec velocity;
    if (contact->side[1] < flow->tables.n_blocks)
        return;
    if (contact->kind != FLOW_CONTACT_SHAPE) {
        flow_body_ahead(flow, from, to, contact, row);
        return;
    }
    find_place(flow, from, to, CONTACT_BEGIN, contact, row, &velocity);
    const phys_vec carried = (to - from) * velocity;
    row->gap -= phys_dot(&row->normal, &carried);
    row->slip -= carried;
}
