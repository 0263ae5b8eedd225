/* Springs against counts, lengths and stiffnesses found by hand. */
#include "cloth/mesh/lattice.h"
#include "tests/cloth/mesh/tools.h"

#include <math.h>

static struct mesh_lattice lattice_of(const struct mesh *mesh, double stretch, double shear,
                                      double bend, int both)
{
    struct mesh_lattice lattice;
    struct mesh_moduli moduli = {stretch, shear, bend, both, 0, NULL, stretch};
    UNIT_FINE(mesh_lattice_build(&lattice, mesh, &moduli, &error));
    struct mesh_spring *spring = springs_of(&lattice); /* as they are visited, a grid's too */
    free(lattice.spring);
    lattice.spring = spring;
    for (uint32_t s = 0; s < lattice.n; s++) {
        const struct mesh_spring *here = &lattice.spring[s], *last = here - 1;
        ck_assert_uint_lt(here->a, here->b);
        ck_assert_double_gt(here->stiffness, 0);
        ck_assert(s == 0 || last->a < here->a ||
                  (last->a == here->a &&
                   (last->b < here->b || (last->b == here->b && last->kind <= here->kind))));
    }
    return lattice;
}

static const struct mesh_spring *find(const struct mesh_lattice *lattice, uint32_t a, uint32_t b,
                                      enum mesh_spring_kind kind)
{
    for (uint32_t s = 0; s < lattice->n; s++)
        if (lattice->spring[s].a == a && lattice->spring[s].b == b &&
            lattice->spring[s].kind == kind)
            return &lattice->spring[s];
    return NULL;
}

static uint32_t count(const struct mesh_lattice *lattice, enum mesh_spring_kind kind)
{
    uint32_t n = 0;
    for (uint32_t s = 0; s < lattice->n; s++)
        n += lattice->spring[s].kind == kind;
    return n;
}

static void spring_is(const struct mesh_lattice *lattice, uint32_t a, uint32_t b,
                      enum mesh_spring_kind kind, double stiffness, double length)
{
    const struct mesh_spring *spring = find(lattice, a, b, kind);
    ck_assert_msg(spring != NULL, "no spring %u-%u of kind %d", a, b, kind);
    ck_assert_double_eq_tol(spring->stiffness, stiffness, 1e-12 * stiffness);
    ck_assert_double_eq_tol(spring->length, length, 1e-14);
}

UNIT_TEST(grid_with_both_diagonals)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(4, 6, 5, 4); /* cells of 1 x 2 m */
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 100, 10, 1, 1);
    ck_assert_uint_eq(count(&lattice, MESH_STRETCH), 4 * 4 + 5 * 3);
    ck_assert_uint_eq(count(&lattice, MESH_SHEAR), 2 * 4 * 3);
    ck_assert_uint_eq(count(&lattice, MESH_BEND), 3 * 4 + 5 * 2);
    ck_assert_uint_eq(lattice.n, 31 + 24 + 22);
    spring_is(&lattice, 0, 1, MESH_STRETCH, 50, 1);   /* first row */
    spring_is(&lattice, 18, 19, MESH_STRETCH, 50, 1); /* last row */
    spring_is(&lattice, 5, 6, MESH_STRETCH, 100, 1);  /* inner row, touching the border */
    spring_is(&lattice, 0, 5, MESH_STRETCH, 50, 2);   /* first column */
    spring_is(&lattice, 9, 14, MESH_STRETCH, 50, 2);  /* last column */
    spring_is(&lattice, 1, 6, MESH_STRETCH, 100, 2);
    spring_is(&lattice, 0, 6, MESH_SHEAR, 10, sqrt(5));
    spring_is(&lattice, 1, 5, MESH_SHEAR, 10, sqrt(5));
    spring_is(&lattice, 0, 2, MESH_BEND, 0.5, 2);
    spring_is(&lattice, 5, 7, MESH_BEND, 1, 2);
    spring_is(&lattice, 0, 10, MESH_BEND, 0.5, 4);
    spring_is(&lattice, 6, 16, MESH_BEND, 1, 4);
    spring_is(&lattice, 9, 19, MESH_BEND, 0.5, 4);
}

UNIT_TEST(grid_with_one_diagonal)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(4, 6, 5, 4);
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 100, 10, 1, 0);
    ck_assert_uint_eq(lattice.n, 31 + 12 + 22);
    ck_assert_uint_eq(count(&lattice, MESH_SHEAR), 4 * 3);
    spring_is(&lattice, 0, 6, MESH_SHEAR, 10, sqrt(5)); /* that of the triangles */
    ck_assert_ptr_null(find(&lattice, 1, 5, MESH_SHEAR));
}

/* The springs of a grid with one diagonal are the edges of its triangles. */
UNIT_TEST(one_diagonal_is_that_of_the_triangles)
{
    const enum mesh_cells all[] = {MESH_SAME, MESH_ALTERNATE, MESH_MIRRORED};
    for (size_t k = 0; k < 3; k++) {
        UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(4, 6, 6, 5, all[k]);
        UNIT_OWNED(mesh_lattice_free)
        struct mesh_lattice lattice = lattice_of(&mesh, 100, 10, 0, 0);
        struct mesh_edges edges;
        UNIT_FINE(mesh_edges_find(&edges, &mesh, &error));
        ck_assert_uint_eq(lattice.n, edges.n);
        for (uint32_t e = 0; e < edges.n; e++) {
            ck_assert_uint_eq(lattice.spring[e].a, edges.edge[e].a);
            ck_assert_uint_eq(lattice.spring[e].b, edges.edge[e].b);
        }
        mesh_edges_free(&edges);
        mesh_lattice_free(&lattice);
        lattice = lattice_of(&mesh, 100, 10, 0, 1);
        ck_assert_uint_eq(count(&lattice, MESH_SHEAR), 2 * 5 * 4);
    }
}

/* All springs alike, but half of it at the border: E = 2 / sqrt(3) k is the modulus. */
UNIT_TEST(equilateral_springs)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(1, 0, 9, 8, MESH_EQUILATERAL);
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 100, 10, 0, 1);
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges;
    UNIT_FINE(mesh_edges_find(&edges, &mesh, &error));
    ck_assert_uint_eq(lattice.n, edges.n);
    for (uint32_t e = 0; e < edges.n; e++) {
        const double k = edges.edge[e].opposite[1] == UINT32_MAX ? 0.5 : 1;
        ck_assert_double_eq_tol(lattice.spring[e].stiffness, k * 100 * sqrt(0.75), 1e-11);
        ck_assert_double_eq_tol(lattice.spring[e].length, 0.125, 1e-15);
    }
}

UNIT_TEST(the_sheet)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(1, 1, 150, 150);
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 1, 1, 1, 1);
    ck_assert_uint_eq(lattice.n, 2 * 149 * 150 + 2 * 149 * 149 + 2 * 148 * 150);
    double sum = 0; /* along u: 148 inner rows and two halves are 149 whole ones */
    for (uint32_t s = 0; s < lattice.n; s++)
        if (lattice.spring[s].kind == MESH_STRETCH)
            sum += lattice.spring[s].stiffness;
    ck_assert_double_eq(sum, 2 * 149 * 149);
}

UNIT_TEST(small_grids)
{
    const uint32_t sizes[][3] = {{2, 2, 6}, {2, 3, 11 + 2}, {3, 2, 11 + 2}, {3, 3, 20 + 6}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        UNIT_OWNED(mesh_free) struct mesh mesh = grid(1, 1, sizes[i][0], sizes[i][1]);
        UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 1, 1, 1, 1);
        ck_assert_uint_eq(lattice.n, sizes[i][2]);
    }
}

UNIT_TEST(without_stiffness_no_spring)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(4, 6, 5, 4);
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 0, 10, 0, 1);
    ck_assert_uint_eq(lattice.n, 24);
    mesh_lattice_free(&lattice);
    lattice = lattice_of(&mesh, 0, 0, 0, 1);
    ck_assert_uint_eq(lattice.n, 0);
}

UNIT_TEST(lengths_as_positioned)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(4, 6, 5, 4);
    struct mesh_transform transform = {{3, 1, 0.5}, {1, 0, 0, 2}, {7, 8, 9}};
    mesh_apply(&mesh, &transform);
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 100, 10, 1, 0);
    spring_is(&lattice, 5, 6, MESH_STRETCH, 100, 3);
    spring_is(&lattice, 1, 6, MESH_STRETCH, 100, 1);
    spring_is(&lattice, 0, 6, MESH_SHEAR, 10, sqrt(10));
}

UNIT_TEST(triangle_meshes)
{
    /* two triangles with the legs 3 and 4, joined at the long side 1-2; a chain; a lone edge on a
     * side */
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("v 0 0 0\nv 3 0 0\nv 0 4 0\nv 3 4 0\nv 9 0 0\nv 9 0 2\n"
                                 "f 1 2 3\nf 2 4 3\nl 5 6\nl 1 2\n");
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 100, 77, 10, 1);
    ck_assert_uint_eq(lattice.n, 5 + 1 + 1);
    spring_is(&lattice, 0, 1, MESH_STRETCH, 100 * 6.0 / 9, 3);
    spring_is(&lattice, 0, 2, MESH_STRETCH, 100 * 6.0 / 16, 4);
    spring_is(&lattice, 1, 2, MESH_STRETCH, 100 * 12.0 / 25, 5);
    spring_is(&lattice, 1, 3, MESH_STRETCH, 100 * 6.0 / 16, 4);
    spring_is(&lattice, 0, 3, MESH_BEND, 10 * 12.0 / 25, 5);
    spring_is(&lattice, 4, 5, MESH_STRETCH, 100 / 2.0, 2); /* EA / length */
    mesh_lattice_free(&lattice);
    lattice = lattice_of(&mesh, 100, 77, 0, 1);
    ck_assert_uint_eq(lattice.n, 6);
}

UNIT_TEST(stretch_and_bend_of_the_same_vertices)
{
    /* a tetrahedron: opposite vertices of each edge are joined by an edge, too; and a pillow: they
     * are one */
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                 "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 1, 1, 1, 1);
    ck_assert_uint_eq(lattice.n, 12);
    for (uint32_t s = 0; s < 12; s++)
        ck_assert_int_eq(lattice.spring[s].kind, s % 2 ? MESH_BEND : MESH_STRETCH);
    mesh_lattice_free(&lattice);
    mesh_free(&mesh);
    mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
    lattice = lattice_of(&mesh, 1, 1, 1, 1);
    ck_assert_uint_eq(lattice.n, 3);
}

static void fails(const struct mesh *mesh, double bend, const char *says)
{
    struct mesh_lattice lattice;
    struct mesh_moduli moduli = {1, 1, bend, 1, 0, NULL, 0};
    UNIT_REFUSED(mesh_lattice_build(&lattice, mesh, &moduli, &error), CLOTH_E_INPUT, says);
    ck_assert(lattice.n == 0 && !lattice.spring);
}

UNIT_TEST(no_length)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n");
    fails(&mesh, 0, "vertices 2 and 3 (counted from 1) are 0 m apart");
    mesh_free(&mesh);
    mesh = read_text("v 0 0 0\nv 1e200 0 0\nl 1 2\n");
    fails(&mesh, 0, "vertices 1 and 2 (counted from 1) are inf m apart");
    mesh_free(&mesh);
    mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nf 1 2 3\nf 2 1 4\n"); /* folded flat */
    fails(&mesh, 1, "vertices 3 and 4 (counted from 1) are 0 m apart");
    struct mesh_lattice lattice = lattice_of(&mesh, 1, 1, 0, 1);
    ck_assert_uint_eq(lattice.n, 5);
    mesh_lattice_free(&lattice);
    mesh_free(&mesh);
    mesh = grid(1, 1, 3, 3);
    struct mesh_transform flat = mesh_identity;
    flat.scale[0] = 0;
    mesh_apply(&mesh, &flat);
    fails(&mesh, 1, "vertices 1 and 2 (counted from 1) are 0 m apart");
}

UNIT_TEST(no_area)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh =
        read_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"); /* a needle: no stiffness */
    UNIT_OWNED(mesh_lattice_free) struct mesh_lattice lattice = lattice_of(&mesh, 1, 1, 1, 1);
    ck_assert_uint_eq(lattice.n, 0);
}
