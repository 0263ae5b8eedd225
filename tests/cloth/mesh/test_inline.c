/* Meshes from arrays. */
#include "tests/cloth/mesh/tools.h"

#include <math.h>

static const double SQUARE[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

UNIT_TEST(copies)
{
    double x[12];
    uint32_t edges[4] = {3, 1, 1, 0}, triangles[6] = {0, 1, 2, 2, 3, 0};
    UNIT_OWNED(mesh_free) struct mesh mesh;
    memcpy(x, SQUARE, sizeof x);
    UNIT_FINE(mesh_inline(&mesh, 4, x, 2, edges, 2, triangles, &error));
    memset(x, 0, sizeof x);
    const uint32_t start[3] = {0, 3, 6};
    ck_assert_mem_eq(mesh.position, SQUARE, sizeof SQUARE);
    ck_assert_mem_eq(mesh.lone_edge, edges, sizeof edges); /* as given */
    ck_assert_mem_eq(mesh.face_corner, triangles, sizeof triangles);
    ck_assert_mem_eq(mesh.triangle, triangles, sizeof triangles);
    ck_assert_mem_eq(mesh.face_start, start, sizeof start);
    ck_assert_uint_eq(mesh.n_vertices, 4);
    ck_assert_uint_eq(mesh.n_lone_edges, 2);
    ck_assert_uint_eq(mesh.n_faces, 2);
    ck_assert_uint_eq(mesh.n_triangles, 2);
    ck_assert_ptr_null(mesh.uv);
    ck_assert_uint_eq(mesh.grid_nx, 0);
}

UNIT_TEST(a_chain_and_a_point)
{
    const uint32_t edges[6] = {0, 1, 1, 2, 2, 3};
    UNIT_OWNED(mesh_free) struct mesh mesh;
    ck_assert_int_eq(mesh_inline(&mesh, 4, SQUARE, 3, edges, 0, NULL, NULL), CLOTH_OK);
    ck_assert_uint_eq(mesh.n_triangles, 0);
    ck_assert_uint_eq(mesh.n_lone_edges, 3);
    mesh_free(&mesh);
    ck_assert_int_eq(mesh_inline(&mesh, 1, SQUARE, 0, NULL, 0, NULL, NULL), CLOTH_OK);
    unsigned char used = 1;
    mesh_used(&mesh, &used);
    ck_assert_uint_eq(used, 0);
}

static void fails(uint32_t n_vertices, const double *x, uint32_t n_edges, const uint32_t *edges,
                  uint32_t n_triangles, const uint32_t *triangles, const char *says)
{
    struct mesh mesh;
    UNIT_CALL(mesh_inline(&mesh, n_vertices, x, n_edges, edges, n_triangles, triangles, &error),
              ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
              ck_assert_str_eq(error.text, says));
    ck_assert_ptr_null(mesh.position);
}

UNIT_TEST(wrong_entries)
{
    double x[12];
    memcpy(x, SQUARE, sizeof x);
    x[7] = NAN;
    fails(4, x, 0, NULL, 0, NULL, "vertices[2]: nan is not a finite number");
    x[7] = -INFINITY;
    fails(4, x, 0, NULL, 0, NULL, "vertices[2]: -inf is not a finite number");
    fails(0, x, 0, NULL, 0, NULL, "the mesh has no vertices; it needs at least one");

    fails(4, SQUARE, 2, (uint32_t[]){0, 1, 1, 4}, 0, NULL,
          "edges[1]: there is no vertex 4; the mesh has the vertices 0 to 3");
    fails(4, SQUARE, 2, (uint32_t[]){0, 1, 1, 1}, 0, NULL,
          "edges[1]: the edge joins vertex 1 to itself; its ends must differ");
    fails(4, SQUARE, 0, NULL, 2, (uint32_t[]){0, 1, 2, 0, 4294967295u, 3},
          "triangles[1]: there is no vertex 4294967295; the mesh has the vertices 0 to 3");
    fails(4, SQUARE, 0, NULL, 2, (uint32_t[]){0, 1, 2, 3, 0, 3},
          "triangles[1]: the face has vertex 3 at two corners; corners must differ");
}

UNIT_TEST(edges_that_stand_twice)
{
    fails(4, SQUARE, 3, (uint32_t[]){0, 1, 1, 2, 1, 0}, 0, NULL,
          "edges[2]: the edge between vertices 0 and 1 stands here again, after entry 0; give it "
          "once");
    fails(4, SQUARE, 4, (uint32_t[]){0, 1, 1, 2, 2, 1, 1, 2}, 1, (uint32_t[]){0, 1, 2},
          "edges[2]: the edge between vertices 1 and 2 stands here again, after entry 1; give it "
          "once");
}

UNIT_TEST(too_large)
{
    fails(2147483649u, SQUARE, 0, NULL, 0, NULL,
          "the mesh is too large: at most 2147483648 vertices, 715827882 triangles and 1073741824 "
          "edges");
}

UNIT_TEST(non_manifold)
{
    double x[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 5, 5};
    const uint32_t triangles[] = {0, 1, 2, 2, 3, 0, 0, 2, 4};
    fails(5, x, 0, NULL, 3, triangles,
          "triangles[2]: this face is the third at the edge between vertices 0 and 2 "
          "(non-manifold); an edge may have at most two triangles");
    /* a lone edge there is no third use */
    UNIT_OWNED(mesh_free) struct mesh mesh;
    const uint32_t edge[] = {2, 0};
    ck_assert_int_eq(mesh_inline(&mesh, 5, x, 1, edge, 2, triangles, NULL), CLOTH_OK);
}

/* A chain of vertices each near the next: those that stand for others are not near each other. */
UNIT_TEST(vertices_on_one_place)
{
    const double x[] = {-1e-5, 0, 0,       5e-6, 0, 0,    1.2e-5, 0, 0, 1,     1, 1,
                        1,     1, 1.00001, 1,    1, 0.99, -1e-5,  0, 0, 1e300, 0, 0};
    const uint32_t edges[] = {0, 3, 1, 4, 2, 5, 3, 5, 5, 7};
    UNIT_OWNED(mesh_free) struct mesh mesh;
    uint32_t same[8];
    UNIT_FINE(mesh_inline(&mesh, 8, x, 5, edges, 0, NULL, &error));
    UNIT_FINE(mesh_coincide(&mesh, 2e-5, same, &error));
    const uint32_t expected[] = {0, 0, 2, 3, 3, 5, 6, 7}; /* nothing uses vertex 6 */
    ck_assert_mem_eq(same, expected, sizeof same);
    UNIT_FINE(mesh_coincide(&mesh, 1e-300, same, &error));
    for (uint32_t v = 0; v < 8; v++)
        ck_assert_uint_eq(same[v], v);
}
