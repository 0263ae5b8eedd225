/* The file holds a header and whole records: one is written at once, behind those before it. */
#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/records.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct output_colours {
    struct output_file of;
    uint32_t n_vertices, n_blocks;
    unsigned char *blocks, *ranks; /* as they were written last; NULL: they were not */
};

uint64_t output_colours_bytes(uint32_t n_vertices, uint32_t n_blocks,
                              const struct element_strains *rest)
{
    return OUTPUT_COLOURS_HEADER + 3 * OUTPUT_RECORD_HEADER + output_rest_size(rest) +
           4 * ((uint64_t)n_vertices + n_blocks);
}

/* ---- Beginning ---- */

/* The size of the records of earlier frames, which come first. */
static uint64_t find_size(int file, uint64_t file_size, uint64_t n_frames)
{
    uint64_t size = OUTPUT_COLOURS_HEADER;
    unsigned char bytes[OUTPUT_RECORD_HEADER];
    while (output_read_at(file, bytes, sizeof bytes, size)) {
        const struct output_record record = output_record_get(bytes);
        if (record.frame >= n_frames || record.size > file_size - size - OUTPUT_RECORD_HEADER)
            break;
        size += OUTPUT_RECORD_HEADER + record.size;
    }
    return size;
}

static int colours_start(struct output_file *of, const uint64_t *n_frames,
                         struct cloth_error *error)
{
    struct stat status;
    const char *path = of->path.text;
    if (output_file_open(of, O_RDWR | O_CREAT, "write", error))
        return error->code;
    if (fstat(of->file, &status) != 0)
        return output_refuse(error, "write", path);
    if (status.st_size > 0 && !output_begins(path, output_colours_header, OUTPUT_COLOURS_HEADER))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is in the way, and is not of an earlier run; give another folder, or "
                          "move the file away",
                          path);
    of->size =
        n_frames ? find_size(of->file, (uint64_t)status.st_size, *n_frames) : OUTPUT_COLOURS_HEADER;
    if (ftruncate(of->file, (off_t)of->size) != 0 ||
        output_write_at(of->file, output_colours_header, OUTPUT_COLOURS_HEADER, 0) != 0)
        return output_fail(error, "write", path);
    return CLOTH_OK;
}

int output_colours_open(struct output_colours **colours, const char *folder, uint32_t n_vertices,
                        const uint64_t *n_frames, struct cloth_error *error)
{
    struct output_colours *made = *colours = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the colours of %s", folder);
    made->n_vertices = n_vertices;
    made->of = output_file(folder, output_colours_name);
    return colours_start(&made->of, n_frames, error);
}

/* ---- Records ---- */

/* Writes `bytes`, which begin with room for the record's header. */
static int colours_add(struct output_colours *colours, enum output_record_kind kind, uint64_t frame,
                       unsigned char *bytes, uint64_t size, struct cloth_error *error)
{
    const struct output_record record = {kind, (uint32_t)frame, size};
    output_record_put(bytes, &record);
    return output_file_append(&colours->of, bytes, OUTPUT_RECORD_HEADER + size, "write", error);
}

int output_colours_rest(struct output_colours *colours, uint64_t frame,
                        const struct element_strains *rest, struct cloth_error *error)
{
    const uint64_t size = output_rest_size(rest);
    unsigned char *bytes = cloth_alloc(OUTPUT_RECORD_HEADER + size, 1, error);
    if (!bytes)
        return CLOTH_E_MEMORY;
    output_rest_put(bytes + OUTPUT_RECORD_HEADER, rest);
    const int code = colours_add(colours, OUTPUT_RECORD_REST, frame, bytes, size, error);
    free(bytes);
    return code;
}

/* Writes n numbers unless they equal the last ones. */
static int add_numbers(struct output_colours *colours, enum output_record_kind kind, uint64_t frame,
                       uint32_t n, const int32_t *number, unsigned char **last,
                       struct cloth_error *error)
{
    const size_t size = (size_t)4 * n;
    unsigned char *bytes = cloth_alloc(OUTPUT_RECORD_HEADER + size, 1, error);
    int code = bytes ? CLOTH_OK : CLOTH_E_MEMORY;
    for (size_t i = 0; i < n && bytes; i++)
        cloth_put_u32(bytes + OUTPUT_RECORD_HEADER + 4 * i, (uint32_t)number[i]);
    if (bytes &&
        !(*last && memcmp(*last + OUTPUT_RECORD_HEADER, bytes + OUTPUT_RECORD_HEADER, size) == 0)) {
        code = colours_add(colours, kind, frame, bytes, size, error);
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
    if (colours->n_blocks != n_blocks) {
        free(colours->ranks);
        colours->ranks = NULL;
    }
    colours->n_blocks = n_blocks;
    const int code = add_numbers(colours, OUTPUT_RECORD_BLOCKS, frame, colours->n_vertices, block,
                                 &colours->blocks, error);
    return code ? code
                : add_numbers(colours, OUTPUT_RECORD_RANKS, frame, n_blocks, rank, &colours->ranks,
                              error);
}

int output_colours_close(struct output_colours **colours, struct cloth_error *error)
{
    struct output_colours *gone = *colours;
    *colours = NULL;
    if (!gone)
        return CLOTH_OK;
    const int code = output_file_close(&gone->of, error);
    free(gone->blocks);
    free(gone->ranks);
    free(gone);
    return code;
}
