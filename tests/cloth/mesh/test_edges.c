/* Edges against what can be counted by hand. */
#include "tests/cloth/mesh/tools.h"

#include <math.h>

static struct mesh_edges edges_of(const struct mesh *mesh)
{
    struct mesh_edges edges;
    UNIT_FINE(mesh_edges_find(&edges, mesh, &error));
    for (uint32_t e = 0; e < edges.n; e++) {
        ck_assert_uint_lt(edges.edge[e].a, edges.edge[e].b);
        ck_assert(
            e == 0 || edges.edge[e - 1].a < edges.edge[e].a ||
            (edges.edge[e - 1].a == edges.edge[e].a && edges.edge[e - 1].b < edges.edge[e].b));
    }
    return edges;
}

static const struct mesh_edge *find(const struct mesh_edges *edges, uint32_t a, uint32_t b)
{
    for (uint32_t e = 0; e < edges->n; e++)
        if (edges->edge[e].a == a && edges->edge[e].b == b)
            return &edges->edge[e];
    ck_abort_msg("no edge %u-%u", a, b);
    return NULL;
}

UNIT_TEST(of_a_grid)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(2, 3, 3, 4);
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges = edges_of(&mesh);
    uint32_t border = 0;
    ck_assert_uint_eq(edges.n, 2 * 4 + 3 * 3 + 2 * 3); /* rows, columns, diagonals */
    for (uint32_t e = 0; e < edges.n; e++)
        border += edges.edge[e].opposite[1] == UINT32_MAX;
    ck_assert_uint_eq(border, 2 * (2 + 3));
    const struct mesh_edge *diagonal = find(&edges, 0, 4), *top = find(&edges, 0, 1);
    ck_assert_uint_eq(diagonal->opposite[0], 3);
    ck_assert_uint_eq(diagonal->opposite[1], 1);
    ck_assert_double_eq_tol(diagonal->area, 1, 1e-15);
    ck_assert_uint_eq(top->opposite[0], 4);
    ck_assert_uint_eq(top->opposite[1], UINT32_MAX);
    ck_assert_double_eq_tol(top->area, 0.5, 1e-15);
}

UNIT_TEST(area_as_positioned)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = grid(1, 1, 2, 2);
    struct mesh_transform larger = {{2, 7, 3}, {1, 1, 0, 0}, {1, 2, 3}};
    mesh_apply(&mesh, &larger);
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges = edges_of(&mesh);
    ck_assert_double_eq_tol(find(&edges, 0, 3)->area, 6, 1e-14);
}

UNIT_TEST(lone_edges_join)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\n"
                                 "f 1 2 3\nl 5 4\nl 4 2\nl 2 1\n");
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges = edges_of(&mesh);
    ck_assert_uint_eq(edges.n, 5); /* three sides, 3-4 once, 1-3 */
    const struct mesh_edge *lone = find(&edges, 3, 4), *shared = find(&edges, 0, 1);
    ck_assert_uint_eq(lone->opposite[0], UINT32_MAX);
    ck_assert(lone->area == 0);
    ck_assert_uint_eq(shared->opposite[0], 2); /* the triangle's, once */
    ck_assert_double_eq(shared->area, 0.5);
}

UNIT_TEST(either_winding_and_pillow)
{
    /* two triangles over the same three vertices, and a neighbour wound the other way */
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 5 1 0\nv 6 0 0\nv 6 1 0\n"
                                 "f 1 2 3\nf 1 3 2\nf 4 5 6\nf 5 6 7\n");
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges = edges_of(&mesh);
    ck_assert_uint_eq(edges.n, 3 + 5);
    ck_assert_uint_eq(find(&edges, 0, 1)->opposite[0], 2);
    ck_assert_uint_eq(find(&edges, 0, 1)->opposite[1], 2);
    ck_assert_uint_eq(find(&edges, 4, 5)->opposite[0], 3);
    ck_assert_uint_eq(find(&edges, 4, 5)->opposite[1], 6);
}

UNIT_TEST(none_at_all)
{
    UNIT_OWNED(mesh_free) struct mesh mesh = read_text("v 0 0 0\nv 1 0 0\n");
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges = edges_of(&mesh);
    ck_assert_uint_eq(edges.n, 0);
}

UNIT_TEST(non_manifold)
{
    double x[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 5, 5};
    uint32_t triangles[] = {0, 1, 2, 2, 3, 0, 0, 2, 4};
    struct mesh mesh = {.n_vertices = 5, .position = x, .n_triangles = 3, .triangle = triangles};
    struct mesh_edges edges;
    UNIT_REFUSED(mesh_edges_find(&edges, &mesh, &error), CLOTH_E_INPUT, "triangle 3 is the third");
    ck_assert_ptr_null(edges.edge);
}

/* A hub with many spokes, and many vertices: counted by Euler's formula. */
UNIT_TEST(a_large_fan)
{
    enum { N = 20000 };
    static double x[3 * (N + 1)];
    static uint32_t triangles[3 * N];
    for (uint32_t i = 0; i < N; i++) {
        x[3 * i] = cos(i * 6.283185307179586 / N);
        x[3 * i + 1] = sin(i * 6.283185307179586 / N);
        triangles[3 * i] = N;
        triangles[3 * i + 1] = (i + 1) % N;
        triangles[3 * i + 2] = i;
    }
    UNIT_OWNED(mesh_free) struct mesh mesh;
    ck_assert_int_eq(mesh_inline(&mesh, N + 1, x, 0, NULL, N, triangles, NULL), CLOTH_OK);
    UNIT_OWNED(mesh_edges_free) struct mesh_edges edges = edges_of(&mesh);
    ck_assert_int_eq((int)mesh.n_vertices - (int)edges.n + (int)mesh.n_triangles, 1); /* a disc */
}
