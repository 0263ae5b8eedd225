/* A mesh a cloth, and one of all obstacles, in a layer of OpenUSD's text form. Each mesh has all
 * its time samples in one place, so that the frames of the folder are read once for each. */
#include "cloth/output/files/files.h"
#include "cloth/view/export.h"

#include "cloth/view/view.h"

#include <inttypes.h>
#include <stdio.h>

enum { USD_LINE = 8 }; /* numbers or points a line: files of one long line open in no editor */

struct usd {
    struct view_export from;
    uint64_t first, last;
};

static void usd_put_break(FILE *file, size_t i)
{
    fputs(i ? i % USD_LINE ? ", " : ",\n            " : "", file);
}

static void usd_put_point(FILE *file, size_t i, const double *x)
{
    usd_put_break(file, i);
    fprintf(file, "(%.9g, %.9g, %.9g)", x[0], x[1], x[2]);
}

static void usd_put_head(FILE *file, const struct usd *usd)
{
    const double fps = usd->from.cache->fps, *time = usd->from.cache->time;
    fprintf(file,
            "#usda 1.0\n(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n"
            "    startTimeCode = %.9g\n    endTimeCode = %.9g\n    timeCodesPerSecond = %.9g\n"
            "    framesPerSecond = %.9g\n)\n\ndef Xform \"World\"\n{\n",
            time[usd->first] * fps, time[usd->last] * fps, fps, fps);
}

static void usd_put_mesh(FILE *file, const char *name)
{
    fprintf(file,
            "    def Mesh \"%s\"\n    {\n        uniform token subdivisionScheme = \"none\"\n"
            "        bool doubleSided = 1\n",
            name);
}

/* ---- Cloths ---- */

static void usd_put_faces(FILE *file, const struct mesh *mesh,
                          const struct view_export_cloth *cloth)
{
    uint32_t room[3];
    const uint32_t *corner;
    size_t at = 0;
    fputs("        int[] faceVertexCounts = [", file);
    for (uint32_t f = cloth->first_face; f < cloth->end_face; f++) {
        usd_put_break(file, f - cloth->first_face);
        fprintf(file, "%" PRIu32, mesh_face(mesh, f, room, &corner));
    }
    fputs("]\n        int[] faceVertexIndices = [", file);
    for (uint32_t f = cloth->first_face; f < cloth->end_face; f++) {
        const uint32_t n = mesh_face(mesh, f, room, &corner);
        for (uint32_t c = 0; c < n; c++) {
            usd_put_break(file, at++);
            fprintf(file, "%" PRIu32, corner[c] - cloth->first);
        }
    }
    fputs("]\n", file);
}

/* uv of corners, since a vertex has several where islands of uv meet. */
static void usd_put_uv(FILE *file, const struct mesh *mesh, const struct view_export_cloth *cloth)
{
    double uv[2];
    size_t at = 0;
    if (!mesh_uv(mesh, 0, uv))
        return;
    fputs("        texCoord2f[] primvars:st = [", file);
    for (uint32_t f = cloth->first_face; f < cloth->end_face; f++) {
        uint32_t room[3];
        const uint32_t *corner, n = mesh_face(mesh, f, room, &corner);
        const uint32_t *number = mesh->face_uv ? mesh->face_uv + mesh->face_start[f] : corner;
        for (uint32_t c = 0; c < n; c++) {
            mesh_uv(mesh, number[c], uv);
            usd_put_break(file, at++);
            fprintf(file, "(%.9g, %.9g)", uv[0], uv[1]);
        }
    }
    fputs("] (\n            interpolation = \"faceVarying\"\n        )\n", file);
}

static int usd_put_cloth(FILE *file, struct usd *usd, const struct view_export_cloth *cloth,
                         struct cloth_error *error)
{
    const struct output_cache *cache = usd->from.cache;
    int code = 0;
    usd_put_mesh(file, cloth->name);
    usd_put_faces(file, &cache->mesh, cloth);
    usd_put_uv(file, &cache->mesh, cloth);
    fputs("        point3f[] points.timeSamples = {\n", file);
    for (uint64_t k = usd->first; k <= usd->last && !code; k++) {
        code = view_export_at(&usd->from, k, error);
        fprintf(file, "            %.9g: [", cache->time[k] * cache->fps);
        for (uint32_t v = cloth->first; v < cloth->end && !code; v++)
            usd_put_point(file, v - cloth->first, usd->from.position + 3 * (size_t)v);
        fputs("],\n", file);
    }
    fputs("        }\n    }\n", file);
    return code;
}

static int usd_put_cloths(FILE *file, struct usd *usd, struct cloth_error *error)
{
    struct view_export_cloth cloth = {.n = 0};
    int code = 0;
    while (!code && view_export_next(usd->from.cache, &cloth))
        code = usd_put_cloth(file, usd, &cloth, error);
    return code;
}

/* ---- Obstacles ---- */

static void usd_put_obstacle_points(FILE *file, const struct view_obstacles *all)
{
    fputc('[', file);
    for (uint32_t v = 0; v < all->n_vertices; v++)
        usd_put_point(file, v, all->vertex[v]);
    fputc(']', file);
}

static int usd_put_obstacles(FILE *file, struct usd *usd, struct cloth_error *error)
{
    const struct output_cache *cache = usd->from.cache;
    const struct view_obstacles *all = usd->from.obstacles;
    const bool moves = view_export_moves(cache);
    const uint64_t last = moves ? usd->last : usd->first;
    int code = 0;
    if (!all->n_triangles)
        return 0;
    usd_put_mesh(file, "obstacles");
    fputs("        int[] faceVertexCounts = [", file);
    for (uint32_t t = 0; t < all->n_triangles; t++)
        usd_put_break(file, t), fputc('3', file);
    fputs("]\n        int[] faceVertexIndices = [", file);
    for (uint32_t t = 0; t < all->n_triangles; t++) {
        usd_put_break(file, t);
        fprintf(file, "%" PRIu32 ", %" PRIu32 ", %" PRIu32, all->triangle[t][0],
                all->triangle[t][1], all->triangle[t][2]);
    }
    fprintf(file, "]\n        point3f[] points%s", moves ? ".timeSamples = {\n" : " = ");
    for (uint64_t k = usd->first; k <= last && !code; k++) {
        code = view_export_at(&usd->from, k, error);
        if (moves)
            fprintf(file, "            %.9g: ", cache->time[k] * cache->fps);
        usd_put_obstacle_points(file, all);
        fputs(moves ? ",\n" : "\n", file);
    }
    fputs(moves ? "        }\n    }\n" : "    }\n", file);
    return code;
}

struct usd_writing {
    struct usd *usd;
    struct cloth_error *error;
};

static int usd_fill(FILE *file, const void *what)
{
    const struct usd_writing *of = what;
    usd_put_head(file, of->usd);
    int code = usd_put_cloths(file, of->usd, of->error);
    code = code ? code : usd_put_obstacles(file, of->usd, of->error);
    fputs("}\n", file);
    return code;
}

int view_export_usd(struct output_cache *cache, uint64_t first, uint64_t last, const char *path,
                    struct cloth_error *error)
{
    struct usd usd = {.first = first, .last = last};
    const struct usd_writing writing = {&usd, error};
    int code = view_export_open(&usd.from, cache, error);
    code = code ? code : output_replace_file(path, usd_fill, &writing, error);
    view_export_close(&usd.from);
    return code;
}
