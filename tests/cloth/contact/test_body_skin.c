/* Skins of bodies: all vertices, edges and triangles, each once; their places in a step; pairs with
 * a cloth against brute force. */
#include "cloth/contact/body_skin.h"
#include "tests/cloth/contact/bodies.h"
#include "tests/support/random.h"

#include <stdlib.h>
#include <string.h>

enum { CLOTH = 30, TIMES = 5, FIRST_ID = 1000 };
static const double REACH = 0.02;

static struct contact_bodies bodies;
static const struct contact_body *body;

/* A ring with a vertex that no triangle has. */
static void start(void)
{
    static struct surface ring;
    UNIT_OWNED(mesh_free) struct mesh mesh = {0};
    bool turned;
    surface_torus(&ring, 0.5, 0.2, 24, 12);
    ring.x[ring.n++][0] = 3;
    surface_mesh(&ring, &mesh);
    bodies = (struct contact_bodies){0};
    UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    body = contact_bodies_at(&bodies, 1);
}

static void end(void)
{
    free(bodies.memory);
}

static void *take(size_t bytes, int fill)
{
    void *memory = aligned_alloc(CONTACT_ALIGN, (bytes + 63) / 64 * 64);
    ck_assert(memory);
    return memset(memory, fill, bytes);
}

static void *make_table(int fill)
{
    void *table = take(contact_body_skin_bytes(body), fill);
    UNIT_FINE(contact_body_skin_make(body, FIRST_ID, table, &error));
    return table;
}

static int by_value(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(uint64_t));
}

UNIT_FIXTURE(start, end)

UNIT_TEST(all_features_once)
{
    void *table = make_table(0), *other = make_table(255);
    const struct contact_skin skin = contact_skin_open(table);
    const uint32_t n = body->n_triangles, used = body->n_vertices - 1;
    uint64_t *edge = take(skin.n_edges * sizeof *edge, 0);
    unsigned char *seen = take(body->n_vertices, 0);
    ck_assert(memcmp(table, other, contact_body_skin_bytes(body)) == 0);
    ck_assert_uint_eq(skin.n_points, body->n_vertices);
    ck_assert_uint_eq(skin.n_triangles, n);
    ck_assert_uint_eq(skin.n_edges, n / 2 * 3);
    ck_assert_uint_eq(skin.n_vertices, used);
    for (uint32_t i = 0; i < skin.n_vertices; i++)
        ck_assert_uint_eq(seen[skin.vertex[i]]++, 0);
    for (uint32_t i = 0; i < skin.n_points; i++)
        ck_assert_uint_eq(skin.id[i], FIRST_ID + i);
    for (uint32_t i = 0; i < skin.n_edges; i++) {
        const uint32_t a = skin.edge[i][0], b = skin.edge[i][1];
        edge[i] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    }
    qsort(edge, skin.n_edges, sizeof *edge, by_value);
    for (uint32_t i = 1; i < skin.n_edges; i++)
        ck_assert(edge[i] != edge[i - 1]);
    free(edge);
    free(seen);
    free(table);
    free(other);
}

static const struct phys_key keys[2] = {{0, {0, 0, 0}, {1, 0, 0, 0}},
                                        {2, {0.2, -0.3, 0.1}, {0.96, 0, 0.28, 0}}};
static const struct contact_shape shape = {.n = 2, .body = 1, .about = {0.1, 0.2, 0.3}};

static void step(double from, double to, phys_vec *x, phys_vec *y, phys_vec *way)
{
    struct contact_pose pose;
    contact_pose_over(&shape, keys, &bodies, from, to, &pose);
    contact_body_ends(body, &pose, x, y, way);
}

/* The end of a step is the begin of the next one, to the bit; the middle's way is near to all. */
UNIT_TEST(steps_join)
{
    const size_t bytes = body->n_vertices * sizeof(phys_vec);
    phys_vec *x = take(4 * bytes, 0), *y = x + body->n_vertices, *next = y + body->n_vertices;
    phys_vec way, still;
    step(0.5, 0.8, x, y, &way);
    step(0.8, 1.0, next, next + body->n_vertices, &still);
    ck_assert(memcmp(y, next, bytes) == 0);
    for (uint32_t v = 0; v < body->n_vertices; v++) {
        const phys_vec left = y[v] - x[v] - way;
        ck_assert_double_lt(sqrt(phys_dot(&left, &left)), 0.3);
    }
    contact_body_ends(body, &(struct contact_pose){.moves = false}, x, y, &still);
    ck_assert(memcmp(x, contact_body_vertices(body), bytes) == 0);
    ck_assert(memcmp(y, x, bytes) == 0);
    ck_assert_double_eq(phys_dot(&still, &still), 0);
    free(x);
}

/* ---- With a cloth: triangles that share nothing ---- */

static void make_cloth(uint32_t (*corner)[3], uint32_t *id, phys_vec *x, phys_vec *y)
{
    for (uint32_t t = 0; t < CLOTH; t++) {
        const double turn = uniform(0, 6.28), far = uniform(0.25, 0.75);
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t v = 3 * t + k;
            corner[t][k] = id[v] = v;
            x[v] = (phys_vec){far * cos(turn), 0.15, far * sin(turn), 0};
            for (int c = 0; c < 3; c++)
                x[v][c] += uniform(-0.05, 0.05);
            y[v] = x[v];
            y[v][1] += uniform(-0.1, 0);
        }
    }
}

struct found {
    uint32_t n, capacity;
    struct contact_candidate *candidate;
};

static void keep(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    struct found *found = to;
    ck_assert_uint_le(found->n + n, found->capacity);
    memcpy(found->candidate + found->n, candidate, n * sizeof *candidate);
    found->n += n;
}

static bool is_found(const struct found *found, uint32_t kind, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < found->n; i++) {
        const struct contact_candidate *c = found->candidate + i;
        if (c->kind == kind && c->of[0] == a && c->of[1] == b)
            return true;
    }
    return false;
}

/* True if a pair is nearer than the reach at one of some times. */
static bool is_near(const struct contact_side side[2], const struct contact_candidate *candidate)
{
    uint32_t point[4];
    unsigned char of[4];
    const enum contact_pair pair =
        contact_candidate_corners(side[0].skin, side[1].skin, candidate, point, of);
    for (int i = 0; i <= TIMES; i++) {
        const double s = (double)i / TIMES;
        struct contact_nearest nearest;
        phys_vec at[4];
        for (int k = 0; k < 4; k++)
            at[k] = (1 - s) * side[of[k]].x[point[k]] + s * side[of[k]].y[point[k]];
        contact_nearest_of(pair, at, &nearest);
        if (nearest.gap < REACH)
            return true;
    }
    return false;
}

static uint32_t check_kind(const struct contact_side side[2], uint32_t kind, uint32_t na,
                           uint32_t nb, const struct found *found)
{
    uint32_t n = 0;
    for (uint32_t a = 0; a < na; a++)
        for (uint32_t b = 0; b < nb; b++) {
            const struct contact_candidate candidate = {.kind = kind, .of = {a, b}};
            if (!is_near(side, &candidate))
                continue;
            n++;
            ck_assert(is_found(found, kind, a, b));
        }
    return n;
}

UNIT_TEST(pairs_with_a_cloth)
{
    static uint32_t corner[CLOTH][3], id[3 * CLOTH];
    static unsigned char stands[CLOTH];
    static phys_vec x[2][1000], y[2][1000];
    phys_vec way[2] = {{0}};
    void *table[2], *boxes[2];
    struct contact_skin skin[2];
    struct contact_side side[2];
    struct found found = {.capacity = 1000000};
    make_cloth(corner, id, x[0], y[0]);
    memset(stands, 63, sizeof stands);
    static unsigned char held[3 * CLOTH];
    const struct contact_skin_source from = {.n_points = 3 * CLOTH,
                                             .n_triangles = CLOTH,
                                             .corner = (const uint32_t(*)[3])corner,
                                             .stands = stands,
                                             .id = id,
                                             .held = held,
                                             .x = x[0]};
    const struct contact_skin counts = {
        .n_points = 3 * CLOTH, .n_triangles = CLOTH, .n_edges = 3 * CLOTH, .n_vertices = 3 * CLOTH};
    table[0] = take(contact_skin_bytes(&counts), 0);
    UNIT_FINE(contact_skin_make(&from, table[0], &error));
    table[1] = make_table(0);
    step(0.5, 0.7, x[1], y[1], way + 1);
    for (int i = 0; i < 2; i++) {
        skin[i] = contact_skin_open(table[i]);
        boxes[i] = take(contact_boxes_bytes(skin + i), 0);
        contact_refit(skin + i, x[i], y[i], way + i, boxes[i]);
        side[i] = (struct contact_side){.skin = skin + i, .boxes = boxes[i], .x = x[i], .y = y[i]};
    }
    found.candidate = take(found.capacity * sizeof *found.candidate, 0);
    contact_query(side, side + 1, REACH, keep, &found);
    ck_assert_uint_gt(check_kind(side, CONTACT_VT, skin[0].n_vertices, skin[1].n_triangles, &found),
                      CLOTH);
    ck_assert_uint_gt(check_kind(side, CONTACT_TV, skin[0].n_triangles, skin[1].n_vertices, &found),
                      0);
    ck_assert_uint_gt(check_kind(side, CONTACT_EE, skin[0].n_edges, skin[1].n_edges, &found),
                      CLOTH);
    free(found.candidate);
    for (int i = 0; i < 2; i++) {
        free(boxes[i]);
        free(table[i]);
    }
}

/* A bit along n from a point of the surface: how far the nearest of all facets is, of how far the
 * point is. */
static double nearness(const phys_vec *point, const phys_vec *n)
{
    const phys_vec x = *point + 1e-3 * *n;
    struct contact_hit hit;
    contact_body_kind.closest(NULL, body, 1, &x, &hit);
    return fabs(hit.gap) / 1e-3;
}

/* A direction of length 1, across an edge if there is one. */
static void any_direction(const phys_vec *edge, phys_vec *n)
{
    *n = (phys_vec){uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    if (edge)
        *n -= phys_dot(edge, n) / phys_dot(edge, edge) * *edge;
    *n /= sqrt(phys_dot(n, n));
}

/* On vertices and in the middle of edges: outside and inside of the ring, where edges go in. */
UNIT_TEST(opens_where_it_is_nearest)
{
    const phys_vec *x = contact_body_vertices(body);
    const struct contact_facet *facet = contact_body_facets(body);
    uint32_t *fan = take(body->n_vertices * sizeof *fan, 0);
    int opened[2] = {0};
    contact_body_fans(body, fan);
    ck_assert_uint_eq(fan[body->n_vertices - 1], UINT32_MAX);
    for (uint32_t i = 0; i < 40 * body->n_triangles; i++) {
        const uint32_t *vertex = facet[i % body->n_triangles].corner, n = 1 + i / 7 % 2;
        const phys_vec edge = x[vertex[1]] - x[vertex[0]];
        const phys_vec point = n == 1 ? x[vertex[0]] : (x[vertex[0]] + x[vertex[1]]) / 2;
        phys_vec along;
        any_direction(n == 2 ? &edge : NULL, &along);
        const bool opens = contact_body_opens(body, fan, x, n, vertex, &point, &along);
        if (opens)
            ck_assert_double_gt(nearness(&point, &along), 1 - 1e-5);
        else
            ck_assert_double_lt(nearness(&point, &along), 1 - 1e-7);
        opened[n - 1] += opens;
    }
    ck_assert_int_gt(opened[0], 20);
    ck_assert_int_gt(opened[1], 50);
    free(fan);
}
