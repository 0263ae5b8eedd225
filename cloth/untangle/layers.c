/* Triangles of a cloth are counterclockwise as seen from its outer side. Each vertex of an outer
 * cloth that has an inner cloth near it must be on the inner cloth's outer side. It has no side if
 * the nearest place of the inner cloth is its border. The inner cloth does not move. */
#include "cloth/untangle/state.h"

#include <string.h>

static bool layers_is_of(const struct untangle *all, uint32_t triangle, const void *context)
{
    return all->owner[triangle] == *(const uint32_t *)context;
}

bool untangle_beside(const struct untangle *all, uint32_t point, uint32_t cloth,
                     struct untangle_nearest *at, phys_vec *normal)
{
    const double reach = UNTANGLE_REACH * all->of->thickness;
    if (!untangle_find(all, all->x + point, reach, layers_is_of, &cloth, at))
        return false;
    bool border = true;
    *normal = (phys_vec){0};
    for (int k = 0; k < 3; k++) {
        const uint32_t corner = all->corner[at->triangle][k];
        const double weight = -at->at.weight[1 + k];
        border = border && (all->border[corner] || !(weight > 0));
        *normal += weight * all->normal[corner];
    }
    return !border && untangle_unit(normal);
}

enum { TRIANGLE = 7 << 1 }; /* its corners, of a push whose corner 0 is a vertex */

int untangle_push_vertex(struct untangle *all, uint32_t point, const struct untangle_nearest *at,
                         const phys_vec *normal, bool still)
{
    struct untangle_push push = {
        .n = 4, .still = still ? TRIANGLE : 0, .want = all->room, .normal = *normal};
    for (uint32_t k = 0; k < 4; k++) {
        push.point[k] = k ? all->corner[at->triangle][k - 1] : point;
        push.weight[k] = at->at.weight[k];
    }
    return untangle_add(all, &push);
}

/* Pushes an end of an edge and the triangle that the edge crosses apart along the normal, at the
 * crossing. side 1: the end that lies less far along the normal goes along it. side -1: the
 * triangle goes along it, away from the end that lies farther. */
static int push_end(struct untangle *all, const struct untangle_crossing *crossing,
                    const phys_vec *normal, double side, uint32_t still)
{
    const uint32_t *end = all->edge[crossing->edge].end, *corner = all->corner[crossing->triangle];
    const phys_vec along = all->x[end[1]] - all->x[end[0]];
    double weight[UNTANGLE_CORNERS];
    untangle_place(all, crossing, weight);
    struct untangle_push push = {.n = 4,
                                 .point = {end[side * phys_dot(&along, normal) < 0]},
                                 .still = still,
                                 .weight = {side},
                                 .want = all->room,
                                 .normal = *normal};
    for (int k = 0; k < 3; k++) {
        push.point[1 + k] = corner[k];
        push.weight[1 + k] = -side * weight[2 + k];
    }
    return untangle_add(all, &push);
}

int untangle_push_edge(struct untangle *all, const struct untangle_crossing *crossing, double sign,
                       bool still)
{
    phys_vec normal;
    untangle_face(all, crossing->triangle, &normal);
    normal *= sign;
    return push_end(all, crossing, &normal, 1, still ? TRIANGLE : 0);
}

int untangle_push_triangle(struct untangle *all, const struct untangle_crossing *crossing,
                           double sign, bool still)
{
    const uint32_t *end = all->edge[crossing->edge].end;
    phys_vec normal = sign * (all->normal[end[0]] + all->normal[end[1]]);
    return untangle_unit(&normal) ? push_end(all, crossing, &normal, -1, still) : CLOTH_OK;
}

static int layers_look_at_vertex(struct untangle *all, uint32_t point, uint32_t inner)
{
    struct untangle_nearest at;
    phys_vec normal;
    if (!untangle_beside(all, point, inner, &at, &normal))
        return CLOTH_OK;
    const double height = at.at.gap * phys_dot(&normal, &at.at.normal);
    const uint32_t piece = all->piece[all->corner[at.triangle][0]];
    all->sides[piece][height < 0]++;
    if (height < 0)
        all->outer[piece] = all->cloth[point];
    if (!(height < all->open))
        return CLOTH_OK;
    all->count.layers++;
    return untangle_push_vertex(all, point, &at, &normal, true);
}

static int push_crossings(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    int code = CLOTH_OK;
    for (size_t i = 0; i < all->crossings.n && !code; i++) {
        const uint32_t edge = all->edge[crossing[i].edge].owner;
        const uint32_t triangle = all->owner[crossing[i].triangle];
        if (!untangle_layered(all, edge, triangle))
            continue;
        code = all->of->layer[edge] > all->of->layer[triangle]
                   ? untangle_push_edge(all, crossing + i, 1, true)
                   : untangle_push_triangle(all, crossing + i, 1, true);
    }
    return code;
}

/* A point shared by cloths is on no side of them. */
int untangle_layers(struct untangle *all)
{
    const uint32_t *layer = all->of->layer;
    all->count.layers = 0;
    memset(all->sides, 0, all->n_cloth_points * sizeof *all->sides);
    int code = push_crossings(all);
    for (uint32_t inner = 0; inner < all->n_cloths; inner++)
        for (uint32_t p = 0; p < all->n_cloth_points && !code; p++)
            if (all->used[p] && !all->shared[p] && layer[all->cloth[p]] > layer[inner] &&
                untangle_meets(all, all->cloth[p], inner))
                code = layers_look_at_vertex(all, p, inner);
    return code;
}

void untangle_turned(const struct untangle *all, struct untangle_result *result)
{
    for (uint32_t piece = 0; piece < all->n_cloth_points; piece++) {
        if (all->sides[piece][1] <= all->sides[piece][0] || result->n_turned++ >= UNTANGLE_TURNED)
            continue;
        struct untangle_turned *turned = result->turned + result->n_turned - 1;
        *turned = (struct untangle_turned){.point = piece, .outer = all->outer[piece]};
        for (uint32_t p = piece; p < all->n_cloth_points; p++)
            turned->n += all->piece[p] == piece;
    }
}
