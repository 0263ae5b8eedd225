/* The skins of the blocks. Rank 0 keeps which triangles each has, and which vertices and edges each
 * triangle stands for: those that no triangle before it has, in the order of blocks. So every
 * vertex and every edge of the whole cloth, welds and seams included, is the feature of one skin.
 * Vertices that seams pull to each other stay features of their own, and are joined in what meets.
 *
 * Corners of a triangle are joined: by springs, by what elements join, or by the links of cloths
 * without such springs (springs.c). So corners that a block does not own are rows that its
 * neighbours show. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/state/room.h"
#include "cloth/mesh/detail/sides.h"

#include <stdlib.h>
#include <string.h>

/* ---- Triangles of all cloths ---- */

/* The cloth of a triangle; looked for from the last one found. */
struct finder {
    uint32_t cloth, triangle, vertex; /* the first of the cloth */
};

/* The places of the corners of a triangle, by its number among those of all cloths. */
static void skin_tables_find_corners(const struct flow_source *source, struct finder *finder,
                                     uint32_t number, uint32_t place[3])
{
    const struct model_cloth *cloths = source->model->cloths;
    if (number < finder->triangle)
        *finder = (struct finder){0};
    while (number - finder->triangle >= cloths[finder->cloth].mesh.n_triangles) {
        finder->vertex += cloths[finder->cloth].mesh.n_vertices;
        finder->triangle += cloths[finder->cloth++].mesh.n_triangles;
    }
    mesh_corners(&cloths[finder->cloth].mesh, number - finder->triangle, place);
    for (int k = 0; k < 3; k++)
        place[k] = source->blocks.place[finder->vertex + place[k]];
}

static uint32_t lowest(const uint32_t place[3])
{
    const uint32_t least = place[0] < place[1] ? place[0] : place[1];
    return least < place[2] ? least : place[2];
}

/* ---- The triangles of each block ---- */

static uint32_t count_triangles(const struct model *model)
{
    uint32_t n = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        n += model->cloths[c].mesh.n_triangles;
    return n;
}

/* Lists the triangles by block, in each in their own order. */
static int skin_tables_list_triangles(struct flow_source *source, uint32_t n,
                                      struct cloth_error *error)
{
    struct flow_skins *skins = &source->skins;
    const uint32_t n_blocks = source->blocks.n_blocks;
    struct finder finder = {0};
    uint32_t place[3], block = 0;
    uint32_t *of = cloth_alloc(n, sizeof *of, error);
    if (!of)
        return CLOTH_E_MEMORY;
    for (uint32_t t = 0; t < n; t++) {
        skin_tables_find_corners(source, &finder, t, place);
        of[t] = block = flow_source_block(&source->blocks, lowest(place), block);
        skins->start[block + 1]++;
    }
    for (uint32_t b = 0; b < n_blocks; b++)
        skins->start[b + 1] += skins->start[b];
    for (uint32_t t = 0; t < n; t++)
        skins->triangle[skins->start[of[t]]++] = t;
    for (uint32_t b = n_blocks; b > 0; b--) /* each was moved on to the next one's */
        skins->start[b] = skins->start[b - 1];
    skins->start[0] = 0;
    free(of);
    return CLOTH_OK;
}

/* Marks the first of the edges that have the same ends, and whether there are others. edge: three
 * of each listed triangle. */
static int mark_edges(struct flow_source *source, uint32_t n, uint32_t (*edge)[2],
                      struct cloth_error *error)
{
    uint32_t *order = cloth_alloc(3 * (size_t)n, sizeof *order, error);
    const int code =
        order ? mesh_sort_pairs(order, 3 * (size_t)n, *edge, source->blocks.n_places, error)
              : CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < 3 * n && !code; i++) {
        const uint32_t e = order[i], before = i ? order[i - 1] : 0;
        const bool again = i && !memcmp(edge[e], edge[before], sizeof *edge);
        source->skins.stands[e / 3] |= (unsigned char)(again ? 0 : 8 << e % 3);
        source->skins.shared[before / 3] |= (unsigned char)(again << before % 3);
    }
    free(order);
    return code;
}

static int mark_features(struct flow_source *source, uint32_t n, struct cloth_error *error)
{
    const struct flow_skins *skins = &source->skins;
    struct finder finder = {0};
    unsigned char *seen = cloth_alloc(source->blocks.n_places, 1, error);
    uint32_t(*edge)[2] = cloth_alloc(3 * (size_t)n, sizeof *edge, error);
    int code = seen && edge ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < n && !code; i++) {
        uint32_t place[3];
        skin_tables_find_corners(source, &finder, skins->triangle[i], place);
        for (size_t k = 0; k < 3; k++) {
            const uint32_t a = place[k], b = place[(k + 1) % 3];
            skins->stands[i] |= (unsigned char)(seen[a] ? 0 : 1 << k);
            seen[a] = 1;
            edge[3 * (size_t)i + k][0] = a < b ? a : b;
            edge[3 * (size_t)i + k][1] = a < b ? b : a;
        }
    }
    if (!code)
        code = mark_edges(source, n, edge, error);
    free(seen);
    free(edge);
    return code;
}

/* Puts the places of a block's points, ascending, at the begin of `place`, which has room for three
 * of each triangle. Returns how many there are. */
static uint32_t find_points(const struct flow_source *source, uint32_t block, uint32_t *place)
{
    const struct flow_skins *skins = &source->skins;
    struct finder finder = {0};
    uint32_t n = 0, kept = 0;
    for (uint32_t i = skins->start[block]; i < skins->start[block + 1]; i++, n += 3)
        skin_tables_find_corners(source, &finder, skins->triangle[i], place + n);
    qsort(place, n, sizeof *place, cloth_compare_items_u32);
    for (uint32_t i = 0; i < n; i++)
        if (!kept || place[i] != place[kept - 1])
            place[kept++] = place[i];
    return kept;
}

/* The cloths that points are of, from the first to the last. */
static void skin_tables_find_cloths(const struct flow_source *source, uint32_t n,
                                    const uint32_t *place, uint32_t cloth[2])
{
    struct flow_cloths at = {0};
    for (uint32_t i = 0; i < n; i++) {
        flow_source_cloth(&at, source->model, source->blocks.vertex[place[i]]);
        cloth[0] = i && cloth[0] < at.cloth ? cloth[0] : at.cloth;
        cloth[1] = i && cloth[1] > at.cloth ? cloth[1] : at.cloth;
    }
}

/* The kin of points, one after the other, and what is clear around each; arrays: NULL, to count.
 * Returns how many they are. */
static uint32_t skin_tables_list_kin(const struct flow_source *source, uint32_t n,
                                     const uint32_t *place, const struct flow_skin_arrays *arrays)
{
    const struct flow_skins *skins = &source->skins;
    uint32_t to = 0;
    for (uint32_t i = 0; i < n && skins->kin.start; i++) {
        const uint32_t root = skins->joined ? skins->joined[place[i]] : place[i];
        const uint32_t first = skins->kin.start[root], some = skins->kin.start[root + 1] - first;
        if (arrays) {
            arrays->clear[i] = skins->kin.clear[root];
            memcpy(arrays->kin + to, skins->kin.of + first, some * sizeof *arrays->kin);
            arrays->kin_end[i] = to + some;
        }
        to += some;
    }
    return to;
}

static int count_skins(struct flow_source *source, struct cloth_error *error)
{
    const struct flow_skins *skins = &source->skins;
    uint32_t most = 0;
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++) {
        const uint32_t n = skins->start[b + 1] - skins->start[b];
        most = n > most ? n : most;
    }
    uint32_t *place = cloth_alloc(3 * (size_t)most, sizeof *place, error);
    if (!place)
        return CLOTH_E_MEMORY;
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++) {
        struct flow_skin_size *size = &source->shape[b].skin;
        size->n_triangles = skins->start[b + 1] - skins->start[b];
        size->n_points = find_points(source, b, place);
        size->n_kin = skin_tables_list_kin(source, size->n_points, place, NULL);
        skin_tables_find_cloths(source, size->n_points, place, size->cloth);
        for (uint32_t i = skins->start[b]; i < skins->start[b + 1]; i++) {
            size->n_vertices += (uint32_t)__builtin_popcount(skins->stands[i] & 7u);
            size->n_edges += (uint32_t)__builtin_popcount(skins->stands[i] >> 3);
        }
    }
    free(place);
    return CLOTH_OK;
}

/* Finds for each place one of those that pulled seams join it with: the same for all of them. */
static int skin_tables_find_joined(struct flow_source *source, struct cloth_error *error)
{
    const uint32_t *place = source->blocks.place, n = source->particles.n;
    const uint32_t *vertex = source->model->contact.apart.joined;
    if (!vertex)
        return CLOTH_OK;
    uint32_t *joined = cloth_alloc(source->blocks.n_places, sizeof *joined, error);
    source->skins.joined = joined;
    if (!joined)
        return CLOTH_E_MEMORY;
    cloth_sets_start(joined, source->blocks.n_places);
    for (uint32_t v = 0; v < n; v++)
        if (place[v] != MESH_NO_PLACE)
            cloth_sets_join(joined, place[v], place[vertex[v]]);
    for (uint32_t p = 0; p < source->blocks.n_places; p++)
        joined[p] = cloth_sets_root(joined, p);
    return CLOTH_OK;
}

/* Sums the areas of triangles at their corners. */
static int skin_tables_find_areas(struct flow_source *source, uint32_t n, struct cloth_error *error)
{
    struct finder finder = {0};
    double *area = cloth_alloc(source->blocks.n_places, sizeof *area, error);
    source->skins.area = area;
    for (uint32_t t = 0; t < n && area; t++) {
        uint32_t place[3];
        skin_tables_find_corners(source, &finder, t, place);
        const struct mesh *rest = model_rest(source->model->cloths + finder.cloth);
        const double third = mesh_triangle_area(rest, t - finder.triangle) / 3;
        for (int k = 0; k < 3; k++)
            area[place[k]] += third;
    }
    return area ? CLOTH_OK : CLOTH_E_MEMORY;
}

int flow_skins_make(struct flow_source *source, struct cloth_error *error)
{
    struct flow_skins *skins = &source->skins;
    const uint32_t n = count_triangles(source->model);
    skins->start = cloth_alloc((size_t)source->blocks.n_blocks + 1, sizeof *skins->start, error);
    skins->triangle = cloth_alloc(n, sizeof *skins->triangle, error);
    skins->stands = cloth_alloc(n, 1, error);
    skins->shared = cloth_alloc(n, 1, error);
    if (!skins->start || !skins->triangle || !skins->stands || !skins->shared)
        return CLOTH_E_MEMORY;
    int code = skin_tables_find_joined(source, error);
    if (!code)
        code = skin_tables_find_areas(source, n, error);
    if (!code)
        code = skin_tables_list_triangles(source, n, error);
    if (!code)
        code = mark_features(source, n, error);
    if (!code)
        code = flow_kin_make(source, n, error);
    return code ? code : count_skins(source, error);
}

void flow_skins_free(struct flow_skins *skins)
{
    free(skins->start);
    free(skins->triangle);
    free(skins->stands);
    free(skins->shared);
    free(skins->joined);
    free(skins->area);
    flow_kin_free(&skins->kin);
    *skins = (struct flow_skins){0};
}

/* ---- The skin of a block ---- */

/* The parts of a skin, by point, in one piece of memory; place: first of all corners. */
struct making {
    const struct flow_source *source;
    const struct flow_table *table;
    uint32_t *place, (*corner)[3], *block, *row, *cloth, *joined;
    unsigned char *held;
    phys_vec *x;
};

static size_t skin_tables_lay(const struct flow_skin_size *size, void *memory,
                              struct making *making)
{
    const size_t n = size->n_points, triangles = size->n_triangles;
    struct flow_room room = {.base = memory};
    making->place = flow_room_next(&room, 3 * triangles * sizeof *making->place);
    making->corner = flow_room_next(&room, triangles * sizeof *making->corner);
    making->block = flow_room_next(&room, n * sizeof *making->block);
    making->row = flow_room_next(&room, n * sizeof *making->row);
    making->cloth = flow_room_next(&room, n * sizeof *making->cloth);
    making->joined = flow_room_next(&room, n * sizeof *making->joined);
    making->held = flow_room_next(&room, n);
    making->x = flow_room_next(&room, n * sizeof *making->x);
    return room.used;
}

static uint32_t skin_tables_point_of(const struct making *making, uint32_t place)
{
    uint32_t low = 0, high = making->table->skin.n_points;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (making->place[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void skin_tables_fill_corners(const struct making *making, uint32_t block)
{
    const struct flow_skins *skins = &making->source->skins;
    struct finder finder = {0};
    for (uint32_t i = 0; i < making->table->skin.n_triangles; i++) {
        uint32_t place[3];
        skin_tables_find_corners(making->source, &finder, skins->triangle[skins->start[block] + i],
                                 place);
        for (int k = 0; k < 3; k++)
            making->corner[i][k] = skin_tables_point_of(making, place[k]);
    }
}

/* The number of a neighbour; n_neighbours: the block itself. */
static uint32_t neighbour_of(const struct flow_table *t, uint32_t block)
{
    uint32_t s = 0;
    while (s < t->n_neighbours && t->neighbour[s] != block)
        s++;
    return s;
}

static void fill_points(const struct making *making, const struct flow_skin_arrays *arrays)
{
    const struct flow_source *source = making->source;
    const struct flow_table *t = making->table;
    struct flow_cloths at = {0};
    uint32_t block = 0;
    for (uint32_t i = 0; i < t->skin.n_points; i++) {
        const uint32_t place = making->place[i], v = source->blocks.vertex[place];
        struct flow_particle particle;
        block = flow_source_block(&source->blocks, place, block);
        flow_source_cloth(&at, source->model, v);
        flow_particle_of(&source->particles, source->model, source->model->cloths + at.cloth,
                         at.first, v, &particle);
        making->block[i] = block;
        making->row[i] = place - source->blocks.start[block];
        making->cloth[i] = at.cloth;
        making->joined[i] = source->skins.joined ? source->skins.joined[place] : place;
        making->held[i] = !source->particles.free[v];
        making->x[i] = particle.position;
        arrays->attached[i] = source->particles.attached ? source->particles.attached[v] : 0;
        arrays->area[i] = source->skins.area[place];
        arrays->from[i] = neighbour_of(t, block);
        arrays->at[i] = arrays->from[i] == t->n_neighbours ? making->row[i] : source->halo[place];
    }
}

int flow_source_skin(const struct flow_source *source, uint32_t block, void *memory,
                     struct cloth_error *error)
{
    const struct flow_table *t = source->shape + block;
    struct making making = {.source = source, .table = t};
    const size_t bytes = skin_tables_lay(&t->skin, NULL, &making);
    void *room = aligned_alloc(FLOW_LINE, bytes ? bytes : FLOW_LINE);
    if (!room)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the skin of a block");
    skin_tables_lay(&t->skin, room, &making);
    memset(memory, 0, flow_skin_bytes(t));
    const struct flow_skin_arrays arrays = flow_skin_places(t, memory);
    find_points(source, block, making.place);
    skin_tables_fill_corners(&making, block);
    fill_points(&making, &arrays);
    skin_tables_list_kin(source, t->skin.n_points, making.place, &arrays);
    const struct contact_skin_source from = {
        .n_points = t->skin.n_points,
        .n_triangles = t->skin.n_triangles,
        .corner = (const uint32_t(*)[3])making.corner,
        .stands = source->skins.stands + source->skins.start[block],
        .shared = source->skins.shared + source->skins.start[block],
        .id = making.place,
        .joined = making.joined,
        .block = making.block,
        .row = making.row,
        .cloth = making.cloth,
        .held = making.held,
        .x = making.x};
    const int code = contact_skin_make(&from, memory, error);
    free(room);
    return code;
}
