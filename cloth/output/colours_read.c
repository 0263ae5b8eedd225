/* The file is read as it was when it was opened, up to its first incomplete record. A whole record
 * of another size than its kind and the mesh give is an error. */
#include "cloth/base/bytes.h"
#include "cloth/base/file.h"
#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/records.h"

#include <stdlib.h>
#include <string.h>

struct output_colours_read {
    struct output_path path;
    unsigned char *bytes;
    size_t size;
    uint32_t n_vertices;
};

static struct element_strains counts_of(const unsigned char *bytes)
{
    return (struct element_strains){.n_triangles = cloth_get_u32(bytes),
                                    .n_edges = cloth_get_u32(bytes + 4),
                                    .n_materials = cloth_get_u32(bytes + 8)};
}

/* True if a record has the size it must have. bytes: after its header. */
static bool is_sound(const struct output_colours_read *colours, const struct output_record *record,
                     const unsigned char *bytes)
{
    if (record->kind == OUTPUT_RECORD_BLOCKS)
        return record->size == (uint64_t)4 * colours->n_vertices;
    if (record->kind == OUTPUT_RECORD_RANKS)
        return record->size % 4 == 0;
    if (record->kind != OUTPUT_RECORD_REST || record->size < OUTPUT_REST_COUNTS)
        return false;
    const struct element_strains rest = counts_of(bytes);
    return record->size == output_rest_size(&rest);
}

/* The record at *at, which moves behind it. NULL: there is none, or it is being written. */
static const unsigned char *next_record(const struct output_colours_read *colours, size_t *at,
                                        struct output_record *record)
{
    const unsigned char *bytes = colours->bytes + *at;
    const size_t left = colours->size - *at;
    if (left < OUTPUT_RECORD_HEADER)
        return NULL;
    *record = output_record_get(bytes);
    if (record->size > left - OUTPUT_RECORD_HEADER)
        return NULL;
    *at += OUTPUT_RECORD_HEADER + (size_t)record->size;
    return bytes + OUTPUT_RECORD_HEADER;
}

static int check_records(const struct output_colours_read *colours, struct cloth_error *error)
{
    struct output_record record;
    const unsigned char *bytes;
    for (size_t at = OUTPUT_COLOURS_HEADER, from = at; (bytes = next_record(colours, &at, &record));
         from = at)
        if (!is_sound(colours, &record, bytes))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%s is damaged at byte %zu, or of another mesh than cloth.obj beside "
                              "it: run the scene again",
                              colours->path.text, from);
    return CLOTH_OK;
}

int output_colours_load(struct output_colours_read **colours, const char *folder,
                        uint32_t n_vertices, struct cloth_error *error)
{
    struct output_colours_read *made = *colours = cloth_alloc(1, sizeof *made, error);
    if (!made)
        return CLOTH_E_MEMORY;
    made->n_vertices = n_vertices;
    made->path = output_path(folder, "%s", output_colours_name);
    made->bytes = output_read_file(made->path.text, &made->size);
    if (!made->bytes)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "cannot read %s: %s; duite-cloth --output writes it beside the frames",
                          made->path.text, cloth_file_why());
    if (made->size < OUTPUT_COLOURS_HEADER ||
        memcmp(made->bytes, output_colours_header, OUTPUT_COLOURS_HEADER) != 0)
        return cloth_fail(error, CLOTH_E_INPUT, "%s is not what duite-cloth writes (version 1)",
                          made->path.text);
    return check_records(made, error);
}

/* The last record of a kind that counts in a frame; NULL: none. */
static const unsigned char *colours_read_find(const struct output_colours_read *colours,
                                              enum output_record_kind kind, uint64_t frame,
                                              struct output_record *record)
{
    const unsigned char *found = NULL, *bytes;
    struct output_record one;
    for (size_t at = OUTPUT_COLOURS_HEADER; (bytes = next_record(colours, &at, &one));)
        if (one.kind == kind && one.frame <= frame) {
            *record = one;
            found = bytes;
        }
    return found;
}

static int colours_read_fail(const struct output_colours_read *colours, const char *what,
                             uint64_t frame, struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_INPUT, "%s does not say %s of frame %ju", colours->path.text,
                      what, (uintmax_t)frame);
}

static int fail_as_damaged(const struct output_colours_read *colours, const char *what,
                           struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s is damaged: it has a number of %s that is none: run the scene again",
                      colours->path.text, what);
}

/* -1, or less than there are vertices: of a block, or of a rank, which has a block. */
static bool get_number(const struct output_colours_read *colours, const unsigned char bytes[4],
                       int32_t *number)
{
    const uint32_t value = cloth_get_u32(bytes);
    *number = value == UINT32_MAX ? -1 : (int32_t)value;
    return value == UINT32_MAX || value < colours->n_vertices;
}

int output_colours_blocks(const struct output_colours_read *colours, uint64_t frame, int32_t *block,
                          struct cloth_error *error)
{
    struct output_record record;
    const unsigned char *bytes = colours_read_find(colours, OUTPUT_RECORD_BLOCKS, frame, &record);
    if (!bytes)
        return colours_read_fail(colours, "the blocks", frame, error);
    for (size_t v = 0; v < colours->n_vertices; v++)
        if (!get_number(colours, bytes + 4 * v, block + v))
            return fail_as_damaged(colours, "a block", error);
    return CLOTH_OK;
}

int output_colours_ranks(const struct output_colours_read *colours, uint64_t frame, int32_t *rank,
                         struct cloth_error *error)
{
    struct output_record record;
    int code = output_colours_blocks(colours, frame, rank, error);
    const unsigned char *bytes = colours_read_find(colours, OUTPUT_RECORD_RANKS, frame, &record);
    if (code || !bytes)
        return code ? code : colours_read_fail(colours, "the ranks", frame, error);
    const uint64_t n_blocks = record.size / 4;
    for (size_t v = 0; v < colours->n_vertices; v++) {
        if (rank[v] < 0)
            continue;
        if ((uint64_t)rank[v] >= n_blocks)
            return colours_read_fail(colours, "the ranks of all blocks", frame, error);
        if (!get_number(colours, bytes + (size_t)4 * (size_t)rank[v], rank + v))
            return fail_as_damaged(colours, "a rank", error);
    }
    return CLOTH_OK;
}

uint64_t output_colours_rest_since(const struct output_colours_read *colours, uint64_t frame)
{
    struct output_record record;
    return colours_read_find(colours, OUTPUT_RECORD_REST, frame, &record) ? record.frame
                                                                          : UINT64_MAX;
}

int output_colours_rest_at(const struct output_colours_read *colours, uint64_t frame,
                           struct element_strains *rest, struct cloth_error *error)
{
    struct output_record record;
    const unsigned char *bytes = colours_read_find(colours, OUTPUT_RECORD_REST, frame, &record);
    *rest = (struct element_strains){0};
    if (!bytes)
        return colours_read_fail(colours, "the shapes at rest", frame, error);
    *rest = counts_of(bytes);
    rest->n_vertices = colours->n_vertices;
    if (element_strains_room(rest, error))
        return CLOTH_E_MEMORY;
    return output_rest_get(bytes, rest) ? CLOTH_OK
                                        : fail_as_damaged(colours, "a shape at rest", error);
}

void output_colours_unload(struct output_colours_read *colours)
{
    if (!colours)
        return;
    free(colours->bytes);
    free(colours);
}
