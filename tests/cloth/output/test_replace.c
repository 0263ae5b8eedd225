/* Files that a run replaces in a folder of frames, and those that it refuses to: then no file has
 * changed. */
#include "tests/cloth/contact/bodies.h"
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

UNIT_FIXTURE(sample_make, sample_free)

UNIT_TEST(folder_in_the_way)
{
    struct output_frames *frames = NULL;
    char file[96], below[112];
    snprintf(file, sizeof file, "%s/file", sample.folder);
    snprintf(below, sizeof below, "%s/frames", file);
    sample_write(file, "mine", 4);
    sample.setup.folder = file;
    UNIT_CALL(output_open(&frames, &sample.setup, &error),
              ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
              unit_says(error.text, file); unit_says(error.text, "Not a directory"));
    sample.setup.folder = below;
    UNIT_REFUSED(output_open(&frames, &sample.setup, &error), CLOTH_E_INPUT, "Not a directory");
    ck_assert_ptr_null(frames);
    char text[8];
    sample_read(file, text, sizeof text);
    ck_assert_str_eq(text, "mine");
}

/* Something else stands where a file of the folder goes. */
UNIT_TEST(file_in_the_way)
{
    static const char *const name[] = {"cloth.obj", "cloth.pc2", "frames.csv.part"};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        struct output_frames *frames = NULL;
        sample_run(1, 1);
        unlink(sample_path(name[i]));
        ck_assert_int_eq(mkdir(sample_path(name[i]), 0777), 0);
        UNIT_REFUSED(output_open(&frames, &sample.setup, &error), CLOTH_E_INPUT,
                     sample_path(name[i]));
        ck_assert_ptr_null(frames);
        ck_assert_int_eq(rmdir(sample_path(name[i])), 0);
    }
}

/* A mesh that the user keeps in the folder stays; what an earlier run left goes. */
UNIT_TEST(mesh_of_the_user)
{
    struct cloth_error error = {0};
    struct output_frames *frames = NULL;
    char text[8];
    ck_assert_int_eq(mkdir(sample.frames, 0777), 0);
    sample_write(sample_path("cloth.obj"), "mine", 4);
    ck_assert_int_eq(output_open(&frames, &sample.setup, &error), CLOTH_E_INPUT);
    ck_assert_ptr_null(frames);
    unit_says(error.text, sample_path("cloth.obj"));
    sample_read(sample_path("cloth.obj"), text, sizeof text);
    ck_assert_str_eq(text, "mine");
    ck_assert_int_ne(access(sample_path("cloth.obj.part"), F_OK), 0);
}

/* Makes so many boxes; the caller frees their memory. */
static struct contact_bodies boxes_make(uint32_t n)
{
    static struct surface box;
    static const struct contact_shape shape[] = {{.kind = 5, .body = 1}, {.kind = 5, .body = 2}};
    struct contact_bodies bodies = {0};
    for (uint32_t i = 0; i < n; i++) {
        UNIT_OWNED(mesh_free) struct mesh mesh;
        bool turned;
        surface_box(&box, 1 + i, 1, 1);
        surface_mesh(&box, &mesh);
        UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    }
    sample.setup.n_obstacles = n;
    sample.setup.obstacles = shape;
    return bodies;
}

/* The folder is as it was, and nothing is beside its files. */
static void check_untouched(const char *const *name, size_t n, uint64_t n_frames)
{
    struct output_cache cache;
    for (size_t i = 0; i < n; i++) {
        char part[40];
        snprintf(part, sizeof part, "%s.part", name[i]);
        ck_assert_int_ne(access(sample_path(part), F_OK), 0);
    }
    UNIT_FINE(output_cache_open(&cache, sample.frames, &error));
    ck_assert_uint_eq(cache.n_frames, n_frames);
    output_cache_close(&cache);
}

static const char *const FILES[] = {"cloth.obj",  "cloth.pc2",  "frames.csv",
                                    "scene.json", "body-0.obj", "body-1.obj"};
enum { N_FILES = sizeof FILES / sizeof *FILES };

/* The run reads a file by another path: one of an earlier run, also the second body, which would go
 * without a successor; or one that files are written to first. */
UNIT_TEST(would_replace_an_input)
{
    struct contact_bodies two = boxes_make(2), one = boxes_make(1);
    char link[128], want[300];
    const char *const inputs[] = {"nowhere", link};
    sample.setup.bodies = &two;
    sample.setup.n_obstacles = 2;
    sample_run(1, 3);
    sample.setup.bodies = &one;
    sample.setup.n_obstacles = 1;
    snprintf(link, sizeof link, "%s/input", sample.folder);
    sample.setup.n_inputs = 2;
    sample.setup.inputs = inputs;
    for (size_t i = 0; i < (size_t)2 * N_FILES; i++) {
        struct cloth_error error = {0};
        struct output_frames *frames = NULL;
        char name[40];
        snprintf(name, sizeof name, "%s%s", FILES[i / 2], i % 2 ? ".part" : "");
        if (i % 2)
            sample_write(sample_path(name), "mine", 4);
        ck_assert_int_eq(symlink(sample_path(name), link), 0);
        snprintf(want, sizeof want, "%s would be replaced, but this run reads it, as %s; ",
                 sample_path(name), link);
        ck_assert_int_eq(output_open(&frames, &sample.setup, &error), CLOTH_E_INPUT);
        ck_assert_msg(strstr(error.text, want) == error.text, "%s", error.text);
        ck_assert_int_eq(unlink(link), 0);
        ck_assert_int_eq(i % 2 ? unlink(sample_path(name)) : 0, 0);
        check_untouched(FILES, N_FILES, 3);
    }
    sample_run(2, 1);
    free(one.memory);
    free(two.memory);
}

/* Bodies of an earlier run that had more; what no run made stays. */
UNIT_TEST(bodies_of_an_earlier_run)
{
    struct contact_bodies two = boxes_make(2), one = boxes_make(1);
    for (uint32_t n = 3; n-- > 0;) {
        sample.setup.bodies = n == 2 ? &two : n == 1 ? &one : NULL;
        sample.setup.n_obstacles = n;
        sample_run(n, 1);
        if (n == 2)
            sample_write(sample_path("body-2.obj"), "mine", 4);
        ck_assert_int_eq(access(sample_path("body-0.obj"), F_OK) == 0, n > 0);
        ck_assert_int_eq(access(sample_path("body-1.obj"), F_OK) == 0, n > 1);
        ck_assert_int_eq(access(sample_path("body-2.obj"), F_OK), 0);
    }
    free(one.memory);
    free(two.memory);
}

/* Found before the frames of an earlier run go. */
UNIT_TEST(folder_where_a_file_goes)
{
    struct contact_bodies one = boxes_make(1);
    sample.setup.n_obstacles = 0;
    sample_run(1, 3);
    sample.setup.bodies = &one;
    sample.setup.n_obstacles = 1;
    for (int i = 0; i < 2; i++) {
        const char *name = i ? "body-0.obj" : "body-0.obj.part";
        struct output_frames *frames = NULL;
        ck_assert_int_eq(mkdir(sample_path(name), 0777), 0);
        UNIT_CALL(
            output_open(&frames, &sample.setup, &error), ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
            unit_says(error.text, sample_path(name)); unit_says(error.text, "Is a directory"));
        ck_assert_int_eq(rmdir(sample_path(name)), 0);
        check_untouched(FILES, N_FILES, 3);
    }
    free(one.memory);
}
