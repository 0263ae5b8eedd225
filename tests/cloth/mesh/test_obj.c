/* The OBJ reader reads good files, however they are written, and refuses bad ones, here those that
 * tests/cloth/scene/sentences.txt cannot hold. */
#include "tests/cloth/mesh/tools.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void corners_are(const struct mesh *mesh, size_t n, const uint32_t *corners)
{
    ck_assert_uint_eq(mesh->n_triangles * 3, n);
    ck_assert_mem_eq(mesh->triangle, corners, n * sizeof *corners);
}

UNIT_TEST(polygons_are_fanned)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh =
        read_text(SQUARE "v 1 -1 0\nv 2 0 0\nv 0 -1 0\nf 3 4 1 2\nf 2 5 6\nf 6 5 7 4 3\n");
    const uint32_t start[] = {0, 4, 7, 12}, corner[] = {2, 3, 0, 1, 1, 4, 5, 5, 4, 6, 3, 2};
    const uint32_t fans[] = {2, 3, 0, 2, 0, 1, 1, 4, 5, 5, 4, 6, 5, 6, 3, 5, 3, 2};
    ck_assert_uint_eq(mesh.n_faces, 3);
    ck_assert_mem_eq(mesh.face_start, start, sizeof start);
    ck_assert_mem_eq(mesh.face_corner, corner, sizeof corner);
    corners_are(&mesh, 18, fans);
    ck_assert_uint_eq(mesh.grid_nx, 0);
    ck_assert_ptr_null(mesh.uv);
}

UNIT_TEST(every_way_to_write_a_corner)
{
    const uint32_t same[] = {0, 1, 2, 0, 2, 3};
    const char *faces[] = {
        "f 1 2 3 4\n",
        "f 1/1 2/1 3/1 4/1\n",
        "f 1//9 2//9 3//9 4//9\n",
        "f 1/1/9 2/1/9 3/1/1 4/1/1\n",
        "f -4 -3 -2 -1\n",
        "f -4/-1 -3/-1/7 3//-1 4/\n",
        "f\t1  2 \t3 4 \r\n",
        "  f 1 2 3 4",
        "f 1 2 3 4 # 5 6",
        "f 1 2 \\\n3 4\n",
        "f 1 2 \\\r\n3 \\\r\n4\r\n",
        "f 1 2 3 4\\",
        "f +1 2 3 4",
        "f 1// 2 3 4\n",
    };
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
        char text[256];
        snprintf(text, sizeof text, SQUARE "vn 0 0 1\nvt 0.5 0.5\n%s", faces[i]);
        UNIT_OWNED(mesh_free) struct mesh mesh = read_text(text);
        corners_are(&mesh, 6, same);
    }
}

UNIT_TEST(numbers)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("\xef\xbb\xbfv 1e-3 -.5 +2. 0.1 0.2 0.3\n"
                                 "v 1 2 3 1.0\nv 4 5 6 red\nv 0.1 1E2 5e-324\n");
    const double x[] = {1e-3, -0.5, 2, 1, 2, 3, 4, 5, 6, 0.1, 100, 5e-324};
    ck_assert_uint_eq(mesh.n_vertices, 4);
    ck_assert_mem_eq(mesh.position, x, sizeof x);
    ck_assert_uint_eq(mesh.n_faces, 0);
    ck_assert_uint_eq(mesh.face_start[0], 0);
}

UNIT_TEST(the_locale_does_not_matter)
{
    setlocale(LC_ALL, "de_DE.UTF-8"); /* where it exists, strtod wants commas */
    UNIT_OWNED(mesh_free) struct mesh mesh = read_text("v 1.5 0 0\n");
    ck_assert_double_eq(mesh.position[0], 1.5);
}

UNIT_TEST(all_else_is_skipped)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("# a comment that ends with C:\\\n" SQUARE
                                 "mtllib a.mtl\no thing\n\n   \ng a b\nusemtl x\ns off\n"
                                 "vp 0 0\nvertex 1\nfoo\nf 1 2 3\np 1\nfo 1 2 4\ncurv 0 1 1 2\n#");
    ck_assert_uint_eq(mesh.n_vertices, 4);
    ck_assert_uint_eq(mesh.n_triangles, 1);
}

UNIT_TEST(faces_may_come_first)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("f 1/1 2/2 3/3\nvt 0 0\nvt 1 0\nvt 0 1\n" SQUARE);
    const uint32_t corner[] = {0, 1, 2};
    corners_are(&mesh, 3, corner);
    ck_assert_double_eq(mesh.uv[2], 1);
}

UNIT_TEST(lone_edges)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text(SQUARE "l 1 2 3\nl -1/7 -4\nvt 0 0\nvt 0 0\nvt 0 0\nvt 0 0\n"
                                        "vt 0 0\nvt 0 0\nvt 0 0\n");
    const uint32_t edges[] = {0, 1, 1, 2, 3, 0};
    ck_assert_uint_eq(mesh.n_lone_edges, 3);
    ck_assert_mem_eq(mesh.lone_edge, edges, sizeof edges);
    ck_assert_uint_eq(mesh.n_triangles, 0);
}

UNIT_TEST(unused_vertices_are_kept)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text("v 9 9 9\n" SQUARE "v 8 8 8\nv 7 7 7\nf 2 3 4\nl 5 6\n");
    unsigned char used[7] = {5, 5, 5, 5, 5, 5, 5};
    const unsigned char expected[7] = {0, 1, 1, 1, 1, 1, 0};
    ck_assert_uint_eq(mesh.n_vertices, 7);
    mesh_used(&mesh, used);
    ck_assert_mem_eq(used, expected, 7);
}

UNIT_TEST(uv_of_vertices)
{
    const struct {
        const char *text;
        int has;
    } files[] = {
        {SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n", 1},
        {SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/2 3/3 4/4\n", 1}, /* a seam */
        {SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/4 3/3 4/4\n", 1},
        {SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4\n", 0},
        {SQUARE "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1 2 3 4\n", 0},
        {SQUARE "vt 0 0\n", 0},
        /* equal values under two numbers are one uv; w and a lone v = 0 */
        {SQUARE "vt 0\nvt 1 0 0.5\nvt 1 1\nvt 0 1\nvt 0 0\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\n", 1},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        UNIT_OWNED(mesh_free) struct mesh mesh = read_text(files[i].text);
        const double uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
        ck_assert_msg((mesh.uv != NULL) == files[i].has, "file %zu", i);
        ck_assert_uint_eq(mesh.n_without_uv, i == 3);
        if (mesh.uv)
            ck_assert_mem_eq(mesh.uv, uv, sizeof uv);
    }
}

/* Vertex 1 has three uv, one of them under two numbers; vertex 3 has two in one polygon and
 * another.
 */
UNIT_TEST(uv_of_corners)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text(SQUARE "v 2 0 0\nv 2 1 0\nv -1 0 0\n"
                                        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 7 7\nvt 5 5\nvt 7 7\n"
                                        "f 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 3/5\nf 1/5 4/4 7/1\n"
                                        "f 7/1 2/2 1/6\n");
    const uint32_t face[] = {0, 1, 2, 3, 1, 4, 5, 9, 8, 3, 6, 6, 1, 7};
    const uint32_t triangle[] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 9, 8, 3, 6, 6, 1, 7};
    const double more[] = {5, 5, 7, 7, 7, 7};
    double uv[2];
    ck_assert_uint_eq(mesh.n_more_uv, 3);
    ck_assert_mem_eq(mesh.face_uv, face, sizeof face);
    ck_assert_mem_eq(mesh.triangle_uv, triangle, sizeof triangle);
    ck_assert_mem_eq(mesh.uv + 14, more, sizeof more);
    ck_assert_uint_eq(mesh_uv_number(&mesh, 3, 2), 9);
    ck_assert_uint_eq(mesh_uv_number(&mesh, 1, 2), 2);
    ck_assert_uint_eq(mesh_uv_number(&mesh, UINT32_MAX, 2), 2);
    ck_assert(mesh_uv(&mesh, 9, uv) && uv[0] == 7 && uv[1] == 7);
}

UNIT_TEST(very_long_lines)
{
    enum { N = 300000 }; /* corners of one face, over several of the reader's chunks */
    size_t room = (size_t)N * 80, n = 0;
    char *text = malloc(room);
    for (int i = 0; i < N; i++)
        n += (size_t)snprintf(text + n, room - n, "v %.17g %.17g 0\n", cos(2 * M_PI * i / N),
                              sin(2 * M_PI * i / N));
    n += (size_t)snprintf(text + n, room - n, "f");
    for (int i = 0; i < N; i++)
        n += (size_t)snprintf(text + n, room - n, i % 1000 ? " %d" : " \\\n%d", i + 1);
    UNIT_OWNED(mesh_free) struct mesh mesh = read_text(text);
    ck_assert_uint_eq(mesh.n_vertices, N);
    ck_assert_uint_eq(mesh.n_faces, 1);
    ck_assert_uint_eq(mesh.n_triangles, N - 2);
    ck_assert_uint_eq(mesh.face_corner[N - 1], N - 1);
    free(text);
}

/* Chunks of the reader end anywhere, also between CR and LF and inside numbers. */
UNIT_TEST(lines_across_chunks)
{
    enum { N = 40000 };
    char *text = malloc((size_t)N * 32);
    for (int shift = 0; shift < 5; shift++) {
        size_t n = (size_t)sprintf(text, "#%*s\r\n", shift, "");
        for (int i = 0; i < N; i++)
            n += (size_t)sprintf(text + n, "v %d 0.25 -1\r\n", i);
        UNIT_OWNED(mesh_free) struct mesh mesh = read_text(text);
        ck_assert_uint_eq(mesh.n_vertices, N);
        for (int i = 0; i < N; i++)
            ck_assert(mesh.position[3 * i] == i && mesh.position[3 * i + 1] == 0.25);
    }
    free(text);
}

/* The bytes of what a group has: "0110". */
static void group_is(const struct mesh *mesh, const char *name, const char *vertices,
                     const char *triangles)
{
    const uint32_t group = mesh_group_of(mesh, name);
    unsigned char vertex[16] = {0}, triangle[16] = {0};
    ck_assert_msg(group < mesh->n_groups, "there is no group %s", name);
    ck_assert(strlen(vertices) == mesh->n_vertices && strlen(triangles) == mesh->n_triangles);
    mesh_group_vertices(mesh, group, vertex);
    mesh_group_triangles(mesh, group, triangle);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        ck_assert_msg(vertex[v] == vertices[v] - '0', "vertex %u of %s", v, name);
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        ck_assert_msg(triangle[t] == triangles[t] - '0', "triangle %u of %s", t, name);
}

UNIT_TEST(groups_of_faces)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh =
        read_text(SQUARE "v 2 0 0\nv 2 1 0\nv 9 9 9\n"
                         "o  all of it # c\ng empty\n g b \ta # c\nf 1 2 3 4\ng\nf 2 5 3\n"
                         "g a\nf 5 6 3\ng b a b\ng e\\\nnd\ng\n");
    ck_assert_uint_eq(mesh.n_groups, 3); /* in the order of the file */
    ck_assert_str_eq(mesh.group[0], "all of it");
    ck_assert_str_eq(mesh.group[1], "b");
    ck_assert_str_eq(mesh.group[2], "a");
    group_is(&mesh, "all of it", "1111110", "1111");
    group_is(&mesh, "b", "1111000", "1100");
    group_is(&mesh, "a", "1111110", "1101");
    ck_assert_uint_eq(mesh_group_of(&mesh, "empty"), UINT32_MAX);
    mesh_free(&mesh);
    mesh = read_text(SQUARE "f 1 2 3\ng last last\nf 1 3 4\n");
    ck_assert_uint_eq(mesh.n_groups, 1);
    group_is(&mesh, "last", "1011", "01");
    ck_assert_int_eq(mesh_group_add(&mesh, "both", 0, 2, NULL), CLOTH_OK);
    group_is(&mesh, "both", "1111", "11");
    group_is(&mesh, "last", "1011", "01");
}

UNIT_TEST(materials_of_faces)
{
    UNIT_OWNED(mesh_free)
    struct mesh mesh = read_text(SQUARE "mtllib gone.mtl  other.mtl\nmtllib other.mtl\n"
                                        "usemtl unused\nusemtl dark red\nf 1 2 3\nusemtl blue\n"
                                        "f 1 3 4\nv 3 0 0\nusemtl dark red\nf 2 5 3\n");
    ck_assert_uint_eq(mesh.n_groups, 0);
    ck_assert_uint_eq(mesh.n_libraries, 2);
    ck_assert_str_eq(mesh.library[0], "gone.mtl"); /* neither is there */
    ck_assert_str_eq(mesh.library[1], "other.mtl");
    ck_assert_uint_eq(mesh.n_materials, 2);
    ck_assert_uint_eq(mesh.n_material_runs, 3);
    ck_assert_str_eq(mesh.material[mesh.material_run[0].group], "dark red");
    ck_assert_str_eq(mesh.material[mesh.material_run[1].group], "blue");
    ck_assert_str_eq(mesh.material[mesh.material_run[2].group], "dark red");
    ck_assert_uint_eq(mesh.material_run[2].first, 2);
}

/* ---- Refused ---- */

/* The mesh that it leaves is empty. */
UNIT_TEST(zero_bytes)
{
    static const struct {
        const char *bytes;
        size_t n;
        const char *says;
    } cases[] = {
        {"v 0 0 0\nv 1\0 0 0\n", 18, ":2: the line has a zero byte; a text file is expected"},
        {"\x7f"
         "ELF\0\0\0",
         7, ":1: the line has a zero byte"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct mesh mesh;
        struct file file = file_new(cases[i].bytes, cases[i].n);
        UNIT_REFUSED(mesh_read_obj(&mesh, file.path, &error), CLOTH_E_INPUT, cases[i].says);
        ck_assert(!mesh.position && !mesh.triangle && mesh.n_vertices == 0);
        close(file.descriptor);
    }
}

UNIT_TEST(unreadable)
{
    static const char *const cases[][2] = {
        {"/nonexistent/a.obj", "/nonexistent/a.obj: cannot be opened: No such file or directory"},
        {"/", "/: cannot be opened: Is a directory"},
        {"/dev/zero", /* has no end */
         "/dev/zero: cannot be opened: it is no plain file, but a pipe, a device or the like"}};
    struct mesh mesh;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        UNIT_CALL(mesh_read_obj(&mesh, cases[i][0], &error),
                  ck_assert_int_eq(unit_code, CLOTH_E_IO);
                  ck_assert_str_eq(error.text, cases[i][1]));
    ck_assert_int_eq(mesh_read_obj(&mesh, "/nonexistent", NULL), CLOTH_E_IO);
}

UNIT_TEST(long_paths_keep_the_reason)
{
    struct mesh mesh;
    char path[3001];
    memset(path, 'a', 3000);
    for (int i = 0; i < 3000; i += 100)
        path[i] = '/';
    path[3000] = 0;
    UNIT_REFUSED(mesh_read_obj(&mesh, path, &error), CLOTH_E_IO, "No such file");
}

/* A file cut anywhere is read or refused. */
UNIT_TEST(truncated)
{
    const char text[] = "v 0 0 0\r\nv 1.25 0 0\nv 1 1e1 0\nvt 0 0\nvt 1 0\n"
                        "f 1/1 2/2 \\\n 3/1\nl 1 2\n# end \\\n";
    for (size_t n = 0; n < sizeof text; n++) {
        struct cloth_error error = {0};
        struct mesh mesh;
        struct file file = file_new(text, n);
        int code = mesh_read_obj(&mesh, file.path, &error);
        ck_assert(code == CLOTH_OK || code == CLOTH_E_INPUT);
        if (code == CLOTH_OK)
            mesh_free(&mesh);
        close(file.descriptor);
    }
}
