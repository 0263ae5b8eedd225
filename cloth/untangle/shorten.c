/* The crossing of an edge and a triangle is a point of the contour of an intersection. The contour
 * goes on along the triangles that have the edge, in directions R. Moving the edge by D against the
 * triangle, whose normal is N, moves the point along the edge E. This shortens the contour by
 *
 *     D . sum over R of (R - (R.E) / (N.E) N)
 *
 * (Volino & Magnenat-Thalmann 2006, equation 5). D points along that sum. Its length is a step, a
 * full one if the sum is long. */
#include "cloth/untangle/state.h"

/* The sum; false: there is none. */
static bool find_gradient(const struct untangle *all, const struct untangle_crossing *crossing,
                          phys_vec *gradient)
{
    const struct untangle_edge *edge = all->edge + crossing->edge;
    phys_vec normal, along = all->x[edge->end[1]] - all->x[edge->end[0]];
    *gradient = (phys_vec){0};
    untangle_face(all, crossing->triangle, &normal);
    const double slope = untangle_unit(&along) ? phys_dot(&along, &normal) : 0;
    if (!(fabs(slope) > 1e-6))
        return false;
    for (int k = 0; k < 2 && edge->opposite[k] != UNTANGLE_NONE; k++) {
        const phys_vec to = all->x[edge->opposite[k]] - all->x[edge->end[0]];
        const phys_vec across = to - phys_dot(&to, &along) * along;
        phys_vec face, line;
        phys_cross(&along, &across, &face);
        phys_cross(&face, &normal, &line);
        if (!untangle_unit(&line))
            continue;
        if (phys_dot(&line, &across) < 0)
            line = -line;
        *gradient += line - phys_dot(&line, &along) / slope * normal;
    }
    return true;
}

static int push_edge(struct untangle *all, const struct untangle_crossing *crossing)
{
    phys_vec gradient;
    if (!find_gradient(all, crossing, &gradient))
        return CLOTH_OK;
    const double square = phys_dot(&gradient, &gradient);
    if (!untangle_unit(&gradient))
        return CLOTH_OK;
    struct untangle_push push = {.n = UNTANGLE_CORNERS,
                                 .want = all->of->thickness * sqrt(square / (1 + square)),
                                 .normal = gradient};
    untangle_place(all, crossing, push.weight);
    for (uint32_t k = 0; k < push.n; k++) {
        push.point[k] =
            k < 2 ? all->edge[crossing->edge].end[k] : all->corner[crossing->triangle][k - 2];
        if (k >= 2)
            push.weight[k] = -push.weight[k];
    }
    return untangle_add(all, &push);
}

/* True if another kind of push moves its points in the round. */
static bool is_pushed(const struct untangle *all, const struct untangle_crossing *crossing)
{
    const struct untangle_edge *edge = all->edge + crossing->edge;
    const uint32_t owner = all->owner[crossing->triangle];
    bool is = untangle_layered(all, edge->owner, owner) || untangle_zoned(all, edge->owner, owner);
    for (int k = 0; k < 2; k++)
        is = is || all->wrong[edge->end[k]] || all->inside[edge->end[k]];
    for (int k = 0; k < 3; k++) {
        const uint32_t corner = all->corner[crossing->triangle][k];
        is = is || all->wrong[corner] || all->inside[corner];
    }
    return is;
}

int untangle_shorten(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    int code = CLOTH_OK;
    for (size_t i = 0; i < all->crossings.n && !code; i++)
        if (!is_pushed(all, crossing + i))
            code = push_edge(all, crossing + i);
    return code;
}
