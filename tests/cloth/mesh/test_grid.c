/* Grids, what all meshes can do with their vertices, and the frame they stand in. */
#include "tests/cloth/mesh/tools.h"

#include <math.h>
#include <stdlib.h>

UNIT_TEST(numbering)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(2, 3, 3, 4);
    ck_assert_uint_eq(mesh.n_vertices, 12);
    ck_assert_uint_eq(mesh.grid_nx, 3);
    ck_assert_uint_eq(mesh.grid_ny, 4);
    for (uint32_t j = 0; j < 4; j++) {
        for (uint32_t i = 0; i < 3; i++) {
            const double *x = mesh.position + 3 * (j * 3 + i);
            double uv[2];
            ck_assert_int_eq(mesh_uv(&mesh, j * 3 + i, uv), 1);
            ck_assert_double_eq(x[0], -1.0 + i);
            ck_assert_double_eq(x[1], 0);
            ck_assert_double_eq(x[2], -1.5 + j);
            ck_assert_double_eq(uv[0], i);
            ck_assert_double_eq(uv[1], j);
        }
    }
    const uint32_t expected[][3] = {{0, 3, 4},
                                    {0, 4, 1},
                                    {1, 4, 5},
                                    {1, 5, 2},
                                    {3, 6, 7}}; /* the diagonals are 0-4, 1-5, ... */
    for (uint32_t t = 0; t < 5; t++) {
        uint32_t corner[3];
        mesh_corners(&mesh, t, corner);
        ck_assert_mem_eq(corner, expected[t], sizeof corner);
    }
}

/* Cells that are turned, row after row. */
static void turns_are(enum mesh_cells cells, uint32_t nx, uint32_t ny, const char *turns)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(1, 1, nx, ny, cells);
    for (uint32_t j = 0; j + 1 < ny; j++)
        for (uint32_t i = 0; i + 1 < nx; i++)
            ck_assert_int_eq(mesh_cell_turned(&mesh, i, j), *turns++ == '/');
}

UNIT_TEST(diagonals)
{
    turns_are(MESH_SAME, 4, 3, "\\\\\\\\\\\\");
    turns_are(MESH_ALTERNATE, 4, 3, "\\/\\/\\/");
    turns_are(MESH_MIRRORED, 5, 5, "\\\\//\\\\////\\\\//\\\\");
    turns_are(MESH_MIRRORED, 4, 5, "\\\\/\\///\\\\//\\"); /* the middle column by turns */
    turns_are(MESH_MIRRORED, 5, 2, "\\/\\/");             /* the only row, too, from either end */
    turns_are(MESH_MIRRORED, 2, 2, "\\");
}

/* Where counts of cells are even, the mirror image of a cell is turned the other way. */
UNIT_TEST(mirror_images)
{
    const enum mesh_cells symmetric[] = {MESH_ALTERNATE, MESH_MIRRORED};
    for (size_t k = 0; k < 2; k++) {
        UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(1, 1, 7, 9, symmetric[k]);
        for (uint32_t j = 0; j < 8; j++) {
            for (uint32_t i = 0; i < 6; i++) {
                ck_assert(mesh_cell_turned(&mesh, i, j) != mesh_cell_turned(&mesh, 5 - i, j));
                ck_assert(mesh_cell_turned(&mesh, i, j) != mesh_cell_turned(&mesh, i, 7 - j));
            }
        }
    }
}

UNIT_TEST(turned_triangles)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(1, 1, 3, 2, MESH_ALTERNATE);
    const uint32_t expected[][3] = {{0, 3, 4}, {0, 4, 1}, {2, 1, 4}, {2, 4, 5}};
    for (uint32_t t = 0; t < 4; t++) {
        uint32_t corner[3];
        mesh_corners(&mesh, t, corner);
        ck_assert_mem_eq(corner, expected[t], sizeof corner);
    }
}

static void triangles_of(enum mesh_cells cells)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(1, 1, 150, 150, cells);
    ck_assert_uint_eq(mesh.n_triangles, 44402);
    ck_assert_uint_eq(mesh.n_faces, 44402);
    for (uint32_t t = 0; t < mesh.n_triangles; t++) { /* y of (q - p) x (r - p) */
        uint32_t corner[3], room[3];
        const uint32_t *face;
        mesh_corners(&mesh, t, corner);
        ck_assert_uint_eq(mesh_face(&mesh, t, room, &face), 3);
        ck_assert_mem_eq(face, corner, sizeof corner);
        const double *p = mesh.position + 3 * corner[0];
        const double *q = mesh.position + 3 * corner[1];
        const double *r = mesh.position + 3 * corner[2];
        ck_assert_double_gt((q[2] - p[2]) * (r[0] - p[0]) - (q[0] - p[0]) * (r[2] - p[2]), 0);
    }
}

UNIT_TEST(triangles)
{
    triangles_of(MESH_SAME);
    triangles_of(MESH_ALTERNATE);
    triangles_of(MESH_MIRRORED);
}

UNIT_TEST(centred_to_the_bit)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(0.7, 1.3, 37, 8);
    uint32_t n = mesh.n_vertices;
    for (uint32_t v = 0; v < n; v++) {
        ck_assert(mesh.position[3 * v] == -mesh.position[3 * (n - 1 - v)]);
        ck_assert(mesh.position[3 * v + 2] == -mesh.position[3 * (n - 1 - v) + 2]);
    }
    ck_assert(mesh.position[0] == -0.35);
}

UNIT_TEST(wrong_sizes)
{
    const struct {
        double width, height;
        uint32_t nx, ny;
        const char *says;
    } wrong[] = {
        {0, 1, 2, 2, "must be positive"},
        {1, -1, 2, 2, "must be positive"},
        {NAN, 1, 2, 2, "must be positive"},
        {1, INFINITY, 2, 2, "must be positive"},
        {1, 1, 1, 2, "at least 2"},
        {1, 1, 2, 0, "at least 2"},
        {1, 1, 65536, 65536, "is too large"},
        {1, 1, 4294967295u, 4294967295u, "is too large"},
        {1, 1, 20000, 20000, "at most 357913941"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct mesh mesh;
        UNIT_REFUSED(mesh_grid(&mesh, wrong[i].width, wrong[i].height, wrong[i].nx, wrong[i].ny,
                               MESH_SAME, &error),
                     CLOTH_E_INPUT, wrong[i].says);
        ck_assert_ptr_null(mesh.position);
    }
}

UNIT_TEST(mass_of_vertices)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(1.5, 0.8, 41, 23);
    double *mass = calloc(mesh.n_vertices, sizeof *mass), sum = 0;
    mass[0] = 1; /* is added to */
    mesh_add_mass(&mesh, 0.25, false, mass);
    for (uint32_t v = 0; v < mesh.n_vertices; v++)
        sum += mass[v];
    ck_assert_double_eq_tol(sum, 1 + 1.5 * 0.8 * 0.25, 1e-13);
    double cell = 1.5 / 40 * 0.8 / 22 * 0.25;
    ck_assert_double_eq_tol(mass[0], 1 + cell / 3, 1e-15);   /* two triangles */
    ck_assert_double_eq_tol(mass[40], cell / 6, 1e-15);      /* one */
    ck_assert_double_eq_tol(mass[41 * 10 + 7], cell, 1e-15); /* six */
    ck_assert_double_eq_tol(mass[20], cell / 2, 1e-15);      /* three */
    free(mass);
}

UNIT_TEST(equilateral)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(2, 0, 5, 4, MESH_EQUILATERAL);
    double mass[18] = {0}, uv[2];
    ck_assert_uint_eq(mesh.n_vertices, 18);
    ck_assert_uint_eq(mesh.n_triangles, 3 * 7);
    ck_assert_uint_eq(mesh.grid_nx, 0);
    for (uint32_t t = 0; t < mesh.n_triangles; t++) {
        uint32_t c[3];
        mesh_corners(&mesh, t, c);
        for (int i = 0; i < 3; i++)
            ck_assert_double_eq_tol(mesh_distance(mesh.position, c[i], c[(i + 1) % 3]), 0.5, 1e-15);
        const double *p = mesh.position + 3 * c[0], *q = mesh.position + 3 * c[1],
                     *r = mesh.position + 3 * c[2];
        ck_assert_double_gt((q[2] - p[2]) * (r[0] - p[0]) - (q[0] - p[0]) * (r[2] - p[2]), 0);
    }
    for (uint32_t j = 0, v = 0; j < 4; j++) /* its own mirror image */
        for (uint32_t i = 0, n = 5 - j % 2; i < n; i++, v++) {
            ck_assert(mesh.position[3 * v] == -mesh.position[3 * (v + n - 1 - 2 * i)]);
            ck_assert(mesh_uv(&mesh, v, uv));
            ck_assert_double_eq_tol(uv[0], mesh.position[3 * v] + 1, 1e-15);
            ck_assert_double_eq_tol(uv[1], j * sqrt(3) / 4, 1e-15);
        }
    ck_assert_double_eq(mesh.position[0], -1);
    ck_assert_double_eq_tol(mesh.position[2], -3 * sqrt(3) / 8, 1e-15);
    mesh_add_mass(&mesh, 1, false, mass);
    ck_assert_double_eq_tol(mass[6], sqrt(3) / 16 * 2, 1e-15); /* six */
    mesh_free(&mesh);
    mesh = grid_of(1, 0, 2, 2, MESH_EQUILATERAL);
    ck_assert_uint_eq(mesh.n_triangles, 1);
}

UNIT_TEST(mass_of_cells)
{
    const enum mesh_cells all[] = {MESH_SAME, MESH_ALTERNATE, MESH_MIRRORED};
    for (size_t k = 0; k < 3; k++) {
        UNIT_OWNED(mesh_free) struct mesh mesh = grid_of(1.5, 0.8, 4, 3, all[k]);
        double mass[12] = {1};
        mesh_add_mass(&mesh, 0.25, true, mass);
        const double cell = 0.5 * 0.4 * 0.25;
        ck_assert_double_eq_tol(mass[0], 1 + cell / 4, 1e-15);
        ck_assert_double_eq_tol(mass[3], cell / 4, 1e-15);
        ck_assert_double_eq_tol(mass[2], cell / 2, 1e-15);
        ck_assert_double_eq_tol(mass[4], cell / 2, 1e-15);
        ck_assert_double_eq_tol(mass[5], cell, 1e-15);
    }
    double third[3] = {0};
    UNIT_OWNED(mesh_free)
    struct mesh one = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"); /* has no cells */
    mesh_add_mass(&one, 6, true, third);
    ck_assert_double_eq_tol(third[0], 1, 1e-15);
}

UNIT_TEST(identity_keeps_bits)
{
    double x[6] = {-0.0, 5e-324, 0.1, -1e308, 3.0, -0.0}, before[6];
    struct mesh mesh = {.n_vertices = 2, .position = x};
    struct mesh_transform same = mesh_identity;
    memcpy(before, x, sizeof x);
    mesh_apply(&mesh, &same);
    ck_assert_mem_eq(x, before, sizeof x);
    same.rotate[0] = -3; /* also the identity, not normalised */
    same.translate[1] = -0.0;
    mesh_apply(&mesh, &same);
    ck_assert_mem_eq(x, before, sizeof x);
    memset(same.rotate, 0, sizeof same.rotate);
    mesh_apply(&mesh, &same);
    ck_assert_mem_eq(x, before, sizeof x);
}

UNIT_TEST(scale_then_rotate_then_translate)
{
    double x[6] = {1, 2, 3, 0, 0, 1};
    struct mesh mesh = {.n_vertices = 2, .position = x};
    /* a quarter turn about y: z -> x, x -> -z */
    struct mesh_transform transform = {{2, 3, 4}, {5, 0, 5, 0}, {10, 20, 30}};
    mesh_apply(&mesh, &transform);
    const double expected[6] = {22, 26, 28, 14, 20, 30};
    for (int i = 0; i < 6; i++)
        ck_assert_double_eq_tol(x[i], expected[i], 1e-13);
    double y[3] = {0, 1, 0};
    struct mesh one = {.n_vertices = 1, .position = y};
    struct mesh_transform about_x = {
        {1, 1, 1}, {sqrt(0.75), 0.5, 0, 0}, {0, 0, 0}}; /* 60 degrees */
    mesh_apply(&one, &about_x);
    ck_assert_double_eq_tol(y[1], 0.5, 1e-15);
    ck_assert_double_eq_tol(y[2], sqrt(0.75), 1e-15);
}

UNIT_TEST(areas)
{
    const double x[9] = {0, 0, 0, 3, 0, 0, 0, 0, 4};
    const uint32_t corner[3] = {0, 1, 2};
    ck_assert_double_eq(mesh_area(x, corner), 6);
    ck_assert_double_eq(mesh_distance(x, 1, 2), 5);
}

UNIT_TEST(free_twice)
{
    struct mesh mesh = {0};
    mesh_free(&mesh);
    mesh = grid(1, 1, 2, 2);
    mesh_free(&mesh);
    mesh_free(&mesh);
    ck_assert_uint_eq(mesh.n_vertices, 0);
}
