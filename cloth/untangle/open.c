/* Corners, edges, skins and the tree of the soup are made once; boxes and normals are made again in
 * each round. */
#include "cloth/contact/body_skin.h"
#include "cloth/mesh/detail/sides.h"
#include "cloth/untangle/state.h"
#include "cloth/verify/orient.h"

#include <stdlib.h>
#include <string.h>

static const double OPEN = 0.1, ROOM = 0.5; /* of the thickness */

/* A zeroed array that lives as long as `all`. */
static void *open_room(struct untangle *all, size_t n, size_t size)
{
    return cloth_take(&all->memory, n, size, all->error);
}

void untangle_close(struct untangle *all)
{
    cloth_pool_free(&all->memory);
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
    all->body = open_room(all, all->n_obstacles, sizeof *all->body);
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
    const size_t p = all->n_points, t = all->n_triangles;
#define MAKE(type, name, numbers, items) all->name = open_room(all, items, sizeof *all->name);
    UNTANGLE_ARRAYS(MAKE)
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
    phys_vec way, *end = at->body ? open_room(all, at->body->n_vertices, sizeof *end) : NULL;
    if (!end)
        return all->error->code;
    contact_body_ends(at->body, &at->pose, all->x + at->first.point, end, &way);
    memset(all->held + at->first.point, 1, at->body->n_vertices);
    return CLOTH_OK;
}

/* ---- Edges ---- */

/* Adds the edge of the sides from `first` to before `end` in their order. */
static void open_add_edge(struct untangle *all, const struct mesh_sides *sides, uint32_t first,
                          uint32_t end)
{
    const uint32_t *ends = sides->pair + 2 * (size_t)sides->order[first];
    const phys_vec along = all->x[ends[1]] - all->x[ends[0]];
    struct untangle_edge *edge = all->edge + all->n_edges;
    *edge = (struct untangle_edge){.end = {ends[0], ends[1]},
                                   .opposite = {UNTANGLE_NONE, UNTANGLE_NONE},
                                   .n = end - first,
                                   .owner = all->owner[sides->order[first] / 3],
                                   .length = sqrt(phys_dot(&along, &along))};
    for (uint32_t i = first; i < end; i++) {
        const uint32_t side = sides->order[i];
        all->side[side / 3][side % 3] = all->n_edges;
        if (i < first + 2)
            edge->opposite[i - first] = all->corner[side / 3][(side % 3 + 2) % 3];
    }
    for (int k = 0; k < 2 && edge->n == 1; k++)
        all->border[ends[k]] = 1;
    all->n_edges++;
}

static int open_find_edges(struct untangle *all)
{
    const struct mesh soup = {
        .n_vertices = all->n_points, .n_triangles = all->n_triangles, .triangle = *all->corner};
    struct mesh_sides sides;
    const int code = mesh_sides_sort(&sides, &soup, all->error);
    for (uint32_t i = 0, end; i < sides.n; i = end) {
        end = mesh_sides_run(&sides, i);
        open_add_edge(all, &sides, i, end);
    }
    mesh_sides_free(&sides);
    return code;
}

/* ---- Skins ---- */

/* Bits of the features that each triangle of cloth stands for. *skin gets the counts. */
static int find_features(struct untangle *all, unsigned char *stands, struct contact_skin *skin)
{
    unsigned char *edge = open_room(all, all->n_edges, 1);
    unsigned char *point = open_room(all, all->n_cloth_points, 1);
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
    all->joined = open_room(all, all->n_points, sizeof *all->joined);
    for (uint32_t p = 0; p < all->n_points && all->joined; p++)
        all->joined[p] = p < all->n_cloth_points ? joined[p] : p;
    return all->joined ? CLOTH_OK : CLOTH_E_MEMORY;
}

static int open_make_skin(struct untangle *all)
{
    unsigned char *stands = open_room(all, all->n_cloth_triangles, 1);
    uint32_t *id = open_room(all, all->n_cloth_points, sizeof *id);
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
    void *table = open_room(all, contact_skin_bytes(&skin), 1);
    all->boxes = open_room(all, contact_boxes_bytes(&skin), 1);
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
    void *table = open_room(all, contact_body_skin_bytes(at->body), 1);
    at->boxes = open_room(all, contact_body_boxes_bytes(at->body), 1);
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
    phys_vec *low = open_room(all, n, sizeof *low), *high = open_room(all, n, sizeof *high);
    uint32_t *order = open_room(all, n, sizeof *order);
    all->n_nodes = contact_tree_nodes(n);
    all->node = open_room(all, all->n_nodes, sizeof *all->node);
    all->facet = open_room(all, n, sizeof *all->facet);
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

static void open_find_normals(struct untangle *all)
{
    memset(all->normal, 0, all->n_points * sizeof *all->normal);
    for (uint32_t t = 0; t < all->n_triangles; t++) {
        const uint32_t *c = all->corner[t];
        const phys_vec u = all->x[c[1]] - all->x[c[0]], v = all->x[c[2]] - all->x[c[0]];
        phys_vec area;
        phys_cross(&u, &v, &area);
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
    open_find_normals(all);
    contact_refit(&all->skin, all->x, all->x, &none, all->boxes);
    contact_tree_refit(all->n_nodes, all->facet, all->x, all->node);
}
