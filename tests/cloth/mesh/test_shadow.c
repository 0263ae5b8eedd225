/* Shadows of a disc, flat and folded, against closed forms: those of its rings, which are regular
 * polygons. */
#include "cloth/mesh/mesh.h"
#include "tests/cloth/mesh/tools.h"

#include <math.h>

enum { RINGS = 50 }; /* 15 cm; 9 cm of them lie on the disc */

static const double up[3] = {0, 1, 0};

static double shadow_of(const struct mesh *mesh, const double *position, const double axis[3])
{
    const struct mesh_shape shape = {mesh->n_vertices, mesh->n_triangles, position,
                                     (const uint32_t(*)[3])mesh->triangle};
    double area;
    UNIT_FINE(mesh_shadow(&shape, axis, &area, &error));
    return area;
}

static double polygon(double radius, uint32_t rings)
{
    const double n = 6 * rings;
    return n / 2 * radius * radius * sin(2 * acos(-1) / n);
}

static struct mesh disc(void)
{
    struct mesh mesh;
    UNIT_FINE(mesh_disc(&mesh, 0.15, RINGS, &error));
    return mesh;
}

/* The border beyond 9 cm hangs down as a cone, by an angle against level. */
static void hang(struct mesh *mesh, double angle)
{
    for (uint32_t v = 0; v < mesh->n_vertices; v++) {
        double *x = mesh->position + 3 * (size_t)v;
        const double r = hypot(x[0], x[2]), beyond = fmax(r - 0.09, 0);
        const double to = r > 0 ? (r - beyond + beyond * cos(angle)) / r : 0;
        x[0] *= to;
        x[1] = -beyond * sin(angle);
        x[2] *= to;
    }
}

/* 100 % of the border where it stands out, 0 % where it hangs straight down. */
UNIT_TEST(drape_coefficients)
{
    const double carried = acos(-1) * 0.09 * 0.09, quarter = acos(0);
    for (int i = 0; i <= 3; i++) {
        UNIT_OWNED(mesh_free) struct mesh mesh = disc();
        const double flat = mesh_surface(&mesh), part = cos(i * quarter / 3);
        ck_assert_double_eq_tol(flat, polygon(0.15, RINGS), 1e-15);
        hang(&mesh, i * quarter / 3);
        const double shadow = shadow_of(&mesh, mesh.position, up);
        const double coefficient = (shadow - carried) / (flat - carried);
        const double cone = polygon(0.09 + 0.06 * part, RINGS);
        ck_assert_double_eq_tol(coefficient, fmax(cone - carried, 0) / (flat - carried), 1e-5);
        if (i == 0 || i == 3)
            ck_assert_double_eq_tol(coefficient, i == 0, 1e-5);
    }
}

/* Folded in two it shades half as much, but for triangles that lie across the fold, and nothing if
 * the fold points at the light. */
UNIT_TEST(folded)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = disc();
    double *x = mesh.position;
    const double whole = mesh_surface(&mesh);
    for (uint32_t v = 0; v < mesh.n_vertices; v++)
        x[3 * v] = fabs(x[3 * v]);
    ck_assert_double_eq_tol(shadow_of(&mesh, x, up), whole / 2, 0.01 * whole);
    for (uint32_t v = 0; v < mesh.n_vertices; v++) {
        x[3 * v + 1] = x[3 * v];
        x[3 * v] = 0.3 * x[3 * v + 2];
    }
    ck_assert_double_lt(shadow_of(&mesh, x, up), 1e-12);
}

/* Any axis, of any length: turned with the cloth it shows the same, aslant the cosine of it. */
UNIT_TEST(any_axis)
{
    static const double axes[][3] = {{2, 0, 0}, {0, -3, 0}, {0, 0, 1e-3}, {1, 2, 3}, {-3, 1, 1e-9}};
    UNIT_OWNED(mesh_free) struct mesh mesh = disc();
    const double whole = mesh_surface(&mesh);
    for (size_t i = 0; i < sizeof axes / sizeof *axes; i++) {
        const double *a = axes[i], size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        ck_assert_double_eq_tol(shadow_of(&mesh, mesh.position, a), whole * fabs(a[1]) / size,
                                1e-5 * whole);
    }
}

/* Triangles above one another count once, holes and single points count nothing. */
UNIT_TEST(stacked)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh =
        read_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 1 0.5\nv 1.5 1 0.5\nv 1.5 1 1.5\n"
                  "v 0.5 1 1.5\nv 5 0 5\nv 6 0 5\nv 5 0 6\nv 9 9 9\n"
                  "f 1 4 3 2\nf 5 8 7 6\nf 9 10 11\n");
    ck_assert_double_eq_tol(shadow_of(&mesh, mesh.position, up), 1.75 + 0.5, 0.01);
    mesh.n_triangles = 0;
    ck_assert_double_eq(shadow_of(&mesh, mesh.position, up), 0);
}
