/* Discs: round, of almost equal triangles, their own mirror images, with the bits of no C library.
 */
#include "cloth/mesh/mesh.h"
#include "tests/cloth/mesh/tools.h"

#include <math.h>

enum { RINGS = 40, N = 1 + 3 * RINGS * (RINGS + 1) };

static struct mesh disc(double radius, uint32_t rings)
{
    struct mesh mesh;
    UNIT_FINE(mesh_disc(&mesh, radius, rings, &error));
    return mesh;
}

static const double *place_of(const struct mesh *mesh, uint32_t ring, uint32_t j)
{
    return mesh->position + 3 * (size_t)(ring ? 1 + 3 * ring * (ring - 1) + j : 0);
}

/* Within rounding where the angle says, by the functions of the C library. */
UNIT_TEST(places)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = disc(0.15, RINGS);
    ck_assert_uint_eq(mesh.n_vertices, N);
    ck_assert_uint_eq(mesh.grid_nx, 0);
    for (uint32_t ring = 0; ring <= RINGS; ring++)
        for (uint32_t j = 0; j < (ring ? 6 * ring : 1); j++) {
            const double *x = place_of(&mesh, ring, j), r = 0.15 * ring / RINGS;
            const double angle = ring ? acos(-1) / 3 * j / ring : 0;
            double uv[2];
            ck_assert_double_eq_tol(x[0], r * cos(angle), 3e-16);
            ck_assert_double_eq(x[1], 0);
            ck_assert_double_eq_tol(x[2], r * sin(angle), 3e-16);
            ck_assert_int_eq(mesh_uv(&mesh, (uint32_t)((x - mesh.position) / 3), uv), 1);
            ck_assert_double_eq(uv[0], x[0] + 0.15);
            ck_assert_double_eq(uv[1], x[2] + 0.15);
        }
}

UNIT_TEST(mirror_images)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = disc(0.15, RINGS);
    for (uint32_t ring = 1; ring <= RINGS; ring++)
        for (uint32_t j = 0; j < 6 * ring; j++) {
            const double *x = place_of(&mesh, ring, j);
            const double *down = place_of(&mesh, ring, (6 * ring - j) % (6 * ring));
            const double *left = place_of(&mesh, ring, (9 * ring - j) % (6 * ring));
            ck_assert(x[0] == down[0] && x[2] == -down[2]);
            ck_assert(x[0] == -left[0] && x[2] == left[2]);
        }
}

/* As mesh.h says; no triangle has less than three quarters of the area of another, and their sum is
 * that of a polygon of 6 rings corners. */
UNIT_TEST(almost_equal_triangles)
{
    for (uint32_t rings = 1; rings <= RINGS; rings += 3) {
        UNIT_OWNED(mesh_free) struct mesh mesh = disc(rings, rings);
        double shortest = INFINITY, longest = 0, least = INFINITY, most = 0, sum = 0;
        ck_assert_uint_eq(mesh.n_triangles, 6 * rings * rings);
        for (uint32_t t = 0; t < mesh.n_triangles; t++) {
            uint32_t corner[3];
            mesh_corners(&mesh, t, corner);
            const double *p[3];
            for (int i = 0; i < 3; i++)
                p[i] = mesh.position + 3 * (size_t)corner[i];
            for (int i = 0; i < 3; i++) {
                const double length =
                    hypot(p[i][0] - p[(i + 1) % 3][0], p[i][2] - p[(i + 1) % 3][2]);
                shortest = fmin(shortest, length);
                longest = fmax(longest, length);
            }
            const double area = ((p[1][2] - p[0][2]) * (p[2][0] - p[0][0]) -
                                 (p[1][0] - p[0][0]) * (p[2][2] - p[0][2])) /
                                2;
            least = fmin(least, area);
            most = fmax(most, area);
            sum += area;
        }

        ck_assert_double_ge(shortest, 1 - 1e-12);
        ck_assert_double_le(longest, 1.45);
        ck_assert_double_ge(least, 0.75 * most);
        const double n = 6 * rings;
        ck_assert_double_eq_tol(sum, n / 2 * rings * rings * sin(2 * acos(-1) / n), 1e-9);
    }
}

UNIT_TEST(wrong_sizes)
{
    const struct {
        double radius;
        uint32_t rings;
    } wrong[] = {{0, 3}, {-1, 3}, {NAN, 3}, {INFINITY, 3}, {1, 0}, {1, MESH_DISC_RINGS + 1}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct mesh mesh;
        UNIT_REFUSED(mesh_disc(&mesh, wrong[i].radius, wrong[i].rings, &error), CLOTH_E_INPUT,
                     "a disc has 1 to 10000 rings");
        ck_assert_uint_eq(mesh.n_vertices, 0);
    }
}
