/* Skins: a sheet in several parts is met with itself. All pairs of features that brute force finds
 * nearer than the reach, at times of the step, are visited; each pair comes at most once, in one
 * order; none of them shares a vertex. A feature that the boxes do not know of is missed, and seen
 * here. */
#include "tests/cloth/contact/distances.h"
#include "tests/cloth/contact/skin_sheet.h"

/* ---- What is visited ---- */

static unsigned char vertices_seen[N][TRIANGLES], edges_seen[EDGES][EDGES];
static uint32_t n_seen;
static bool again;      /* only what moved is met */
static bool leaves_out; /* edges without ridges are left out where they are parted */
static uint32_t n_parted;
static uint64_t order;
static const double PARTED = 1e-4; /* m */

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

static void at_time(uint32_t vertex, double s, phys_vec *at)
{
    *at = x[vertex] + s * (y[vertex] - x[vertex]);
}

/* True if two features are apart by this much (m) at times of the step. */
static bool are_apart(enum contact_pair pair, const uint32_t v[4], double by)
{
    bool apart = true;
    for (int i = 0; i <= TIMES; i++) {
        phys_vec p[4];
        for (int k = 0; k < 4; k++)
            at_time(v[k], (double)i / TIMES, p + k);
        apart = apart && (pair == CONTACT_VT ? vertex_distance(p) : edge_distance(p)) > by;
    }
    return apart;
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
        n_parted += candidate[i].parted;
        must(!candidate[i].parted || (leaves_out && are_apart(pair, v, PARTED)));
        must(leaves_out || candidate[i].presses);
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
    n_seen = n_parted = 0;
    order = 0;
    for (uint32_t p = 0; p < PARTS; p++)
        for (uint32_t q = 0; q <= p; q++) {
            struct meeting meeting = {skins + (q % 2 ? q : p), skins + (q % 2 ? p : q)};
            const struct contact_side a = {.skin = &meeting.a->skin,
                                           .boxes = meeting.a->boxes,
                                           .x = meeting.a->x,
                                           .y = meeting.a->y,
                                           .ridges = leaves_out,
                                           .parts = leaves_out ? PARTED : 0};
            const struct contact_side b = {.skin = &meeting.b->skin,
                                           .boxes = meeting.b->boxes,
                                           .x = meeting.b->x,
                                           .y = meeting.b->y};
            if (again)
                contact_query_moved(&a, &b, false, reach, see, &meeting);
            else
                contact_query(&a, &b, reach, see, &meeting);
        }
}

/* ---- What brute force finds ---- */

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

UNIT_FIXTURE(NULL, end)

/* Also that there are pairs where the cloth lies on itself, and that a query is not all pairs. */
UNIT_LOOP(meets_all, 0, 3 * SHAPES)
{
    static const double reach[] = {2e-3, 6e-3};
    static const uint32_t parts[] = {PARTS, 1, 3};
    const int shape = _i / 3;
    uint32_t near;
    if (unit_quick() && _i % 3 != shape % 3) /* each shape is cut in one way */
        return;
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

/* Each edge as a feature of a skin. */
struct feature {
    const struct skin *skin;
    uint32_t number;
};

static void find_features(struct feature of[EDGES])
{
    for (uint32_t p = 0; p < PARTS; p++)
        for (uint32_t i = 0; i < skins[p].skin.n_edges; i++) {
            const uint32_t *at = skins[p].skin.edge[i];
            const uint32_t v[2] = {skins[p].point[at[0]], skins[p].point[at[1]]};
            of[find_edge(v)] = (struct feature){skins + p, i};
        }
}

static bool has_ridge(const struct feature *of, const phys_vec *normal)
{
    return contact_is_ridge(&of->skin->skin, of->skin->y, of->number, normal);
}

/* True if two edges press each other at the end of the step. */
static bool edges_press(const struct feature *a, const struct feature *b, const uint32_t v[4])
{
    const phys_vec at[4] = {y[v[0]], y[v[1]], y[v[2]], y[v[3]]};
    struct contact_nearest nearest;
    contact_nearest_of(CONTACT_EE, at, &nearest);
    const phys_vec normal = nearest.normal, back = -normal;
    const double *w = nearest.weight;
    return w[0] > 0 && w[1] > 0 && w[2] < 0 && w[3] < 0 && has_ridge(a, &normal) &&
           has_ridge(b, &back);
}

/* Cloth that goes so far in a step is not parted: it shall go a twentieth of that. */
static void go_slowly(void)
{
    for (uint32_t v = 0; v < N; v++)
        y[v] = x[v] + 0.05 * (y[v] - x[v]);
    for (uint32_t p = 0; p < PARTS; p++)
        refit(skins + p);
}

/* Edges that are left out are parted, and do not press. All others are seen, as all vertices are.
 */
UNIT_LOOP(ridges, 0, SHAPES)
{
    static unsigned char vertices[N][TRIANGLES], edges[EDGES][EDGES];
    static struct feature feature[EDGES];
    uint32_t n = 0;
    random_seed = 8;
    make((int)_i, PARTS);
    go_slowly();
    find_features(feature);
    query_all(2e-3);
    memcpy(vertices, vertices_seen, sizeof vertices);
    memcpy(edges, edges_seen, sizeof edges);
    leaves_out = true;
    query_all(2e-3);
    leaves_out = false;
    ck_assert_mem_eq(vertices, vertices_seen, sizeof vertices);
    for (uint32_t e = 0; e < n_edges; e++)
        for (uint32_t f = e; f < n_edges; f++) {
            const uint32_t v[4] = {edge[e][0], edge[e][1], edge[f][0], edge[f][1]};
            if (edges[e][f] == edges_seen[e][f])
                continue;
            must(edges[e][f] && are_apart(CONTACT_EE, v, PARTED));
            must(!edges_press(feature + e, feature + f, v));
            n++;
        }
    if (_i == 7)
        ck_assert(n > N && n_parted > N);
}

/* Marks what moved and, where it is known, the vertices beside. */
static void find_marked(bool beside, bool *marked)
{
    for (uint32_t v = 0; v < N; v++)
        marked[v] = vertex_moved[v];
    if (!beside)
        return;
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (int k = 0; k < 9; k++)
            marked[corner[t][k / 3]] |= vertex_moved[corner[t][k % 3]];
}

/* How many pairs of marked vertices were seen. */
static uint32_t count_marked(const bool *marked)
{
    uint32_t n = 0;
    for (uint32_t t = 0; t < TRIANGLES; t++)
        for (uint32_t v = 0; v < N; v++) {
            const bool is = marked[corner[t][0]] || marked[corner[t][1]] || marked[corner[t][2]];
            n += vertices_seen[v][t] && (is || marked[v]);
        }
    for (uint32_t e = 0; e < n_edges; e++)
        for (uint32_t f = e; f < n_edges; f++)
            n += edges_seen[e][f] && (marked[edge[e][0]] || marked[edge[e][1]] ||
                                      marked[edge[f][0]] || marked[edge[f][1]]);
    return n;
}

/* A query of what moved visits all pairs that a whole one visits of marked vertices, and few
 * others: none where nothing moved. In one part, what is beside a vertex is known. */
UNIT_LOOP(meets_what_moved, 0, 2)
{
    bool marked[N];
    random_seed = 6;
    for (uint32_t v = 5; v < N; v += N / 3)
        vertex_moved[v] = 1;
    make(5, _i ? PARTS : 1);
    find_marked(!_i, marked);
    query_all(6e-3);
    const uint32_t all = n_seen, n = count_marked(marked);
    again = true;
    query_all(6e-3);
    ck_assert_uint_gt(n, 20);
    ck_assert_uint_eq(count_marked(marked), n);
    ck_assert_uint_lt(n_seen, all / 2);
    memset(vertex_moved, 0, sizeof vertex_moved);
    for (uint32_t p = 0; p < PARTS; p++)
        refit(skins + p);
    query_all(6e-3);
    ck_assert_uint_eq(n_seen, 0);
    again = false;
}

/* Boxes that do not know where a vertex goes, and some that are too small. */
UNIT_TEST(misses_are_seen)
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

/* A copy of table and boxes elsewhere is as good; boxes do not depend on what was there. */
UNIT_TEST(lies_anywhere)
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

/* The points where bunches go, and on by as much again, are in their boxes. */
static void check_box(const struct skin *skin, const struct contact_bunch *bunch, uint32_t point)
{
    double low[3], high[3];
    contact_bunch_box(bunch, skin->x, skin->y, low, high);
    for (int c = 0; c < 3; c++) {
        const double from = skin->x[point][c], to = skin->y[point][c];
        const double least = fmin(from, to + (to - from)), most = fmax(from, to + (to - from));
        must(low[c] <= least && high[c] >= most);
    }
}

/* Each triangle and each vertex is in one bunch, in their order. */
UNIT_TEST(bunches)
{
    random_seed = 7;
    make(5, PARTS);
    for (uint32_t p = 0; p < PARTS; p++) {
        const struct contact_skin *skin = &skins[p].skin;
        uint32_t triangles = 0, vertices = 0;
        for (uint32_t i = 0; i < contact_bunches(skin); i++) {
            struct contact_bunch bunch;
            contact_bunch_of(skin, i, &bunch);
            ck_assert(bunch.triangle == triangles && bunch.vertex == vertices);
            triangles += bunch.n_triangles;
            vertices += bunch.n_vertices;
            for (uint32_t k = bunch.triangle; k < triangles; k++)
                for (int c = 0; c < 3; c++)
                    check_box(skins + p, &bunch, skin->corner[k][c]);
            for (uint32_t k = bunch.vertex; k < vertices; k++)
                check_box(skins + p, &bunch, skin->vertex[k]);
        }
        ck_assert(triangles == skin->n_triangles && vertices == skin->n_vertices);
    }
}

UNIT_TEST(roots)
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
