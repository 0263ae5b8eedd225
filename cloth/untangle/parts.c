/* Edges that cross triangles of their own layer are cut, so that the cloth falls into parts. The
 * largest part of each piece of cloth stays. The other parts are on the wrong side of the cloth
 * that their edges cross, and go through its nearest place. */
#include "cloth/untangle/state.h"

#include "cloth/base/order.h"
#include "cloth/base/sets.h"

#include <stdlib.h>
#include <string.h>

/* A part that is on the wrong side of a cloth. */
struct link {
    uint32_t part, cloth;
};

/* ---- Parts ---- */

/* Joins points along edges of cloth. cut: by edge; NULL: none is. */
static void parts_join(const struct untangle *all, const unsigned char *cut, uint32_t *root)
{
    cloth_sets_start(root, all->n_cloth_points);
    for (uint32_t e = 0; e < all->n_edges; e++) {
        const struct untangle_edge *edge = all->edge + e;
        if (edge->owner >= all->n_cloths || (cut && cut[e]))
            continue;
        cloth_sets_join(root, edge->end[0], edge->end[1]);
    }
    for (uint32_t p = 0; p < all->n_cloth_points; p++)
        root[p] = cloth_sets_root(root, p);
}

void untangle_pieces(struct untangle *all)
{
    parts_join(all, NULL, all->piece);
}

static bool is_cut(const struct untangle *all, const struct untangle_crossing *crossing)
{
    const uint32_t n = all->n_cloths, owner = all->owner[crossing->triangle];
    const uint32_t of = all->edge[crossing->edge].owner;
    return of < n && owner < n && !untangle_layered(all, of, owner);
}

/* All parts but the largest of each piece, of equal ones the first. largest: room, by point. */
static void parts_find_wrong(struct untangle *all, uint32_t *largest)
{
    const uint32_t n = all->n_cloth_points;
    memset(all->size, 0, n * sizeof *all->size);
    for (uint32_t p = 0; p < n; p++)
        all->size[all->part[p]]++;
    for (uint32_t p = 0; p < n; p++)
        largest[p] = p;
    for (uint32_t p = 0; p < n; p++) {
        uint32_t *best = largest + all->piece[p];
        if (all->size[all->part[p]] > all->size[all->part[*best]])
            *best = all->part[p];
    }
    for (uint32_t p = 0; p < n; p++) {
        all->wrong[p] = all->part[p] != all->part[largest[all->piece[p]]];
        all->tangled[p] |= all->wrong[p];
    }
}

/* ---- Cloths that they are on the wrong side of ---- */

static int find_links(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    all->links.n = 0;
    for (uint32_t t = 0; t < all->n_cloth_triangles; t++)
        all->stamp[t] = UNTANGLE_NONE;
    for (size_t i = 0; i < all->crossings.n; i++)
        for (int k = 0; k < 2 && is_cut(all, crossing + i); k++) {
            const uint32_t end = all->edge[crossing[i].edge].end[k];
            if (!all->wrong[end])
                continue;
            const struct link link = {all->part[end], all->owner[crossing[i].triangle]};
            if (cloth_list_put(&all->links, &link, sizeof link, all->error))
                return CLOTH_E_MEMORY;
            all->stamp[crossing[i].triangle] = all->part[end];
        }
    cloth_list_sort_once(&all->links, sizeof(struct link), cloth_by_two);
    return CLOTH_OK;
}

/* ---- The way through ---- */

struct seeker {
    uint32_t point, cloth;
};

/* All triangles of another cloth; of the part's own cloth, the triangles that it crosses and other
 * wrong parts. */
static bool allows(const struct untangle *all, uint32_t triangle, const void *context)
{
    const struct seeker *seeker = context;
    const uint32_t *corner = all->corner[triangle], part = all->part[seeker->point];
    bool is = all->stamp[triangle] == part || seeker->cloth != all->cloth[seeker->point];
    for (int k = 0; k < 3; k++)
        is = is || (all->wrong[corner[k]] && all->part[corner[k]] != part);
    for (int k = 0; k < 3; k++)
        is = is && corner[k] != seeker->point;
    return is && all->owner[triangle] == seeker->cloth;
}

/* A point on the surface follows its neighbours. */
static int push_through(struct untangle *all, uint32_t point, uint32_t cloth)
{
    const struct seeker seeker = {point, cloth};
    struct untangle_nearest found;
    if (!untangle_find(all, all->x + point, UNTANGLE_REACH * all->of->thickness, allows, &seeker,
                       &found) ||
        found.at.gap < 1e-6 * all->of->thickness)
        return CLOTH_OK;
    const phys_vec through = -found.at.normal;
    return untangle_push_vertex(all, point, &found, &through, false);
}

static int push_part(struct untangle *all, uint32_t point)
{
    const struct link *link = all->links.items;
    const uint32_t part = all->part[point], n = (uint32_t)all->links.n;
    for (uint32_t i = cloth_first_from(link, 2, n, part); i < n && link[i].part == part; i++)
        if (!untangle_zoned(all, all->cloth[point], link[i].cloth) &&
            push_through(all, point, link[i].cloth))
            return CLOTH_E_MEMORY;
    return CLOTH_OK;
}

int untangle_parts(struct untangle *all)
{
    const struct untangle_crossing *crossing = all->crossings.items;
    int code = CLOTH_OK;
    bool any = false;
    all->zoned.n = 0;
    memset(all->wrong, 0, all->n_points);
    for (size_t i = 0; i < all->crossings.n; i++) {
        all->cut[crossing[i].edge] |= is_cut(all, crossing + i);
        any = any || all->cut[crossing[i].edge];
    }
    if (!any)
        return CLOTH_OK;
    parts_join(all, all->cut, all->part);
    parts_find_wrong(all, all->largest);
    for (size_t i = 0; i < all->crossings.n; i++)
        all->cut[crossing[i].edge] = 0;
    code = find_links(all);
    code = code ? code : untangle_zones(all);
    for (uint32_t p = 0; p < all->n_cloth_points && !code; p++)
        code = all->wrong[p] ? push_part(all, p) : CLOTH_OK;
    return code;
}
