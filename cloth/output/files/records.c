/* Numbers are floats on the disk, as positions are: what follows from them is no finer. */
#include "cloth/output/files/records.h"

#include "cloth/base/bytes.h"

#include <math.h>

const char output_colours_name[] = "colours.bin";
const unsigned char output_colours_header[OUTPUT_COLOURS_HEADER] = "DUITE COLOURS 1\n";

void output_record_put(unsigned char bytes[OUTPUT_RECORD_HEADER],
                       const struct output_record *record)
{
    cloth_put_u32(bytes, record->kind);
    cloth_put_u32(bytes + 4, record->frame);
    cloth_put_u64(bytes + 8, record->size);
}

struct output_record output_record_get(const unsigned char bytes[OUTPUT_RECORD_HEADER])
{
    return (struct output_record){.kind = cloth_get_u32(bytes),
                                  .frame = cloth_get_u32(bytes + 4),
                                  .size = cloth_get_u64(bytes + 8)};
}

/* ---- Shapes at rest ---- */

uint64_t output_rest_size(const struct element_strains *rest)
{
    return OUTPUT_REST_COUNTS + (uint64_t)OUTPUT_REST_TRIANGLE * rest->n_triangles +
           (uint64_t)OUTPUT_REST_EDGE * rest->n_edges +
           (uint64_t)OUTPUT_REST_MATERIAL * rest->n_materials;
}

/* Goes through the bytes of a record, and either writes numbers or reads them. */
struct walk {
    unsigned char *to; /* NULL: it reads */
    const unsigned char *from;
    bool good; /* all that was read is in range */
};

/* Numbers below `end`. */
static void walk_whole(struct walk *walk, uint32_t *value, size_t n, uint32_t end)
{
    for (size_t i = 0; i < n; i++)
        if (walk->to) {
            cloth_put_u32(walk->to, value[i]);
            walk->to += 4;
        } else {
            value[i] = cloth_get_u32(walk->from);
            walk->from += 4;
            walk->good = walk->good && value[i] < end;
        }
}

static void walk_floats(struct walk *walk, double *value, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (walk->to) {
            cloth_put_float(walk->to, (float)value[i]);
            walk->to += 4;
        } else {
            value[i] = (double)cloth_get_float(walk->from);
            walk->from += 4;
            walk->good = walk->good && isfinite(value[i]);
        }
}

static void walk_rest(struct walk *walk, const struct element_strains *rest)
{
    const uint32_t n_vertices = rest->n_vertices;
    for (size_t t = 0; t < rest->n_triangles && walk->good; t++) {
        walk_whole(walk, rest->corner[t], 3, n_vertices);
        walk_whole(walk, rest->corner[t] + 3, 1, rest->n_materials);
        walk_floats(walk, (double *)&rest->gradient[t], 4);
        walk_floats(walk, rest->area + t, 1);
    }
    for (size_t e = 0; e < rest->n_edges && walk->good; e++) {
        walk_whole(walk, rest->edge[e], 2, n_vertices);
        walk_floats(walk, rest->length + e, 1);
    }
    for (size_t m = 0; m < rest->n_materials && walk->good; m++) {
        uint32_t has_stress = rest->has_stress[m];
        walk_floats(walk, (double *)&rest->membrane[m].modulus, 4);
        walk_whole(walk, &has_stress, 1, 2);
        rest->has_stress[m] = has_stress;
    }
}

void output_rest_put(unsigned char *bytes, const struct element_strains *rest)
{
    struct walk walk = {.to = bytes + OUTPUT_REST_COUNTS, .good = true};
    cloth_put_u32(bytes, rest->n_triangles);
    cloth_put_u32(bytes + 4, rest->n_edges);
    cloth_put_u32(bytes + 8, rest->n_materials);
    walk_rest(&walk, rest);
}

bool output_rest_get(const unsigned char *bytes, struct element_strains *rest)
{
    struct walk walk = {.from = bytes + OUTPUT_REST_COUNTS, .good = true};
    walk_rest(&walk, rest);
    return walk.good;
}
