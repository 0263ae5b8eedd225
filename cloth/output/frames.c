/* At any moment the folder holds whole frames. PC2's count says how many. The settler, the only
 * owner of `settled`, rewrites it once the floats and the index lines that it counts are on the
 * disk. Bytes beyond the counted frames mean nothing; a frame that fails is removed. Frame k of a
 * body that changes its shape is of the time of frame k of the cloth, and counted before it: so it
 * may have a frame more, of a run that was killed. */
#include "cloth/base/memory.h"
#include "cloth/output/files/pc2.h"
#include "cloth/output/files/scene.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>

/* The shapes of a body, without the motion of the obstacle. */
struct pose {
    uint32_t number; /* of the body, from 1 */
    struct output_pc2 cache;
};

struct output_frames {
    struct output_pc2 cache;
    struct output_file index;
    uint32_t n_frames;        /* written, */
    _Atomic uint32_t settled; /* and of these on the disk, and counted */
    struct output_member member;
    struct output_path scene;
    const struct contact_bodies *bodies;
    double begin; /* s: their time 0 */
    uint32_t n_poses;
    struct pose *pose; /* of bodies that change their shape */
    phys_vec *x;       /* room for the vertices of the largest body */
};

/* ---- Bringing frames to the disk ---- */

/* Cuts cache and index to the first n frames. */
static void frames_cut(struct output_frames *frames, uint32_t n)
{
    output_pc2_cut(&frames->cache, n, false);
    output_file_keep_lines(&frames->index, 1 + (uint64_t)n, NULL);
}

/* This order keeps the folder whole: poses, index and floats on the disk, then the count. */
static int frames_settle(void *context, uint32_t n, struct cloth_error *error)
{
    struct output_frames *frames = context;
    int code = 0;
    for (uint32_t i = 0; i < frames->n_poses && !code; i++)
        code = output_pc2_count(&frames->pose[i].cache, n, error);
    if (!code && output_sync(frames->index.file) != 0)
        code = output_fail(error, "write a frame to", frames->index.path.text);
    code = code ? code : output_pc2_count(&frames->cache, n, error);
    if (code)
        output_pc2_cut(&frames->cache, frames->settled, true);
    else
        frames->settled = n;
    return code;
}

/* ---- Beginning ---- */

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

static int poses_open(struct output_frames *frames, const struct output_setup *setup,
                      struct cloth_error *error)
{
    const uint32_t n_bodies = setup->bodies && setup->posed ? setup->bodies->n : 0;
    size_t most = 1;
    frames->pose = cloth_alloc(n_bodies, sizeof *frames->pose, error);
    for (uint32_t i = 0; frames->pose && i < n_bodies; i++) {
        const uint32_t n_points = contact_bodies_at(setup->bodies, i + 1)->n_vertices;
        char name[40];
        if (!setup->posed[i])
            continue;
        struct pose *pose = &frames->pose[frames->n_poses++];
        pose->number = i + 1;
        snprintf(name, sizeof name, OUTPUT_BODY_PC2, i);
        if (output_pc2_make(&pose->cache, setup->folder, name, n_points, error) ||
            output_pc2_open(&pose->cache, setup->n_frames, error))
            return error->code;
        most = most > n_points ? most : n_points;
    }
    frames->x = aligned_alloc(CONTACT_ALIGN, (most + most % 2) * sizeof *frames->x);
    return frames->pose && frames->x
               ? 0
               : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the shapes of bodies");
}

/* The cache is cut before the index: it never counts a frame that the index lacks. */
static int frames_open(struct output_frames *frames, const struct output_setup *setup,
                       uint32_t n_points, struct cloth_error *error)
{
    const uint64_t *stay = setup->n_frames;
    const char *folder = setup->folder;
    frames->index = output_file(folder, "frames.csv");
    frames->index.size = strlen(OUTPUT_INDEX_HEADER);
    frames->scene = output_path(folder, "scene.json");
    frames->n_frames = stay ? (uint32_t)*stay : 0;
    frames->settled = frames->n_frames;
    int code = output_pc2_make(&frames->cache, folder, "cloth.pc2", n_points, error);
    code = code ? code : output_make_folder(folder, error);
    if (!code && !stay)
        code = output_begin(setup, n_points, error);
    if (!code)
        code = output_file_open(&frames->index, O_RDWR, stay ? "go on with" : "write", error);
    code = code ? code : output_pc2_open(&frames->cache, stay, error);
    if (!code && stay)
        code = output_file_keep_lines(&frames->index, 1 + *stay, error);
    return code ? code : poses_open(frames, setup, error);
}

int output_open(struct output_frames **frames, const struct output_setup *setup,
                struct cloth_error *error)
{
    uint32_t n_points = 0;
    struct output_frames *made = *frames = NULL;
    int code = count_points(setup, &n_points, error);
    if (code)
        return code;
    made = *frames = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the frames of %s", setup->folder);
    made->member = (struct output_member){.settle = frames_settle, .context = made};
    made->bodies = setup->bodies;
    code = frames_open(made, setup, n_points, error);
    if (code)
        output_close(frames, error);
    else
        output_member_add(&made->member, setup->settler, made->n_frames);
    return code;
}

int output_scene(const struct output_frames *frames, const struct output_setup *setup,
                 struct cloth_error *error)
{
    return output_replace_file(frames->scene.text, output_fill_scene, setup, error);
}

void output_bodies_go_on(struct output_frames *frames, const struct contact_bodies *bodies,
                         double begin)
{
    frames->bodies = bodies;
    frames->begin = begin;
}

/* ---- The run ---- */

static int poses_write(struct output_frames *frames, uint64_t frame, double time,
                       struct cloth_error *error)
{
    const size_t stride = sizeof *frames->x / sizeof(double);
    for (uint32_t i = 0; i < frames->n_poses; i++) {
        struct output_pc2 *cache = &frames->pose[i].cache;
        const struct contact_body *body = contact_bodies_at(frames->bodies, frames->pose[i].number);
        const phys_vec *x = body->n_frames ? frames->x : contact_body_vertices(body);
        size_t finite;
        if (body->n_frames)
            contact_body_places(body, time - frames->begin, frames->x);
        if (output_pc2_write(cache, frame, (const double *)x, stride, &finite, error))
            return error->code;
        if (finite < cache->n_points)
            return cloth_fail(error, CLOTH_E_RUN,
                              "%s: vertex %zu has no finite place (vertices count from 1)",
                              cache->of.path.text, finite + 1);
    }
    return 0;
}

static int frames_write(struct output_frames *frames, uint64_t frame, double time,
                        const double *position, struct cloth_error *error)
{
    char line[64];
    size_t finite;
    const int n = snprintf(line, sizeof line, "%ju,%.17g\n", (uintmax_t)frame, time);
    int code = output_pc2_write(&frames->cache, frame, position, 3, &finite, error);
    if (finite < frames->cache.n_points)
        return cloth_fail(error, CLOTH_E_RUN,
                          "frame %ju: vertex %zu has no finite place; the frame is not written "
                          "(vertices count from 1)",
                          (uintmax_t)frame, finite + 1);
    if (!code)
        code = output_file_append(&frames->index, line, (size_t)n, "write a frame to", error);
    return code ? code : poses_write(frames, frame, time, error);
}

int output_frame(void *context, uint64_t frame, double time, const double *position,
                 struct cloth_error *error)
{
    struct output_frames *frames = context;
    if (frame != frames->n_frames || frame >= INT32_MAX)
        return cloth_fail(error, CLOTH_E_RUN, "%s: frame %ju came where frame %u was due",
                          frames->cache.of.path.text, (uintmax_t)frame, frames->n_frames);
    int code = frames_write(frames, frame, time, position, error);
    if (!code) {
        code = output_member_wrote(&frames->member, ++frames->n_frames, error);
        if (!code || frames->member.settler) /* then output_close cuts off all that failed */
            return code;
        frames->n_frames = frames->settled;
    }
    frames_cut(frames, frames->n_frames);
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
    if (gone->settled < gone->n_frames) /* written while one before them failed */
        frames_cut(gone, gone->settled);
    int code = output_file_close(&gone->index, error);
    const int cache = output_pc2_close(&gone->cache, error);
    code = code ? code : cache;
    for (uint32_t i = 0; i < gone->n_poses; i++) {
        const int pose = output_pc2_close(&gone->pose[i].cache, error);
        code = code ? code : pose;
    }
    free(gone->pose);
    free(gone->x);
    free(gone);
    return code;
}
