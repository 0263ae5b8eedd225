/* Skins: a sheet in several parts is met with itself. All pairs of features that brute force finds
 * nearer than the reach, at times of the step, are visited; each pair comes at most once, in one
 * order; none of them shares a vertex. What the boxes do not know of is missed, and seen here. */
#include "cloth/contact/skin_table.h"
#include "tests/cloth/contact/distances.h"
#include "tests/support/random.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 17, /* vertices */
    N = SIDE * SIDE,
    TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1),
    EDGES = 3 * SIDE * SIDE,
    TIMES = 4,
    PARTS = 6,
    SHAPES = 10
};
static const double EDGE = 5e-3; /* m, at rest */
static double longest;           /* m, of an edge in the step */

struct skin {
    void *table, *boxes;
    struct contact_skin skin;
    uint32_t point[N], triangle[TRIANGLES]; /* of the sheet; triangles as they were given */
    phys_vec x[N], y[N];
};

static phys_vec x[N], y[N];
static uint32_t corner[TRIANGLES][3], edge[EDGES][2], n_edges, part_of[N];
static uint32_t edge_of[N][N]; /* by its ends, ascending */
static struct skin skins[PARTS];

/* ---- The sheet ---- */

static void make_triangles(void)
{
    uint32_t n = 0;
    n_edges = 0;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            const uint32_t v = j * SIDE + i;
            const uint32_t to[3] = {v + 1, v + SIDE, v + SIDE + 1};
            const int is[3] = {i + 1 < SIDE, j + 1 < SIDE, i + 1 < SIDE && j + 1 < SIDE};
            for (int k = 0; k < 3; k++)
                if (is[k]) {
                    edge_of[v][to[k]] = n_edges;
                    memcpy(edge[n_edges++], (uint32_t[2]){v, to[k]}, sizeof *edge);
                }
            if (!is[2])
                continue;
            memcpy(corner[n++], (uint32_t[3]){v, v + SIDE + 1, v + 1}, sizeof *corner);
            memcpy(corner[n++], (uint32_t[3]){v, v + SIDE, v + SIDE + 1}, sizeof *corner);
        }
}

/* A part of a ring, of so many degrees, that rises by a millimetre. */
static void ring(double degrees, double u, double v, phys_vec *at)
{
    const double part = u / ((SIDE - 1) * EDGE), turn = (part - 0.5) * degrees * acos(-1) / 180;
    *at = (phys_vec){(0.03 + v) * cos(turn), 1e-3 * part, (0.03 + v) * sin(turn), 0};
}

static void place(int shape, double u, double v, phys_vec *at)
{
    const double width = (SIDE - 1) * EDGE, pi = acos(-1);
    *at = (phys_vec){u, 0, v, 0};
    if (shape == 1 || shape == 4) { /* waves */
        (*at)[1] = 0.01 * sin(60 * u) * cos(45 * v);
    } else if (shape == 2 || shape == 5) { /* six layers, 1 mm from each other */
        const double layer = floor(6 * u / width), along = u - layer * width / 6;
        *at = (phys_vec){fmod(layer, 2) < 1 ? along : width / 6 - along, 1e-3 * layer, v, 0};
        (*at)[1] += 1e-3 * (6 * u / width - layer) + 2e-3 * sin(80 * v);
    } else if (shape == 3) { /* crumpled */
        *at = 0.3 * *at;
        for (int c = 0; c < 3; c++)
            (*at)[c] += uniform(-0.012, 0.012);
    } else if (shape == 6) { /* a roll */
        const double turn = u / width * 6 * pi, radius = 2e-3 + 2e-3 * turn / pi;
        *at = (phys_vec){radius * cos(turn), radius * sin(turn), v, 0};
    } else if (shape == 7) { /* a winding stair: all normals are up, and it lies above itself */
        const double turn = u / width * 4 * pi, radius = 0.01 + v;
        *at = (phys_vec){radius * cos(turn), 1.2e-3 * turn / (2 * pi), radius * sin(turn), 0};
    } else if (shape == 9) {
        ring(354, u, v, at);
    }
}

/* Two that are flat when the step begins: one folds, the other's border comes to cross itself. */
static void move(int shape, double u, double v, phys_vec *to)
{
    const double middle = 0.5 * (SIDE - 1) * EDGE, over = u - middle;
    if (shape == 8 && over > 0)
        *to = (phys_vec){middle - over, 1e-3, v, 0};
    if (shape == 9)
        ring(366, u, v, to);
}

/* Some are far away, some fast; every vertex has a motion of its own. */
static void make_sheet(int shape)
{
    const double fast = shape >= 4 && shape <= 7 ? 0.2 : 0, own = shape == 3   ? 5e-3
                                                                  : shape == 9 ? 1e-5
                                                                               : 5e-4;
    const phys_vec way = {fast, -2 * fast, fast, 0}, far = {0, fast > 0 ? 100 : 0, 0, 0};
    for (uint32_t i = 0; i < N; i++) {
        place(shape, EDGE * (i % SIDE), EDGE * (i / SIDE), x + i);
        x[i] += far;
        y[i] = x[i] + way;
        move(shape, EDGE * (i % SIDE), EDGE * (i / SIDE), y + i);
        for (int c = 0; c < 3; c++)
            y[i][c] += uniform(-own, own);
    }
}

/* ---- Its skins ---- */

/* Parts of unlike sizes; a triangle belongs to the lowest of its corners. */
static void make_parts(uint32_t n_parts)
{
    for (uint32_t i = 0; i < N; i++) {
        const uint32_t u = 3 * (i % SIDE) / SIDE, v = i / SIDE > SIDE / 3;
        part_of[i] = (u + 3 * v) % n_parts;
    }
}

static uint32_t part_of_triangle(uint32_t t)
{
    uint32_t least = PARTS;
    for (int k = 0; k < 3; k++)
        least = part_of[corner[t][k]] < least ? part_of[corner[t][k]] : least;
    return least;
}

static bool has(uint32_t t, uint32_t v)
{
    return corner[t][0] == v || corner[t][1] == v || corner[t][2] == v;
}

/* The first triangle of the sheet that has a vertex, or an edge, stands for it. */
static unsigned char stands_of(uint32_t t)
{
    unsigned char stands = 63;
    for (uint32_t s = 0; s < t; s++)
        for (int k = 0; k < 3; k++) {
            const uint32_t a = corner[t][k], b = corner[t][(k + 1) % 3];
            if (has(s, a))
                stands &= (unsigned char)~(1 << k);
            if (has(s, a) && has(s, b))
                stands &= (unsigned char)~(8 << k);
        }
    return stands;
}

static uint32_t point_of(struct skin *skin, uint32_t *n, uint32_t vertex)
{
    for (uint32_t i = 0; i < *n; i++)
        if (skin->point[i] == vertex)
            return i;
    skin->point[*n] = vertex;
    return (*n)++;
}

static void make_skin(struct skin *skin, uint32_t part)
{
    static uint32_t local[TRIANGLES][3];
    static unsigned char stands[TRIANGLES], held[N];
    struct contact_skin_source from = {.corner = (const uint32_t(*)[3])local,
                                       .stands = stands,
                                       .id = skin->point,
                                       .block = skin->point,
                                       .row = skin->point,
                                       .cloth = skin->point,
                                       .held = held,
                                       .x = skin->x};
    struct contact_skin sizes = {0};
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        if (part_of_triangle(t) != part)
            continue;
        for (int k = 0; k < 3; k++)
            local[from.n_triangles][k] = point_of(skin, &from.n_points, corner[t][k]);
        stands[from.n_triangles] = stands_of(t);
        sizes.n_vertices += (uint32_t)__builtin_popcount(stands[from.n_triangles] & 7u);
        sizes.n_edges += (uint32_t)__builtin_popcount(stands[from.n_triangles] & 56u);
        skin->triangle[from.n_triangles++] = t;
    }
    for (uint32_t i = 0; i < from.n_points; i++)
        skin->x[i] = x[skin->point[i]];
    sizes.n_points = from.n_points;
    sizes.n_triangles = from.n_triangles;
    skin->table = aligned_alloc(CONTACT_ALIGN, contact_skin_bytes(&sizes));
    skin->boxes = aligned_alloc(CONTACT_ALIGN, contact_boxes_bytes(&sizes));
    ck_assert(skin->table && skin->boxes);
    ck_assert_int_eq(contact_skin_make(&from, skin->table, NULL), 0);
    skin->skin = contact_skin_open(skin->table);
    ck_assert_uint_eq(skin->skin.n_vertices, sizes.n_vertices);
    ck_assert_uint_eq(skin->skin.n_edges, sizes.n_edges);
}

/* Makes the boxes, in a frame as a run has it: the mean way of the points. */
static void refit(struct skin *skin)
{
    phys_vec way = {0};
    const uint32_t n = skin->skin.n_points;
    for (uint32_t i = 0; i < n; i++) {
        skin->x[i] = x[skin->point[i]];
        skin->y[i] = y[skin->point[i]];
        way += (skin->y[i] - skin->x[i]) / n;
    }
    contact_refit(&skin->skin, skin->x, skin->y, &way, skin->boxes);
}

static void make(int shape, uint32_t n_parts)
{
    make_triangles();
    make_sheet(shape);
    make_parts(n_parts);
    for (uint32_t p = 0; p < PARTS; p++) {
        make_skin(skins + p, p);
        refit(skins + p);
    }
}

static void end(void)
{
    for (uint32_t p = 0; p < PARTS; p++) {
        free(skins[p].table);
        free(skins[p].boxes);
        skins[p] = (struct skin){0};
    }
}

/* In loops: each ck_assert writes to a file. */
static void must(bool is)
{
    if (!is)
        ck_abort_msg("a pair twice, or of features that share a vertex, or a batch too large");
}

/* ---- What is visited ---- */

static unsigned char vertices_seen[N][TRIANGLES], edges_seen[EDGES][EDGES];
static uint32_t n_seen;
static uint64_t order;

struct meeting {
    const struct skin *a, *b;
};

/* The lowest corner says which cell, the middle one which of its two triangles. */
static uint32_t find_triangle(const uint32_t v[3])
{
    uint32_t least = v[0];
    for (int k = 1; k < 3; k++)
        least = v[k] < least ? v[k] : least;
    const uint32_t t = 2 * (least / SIDE * (SIDE - 1) + least % SIDE);
    return has(t, v[0]) && has(t, v[1]) && has(t, v[2]) ? t : t + 1;
}

static uint32_t find_edge(const uint32_t v[2])
{
    return edge_of[v[0] < v[1] ? v[0] : v[1]][v[0] < v[1] ? v[1] : v[0]];
}

static void see(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    const struct meeting *meeting = to;
    must(n > 0 && n <= CONTACT_BATCH);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t point[4], v[4];
        unsigned char side[4];
        const enum contact_pair pair = contact_candidate_corners(
            &meeting->a->skin, &meeting->b->skin, candidate + i, point, side);
        for (int k = 0; k < 4; k++)
            v[k] = (side[k] ? meeting->b : meeting->a)->point[point[k]];
        order = (order ^ (v[0] + 1000 * (uint64_t)v[3] + 1000000 * (uint64_t)pair)) *
                UINT64_C(1099511628211);
        n_seen++;
        if (pair == CONTACT_VT) {
            vertices_seen[v[0]][find_triangle(v + 1)]++;
        } else {
            const uint32_t a = find_edge(v), b = find_edge(v + 2);
            edges_seen[a < b ? a : b][a < b ? b : a]++;
        }
    }
}

static void query_all(double reach)
{
    memset(vertices_seen, 0, sizeof vertices_seen);
    memset(edges_seen, 0, sizeof edges_seen);
    n_seen = 0;
    order = 0;
    for (uint32_t p = 0; p < PARTS; p++)
        for (uint32_t q = 0; q <= p; q++) {
            struct meeting meeting = {skins + (q % 2 ? q : p), skins + (q % 2 ? p : q)};
            const struct contact_side a = {&meeting.a->skin, meeting.a->boxes, meeting.a->x,
                                           meeting.a->y};
            const struct contact_side b = {&meeting.b->skin, meeting.b->boxes, meeting.b->x,
                                           meeting.b->y};
            contact_query(&a, &b, reach, see, &meeting);
        }
}

/* ---- What brute force finds ---- */

static void at_time(uint32_t vertex, double s, phys_vec *at)
{
    *at = x[vertex] + s * (y[vertex] - x[vertex]);
}

static bool are_near(const uint32_t v[4], double (*distance)(const phys_vec[4]), double reach)
{
    for (int i = 0; i <= TIMES; i++) {
        phys_vec p[4], away;
        for (int k = 0; k < 4; k++)
            at_time(v[k], (double)i / TIMES, p + k);
        away = p[0] - p[3];
        if (length(&away) < 2 * longest + reach && distance(p) < reach)
            return true;
    }
    return false;
}

static void measure_edges(void)
{
    longest = 0;
    for (uint32_t e = 0; e < n_edges; e++) {
        const phys_vec begin = x[edge[e][1]] - x[edge[e][0]], end = y[edge[e][1]] - y[edge[e][0]];
        longest = fmax(longest, fmax(length(&begin), length(&end)));
    }
}

/* How many near pairs were not visited; *near: how many there are. */
static uint32_t count_missed(double reach, uint32_t *near)
{
    uint32_t missed = 0;
    *near = 0;
    measure_edges();
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (uint32_t v = 0; v < N; v++) {
            const uint32_t all[4] = {v, corner[t][0], corner[t][1], corner[t][2]};
            if (has(t, v)) {
                must(!vertices_seen[v][t]);
                continue;
            }
            must(vertices_seen[v][t] <= 1);
            if (are_near(all, vertex_distance, reach)) {
                ++*near;
                missed += !vertices_seen[v][t];
            }
        }
    for (uint32_t e = 0; e < n_edges; e++)
        for (uint32_t f = e; f < n_edges; f++) {
            const uint32_t all[4] = {edge[e][0], edge[e][1], edge[f][0], edge[f][1]};
            if (all[0] == all[2] || all[0] == all[3] || all[1] == all[2] || all[1] == all[3]) {
                must(!edges_seen[e][f]);
                continue;
            }
            must(edges_seen[e][f] <= 1);
            if (are_near(all, edge_distance, reach)) {
                ++*near;
                missed += !edges_seen[e][f];
            }
        }
    return missed;
}

/* ---- Tests ---- */

/* Also that there are pairs where the cloth lies on itself, and that a query is not all pairs. */
START_TEST(meets_all)
{
    static const double reach[] = {2e-3, 6e-3};
    static const uint32_t parts[] = {PARTS, 1, 3};
    const int shape = _i / 3;
    uint32_t near;
    random_seed = (uint64_t)_i;
    make(shape, parts[_i % 3]);
    for (size_t i = 0; i < (unit_quick() ? 1 : sizeof reach / sizeof *reach); i++) {
        query_all(reach[i]);
        const uint32_t seen = n_seen;
        const uint64_t first = order;
        ck_assert_uint_eq(count_missed(reach[i], &near), 0);
        query_all(reach[i]);
        ck_assert(n_seen == seen && order == first);
        ck_assert_uint_le(near, seen);
        ck_assert_uint_lt(seen, 100 * near + 20 * N);
        if (shape == 0 && i == 0)
            ck_assert_uint_lt(seen, parts[_i % 3] == 1 ? 1 : N); /* flat parts are left out */
        if (shape == 2 || shape == 3 || shape >= 5)
            ck_assert_uint_gt(near, N / 4);
    }
}
END_TEST

/* Boxes that do not know where a vertex goes, and some that are too small. */
START_TEST(misses_are_seen)
{
    const phys_vec none = {0};
    uint32_t near;
    random_seed = 3;
    make(3, PARTS);
    for (uint32_t p = 0; p < PARTS; p++)
        contact_refit(&skins[p].skin, skins[p].x, skins[p].x, &none, skins[p].boxes);
    query_all(2e-3);
    ck_assert_uint_gt(count_missed(2e-3, &near), 0);
    end();
    make(5, PARTS);
    struct contact_boxes *node =
        (void *)((char *)skins[1].boxes + ((struct contact_boxes_head *)skins[1].boxes)->nodes);
    for (int c = 0; c < 3; c++)
        node->low[c] += (contact_lanes){0.02f, 0.02f, 0.02f, 0.02f};
    query_all(2e-3);
    ck_assert_uint_gt(count_missed(2e-3, &near), 0);
}
END_TEST

/* A copy of table and boxes elsewhere is as good; boxes do not depend on what was there. */
START_TEST(lies_anywhere)
{
    random_seed = 4;
    make(2, PARTS);
    query_all(2e-3);
    const uint32_t seen = n_seen;
    const uint64_t first = order;
    for (uint32_t p = 0; p < PARTS; p++) {
        struct skin *skin = skins + p;
        const size_t bytes = contact_skin_bytes(&skin->skin),
                     rest = contact_boxes_bytes(&skin->skin);
        void *table = aligned_alloc(CONTACT_ALIGN, bytes);
        void *boxes = aligned_alloc(CONTACT_ALIGN, rest);
        ck_assert(table && boxes);
        memcpy(table, skin->table, bytes);
        memset(skin->table, 0xff, bytes);
        memset(boxes, 0xff, rest);
        free(skin->table);
        skin->table = table;
        skin->skin = contact_skin_open(table);
        void *before = skin->boxes;
        skin->boxes = boxes;
        refit(skin);
        ck_assert_mem_eq(before, boxes, rest);
        free(before);
    }
    query_all(2e-3);
    ck_assert(n_seen == seen && order == first);
}
END_TEST

START_TEST(roots)
{
    random_seed = 5;
    make(4, PARTS);
    for (uint32_t p = 0; p < PARTS; p++) {
        double low[3], high[3];
        contact_boxes_root(skins[p].boxes, low, high);
        for (int c = 0; c < 3; c++) {
            double least = (double)INFINITY, most = -(double)INFINITY;
            for (uint32_t i = 0; i < skins[p].skin.n_points; i++) {
                least = fmin(least, fmin(skins[p].x[i][c], skins[p].y[i][c]));
                most = fmax(most, fmax(skins[p].x[i][c], skins[p].y[i][c]));
            }
            ck_assert(low[c] == least && high[c] == most);
        }
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("skin");
    TCase *cases = tcase_create("skin");
    tcase_add_checked_fixture(cases, NULL, end);
    tcase_set_timeout(cases, 120);
    for (int i = 0; i < 3 * SHAPES; i++) /* the quick subset cuts each shape in one way */
        if (!unit_quick() || i % 3 == i / 3 % 3)
            tcase_add_loop_test(cases, meets_all, i, i + 1);
    tcase_add_test(cases, misses_are_seen);
    tcase_add_test(cases, lies_anywhere);
    tcase_add_test(cases, roots);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
