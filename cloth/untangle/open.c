/* Corners, edges, skins and the tree of the soup are made once; boxes and normals are made again in
 * each round. */
#include "cloth/contact/body_skin.h"
#include "cloth/mesh/detail/sides.h"
#include "cloth/untangle/state.h"
#include "cloth/verify/orient.h"

#include <stdlib.h>
#include <string.h>

static const double OPEN = 0.1, ROOM = 0.5; /* of the thickness */

void *untangle_room(struct untangle *all, size_t n, size_t size)
{
    const size_t line = CONTACT_ALIGN, lines = n < SIZE_MAX / 2 / size ? n * size / line + 1 : 0;
    void **kept = cloth_list_add(&all->memory, sizeof *kept, 1, all->error);
    if (!kept)
        return NULL;
    *kept = lines ? aligned_alloc(line, lines * line) : NULL;
    if (*kept)
        memset(*kept, 0, lines * line);
    else
        cloth_fail(all->error, CLOTH_E_MEMORY, "out of memory while the start is untangled");
    return *kept;
}

void untangle_close(struct untangle *all)
{
    void **kept = all->memory.items;
    for (size_t i = 0; i < all->memory.n; i++)
        free(kept[i]);
    free(all->memory.items);
    free(all->pairs.items);
    free(all->crossings.items);
    free(all->links.items);
    free(all->zoned.items);
    free(all->pushes.items);
}

/* ---- The soup ---- */

static int count_soup(struct untangle *all)
{
    const struct untangle_cloths *of = all->of;
    const struct contact_soup *soup = of->soup;
    const struct contact_surface cloths = contact_soup_cloths(soup), end = contact_soup_all(soup);
    all->n_cloths = soup->n_cloths;
    all->n_obstacles = soup->n_obstacles;
    all->n_cloth_points = cloths.point;
    all->n_cloth_triangles = cloths.triangle;
    all->n_points = end.point;
    all->n_triangles = end.triangle;
    if (end.point > UINT32_MAX / 4 || end.triangle > UINT32_MAX / 4)
        return cloth_fail(all->error, CLOTH_E_INPUT,
                          "contact.untangle: cloths and bodies have more than %u vertices or "
                          "triangles",
                          UINT32_MAX / 4);
    all->body = untangle_room(all, all->n_obstacles, sizeof *all->body);
    for (uint32_t i = 0; i < all->n_obstacles && all->body; i++) {
        struct untangle_body *body = all->body + i;
        body->body = contact_bodies_at(of->bodies, of->obstacles[i].body);
        body->first = soup->surface[all->n_cloths + i];
        contact_pose_over(of->obstacles + i, of->keys, of->bodies, 0, 0, &body->pose);
    }
    return all->error->code;
}

static int open_make_room(struct untangle *all)
{
    const uint32_t p = all->n_points, t = all->n_triangles;
    all->x = untangle_room(all, p, sizeof *all->x);
    all->start = untangle_room(all, p, sizeof *all->start);
    all->best = untangle_room(all, p, sizeof *all->best);
    all->normal = untangle_room(all, p, sizeof *all->normal);
    all->place = untangle_room(all, p, sizeof *all->place);
    all->corner = untangle_room(all, t, sizeof *all->corner);
    all->side = untangle_room(all, t, sizeof *all->side);
    all->owner = untangle_room(all, t, sizeof *all->owner);
    all->cloth = untangle_room(all, p, sizeof *all->cloth);
    all->held = untangle_room(all, p, sizeof *all->held);
    all->border = untangle_room(all, p, sizeof *all->border);
    all->edge = untangle_room(all, 3 * (size_t)t, sizeof *all->edge);
    all->part = untangle_room(all, p, sizeof *all->part);
    all->piece = untangle_room(all, p, sizeof *all->piece);
    all->size = untangle_room(all, p, sizeof *all->size);
    all->largest = untangle_room(all, p, sizeof *all->largest);
    all->cut = untangle_room(all, 3 * (size_t)t, sizeof *all->cut);
    all->zone = untangle_room(all, p, sizeof *all->zone);
    all->votes[0] = untangle_room(all, p, sizeof *all->votes[0]);
    all->votes[1] = untangle_room(all, p, sizeof *all->votes[1]);
    all->label = untangle_room(all, p, sizeof *all->label);
    all->stamp = untangle_room(all, t, sizeof *all->stamp);
    all->wrong = untangle_room(all, p, sizeof *all->wrong);
    all->tangled = untangle_room(all, p, sizeof *all->tangled);
    all->used = untangle_room(all, p, 1);
    all->shared = untangle_room(all, p, 1);
    all->moved = untangle_room(all, p, 1);
    all->seen = untangle_room(all, p, 1);
    all->inside = untangle_room(all, p, sizeof *all->inside);
    return all->error->code;
}

static void take_triangles(struct untangle *all)
{
    const struct contact_soup *soup = all->of->soup;
    memcpy(all->corner, soup->welded, all->n_triangles * sizeof *all->corner);
    for (uint32_t i = 0; i < all->n_cloths + all->n_obstacles; i++)
        for (uint32_t t = soup->surface[i].triangle; t < soup->surface[i + 1].triangle; t++)
            all->owner[t] = i;
    for (uint32_t t = all->n_triangles; t-- > 0;)
        for (int k = 0; k < 3; k++)
            all->cloth[all->corner[t][k]] = all->owner[t];
}

static void open_take_cloths(struct untangle *all, const phys_vec *x)
{
    memcpy(all->x, x, all->n_cloth_points * sizeof *x);
    memcpy(all->held, all->of->held, all->n_cloth_points);
    for (uint32_t t = 0; t < all->n_cloth_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t p = all->corner[t][k];
            all->used[p] = 1;
            all->shared[p] |= all->cloth[p] != all->owner[t];
            all->border[p] |= all->shared[p];
        }
}

static int open_place_body(struct untangle *all, const struct untangle_body *at)
{
    phys_vec way, *end = at->body ? untangle_room(all, at->body->n_vertices, sizeof *end) : NULL;
    if (!end)
        return all->error->code;
    contact_body_ends(at->body, &at->pose, all->x + at->first.point, end, &way);
    memset(all->held + at->first.point, 1, at->body->n_vertices);
    return CLOTH_OK;
}

/* ---- Edges ---- */

static void open_add_side(struct untangle *all, uint32_t side, bool is_new, const uint32_t end[2])
{
    const uint32_t opposite = all->corner[side / 3][(side % 3 + 2) % 3];
    if (is_new) {
        const phys_vec along = all->x[end[1]] - all->x[end[0]];
        all->edge[all->n_edges++] =
            (struct untangle_edge){.end = {end[0], end[1]},
                                   .opposite = {UNTANGLE_NONE, UNTANGLE_NONE},
                                   .owner = all->owner[side / 3],
                                   .length = sqrt(phys_dot(&along, &along))};
    }
    struct untangle_edge *edge = all->edge + all->n_edges - 1;
    all->side[side / 3][side % 3] = all->n_edges - 1;
    if (edge->n < 2)
        edge->opposite[edge->n] = opposite;
    edge->n++;
}

static int open_find_edges(struct untangle *all)
{
    const size_t n = 3 * (size_t)all->n_triangles;
    uint32_t(*ends)[2] = untangle_room(all, n, sizeof *ends);
    uint32_t *order = untangle_room(all, n, sizeof *order);
    if (!ends || !order)
        return CLOTH_E_MEMORY;
    for (size_t s = 0; s < n; s++) {
        const uint32_t a = all->corner[s / 3][s % 3], b = all->corner[s / 3][(s + 1) % 3];
        ends[s][0] = a < b ? a : b;
        ends[s][1] = a < b ? b : a;
    }
    if (mesh_sort_pairs(order, n, *ends, all->n_points, all->error))
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++)
        open_add_side(all, order[i], !i || memcmp(ends[order[i]], ends[order[i - 1]], sizeof *ends),
                      ends[order[i]]);
    for (uint32_t e = 0; e < all->n_edges; e++)
        for (int k = 0; k < 2 && all->edge[e].n == 1; k++)
            all->border[all->edge[e].end[k]] = 1;
    return CLOTH_OK;
}

/* ---- Skins ---- */

/* Bits of the features that each triangle of cloth stands for. *skin gets the counts. */
static int find_features(struct untangle *all, unsigned char *stands, struct contact_skin *skin)
{
    unsigned char *edge = untangle_room(all, all->n_edges, 1);
    unsigned char *point = untangle_room(all, all->n_cloth_points, 1);
    if (!edge || !point)
        return CLOTH_E_MEMORY;
    *skin = (struct contact_skin){.n_points = all->n_cloth_points,
                                  .n_triangles = all->n_cloth_triangles};
    for (uint32_t t = 0; t < skin->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            unsigned char *of_point = point + all->corner[t][k], *of_edge = edge + all->side[t][k];
            stands[t] |= (unsigned char)((!*of_point << k) | (!*of_edge << (3 + k)));
            skin->n_vertices += !*of_point;
            skin->n_edges += !*of_edge;
            *of_point = *of_edge = 1;
        }
    return CLOTH_OK;
}

/* Points of bodies, behind those of cloths, are joined to nothing. */
static int open_find_joined(struct untangle *all)
{
    const uint32_t *joined = all->of->apart ? all->of->apart->joined : NULL;
    if (!joined)
        return CLOTH_OK;
    all->joined = untangle_room(all, all->n_points, sizeof *all->joined);
    for (uint32_t p = 0; p < all->n_points && all->joined; p++)
        all->joined[p] = p < all->n_cloth_points ? joined[p] : p;
    return all->joined ? CLOTH_OK : CLOTH_E_MEMORY;
}

static int open_make_skin(struct untangle *all)
{
    unsigned char *stands = untangle_room(all, all->n_cloth_triangles, 1);
    uint32_t *id = untangle_room(all, all->n_cloth_points, sizeof *id);
    struct contact_skin skin;
    if (!stands || !id || find_features(all, stands, &skin))
        return CLOTH_E_MEMORY;
    for (uint32_t p = 0; p < all->n_cloth_points; p++)
        id[p] = p;
    const struct contact_skin_source from = {.n_points = skin.n_points,
                                             .n_triangles = skin.n_triangles,
                                             .corner = (const uint32_t(*)[3])all->corner,
                                             .stands = stands,
                                             .id = id,
                                             .joined = all->joined,
                                             .held = all->held,
                                             .x = all->x};
    void *table = untangle_room(all, contact_skin_bytes(&skin), 1);
    all->boxes = untangle_room(all, contact_boxes_bytes(&skin), 1);
    if (!table || !all->boxes || contact_skin_make(&from, table, all->error))
        return CLOTH_E_MEMORY;
    all->skin = contact_skin_open(table);
    return CLOTH_OK;
}

static int make_body_skin(struct untangle *all, struct untangle_body *at)
{
    const phys_vec none = {0};
    if (!at->body)
        return CLOTH_OK;
    void *table = untangle_room(all, contact_body_skin_bytes(at->body), 1);
    at->boxes = untangle_room(all, contact_body_boxes_bytes(at->body), 1);
    if (!table || !at->boxes ||
        contact_body_skin_make(at->body, at->first.point, table, all->error))
        return CLOTH_E_MEMORY;
    at->skin = contact_skin_open(table);
    contact_refit(&at->skin, all->x + at->first.point, all->x + at->first.point, &none, at->boxes);
    return CLOTH_OK;
}

/* ---- The tree ---- */

static void open_box_of(const struct untangle *all, uint32_t triangle, phys_vec *low,
                        phys_vec *high)
{
    const uint32_t *c = all->corner[triangle];
    for (int i = 0; i < 3; i++) {
        const double u = all->x[c[0]][i], v = all->x[c[1]][i], w = all->x[c[2]][i];
        (*low)[i] = fmin(u, fmin(v, w));
        (*high)[i] = fmax(u, fmax(v, w));
    }
}

static int make_tree(struct untangle *all)
{
    const uint32_t n = all->n_cloth_triangles;
    phys_vec *low = untangle_room(all, n, sizeof *low), *high = untangle_room(all, n, sizeof *high);
    uint32_t *order = untangle_room(all, n, sizeof *order);
    all->n_nodes = contact_tree_nodes(n);
    all->node = untangle_room(all, all->n_nodes, sizeof *all->node);
    all->facet = untangle_room(all, n, sizeof *all->facet);
    if (!low || !high || !order || !all->node || !all->facet)
        return CLOTH_E_MEMORY;
    for (uint32_t t = 0; t < n; t++)
        open_box_of(all, t, low + t, high + t);
    if (contact_tree_build(n, order, low, high, all->node, all->error))
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < n; i++) {
        memcpy(all->facet[i].corner, all->corner[order[i]], sizeof all->facet[i].corner);
        all->facet[i].number = order[i];
    }
    return CLOTH_OK;
}

/* ---- In all ---- */

int untangle_open(struct untangle *all, phys_vec *x)
{
    all->open = OPEN * all->of->thickness;
    all->room = ROOM * all->of->thickness;
    int code = count_soup(all);
    code = code ? code : open_make_room(all);
    if (!code) {
        take_triangles(all);
        open_take_cloths(all, x);
    }
    for (uint32_t i = 0; i < all->n_obstacles && !code; i++)
        code = open_place_body(all, all->body + i);
    if (!code)
        memcpy(all->start, all->x, all->n_points * sizeof *all->x);
    code = code ? code : open_find_edges(all);
    code = code ? code : open_find_joined(all);
    code = code ? code : open_make_skin(all);
    for (uint32_t i = 0; i < all->n_obstacles && !code; i++)
        code = make_body_skin(all, all->body + i);
    return code ? code : make_tree(all);
}

static void find_normals(struct untangle *all)
{
    memset(all->normal, 0, all->n_points * sizeof *all->normal);
    for (uint32_t t = 0; t < all->n_triangles; t++) {
        const uint32_t *c = all->corner[t];
        const phys_vec u = all->x[c[1]] - all->x[c[0]], v = all->x[c[2]] - all->x[c[0]];
        phys_vec area;
        untangle_product(&u, &v, &area);
        for (int k = 0; k < 3; k++)
            all->normal[c[k]] += area;
    }
}

void untangle_refit(struct untangle *all)
{
    const phys_vec none = {0};
    for (uint32_t p = 0; p < all->n_points; p++)
        for (int c = 0; c < 3; c++)
            all->place[p][c] = verify_coordinate(all->x[p][c]);
    find_normals(all);
    contact_refit(&all->skin, all->x, all->x, &none, all->boxes);
    contact_tree_refit(all->n_nodes, all->facet, all->x, all->node);
}
