/* The file holds a header and whole records: one is written at once, behind those before it, and
 * one that fails is taken away again. */
#include "cloth/output/colours.h"

#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/records.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct output_colours {
    char *path;
    int file;      /* -1: none */
    uint64_t size; /* bytes of whole records */
    uint32_t n_vertices, n_blocks;
    unsigned char *blocks, *ranks; /* as they were written last; NULL: they were not */
};

int output_rest_make(struct output_rest *rest, struct cloth_error *error)
{
    rest->corner = cloth_alloc(rest->n_triangles, sizeof *rest->corner, error);
    rest->gradient = cloth_alloc(rest->n_triangles, sizeof *rest->gradient, error);
    rest->area = cloth_alloc(rest->n_triangles, sizeof *rest->area, error);
    rest->edge = cloth_alloc(rest->n_edges, sizeof *rest->edge, error);
    rest->length = cloth_alloc(rest->n_edges, sizeof *rest->length, error);
    rest->modulus = cloth_alloc(rest->n_materials, sizeof *rest->modulus, error);
    rest->has_stress = cloth_alloc(rest->n_materials, sizeof *rest->has_stress, error);
    return rest->corner && rest->gradient && rest->area && rest->edge && rest->length &&
                   rest->modulus && rest->has_stress
               ? CLOTH_OK
               : CLOTH_E_MEMORY;
}

void output_rest_free(struct output_rest *rest)
{
    free(rest->corner);
    free(rest->gradient);
    free(rest->area);
    free(rest->edge);
    free(rest->length);
    free(rest->modulus);
    free(rest->has_stress);
    *rest = (struct output_rest){0};
}

uint64_t output_colours_bytes(uint32_t n_vertices, uint32_t n_blocks,
                              const struct output_rest *rest)
{
    return OUTPUT_COLOURS_HEADER + 3 * OUTPUT_RECORD_HEADER + output_rest_size(rest) +
           4 * ((uint64_t)n_vertices + n_blocks);
}

/* ---- Beginning ---- */

/* Reads n bytes at an offset. Returns false where there are fewer. */
static bool output_colours_read_at(int file, unsigned char *bytes, size_t n, uint64_t at)
{
    return pread(file, bytes, n, (off_t)at) == (ssize_t)n;
}

static bool output_colours_is_ours(int file)
{
    unsigned char header[OUTPUT_COLOURS_HEADER];
    return output_colours_read_at(file, header, sizeof header, 0) &&
           memcmp(header, output_colours_header, sizeof header) == 0;
}

/* The size of the records of earlier frames, which come first. */
static uint64_t find_size(int file, const uint64_t *n_frames)
{
    uint64_t size = OUTPUT_COLOURS_HEADER;
    unsigned char bytes[OUTPUT_RECORD_HEADER];
    struct stat status;
    if (!n_frames || fstat(file, &status) != 0)
        return size;
    while (output_colours_read_at(file, bytes, sizeof bytes, size)) {
        const struct output_record record = output_record_get(bytes);
        const uint64_t left = (uint64_t)status.st_size - size - OUTPUT_RECORD_HEADER;
        if (record.frame >= *n_frames || record.size > left)
            break;
        size += OUTPUT_RECORD_HEADER + record.size;
    }
    return size;
}

static int output_colours_start(struct output_colours *colours, const uint64_t *n_frames,
                                struct cloth_error *error)
{
    struct stat status;
    colours->file = open(colours->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (colours->file < 0 || fstat(colours->file, &status) != 0)
        return output_refuse(error, "write", colours->path);
    if (status.st_size > 0 && !output_colours_is_ours(colours->file))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is in the way, and is not of an earlier run; give another folder, or "
                          "move the file away",
                          colours->path);
    colours->size = find_size(colours->file, n_frames);
    if (ftruncate(colours->file, (off_t)colours->size) != 0 ||
        output_write_at(colours->file, output_colours_header, OUTPUT_COLOURS_HEADER, 0) != 0)
        return output_fail(error, "write", colours->path);
    return CLOTH_OK;
}

int output_colours_open(struct output_colours **colours, const char *folder, uint32_t n_vertices,
                        const uint64_t *n_frames, struct cloth_error *error)
{
    struct output_colours *made = *colours = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the colours of %s", folder);
    made->file = -1;
    made->n_vertices = n_vertices;
    made->path = output_path(folder, output_colours_name, "");
    return made->path ? output_colours_start(made, n_frames, error)
                      : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
}

/* ---- Records ---- */

/* Writes `bytes`, which begin with room for the record's header. */
static int output_colours_add(struct output_colours *colours, enum output_record_kind kind,
                              uint64_t frame, unsigned char *bytes, uint64_t size,
                              struct cloth_error *error)
{
    const struct output_record record = {kind, (uint32_t)frame, size};
    output_record_put(bytes, &record);
    int code = output_check_same(colours->file, colours->path, error);
    if (!code &&
        output_write_at(colours->file, bytes, OUTPUT_RECORD_HEADER + size, colours->size) != 0) {
        code = output_fail(error, "write", colours->path);
        if (ftruncate(colours->file, (off_t)colours->size) != 0)
            return code; /* the rest is incomplete, and readers stop before it */
    }
    if (!code)
        colours->size += OUTPUT_RECORD_HEADER + size;
    return code;
}

int output_colours_rest(struct output_colours *colours, uint64_t frame,
                        const struct output_rest *rest, struct cloth_error *error)
{
    const uint64_t size = output_rest_size(rest);
    unsigned char *bytes = cloth_alloc(OUTPUT_RECORD_HEADER + size, 1, error);
    if (!bytes)
        return CLOTH_E_MEMORY;
    output_rest_put(bytes + OUTPUT_RECORD_HEADER, rest);
    const int code = output_colours_add(colours, OUTPUT_RECORD_REST, frame, bytes, size, error);
    free(bytes);
    return code;
}

/* Writes n numbers unless they equal the last ones. */
static int add_numbers(struct output_colours *colours, enum output_record_kind kind, uint64_t frame,
                       uint32_t n, const int32_t *number, bool known, unsigned char **last,
                       struct cloth_error *error)
{
    const size_t size = (size_t)4 * n;
    unsigned char *bytes = cloth_alloc(OUTPUT_RECORD_HEADER + size, 1, error);
    int code = bytes ? CLOTH_OK : CLOTH_E_MEMORY;
    for (size_t i = 0; i < n && bytes; i++)
        output_put_u32(bytes + OUTPUT_RECORD_HEADER + 4 * i, (uint32_t)number[i]);
    if (bytes && !(known && *last &&
                   memcmp(*last + OUTPUT_RECORD_HEADER, bytes + OUTPUT_RECORD_HEADER, size) == 0)) {
        code = output_colours_add(colours, kind, frame, bytes, size, error);
        unsigned char *before = *last;
        *last = bytes;
        bytes = before;
    }
    free(bytes);
    return code;
}

int output_colours_places(struct output_colours *colours, uint64_t frame, const int32_t *block,
                          uint32_t n_blocks, const int32_t *rank, struct cloth_error *error)
{
    const bool known = colours->n_blocks == n_blocks;
    int code = add_numbers(colours, OUTPUT_RECORD_BLOCKS, frame, colours->n_vertices, block, true,
                           &colours->blocks, error);
    if (!code)
        code = add_numbers(colours, OUTPUT_RECORD_RANKS, frame, n_blocks, rank, known,
                           &colours->ranks, error);
    colours->n_blocks = n_blocks;
    return code;
}

int output_colours_close(struct output_colours **colours, struct cloth_error *error)
{
    struct output_colours *gone = *colours;
    int code = CLOTH_OK;
    *colours = NULL;
    if (!gone)
        return CLOTH_OK;
    if (gone->file >= 0 && close(gone->file) != 0)
        code = output_fail(error, "close", gone->path);
    free(gone->path);
    free(gone->blocks);
    free(gone->ranks);
    free(gone);
    return code;
}
