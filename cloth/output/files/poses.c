/* As of the cloth, the count is rewritten last, when the floats that it counts are on the disk. */
#include "cloth/output/files/poses.h"
#include "cloth/output/files/cut.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/obstacles.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct pose_file {
    uint32_t number, n_points; /* of the body, from 1 */
    char *path;
    int file; /* -1: none */
};

struct output_poses {
    uint32_t n, n_frames;
    struct pose_file *of;
    const struct contact_bodies *bodies;
    double begin;         /* s */
    phys_vec *x;          /* room for the vertices of the largest body */
    unsigned char *bytes; /* of a frame of it */
};

static int fail_memory(struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the shapes of bodies");
}

static char *pose_path(const char *folder, uint32_t number)
{
    char name[OUTPUT_BODY_NAME];
    output_pose_name(name, number);
    return output_path(folder, name, "");
}

/* ---- Beginning ---- */

static int poses_remove_old(const char *folder, uint32_t n_before, struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 1; i <= n_before && !code; i++) {
        char *path = pose_path(folder, i);
        code = path ? 0 : fail_memory(error);
        if (path && unlink(path) != 0 && errno != ENOENT)
            code = output_refuse(error, "remove", path);
        free(path);
    }
    return code;
}

static int poses_go_on(struct pose_file *of, uint64_t n_frames, struct cloth_error *error)
{
    of->file = open(of->path, O_RDWR | O_CLOEXEC);
    return of->file < 0 ? output_refuse(error, "go on with", of->path)
                        : output_cut_cache(of->file, of->path, of->n_points, n_frames, error);
}

static int poses_start(struct pose_file *of, const struct output_setup *setup, uint32_t number,
                       struct cloth_error *error)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    of->file = -1;
    of->number = number;
    of->n_points = contact_bodies_at(setup->bodies, number)->n_vertices;
    of->path = pose_path(setup->folder, number);
    if (!of->path)
        return fail_memory(error);
    if (setup->n_frames)
        return poses_go_on(of, *setup->n_frames, error);
    of->file = open(of->path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (of->file < 0)
        return output_refuse(error, "write", of->path);
    output_pc2_header(header, of->n_points, 0);
    return output_write_at(of->file, header, sizeof header, 0) == 0
               ? 0
               : output_fail(error, "write", of->path);
}

static int start_all(struct output_poses *poses, const struct output_setup *setup,
                     struct cloth_error *error)
{
    size_t most = 1;
    int code = 0;
    poses->of = calloc(setup->bodies ? setup->bodies->n + 1 : 1, sizeof *poses->of);
    if (!poses->of)
        return fail_memory(error);
    for (uint32_t i = 0; setup->posed && i < setup->bodies->n && !code; i++)
        if (setup->posed[i]) {
            code = poses_start(&poses->of[poses->n++], setup, i + 1, error);
            most =
                most > poses->of[poses->n - 1].n_points ? most : poses->of[poses->n - 1].n_points;
        }
    poses->x = aligned_alloc(CONTACT_ALIGN, (most + most % 2) * sizeof *poses->x);
    poses->bytes = malloc(12 * most);
    return code || (poses->x && poses->bytes) ? code : fail_memory(error);
}

int output_poses_open(struct output_poses **poses, const struct output_setup *setup,
                      uint32_t n_before, struct cloth_error *error)
{
    struct output_poses *made = *poses = calloc(1, sizeof *made);
    if (!made)
        return fail_memory(error);
    made->bodies = setup->bodies;
    const int code = setup->n_frames ? 0 : poses_remove_old(setup->folder, n_before, error);
    made->n_frames = setup->n_frames ? (uint32_t)*setup->n_frames : 0;
    return code ? code : start_all(made, setup, error);
}

void output_poses_go_on(struct output_poses *poses, const struct contact_bodies *bodies,
                        double begin)
{
    poses->bodies = bodies;
    poses->begin = begin;
}

/* ---- A frame ---- */

static int poses_encode(const struct output_poses *poses, const struct pose_file *of, double time,
                        struct cloth_error *error)
{
    const struct contact_body *body = contact_bodies_at(poses->bodies, of->number);
    const phys_vec *x = body->n_frames ? poses->x : contact_body_vertices(body);
    if (body->n_frames)
        contact_body_places(body, time - poses->begin, poses->x);
    for (size_t i = 0; i < 3 * (size_t)of->n_points; i++) {
        const double value = x[i / 3][i % 3];
        if (!(fabs(value) <= (double)FLT_MAX))
            return cloth_fail(error, CLOTH_E_RUN,
                              "%s: vertex %zu has no finite place (vertices count from 1)",
                              of->path, i / 3 + 1);
        output_put_float(poses->bytes + 4 * i, (float)value);
    }
    return 0;
}

static int write_pose(const struct output_poses *poses, const struct pose_file *of,
                      struct cloth_error *error)
{
    const size_t size = 12 * (size_t)of->n_points;
    if (output_check_same(of->file, of->path, error))
        return error->code;
    if (output_write_at(of->file, poses->bytes, size,
                        OUTPUT_PC2_HEADER + (uint64_t)size * poses->n_frames) != 0)
        return output_fail(error, "write a frame to", of->path);
    return 0;
}

int output_poses_settle(const struct output_poses *poses, uint32_t n, struct cloth_error *error)
{
    unsigned char count[4];
    output_put_u32(count, n);
    for (uint32_t i = 0; i < poses->n; i++) {
        const struct pose_file *of = poses->of + i;
        if (output_sync(of->file) != 0 ||
            output_write_at(of->file, count, sizeof count, OUTPUT_PC2_COUNT) != 0 ||
            output_sync(of->file) != 0)
            return output_fail(error, "write a frame to", of->path);
    }
    return 0;
}

int output_poses_frame(struct output_poses *poses, double time, struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 0; i < poses->n && !code; i++) {
        code = poses_encode(poses, &poses->of[i], time, error);
        code = code ? code : write_pose(poses, &poses->of[i], error);
    }
    poses->n_frames++;
    return code;
}

int output_poses_close(struct output_poses **poses, struct cloth_error *error)
{
    struct output_poses *gone = *poses;
    int code = 0;
    *poses = NULL;
    for (uint32_t i = 0; gone && i < gone->n; i++) {
        if (gone->of[i].file >= 0 && close(gone->of[i].file) != 0)
            code = output_fail(error, "close", gone->of[i].path);
        free(gone->of[i].path);
    }
    if (gone) {
        free(gone->of);
        free(gone->x);
        free(gone->bytes);
        free(gone);
    }
    return code;
}
