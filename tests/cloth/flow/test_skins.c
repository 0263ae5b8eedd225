/* The skins of a run: every triangle is in the skin of the block of its lowest place, every vertex
 * and every edge is the feature of one skin, points are where the block finds them, also where a
 * cloth has no springs between the corners of its triangles, and across welds. A contact that skins
 * find stands once. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/state/flow.h"
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 9, MOST = SIDE * SIDE };

static struct setup setup;
static struct model_weld weld;
static uint32_t welded[2][SIDE];
static struct flow *flow;
static struct flow_skin *skins;
static void **memory;

static void start(void)
{
    setup_sheet(&setup, SIDE);
    setup.model.contact.mode = MODEL_CONTACT_CERTIFIED;
    setup.model.contact.thickness = 1e-3;
    setup.model.contact.self = true;
}

static uint32_t n_blocks(void)
{
    return flow->source.blocks.n_blocks;
}

static void end(void)
{
    for (uint32_t b = 0; memory && b < n_blocks(); b++)
        free(memory[b]);
    free(memory);
    free(skins);
    flow_free(flow);
    setup_free(&setup);
    memory = NULL;
    skins = NULL;
    flow = NULL;
}

static void make(void)
{
    UNIT_FINE(flow_prepare(&flow, &setup.model, 1, &error));
    memory = calloc(n_blocks(), sizeof *memory);
    skins = calloc(n_blocks(), sizeof *skins);
    ck_assert(memory && skins);
    for (uint32_t b = 0; b < n_blocks(); b++) {
        const size_t bytes = flow_skin_bytes(flow->source.shape + b);
        memory[b] = aligned_alloc(64, bytes);
        ck_assert_ptr_nonnull(memory[b]);
        memset(memory[b], 0xff, bytes);
        UNIT_FINE(flow_source_skin(&flow->source, b, memory[b], &error));
        skins[b] = flow_skin_open(memory[b]);
    }
}

/* The two sides of the sheet along its rows become one. */
static void weld_sides(void)
{
    for (uint32_t j = 0; j < SIDE; j++) {
        welded[0][j] = j * SIDE;
        welded[1][j] = j * SIDE + SIDE - 1;
    }
    weld = (struct model_weld){.pairs = {.end = {{.cloth = 0, .n = SIDE, .vertices = welded[0]},
                                                 {.cloth = 0, .n = SIDE, .vertices = welded[1]}}},
                               .tolerance = 2};
    setup.model.welds = &weld;
    setup.model.n_welds = 1;
}

/* ---- What is there ---- */

static bool shows(const struct flow_table *t, uint32_t s, uint32_t at)
{
    bool is = false;
    for (uint32_t i = t->ghost_start[s]; i < t->ghost_start[s + 1]; i++)
        is = is || t->ghost[i] == at;
    return is;
}

static void check_points(uint32_t b)
{
    const struct flow_source *source = &flow->source;
    const struct flow_table *t = source->shape + b;
    const struct contact_skin *skin = &skins[b].skin;
    for (uint32_t i = 0; i < skin->n_points; i++) {
        const uint32_t place = skin->id[i], v = source->blocks.vertex[place];
        ck_assert_uint_eq(place, source->blocks.start[skin->block[i]] + skin->row[i]);
        ck_assert_uint_lt(place, source->blocks.start[skin->block[i] + 1]);
        ck_assert_uint_eq(skin->held[i], !source->particles.free[v]);
        ck_assert_uint_eq(skin->cloth[i], 0);
        if (skins[b].from[i] == t->n_neighbours) {
            ck_assert_uint_eq(skin->block[i], b);
            ck_assert_uint_eq(skins[b].at[i], skin->row[i]);
            continue;
        }
        ck_assert_uint_lt(skins[b].from[i], t->n_neighbours);
        ck_assert_uint_eq(t->neighbour[skins[b].from[i]], skin->block[i]);
        ck_assert_uint_eq(source->halo[place], skins[b].at[i]);
        ck_assert(shows(t, skins[b].from[i], skins[b].at[i]));
    }
}

/* Counts by place, and by the places of both ends. */
static uint32_t vertices[MOST], edges[MOST][MOST], n_triangles, n_borders;

static void count_features(uint32_t b)
{
    const struct contact_skin *skin = &skins[b].skin;
    for (uint32_t i = 0; i < skin->n_vertices; i++)
        vertices[skin->id[skin->vertex[i]]]++;
    for (uint32_t i = 0; i < skin->n_edges; i++) {
        const uint32_t p = skin->id[skin->edge[i][0]], q = skin->id[skin->edge[i][1]];
        edges[p < q ? p : q][p < q ? q : p]++;
        n_borders += skin->beside[i][1] == CONTACT_NO_POINT;
    }
    for (uint32_t t = 0; t < skin->n_triangles; t++) {
        const uint32_t *corner = skin->corner[t];
        uint32_t least = UINT32_MAX;
        for (int k = 0; k < 3; k++)
            least = skin->block[corner[k]] < least ? skin->block[corner[k]] : least;
        ck_assert_uint_eq(least, b);
    }
    n_triangles += skin->n_triangles;
}

/* Features of triangles are counted once, others not at all. */
static void check_features(void)
{
    const struct mesh *mesh = &setup.cloth.mesh;
    const uint32_t *place = flow->source.blocks.place;
    static bool has[MOST][MOST];
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (int k = 0; k < 3; k++) {
            const uint32_t p = place[corner[k]], q = place[corner[(k + 1) % 3]];
            has[p < q ? p : q][p < q ? q : p] = true;
        }
    }
    for (uint32_t p = 0; p < MOST; p++)
        for (uint32_t q = 0; q < MOST; q++)
            ck_assert_uint_eq(edges[p][q], has[p][q]);
    for (uint32_t p = 0; p < flow->source.blocks.n_places; p++)
        ck_assert_uint_eq(vertices[p], 1);
    ck_assert_uint_eq(n_triangles, mesh->n_triangles);
}

/* borders: edges of one triangle. An edge whose triangles are in different skins is none. */
static void check_all(uint32_t borders)
{
    ck_assert_uint_gt(n_blocks(), 6);
    for (uint32_t b = 0; b < n_blocks(); b++) {
        check_points(b);
        count_features(b);
    }
    check_features();
    ck_assert_uint_eq(n_borders, borders);
}

/* ---- Tests ---- */

UNIT_FIXTURE(start, end)

UNIT_TEST(springs)
{
    setup_pin(&setup, 2, (const uint32_t[]){0, SIDE - 1});
    make();
    check_all(4 * (SIDE - 1));
}

/* Without shear springs nothing else joins the ends of diagonals. */
UNIT_TEST(no_shear)
{
    setup.material.shear = setup.material.bend = 0;
    make();
    check_all(4 * (SIDE - 1));
}

UNIT_TEST(welded_sides)
{
    weld_sides();
    make();
    check_all(2 * (SIDE - 1));
    ck_assert_uint_eq(flow->source.blocks.n_places, SIDE * SIDE - SIDE);
}

/* Other contact has no skins. */
UNIT_TEST(none)
{
    setup.model.contact.mode = MODEL_CONTACT_PROJECT;
    UNIT_FINE(flow_prepare(&flow, &setup.model, 1, &error));
    ck_assert_ptr_null(flow->source.skins.start);
    ck_assert_uint_eq(flow->source.shape[0].skin.n_points, 0);
}

/* A vertex of the block, 2 mm off in a direction along y. */
static struct flow_contact drawn(uint32_t kind, uint32_t vertex, double along)
{
    return (struct flow_contact){
        .kind = kind,
        .feature = {vertex},
        .row = {.normal = {0, along, 0, 0}, .gap = 0.002, .thickness = 0.002}};
}

/* Triangles with a common edge or corner have the nearest point of a vertex in common: it is one
 * contact. Where the vertex lies between two layers there are two. */
UNIT_TEST(a_point_is_met_once)
{
    struct flow_contact list[] = {
        drawn(CONTACT_VT, 5, 1), drawn(CONTACT_VT, 5, 1), drawn(CONTACT_VT, 5, -1),
        drawn(CONTACT_VT, 5, 1), drawn(CONTACT_VT, 6, 1), drawn(CONTACT_EE, 6, 1),
        drawn(CONTACT_EE, 6, 1),
    };
    static const double along[] = {1, -1, 1, 1, 1};
    static const uint32_t vertex[] = {5, 5, 6, 6, 6};
    ck_assert_uint_eq(flow_contact_drop_repeated(list, sizeof list / sizeof *list), 5);
    for (int i = 0; i < 5; i++) {
        ck_assert_uint_eq(list[i].feature[0], vertex[i]);
        ck_assert(list[i].row.normal[1] * along[i] > 0);
    }
}
