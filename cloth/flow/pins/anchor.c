/* The axes of a triangle are its first edge, the direction across it in the plane, and the normal.
 * They turn with the triangle, and so does an offset in them. */
#include "cloth/flow/pins/anchor.h"

#include "cloth/contact/pair.h"

#include <math.h>

static const struct contact_body *body_of(const struct model *model, uint32_t obstacle)
{
    return contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
}

/* Moves a vertex by the frames, then by the motion of the obstacle. */
static void place_vertex(const struct model *model, uint32_t obstacle, uint32_t vertex, double time,
                         phys_vec *to)
{
    const struct contact_shape *shape = model->obstacles + obstacle;
    contact_body_vertex_place(body_of(model, obstacle), time, vertex, to);
    if (shape->n) {
        struct phys_pose pose;
        phys_pose_at(shape->n, model->keys + shape->first, shape->about, time, &pose);
        phys_pose_point(&pose, to, to);
    }
}

void flow_anchor_places(const struct model *model, uint32_t obstacle, phys_vec *place)
{
    for (uint32_t v = 0; v < body_of(model, obstacle)->n_vertices; v++)
        place_vertex(model, obstacle, v, 0, place + v);
}

static void cross(const phys_vec *a, const phys_vec *b, phys_vec *to)
{
    const phys_vec u = *a, v = *b;
    *to = (phys_vec){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                     u[0] * v[1] - u[1] * v[0], 0};
}

/* Makes a vector one of length 1; one of length 0 becomes another. */
static void normalise(phys_vec *x, const phys_vec *other)
{
    const double square = phys_dot(x, x);
    *x = square > 0 ? *x / sqrt(square) : *other;
}

/* The axes of a triangle. Without area it gets any axes, which do not turn with it. */
static void find_axes(const phys_vec x[3], phys_vec axis[3])
{
    const phys_vec first = {1, 0, 0, 0}, last = {0, 0, 1, 0}, side = x[2] - x[0];
    axis[0] = x[1] - x[0];
    cross(axis, &side, axis + 2);
    normalise(axis, &first);
    normalise(axis + 2, &last);
    cross(axis + 2, axis, axis + 1);
}

void flow_anchor_find(const struct model *model, uint32_t obstacle, const phys_vec *place,
                      const phys_vec *x, struct flow_anchor *anchor)
{
    const struct contact_body *body = body_of(model, obstacle);
    const struct contact_facet *facet = contact_body_facets(body);
    double least = INFINITY;
    phys_vec axis[3], way = *x;
    *anchor = (struct flow_anchor){.obstacle = obstacle};
    for (uint32_t f = 0; f < body->n_triangles; f++) {
        const uint32_t *corner = facet[f].corner;
        const phys_vec at[4] = {*x, place[corner[0]], place[corner[1]], place[corner[2]]};
        struct contact_nearest nearest;
        contact_nearest_of(CONTACT_VT, at, &nearest);
        if (!(nearest.gap < least))
            continue;
        least = nearest.gap;
        for (int k = 0; k < 3; k++) {
            anchor->corner[k] = corner[k];
            anchor->weight[k] = -nearest.weight[k + 1];
        }
    }
    const phys_vec at[3] = {place[anchor->corner[0]], place[anchor->corner[1]],
                            place[anchor->corner[2]]};
    find_axes(at, axis);
    for (int k = 0; k < 3; k++)
        way -= anchor->weight[k] * at[k];
    for (int k = 0; k < 3; k++)
        anchor->offset[k] = phys_dot(&way, axis + k);
}

void flow_anchor_place(const struct model *model, const struct flow_anchor *anchor, double time,
                       phys_vec *to)
{
    phys_vec at[3], axis[3];
    for (int k = 0; k < 3; k++)
        place_vertex(model, anchor->obstacle, anchor->corner[k], time, at + k);
    find_axes(at, axis);
    *to = (phys_vec){0};
    for (int k = 0; k < 3; k++)
        *to += anchor->weight[k] * at[k] + anchor->offset[k] * axis[k];
}
