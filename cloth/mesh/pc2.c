/* PC2 point caches: a header of 32 bytes, then x y z of each vertex in each frame; floats and whole
 * numbers are little-endian on any machine. */
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

static uint32_t number_at(const unsigned char *bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value |= (uint32_t)bytes[i] << (8 * i);
    return value;
}

static double float_at(const unsigned char *bytes)
{
    const uint32_t bits = number_at(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/* How many frames follow of the header, one or more; the file is read up to there. */
static int mesh_pc2_read_header(FILE *file, const char *path, uint32_t n_vertices,
                                uint32_t *n_frames, struct cloth_error *error)
{
    unsigned char header[HEADER];
    if (fread(header, HEADER, 1, file) != 1 || memcmp(header, "POINTCACHE2", 12) != 0 ||
        number_at(header + 12) != 1)
        return cloth_fail(error, CLOTH_E_INPUT, "%s: no PC2 file of version 1", path);
    if (number_at(header + 16) != n_vertices)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: its frames have %u vertices, but the mesh has %u", path,
                          number_at(header + 16), n_vertices);
    *n_frames = number_at(header + 28);
    if (!*n_frames)
        return cloth_fail(error, CLOTH_E_INPUT, "%s: it has no frames", path);
    return CLOTH_OK;
}

/* Adds a frame, the next of the file, to the list. bytes: room for one. */
static int mesh_pc2_read_frame(FILE *file, const char *path, uint32_t n_vertices, uint32_t frame,
                               unsigned char *bytes, struct cloth_list *list,
                               struct cloth_error *error)
{
    if (fread(bytes, POINT, n_vertices, file) != n_vertices)
        return cloth_fail(error, ferror(file) ? CLOTH_E_IO : CLOTH_E_INPUT,
                          "%s: it ends within frame %ju", path, (uintmax_t)frame + 1);
    double(*place)[3] = cloth_list_add(list, sizeof *place, n_vertices, error);
    for (size_t i = 0; place && i < 3 * (size_t)n_vertices; i++)
        place[i / 3][i % 3] = float_at(bytes + 4 * i);
    if (!place)
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < 3 * (size_t)n_vertices; i++)
        if (!isfinite(place[i / 3][i % 3]))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%s: vertex %zu of frame %zu has a coordinate that is no finite "
                              "number (vertices and frames count from 1)",
                              path, i / 3 + 1, list->n / n_vertices);
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
static int read_frames(FILE *file, const char *path, uint32_t n_vertices, uint32_t first,
                       uint32_t end, double **place, struct cloth_error *error)
{
    struct cloth_list list = {0};
    const uint64_t n_whole = count_whole(file, n_vertices);
    if (n_whole < end)
        return cloth_fail(error, CLOTH_E_INPUT, "%s: it ends within frame %ju", path,
                          (uintmax_t)n_whole + 1);
    unsigned char *bytes = cloth_alloc(n_vertices, POINT, error);
    int code = bytes ? CLOTH_OK : CLOTH_E_MEMORY;
    if (!code && fseeko(file, HEADER + (off_t)POINT * n_vertices * first, SEEK_SET) != 0)
        code = cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", path, strerror(errno));
    for (uint32_t k = first; k < end && !code; k++)
        code = mesh_pc2_read_frame(file, path, n_vertices, k, bytes, &list, error);
    free(bytes);
    if (code)
        free(list.items);
    else
        *place = list.items;
    return code;
}

/* Opens it, and reads its header. Returns NULL after an error. */
static FILE *mesh_pc2_open_frames(const char *path, uint32_t n_vertices, uint32_t *n_frames,
                                  struct cloth_error *error)
{
    FILE *file = cloth_file_open(path);
    *n_frames = 0;
    if (!file) {
        cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", path, cloth_file_why());
        return NULL;
    }
    if (mesh_pc2_read_header(file, path, n_vertices, n_frames, error)) {
        fclose(file);
        return NULL;
    }
    return file;
}

int mesh_read_pc2(const char *path, uint32_t n_vertices, uint32_t *n_frames, double **place,
                  struct cloth_error *error)
{
    *place = NULL;
    FILE *file = mesh_pc2_open_frames(path, n_vertices, n_frames, error);
    if (!file)
        return error->code;
    const int code = read_frames(file, path, n_vertices, 0, *n_frames, place, error);
    fclose(file);
    return code;
}

int mesh_read_pc2_frame(const char *path, uint32_t n_vertices, uint32_t frame, uint32_t *n_frames,
                        double **place, struct cloth_error *error)
{
    int code = CLOTH_OK;
    *place = NULL;
    FILE *file = mesh_pc2_open_frames(path, n_vertices, n_frames, error);
    if (!file)
        return error->code;
    const uint32_t one = frame == MESH_LAST_FRAME ? *n_frames - 1 : frame;
    if (one < *n_frames)
        code = read_frames(file, path, n_vertices, one, one + 1, place, error);
    fclose(file);
    return code;
}
