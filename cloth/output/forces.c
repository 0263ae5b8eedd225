/* Forces of frames have a PC2 cache of their own, so that cloth.pc2 keeps its format. The count is
 * rewritten last, as there, when its floats are on the disk; it never counts a frame that cloth.pc2
 * does not. */
#include "cloth/base/file.h"
#include "cloth/output/files/cut.h"
#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char NAME[] = "contact.pc2";

struct output_forces {
    char *path;
    int file; /* -1: none */
    uint32_t n_points, n_frames;
    struct output_member member; /* settled after the frames of cloth.pc2 */
    unsigned char *bytes;        /* of one frame */
};

static uint64_t frame_at(uint32_t n_points, uint64_t frame)
{
    return OUTPUT_PC2_HEADER + (uint64_t)12 * n_points * frame;
}

/* ---- Writing ---- */

/* True if an existing file is a cache of an earlier run. */
static bool output_forces_is_ours(const char *path)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    uint32_t n_points, n_frames;
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return false;
    const ssize_t n = read(file, header, sizeof header);
    close(file);
    return n == (ssize_t)sizeof header && output_pc2_parse(header, &n_points, &n_frames);
}

static int output_forces_remove_old(const char *path, struct cloth_error *error)
{
    struct stat status;
    if (lstat(path, &status) != 0)
        return 0;
    if (!output_forces_is_ours(path))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is in the way, and is no point cache of an earlier run; give another "
                          "folder, or move the file away",
                          path);
    return unlink(path) == 0 ? 0 : output_refuse(error, "replace", path);
}

int output_forces_forget(const char *folder, struct cloth_error *error)
{
    char *path = output_path(folder, NAME, "");
    if (!path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of %s", NAME);
    const int code = output_forces_is_ours(path) ? output_forces_remove_old(path, error) : 0;
    free(path);
    return code;
}

static int output_forces_start(struct output_forces *forces, struct cloth_error *error)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    const int code = output_forces_remove_old(forces->path, error);
    if (code)
        return code;
    forces->file = open(forces->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (forces->file < 0)
        return output_refuse(error, "write", forces->path);
    output_pc2_header(header, forces->n_points, 0);
    return output_write_at(forces->file, header, sizeof header, 0) == 0
               ? 0
               : output_fail(error, "write", forces->path);
}

static int output_forces_go_on(struct output_forces *forces, uint64_t n_frames,
                               struct cloth_error *error)
{
    forces->file = open(forces->path, O_RDWR | O_CLOEXEC);
    forces->n_frames = (uint32_t)n_frames;
    return forces->file < 0
               ? output_refuse(error, "go on with", forces->path)
               : output_cut_cache(forces->file, forces->path, forces->n_points, n_frames, error);
}

static int output_forces_settle(void *context, uint32_t n, struct cloth_error *error)
{
    const struct output_forces *forces = context;
    unsigned char count[4];
    output_put_u32(count, n);
    if (output_sync(forces->file) != 0)
        return output_fail(error, "write a frame to", forces->path);
    if (output_write_at(forces->file, count, sizeof count, OUTPUT_PC2_COUNT) != 0 ||
        output_sync(forces->file) != 0)
        return output_fail(error, "count a frame in", forces->path);
    return 0;
}

int output_forces_open(struct output_forces **forces, const char *folder, uint32_t n_vertices,
                       const uint64_t *n_frames, struct output_settler *settler,
                       struct cloth_error *error)
{
    *forces = NULL;
    struct output_forces *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the forces of %s", folder);
    made->file = -1;
    made->n_points = n_vertices;
    made->member = (struct output_member){.settle = output_forces_settle, .context = made};
    made->path = output_path(folder, NAME, "");
    made->bytes = malloc((size_t)12 * n_vertices + 1);
    int code = CLOTH_OK;
    if (!made->path || !made->bytes)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the forces of %s", folder);
    else
        code = n_frames ? output_forces_go_on(made, *n_frames, error)
                        : output_forces_start(made, error);
    if (code) {
        struct cloth_error ignored = {0};
        output_forces_close(&made, &ignored);
        return code;
    }
    output_member_add(&made->member, settler, made->n_frames);
    *forces = made;
    return 0;
}

static int output_forces_write_frame(struct output_forces *forces, struct cloth_error *error)
{
    const size_t size = (size_t)12 * forces->n_points;
    if (output_write_at(forces->file, forces->bytes, size,
                        frame_at(forces->n_points, forces->n_frames)) != 0)
        return output_fail(error, "write a frame to", forces->path);
    return output_member_wrote(&forces->member, ++forces->n_frames, error);
}

int output_forces_frame(void *context, uint64_t frame, const double *force,
                        struct cloth_error *error)
{
    struct output_forces *forces = context;
    if (frame != forces->n_frames || frame >= INT32_MAX)
        return cloth_fail(error, CLOTH_E_RUN, "%s: frame %ju came where frame %u was due",
                          forces->path, (uintmax_t)frame, forces->n_frames);
    for (size_t i = 0; i < (size_t)3 * forces->n_points; i++) {
        if (!(fabs(force[i]) <= (double)FLT_MAX))
            return cloth_fail(error, CLOTH_E_RUN,
                              "frame %ju: vertex %zu has no finite force of contact; the frame is "
                              "not written (vertices count from 1)",
                              (uintmax_t)frame, i / 3 + 1);
        output_put_float(forces->bytes + 4 * i, (float)force[i]);
    }
    const int code = output_check_same(forces->file, forces->path, error);
    return code ? code : output_forces_write_frame(forces, error);
}

int output_forces_close(struct output_forces **forces, struct cloth_error *error)
{
    struct output_forces *gone = *forces;
    *forces = NULL;
    if (!gone)
        return 0;
    int code = 0;
    if (gone->file >= 0 && close(gone->file) != 0)
        code = output_fail(error, "close", gone->path);
    free(gone->path);
    free(gone->bytes);
    free(gone);
    return code;
}

/* ---- Reading ---- */

static int read_floats(FILE *file, uint32_t n_points, uint64_t frame, double *force)
{
    unsigned char bytes[12];
    if (fseeko(file, (off_t)frame_at(n_points, frame), SEEK_SET) != 0)
        return -1;
    for (size_t v = 0; v < n_points; v++) {
        if (fread(bytes, sizeof bytes, 1, file) != 1)
            return -1;
        for (size_t c = 0; c < 3; c++)
            force[3 * v + c] = (double)output_get_float(bytes + 4 * c);
    }
    return 0;
}

static int output_forces_read_count(FILE *file, const char *path, uint32_t n_vertices,
                                    uint64_t *n_frames, struct cloth_error *error)
{
    unsigned char header[OUTPUT_PC2_HEADER];
    uint32_t n_points, n;
    if (fread(header, sizeof header, 1, file) != 1 || !output_pc2_parse(header, &n_points, &n) ||
        n_points != n_vertices)
        return cloth_fail(error, CLOTH_E_INPUT, "%s is not a point cache of %u vertices", path,
                          n_vertices);
    *n_frames = n;
    return CLOTH_OK;
}

static int output_forces_read_frame(FILE *file, const char *path, uint32_t n_vertices,
                                    uint64_t frame, double *force, struct cloth_error *error)
{
    uint64_t n_frames;
    const int code = output_forces_read_count(file, path, n_vertices, &n_frames, error);
    if (code)
        return code;
    if (frame >= n_frames)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has %ju frames: no frame %ju", path,
                          (uintmax_t)n_frames, (uintmax_t)frame);
    return read_floats(file, n_vertices, frame, force) == 0
               ? 0
               : cloth_fail(error, CLOTH_E_INPUT, "%s is cut off before frame %ju ends", path,
                            (uintmax_t)frame);
}

/* force: NULL where the count is asked for. */
static int read_forces(const char *folder, uint32_t n_vertices, uint64_t frame, double *force,
                       uint64_t *n_frames, struct cloth_error *error)
{
    char *path = output_path(folder, NAME, "");
    FILE *file = path ? cloth_file_open(path) : NULL;
    int code;
    if (!path)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of %s", NAME);
    else if (!file)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "cannot read %s: %s; a run writes it if its scene has contact: {force: "
                          "on}",
                          path, cloth_file_why());
    else
        code = force ? output_forces_read_frame(file, path, n_vertices, frame, force, error)
                     : output_forces_read_count(file, path, n_vertices, n_frames, error);
    if (file)
        fclose(file);
    free(path);
    return code;
}

int output_forces_read(const char *folder, uint32_t n_vertices, uint64_t frame, double *force,
                       struct cloth_error *error)
{
    return read_forces(folder, n_vertices, frame, force, NULL, error);
}

int output_forces_count(const char *folder, uint32_t n_vertices, uint64_t *n_frames,
                        struct cloth_error *error)
{
    return read_forces(folder, n_vertices, 0, NULL, n_frames, error);
}
