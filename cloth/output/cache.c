/* A folder is believed as far as PC2's count goes: frames beyond it were never finished. All that
 * is counted must be there, or the folder is refused. */
#include "cloth/base/file.h"
#include "cloth/base/memory.h"
#include "cloth/output/files/pc2.h"
#include "cloth/output/files/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int open_fail(struct cloth_error *error, const char *path)
{
    return cloth_fail(error, CLOTH_E_INPUT, "cannot read %s: %s", path, cloth_file_why());
}

static int read_scene(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    size_t size;
    unsigned char *text = output_read_file(path, &size);
    const int code =
        text ? output_cache_scene(cache, (const char *)text, path, error) : open_fail(error, path);
    free(text);
    return code;
}

/* Opens a point cache, which has as many points as the mesh beside it, and at least `least`
 * frames. */
static int open_points(const char *path, uint32_t n_vertices, const char *mesh, uint64_t least,
                       FILE **pc2, uint64_t *n_frames, struct cloth_error *error)
{
    uint32_t n_points, n;
    struct stat status;
    *pc2 = cloth_file_open(path);
    if (!*pc2)
        return open_fail(error, path);
    if (!output_pc2_read_header(*pc2, &n_points, &n))
        return cloth_fail(error, CLOTH_E_INPUT, "%s is not a point cache (PC2, version 1)", path);
    if (n_points != n_vertices)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has %u points, %s beside it %u", path, n_points,
                          mesh, n_vertices);
    const uint64_t needed = OUTPUT_PC2_HEADER + (uint64_t)12 * n_points * n;
    if (fstat(fileno(*pc2), &status) != 0)
        return output_fail(error, "read", path);
    if ((uint64_t)status.st_size < needed)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is cut off: its header counts %u frames (%ju bytes), it has %ju",
                          path, n, (uintmax_t)needed, (uintmax_t)status.st_size);
    if (n < least)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has %u frames, cloth.pc2 beside it %ju", path,
                          n, (uintmax_t)least);
    *n_frames = n;
    return 0;
}

/* One line "frame,time" of the index; the frames count up from 0. */
static bool parse_line(const char **next, uint64_t frame, double *time)
{
    char *end = NULL;
    if (**next < '0' || **next > '9' || strtoull(*next, &end, 10) != frame || *end != ',')
        return false;
    const char *start = end + 1;
    *time = strtod(start, &end);
    if (end == start || *end != '\n' || !isfinite(*time))
        return false;
    *next = end + 1;
    return true;
}

static int read_index(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    const size_t n_header = strlen(OUTPUT_INDEX_HEADER);
    size_t size;
    unsigned char *text = output_read_file(path, &size);
    if (!text)
        return open_fail(error, path);
    cache->time = cloth_alloc(cache->n_frames, sizeof *cache->time, error);
    int code = cache->time ? 0 : CLOTH_E_MEMORY;
    const char *next = (const char *)text + n_header;
    if (!code && strncmp((const char *)text, OUTPUT_INDEX_HEADER, n_header) != 0)
        code = cloth_fail(error, CLOTH_E_INPUT, "%s:1: expected \"frame,time\"", path);
    for (uint64_t i = 0; i < cache->n_frames && !code; i++)
        if (!parse_line(&next, i, &cache->time[i]))
            code = cloth_fail(error, CLOTH_E_INPUT, "%s:%ju: expected frame %ju and its time", path,
                              (uintmax_t)(i + 2), (uintmax_t)i);
    free(text);
    return code;
}

/* A mesh that cannot be read is a mistake, as of the other files. */
static int read_obj(struct mesh *mesh, const char *path, struct cloth_error *error)
{
    const int code = mesh_read_obj(mesh, path, error);
    if (code == CLOTH_E_IO)
        error->code = CLOTH_E_INPUT;
    return code ? error->code : CLOTH_OK;
}

/* A body that scene.json names, and its shapes. */
static int read_body(struct output_cache *cache, const char *folder, uint32_t number,
                     struct cloth_error *error)
{
    char name[40];
    struct cloth_error inner = {0};
    struct mesh mesh = {0};
    uint64_t n_frames;
    bool turned;
    snprintf(name, sizeof name, OUTPUT_BODY_OBJ, number - 1);
    const struct output_path path = output_path(folder, "%s", name);
    int code = read_obj(&mesh, path.text, error);
    if (!code && contact_bodies_add(&cache->bodies, &mesh, &turned, &inner))
        code = cloth_fail(error, inner.code, "%s: %s", path.text, inner.text);
    if (!code && cache->posed[number - 1])
        code = open_points(output_path(folder, OUTPUT_BODY_PC2, number - 1).text,
                           contact_bodies_at(&cache->bodies, number)->n_vertices, name,
                           cache->n_frames, &cache->poses[number - 1], &n_frames, error);
    mesh_free(&mesh);
    return code;
}

int output_cache_open(struct output_cache *cache, const char *folder, struct cloth_error *error)
{
    struct stat status;
    memset(cache, 0, sizeof *cache);
    if (stat(folder, &status) != 0)
        return open_fail(error, folder);
    int code = read_obj(&cache->mesh, output_path(folder, "cloth.obj").text, error);
    if (!code)
        code = open_points(output_path(folder, "cloth.pc2").text, cache->mesh.n_vertices,
                           "cloth.obj", 0, &cache->pc2, &cache->n_frames, error);
    code = code ? code : read_index(cache, output_path(folder, "frames.csv").text, error);
    code = code ? code : read_scene(cache, output_path(folder, "scene.json").text, error);
    if (!code && !(cache->poses = cloth_alloc(cache->n_bodies, sizeof *cache->poses, error)))
        code = CLOTH_E_MEMORY;
    for (uint32_t i = 1; i <= cache->n_bodies && !code; i++)
        code = read_body(cache, folder, i, error);
    if (code)
        output_cache_close(cache);
    return code;
}

static int read_points(FILE *pc2, uint32_t n_points, uint64_t frame, double *position,
                       struct cloth_error *error)
{
    const char *why = output_pc2_read(pc2, n_points, frame, position);
    if (why)
        return cloth_fail(error, CLOTH_E_IO, "cannot read frame %ju: %s", (uintmax_t)frame, why);
    for (size_t i = 0; i < (size_t)3 * n_points; i++)
        if (!isfinite(position[i]))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "frame %ju: vertex %zu is not finite (vertices count from 1)",
                              (uintmax_t)frame, i / 3 + 1);
    return 0;
}

int output_cache_frame(struct output_cache *cache, uint64_t frame, double *position,
                       struct cloth_error *error)
{
    if (frame >= cache->n_frames)
        return cloth_fail(error, CLOTH_E_INPUT, "there is no frame %ju: the run has %ju frames",
                          (uintmax_t)frame, (uintmax_t)cache->n_frames);
    if (cache->held) {
        memcpy(position, cache->held, 3 * (size_t)cache->mesh.n_vertices * sizeof *position);
        return 0;
    }
    return read_points(cache->pc2, cache->mesh.n_vertices, frame, position, error);
}

int output_cache_pose(struct output_cache *cache, uint64_t frame, struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 0; i < cache->n_bodies && cache->poses && !code; i++) {
        const uint32_t n = contact_bodies_at(&cache->bodies, i + 1)->n_vertices;
        double(*x)[3] = cache->poses[i] ? malloc(n * sizeof *x) : NULL;
        if (cache->poses[i])
            code = x ? read_points(cache->poses[i], n, frame, x[0], error)
                     : cloth_fail(error, CLOTH_E_MEMORY, "no memory for %u vertices", n);
        if (x && !code)
            contact_body_place(&cache->bodies, i + 1, (const double(*)[3])x);
        free(x);
    }
    return code;
}

void output_cache_close(struct output_cache *cache)
{
    mesh_free(&cache->mesh);
    free(cache->time);
    free(cache->obstacles);
    for (uint32_t i = 0; cache->poses && i < cache->n_bodies; i++)
        if (cache->poses[i])
            fclose(cache->poses[i]);
    free(cache->poses);
    free(cache->posed);
    free(cache->bodies.memory);
    free(cache->keys);
    free(cache->apart.end);
    free(cache->apart.apart);
    free(cache->apart.joined);
    free(cache->attached);
    free(cache->held);
    if (cache->pc2)
        fclose(cache->pc2);
    memset(cache, 0, sizeof *cache);
}
