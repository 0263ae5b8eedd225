/* A block meets a convex shape: each of its triangles is certified on its way through the step.
 * Vertices near the shape at the end of the step are contacts, and so are places on edges and in
 * triangles that are nearer to it than their corners: a corner of a box under the middle of a
 * triangle is one. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/state/skin.h"

#include "cloth/contact/solid.h"

#include <math.h>

struct meeting {
    const struct flow *flow;
    const struct model *model;
    const struct flow_meet_args *args;
    struct contact_solid solid;
    double friction; /* of the shape */
    struct contact_skin skin;
    const phys_vec *x, *y; /* by point */
    struct flow_near *near;
    size_t n, room; /* found; there is room for */
    double *counts;
};

static void append(struct meeting *m, const struct flow_near *near)
{
    if (m->n < m->room)
        m->near[m->n] = *near;
    m->n++;
    m->counts[FLOW_COUNT_FAILS] += near->fails;
    m->counts[FLOW_COUNT_FIRST]++;
}

/* What is kept of a point of the cloth, in memory that is zero: n corners at places, whose weights
 * `on` has. What follows of the shape's place is found when a step begins (flow_contact_ahead). */
static void describe(const struct meeting *m, uint32_t n, const uint32_t *point,
                     const phys_vec *places, const struct contact_solid_point *on,
                     struct flow_near *near)
{
    struct flow_contact *to = &near->contact;
    to->kind = FLOW_CONTACT_SHAPE;
    to->first = to->at.n = n;
    to->row.normal = on->normal;
    to->row.gap = on->gap;
    to->row.thickness = m->model->contact.thickness;
    to->row.friction = sqrt(m->friction * flow_friction_of(m->flow, &m->skin, point[0]));
    for (int k = 0; k < 2; k++)
        to->side[k] = m->args->side[k];
    for (uint32_t k = 0; k < n; k++) {
        to->point[k] = point[k];
        to->at.block[k] = m->skin.block[point[k]];
        to->at.row[k] = m->skin.row[point[k]];
        to->at.weight[k] = on->weight[k];
        to->at.held |= (unsigned char)((m->skin.held[point[k]] != 0) << k);
        to->row.origin += on->weight[k] * places[k];
        near->part[k] = 1;
    }
}

/* ---- Triangles ---- */

static void fail(struct meeting *m, uint32_t triangle, const phys_vec x[3], const phys_vec y[3])
{
    const uint32_t *point = m->skin.corner[triangle];
    struct contact_solid_point on;
    struct flow_near near;
    memset(&near, 0, sizeof near); /* padding, too: lists are compared byte by byte */
    contact_solid_nearest(&m->solid, CONTACT_BEGIN, x, &on);
    describe(m, 3, point, x, &on, &near);
    near.fails = true;
    near.contact.feature[0] = triangle;
    near.contact.feature[1] = FLOW_ON_TRIANGLE;
    contact_solid_cut(&m->solid, x, y, m->model->contact.thickness, near.contact.at.held,
                      near.part);
    append(m, &near);
}

static void list_triangle(struct meeting *m, uint32_t triangle, const phys_vec y[3])
{
    struct contact_solid_point on;
    struct flow_near near;
    contact_solid_nearest(&m->solid, CONTACT_END, y, &on);
    if (on.feature < CONTACT_ON_EDGE || !(on.gap < flow_contact_reach(m->model)))
        return;
    memset(&near, 0, sizeof near);
    describe(m, 3, m->skin.corner[triangle], y, &on, &near);
    near.contact.feature[0] = triangle;
    near.contact.feature[1] = FLOW_ON_TRIANGLE;
    append(m, &near);
}

static void look_at_triangle(struct meeting *m, uint32_t triangle)
{
    const uint32_t *point = m->skin.corner[triangle];
    const phys_vec x[3] = {m->x[point[0]], m->x[point[1]], m->x[point[2]]};
    const phys_vec y[3] = {m->y[point[0]], m->y[point[1]], m->y[point[2]]};
    const enum contact_passing passing = contact_solid_pass(
        &m->solid, x, y, m->model->contact.thickness, flow_contact_reach(m->model));
    if (passing == CONTACT_PASSES)
        list_triangle(m, triangle, y);
    else if (passing == CONTACT_MAY_TOUCH)
        fail(m, triangle, x, y);
}

/* ---- Vertices ---- */

static void look_at_vertex(struct meeting *m, uint32_t vertex)
{
    const uint32_t point = m->skin.vertex[vertex];
    const phys_vec y[3] = {m->y[point], m->y[point], m->y[point]};
    struct contact_solid_point on;
    struct flow_near near;
    contact_solid_nearest(&m->solid, CONTACT_END, y, &on);
    if (!(on.gap < flow_contact_reach(m->model)))
        return;
    on.weight[0] = 1;
    memset(&near, 0, sizeof near);
    describe(m, 1, &point, y, &on, &near);
    near.contact.feature[0] = vertex;
    near.contact.feature[1] = FLOW_ON_VERTEX;
    append(m, &near);
}

/* ---- The task ---- */

/* Parameters: w the list, cw the counts, r the skin, its points. */
enum { AT_LIST, AT_COUNTS, AT_SKIN, AT_POINTS };

static int meet(const duite_call *call)
{
    const struct flow_meet_args *args = call->args;
    const struct flow *flow = flow_of(call);
    const struct contact_shape *shape =
        flow->model->obstacles + (args->side[1] - flow->tables.n_blocks);
    struct flow_list *list = duite_out(call, AT_LIST, struct flow_list);
    struct contact_pose pose;
    contact_pose_over(shape, flow->model->keys, &flow->model->bodies, args->from, args->to, &pose);
    struct meeting m = {.flow = flow,
                        .model = flow->model,
                        .args = args,
                        .friction = shape->friction,
                        .near = (struct flow_near *)(list + 1),
                        .room = args->room,
                        .counts = duite_out(call, AT_COUNTS, double) +
                                  (size_t)FLOW_COUNTS * args->number};
    contact_solid_make(shape, &pose, &m.solid);
    m.skin = flow_skin_open(duite_in(call, AT_SKIN, unsigned char)).skin;
    m.x = duite_in(call, AT_POINTS, phys_vec);
    m.y = m.x + m.skin.n_points;
    for (uint32_t i = 0; i < m.skin.n_triangles; i++)
        look_at_triangle(&m, i);
    for (uint32_t i = 0; i < m.skin.n_vertices; i++)
        look_at_vertex(&m, i);
    m.counts[FLOW_COUNT_ALL] = (double)m.n;
    *list = (struct flow_list){.n = m.n < m.room ? m.n : m.room,
                               .side = {args->side[0], args->side[1]}};
    return duite_resize(call, AT_LIST, flow_list_bytes(list->n, sizeof *m.near));
}

static int meet_timed(const duite_call *call)
{
    return flow_timed(call, meet, FLOW_COLLIDE);
}
const duite_kernel flow_meet_shape = {.name = "meet_shape",
                                      .body = meet_timed,
                                      .access = {DUITE_W, DUITE_CW},
                                      .law = {NULL, &duite_sum},
                                      .variadic = DUITE_R,
                                      .args_size = sizeof(struct flow_meet_args)};

/* ---- What a contact is in the step to come ---- */

void flow_contact_ahead(const struct flow *flow, double from, double to,
                        const struct flow_contact *contact, struct contact_row *row)
{
    const struct model *model = flow->model;
    const phys_vec x[3] = {row->origin, row->origin, row->origin};
    struct contact_solid solid;
    struct contact_pose pose;
    struct contact_solid_point on;
    if (contact->side[1] < flow->tables.n_blocks)
        return;
    if (contact->kind != FLOW_CONTACT_SHAPE) {
        flow_body_ahead(flow, from, to, contact, row);
        return;
    }
    const struct contact_shape *shape =
        model->obstacles + (contact->side[1] - flow->tables.n_blocks);
    contact_pose_over(shape, model->keys, &model->bodies, from, to, &pose);
    contact_solid_make(shape, &pose, &solid);
    contact_solid_nearest(&solid, CONTACT_BEGIN, x, &on);
    const phys_vec carried = (to - from) * on.velocity;
    row->normal = on.normal;
    row->gap = on.gap - phys_dot(&on.normal, &carried);
    row->slip -= carried;
}
