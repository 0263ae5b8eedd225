/* A folder is believed as far as PC2's count goes: frames beyond it were never finished. All that
 * is counted must be there, or the folder is refused. */
#include "cloth/base/file.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/json.h"
#include "cloth/output/files/obstacles.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Our own scene.json and index are small; a larger file is not ours. */
enum { MAX_TEXT = 1 << 30 };

static int open_fail(struct cloth_error *error, const char *path)
{
    return cloth_fail(error, CLOTH_E_INPUT, "cannot read %s: %s", path, cloth_file_why());
}

/* The whole of a text file, ended by '\0'. */
static int read_text(const char *path, char **text, struct cloth_error *error)
{
    FILE *file = cloth_file_open(path);
    if (!file)
        return open_fail(error, path);
    int code = 0;
    struct stat status;
    size_t size = fstat(fileno(file), &status) == 0 ? (size_t)status.st_size : 0;
    *text = size < MAX_TEXT ? malloc(size + 1) : NULL;
    if (!*text) {
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory to read %s", path);
    } else {
        size_t n = fread(*text, 1, size, file);
        (*text)[n] = '\0';
        if (ferror(file))
            code = open_fail(error, path);
    }
    fclose(file);
    return code;
}

static void cache_parse_scene(struct output_cache *cache, struct output_json *json)
{
    output_json_expect(json, '{');
    if (!output_json_key(json, "fps"))
        output_json_fail(json, "\"fps\"");
    cache->fps = output_json_double(json);
    output_json_expect(json, ',');
    if (!output_json_key(json, "obstacles"))
        output_json_fail(json, output_json_key(json, "planes")
                                   ? "\"obstacles\" in place of \"planes\", which an earlier "
                                     "duite-cloth wrote: run the scene again"
                                   : "\"obstacles\"");
    output_obstacles_read(cache, json);
    while (!json->failed && output_json_take(json, ',')) {
        if (!cache->apart.apart && output_json_key(json, "apart"))
            output_apart_read(cache, json);
        else if (!cache->attached && output_json_key(json, "attached"))
            output_attached_read(cache, json);
        else if (!cache->apart.joined && output_json_key(json, "sewn"))
            output_sewn_read(cache, json);
        else
            output_json_fail(json, "\"apart\", \"attached\" or \"sewn\", or the end");
    }
    output_json_expect(json, '}');
    output_json_expect(json, '\0');
}

/* Checks that the cloths of "apart" have the vertices of the mesh. */
static int cache_check_apart(const struct output_cache *cache, const char *name,
                             struct cloth_error *error)
{
    const struct contact_apart *apart = &cache->apart;
    if (!apart->n_cloths || !cache->mesh.n_vertices ||
        apart->end[apart->n_cloths - 1] == cache->mesh.n_vertices)
        return 0;
    return cloth_fail(error, CLOTH_E_INPUT, "%s has cloths of %u vertices, cloth.obj beside it %u",
                      name, apart->end[apart->n_cloths - 1], cache->mesh.n_vertices);
}

int output_cache_scene(struct output_cache *cache, const char *text, const char *name,
                       struct cloth_error *error)
{
    struct output_json json = {.path = name, .text = text, .next = text, .error = error};
    cache_parse_scene(cache, &json);
    if (json.failed)
        return error ? error->code : CLOTH_E_INPUT;
    return cache_check_apart(cache, name, error);
}

static int cache_read_scene(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    char *text = NULL;
    int code = read_text(path, &text, error);
    code = code ? code : output_cache_scene(cache, text, path, error);
    free(text);
    return code;
}

uint32_t output_bodies_before(const char *folder)
{
    struct cloth_error ignored = {0};
    struct output_cache cache = {0};
    char *path = output_path(folder, "scene.json", "");
    const int code = path ? cache_read_scene(&cache, path, &ignored) : CLOTH_E_MEMORY;
    const uint32_t n = code ? 0 : cache.n_bodies;
    output_cache_close(&cache);
    free(path);
    return n;
}

/* Opens a point cache, which has as many points as the mesh beside it, and at least `least`
 * frames. */
static int open_points(const char *path, uint32_t n_vertices, const char *mesh, uint64_t least,
                       FILE **pc2, uint64_t *n_frames, struct cloth_error *error)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    uint32_t n_points, n;
    struct stat status;
    *pc2 = cloth_file_open(path);
    if (!*pc2)
        return open_fail(error, path);
    if (fread(header, sizeof header, 1, *pc2) != 1 || !output_pc2_parse(header, &n_points, &n))
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

static int read_cache(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    return open_points(path, cache->mesh.n_vertices, "cloth.obj", 0, &cache->pc2, &cache->n_frames,
                       error);
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
    static const char TITLE[] = "frame,time\n";
    char *text = NULL;
    int code = read_text(path, &text, error);
    if (code)
        goto out;
    cache->time = calloc(cache->n_frames + 1, sizeof *cache->time);
    if (!cache->time) {
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory to read %s", path);
        goto out;
    }
    const char *next = text + strlen(TITLE);
    if (strncmp(text, TITLE, strlen(TITLE)) != 0)
        code = cloth_fail(error, CLOTH_E_INPUT, "%s:1: expected \"frame,time\"", path);
    for (uint64_t i = 0; i < cache->n_frames && !code; i++)
        if (!parse_line(&next, i, &cache->time[i]))
            code = cloth_fail(error, CLOTH_E_INPUT, "%s:%ju: expected frame %ju and its time", path,
                              (uintmax_t)(i + 2), (uintmax_t)i);
out:
    free(text);
    return code;
}

static int read_mesh(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    const int code = mesh_read_obj(&cache->mesh, path, error);
    if (code == CLOTH_E_IO) /* as of the other files */
        error->code = CLOTH_E_INPUT;
    return code ? error->code : CLOTH_OK;
}

static int read_body(struct output_cache *cache, const char *path, struct cloth_error *error)
{
    struct cloth_error inner = {0};
    struct mesh mesh = {0};
    bool turned;
    int code = mesh_read_obj(&mesh, path, error);
    if (code == CLOTH_E_IO)
        code = error->code = CLOTH_E_INPUT;
    if (!code && contact_bodies_add(&cache->bodies, &mesh, &turned, &inner))
        code = cloth_fail(error, inner.code, "%s: %s", path, inner.text);
    mesh_free(&mesh);
    return code;
}

static int open_poses(struct output_cache *cache, const char *folder, uint32_t number,
                      struct cloth_error *error)
{
    char mesh[OUTPUT_BODY_NAME], name[OUTPUT_BODY_NAME];
    uint64_t n_frames;
    output_body_name(mesh, number, "");
    output_pose_name(name, number);
    char *path = output_path(folder, name, "");
    const int code =
        path ? open_points(path, contact_bodies_at(&cache->bodies, number)->n_vertices, mesh,
                           cache->n_frames, &cache->poses[number - 1], &n_frames, error)
             : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
    free(path);
    return code;
}

/* Reads the bodies that scene.json names. */
static int read_bodies(struct output_cache *cache, const char *folder, struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 1; i <= cache->n_bodies && !code; i++) {
        char name[OUTPUT_BODY_NAME];
        output_body_name(name, i, "");
        char *path = output_path(folder, name, "");
        code = path ? read_body(cache, path, error)
                    : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
        free(path);
    }
    cache->poses = calloc((size_t)cache->n_bodies + 1, sizeof *cache->poses);
    if (!code && !cache->poses)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the shapes of bodies");
    for (uint32_t i = 1; i <= cache->n_bodies && !code; i++)
        if (cache->posed[i - 1])
            code = open_poses(cache, folder, i, error);
    return code;
}

int output_cache_open(struct output_cache *cache, const char *folder, struct cloth_error *error)
{
    static const struct {
        const char *name;
        int (*read)(struct output_cache *, const char *, struct cloth_error *);
    } part[] = {{"cloth.obj", read_mesh},
                {"cloth.pc2", read_cache},
                {"frames.csv", read_index},
                {"scene.json", cache_read_scene}};
    memset(cache, 0, sizeof *cache);
    struct stat status;
    if (stat(folder, &status) != 0)
        return open_fail(error, folder);
    int code = 0;
    for (size_t i = 0; i < sizeof part / sizeof *part && !code; i++) {
        char *path = output_path(folder, part[i].name, "");
        code = path ? part[i].read(cache, path, error)
                    : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
        free(path);
    }
    code = code ? code : read_bodies(cache, folder, error);
    if (code)
        output_cache_close(cache);
    return code;
}

/* Floats come in lumps, so that a frame of any size needs little memory besides the caller's. */
static int read_points(FILE *pc2, uint32_t n_points, uint64_t frame, double *position,
                       struct cloth_error *error)
{
    const size_t n = (size_t)3 * n_points;
    if (fseeko(pc2, (off_t)(OUTPUT_PC2_HEADER + 4 * (uint64_t)n * frame), SEEK_SET) != 0)
        return cloth_fail(error, CLOTH_E_IO, "cannot read frame %ju: %s", (uintmax_t)frame,
                          strerror(errno));
    unsigned char lump[4 * 1024];
    for (size_t done = 0; done < n;) {
        size_t some = n - done < 1024 ? n - done : 1024;
        if (fread(lump, 4, some, pc2) != some)
            return cloth_fail(error, CLOTH_E_IO, "cannot read frame %ju: %s", (uintmax_t)frame,
                              ferror(pc2) ? strerror(errno) : "the file ends early");
        for (size_t i = 0; i < some; i++, done++) {
            position[done] = (double)output_get_float(lump + 4 * i);
            if (!isfinite(position[done]))
                return cloth_fail(error, CLOTH_E_INPUT,
                                  "frame %ju: vertex %zu is not finite (vertices count from 1)",
                                  (uintmax_t)frame, done / 3 + 1);
        }
    }
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
