/* One file with the JSON of glTF 2.0 and one buffer: for the cloth, then for the obstacles, points
 * and triangles; for the cloth uv between them. A vertex stands once for each uv that it has. */
#include "config.h"

#include "cloth/view/export.h"

#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/view/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of the format. */
enum {
    GLTF_MAGIC = 0x46546C67,
    GLTF_JSON = 0x4E4F534A,
    GLTF_BIN = 0x004E4942,
    GLTF_FLOAT = 5126,
    GLTF_UINT = 5125,
    GLTF_HEADERS = 28 /* bytes: of the file and of both chunks */
};

/* A mesh as the buffer has it. */
struct gltf_mesh {
    const char *name;
    uint32_t n_points, n_triangles;
    float (*point)[3], (*uv)[2]; /* n_points; uv NULL: there is none */
    uint32_t (*corner)[3];
};

static int gltf_take_room(struct gltf_mesh *mesh, bool has_uv, struct cloth_error *error)
{
    mesh->point = cloth_alloc(mesh->n_points, sizeof *mesh->point, error);
    mesh->corner = cloth_alloc(mesh->n_triangles, sizeof *mesh->corner, error);
    mesh->uv = has_uv ? cloth_alloc(mesh->n_points, sizeof *mesh->uv, error) : NULL;
    return mesh->point && mesh->corner && (!has_uv || mesh->uv) ? 0 : CLOTH_E_MEMORY;
}

static void gltf_set_point(struct gltf_mesh *mesh, uint32_t i, const double *x)
{
    for (int c = 0; c < 3; c++)
        mesh->point[i][c] = (float)x[c];
}

/* uv has its origin below in scenes, above in glTF. */
static void gltf_set_uv(struct gltf_mesh *mesh, uint32_t i, const double uv[2])
{
    mesh->uv[i][0] = (float)uv[0];
    mesh->uv[i][1] = (float)(1 - uv[1]);
}

static int gltf_make_cloth(struct gltf_mesh *to, const struct view_export *from,
                           struct cloth_error *error)
{
    const struct mesh *mesh = &from->cache->mesh;
    double uv[2];
    const bool has_uv = mesh_uv(mesh, 0, uv);
    *to = (struct gltf_mesh){.name = "cloth",
                             .n_points = mesh->n_vertices + (has_uv ? mesh->n_more_uv : 0),
                             .n_triangles = mesh->n_triangles};
    if (gltf_take_room(to, has_uv, error))
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        gltf_set_point(to, v, from->position + 3 * (size_t)v);
    for (uint32_t i = 0; i < to->n_points && mesh_uv(mesh, i, uv); i++)
        gltf_set_uv(to, i, uv);
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t v = mesh->triangle[3 * (size_t)t + (size_t)k];
            const uint32_t number =
                mesh->triangle_uv ? mesh->triangle_uv[3 * (size_t)t + (size_t)k] : v;
            gltf_set_point(to, number, from->position + 3 * (size_t)v);
            to->corner[t][k] = number;
        }
    return 0;
}

static int gltf_make_obstacles(struct gltf_mesh *to, const struct view_obstacles *from,
                               struct cloth_error *error)
{
    *to = (struct gltf_mesh){
        .name = "obstacles", .n_points = from->n_vertices, .n_triangles = from->n_triangles};
    if (gltf_take_room(to, false, error))
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < from->n_vertices; v++)
        gltf_set_point(to, v, from->vertex[v]);
    for (uint32_t t = 0; t < from->n_triangles; t++)
        memcpy(to->corner[t], from->triangle[t], sizeof to->corner[t]);
    return 0;
}

/* ---- The JSON ---- */

/* Accessors, and views of the buffer, have the same numbers: points, uv, corners of each mesh. */
struct gltf {
    struct gltf_mesh mesh[2];
    uint32_t n;   /* meshes that have triangles */
    size_t bytes; /* of the buffer */
    char *json;   /* its length is a multiple of 4 */
    size_t n_json;
};

static size_t gltf_put_view(FILE *json, size_t at, size_t bytes, const char *end)
{
    fprintf(json, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}%s", at, bytes, end);
    return at + bytes;
}

static size_t gltf_put_views(FILE *json, const struct gltf *gltf)
{
    size_t at = 0;
    for (uint32_t m = 0; m < gltf->n; m++) {
        const struct gltf_mesh *mesh = gltf->mesh + m;
        at = gltf_put_view(json, at, mesh->n_points * sizeof *mesh->point, ",");
        if (mesh->uv)
            at = gltf_put_view(json, at, mesh->n_points * sizeof *mesh->uv, ",");
        at = gltf_put_view(json, at, mesh->n_triangles * sizeof *mesh->corner,
                           m + 1 < gltf->n ? "," : "");
    }
    return at;
}

static void gltf_put_accessors(FILE *json, const struct gltf *gltf)
{
    uint32_t view = 0;
    for (uint32_t m = 0; m < gltf->n; m++) {
        const struct gltf_mesh *mesh = gltf->mesh + m;
        float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (uint32_t i = 0; i < mesh->n_points; i++)
            for (int c = 0; c < 3; c++) {
                low[c] = fminf(low[c], mesh->point[i][c]);
                high[c] = fmaxf(high[c], mesh->point[i][c]);
            }
        fprintf(json,
                "%s{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"VEC3\","
                "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},",
                m ? "," : "", view++, GLTF_FLOAT, mesh->n_points, low[0], low[1], low[2], high[0],
                high[1], high[2]);
        if (mesh->uv)
            fprintf(json,
                    "{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"VEC2\"},",
                    view++, GLTF_FLOAT, mesh->n_points);
        fprintf(json, "{\"bufferView\":%u,\"componentType\":%d,\"count\":%u,\"type\":\"SCALAR\"}",
                view++, GLTF_UINT, 3 * mesh->n_triangles);
    }
}

static void gltf_put_meshes(FILE *json, const struct gltf *gltf)
{
    uint32_t part = 0;
    for (uint32_t m = 0; m < gltf->n; m++) {
        const struct gltf_mesh *mesh = gltf->mesh + m;
        fprintf(json, "%s{\"name\":\"%s\",\"primitives\":[{\"attributes\":{\"POSITION\":%u",
                m ? "," : "", mesh->name, part++);
        if (mesh->uv)
            fprintf(json, ",\"TEXCOORD_0\":%u", part++);
        fprintf(json, "},\"indices\":%u}]}", part++);
    }
}

static int gltf_make_json(struct gltf *gltf, struct cloth_error *error)
{
    FILE *json = open_memstream(&gltf->json, &gltf->n_json);
    if (!json)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for glTF");
    fputs("{\"asset\":{\"version\":\"2.0\",\"generator\":\"" PACKAGE_STRING "\"},\"scene\":0,",
          json);
    fputs(gltf->n > 1 ? "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"name\":\"cloth\",\"mesh\":0},"
                        "{\"name\":\"obstacles\",\"mesh\":1}]"
                      : "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"cloth\",\"mesh\":0}]",
          json);
    fputs(",\"meshes\":[", json);
    gltf_put_meshes(json, gltf);
    fputs("],\"accessors\":[", json);
    gltf_put_accessors(json, gltf);
    fputs("],\"bufferViews\":[", json);
    gltf->bytes = gltf_put_views(json, gltf);
    fprintf(json, "],\"buffers\":[{\"byteLength\":%zu}]}", gltf->bytes);
    for (long n = ftell(json); n % 4; n++)
        fputc(' ', json);
    const bool failed = ferror(json);
    return fclose(json) || failed ? cloth_fail(error, CLOTH_E_MEMORY, "no memory for glTF") : 0;
}

/* ---- The file ---- */

static void gltf_put_floats(FILE *file, const float *value, size_t n)
{
    unsigned char bytes[4];
    for (size_t i = 0; i < n; i++) {
        cloth_put_float(bytes, value[i]);
        fwrite(bytes, sizeof bytes, 1, file);
    }
}

static size_t gltf_size(const struct gltf *gltf)
{
    return GLTF_HEADERS + gltf->n_json + gltf->bytes;
}

static int gltf_fill(FILE *file, const void *what)
{
    const struct gltf *gltf = what;
    const size_t size = gltf_size(gltf);
    const uint32_t head[] = {GLTF_MAGIC, 2, (uint32_t)size, (uint32_t)gltf->n_json, GLTF_JSON};
    for (size_t i = 0; i < sizeof head / sizeof *head; i++)
        view_export_u32(file, head[i]);
    fwrite(gltf->json, 1, gltf->n_json, file);
    view_export_u32(file, (uint32_t)gltf->bytes);
    view_export_u32(file, GLTF_BIN);
    for (uint32_t m = 0; m < gltf->n; m++) {
        const struct gltf_mesh *mesh = gltf->mesh + m;
        gltf_put_floats(file, mesh->point[0], 3 * (size_t)mesh->n_points);
        if (mesh->uv)
            gltf_put_floats(file, mesh->uv[0], 2 * (size_t)mesh->n_points);
        for (uint32_t t = 0; t < mesh->n_triangles; t++)
            for (int k = 0; k < 3; k++)
                view_export_u32(file, mesh->corner[t][k]);
    }
    return 0;
}

static void gltf_free(struct gltf *gltf)
{
    for (int m = 0; m < 2; m++) {
        free(gltf->mesh[m].point);
        free(gltf->mesh[m].uv);
        free(gltf->mesh[m].corner);
    }
    free(gltf->json);
}

int view_export_gltf(struct output_cache *cache, uint64_t frame, const char *path,
                     struct cloth_error *error)
{
    struct view_export from;
    struct gltf gltf = {.n = 1};
    int code = view_export_open(&from, cache, error);
    code = code ? code : view_export_at(&from, frame, error);
    code = code ? code : gltf_make_cloth(gltf.mesh, &from, error);
    if (!code && from.obstacles->n_triangles) {
        code = gltf_make_obstacles(gltf.mesh + 1, from.obstacles, error);
        gltf.n = 2;
    }
    code = code ? code : gltf_make_json(&gltf, error);
    if (!code && gltf_size(&gltf) > UINT32_MAX)
        code = cloth_fail(error, CLOTH_E_INPUT, "%s: glTF holds no more than 4 GiB", path);
    code = code ? code : output_replace_file(path, gltf_fill, &gltf, error);
    gltf_free(&gltf);
    view_export_close(&from);
    return code;
}
