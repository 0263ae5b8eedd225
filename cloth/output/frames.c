/* At any moment the folder holds whole frames. PC2's count says how many. The settler, the only
 * owner of `settled`, rewrites it once the floats and the index lines that it counts are on the
 * disk. Bytes beyond the counted frames mean nothing; a frame that fails is removed. When a folder
 * is opened, the cache of an earlier run is removed first and the new one is made last. So cache
 * and mesh always belong together. scene.json is made first: a cloth.obj without one is not ours.
 */
#include "cloth/output/files/bodies.h"
#include "cloth/output/files/cut.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/inputs.h"
#include "cloth/output/files/json.h"
#include "cloth/output/files/obstacles.h"
#include "cloth/output/files/poses.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum part { PART_SCENE, PART_OBJ, PART_INDEX, PART_CACHE, N_PARTS };
static const char *const PART_NAME[N_PARTS] = {"scene.json", "cloth.obj", "frames.csv",
                                               "cloth.pc2"};

enum { REMEMBERED = 8 }; /* more frames than the disk may be behind */

struct output_frames {
    char *folder;
    char *path[N_PARTS];
    int index, cache; /* open files, -1: none */
    uint32_t n_points;
    uint32_t n_frames;               /* written, */
    _Atomic uint32_t settled;        /* and of these on the disk, and counted */
    uint32_t n_bodies_before;        /* of the earlier run that is replaced */
    uint64_t index_size[REMEMBERED]; /* bytes of the index with the first k frames, at k modulo
                                      * REMEMBERED, from `settled` on */
    struct output_member member;
    unsigned char *bytes;       /* of one frame */
    struct output_poses *poses; /* of bodies */
};

void output_scene_text(FILE *file, const struct output_setup *setup)
{
    fputs("{\n  \"fps\": ", file);
    output_json_number(file, setup->fps);
    fputs(",\n  \"obstacles\": ", file);
    output_obstacles(file, setup->n_obstacles, setup->obstacles, setup->keys, setup->posed);
    if (setup->apart && (setup->apart->apart || setup->apart->n_cloths > 1)) {
        fputs(",\n  \"apart\": ", file);
        output_apart(file, setup->apart);
    }
    if (setup->apart && setup->apart->attached) {
        fputs(",\n  \"attached\": ", file);
        output_attached(file, setup->n_obstacles, setup->apart);
    }
    if (setup->apart && setup->apart->joined) {
        fputs(",\n  \"sewn\": ", file);
        output_sewn(file, setup->apart);
    }
    fputs("\n}\n", file);
}

static int fill_scene(FILE *file, const void *what)
{
    output_scene_text(file, what);
    return ferror(file);
}

static int fill_index(FILE *file, const void *what)
{
    (void)what;
    return fputs("frame,time\n", file) < 0;
}

static int fill_cache(FILE *file, const void *what)
{
    const struct output_frames *frames = what;
    unsigned char header[OUTPUT_PC2_HEADER];
    output_pc2_header(header, frames->n_points, 0);
    return fwrite(header, sizeof header, 1, file) != 1;
}

/* Writes the new files beside the old ones. */
static int write_part(const struct output_frames *frames, enum part part, const char *path,
                      const struct output_setup *setup, struct cloth_error *error)
{
    static int (*const fill[N_PARTS])(FILE *, const void *) = {fill_scene, output_fill_obj,
                                                               fill_index, fill_cache};
    const void *what = part == PART_CACHE ? (const void *)frames : setup;
    return output_write_file(path, fill[part], what, error);
}

static uint32_t count_bodies(const struct output_setup *setup)
{
    return setup->bodies ? setup->bodies->n : 0;
}

/* ---- Files that may be replaced ---- */

/* A mesh of the user's must not be taken for one of an earlier run. */
static int check_mesh(const struct output_frames *frames, const char *path,
                      struct cloth_error *error)
{
    struct stat status;
    if (stat(frames->path[PART_SCENE], &status) == 0 || lstat(path, &status) != 0)
        return 0;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s would be replaced, but is not of an earlier run: there is no scene.json "
                      "beside it; give another folder, or move the file away",
                      path);
}

/* Checks a file of the folder, and its temporary file. */
static int output_frames_check_file(const struct output_frames *frames, const char *name,
                                    bool is_mesh, const struct output_setup *setup,
                                    const struct output_input *inputs, struct cloth_error *error)
{
    char *path = output_path(frames->folder, name, "");
    char *fresh = output_path(frames->folder, name, ".part");
    int code = path && fresh ? output_input_check(path, setup, inputs, error)
                             : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
    code = code ? code : output_input_check(fresh, setup, inputs, error);
    if (!code && is_mesh)
        code = check_mesh(frames, path, error);
    free(path);
    free(fresh);
    return code;
}

static int check_ours(const struct output_frames *frames, const struct output_setup *setup,
                      struct cloth_error *error)
{
    const uint32_t n = count_bodies(setup), before = frames->n_bodies_before;
    struct output_input *inputs = output_inputs_find(setup);
    int code = inputs ? 0 : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the files read");
    for (int i = 0; i < N_PARTS && !code; i++)
        code = output_frames_check_file(frames, PART_NAME[i], i == PART_OBJ, setup, inputs, error);
    for (uint32_t i = 1; i <= (n > before ? n : before) && !code; i++) {
        char name[OUTPUT_BODY_NAME];
        output_body_name(name, i, "");
        code = output_frames_check_file(frames, name, true, setup, inputs, error);
        output_pose_name(name, i);
        code = code ? code
                    : output_frames_check_file(frames, name,
                                               i <= n && setup->posed && setup->posed[i - 1], setup,
                                               inputs, error);
    }
    free(inputs);
    return code;
}

/* ---- Beginning ---- */

static int replace_parts(struct output_frames *frames, char *const fresh[N_PARTS],
                         const struct output_setup *setup, struct cloth_error *error)
{
    int code = 0;
    if (unlink(frames->path[PART_CACHE]) != 0 && errno != ENOENT)
        return output_refuse(error, "replace", frames->path[PART_CACHE]);
    output_sync_folder(frames->folder);
    code =
        output_bodies_replace(frames->folder, count_bodies(setup), frames->n_bodies_before, error);
    code = code ? code : output_poses_open(&frames->poses, setup, frames->n_bodies_before, error);
    if (code)
        return code;
    for (int i = 0; i < N_PARTS; i++)
        if (rename(fresh[i], frames->path[i]) != 0)
            return output_refuse(error, "replace", frames->path[i]);
    output_sync_folder(frames->folder);
    return 0;
}

static int start_files(struct output_frames *frames, const struct output_setup *setup,
                       struct cloth_error *error)
{
    char *fresh[N_PARTS] = {NULL};
    int code = 0;
    for (int i = 0; i < N_PARTS && !code; i++) {
        fresh[i] = output_path(frames->folder, PART_NAME[i], ".part");
        code = fresh[i] ? write_part(frames, (enum part)i, fresh[i], setup, error)
                        : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
    }
    if (!code && setup->bodies)
        code = output_bodies_write(frames->folder, setup->bodies, error);
    code = code ? code : replace_parts(frames, fresh, setup, error);
    if (code)
        output_bodies_drop(frames->folder, count_bodies(setup));
    for (int i = 0; i < N_PARTS; i++) {
        if (code && fresh[i])
            unlink(fresh[i]);
        free(fresh[i]);
    }
    return code;
}

static int open_part(const struct output_frames *frames, enum part part, int *file,
                     struct cloth_error *error)
{
    *file = open(frames->path[part], O_WRONLY | O_CLOEXEC);
    return *file >= 0 ? 0 : output_fail(error, "write", frames->path[part]);
}

/* Goes on with the files of an earlier run. The cache is cut first: it never counts a frame that
 * the index lacks. */
static int output_frames_go_on(struct output_frames *frames, const struct output_setup *setup,
                               struct cloth_error *error)
{
    const uint64_t n = *setup->n_frames;
    static const enum part parts[] = {PART_INDEX, PART_CACHE};
    int *const file[] = {&frames->index, &frames->cache};
    for (int i = 0; i < 2; i++) {
        *file[i] = open(frames->path[parts[i]], O_RDWR | O_CLOEXEC);
        if (*file[i] < 0)
            return output_refuse(error, "go on with", frames->path[parts[i]]);
    }
    frames->n_frames = (uint32_t)n;
    frames->settled = (uint32_t)n;
    int code =
        output_cut_cache(frames->cache, frames->path[PART_CACHE], frames->n_points, n, error);
    if (!code)
        code = output_cut_lines(frames->index, frames->path[PART_INDEX], 1 + n,
                                frames->index_size + n % REMEMBERED, error);
    return code ? code : output_poses_open(&frames->poses, setup, 0, error);
}

static int output_frames_begin(struct output_frames *frames, const struct output_setup *setup,
                               struct cloth_error *error)
{
    int code = check_ours(frames, setup, error);
    code = code ? code : start_files(frames, setup, error);
    code = code ? code : open_part(frames, PART_INDEX, &frames->index, error);
    return code ? code : open_part(frames, PART_CACHE, &frames->cache, error);
}

static int count_points(const struct output_setup *setup, uint32_t *n_points,
                        struct cloth_error *error)
{
    uint64_t n = 0;
    for (size_t i = 0; i < setup->n_meshes; i++)
        n += setup->meshes[i]->n_vertices;
    if (n == 0 || n > INT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: a point cache holds 1 to 2147483647 vertices, not %ju",
                          setup->folder, (uintmax_t)n);
    *n_points = (uint32_t)n;
    return 0;
}

static int output_frames_allocate(struct output_frames *frames, const char *folder,
                                  struct cloth_error *error)
{
    bool whole = (frames->folder = strdup(folder)) &&
                 (frames->bytes = malloc((size_t)12 * frames->n_points));
    for (int i = 0; i < N_PARTS && whole; i++)
        whole = (frames->path[i] = output_path(folder, PART_NAME[i], ""));
    return whole ? 0 : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the frames of %s", folder);
}

static void output_frames_free(struct output_frames *frames)
{
    for (int i = 0; i < N_PARTS; i++)
        free(frames->path[i]);
    free(frames->folder);
    free(frames->bytes);
    free(frames);
}

/* ---- Bringing frames to the disk ---- */

/* Cuts cache and index to the first n frames. A shorter file needs no room. */
static void output_frames_cut(const struct output_frames *frames, uint32_t n)
{
    const uint64_t whole = OUTPUT_PC2_HEADER + (uint64_t)12 * frames->n_points * n;
    if (ftruncate(frames->cache, (off_t)whole) == 0)
        fdatasync(frames->cache);
    if (ftruncate(frames->index, (off_t)frames->index_size[n % REMEMBERED]) == 0)
        fdatasync(frames->index);
}

/* This order keeps the folder whole: floats and index, both on the disk, then the count. */
static int count_frames(const struct output_frames *frames, uint32_t n, struct cloth_error *error)
{
    const char *cache = frames->path[PART_CACHE], *index = frames->path[PART_INDEX];
    unsigned char count[4];
    output_put_u32(count, n);
    if (output_sync(frames->cache) != 0)
        return output_fail(error, "write a frame to", cache);
    if (output_sync(frames->index) != 0)
        return output_fail(error, "write a frame to", index);
    if (output_write_at(frames->cache, count, sizeof count, OUTPUT_PC2_COUNT) != 0 ||
        output_sync(frames->cache) != 0)
        return output_fail(error, "count a frame in", cache);
    return 0;
}

static void forget_frames(const struct output_frames *frames)
{
    unsigned char count[4];
    output_put_u32(count, frames->settled);
    output_write_at(frames->cache, count, sizeof count, OUTPUT_PC2_COUNT);
    output_frames_cut(frames, frames->settled);
}

static int output_frames_settle(void *context, uint32_t n, struct cloth_error *error)
{
    struct output_frames *frames = context;
    int code = output_poses_settle(frames->poses, n, error);
    code = code ? code : count_frames(frames, n, error);
    if (code)
        forget_frames(frames);
    else
        frames->settled = n;
    return code;
}

/* ---- The run ---- */

int output_open(struct output_frames **frames, const struct output_setup *setup,
                struct cloth_error *error)
{
    *frames = NULL;
    struct output_frames *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the frames of %s", setup->folder);
    made->index = made->cache = -1;
    made->index_size[0] = strlen("frame,time\n");
    made->member = (struct output_member){.settle = output_frames_settle, .context = made};
    int code = count_points(setup, &made->n_points, error);
    code = code ? code : output_frames_allocate(made, setup->folder, error);
    code = code ? code : output_make_folder(setup->folder, error);
    made->n_bodies_before = output_bodies_before(setup->folder);
    if (!code)
        code = setup->n_frames ? output_frames_go_on(made, setup, error)
                               : output_frames_begin(made, setup, error);
    if (code) {
        struct cloth_error ignored = {0};
        output_close(&made, &ignored);
        return code;
    }
    output_member_add(&made->member, setup->settler, made->n_frames);
    *frames = made;
    return 0;
}

int output_scene(const struct output_frames *frames, const struct output_setup *setup,
                 struct cloth_error *error)
{
    return output_replace_file(frames->path[PART_SCENE], fill_scene, setup, error);
}

void output_bodies_go_on(const struct output_frames *frames, const struct contact_bodies *bodies,
                         double begin)
{
    output_poses_go_on(frames->poses, bodies, begin);
}

static int output_frames_encode(struct output_frames *frames, uint64_t frame,
                                const double *position, struct cloth_error *error)
{
    for (size_t i = 0; i < (size_t)3 * frames->n_points; i++) {
        if (!(fabs(position[i]) <= (double)FLT_MAX))
            return cloth_fail(error, CLOTH_E_RUN,
                              "frame %ju: vertex %zu has no finite place; the frame is not written "
                              "(vertices count from 1)",
                              (uintmax_t)frame, i / 3 + 1);
        output_put_float(frames->bytes + 4 * i, (float)position[i]);
    }
    return 0;
}

static int output_frames_write_frame(struct output_frames *frames, const char *line, size_t n,
                                     struct cloth_error *error)
{
    const size_t size = (size_t)12 * frames->n_points;
    if (output_write_at(frames->cache, frames->bytes, size,
                        OUTPUT_PC2_HEADER + (uint64_t)size * frames->n_frames) != 0)
        return output_fail(error, "write a frame to", frames->path[PART_CACHE]);
    if (output_write_at(frames->index, line, n,
                        frames->index_size[frames->n_frames % REMEMBERED]) != 0)
        return output_fail(error, "write a frame to", frames->path[PART_INDEX]);
    return 0;
}

int output_frame(void *context, uint64_t frame, double time, const double *position,
                 struct cloth_error *error)
{
    struct output_frames *frames = context;
    if (frame != frames->n_frames || frame >= INT32_MAX)
        return cloth_fail(error, CLOTH_E_RUN, "%s: frame %ju came where frame %u was due",
                          frames->path[PART_CACHE], (uintmax_t)frame, frames->n_frames);
    int code = output_frames_encode(frames, frame, position, error);
    code = code ? code : output_check_same(frames->index, frames->path[PART_INDEX], error);
    code = code ? code : output_check_same(frames->cache, frames->path[PART_CACHE], error);
    code = code ? code : output_poses_frame(frames->poses, time, error);
    if (code)
        return code;
    char line[64];
    int n = snprintf(line, sizeof line, "%ju,%.17g\n", (uintmax_t)frame, time);
    code = output_frames_write_frame(frames, line, (size_t)n, error);
    if (code) {
        output_frames_cut(frames, frames->n_frames);
        return code;
    }
    const uint64_t end = frames->index_size[frame % REMEMBERED] + (uint64_t)n;
    frames->index_size[++frames->n_frames % REMEMBERED] = end;
    code = output_member_wrote(&frames->member, frames->n_frames, error);
    if (code && !frames->member.settler)
        frames->n_frames = frames->settled;
    return code;
}

uint64_t output_frames_settled(const struct output_frames *frames)
{
    return frames->settled;
}

int output_close(struct output_frames **frames, struct cloth_error *error)
{
    struct output_frames *gone = *frames;
    *frames = NULL;
    if (!gone)
        return 0;
    int code = 0;
    if (gone->settled < gone->n_frames) /* written while one before them failed */
        forget_frames(gone);
    if (gone->index >= 0 && close(gone->index) != 0)
        code = output_fail(error, "close", gone->path[PART_INDEX]);
    if (gone->cache >= 0 && close(gone->cache) != 0)
        code = output_fail(error, "close", gone->path[PART_CACHE]);
    const int poses = output_poses_close(&gone->poses, error);
    code = code ? code : poses;
    output_frames_free(gone);
    return code;
}
