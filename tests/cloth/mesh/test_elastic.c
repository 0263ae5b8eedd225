/* The closed forms against the energy of the springs of an inner vertex in all uniform strains,
 * whose matrix is inverted here; and against those that can be said by heart. */
#include "cloth/mesh/lattice.h"
#include "tests/cloth/mesh/tools.h"

#include <math.h>

enum { SIDE = 7, MIDDLE = SIDE * SIDE / 2 };

/* A grid of cells of a x b. */
static struct mesh elastic_grid(double a, double b)
{
    return grid((SIDE - 1) * a, (SIDE - 1) * b, SIDE, SIDE);
}

/* The stiffness C[3][3] (xx, zz, xz) of the springs at an inner vertex, half of each, that has so
 * much of the area. */
static void stiffness(const struct mesh *mesh, const struct mesh_moduli *moduli, uint32_t middle,
                      double area, double c[3][3])
{
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice;
    UNIT_FINE(mesh_lattice_build(&lattice, mesh, moduli, &error));
    struct mesh_spring *spring = springs_of(&lattice);
    memset(c, 0, 9 * sizeof(double));
    for (uint32_t s = 0; s < lattice.n; s++) {
        const double *p = mesh->position + 3 * (size_t)spring[s].a;
        const double *q = mesh->position + 3 * (size_t)spring[s].b;
        const double x = (q[0] - p[0]) / spring[s].length, y = (q[2] - p[2]) / spring[s].length;
        const double strain[3] = {x * x, y * y, x * y}; /* along the spring, of each component */
        if (spring[s].a != middle && spring[s].b != middle)
            continue;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                c[i][j] += 0.5 * spring[s].stiffness * spring[s].length * spring[s].length *
                           strain[i] * strain[j] / area;
    }
    free(spring);
}

static double minor(double c[3][3], int i, int j)
{
    const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
    return c[k][m] * c[l][n] - c[k][n] * c[l][m];
}

static void near(double found, double expected)
{
    ck_assert_double_eq_tol(found, expected, 1e-12 * fabs(expected) + 1e-15);
}

/* found against the inverse of C */
static void is_inverse(const struct mesh_elastic *found, double c[3][3])
{
    double determinant = 0;
    for (int j = 0; j < 3; j++)
        determinant += c[0][j] * minor(c, 0, j);
    near(found->warp, determinant / minor(c, 0, 0));
    near(found->weft, determinant / minor(c, 1, 1));
    near(found->shear, determinant / minor(c, 2, 2));
    ck_assert_double_eq_tol(found->poisson, -minor(c, 0, 1) / minor(c, 0, 0), 1e-12);
}

static void holds(double stretch, double weft, double shear, double bend, int both, double a,
                  double b)
{
    const struct mesh_moduli moduli = {stretch, shear, bend, both, weft - stretch, NULL, 0};
    UNIT_OWNED(mesh_free) struct mesh mesh = elastic_grid(a, b);
    const struct mesh_elastic found = mesh_elastic_of(&mesh, &moduli);
    double c[3][3];
    stiffness(&mesh, &moduli, MIDDLE, a * b, c);
    is_inverse(&found, c);
}

UNIT_TEST(every_lattice)
{
    for (int both = 0; both < 2; both++) {
        holds(1000, 1000, 500, 0, both, 0.1, 0.1);
        holds(1000, 300, 400, 0, both, 0.1, 0.1);
        holds(1000, 300, 400, 0, both, 0.1, 0.25);
        holds(300, 1000, 7, 0, both, 3, 0.5);
        holds(1000, 300, 400, 60, both, 0.1, 0.25);
    }
}

/* Cells by turns: half of the vertices have four diagonals, the others none; a pair of neighbours
 * has two cells. */
UNIT_TEST(cells_by_turns)
{
    const struct mesh_moduli moduli = {1000, 400, 60, 0, -700, NULL, 0};
    UNIT_OWNED(mesh_free) struct mesh mesh;
    UNIT_FINE(mesh_grid(&mesh, 0.6, 1.5, SIDE, SIDE, MESH_ALTERNATE, &error));
    const struct mesh_elastic found = mesh_elastic_of(&mesh, &moduli);
    double c[3][3], other[3][3];
    stiffness(&mesh, &moduli, MIDDLE, 2 * 0.1 * 0.25, c);
    stiffness(&mesh, &moduli, MIDDLE + 1, 2 * 0.1 * 0.25, other);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[i][j] += other[i][j];
    is_inverse(&found, c);
}

/* Mirrored ones with one diagonal are no uniform lattice; with both, or without any, they are. */
UNIT_TEST(mirrored_cells)
{
    struct mesh_moduli moduli = {1000, 400, 0, 0, 0, NULL, 0};
    UNIT_OWNED(mesh_free) struct mesh mesh;
    UNIT_FINE(mesh_grid(&mesh, 1, 1, SIDE, SIDE, MESH_MIRRORED, &error));
    ck_assert(isnan(mesh_elastic_of(&mesh, &moduli).warp));
    moduli.both_diagonals = 1;
    near(mesh_elastic_of(&mesh, &moduli).shear, 400);
    moduli.both_diagonals = 0;
    moduli.shear = 0;
    near(mesh_elastic_of(&mesh, &moduli).warp, 1000);
    near(mesh_elastic_of(&mesh, &moduli).shear, 0);
}

static struct mesh_elastic of(double stretch, double shear, int both)
{
    const struct mesh_moduli moduli = {stretch, shear, 0, both, 0, NULL, 0};
    struct mesh mesh = elastic_grid(0.02, 0.02);
    const struct mesh_elastic found = mesh_elastic_of(&mesh, &moduli);
    mesh_free(&mesh);
    return found;
}

/* The moduli of a mesh of equilateral triangles in docs/physics.md, threads of 1000 and 300 N/m. */
UNIT_TEST(equilateral_triangles)
{
    char text[1024];
    size_t used = (size_t)snprintf(text, sizeof text, "v 0 0 0\nvt 0 0\n");
    for (int i = 0; i < 6; i++) {
        const double x = cos(i * acos(0.5)), z = sin(i * acos(0.5));
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "v %.17g 0 %.17g\nvt %.17g %.17g\n", x, z, x, z);
    }
    for (int i = 0; i < 6; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "f 1/1 %d/%d %d/%d\n", i + 2,
                                 i + 2, (i + 1) % 6 + 2, (i + 1) % 6 + 2);
    UNIT_OWNED(mesh_free) struct mesh mesh = read_text(text);
    const double side = 1000 / 4.0 + 300 * 3 / 4.0;
    const struct mesh_elastic expected = {1000, 9 * 1000 * side / (8 * 1000 + side), 3 * side / 8,
                                          1.0 / 3};
    double c[3][3];
    stiffness(&mesh, &(struct mesh_moduli){.stretch = 1000, .weft_excess = -700}, 0, sqrt(3) / 2,
              c);
    is_inverse(&expected, c);
}

UNIT_TEST(square_cells)
{
    const struct mesh_elastic isotropic = of(900, 450, 1); /* shear half of stretch */
    near(isotropic.warp, 1200);
    near(isotropic.weft, 1200);
    near(isotropic.poisson, 1.0 / 3);
    near(isotropic.shear, 450); /* E / 2 (1 + nu) */
    const struct mesh_elastic one = of(1000, 400, 0);
    near(one.warp, 1000);
    near(one.weft, 1000);
    near(one.shear, 1000 / 7.0); /* 1 / G = 2 / kd + 2 / ks */
    near(one.poisson, 0);
}

UNIT_TEST(no_grid)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const struct mesh_elastic found = mesh_elastic_of(&mesh, &(struct mesh_moduli){.stretch = 1});
    ck_assert(isnan(found.warp) && isnan(found.weft) && isnan(found.shear) && isnan(found.poisson));
}

UNIT_TEST(without_shear_or_stretch)
{
    for (int both = 0; both < 2; both++) {
        const struct mesh_elastic threads = of(1000, 0, both);
        near(threads.warp, 1000);
        near(threads.weft, 1000);
        near(threads.shear, 0);
        near(threads.poisson, 0);
        ck_assert(isnan(of(0, 0, both).poisson));
        near(of(0, 0, both).warp, 0);
    }
    near(of(0, 100, 0).shear, 0); /* diagonals turn, and nothing holds them */
    near(of(0, 100, 1).warp, 0);
    near(of(0, 100, 1).poisson, 1);
}
