/* PC2 point caches: a header of 32 bytes, then x y z of each vertex in each frame; floats and whole
 * numbers are little-endian on any machine. */
#include "cloth/base/bytes.h"
#include "cloth/base/file.h"
#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { HEADER = 32, POINT = 12 }; /* bytes */

/* How many frames follow of the header, one or more; the file is read up to there. */
static int mesh_pc2_read_header(FILE *file, const char *path, uint32_t n_vertices,
                                uint32_t *n_frames, struct cloth_error *error)
{
    unsigned char header[HEADER];
    if (fread(header, HEADER, 1, file) != 1 || memcmp(header, "POINTCACHE2", 12) != 0 ||
        cloth_get_u32(header + 12) != 1)
        return cloth_fail(error, CLOTH_E_INPUT, "%s: no PC2 file of version 1", path);
    if (cloth_get_u32(header + 16) != n_vertices)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: its frames have %u vertices, but the mesh has %u", path,
                          cloth_get_u32(header + 16), n_vertices);
    *n_frames = cloth_get_u32(header + 28);
    if (!*n_frames)
        return cloth_fail(error, CLOTH_E_INPUT, "%s: it has no frames", path);
    return CLOTH_OK;
}

/* Reads a frame, the next of the file. bytes: room for it; place: n_vertices x 3. */
static int mesh_pc2_read_frame(FILE *file, const char *path, uint32_t n_vertices, uint32_t frame,
                               unsigned char *bytes, double *place, struct cloth_error *error)
{
    if (fread(bytes, POINT, n_vertices, file) != n_vertices)
        return cloth_fail(error, ferror(file) ? CLOTH_E_IO : CLOTH_E_INPUT,
                          "%s: it ends within frame %ju", path, (uintmax_t)frame + 1);
    for (size_t i = 0; i < 3 * (size_t)n_vertices; i++) {
        place[i] = (double)cloth_get_float(bytes + 4 * i);
        if (!isfinite(place[i]))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%s: vertex %zu of frame %ju has a coordinate that is no finite "
                              "number (vertices and frames count from 1)",
                              path, i / 3 + 1, (uintmax_t)frame + 1);
    }
    return CLOTH_OK;
}

/* The number of whole frames in the file, whatever its header says. */
static uint64_t count_whole(FILE *file, uint32_t n_vertices)
{
    struct stat status;
    const uint64_t size =
        fstat(fileno(file), &status) == 0 && status.st_size > 0 ? (uint64_t)status.st_size : 0;
    if (!n_vertices || size < HEADER)
        return 0;
    return (size - HEADER) / ((uint64_t)POINT * n_vertices);
}

/* Reads the frames from `first` on, before `end`; both are numbers of frames that the header
 * counts. */
static int pc2_read_frames(FILE *file, const char *path, uint32_t n_vertices, uint32_t first,
                           uint32_t end, double **place, struct cloth_error *error)
{
    const uint64_t n_whole = count_whole(file, n_vertices);
    if (n_whole < end)
        return cloth_fail(error, CLOTH_E_INPUT, "%s: it ends within frame %ju", path,
                          (uintmax_t)n_whole + 1);
    const size_t n = 3 * (size_t)n_vertices;
    unsigned char *bytes = cloth_alloc(n_vertices, POINT, error);
    double *to = cloth_alloc((end - first) * n, sizeof *to, error);
    int code = bytes && to ? CLOTH_OK : CLOTH_E_MEMORY;
    if (!code && fseeko(file, HEADER + (off_t)POINT * n_vertices * first, SEEK_SET) != 0)
        code = cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", path, strerror(errno));
    for (uint32_t k = first; k < end && !code; k++)
        code = mesh_pc2_read_frame(file, path, n_vertices, k, bytes, to + (k - first) * n, error);
    free(bytes);
    if (code)
        free(to);
    else
        *place = to;
    return code;
}

int mesh_read_pc2(const char *path, uint32_t n_vertices, uint32_t frame, uint32_t *n_frames,
                  double **place, struct cloth_error *error)
{
    FILE *file = cloth_file_open(path);
    const bool all = frame == MESH_ALL_FRAMES;
    *n_frames = 0;
    *place = NULL;
    if (!file)
        return cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", path, cloth_file_why());
    int code = mesh_pc2_read_header(file, path, n_vertices, n_frames, error);
    const uint32_t first = all ? 0 : frame == MESH_LAST_FRAME ? *n_frames - 1 : frame;
    if (!code && first < *n_frames)
        code = pc2_read_frames(file, path, n_vertices, first, all ? *n_frames : first + 1, place,
                               error);
    fclose(file);
    return code;
}
