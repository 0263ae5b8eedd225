#ifndef TESTS_CLOTH_MESH_TOOLS_H
#define TESTS_CLOTH_MESH_TOOLS_H

#include "cloth/mesh/mesh.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* A file in memory, so that nothing is left behind. */
struct file {
    int descriptor;
    char path[64];
};

static inline struct file file_new(const void *bytes, size_t n)
{
    struct file file = {.descriptor = memfd_create("mesh", 0)};
    ck_assert_int_ge(file.descriptor, 0);
    ck_assert_int_eq(write(file.descriptor, bytes, n), (ssize_t)n);
    snprintf(file.path, sizeof file.path, "/proc/self/fd/%d", file.descriptor);
    return file;
}

/* Reads the text as an OBJ file; it must succeed. */
static inline struct mesh read_text(const char *text)
{
    struct cloth_error error = {0};
    struct mesh mesh;
    struct file file = file_new(text, strlen(text));
    int code = mesh_read_obj(&mesh, file.path, &error);
    ck_assert_msg(code == CLOTH_OK && error.code == CLOTH_OK, "%s", error.text);
    close(file.descriptor);
    return mesh;
}

static inline struct mesh grid(double width, double height, uint32_t nx, uint32_t ny)
{
    struct cloth_error error = {0};
    struct mesh mesh;
    ck_assert_msg(mesh_grid(&mesh, width, height, nx, ny, &error) == CLOTH_OK, "%s", error.text);
    return mesh;
}

static inline int run_cases(const char *name, const TTest *const *tests, size_t n)
{
    TCase *cases = tcase_create(name);
    for (size_t i = 0; i < n; i++)
        tcase_add_test(cases, tests[i]);
    Suite *suite = suite_create(name);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}

/* int main of a test program that runs the cases listed. */
#define RUN(name, ...)                                                                             \
    int main(void)                                                                                 \
    {                                                                                              \
        const TTest *const tests[] = {__VA_ARGS__};                                                \
        return run_cases(name, tests, sizeof tests / sizeof *tests);                               \
    }

#endif
