/* The folder of a process is made on first use and removed, with what the tests wrote there, at its
 * end. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *const scene_right = "schema: 1\n"
                                "gravity: [0, -9.81, 0]\n"
                                "cloths:\n"
                                "  - name: sheet\n"
                                "    mesh: {grid: {width: 1, height: 2, nx: 4, ny: 3}}\n"
                                "    material: cotton\n"
                                "    pins: [{vertices: [0, 3]}]\n"
                                "    loads: [{vertices: [11], force: [0, 1, 0]}]\n"
                                "materials:\n"
                                "  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n"
                                "obstacles: [{plane: {point: [0, -1, 0], normal: [0, 3, 4]}}]\n"
                                "time: {h: 0.001, end: 0.1}\n";

static char folder[64];
static char written[32][128];
static size_t n_written;
static pid_t owner;

static void remove_files(void)
{
    if (owner != getpid())
        return;
    for (size_t i = 0; i < n_written; i++) {
        unlink(written[i]);
        rmdir(dirname(written[i])); /* the last file's removes it */
    }
    rmdir(folder);
}

static void path_of(char *path, size_t size, const char *name)
{
    if (owner != getpid()) {
        owner = getpid();
        n_written = 0;
        strcpy(folder, "/tmp/duite-scene.XXXXXX");
        ck_assert_ptr_nonnull(mkdtemp(folder));
        atexit(remove_files);
    }
    snprintf(path, size, "%s/%s", folder, name);
}

void scene_write_file(const char *name, const char *bytes, size_t size)
{
    char path[128], folder_of[128];
    path_of(path, sizeof path, name);
    strcpy(folder_of, path);
    if (strchr(name, '/'))
        mkdir(dirname(folder_of), 0777);
    size_t i = 0;
    while (i < n_written && strcmp(written[i], path) != 0)
        i++;
    ck_assert_uint_lt(i, sizeof written / sizeof *written);
    if (i == n_written)
        strcpy(written[n_written++], path);
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(bytes, 1, size, file), size);
    ck_assert_int_eq(fclose(file), 0);
}

const char *scene_path(void)
{
    static char path[128];
    path_of(path, sizeof path, "scene.yaml");
    return path;
}

char *scene_changed(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    ck_assert_msg(at != NULL, "'%s' is not in the scene", from);
    char *changed = NULL;
    ck_assert_int_ge(asprintf(&changed, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from)),
                     0);
    return changed;
}

int scene_read_text(struct model *model, const char *text, size_t n_sets,
                    const struct scene_set *sets, struct cloth_error *error)
{
    scene_write_file("scene.yaml", text, strlen(text));
    return scene_read(model, scene_path(), n_sets, sets, error);
}

struct model scene_read_right(const char *text, size_t n_sets, const char *const *sets)
{
    struct model model;
    struct scene_set set[8] = {0};
    ck_assert_uint_le(n_sets, sizeof set / sizeof *set);
    for (size_t i = 0; i < n_sets; i++)
        set[i].text = sets[i];
    UNIT_FINE(scene_read_text(&model, text, n_sets, set, &error));
    return model;
}

struct model scene_read_set(const char *set)
{
    return scene_read_right(scene_right, 1, &set);
}

struct model scene_read_changed(const char *from, const char *to)
{
    char *text = scene_changed(scene_right, from, to);
    struct model model = scene_read_right(text, 0, NULL);
    free(text);
    return model;
}
