/* Files that the OBJ reader refuses and that tests/cloth/scene/sentences.txt cannot hold. */
#include "tests/cloth/mesh/tools.h"

#include <stdlib.h>

/* The mesh that it leaves is empty. */
UNIT_TEST(zero_bytes)
{
    static const struct {
        const char *bytes;
        size_t n;
        const char *says;
    } cases[] = {{"v 0 0 0\nv 1\0 0 0\n", 18, ":2: the line has a zero byte; an OBJ file is text"},
                 {"\x7f"
                  "ELF\0\0\0",
                  7, ":1: the line has a zero byte"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct cloth_error error = {0};
        struct mesh mesh;
        struct file file = file_new(cases[i].bytes, cases[i].n);
        ck_assert_int_eq(mesh_read_obj(&mesh, file.path, &error), CLOTH_E_INPUT);
        unit_says(error.text, cases[i].says);
        ck_assert(!mesh.position && !mesh.triangle && mesh.n_vertices == 0);
        close(file.descriptor);
    }
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
    unit_says(error.text, "No such file");
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
