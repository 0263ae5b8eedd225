/* A block meets a convex shape: each of its triangles is certified on its way through the step.
 * Without certified contact it meets any obstacle, and only near points count.
 * Contacts are vertices near the shape at the end of the step, and places on edges and in triangles
 * that are nearer to it than their corners, such as the middle of a triangle on a corner of a
 * box. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/find.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/contact/skin.h"

#include "cloth/contact/push.h"
#include "cloth/contact/solid.h"

#include <math.h>

enum { APPROACHES = 8 }; /* steps of a search, which seldom takes more than two */

struct shape_meeting {
    const struct flow *flow;
    const struct model *model;
    const struct flow_meet_args *args;
    const struct contact_shape *shape;
    struct contact_pose pose;
    struct contact_solid solid;
    double way;                 /* m: that points of the shape go in the step at most */
    bool sweeps;                /* as the mode does (mode.h), */
    double reach;               /* thicknesses: and reaches */
    double far;                 /* m: with its thickest cloth */
    const unsigned char *moved; /* by point */
    uint32_t obstacle;          /* behind all cloths */
    const uint32_t *attached;   /* by point of the skin */
    const double *area;         /* likewise */
    struct contact_skin skin;
    const phys_vec *x, *y; /* by point */
    double h;              /* s: of the step */
    struct flow_findings findings;
    size_t passes; /* triangles in reach that are certified */
};

/* The shape and the cloth of n points. */
static const struct model_sides *sides_at(const struct shape_meeting *m, uint32_t n,
                                          const uint32_t *point)
{
    return flow_sides_of(m->flow, flow_cloth_of(&m->skin, n, point), m->obstacle);
}

static bool are_left_out(const struct shape_meeting *m, uint32_t n, const uint32_t *point)
{
    return sides_at(m, n, point)->friction < 0 ||
           flow_is_attached(m->attached, n, point, m->obstacle - m->flow->n_cloths);
}

/* Fills the contact of a point of the cloth, in zeroed memory: n corners at places, weights in
 * `on`. The begin of a step adds the shape's motion (flow_contact_ahead). */
static void describe_place(const struct shape_meeting *m, uint32_t n, const uint32_t *point,
                           const phys_vec *places, const struct contact_solid_point *on,
                           struct flow_near *near)
{
    struct flow_contact *to = &near->contact;
    const struct model_sides *sides = sides_at(m, n, point);
    to->kind = FLOW_CONTACT_SHAPE;
    to->first = to->at.n = n;
    to->row.normal = on->normal;
    to->row.gap = on->gap;
    to->row.thickness = sides->thickness;
    to->row.friction = sides->friction;
    for (int k = 0; k < 2; k++)
        to->side[k] = m->args->side[k];
    for (uint32_t k = 0; k < n; k++) {
        to->point[k] = point[k];
        to->at.block[k] = m->skin.block[point[k]];
        to->at.row[k] = m->skin.row[point[k]];
        to->at.weight[k] = on->weight[k];
        to->at.held |= (unsigned char)((m->skin.held[point[k]] != 0) << k);
        to->row.origin += on->weight[k] * places[k];
        to->row.hard += sides->pressure * on->weight[k] * m->area[point[k]];
        near->part[k] = 1;
    }
}

/* ---- The gap ahead ---- */

/* The gap at a point one step later, if point and shape move on as in this step; from the begin of
 * this step, the gap at its end. */
static double gap_of_place_ahead(const struct shape_meeting *m, const phys_vec *x,
                                 const phys_vec *y, const struct contact_solid_point *on)
{
    phys_vec way = -m->h * on->velocity;
    for (int k = 0; k < 3; k++)
        way += on->weight[k] * (y[k] - x[k]);
    return on->gap + phys_dot(&on->normal, &way);
}

/* ---- Triangles ---- */

/* Corners that fail alone are contacts of their own. */
static bool fails_alone(const struct shape_meeting *m, double thickness, const phys_vec x[3],
                        const phys_vec y[3])
{
    bool fails = false;
    for (int k = 0; k < 3; k++) {
        const phys_vec begin[3] = {x[k], x[k], x[k]}, end[3] = {y[k], y[k], y[k]};
        fails = fails || !contact_solid_certify(&m->solid, begin, end, thickness);
    }
    return fails;
}

/* Finds the pushes that bring corners out of the plane of the shape's nearest point, which moves
 * with it. */
static void push_place(const struct shape_meeting *m, uint32_t n, const phys_vec x[3],
                       const phys_vec y[3], const struct contact_solid_point *on,
                       struct flow_near *near)
{
    near->apart = contact_push_gap(on->gap, near->contact.row.thickness);
    phys_vec place = m->h * on->velocity;
    for (int k = 0; k < 3; k++)
        place += on->weight[k] * x[k];
    for (uint32_t k = 0; k < n; k++) {
        const phys_vec from = y[k] - place;
        const double gap = on->gap + phys_dot(&on->normal, &from);
        near->along[k] = near->contact.at.held >> k & 1 ? 0 : fmax(near->apart - gap, 0);
    }
}

/* on: at the step's begin. The parts stay 1 if no cut helps, as in meet.c. */
static void fail_place(struct shape_meeting *m, uint32_t n, const uint32_t *point,
                       const phys_vec x[3], const phys_vec y[3],
                       const struct contact_solid_point *on, struct flow_near *near)
{
    double part[3] = {1, 1, 1};
    describe_place(m, n, point, x, on, near);
    near->fails = true;
    near->contact.row.firm =
        contact_row_firm_for(&near->contact.row, gap_of_place_ahead(m, x, y, on));
    (void)contact_solid_cut(&m->solid, x, y, near->contact.row.thickness, near->contact.at.held,
                            part);
    for (uint32_t k = 0; k < n; k++)
        near->part[k] = part[k];
    push_place(m, n, x, y, on, near);
}

static void fail_triangle(struct shape_meeting *m, uint32_t triangle, const phys_vec x[3],
                          const phys_vec y[3])
{
    struct contact_solid_point on;
    struct flow_near near;
    memset(&near, 0, sizeof near); /* padding, too: lists are compared byte by byte */
    contact_solid_nearest(&m->solid, CONTACT_BEGIN, x, &on);
    fail_place(m, 3, m->skin.corner[triangle], x, y, &on, &near);
    near.presses = !fails_alone(m, near.contact.row.thickness, x, y);
    near.contact.feature[0] = triangle;
    near.contact.feature[1] = FLOW_ON_TRIANGLE;
    flow_findings_add(&m->findings, &near);
}

static void list_triangle(struct shape_meeting *m, uint32_t triangle, const phys_vec y[3])
{
    const double thickness = sides_at(m, 3, m->skin.corner[triangle])->thickness;
    struct contact_solid_point on;
    struct flow_near near;
    contact_solid_nearest(&m->solid, CONTACT_END, y, &on);
    if (on.feature < CONTACT_ON_EDGE || !(on.gap < m->reach * thickness))
        return;
    if (!m->sweeps && !(on.gap > 0))
        return; /* its corners know the way out */
    memset(&near, 0, sizeof near);
    describe_place(m, 3, m->skin.corner[triangle], y, &on, &near);
    near.contact.feature[0] = triangle;
    near.contact.feature[1] = FLOW_ON_TRIANGLE;
    if (!m->sweeps)
        near.contact.row.slip = (m->args->from - m->args->to) * on.velocity;
    flow_findings_add(&m->findings, &near);
}

static void look_at_triangle(struct shape_meeting *m, uint32_t triangle)
{
    const uint32_t *point = m->skin.corner[triangle];
    const phys_vec x[3] = {m->x[point[0]], m->x[point[1]], m->x[point[2]]};
    const phys_vec y[3] = {m->y[point[0]], m->y[point[1]], m->y[point[2]]};
    const double thickness = sides_at(m, 3, point)->thickness;
    const enum contact_passing passing =
        contact_solid_pass(&m->solid, x, y, thickness, m->reach * thickness);
    m->passes += passing == CONTACT_PASSES;
    if (passing == CONTACT_PASSES)
        list_triangle(m, triangle, y);
    else if (passing == CONTACT_MAY_TOUCH)
        fail_triangle(m, triangle, x, y);
}

/* ---- Vertices ---- */

/* A vertex is a triangle of three equal corners. */
static void find_vertex(const struct shape_meeting *m, enum contact_end end, const phys_vec x[3],
                        struct contact_solid_point *on)
{
    contact_solid_nearest(&m->solid, end, x, on);
    memcpy(on->weight, (const double[3]){1, 0, 0}, sizeof on->weight);
}

/* True if a vertex comes nearer than a contact reaches within the next step, if it and the shape
 * move on as in this step. The distance from a convex shape is a convex function of the way, so its
 * tangent at a place leads to a place that is not behind the first near one. A vertex that passes
 * beside the shape is no contact: the plane of its nearest point would hold it up. */
static bool comes_near(const struct shape_meeting *m, double thickness, const phys_vec *x,
                       const phys_vec *y, const struct contact_solid_point *on)
{
    const phys_vec way = *y - *x - m->h * on->velocity;
    struct contact_solid_point at = *on;
    double part = 0;
    for (int i = 0; i < APPROACHES; i++) {
        const double lacks = at.gap - thickness;
        const double rate = phys_dot(&at.normal, &way);
        part -= lacks / rate;
        if (!(rate < 0 && part < 1))
            return false;
        const phys_vec place = *y + part * way, triangle[3] = {place, place, place};
        find_vertex(m, CONTACT_END, triangle, &at);
        if (at.gap < m->reach * thickness)
            return true;
    }
    return true;
}

/* Lists a vertex at the step's end if it is near, or will be. */
static void list_vertex(struct shape_meeting *m, uint32_t point, const phys_vec x[3],
                        const phys_vec y[3], struct flow_near *near)
{
    const double thickness = sides_at(m, 1, &point)->thickness;
    struct contact_solid_point on;
    find_vertex(m, CONTACT_END, y, &on);
    if (!(on.gap < m->reach * thickness) && !comes_near(m, thickness, x, y, &on))
        return;
    describe_place(m, 1, &point, y, &on, near);
    if (on.gap > thickness)
        near->contact.row.firm =
            contact_row_firm_for(&near->contact.row, gap_of_place_ahead(m, x, y, &on));
    flow_findings_add(&m->findings, near);
}

static void meet_shape_look_at_vertex(struct shape_meeting *m, uint32_t vertex)
{
    const uint32_t point = m->skin.vertex[vertex];
    const phys_vec x[3] = {m->x[point], m->x[point], m->x[point]};
    const phys_vec y[3] = {m->y[point], m->y[point], m->y[point]};
    struct flow_near near;
    memset(&near, 0, sizeof near);
    near.contact.feature[0] = vertex;
    near.contact.feature[1] = FLOW_ON_VERTEX;
    if (contact_solid_certify(&m->solid, x, y, sides_at(m, 1, &point)->thickness)) {
        list_vertex(m, point, x, y, &near);
        return;
    }
    struct contact_solid_point on;
    find_vertex(m, CONTACT_BEGIN, x, &on);
    fail_place(m, 1, &point, x, y, &on, &near);
    near.presses = true;
    flow_findings_add(&m->findings, &near);
}

/* ---- Contact that is not certified ---- */

/* The shape's motion in the step is taken off the slip, as flow_contact_ahead does. */
static void list_place(struct shape_meeting *m, uint32_t vertex, const struct contact_hit *hit)
{
    const uint32_t point = m->skin.vertex[vertex];
    const struct contact_solid_point on = {.weight = {1}, .normal = hit->normal, .gap = hit->gap};
    struct flow_near near;
    if (!(hit->gap < m->reach * sides_at(m, 1, &point)->thickness))
        return;
    memset(&near, 0, sizeof near);
    describe_place(m, 1, &point, m->y + point, &on, &near);
    near.contact.feature[0] = vertex;
    near.contact.feature[1] = FLOW_ON_VERTEX;
    near.contact.row.slip = (m->args->from - m->args->to) * hit->velocity;
    flow_findings_add(&m->findings, &near);
}

/* Vertices are put out of obstacles. Those that follow each other are near to each other, so many
 * at once are found sooner. */
static void look_at_vertices(struct shape_meeting *m)
{
    enum { AT_ONCE = 64 };
    uint32_t vertex[AT_ONCE], n = 0;
    phys_vec place[AT_ONCE];
    struct contact_hit hit[AT_ONCE];
    for (uint32_t i = 0; i < m->skin.n_vertices; i++) {
        if (!are_left_out(m, 1, m->skin.vertex + i)) {
            vertex[n] = i;
            place[n++] = m->y[m->skin.vertex[i]];
        }
        if (n < AT_ONCE && i + 1 < m->skin.n_vertices)
            continue;
        contact_closest(m->shape, &m->pose, n, place, hit);
        for (uint32_t k = 0; k < n; k++)
            list_place(m, vertex[k], hit + k);
        n = 0;
    }
}

/* ---- All of a skin ---- */

/* True if points are out of the shape's reach in the step and, if they and the shape move on as in
 * this step, in the next one. So is all that lies between them. */
static bool are_apart(const struct shape_meeting *m, const struct contact_bunch *bunch)
{
    double low[3], high[3];
    contact_bunch_box(bunch, m->x, m->y, low, high);
    return contact_solid_apart(&m->solid, low, high, m->far + m->way);
}

/* True for features of n points that the last look at the step has seen as they are. */
static bool was_seen(const struct shape_meeting *m, uint32_t n, const uint32_t *point)
{
    bool moved = !m->args->again;
    for (uint32_t k = 0; k < n; k++)
        moved = moved || m->moved[point[k]];
    return !moved;
}

/* Looks at all triangles, or vertices, that may be in reach, if they were not seen. */
static void look_at_near(struct shape_meeting *m, bool vertices,
                         void (*look)(struct shape_meeting *m, uint32_t number))
{
    const uint32_t n = vertices ? 1 : 3;
    const uint32_t *point = vertices ? m->skin.vertex : *m->skin.corner;
    for (uint32_t i = 0; i < contact_bunches(&m->skin); i++) {
        struct contact_bunch bunch;
        contact_bunch_of(&m->skin, i, &bunch);
        if (!bunch.n_points || was_seen(m, bunch.n_points, bunch.point) || are_apart(m, &bunch))
            continue;
        const uint32_t from = vertices ? bunch.vertex : bunch.triangle;
        const uint32_t end = from + (vertices ? bunch.n_vertices : bunch.n_triangles);
        for (uint32_t k = from; k < end; k++) {
            const uint32_t *at = point + (size_t)n * k;
            if (!was_seen(m, n, at) && !are_left_out(m, n, at))
                look(m, k);
        }
    }
}

static void list_still_triangle(struct shape_meeting *m, uint32_t triangle)
{
    const uint32_t *point = m->skin.corner[triangle];
    const phys_vec y[3] = {m->y[point[0]], m->y[point[1]], m->y[point[2]]};
    list_triangle(m, triangle, y);
}

/* Edges and triangles that are near a shape from outside; of bodies vertices alone count. */
static void look_at_places(struct shape_meeting *m)
{
    if (!m->shape->body)
        look_at_near(m, false, list_still_triangle);
    look_at_vertices(m);
}

static void meet_shape_look_at(struct shape_meeting *m)
{
    look_at_near(m, false, look_at_triangle);
    look_at_near(m, true, meet_shape_look_at_vertex);
}

/* Keeps items of the list that did not move, as in meet.c. */
static void keep_places(struct shape_meeting *m)
{
    const struct flow_near *near = m->findings.near;
    for (size_t i = 0; i < m->findings.before; i++)
        if (was_seen(m, near[i].contact.at.n, near[i].contact.point))
            flow_findings_add(&m->findings, near + i);
}

/* ---- The task ---- */

FLOW_KERNEL(meet_shape, FLOW_COLLIDE, struct flow_meet_args,
            (GIVEN_RW(near), GIVEN_SUM(meeting_counts), R(skin), R(skin_x), R(skin_boxes)))
{
    const struct flow_meet_args *args = on->args;
    const struct flow *flow = flow_of(call);
    const double most = flow_thickness_of(flow, args->side[0], args->side[1]).most,
                 reach = flow_contact_reach(flow->model);
    const struct contact_shape *shape =
        flow->model->obstacles + (args->side[1] - flow->tables.n_blocks);
    struct shape_meeting m = {.flow = flow,
                              .model = flow->model,
                              .sweeps = flow_contact_mode(flow->model)->sweeps,
                              .reach = reach,
                              .far = reach * most,
                              .args = args,
                              .obstacle = flow->n_cloths + (args->side[1] - flow->tables.n_blocks),
                              .shape = shape,
                              .h = args->to - args->from};
    flow_findings_open(call, FLOW_INDEX_OF(meet_shape, near), on->near, args, on->meeting_counts,
                       &m.findings);
    contact_pose_over(shape, flow->model->keys, &flow->model->bodies, args->from, args->to,
                      &m.pose);
    contact_solid_make(shape, &m.pose, &m.solid);
    m.way = contact_solid_way(&m.solid);
    const struct flow_skin skin = flow_skin_open(on->skin);
    m.skin = skin.skin;
    m.findings.n_points[0] = m.skin.n_points;
    m.attached = skin.attached;
    m.area = skin.area;
    m.x = on->skin_x;
    m.y = m.x + m.skin.n_points;
    m.moved = contact_moved_points(&m.skin, on->skin_boxes);
    keep_places(&m);
    if (m.sweeps)
        meet_shape_look_at(&m);
    else
        look_at_places(&m);
    return flow_findings_close(&m.findings, m.passes);
}
