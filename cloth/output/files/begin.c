/* All files are written beside their names first. Then the cache of an earlier run goes first and
 * the new one comes last: so cache and mesh always belong together. scene.json comes before
 * cloth.obj: a cloth.obj without it is the user's. A file that a run reads is known by its inode,
 * not by its path. */
#include "cloth/output/files/files.h"
#include "cloth/output/files/pc2.h"
#include "cloth/output/files/scene.h"

#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

struct begin {
    const struct output_setup *setup;
    uint32_t n_points, n_bodies;
    uint32_t before; /* bodies of the earlier run */
    uint32_t most;   /* of this run or the earlier one */
};

/* A file of the folder; it is written with ".part" behind its name first. */
struct begin_file {
    char name[40];
    int (*fill)(FILE *file, const void *what); /* NULL: of an earlier run alone */
    const void *what;
    bool is_mesh; /* the user may have one of that name */
};

/* ---- The files ---- */

static int fill_index(FILE *file, const void *what)
{
    (void)what;
    return fputs(OUTPUT_INDEX_HEADER, file) < 0;
}

/* A body's OBJ. Memory is all that it can lack. */
static int fill_body(FILE *file, const void *what)
{
    struct mesh mesh = {0};
    const struct output_setup alone = {.n_meshes = 1,
                                       .meshes = (const struct mesh *const[]){&mesh},
                                       .names = (const char *const[]){"body"}};
    int failed = contact_body_mesh(what, &mesh, NULL);
    if (failed)
        errno = ENOMEM;
    else
        failed = output_fill_obj(file, &alone);
    mesh_free(&mesh);
    return failed;
}

enum { BODY_FILES = 2, LAST_FILES = 4 };

static uint32_t begin_count(const struct begin *begin)
{
    return BODY_FILES * begin->most + LAST_FILES;
}

/* In the order in which they come to their names. */
static struct begin_file begin_file(const struct begin *begin, uint32_t i)
{
    const struct output_setup *setup = begin->setup;
    const struct begin_file last[LAST_FILES] = {
        {"scene.json", output_fill_scene, setup, false},
        {"cloth.obj", output_fill_obj, setup, true},
        {"frames.csv", fill_index, NULL, false},
        {"cloth.pc2", output_pc2_fill, &begin->n_points, false}};
    const uint32_t k = i / BODY_FILES; /* the body's, from 0 */
    if (k >= begin->most)
        return last[i - BODY_FILES * begin->most];
    const struct contact_body *body =
        k < begin->n_bodies ? contact_bodies_at(setup->bodies, k + 1) : NULL;
    const bool has_shapes = body && setup->posed && setup->posed[k];
    struct begin_file mesh = {.fill = body ? fill_body : NULL, .what = body, .is_mesh = true};
    struct begin_file shapes = {.fill = has_shapes ? output_pc2_fill : NULL,
                                .what = has_shapes ? &body->n_vertices : NULL,
                                .is_mesh = has_shapes};
    snprintf(mesh.name, sizeof mesh.name, OUTPUT_BODY_OBJ, k);
    snprintf(shapes.name, sizeof shapes.name, OUTPUT_BODY_PC2, k);
    return i % BODY_FILES ? shapes : mesh;
}

/* ---- Files that may be replaced ---- */

/* A folder in the way, or a file that the run reads, is refused. */
static int check_replaceable(const struct begin *begin, const char *path, struct cloth_error *error)
{
    struct stat status, input;
    if (stat(path, &status) != 0)
        return 0;
    if (S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return output_refuse(error, "replace", path);
    }
    for (size_t i = 0; i < begin->setup->n_inputs; i++)
        if (stat(begin->setup->inputs[i], &input) == 0 && input.st_dev == status.st_dev &&
            input.st_ino == status.st_ino)
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%.300s would be replaced, but this run reads it, as %.300s; give "
                              "another folder, or move the file away",
                              path, begin->setup->inputs[i]);
    return 0;
}

/* A mesh of the user's must not be taken for one of an earlier run. */
static int check_mesh(const char *folder, const char *path, struct cloth_error *error)
{
    struct stat status;
    if (stat(output_path(folder, "scene.json").text, &status) == 0 || lstat(path, &status) != 0)
        return 0;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s would be replaced, but is not of an earlier run: there is no scene.json "
                      "beside it; give another folder, or move the file away",
                      path);
}

static int begin_check(const struct begin *begin, struct cloth_error *error)
{
    const char *folder = begin->setup->folder;
    int code = 0;
    for (uint32_t i = 0; i < begin_count(begin) && !code; i++) {
        const struct begin_file file = begin_file(begin, i);
        const struct output_path path = output_path(folder, "%s", file.name);
        code = check_replaceable(begin, path.text, error);
        if (!code)
            code = check_replaceable(begin, output_path(folder, "%s.part", file.name).text, error);
        if (!code && file.is_mesh)
            code = check_mesh(folder, path.text, error);
    }
    return code;
}

/* ---- Making them ---- */

static int begin_write(const struct begin *begin, struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 0; i < begin_count(begin) && !code; i++) {
        const struct begin_file file = begin_file(begin, i);
        if (file.fill)
            code = output_write_file(output_path(begin->setup->folder, "%s.part", file.name).text,
                                     file.fill, file.what, error);
    }
    return code;
}

static int begin_replace(const struct begin *begin, struct cloth_error *error)
{
    const char *folder = begin->setup->folder;
    const struct output_path cache = output_path(folder, "cloth.pc2");
    if (unlink(cache.text) != 0 && errno != ENOENT)
        return output_refuse(error, "replace", cache.text);
    output_sync_folder(folder);
    for (uint32_t i = 0; i < begin_count(begin); i++) {
        const struct begin_file file = begin_file(begin, i);
        const struct output_path path = output_path(folder, "%s", file.name);
        if (file.fill && rename(output_path(folder, "%s.part", file.name).text, path.text) != 0)
            return output_refuse(error, "replace", path.text);
        if (!file.fill && i / BODY_FILES < begin->before && unlink(path.text) != 0 &&
            errno != ENOENT)
            return output_refuse(error, "remove", path.text);
    }
    output_sync_folder(folder);
    return 0;
}

/* After a failure: of the files beside their names none stays. */
static void begin_drop(const struct begin *begin)
{
    for (uint32_t i = 0; i < begin_count(begin); i++) {
        const struct begin_file file = begin_file(begin, i);
        if (file.fill)
            unlink(output_path(begin->setup->folder, "%s.part", file.name).text);
    }
}

int output_begin(const struct output_setup *setup, uint32_t n_points, struct cloth_error *error)
{
    struct begin begin = {.setup = setup,
                          .n_points = n_points,
                          .n_bodies = setup->bodies ? setup->bodies->n : 0,
                          .before = output_bodies_before(setup->folder)};
    begin.most = begin.n_bodies > begin.before ? begin.n_bodies : begin.before;
    int code = begin_check(&begin, error);
    if (code)
        return code;
    code = begin_write(&begin, error);
    code = code ? code : begin_replace(&begin, error);
    if (code)
        begin_drop(&begin);
    return code;
}

/* ---- Their size ---- */

static ssize_t begin_count_bytes(void *bytes, const char *text, size_t n)
{
    (void)text;
    *(double *)bytes += (double)n;
    return (ssize_t)n;
}

double output_begin_bytes(const struct output_setup *setup, double *frame)
{
    enum { INDEX = 24 }; /* characters of a frame's line in frames.csv, about */
    struct begin begin = {.setup = setup, .n_bodies = setup->bodies ? setup->bodies->n : 0};
    double bytes = 0;
    FILE *count = fopencookie(&bytes, "w", (cookie_io_functions_t){.write = begin_count_bytes});
    *frame = INDEX;
    begin.most = begin.n_bodies;
    for (size_t i = 0; i < setup->n_meshes; i++)
        begin.n_points += setup->meshes[i]->n_vertices;
    for (uint32_t i = 0; count && i < begin_count(&begin); i++) {
        const struct begin_file file = begin_file(&begin, i);
        if (file.fill)
            file.fill(count, file.what);
        if (file.fill == output_pc2_fill)
            *frame += 3.0 * sizeof(float) * *(const uint32_t *)file.what;
    }
    if (count)
        fclose(count);
    return bytes;
}
