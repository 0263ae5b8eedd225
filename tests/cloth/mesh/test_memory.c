/* Every allocation fails once: the code says so, nothing is left over, and nothing is lost (the
 * sanitizer looks). */
#include "cloth/base/memory.h"
#include "cloth/mesh/blocks.h"
#include "cloth/mesh/lattice.h"
#include "tests/cloth/mesh/tools.h"
#include "tests/support/scarce.h"

#include <stdint.h>
#include <stdlib.h>

static long left = -1; /* scarce_left of the next call */
/* Memory is scarce only while the code under test runs: check allocates, too. */
#define TRY(call) (scarce_left = left, code = (call), left = scarce_left, scarce_left = -1, code)

/* A strip of 16 squares, so that lists are just full at its end, and a lone edge; with two uv at
 * vertices, and names. */
static struct file strip(void)
{
    char text[4096];
    size_t n = (size_t)sprintf(text, "vt 0 0\nvt 1 1\nmtllib a.mtl\no strip\ng a b\nusemtl red\n");
    for (int i = 0; i <= 16; i++)
        n += (size_t)sprintf(text + n, "v %d 0 0\nv %d 1 0\n", i, i);
    for (int i = 0; i < 16; i++)
        n += (size_t)sprintf(text + n, "f %d/%d %d/1 %d/1 %d/1\n", 2 * i + 1, 1 + i % 2, 2 * i + 3,
                             2 * i + 4, 2 * i + 2);
    n += (size_t)sprintf(text + n, "l 1 34\n");
    return file_new(text, n);
}

/* One way through all functions; each result is freed and was empty if its function failed. */
static int all(struct cloth_error *error, const char *path)
{
    struct mesh mesh, sheet = {0}, copy = {0};
    struct mesh_lattice lattice = {0};
    struct mesh_blocks blocks = {0};
    struct mesh_moduli moduli = {1, 1, 1, 1, 0, NULL, 0};
    static const uint32_t chain[] = {0, 1, 1, 2, 2, 3};
    static unsigned char used[64];
    int code;
    memset(used, 1, sizeof used);
    if (TRY(mesh_read_obj(&mesh, path, error)))
        ck_assert(!mesh.position && !mesh.triangle && !mesh.lone_edge && !mesh.uv);
    else
        ck_assert(mesh.triangle_uv && mesh.n_more_uv == 8 && mesh.n_triangles == 32 &&
                  mesh.n_lone_edges == 1);
    if (!code && TRY(mesh_lattice_build(&lattice, &mesh, &moduli, error)))
        ck_assert(!lattice.spring && lattice.n == 0);
    if (!code && TRY(mesh_grid(&sheet, 1, 1, 8, 8, MESH_SAME, error)))
        ck_assert(!sheet.position && !sheet.triangle);
    if (!code && TRY(mesh_inline(&copy, 4, mesh.position, 1, chain, 1, mesh.triangle, error)))
        ck_assert(!copy.position && !copy.triangle);
    if (!code && TRY(cut_list(&blocks, 64, used, 3, chain, 1, error)))
        ck_assert(!blocks.start && !blocks.vertex && !blocks.place);
    mesh_blocks_free(&blocks);
    mesh_free(&copy);
    mesh_free(&sheet);
    mesh_lattice_free(&lattice);
    mesh_free(&mesh);
    return code;
}

UNIT_TEST(each_fails_once)
{
    struct file file = strip();
    int failures = 0;
    for (long n = 0;; n++) {
        struct cloth_error error = {0};
        left = n;
        int code = all(&error, file.path);
        int failed = left < 0;
        if (!failed) {
            ck_assert_int_eq(code, CLOTH_OK);
            break;
        }
        if (code == CLOTH_OK)
            continue; /* an array was to be made smaller, and stayed as it was */
        ck_assert_int_eq(code, CLOTH_E_MEMORY);
        ck_assert_int_eq(error.code, CLOTH_E_MEMORY);
        unit_says(error.text, "out of memory");
        failures++;
    }
    ck_assert_int_gt(failures, 60);
    close(file.descriptor);
}

UNIT_TEST(lists)
{
    struct cloth_list list = {0};
    for (uint32_t i = 0; i < 1000; i++) {
        uint32_t *to = cloth_list_add(&list, sizeof *to, i % 3, NULL);
        ck_assert_ptr_nonnull(to);
        for (uint32_t k = 0; k < i % 3; k++)
            to[k] = i;
    }
    ck_assert_uint_eq(list.n, 999);
    ck_assert_uint_le(list.n, list.capacity);
    const uint32_t *items = list.items;
    for (uint32_t i = 0, at = 0; i < 1000; i++)
        for (uint32_t k = 0; k < i % 3; k++)
            ck_assert_uint_eq(items[at++], i);
    struct cloth_error error = {0};
    ck_assert_ptr_null(cloth_list_add(&list, 4, SIZE_MAX / 4, &error)); /* too many bytes */
    ck_assert_int_eq(error.code, CLOTH_E_MEMORY);
    ck_assert_ptr_null(cloth_list_add(&list, 4, SIZE_MAX - 500, NULL)); /* wraps around */
    ck_assert_uint_eq(list.n, 999);
    free(list.items);
    ck_assert_ptr_null(cloth_alloc(SIZE_MAX / 2, 4, NULL));
    void *none = cloth_alloc(0, 4, NULL);
    ck_assert_ptr_nonnull(none);
    free(none);
}

UNIT_TEST(the_first_error_stays)
{
    struct cloth_error error = {0};
    ck_assert_int_eq(cloth_fail(&error, CLOTH_E_IO, "first %d", 1), CLOTH_E_IO);
    ck_assert_int_eq(cloth_fail(&error, CLOTH_E_INPUT, "second"), CLOTH_E_IO);
    ck_assert_str_eq(error.text, "first 1");
    ck_assert_int_eq(cloth_fail(NULL, CLOTH_E_INPUT, "third"), CLOTH_E_INPUT);
}
