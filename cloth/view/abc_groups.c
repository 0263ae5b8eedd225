/* Groups in the order of Alembic's library (AbcCoreOgawa, AbcGeom): an object is a group of its
 * properties, its children and their names; a property is a group of its samples. */
#include "config.h"

#include "cloth/view/abc.h"

#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"

#include <errno.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of the format: of a property's head its kind, the sort and count of the numbers that make
 * an item, and marks; the versions of files and of the oldest library that reads them. */
enum {
    ABC_COMPOUND = 0,
    ABC_SCALAR = 1,
    ABC_ARRAY = 2,
    ABC_WIDE = 2 << 2, /* sizes in heads have four bytes */
    ABC_UINT = 5 << 4,
    ABC_INT = 6 << 4,
    ABC_FLOAT = 10 << 4,
    ABC_DOUBLE = 11 << 4,
    ABC_TIMED = 1 << 8, /* the number of its times follows */
    ABC_EVEN = 1 << 10, /* all samples have as many items */
    ABC_CONSTANT = 1 << 11,
    ABC_EXTENT = 1 << 12,      /* times the count */
    ABC_OWN_META = 0xff << 20, /* of a property, 255 of an object: its words follow */
    ABC_VERSION = 0,
    ABC_LIBRARY = 10500
};
#define ABC_ANY_TIMES (DBL_MAX / 32) /* in the place of a period: each sample has its own time */

#define ABC_SCHEMA    "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1"
#define ABC_MESH_META ABC_SCHEMA ";schemaObjTitle=AbcGeom_PolyMesh_v1:.geom"
#define ABC_UV_META                                                                                \
    "arrayExtent=1;geoScope=fvr;interpretation=vector;isGeomParam=true;podExtent=2;"               \
    "podName=float32_t"

/* The bytes that name a group's children, gathered in memory. */
struct abc_head {
    FILE *file;
    char *bytes;
    size_t n;
};

static int abc_open_head(struct abc_head *head, struct cloth_error *error)
{
    *head = (struct abc_head){0};
    head->file = open_memstream(&head->bytes, &head->n);
    return head->file ? 0 : cloth_fail(error, CLOTH_E_MEMORY, "no memory for Alembic");
}

static int abc_close_head(struct abc *abc, struct abc_head *head, uint64_t *reference,
                          struct cloth_error *error)
{
    bool whole = !ferror(head->file);
    whole = !fclose(head->file) && whole;
    if (whole)
        *reference = ogawa_put_bytes(&abc->out, head->bytes, head->n);
    free(head->bytes);
    return whole ? 0 : cloth_fail(error, CLOTH_E_MEMORY, "no memory for Alembic");
}

static void abc_put_words(FILE *file, const char *words)
{
    view_export_u32(file, (uint32_t)strlen(words));
    fputs(words, file);
}

static void abc_put_double(FILE *file, double value)
{
    unsigned char bytes[8];
    cloth_put_double(bytes, value);
    fwrite(bytes, sizeof bytes, 1, file);
}

/* meta: what it means; NULL: no more than its name says. */
static void abc_name_property(const struct abc *abc, FILE *file, const char *name, const char *meta,
                              uint32_t kind)
{
    view_export_u32(file, kind | ABC_WIDE | (meta ? ABC_OWN_META : 0));
    if (kind) {
        view_export_u32(file, abc_frames(abc));
        view_export_u32(file, 1); /* the second times, which are the frames' */
    }
    abc_put_words(file, name);
    if (meta)
        abc_put_words(file, meta);
}

/* A property of an array: each sample has a second block, for shapes of more than one dimension. */
static uint64_t abc_put_array(struct abc *abc, const uint64_t *sample, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        abc->child[2 * (size_t)i] = sample[i];
        abc->child[2 * (size_t)i + 1] = OGAWA_BYTES;
    }
    return ogawa_put_group(&abc->out, abc->child, 2 * (size_t)n);
}

static int abc_put_uv_group(struct abc *abc, const struct abc_mesh *mesh, uint64_t *reference,
                            struct cloth_error *error)
{
    const uint32_t kind = ABC_ARRAY | ABC_TIMED | ABC_EVEN | ABC_CONSTANT;
    uint64_t part[3] = {abc_put_array(abc, &mesh->uv, 1), abc_put_array(abc, &mesh->uv_numbers, 1)};
    struct abc_head head;
    int code = abc_open_head(&head, error);
    if (code)
        return code;
    abc_name_property(abc, head.file, ".vals", ABC_UV_META, kind | ABC_FLOAT | 2 * ABC_EXTENT);
    abc_name_property(abc, head.file, ".indices", NULL, kind | ABC_UINT | ABC_EXTENT);
    code = abc_close_head(abc, &head, part + 2, error);
    *reference = ogawa_put_group(&abc->out, part, 3);
    return code;
}

static int abc_put_geometry(struct abc *abc, const struct abc_mesh *mesh, uint64_t *reference,
                            struct cloth_error *error)
{
    const uint32_t n = mesh->moves ? abc_frames(abc) : 1;
    const uint32_t kind = ABC_TIMED | ABC_EVEN, fixed = kind | ABC_CONSTANT,
                   moving = n > 1 ? kind : fixed;
    uint64_t part[6] = {
        abc_put_array(abc, mesh->points, n), ogawa_put_group(&abc->out, mesh->boxes, n),
        abc_put_array(abc, &mesh->corners, 1), abc_put_array(abc, &mesh->counts, 1)};
    size_t n_parts = 4;
    struct abc_head head;
    int code = abc_open_head(&head, error);
    if (code)
        return code;
    abc_name_property(abc, head.file, "P", "geoScope=vtx;interpretation=point",
                      ABC_ARRAY | moving | ABC_FLOAT | 3 * ABC_EXTENT);
    abc_name_property(abc, head.file, ".selfBnds", "interpretation=box",
                      ABC_SCALAR | moving | ABC_DOUBLE | ABC_BOX * ABC_EXTENT);
    abc_name_property(abc, head.file, ".faceIndices", NULL,
                      ABC_ARRAY | fixed | ABC_INT | ABC_EXTENT);
    abc_name_property(abc, head.file, ".faceCounts", NULL,
                      ABC_ARRAY | fixed | ABC_INT | ABC_EXTENT);
    if (mesh->has_uv) {
        abc_name_property(abc, head.file, "uv", ABC_UV_META, ABC_COMPOUND);
        code = abc_put_uv_group(abc, mesh, part + n_parts++, error);
    }
    const int closed = abc_close_head(abc, &head, part + n_parts++, error);
    *reference = ogawa_put_group(&abc->out, part, n_parts);
    return code ? code : closed;
}

static int abc_put_object(struct abc *abc, const struct abc_mesh *mesh, uint64_t *reference,
                          struct cloth_error *error)
{
    unsigned char sums[2 * OGAWA_DIGEST] = {0}; /* of the properties and of no children */
    uint64_t properties[2], object[2];
    struct abc_head head;
    int code = abc_put_geometry(abc, mesh, properties, error);
    code = code ? code : abc_open_head(&head, error);
    if (code)
        return code;
    abc_name_property(abc, head.file, ".geom", ABC_SCHEMA, ABC_COMPOUND);
    code = abc_close_head(abc, &head, properties + 1, error);
    memcpy(sums, mesh->sum, OGAWA_DIGEST);
    object[0] = ogawa_put_group(&abc->out, properties, 2);
    object[1] = ogawa_put_bytes(&abc->out, sums, sizeof sums);
    *reference = ogawa_put_group(&abc->out, object, 2);
    return code;
}

/* The object that has all meshes, and no properties. */
static int abc_put_top(struct abc *abc, uint64_t *reference, struct cloth_error *error)
{
    uint64_t *child = cloth_alloc((size_t)abc->n_meshes + 2, sizeof *child, error);
    unsigned char sums[2 * OGAWA_DIGEST] = {0}; /* of no properties and of the meshes */
    struct abc_head head;
    int code = child ? abc_open_head(&head, error) : CLOTH_E_MEMORY;
    if (code) {
        free(child);
        return code;
    }
    for (uint32_t m = 0; m < abc->n_meshes && !code; m++) {
        for (size_t i = 0; i < OGAWA_DIGEST; i++)
            sums[OGAWA_DIGEST + i] ^= abc->mesh[m].sum[i];
        abc_put_words(head.file, abc->mesh[m].part.name);
        fputc(0xff, head.file);
        abc_put_words(head.file, ABC_MESH_META);
        code = abc_put_object(abc, abc->mesh + m, child + 1 + m, error);
    }
    fwrite(sums, sizeof sums, 1, head.file);
    const int closed = abc_close_head(abc, &head, child + 1 + abc->n_meshes, error);
    *reference = ogawa_put_group(&abc->out, child, (size_t)abc->n_meshes + 2);
    free(child);
    return code ? code : closed;
}

static void abc_put_times(const struct abc *abc, FILE *file, uint32_t n, double period,
                          const double *time)
{
    view_export_u32(file, abc_frames(abc));
    abc_put_double(file, period);
    view_export_u32(file, n);
    for (uint32_t i = 0; i < n; i++)
        abc_put_double(file, time[i]);
}

int abc_put_root(struct abc *abc, const char *path, struct cloth_error *error)
{
    const struct output_cache *cache = abc->from.cache;
    const double zero = 0;
    unsigned char number[4];
    uint64_t part[6] = {0};
    struct abc_head head;
    char meta[128];
    int code = abc_put_top(abc, part + 2, error);
    code = code ? code : abc_open_head(&head, error);
    if (code)
        return code;
    cloth_put_u32(number, ABC_VERSION);
    part[0] = ogawa_put_bytes(&abc->out, number, sizeof number);
    cloth_put_u32(number, ABC_LIBRARY);
    part[1] = ogawa_put_bytes(&abc->out, number, sizeof number);
    const int n = snprintf(meta, sizeof meta, "_ai_Application=%s;_ai_DCC_FPS=%.9g", PACKAGE_STRING,
                           cache->fps);
    part[3] = ogawa_put_bytes(&abc->out, meta, (size_t)n);
    abc_put_times(abc, head.file, 1, 1, &zero); /* the first times are those of any file */
    abc_put_times(abc, head.file, abc_frames(abc), ABC_ANY_TIMES, cache->time + abc->first);
    code = abc_close_head(abc, &head, part + 4, error);
    part[5] = OGAWA_BYTES; /* words that heads could share: each has its own */
    const uint64_t root = ogawa_put_group(&abc->out, part, 6);
    if (!code && ogawa_end(&abc->out, root))
        code = errno == ESPIPE
                   ? cloth_fail(error, CLOTH_E_INPUT, "%s: Alembic goes to a file, not to a pipe",
                                path)
                   : cloth_fail(error, CLOTH_E_IO, "cannot write %s: %s", path, strerror(errno));
    return code;
}
