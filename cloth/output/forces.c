/* Forces of frames have a PC2 cache of their own, so that cloth.pc2 keeps its format. It never
 * counts a frame that cloth.pc2 does not. */
#include "cloth/base/file.h"
#include "cloth/output/files/pc2.h"
#include "cloth/output/output.h"

#include <stdlib.h>

static const char NAME[] = "contact.pc2";

struct output_forces {
    struct output_pc2 cache;
    uint32_t n_frames;
    struct output_member member; /* settled after the frames of cloth.pc2 */
};

/* ---- Writing ---- */

int output_forces_forget(const char *folder, struct cloth_error *error)
{
    return output_remove_old(output_path(folder, NAME).text, output_pc2_magic, OUTPUT_PC2_MAGIC,
                             NULL, error);
}

static int forces_begin(const struct output_forces *forces, struct cloth_error *error)
{
    const char *path = forces->cache.of.path.text;
    const int code =
        output_remove_old(path, output_pc2_magic, OUTPUT_PC2_MAGIC,
                          "is in the way, and is no point cache of an earlier run", error);
    return code ? code : output_write_file(path, output_pc2_fill, &forces->cache.n_points, error);
}

static int forces_settle(void *context, uint32_t n, struct cloth_error *error)
{
    const struct output_forces *forces = context;
    return output_pc2_count(&forces->cache, n, error);
}

int output_forces_open(struct output_forces **forces, const char *folder, uint32_t n_vertices,
                       const uint64_t *n_frames, struct output_settler *settler,
                       struct cloth_error *error)
{
    struct output_forces *made = *forces = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the forces of %s", folder);
    made->n_frames = n_frames ? (uint32_t)*n_frames : 0;
    made->member = (struct output_member){.settle = forces_settle, .context = made};
    int code = output_pc2_make(&made->cache, folder, NAME, n_vertices, error);
    if (!code && !n_frames)
        code = forces_begin(made, error);
    if (!code)
        code = output_pc2_open(&made->cache, n_frames, error);
    if (code)
        output_forces_close(forces, error);
    else
        output_member_add(&made->member, settler, made->n_frames);
    return code;
}

int output_forces_frame(void *context, uint64_t frame, const double *force,
                        struct cloth_error *error)
{
    struct output_forces *forces = context;
    size_t finite;
    if (frame != forces->n_frames || frame >= INT32_MAX)
        return cloth_fail(error, CLOTH_E_RUN, "%s: frame %ju came where frame %u was due",
                          forces->cache.of.path.text, (uintmax_t)frame, forces->n_frames);
    const int code = output_pc2_write(&forces->cache, frame, force, 3, &finite, error);
    if (finite < forces->cache.n_points)
        return cloth_fail(error, CLOTH_E_RUN,
                          "frame %ju: vertex %zu has no finite force of contact; the frame is "
                          "not written (vertices count from 1)",
                          (uintmax_t)frame, finite + 1);
    return code ? code : output_member_wrote(&forces->member, ++forces->n_frames, error);
}

int output_forces_close(struct output_forces **forces, struct cloth_error *error)
{
    struct output_forces *gone = *forces;
    *forces = NULL;
    const int code = gone ? output_pc2_close(&gone->cache, error) : 0;
    free(gone);
    return code;
}

/* ---- Reading ---- */

static int forces_read(FILE *file, const char *path, uint32_t n_vertices, uint64_t frame,
                       double *force, uint64_t *n_frames, struct cloth_error *error)
{
    uint32_t n_points, n;
    if (!output_pc2_read_header(file, &n_points, &n) || n_points != n_vertices)
        return cloth_fail(error, CLOTH_E_INPUT, "%s is not a point cache of %u vertices", path,
                          n_vertices);
    *n_frames = n;
    return force && frame < n && output_pc2_read(file, n_vertices, frame, force)
               ? cloth_fail(error, CLOTH_E_INPUT, "%s is cut off before frame %ju ends", path,
                            (uintmax_t)frame)
               : CLOTH_OK;
}

int output_forces_read(const char *folder, uint32_t n_vertices, uint64_t frame, double *force,
                       uint64_t *n_frames, struct cloth_error *error)
{
    const struct output_path path = output_path(folder, NAME);
    FILE *file = cloth_file_open(path.text);
    if (!file)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "cannot read %s: %s; a run writes it if its scene has contact: {force: "
                          "on}",
                          path.text, cloth_file_why());
    const int code = forces_read(file, path.text, n_vertices, frame, force, n_frames, error);
    fclose(file);
    return code;
}
