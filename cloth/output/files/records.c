/* Numbers are floats on the disk, as positions are: what follows from them is no finer. */
#include "cloth/output/files/records.h"

#include "cloth/output/files/files.h"

#include <math.h>

const char output_colours_name[] = "colours.bin";
const unsigned char output_colours_header[OUTPUT_COLOURS_HEADER] = "DUITE COLOURS 1\n";

void output_record_put(unsigned char bytes[OUTPUT_RECORD_HEADER],
                       const struct output_record *record)
{
    output_put_u32(bytes, record->kind);
    output_put_u32(bytes + 4, record->frame);
    output_put_u32(bytes + 8, (uint32_t)(record->size & UINT32_MAX));
    output_put_u32(bytes + 12, (uint32_t)(record->size >> 32));
}

struct output_record output_record_get(const unsigned char bytes[OUTPUT_RECORD_HEADER])
{
    const uint64_t high = output_get_u32(bytes + 12);
    return (struct output_record){.kind = output_get_u32(bytes),
                                  .frame = output_get_u32(bytes + 4),
                                  .size = high << 32 | output_get_u32(bytes + 8)};
}

/* ---- Shapes at rest ---- */

uint64_t output_rest_size(const struct output_rest *rest)
{
    return OUTPUT_REST_COUNTS + (uint64_t)OUTPUT_REST_TRIANGLE * rest->n_triangles +
           (uint64_t)OUTPUT_REST_EDGE * rest->n_edges +
           (uint64_t)OUTPUT_REST_MATERIAL * rest->n_materials;
}

static unsigned char *records_put_whole(unsigned char *bytes, const uint32_t *value, size_t n)
{
    for (size_t i = 0; i < n; i++)
        output_put_u32(bytes + 4 * i, value[i]);
    return bytes + 4 * n;
}

static unsigned char *put_floats(unsigned char *bytes, const double *value, size_t n)
{
    for (size_t i = 0; i < n; i++)
        output_put_float(bytes + 4 * i, (float)value[i]);
    return bytes + 4 * n;
}

void output_rest_put(unsigned char *bytes, const struct output_rest *rest)
{
    bytes = records_put_whole(bytes, &rest->n_triangles, 1);
    bytes = records_put_whole(bytes, &rest->n_edges, 1);
    bytes = records_put_whole(bytes, &rest->n_materials, 1);
    for (size_t t = 0; t < rest->n_triangles; t++) {
        bytes = records_put_whole(bytes, rest->corner[t], 4);
        bytes = put_floats(bytes, rest->gradient[t], 4);
        bytes = put_floats(bytes, rest->area + t, 1);
    }
    for (size_t e = 0; e < rest->n_edges; e++) {
        bytes = records_put_whole(bytes, rest->edge[e], 2);
        bytes = put_floats(bytes, rest->length + e, 1);
    }
    for (size_t m = 0; m < rest->n_materials; m++) {
        bytes = put_floats(bytes, rest->modulus[m], 4);
        bytes = records_put_whole(bytes, &(uint32_t){rest->has_stress[m]}, 1);
    }
}

/* Whether all are below `end`. */
static bool get_whole(const unsigned char **bytes, uint32_t *value, size_t n, uint32_t end)
{
    bool good = true;
    for (size_t i = 0; i < n; i++, *bytes += 4) {
        value[i] = output_get_u32(*bytes);
        good = good && value[i] < end;
    }
    return good;
}

/* Whether all are numbers. */
static bool get_floats(const unsigned char **bytes, double *value, size_t n)
{
    bool good = true;
    for (size_t i = 0; i < n; i++, *bytes += 4) {
        value[i] = (double)output_get_float(*bytes);
        good = good && isfinite(value[i]);
    }
    return good;
}

bool output_rest_get(const unsigned char *bytes, uint32_t n_vertices, struct output_rest *rest)
{
    bool good = true;
    bytes += OUTPUT_REST_COUNTS;
    for (size_t t = 0; t < rest->n_triangles && good; t++) {
        uint32_t *corner = rest->corner[t];
        good = get_whole(&bytes, corner, 3, n_vertices) &&
               get_whole(&bytes, corner + 3, 1, rest->n_materials) &&
               get_floats(&bytes, rest->gradient[t], 4) && get_floats(&bytes, rest->area + t, 1);
    }
    for (size_t e = 0; e < rest->n_edges && good; e++)
        good = get_whole(&bytes, rest->edge[e], 2, n_vertices) &&
               get_floats(&bytes, rest->length + e, 1);
    for (size_t m = 0; m < rest->n_materials && good; m++) {
        uint32_t has_stress = 0;
        good = get_floats(&bytes, rest->modulus[m], 4) && get_whole(&bytes, &has_stress, 1, 2);
        rest->has_stress[m] = has_stress;
    }
    return good;
}
