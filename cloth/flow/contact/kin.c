/* The kin of a vertex: the corners of all triangles that at rest, along the cloth, are nearer to it
 * than a contact reaches. From the triangles around the vertex a flood goes over every edge that is
 * near enough into the triangle behind it, which is laid flat beside the one before. So distances
 * are exact where the cloth is flat at rest, across seams and welds too. Vertices that pulled seams
 * join are one. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"
#include "cloth/mesh/detail/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 1024 }; /* triangles of a flood: with more, kin would be most of what a run stores */

/* ---- Triangles of all cloths, joined ---- */

/* Side 3 t + k goes from corner k of triangle t to the next one. */
struct kin_mesh {
    uint32_t n_places, n;
    uint32_t (*corner)[3];  /* n: places */
    double (*length)[3];    /* n: of sides at rest, m */
    uint32_t *beside;       /* 3 n: the next side with the same ends; in a ring */
    double *reach;          /* by place, m: of contacts between cloths that are joined there */
    uint32_t *start, *star; /* n_places + 1: where the sides that go from a place begin; 3 n */
};

static void kin_free_mesh(struct kin_mesh *mesh)
{
    free(mesh->reach);
    free(mesh->corner);
    free(mesh->length);
    free(mesh->beside);
    free(mesh->start);
    free(mesh->star);
}

static int kin_make_room(struct kin_mesh *mesh, struct cloth_error *error)
{
    mesh->reach = cloth_alloc(mesh->n_places, sizeof *mesh->reach, error);
    mesh->corner = cloth_alloc(mesh->n, sizeof *mesh->corner, error);
    mesh->length = cloth_alloc(mesh->n, sizeof *mesh->length, error);
    mesh->beside = cloth_alloc(3 * (size_t)mesh->n, sizeof *mesh->beside, error);
    mesh->start = cloth_alloc((size_t)mesh->n_places + 2, sizeof *mesh->start, error);
    mesh->star = cloth_alloc(3 * (size_t)mesh->n, sizeof *mesh->star, error);
    return mesh->reach && mesh->corner && mesh->length && mesh->beside && mesh->start && mesh->star
               ? CLOTH_OK
               : CLOTH_E_MEMORY;
}

static uint32_t kin_joined(const struct flow_source *source, uint32_t place)
{
    return source->skins.joined ? source->skins.joined[place] : place;
}

static void kin_take_triangles(const struct flow_source *source, struct kin_mesh *mesh)
{
    uint32_t to = 0;
    for (uint32_t c = 0; c < source->model->n_cloths; c++) {
        const struct mesh *rest = model_rest(source->model->cloths + c);
        const uint32_t *place = source->blocks.place + model_first(source->model, c);
        for (uint32_t t = 0; t < rest->n_triangles; t++, to++) {
            const uint32_t triangle[2] = {t, UINT32_MAX};
            uint32_t corner[3];
            mesh_corners(rest, t, corner);
            for (int k = 0; k < 3; k++) {
                mesh->corner[to][k] = kin_joined(source, place[corner[k]]);
                mesh->length[to][k] = mesh_length(rest, triangle, corner[k], corner[(k + 1) % 3]);
            }
        }
    }
}

/* Lists the sides by the place that they go from. */
static void kin_list_stars(struct kin_mesh *mesh)
{
    const uint32_t *place = *mesh->corner;
    for (uint32_t i = 0; i < 3 * mesh->n; i++)
        mesh->start[place[i] + 2]++;
    for (uint32_t p = 2; p < mesh->n_places + 2; p++)
        mesh->start[p] += mesh->start[p - 1];
    for (uint32_t i = 0; i < 3 * mesh->n; i++)
        mesh->star[mesh->start[place[i] + 1]++] = i;
}

/* Makes a ring of the sides that have the same ends. */
static int kin_join_sides(struct kin_mesh *mesh, struct cloth_error *error)
{
    const uint32_t n = 3 * mesh->n;
    uint32_t(*ends)[2] = cloth_alloc(n, sizeof *ends, error);
    uint32_t *order = cloth_alloc(n, sizeof *order, error);
    for (uint32_t i = 0; ends && i < n; i++) {
        const uint32_t a = mesh->corner[i / 3][i % 3], b = mesh->corner[i / 3][(i + 1) % 3];
        ends[i][0] = a < b ? a : b;
        ends[i][1] = a < b ? b : a;
    }
    const int code =
        ends && order ? mesh_sort_pairs(order, n, *ends, mesh->n_places, error) : CLOTH_E_MEMORY;
    for (uint32_t i = 0, first = 0; i < n && !code; i++) {
        const bool last =
            i + 1 == n || cloth_compare_numbers(ends[order[i]], ends[order[i + 1]], 2);
        mesh->beside[order[i]] = order[last ? first : i + 1];
        first = last ? i + 1 : first;
    }
    free(order);
    free(ends);
    return code;
}

/* ---- How far contacts reach ---- */

/* The reach of contacts of a cloth with itself, m. */
static double kin_reach_of(const struct model *model, uint32_t cloth)
{
    return flow_contact_reach(model) * model_sides(model, cloth, cloth).thickness;
}

/* Finds the longest reach of each cloth: of the thickest one that is joined with it. A pair of both
 * reaches no farther. */
static int kin_find_reach(const struct flow_source *source, double *reach,
                          struct cloth_error *error)
{
    const struct model *model = source->model;
    const uint32_t n = model->n_cloths;
    bool alike = true;
    for (uint32_t c = 0; c < n; c++) {
        reach[c] = kin_reach_of(model, c);
        alike = alike && !(reach[c] < reach[0]) && !(reach[c] > reach[0]);
    }
    if (alike)
        return CLOTH_OK;
    uint32_t *parent = cloth_alloc((size_t)n + source->blocks.n_places, sizeof *parent, error);
    if (!parent)
        return CLOTH_E_MEMORY;
    cloth_sets_start(parent, n + source->blocks.n_places); /* cloths, then places */
    for (uint32_t c = 0; c < n; c++) {
        const uint32_t *place = source->blocks.place + model_first(model, c);
        for (uint32_t v = 0; v < model->cloths[c].mesh.n_vertices; v++)
            if (place[v] != MESH_NO_PLACE)
                cloth_sets_join(parent, c, n + kin_joined(source, place[v]));
    }
    for (uint32_t c = 0; c < n; c++) {
        double *most = reach + cloth_sets_root(parent, c);
        *most = reach[c] > *most ? reach[c] : *most;
    }
    for (uint32_t c = 0; c < n; c++)
        reach[c] = reach[cloth_sets_root(parent, c)];
    free(parent);
    return CLOTH_OK;
}

/* reach: of each cloth. */
static void kin_take_reach(const struct flow_source *source, const double *reach,
                           struct kin_mesh *mesh)
{
    for (uint32_t c = 0; c < source->model->n_cloths; c++) {
        const uint32_t *place = source->blocks.place + model_first(source->model, c);
        for (uint32_t v = 0; v < source->model->cloths[c].mesh.n_vertices; v++)
            if (place[v] != MESH_NO_PLACE)
                mesh->reach[kin_joined(source, place[v])] = reach[c];
    }
}

/* ---- A flood ---- */

/* A side that is to be crossed, where its ends were laid; from: the place at a. The part behind it
 * is on the left of the way from a to b. */
struct flood_side {
    uint32_t side, from;
    double a[2], b[2];
};

struct flood {
    const struct kin_mesh *mesh;
    double reach, clear; /* m; clear: of the nearest edge so far */
    uint32_t *seen;      /* by triangle: the last flood that reached it, from 1 */
    uint32_t number, n_seen;
    uint32_t n_sides, n_kin;
    struct flood_side side[2 * MOST];
    uint32_t kin[3 * MOST];
};

static bool flood_sees(struct flood *flood, uint32_t triangle)
{
    const bool first = flood->seen[triangle] != flood->number && flood->n_seen < MOST;
    flood->n_seen += flood->seen[triangle] != flood->number;
    flood->seen[triangle] = first ? flood->number : flood->seen[triangle];
    return first;
}

/* The distance of a side from the place where the flood begins, which is at 0. */
static double distance_of_side(const double a[2], const double b[2])
{
    const double way[2] = {b[0] - a[0], b[1] - a[1]};
    const double square = way[0] * way[0] + way[1] * way[1];
    const double at = square > 0 ? -(a[0] * way[0] + a[1] * way[1]) / square : 0;
    const double part = at > 0 ? (at < 1 ? at : 1) : 0;
    return hypot(a[0] + part * way[0], a[1] + part * way[1]);
}

/* Lays the third corner of a triangle on the left of the way from a to b. to_a, to_b: its distances
 * from them, m. */
static void lay_corner(const double a[2], const double b[2], double to_a, double to_b, double c[2])
{
    const double way[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(way[0], way[1]);
    const double along =
        length > 0 ? (length * length + to_a * to_a - to_b * to_b) / (2 * length) : 0;
    const double square = to_a * to_a - along * along, up = square > 0 ? sqrt(square) : 0;
    for (int i = 0; i < 2; i++)
        c[i] = a[i];
    if (!(length > 0))
        return;
    c[0] += (along * way[0] - up * way[1]) / length;
    c[1] += (along * way[1] + up * way[0]) / length;
}

/* Notes a side that is near enough, to be crossed. */
static void flood_add_side(struct flood *flood, uint32_t side, uint32_t from, const double a[2],
                           const double b[2])
{
    const double distance = distance_of_side(a, b);
    if (!(distance < flood->reach) || flood->n_seen > MOST)
        return;
    flood->clear = fmin(flood->clear, distance);
    flood->side[flood->n_sides++] =
        (struct flood_side){.side = side, .from = from, .a = {a[0], a[1]}, .b = {b[0], b[1]}};
}

static void flood_enter(struct flood *flood, const struct flood_side *over, uint32_t side)
{
    const struct kin_mesh *mesh = flood->mesh;
    const uint32_t t = side / 3, k = side % 3, next = 3 * t + (k + 1) % 3,
                   last = 3 * t + (k + 2) % 3;
    const bool same = mesh->corner[t][k] == over->from;
    const double *length = mesh->length[t];
    const uint32_t third = mesh->corner[t][(k + 2) % 3];
    double c[2];
    if (!flood_sees(flood, t))
        return;
    lay_corner(over->a, over->b, length[(same ? last : next) % 3], length[(same ? next : last) % 3],
               c);
    flood->kin[flood->n_kin++] = third;
    flood_add_side(flood, same ? last : next, over->from, over->a, c);
    flood_add_side(flood, same ? next : last, third, c, over->b);
}

/* The sides of the triangles around a place that do not end there. */
static void flood_begin(struct flood *flood, uint32_t place)
{
    const struct kin_mesh *mesh = flood->mesh;
    const uint32_t first = mesh->start[place], end = mesh->start[place + 1];
    flood->number++;
    flood->n_seen = flood->n_sides = flood->n_kin = 0;
    flood->clear = INFINITY;
    for (uint32_t i = first; i < end; i++)
        flood_sees(flood, mesh->star[i] / 3);
    for (uint32_t i = first; i < end && flood->n_seen <= MOST; i++) {
        const uint32_t t = mesh->star[i] / 3, k = mesh->star[i] % 3;
        const double *length = mesh->length[t], at[2] = {0}, next[2] = {length[k], 0};
        double last[2];
        lay_corner(at, next, length[(k + 2) % 3], length[(k + 1) % 3], last);
        flood_add_side(flood, 3 * t + (k + 1) % 3, mesh->corner[t][(k + 2) % 3], last, next);
        if (flood->n_sides && flood->side[flood->n_sides - 1].side / 3 == t)
            for (uint32_t e = 1; e < 3; e++)
                flood->kin[flood->n_kin++] = mesh->corner[t][(k + e) % 3];
    }
}

/* Finds the kin of a place, ascending, each once. False: there are too many. */
static bool flood_from(struct flood *flood, uint32_t place)
{
    flood_begin(flood, place);
    while (flood->n_sides && flood->n_seen <= MOST) {
        const struct flood_side over = flood->side[--flood->n_sides];
        for (uint32_t s = flood->mesh->beside[over.side]; s != over.side;
             s = flood->mesh->beside[s])
            flood_enter(flood, &over, s);
    }
    uint32_t n = 0;
    qsort(flood->kin, flood->n_kin, sizeof *flood->kin, cloth_compare_items_u32);
    for (uint32_t i = 0; i < flood->n_kin; i++)
        if (!n || flood->kin[i] != flood->kin[n - 1])
            flood->kin[n++] = flood->kin[i];
    flood->n_kin = n;
    return flood->n_seen <= MOST;
}

/* ---- The kin of all places ---- */

void flow_find_low(const struct model *model, uint32_t cloth, struct mesh_low *low)
{
    *low = (struct mesh_low){0};
    if (model_seeks(model))
        mesh_find_low(model_rest(model->cloths + cloth), kin_reach_of(model, cloth), low);
}

/* reach: of each cloth. */
static bool kin_is_needed(const struct model *model, const double *reach)
{
    bool is = false;
    for (uint32_t c = 0; c < model->n_cloths && !is && model_seeks(model); c++) {
        struct mesh_low low;
        mesh_find_low(model_rest(model->cloths + c), reach[c], &low);
        is = low.n > 0;
    }
    return is;
}

/* reach: m. */
static int kin_refuse(const struct model *model, uint32_t triangle, double reach,
                      struct cloth_error *error)
{
    uint32_t c = 0;
    while (triangle >= model->cloths[c].mesh.n_triangles)
        triangle -= model->cloths[c++].mesh.n_triangles;
    return model_fail(model->cloths[c].place, error,
                      "cloth '%.60s': more than %d triangles are nearer at rest than %g m to a "
                      "corner of triangle %u (counted from 0); contact.thickness, or that of a "
                      "material, %g m, should be smaller%s",
                      model->cloths[c].name ? model->cloths[c].name : "", MOST, reach, triangle,
                      reach / flow_contact_reach(model), model_contact_cure(model));
}

/* Lists the kin of all places, one after the other. */
static int kin_list(const struct flow_source *source, const struct kin_mesh *mesh,
                    struct flood *flood, struct flow_kin *kin, struct cloth_error *error)
{
    struct cloth_list list = {0};
    int code = CLOTH_OK;
    for (uint32_t p = 0; p < mesh->n_places && !code; p++) {
        kin->start[p] = (uint32_t)list.n;
        kin->clear[p] = INFINITY;
        if (mesh->start[p] == mesh->start[p + 1])
            continue;
        flood->reach = mesh->reach[p];
        if (!flood_from(flood, p)) {
            code = kin_refuse(source->model, mesh->star[mesh->start[p]] / 3, flood->reach, error);
            continue;
        }
        kin->clear[p] = flood->clear;
        uint32_t *to = cloth_list_add(&list, sizeof *to, flood->n_kin, error);
        code = to ? CLOTH_OK : CLOTH_E_MEMORY;
        if (to)
            memcpy(to, flood->kin, flood->n_kin * sizeof *to);
    }
    kin->start[mesh->n_places] = (uint32_t)list.n;
    kin->of = list.items;
    return code;
}

/* reach: of each cloth. */
static int kin_make_all(struct flow_source *source, uint32_t n_triangles, const double *reach,
                        struct cloth_error *error)
{
    struct flow_kin *kin = &source->skins.kin;
    struct kin_mesh mesh = {.n_places = source->blocks.n_places, .n = n_triangles};
    struct flood *flood = cloth_alloc(1, sizeof *flood, error);
    uint32_t *seen = cloth_alloc(n_triangles, sizeof *seen, error);
    kin->start = cloth_alloc((size_t)mesh.n_places + 1, sizeof *kin->start, error);
    kin->clear = cloth_alloc(mesh.n_places, sizeof *kin->clear, error);
    int code = flood && seen && kin->start && kin->clear ? CLOTH_OK : CLOTH_E_MEMORY;
    code = code ? code : kin_make_room(&mesh, error);
    if (!code) {
        kin_take_reach(source, reach, &mesh);
        kin_take_triangles(source, &mesh);
        kin_list_stars(&mesh);
        code = kin_join_sides(&mesh, error);
    }
    if (!code) {
        flood->mesh = &mesh;
        flood->seen = seen;
        code = kin_list(source, &mesh, flood, kin, error);
    }
    kin_free_mesh(&mesh);
    free(flood);
    free(seen);
    return code;
}

int flow_kin_make(struct flow_source *source, uint32_t n_triangles, struct cloth_error *error)
{
    double *reach = cloth_alloc(source->model->n_cloths, sizeof *reach, error);
    int code = reach ? kin_find_reach(source, reach, error) : CLOTH_E_MEMORY;
    if (!code && kin_is_needed(source->model, reach))
        code = kin_make_all(source, n_triangles, reach, error);
    free(reach);
    return code;
}

void flow_kin_free(struct flow_kin *kin)
{
    free(kin->start);
    free(kin->of);
    free(kin->clear);
    *kin = (struct flow_kin){0};
}
