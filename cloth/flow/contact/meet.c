/* Two skins meet: every pair of their features that may come near each other in the step is looked
 * at (meet_pair.c). A block may meet itself, another block or a body. The order of the list is that
 * of the query, so it is the same for every mapping. Another look at the step keeps items of the
 * list that did not move, and queries only what moved. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/meeting.h"
#include "cloth/flow/contact/mode.h"

#include "cloth/contact/certificate.h"

#include <math.h>

/* Side k is a block of that skin. */
static void open_side(struct meeting *m, int k, const struct flow_skin *skin,
                      const phys_vec *points, const unsigned char *boxes)
{
    m->skin[k] = skin->skin;
    m->findings.n_points[k] = skin->skin.n_points;
    m->area[k] = skin->area;
    m->kin[k] = skin->kin;
    m->moved[k] = contact_moved_points(m->skin + k, boxes);
    m->side[k] = (struct contact_side){
        .skin = m->skin + k, .boxes = boxes, .x = points, .y = points + skin->skin.n_points};
}

/* Opens the first side, and what all meetings have. near: the list's parameter. */
static void begin_meeting(const duite_call *call, size_t near, struct flow_list *list,
                          double *counts, const struct flow_meet_args *args,
                          const unsigned char *skin, const phys_vec *points,
                          const unsigned char *boxes, struct meeting *m)
{
    const struct flow *flow = flow_of(call);
    const struct flow_skin own = flow_skin_open(skin);
    const struct flow_thickness thickness = flow_thickness_of(flow, args->side[0], args->side[1]);
    *m = (struct meeting){.flow = flow,
                          .model = flow->model,
                          .args = args,
                          .thickness = thickness,
                          .reach = flow_contact_reach(flow->model) * thickness.most,
                          .leaves_out =
                              flow_leaves_out(flow->model, args->side[1] >= flow->tables.n_blocks),
                          .attached = own.attached};
    flow_findings_open(call, near, list, args, counts, &m->findings);
    open_side(m, 0, &own, points, boxes);
    m->side[0].parts =
        flow_contact_mode(flow->model)->sweeps ? contact_enough(thickness.most) : -INFINITY;
    m->side[0].ridges = args->side[1] < flow->tables.n_blocks;
}

/* Keeps items of the list that did not move, in their order. */
static void keep_items(struct meeting *m)
{
    for (size_t i = 0; i < m->findings.before; i++)
        if (!flow_meeting_moved(m, &m->findings.near[i].contact))
            flow_findings_add(&m->findings, m->findings.near + i);
}

/* Fills the list; returns what the body does. other: the second side. */
static int query_meeting(struct meeting *m, const struct contact_side *other)
{
    keep_items(m);
    if (m->args->again)
        contact_query_moved(m->side, other, !m->moved[1], m->reach, flow_meeting_visit, m);
    else
        contact_query(m->side, other, m->reach, flow_meeting_visit, m);
    return flow_findings_close(&m->findings, m->passes);
}

FLOW_KERNEL(meet_self, FLOW_COLLIDE, struct flow_meet_args,
            (GIVEN_RW(near), GIVEN_SUM(meeting_counts), R(skin), R(skin_x), R(skin_boxes)))
{
    struct meeting m;
    begin_meeting(call, FLOW_INDEX_OF(meet_self, near), on->near, on->meeting_counts, on->args,
                  on->skin, on->skin_x, on->skin_boxes, &m);
    m.skin[1] = m.skin[0];
    m.area[1] = m.area[0];
    m.kin[1] = m.kin[0];
    m.moved[1] = m.moved[0];
    m.side[1] = m.side[0];
    m.side[0].flat = flow_meeting_kin_reach(&m);
    return query_meeting(&m, m.side);
}

FLOW_KERNEL(meet, FLOW_COLLIDE, struct flow_meet_args,
            (GIVEN_RW(near), GIVEN_SUM(meeting_counts), R(skin), R(skin_x), R(skin_boxes),
             GIVEN_R(other_skin), GIVEN_R(other_x), GIVEN_R(other_boxes)))
{
    struct meeting m;
    begin_meeting(call, FLOW_INDEX_OF(meet, near), on->near, on->meeting_counts, on->args, on->skin,
                  on->skin_x, on->skin_boxes, &m);
    const struct flow_skin other = flow_skin_open(on->other_skin);
    open_side(&m, 1, &other, on->other_x, on->other_boxes);
    m.side[0].flat = flow_meeting_kin_reach(&m);
    return query_meeting(&m, m.side + 1);
}

FLOW_KERNEL(meet_figure, FLOW_COLLIDE, struct flow_meet_args,
            (GIVEN_RW(near), GIVEN_SUM(meeting_counts), R(skin), R(skin_x), R(skin_boxes),
             R(body_skins), R(body_points), R(body_boxes), R(body_fans)))
{
    struct meeting m;
    begin_meeting(call, FLOW_INDEX_OF(meet_figure, near), on->near, on->meeting_counts, on->args,
                  on->skin, on->skin_x, on->skin_boxes, &m);
    const uint32_t number = on->args->side[1] - m.flow->tables.n_blocks;
    m.body = contact_bodies_at(&m.model->bodies, m.model->obstacles[number].body);
    m.fan = on->body_fans + flow_body_place(m.model, number).vertex;
    flow_body_open(m.model, number, on->body_skins, on->body_points, on->body_boxes, m.skin + 1,
                   m.side + 1);
    m.findings.n_points[1] = m.skin[1].n_points;
    return query_meeting(&m, m.side + 1);
}
