/* A contour of an intersection of two cloths that ends at their borders cuts nothing off. Then each
 * vertex of the first that is beside the second is on one of its sides, and a zone is a connected
 * set of such vertices. In a zone with crossings, the side of most vertices is the right one, and
 * the others go there. */
#include "cloth/untangle/state.h"

#include "cloth/base/order.h"
#include "cloth/base/sets.h"

#include <stdlib.h>
#include <string.h>

/* Two cloths, the lower number first. */
struct zoned {
    uint32_t cloth[2];
    int64_t along; /* crossings along each other, less those across */
};

/* ---- Which cloths ---- */

static struct zoned zoned_of(uint32_t a, uint32_t b)
{
    return a < b ? (struct zoned){{a, b}, 0} : (struct zoned){{b, a}, 0};
}

bool untangle_zoned(const struct untangle *all, uint32_t a, uint32_t b)
{
    const struct zoned key = zoned_of(a, b);
    return all->zoned.n &&
           bsearch(&key, all->zoned.items, all->zoned.n, sizeof key, cloth_by_two) != NULL;
}

/* True if a crossing is one of two cloths of equal layers, and none of its points is in a wrong
 * part. */
static bool is_open(const struct untangle *all, const struct untangle_crossing *crossing)
{
    const struct untangle_edge *edge = all->edge + crossing->edge;
    const uint32_t owner = all->owner[crossing->triangle], n = all->n_cloths;
    bool is = edge->owner < n && owner < n && edge->owner != owner &&
              !untangle_layered(all, edge->owner, owner);
    for (int k = 0; k < 2; k++)
        is = is && !all->wrong[edge->end[k]];
    for (int k = 0; k < 3; k++)
        is = is && !all->wrong[all->corner[crossing->triangle][k]];
    return is;
}

/* True if the surfaces of a crossing lie more along each other than across. */
static bool is_along(const struct untangle *all, const struct untangle_crossing *crossing)
{
    const uint32_t *end = all->edge[crossing->edge].end;
    phys_vec face, normal = all->normal[end[0]] + all->normal[end[1]];
    untangle_face(all, crossing->triangle, &face);
    return untangle_unit(&normal) && fabs(phys_dot(&normal, &face)) > 0.5;
}

/* Keeps pairs with more crossings along each other than across. */
static void keep_along(struct cloth_list *list)
{
    struct zoned *zoned = list->items;
    size_t n = 0, kept = 0;
    cloth_list_sort(list, sizeof *zoned, cloth_by_two);
    for (size_t i = 0; i < list->n; i++) {
        if (n && !cloth_by_two(zoned + i, zoned + n - 1))
            zoned[n - 1].along += zoned[i].along;
        else
            zoned[n++] = zoned[i];
    }
    for (size_t i = 0; i < n; i++)
        if (zoned[i].along > 0)
            zoned[kept++] = zoned[i];
    list->n = kept;
}

static int find_zoned(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    for (size_t i = 0; i < all->crossings.n; i++) {
        if (!is_open(all, crossing + i))
            continue;
        struct zoned zoned =
            zoned_of(all->edge[crossing[i].edge].owner, all->owner[crossing[i].triangle]);
        zoned.along = is_along(all, crossing + i) ? 1 : -1;
        if (cloth_list_put(&all->zoned, &zoned, sizeof zoned, all->error))
            return CLOTH_E_MEMORY;
    }
    keep_along(&all->zoned);
    return CLOTH_OK;
}

/* ---- Sides ---- */

static void find_labels(struct untangle *all, const struct zoned *zoned)
{
    memset(all->label, 0, all->n_points);
    for (uint32_t p = 0; p < all->n_cloth_points; p++) {
        struct untangle_nearest at;
        phys_vec normal;
        if (all->used[p] && !all->shared[p] && all->cloth[p] == zoned->cloth[0] &&
            untangle_beside(all, p, zoned->cloth[1], &at, &normal))
            all->label[p] = phys_dot(&normal, &at.at.normal) < 0 ? -1 : 1;
    }
}

static void zones_count_votes(struct untangle *all, const struct zoned *zoned)
{
    cloth_sets_start(all->zone, all->n_cloth_points);
    memset(all->votes, 0, all->n_cloth_points * sizeof *all->votes);
    for (uint32_t e = 0; e < all->n_edges; e++) {
        const struct untangle_edge *edge = all->edge + e;
        if (edge->owner != zoned->cloth[0] || !all->label[edge->end[0]] ||
            !all->label[edge->end[1]])
            continue;
        cloth_sets_join(all->zone, edge->end[0], edge->end[1]);
    }
    for (uint32_t p = 0; p < all->n_cloth_points; p++)
        if (all->label[p])
            all->votes[cloth_sets_root(all->zone, p)][all->label[p] > 0]++;
}

/* The right side of a point's zone: 1 or -1; 0: it is in no zone. */
static int zones_side_of(struct untangle *all, uint32_t point)
{
    const uint32_t root = cloth_sets_root(all->zone, point);
    return !all->label[point] ? 0 : all->votes[root][1] >= all->votes[root][0] ? 1 : -1;
}

/* ---- The way there ---- */

static int push_vertices(struct untangle *all, const struct zoned *zoned)
{
    int code = CLOTH_OK;
    for (uint32_t p = 0; p < all->n_cloth_points && !code; p++) {
        const int side = zones_side_of(all, p);
        struct untangle_nearest at;
        phys_vec normal;
        if (!side || side == all->label[p] ||
            !untangle_beside(all, p, zoned->cloth[1], &at, &normal))
            continue;
        normal *= side;
        code = untangle_push_vertex(all, p, &at, &normal, false);
    }
    return code;
}

static int push_crossing(struct untangle *all, const struct untangle_crossing *crossing,
                         const struct zoned *zoned)
{
    const struct untangle_edge *edge = all->edge + crossing->edge;
    const uint32_t owner = all->owner[crossing->triangle];
    int side = 0;
    if (edge->owner == zoned->cloth[0] && owner == zoned->cloth[1]) {
        for (int k = 0; k < 2 && !side; k++)
            side = zones_side_of(all, edge->end[k]);
        return side ? untangle_push_edge(all, crossing, side, false) : CLOTH_OK;
    }
    if (edge->owner != zoned->cloth[1] || owner != zoned->cloth[0])
        return CLOTH_OK;
    for (int k = 0; k < 3 && !side; k++)
        side = zones_side_of(all, all->corner[crossing->triangle][k]);
    return side ? untangle_push_triangle(all, crossing, side, false) : CLOTH_OK;
}

int untangle_zones(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    int code = find_zoned(all);
    const struct zoned *zoned = all->zoned.items;
    for (size_t k = 0; k < all->zoned.n && !code; k++) {
        find_labels(all, zoned + k);
        zones_count_votes(all, zoned + k);
        code = push_vertices(all, zoned + k);
        for (size_t i = 0; i < all->crossings.n && !code; i++)
            code = push_crossing(all, crossing + i, zoned + k);
    }
    return code;
}
