/* What the OBJ reader says about bad files: the file, the line, what is wrong. */
#include "tests/cloth/mesh/tools.h"

#include <stdlib.h>

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" /* lines 1 to 4 */

static void fails_bytes(const char *text, size_t n, const char *says)
{
    struct cloth_error error = {0};
    struct mesh mesh;
    struct file file = file_new(text, n);
    int code = mesh_read_obj(&mesh, file.path, &error);
    ck_assert_msg(code == CLOTH_E_INPUT && error.code == CLOTH_E_INPUT, "code %d for: %s", code,
                  says);
    char expected[256];
    snprintf(expected, sizeof expected, "%s:%s", file.path, says);
    ck_assert_msg(strncmp(error.text, expected, strlen(expected)) == 0,
                  "\n     got: %s\nexpected: %s", error.text, expected);
    ck_assert(!mesh.position && !mesh.triangle && mesh.n_vertices == 0);
    close(file.descriptor);
}

static void fails(const char *text, const char *says)
{
    fails_bytes(text, strlen(text), says);
}

UNIT_TEST(numbers)
{
    fails("v 0 0 0\nv 1 2\n", "2: there are 2 numbers; at least 3 are needed");
    fails("v 0 0 0\n\nv 1 2 # 3\n", "3: there are 2 numbers");
    fails("v\n", "1: there are 0 numbers");
    fails("v 0 zero 0\n", "1: 'zero' is not a finite decimal number");
    fails("v 0 1.5x 0\n", "1: '1.5x' is not");
    fails("v 0 1,5 0\n", "1: '1,5' is not");
    fails("v 0 0x10 0\n", "1: '0x10' is not");
    fails("v 0 nan 0\n", "1: 'nan' is not");
    fails("v 0 0 -inf\n", "1: '-inf' is not");
    fails("v 0 0 1e999\n", "1: '1e999' is not");
    fails("v 0 0 1\x1b[31m\n", "1: '1?[31m' is not");
    fails(SQUARE "vt\n", "5: there are 0 numbers; at least 1 are needed");
    fails(SQUARE "vt 0 a\n", "5: 'a' is not");
    fails("v 0 0 "
          "123456789012345678901234567890123456789012345678901234567890e\n",
          "1: '12345678901234567890123456789012345678901234...' is not");
}

UNIT_TEST(corners)
{
    fails(SQUARE "f 1 2 x\n", "5: 'x' is not a corner; it is v, v/vt, v//vn or v/vt/vn");
    fails(SQUARE "f 1 2 3.5\n", "5: '3.5' is not a corner");
    fails(SQUARE "f 1 2 3/1/1/1\n", "5: '3/1/1/1' is not a corner");
    fails(SQUARE "f 1 2 3/x\n", "5: '3/x' is not a corner");
    fails(SQUARE "f 1 2 -\n", "5: '-' is not a corner");
    fails(SQUARE "f 1 2 /3\n", "5: '/3' is not a corner");
    fails(SQUARE "f 1 2 0\n", "5: there is no vertex 0; they count from 1");
    fails(SQUARE "f 1 2 -5\n", "5: there is no vertex -5; 4 come before this line");
    fails(SQUARE "f 1 2 3\nf 1 2 5\n", "6: there is no vertex 5; the mesh has the vertices 1 to 4");
    fails(SQUARE "f 1 2 4294967297\n",
          "5: there is no vertex of the number in '4294967297'; 4 come before");
    fails(SQUARE "f 1 2 2147483648\n", "5: there is no vertex 2147483648; the mesh has");
    fails(SQUARE "f 1 2 -99999999999999999999\n",
          "5: there is no vertex of the number in '-99999999999999999999'; 4");
    fails(SQUARE "vt 0 0\nf 1/1 2/1 3/2\n", "6: there is no texture coordinate 2; the file has 1");
    fails(SQUARE "vt 0 0\nf 1/1 2/1 3/-2\n", "6: there is no texture coordinate -2; 1 come");
    fails(SQUARE "f 1/1 2/1 3/1\n", "5: there is no texture coordinate 1; the file has 0");
    fails("f 1 2 3\nf -1 2 3\n" SQUARE, "2: there is no vertex -1; 0 come before this line");
}

UNIT_TEST(faces)
{
    fails(SQUARE "f 1 2\n", "5: the face has 2 corners; it needs at least 3");
    fails(SQUARE "f\n", "5: the face has 0 corners");
    fails(SQUARE "f 1 2 3\nf 1 2 1\n",
          "6: the face has vertex 1 at two corners; corners must differ");
    fails(SQUARE "f 1 2 -3\n", "5: the face has vertex 2 at two corners");
    fails(SQUARE "f 1 2 \\\n\n", "5: the face has 2 corners");
    fails(SQUARE "# \\\nf 1 2 \\\n3\nf 1 2\n", "8: the face has 2 corners");
}

UNIT_TEST(lone_edges)
{
    fails(SQUARE "l 1\n", "5: the line has 1 vertices; it needs at least 2");
    fails(SQUARE "l 1 2 2\n", "5: the edge joins vertex 2 to itself; its ends must differ");
    fails(SQUARE "l 1 2\nl 2 9\n", "6: there is no vertex 9; the mesh has the vertices 1 to 4");
    fails(SQUARE "l 1 two\n", "5: 'two' is not a corner");
    fails(SQUARE "l 1 2 3\nl 4 3 2\n",
          "6: the edge between vertices 2 and 3 stands here again, after line 5; give it once");
    fails(SQUARE "f 1 2 3\nl 1 4\nl 1 2\n\nl 3 1 4\nl 4 3 2 1\n",
          "9: the edge between vertices 1 and 4 stands here again, after line 6; give it once");
}

UNIT_TEST(non_manifold)
{
    fails(SQUARE "v 5 5 5\n\nf 1 2 3\nf 2 1 4\n\nf 5 2 1\n",
          "10: this face is the third at the edge between vertices 1 and 2 (non-manifold); "
          "an edge may have at most two triangles");
    /* polygons before it, and a fourth face: the third in the file is named, not the first edge in
     * number */
    fails(SQUARE "v 5 5 5\nv 6 6 6\nf 3 4 5 6\nf 3 4 1\nf 1 2 3\nf 4 3 2\nf 2 1 4\nf 1 2 5\n",
          "10: this face is the third at the edge between vertices 3 and 4");
}

UNIT_TEST(not_a_mesh)
{
    fails("", " the file has no vertices (lines `v x y z`): it is empty or not OBJ");
    fails("\n\n\n", " the file has no vertices");
    fails("#!/bin/sh\necho hello\n", " the file has no vertices");
    fails("f 1 2 3\n", " the file has no vertices");
    fails("\\\n\\\n\\", " the file has no vertices");
    fails_bytes("v 0 0 0\nv 1\0 0 0\n", 18, "2: the line has a zero byte; an OBJ file is text");
    fails_bytes("\x7f"
                "ELF\0\0\0",
                7, "1: the line has a zero byte");
}

UNIT_TEST(unreadable)
{
    struct cloth_error error = {0};
    struct mesh mesh;
    ck_assert_int_eq(mesh_read_obj(&mesh, "/nonexistent/a.obj", &error), CLOTH_E_IO);
    ck_assert_str_eq(error.text, "/nonexistent/a.obj: cannot be opened: No such file or directory");
    error = (struct cloth_error){0};
    ck_assert_int_eq(mesh_read_obj(&mesh, "/", &error), CLOTH_E_IO);
    ck_assert_str_eq(error.text, "/: cannot be opened: Is a directory");
    ck_assert_int_eq(mesh_read_obj(&mesh, "/nonexistent", NULL), CLOTH_E_IO);
    error = (struct cloth_error){0};
    ck_assert_int_eq(mesh_read_obj(&mesh, "/dev/zero", &error), CLOTH_E_IO); /* has no end */
    ck_assert_str_eq(error.text, "/dev/zero: cannot be opened: it is no plain file, but a pipe, a "
                                 "device or the like");
}

UNIT_TEST(long_paths_keep_the_reason)
{
    struct cloth_error error = {0};
    struct mesh mesh;
    char path[3001];
    memset(path, 'a', 3000);
    for (int i = 0; i < 3000; i += 100)
        path[i] = '/';
    path[3000] = 0;
    ck_assert_int_eq(mesh_read_obj(&mesh, path, &error), CLOTH_E_IO);
    ck_assert_ptr_nonnull(strstr(error.text, "No such file"));
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
