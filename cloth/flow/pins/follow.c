/* Pins that follow obstacles. A rigid obstacle takes its vertices along by its motion. One with
 * frames changes its shape: each vertex gets an anchor on it, whose number stands behind those of
 * motions. An anchor is a point of a triangle, and an offset in the triangle's axes: its first
 * edge, the direction across it in the plane, and the normal. Both turn with the triangle. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/contact/pair.h"

#include <math.h>
#include <stdlib.h>

static const struct contact_body *pins_follow_body_of(const struct model *model, uint32_t obstacle)
{
    return contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
}

/* Moves a vertex by the frames, then by the motion of the obstacle. */
static void place_vertex(const struct model *model, uint32_t obstacle, uint32_t vertex, double time,
                         phys_vec *to)
{
    const struct contact_shape *shape = model->obstacles + obstacle;
    contact_body_vertex_place(pins_follow_body_of(model, obstacle), time, vertex, to);
    if (shape->n) {
        struct phys_pose pose;
        phys_pose_at(shape->n, model->keys + shape->first, shape->about, time, &pose);
        phys_pose_point(&pose, to, to);
    }
}

static void place_all(const struct model *model, uint32_t obstacle, phys_vec *place)
{
    for (uint32_t v = 0; v < pins_follow_body_of(model, obstacle)->n_vertices; v++)
        place_vertex(model, obstacle, v, 0, place + v);
}

/* Makes a vector one of length 1; one of length 0 becomes another. */
static void normalise_axis(phys_vec *x, const phys_vec *other)
{
    const double square = phys_dot(x, x);
    *x = square > 0 ? *x / sqrt(square) : *other;
}

/* The axes of a triangle. Without area it gets any axes, which do not turn with it. */
static void find_axes(const phys_vec x[3], phys_vec axis[3])
{
    const phys_vec first = {1, 0, 0, 0}, last = {0, 0, 1, 0}, side = x[2] - x[0];
    axis[0] = x[1] - x[0];
    phys_cross(axis, &side, axis + 2);
    normalise_axis(axis, &first);
    normalise_axis(axis + 2, &last);
    phys_cross(axis + 2, axis, axis + 1);
}

/* Finds the anchor of a vertex at x, m, when a run starts: the nearest point of the body, of equals
 * that of the first facet. place: the body's vertices at the start. */
static void find_anchor(const struct model *model, uint32_t obstacle, const phys_vec *place,
                        const phys_vec *x, struct flow_anchor *anchor)
{
    const struct contact_body *body = pins_follow_body_of(model, obstacle);
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

static uint32_t followed_by(const struct flow_particles *p, const struct model *model, uint32_t v)
{
    return p->motion[v] ? model->motions[p->motion[v] - 1].follow : 0;
}

static bool has_frames(const struct model *model, uint32_t obstacle)
{
    return pins_follow_body_of(model, obstacle) && pins_follow_body_of(model, obstacle)->n_frames;
}

/* The obstacle, from 1, that a soft pin follows; 0: none. */
static uint32_t pulled_along(const struct model *model, const struct flow_soft *soft)
{
    return soft->motion ? model->motions[soft->motion - 1].follow : 0;
}

/* Marks all vertices that pins hold to an obstacle, and those welded to them. Takes room for the
 * anchors of these, and of soft pins that follow. */
static int mark_followers(struct flow_particles *p, const struct model *model,
                          struct cloth_error *error)
{
    p->attached = cloth_alloc(p->n, sizeof *p->attached, error);
    if (!p->attached)
        return CLOTH_E_MEMORY;
    size_t n = p->soft.n;
    for (uint32_t v = 0; v < p->n; v++) {
        p->attached[v] = followed_by(p, model, flow_root(&p->welds, v));
        n += p->attached[v] != 0;
    }
    p->anchor = cloth_take(&p->memory, n, sizeof *p->anchor, error);
    return p->anchor ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* Adds the anchor of a vertex on an obstacle, whose vertices are at `place`. Returns its number
 * among motions. */
static uint32_t add_anchor(struct flow_particles *p, const struct model *model, uint32_t obstacle,
                           const phys_vec *place, struct flow_cloths *at, uint32_t vertex)
{
    phys_vec x;
    flow_source_cloth(at, model, vertex);
    flow_start_place(p, model->cloths + at->cloth, at->first, vertex - at->first, &x);
    find_anchor(model, obstacle, place, &x, p->anchor + p->n_anchors);
    return model->n_motions + ++p->n_anchors;
}

/* Adds the anchors of an obstacle: of vertices that are held, then of soft pins. */
static void add_anchors(struct flow_particles *p, const struct model *model, uint32_t obstacle,
                        const phys_vec *place)
{
    struct flow_cloths at = {0};
    struct flow_soft *soft = p->soft.items;
    for (uint32_t v = 0; v < p->n; v++)
        if (p->attached[v] == obstacle + 1 && flow_root(&p->welds, v) == v)
            p->motion[v] = add_anchor(p, model, obstacle, place, &at, v);
    for (size_t i = 0; i < p->soft.n; i++)
        if (soft[i].motion <= model->n_motions && pulled_along(model, soft + i) == obstacle + 1)
            soft[i].motion = add_anchor(p, model, obstacle, place, &at, soft[i].at);
}

static int anchor_all(struct flow_particles *p, const struct model *model, uint32_t obstacle,
                      struct cloth_error *error)
{
    struct cloth_pool memory = {0};
    const uint32_t n = pins_follow_body_of(model, obstacle)->n_vertices;
    phys_vec *place = cloth_take(&memory, n, sizeof *place, error);
    if (place) {
        place_all(model, obstacle, place);
        add_anchors(p, model, obstacle, place);
    }
    cloth_pool_free(&memory);
    return place ? CLOTH_OK : CLOTH_E_MEMORY;
}

int flow_follow_make(struct flow_particles *p, const struct model *model, struct cloth_error *error)
{
    int code = model_follows(model) ? mark_followers(p, model, error) : CLOTH_OK;
    for (uint32_t i = 0; i < model->n_obstacles && p->attached && !code; i++)
        if (has_frames(model, i))
            code = anchor_all(p, model, i, error);
    return code;
}
