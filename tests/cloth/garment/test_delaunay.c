/* The triangulation under panels, with what panels seldom have: places on lines and circles, fixed
 * edges across many others, changes that are undone. */
#include "cloth/garment/detail/delaunay.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

static const double LOW[2] = {0, 0}, HIGH[2] = {1, 1};

static void make(struct delaunay *plane, uint32_t room)
{
    ck_assert_int_eq(delaunay_make(plane, LOW, HIGH, room, NULL), CLOTH_OK);
}

/* Neighbours know each other, every vertex one of its triangles, and no triangle is turned over. */
static void check(const struct delaunay *plane)
{
    for (uint32_t t = 0; t < plane->n_triangles; t++) {
        const struct delaunay_triangle *of = &plane->triangle[t];
        if (of->vertex[0] == DELAUNAY_NONE)
            continue;
        ck_assert(delaunay_sharpness_of(plane, t) < 2);
        for (int i = 0; i < 3; i++) {
            const uint32_t u = of->beside[i];
            if (u == DELAUNAY_NONE)
                continue;
            const struct delaunay_triangle *other = &plane->triangle[u];
            const int j = (delaunay_corner(other, of->vertex[(i + 1) % 3]) + 1) % 3;
            ck_assert_uint_eq(other->beside[j], t);
            ck_assert_uint_eq(other->vertex[(j + 1) % 3], of->vertex[(i + 2) % 3]);
            ck_assert_uint_eq(other->fixed >> j & 1, of->fixed >> i & 1);
        }
    }
    for (uint32_t v = 0; v < plane->n; v++)
        if (plane->at[v] != DELAUNAY_NONE) {
            const struct delaunay_triangle *of = &plane->triangle[plane->at[v]];
            ck_assert_uint_eq(of->vertex[delaunay_corner(of, v)], v);
        }
}

/* All of a square grid are on common circles and lines. */
UNIT_TEST(grids)
{
    UNIT_OWNED(delaunay_free) struct delaunay plane;
    make(&plane, 400);
    for (int i = 0; i < 400; i++) {
        const double place[2] = {(i % 20) / 19.0, (i / 20) / 19.0};
        ck_assert_uint_eq(delaunay_insert(&plane, place, plane.last), DELAUNAY_BOX + (uint32_t)i);
    }
    check(&plane);
    ck_assert_uint_eq(plane.n_triangles, 2 + 2 * 400);
    ck_assert_uint_eq(delaunay_insert(&plane, LOW, plane.last), DELAUNAY_NONE);
}

/* A comb: its edges cross many that Delaunay alone would have. */
UNIT_TEST(fixed_edges)
{
    enum { TEETH = 40, N = 2 * TEETH + 2 };
    UNIT_OWNED(delaunay_free) struct delaunay plane;
    make(&plane, N);
    for (int i = 0; i < 2 * TEETH; i++) {
        const double place[2] = {i / (2.0 * TEETH), i % 2 ? 0.9 : 0.1};
        ck_assert_uint_ne(delaunay_insert(&plane, place, plane.last), DELAUNAY_NONE);
    }
    const double right[2] = {1, 0}, left[2] = {-0.01, 0};
    ck_assert_uint_ne(delaunay_insert(&plane, right, plane.last), DELAUNAY_NONE);
    ck_assert_uint_ne(delaunay_insert(&plane, left, plane.last), DELAUNAY_NONE);
    for (uint32_t i = 0; i < N; i++)
        ck_assert(delaunay_fix(&plane, DELAUNAY_BOX + i, DELAUNAY_BOX + (i + 1) % N));
    check(&plane);
    delaunay_carve(&plane);
    check(&plane);
    ck_assert_uint_eq(plane.n, N);
    ck_assert_uint_eq(plane.n_triangles, N - 2); /* of any polygon without inner vertices */
}

UNIT_TEST(crossing_edges_are_refused)
{
    static const double place[4][2] = {{0.1, 0.1}, {0.9, 0.9}, {0.1, 0.9}, {0.9, 0.1}};
    UNIT_OWNED(delaunay_free) struct delaunay plane;
    make(&plane, 4);
    for (int i = 0; i < 4; i++)
        ck_assert_uint_ne(delaunay_insert(&plane, place[i], plane.last), DELAUNAY_NONE);
    ck_assert(delaunay_fix(&plane, DELAUNAY_BOX, DELAUNAY_BOX + 1));
    ck_assert(!delaunay_fix(&plane, DELAUNAY_BOX + 2, DELAUNAY_BOX + 3));
}

/* A pseudo-random number from 0 to 1. */
static double draw(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return (double)(*state >> 11) * 0x1p-53;
}

static bool same(const struct delaunay_triangle *a, const struct delaunay_triangle *b)
{
    return memcmp(a->vertex, b->vertex, sizeof a->vertex) == 0 &&
           memcmp(a->beside, b->beside, sizeof a->beside) == 0 && a->fixed == b->fixed;
}

/* Undoing restores all, whatever was done. */
UNIT_TEST(changes_are_undone)
{
    UNIT_OWNED(delaunay_free) struct delaunay plane;
    uint64_t state = 7;
    make(&plane, 300);
    for (int i = 0; i < 200; i++)
        delaunay_insert(&plane, (const double[2]){draw(&state), draw(&state)}, plane.last);
    const size_t size = plane.n_triangles * sizeof *plane.triangle;
    struct delaunay_triangle *before = malloc(size);
    double(*place)[2] = malloc(plane.n * sizeof *place);
    memcpy(before, plane.triangle, size);
    memcpy(place, plane.place, plane.n * sizeof *place);
    const uint32_t n = plane.n, n_triangles = plane.n_triangles;
    for (int round = 0; round < 200; round++) {
        delaunay_log(&plane);
        delaunay_insert(&plane, (const double[2]){draw(&state), draw(&state)}, 0);
        const uint32_t vertex = DELAUNAY_BOX + (uint32_t)(draw(&state) * 199);
        const struct delaunay_triangle *of = &plane.triangle[plane.at[vertex]];
        delaunay_merge(&plane, vertex, of->vertex[(delaunay_corner(of, vertex) + 1) % 3]);
        delaunay_legalise(&plane);
        check(&plane);
        delaunay_decide(&plane, false);
        ck_assert_uint_eq(plane.n, n);
        ck_assert_uint_eq(plane.n_triangles, n_triangles);
        for (uint32_t t = 0; t < n_triangles; t++)
            ck_assert(same(&before[t], &plane.triangle[t]));
        ck_assert(memcmp(place, plane.place, n * sizeof *place) == 0);
    }
    check(&plane);
    free(before);
    free(place);
}
