/* Finds the edges that go through triangles, from the exact pairs of triangles that intersect. An
 * edge of two triangles is found by both, and listed once. */
#include "cloth/base/order.h"
#include "cloth/untangle/state.h"
#include "cloth/verify/orient.h"

#include <stdlib.h>
#include <string.h>

static bool shares(const uint32_t *corner, const uint32_t end[2])
{
    bool shared = false;
    for (int k = 0; k < 3; k++)
        shared = shared || corner[k] == end[0] || corner[k] == end[1];
    return shared;
}

/* False if edge and triangle lie in one plane: there is no way through. */
static bool goes_through(const struct untangle *all, uint32_t edge, uint32_t triangle)
{
    const uint32_t *corner = all->corner[triangle], *end = all->edge[edge].end;
    if (shares(corner, end))
        return false;
    const double *p = all->place[end[0]], *q = all->place[end[1]];
    const double *a = all->place[corner[0]], *b = all->place[corner[1]];
    const double *c = all->place[corner[2]];
    const int begin = verify_orient(a, b, c, p), over = verify_orient(a, b, c, q);
    if (begin * over > 0 || (!begin && !over))
        return false;
    const int ab = verify_orient(p, q, a, b), bc = verify_orient(p, q, b, c);
    if (ab * bc < 0)
        return false;
    const int ca = verify_orient(p, q, c, a);
    return ab * ca >= 0 && bc * ca >= 0;
}

static int try_edges(struct untangle *all, uint32_t of, uint32_t triangle)
{
    for (int k = 0; k < 3; k++) {
        const struct untangle_crossing found = {all->side[of][k], triangle};
        if (!goes_through(all, found.edge, triangle))
            continue;
        if (cloth_list_put(&all->crossings, &found, sizeof found, all->error))
            return CLOTH_E_MEMORY;
    }
    return CLOTH_OK;
}

/* Marks points of edges and triangles that cross their own layer: near features there may be on
 * their wrong sides. */
static void mark_tangled(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    memset(all->tangled, 0, all->n_points);
    for (size_t i = 0; i < all->crossings.n; i++) {
        const struct untangle_edge *edge = all->edge + crossing[i].edge;
        const uint32_t owner = all->owner[crossing[i].triangle], n_cloths = all->n_cloths;
        if (edge->owner >= n_cloths || owner >= n_cloths ||
            untangle_layered(all, edge->owner, owner))
            continue;
        for (int k = 0; k < 2; k++)
            all->tangled[edge->end[k]] = 1;
        for (int k = 0; k < 3; k++)
            all->tangled[all->corner[crossing[i].triangle][k]] = 1;
    }
}

static bool cross_pair_meets(const struct untangle *all, const struct verify_pair *pair)
{
    const uint32_t *t = pair->triangle;
    return untangle_meets(all, all->owner[t[0]], all->owner[t[1]]) &&
           !untangle_attached(all, 3, all->corner[t[0]], all->owner[t[1]]);
}

static void keep_meeting(struct untangle *all)
{
    struct verify_pair *pair = all->pairs.items;
    size_t n = 0;
    for (size_t i = 0; i < all->pairs.n; i++)
        if (cross_pair_meets(all, pair + i))
            pair[n++] = pair[i];
    all->pairs.n = n;
}

int untangle_cross(struct untangle *all)
{
    const struct verify_soup soup = {.n_points = all->n_points,
                                     .n_triangles = all->n_triangles,
                                     .n_first = all->n_cloth_triangles,
                                     .x = (const double(*)[3])all->place,
                                     .corner = (const uint32_t(*)[3])all->corner,
                                     .joined = all->joined};
    all->pairs.n = all->crossings.n = 0;
    int code = verify_pairs(&soup, &all->pairs, all->error);
    keep_meeting(all);
    const struct verify_pair *pair = all->pairs.items;
    for (size_t i = 0; i < all->pairs.n && !code; i++) {
        const uint32_t *triangle = pair[i].triangle;
        code = try_edges(all, triangle[0], triangle[1]);
        code = code ? code : try_edges(all, triangle[1], triangle[0]);
    }
    if (code)
        return code;
    cloth_list_sort_once(&all->crossings, sizeof(struct untangle_crossing), cloth_by_two);
    mark_tangled(all);
    all->count.pairs = all->pairs.n;
    return CLOTH_OK;
}

void untangle_place(const struct untangle *all, const struct untangle_crossing *crossing,
                    double weight[UNTANGLE_CORNERS])
{
    const uint32_t *end = all->edge[crossing->edge].end;
    const uint32_t *corner = all->corner[crossing->triangle];
    phys_vec x[4], normal;
    struct contact_nearest nearest;
    for (int k = 0; k < 3; k++)
        x[1 + k] = all->x[corner[k]];
    untangle_face(all, crossing->triangle, &normal);
    const phys_vec p = all->x[end[0]] - x[1], q = all->x[end[1]] - x[1];
    const double begin = phys_dot(&p, &normal), over = phys_dot(&q, &normal);
    const double part = begin - over < 0 || begin - over > 0 ? begin / (begin - over) : 0.5;
    weight[1] = fmin(fmax(part, 0), 1);
    weight[0] = 1 - weight[1];
    x[0] = weight[0] * all->x[end[0]] + weight[1] * all->x[end[1]];
    contact_nearest_of(CONTACT_VT, x, &nearest);
    for (int k = 0; k < 3; k++)
        weight[2 + k] = -nearest.weight[1 + k];
}
