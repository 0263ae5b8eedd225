/* Polygons of OBJ files cut into triangles. Whatever the polygon, its plane, its first corner and
 * its sense, the triangles tile it: each is wound as the polygon, and their areas sum up to its
 * own (the shoelace formula). Convex ones are fans from their first corner. */
#include "tests/cloth/mesh/tools.h"

#include <math.h>
#include <stdbool.h>

enum { MAX = 200 };
struct polygon {
    size_t n;
    double x[MAX][2];
};

static const struct polygon POLYGONS[] = {
    {4, {{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}},                             /* a dart */
    {6, {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}},                 /* an L */
    {8, {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}, /* a U */
    {10,
     {{0, 3},
      {-1, 1},
      {-3, 1},
      {-1.3, -0.5},
      {-2, -3},
      {0, -1},
      {2, -3},
      {1.3, -0.5},
      {3, 1},
      {1, 1}}}, /* a star */
    {12,
     {{0, 0},
      {7, 0},
      {7, 3},
      {6, 3},
      {6, 1},
      {5, 1},
      {5, 3},
      {4, 3},
      {4, 1},
      {1, 1},
      {1, 3},
      {0, 3}}},                                                        /* a comb */
    {7, {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {1.5, 0.2}, {0, 1}}}, /* flat corners */
    {5, {{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}},
    {12,
     {{0, 0},
      {5, 0},
      {5, 5},
      {1, 5},
      {1, 2},
      {3, 2},
      {3, 3},
      {2, 3},
      {2, 4},
      {4, 4},
      {4, 1},
      {0, 1}}},                                    /* a spiral */
    {5, {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}}, /* a flat corner */
};

static double shoelace(const struct polygon *p)
{
    double area = 0;
    for (size_t i = 0; i < p->n; i++) {
        const double *a = p->x[i], *b = p->x[(i + 1) % p->n];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    return area;
}

/* The polygon in a plane of space, from a corner on, forwards or backwards, as an OBJ file. */
static struct mesh read_polygon(const struct polygon *p, const double u[3], const double v[3],
                                size_t first, bool backwards)
{
    static char text[MAX * 100];
    size_t n = 0;
    for (size_t i = 0; i < p->n; i++)
        n += (size_t)sprintf(
            text + n, "v %.17g %.17g %.17g\n", 5 + p->x[i][0] * u[0] + p->x[i][1] * v[0],
            p->x[i][0] * u[1] + p->x[i][1] * v[1] - 7, p->x[i][0] * u[2] + p->x[i][1] * v[2]);
    n += (size_t)sprintf(text + n, "f");
    for (size_t i = 0; i < p->n; i++)
        n += (size_t)sprintf(text + n, " %zu", 1 + (first + (backwards ? p->n - i : i)) % p->n);
    sprintf(text + n, "\n");
    return read_text(text);
}

/* Area of a triangle along the polygon's normal u x v; u and v of length 1 and at right angles. */
static double area_of(const struct mesh *mesh, uint32_t t, const double u[3], const double v[3])
{
    double at[3][2] = {{0}};
    for (size_t c = 0; c < 3; c++)
        for (size_t k = 0; k < 3; k++) {
            const double x = mesh->position[3 * mesh->triangle[3 * t + c] + k];
            at[c][0] += x * u[k];
            at[c][1] += x * v[k];
        }
    return 0.5 * ((at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) -
                  (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]));
}

static void tiles(const struct polygon *p, const double u[3], const double v[3], size_t first,
                  bool backwards)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = read_polygon(p, u, v, first, backwards);
    const double sense = shoelace(p) > 0 ? 1 : -1;
    double sum = 0;
    ck_assert_uint_eq(mesh.n_faces, 1);
    ck_assert_uint_eq(mesh.face_start[1], p->n);
    ck_assert_uint_eq(mesh.face_corner[0], first);
    ck_assert_uint_eq(mesh.n_triangles, p->n - 2);
    for (uint32_t t = 0; t < mesh.n_triangles; t++) {
        const double area = area_of(&mesh, t, u, v) * sense * (backwards ? -1 : 1);
        ck_assert_msg(area > 1e-9, "triangle %u has the area %g", t, area);
        sum += area;
    }
    ck_assert_double_eq_tol(sum, fabs(shoelace(p)), 1e-9);
}

static const double PLANES[][2][3] = {{{1, 0, 0}, {0, 1, 0}},
                                      {{0, 0, 1}, {1, 0, 0}},
                                      {{0, -1, 0}, {0, 0, 1}},
                                      {{0.6, 0, 0.8}, {0, 1, 0}},
                                      {{2.0 / 3, 1.0 / 3, 2.0 / 3}, {-2.0 / 3, 2.0 / 3, 1.0 / 3}}};

static void tiles_everywhere(const struct polygon *p)
{
    for (size_t plane = 0; plane < sizeof PLANES / sizeof *PLANES; plane++)
        for (size_t first = 0; first < p->n; first++)
            for (int backwards = 0; backwards < 2; backwards++)
                tiles(p, PLANES[plane][0], PLANES[plane][1], first, backwards);
}

UNIT_LOOP(concave_ones_are_tiled, 0, sizeof POLYGONS / sizeof *POLYGONS)
{
    tiles_everywhere(&POLYGONS[_i]);
}

static double draw(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

/* Corners around a point, at any distance of it: simple, and mostly with many reflex corners. */
UNIT_TEST(random_ones_are_tiled)
{
    uint64_t state = 1;
    for (int round = 0; round < 40; round++) {
        struct polygon p = {.n = 4 + (size_t)(draw(&state) * 40)};
        for (size_t i = 0; i < p.n; i++) {
            const double angle = 2 * M_PI * ((double)i + 0.5 * draw(&state)) / (double)p.n;
            const double far = 0.05 + draw(&state);
            p.x[i][0] = far * cos(angle);
            p.x[i][1] = far * sin(angle);
        }
        tiles_everywhere(&p);
    }
}

/* A comb of many teeth, whose ears are far from the corners where the search begins. */
UNIT_TEST(a_large_one_is_tiled)
{
    struct polygon p = {.n = MAX};
    for (size_t i = 0; i < MAX - 2; i++) {
        p.x[i][0] = (double)i;
        p.x[i][1] = i % 2 ? 0.1 : 5 + 0.001 * (double)i;
    }
    p.x[MAX - 2][0] = MAX;
    p.x[MAX - 2][1] = -1;
    p.x[MAX - 1][0] = -1;
    p.x[MAX - 1][1] = -1;
    tiles(&p, PLANES[3][0], PLANES[3][1], 0, false);
    tiles(&p, PLANES[4][0], PLANES[4][1], 77, true);
}

UNIT_TEST(convex_ones_are_fans)
{
    struct polygon p = {.n = 17};
    for (size_t i = 0; i < p.n; i++) {
        p.x[i][0] = 2 * cos(2 * M_PI * (double)i / 17);
        p.x[i][1] = sin(2 * M_PI * (double)i / 17);
    }
    for (size_t first = 0; first < p.n; first++) {
        UNIT_OWNED(mesh_free)
        struct mesh mesh = read_polygon(&p, PLANES[4][0], PLANES[4][1], first, false);
        for (uint32_t t = 0; t < 15; t++) {
            const uint32_t fan[3] = {(uint32_t)first, (uint32_t)(first + t + 1) % 17,
                                     (uint32_t)(first + t + 2) % 17};
            ck_assert_mem_eq(mesh.triangle + 3 * t, fan, sizeof fan);
        }
    }
}

/* A quad whose corners are not in one plane. */
UNIT_TEST(a_bent_quad_is_a_fan)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("v 0 0 0\nv 1 0.1 0\nv 1 0 1\nv 0 0.2 1\nf 2 3 4 1\n");
    const uint32_t fan[] = {1, 2, 3, 1, 3, 0};
    ck_assert_mem_eq(mesh.triangle, fan, sizeof fan);
}

UNIT_TEST(too_many_corners)
{
    enum { N = 10001 };
    char *text = malloc(N * 60);
    size_t n = 0;
    for (int i = 0; i < N; i++)
        n += (size_t)sprintf(text + n, "v %d %d 0\n", i % 2 ? i : i - 1, i ? i * (1 + i % 2) : -9);
    n += (size_t)sprintf(text + n, "f");
    for (int i = 1; i <= N; i++)
        n += (size_t)sprintf(text + n, " %d", i);
    sprintf(text + n, "\n");
    struct mesh mesh;
    struct file file = file_new(text, strlen(text));
    UNIT_REFUSED(mesh_read_obj(&mesh, file.path, &error), CLOTH_E_INPUT,
                 ":10002: the face is not convex and has 10001 corners; at most 10000 can be cut "
                 "into triangles");
    close(file.descriptor);
    free(text);
}
