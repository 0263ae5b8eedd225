/* Vertices in an obstacle, or nearly at it, go out the shortest way. A triangle that meets a convex
 * shape between its vertices goes out as a whole. For bodies, crossings find such triangles. */
#include "cloth/contact/solid.h"
#include "cloth/untangle/state.h"

#include <string.h>

static void push_vertex(struct untangle *all, uint32_t point, const struct contact_hit *hit)
{
    const struct untangle_push push = {.n = 1,
                                       .point = {point},
                                       .weight = {1},
                                       .want = phys_dot(&hit->normal, all->x + point) + all->room -
                                               hit->gap,
                                       .normal = hit->normal};
    all->count.entered++;
    all->inside[point] = 1;
    untangle_add(all, &push);
}

static void push_triangle(struct untangle *all, uint32_t triangle,
                          const struct contact_solid_point *at)
{
    struct untangle_push push = {.n = 3, .want = all->room - at->gap, .normal = at->normal};
    all->count.entered++;
    for (int k = 0; k < 3; k++) {
        push.point[k] = all->corner[triangle][k];
        push.weight[k] = at->weight[k];
        push.want += at->weight[k] * phys_dot(&at->normal, all->x + push.point[k]);
    }
    untangle_add(all, &push);
}

/* Pushes a vertex out that is too deep; true if it was. The caller looks at each vertex once. */
static bool untangle_obstacles_look_at_vertex(struct untangle *all, size_t obstacle, uint32_t point)
{
    struct contact_hit hit;
    const uint32_t owner = all->n_cloths + (uint32_t)obstacle;
    if (!untangle_meets(all, all->cloth[point], owner) || untangle_attached(all, 1, &point, owner))
        return false;
    contact_closest(all->of->obstacles + obstacle, &all->body[obstacle].pose, 1, all->x + point,
                    &hit);
    if (!(hit.gap < all->open))
        return false;
    push_vertex(all, point, &hit);
    return true;
}

enum { SEEN = 1, DEEP };

static int untangle_obstacles_look_at_shape(struct untangle *all, size_t obstacle)
{
    const struct contact_shape *shape = all->of->obstacles + obstacle;
    struct contact_solid solid;
    contact_solid_make(shape, &all->body[obstacle].pose, &solid);
    memset(all->seen, 0, all->n_points);
    for (uint32_t t = 0; t < all->n_cloth_triangles && !all->error->code; t++) {
        const uint32_t *corner = all->corner[t];
        const phys_vec x[3] = {all->x[corner[0]], all->x[corner[1]], all->x[corner[2]]};
        if (!untangle_meets(all, all->owner[t], all->n_cloths + (uint32_t)obstacle) ||
            contact_solid_pass(&solid, x, x, all->of->thickness, all->open) == CONTACT_PASSES_BY)
            continue;
        bool deep = false;
        for (int k = 0; k < 3; k++) {
            unsigned char *seen = all->seen + corner[k];
            if (!*seen)
                *seen = untangle_obstacles_look_at_vertex(all, obstacle, corner[k]) ? DEEP : SEEN;
            deep = deep || *seen == DEEP;
        }
        struct contact_solid_point at;
        contact_solid_nearest(&solid, CONTACT_BEGIN, x, &at);
        if (!deep && at.gap < all->open &&
            !untangle_attached(all, 3, corner, all->n_cloths + (uint32_t)obstacle))
            push_triangle(all, t, &at);
    }
    return all->error->code;
}

static int untangle_obstacles_look_at_body(struct untangle *all, size_t obstacle)
{
    for (uint32_t p = 0; p < all->n_cloth_points && !all->error->code; p++)
        if (all->used[p])
            untangle_obstacles_look_at_vertex(all, obstacle, p);
    return all->error->code;
}

int untangle_obstacles(struct untangle *all)
{
    int code = CLOTH_OK;
    all->count.entered = 0;
    memset(all->inside, 0, all->n_points);
    for (size_t i = 0; i < all->n_obstacles && !code; i++)
        code = all->body[i].body ? untangle_obstacles_look_at_body(all, i)
                                 : untangle_obstacles_look_at_shape(all, i);
    return code;
}
