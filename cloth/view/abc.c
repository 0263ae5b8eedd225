/* Samples of a cache of Alembic: faces and uv once, then what a frame moves, frame by frame. */
#include "cloth/view/abc.h"

#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/view/view.h"

#include <math.h>
#include <stdlib.h>

static int abc_take_room(struct abc *abc, size_t n, size_t size, struct cloth_error *error)
{
    if (n * size <= abc->room)
        return 0;
    free(abc->bytes);
    abc->bytes = cloth_alloc(n, size, error);
    abc->room = abc->bytes ? n * size : 0;
    return abc->bytes ? 0 : CLOTH_E_MEMORY;
}

static uint32_t abc_vertices(const struct abc_mesh *mesh)
{
    return mesh->part.end - mesh->part.first;
}

/* The corners of a face, or the numbers of their uv. */
static uint32_t abc_face(const struct abc *abc, const struct abc_mesh *mesh, uint32_t f, bool of_uv,
                         uint32_t room[3], const uint32_t **number)
{
    const struct mesh *all = &abc->from.cache->mesh;
    if (!mesh->is_cloth) {
        *number = abc->from.obstacles->triangle[f];
        return 3;
    }
    const uint32_t n = mesh_face(all, f, room, number);
    if (of_uv && all->face_uv)
        *number = all->face_uv + all->face_start[f];
    return n;
}

/* Numbers count from the part's first vertex; the further uv follow its vertices. */
static int abc_put_numbers(struct abc *abc, struct abc_mesh *mesh, bool of_uv, uint64_t *reference,
                           struct cloth_error *error)
{
    const uint32_t n_all = mesh->is_cloth ? abc->from.cache->mesh.n_vertices : UINT32_MAX;
    const uint32_t *number;
    uint32_t room[3];
    size_t n = 0, at = 0;
    for (uint32_t f = mesh->part.first_face; f < mesh->part.end_face; f++)
        n += abc_face(abc, mesh, f, of_uv, room, &number);
    if (abc_take_room(abc, n, 4, error))
        return CLOTH_E_MEMORY;
    for (uint32_t f = mesh->part.first_face; f < mesh->part.end_face; f++)
        for (uint32_t c = abc_face(abc, mesh, f, of_uv, room, &number); c-- > 0; at += 4)
            cloth_put_u32(abc->bytes + at, number[c] < n_all
                                               ? number[c] - mesh->part.first
                                               : number[c] - mesh->first_uv + abc_vertices(mesh));
    *reference = ogawa_put_sample(&abc->out, abc->bytes, 4 * n, mesh->sum);
    return 0;
}

static int abc_put_counts(struct abc *abc, struct abc_mesh *mesh, struct cloth_error *error)
{
    const uint32_t n = mesh->part.end_face - mesh->part.first_face, *corner;
    uint32_t room[3];
    if (abc_take_room(abc, n, 4, error))
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        cloth_put_u32(abc->bytes + 4 * (size_t)i,
                      abc_face(abc, mesh, mesh->part.first_face + i, false, room, &corner));
    mesh->counts = ogawa_put_sample(&abc->out, abc->bytes, 4 * (size_t)n, mesh->sum);
    return 0;
}

/* Finds the uv of the part among those that follow the vertices' own. */
static void abc_find_uv(const struct abc *abc, struct abc_mesh *mesh)
{
    const struct mesh *all = &abc->from.cache->mesh;
    uint32_t room[3], end = 0;
    const uint32_t *number;
    mesh->first_uv = UINT32_MAX;
    for (uint32_t f = mesh->part.first_face; f < mesh->part.end_face; f++)
        for (uint32_t c = abc_face(abc, mesh, f, true, room, &number); c-- > 0;)
            if (number[c] >= all->n_vertices) {
                mesh->first_uv = number[c] < mesh->first_uv ? number[c] : mesh->first_uv;
                end = number[c] >= end ? number[c] + 1 : end;
            }
    mesh->n_uv = end ? end - mesh->first_uv : 0;
}

static int abc_put_uv(struct abc *abc, struct abc_mesh *mesh, struct cloth_error *error)
{
    const uint32_t own = abc_vertices(mesh);
    double uv[2];
    abc_find_uv(abc, mesh);
    const size_t n = (size_t)own + mesh->n_uv;
    if (abc_take_room(abc, n, 8, error))
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++) {
        mesh_uv(&abc->from.cache->mesh,
                (uint32_t)i + (i < own ? mesh->part.first : mesh->first_uv - own), uv);
        cloth_put_float(abc->bytes + 8 * i, (float)uv[0]);
        cloth_put_float(abc->bytes + 8 * i + 4, (float)uv[1]);
    }
    mesh->uv = ogawa_put_sample(&abc->out, abc->bytes, 8 * n, mesh->sum);
    return abc_put_numbers(abc, mesh, true, &mesh->uv_numbers, error);
}

static int abc_put_points(struct abc *abc, struct abc_mesh *mesh, uint64_t at,
                          struct cloth_error *error)
{
    const double *x = mesh->is_cloth ? abc->from.position + 3 * (size_t)mesh->part.first
                                     : abc->from.obstacles->vertex[0];
    const size_t n = abc_vertices(mesh), stride = mesh->is_cloth ? 3 : 6;
    unsigned char bytes[8 * ABC_BOX];
    if (abc_take_room(abc, n, 12, error))
        return CLOTH_E_MEMORY;
    cloth_put_points(abc->bytes, n, x, stride);
    mesh->points[at] = ogawa_put_sample(&abc->out, abc->bytes, 12 * n, mesh->sum);
    for (size_t c = 0; c < 3; c++) {
        double least = INFINITY, most = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            least = fmin(least, (double)cloth_get_float(abc->bytes + 12 * i + 4 * c));
            most = fmax(most, (double)cloth_get_float(abc->bytes + 12 * i + 4 * c));
        }
        cloth_put_double(bytes + 8 * c, least);
        cloth_put_double(bytes + 8 * (c + 3), most);
    }
    mesh->boxes[at] = ogawa_put_sample(&abc->out, bytes, sizeof bytes, mesh->sum);
    return 0;
}

static int abc_put_samples(struct abc *abc, struct cloth_error *error)
{
    int code = 0;
    for (uint32_t m = 0; m < abc->n_meshes && !code; m++) {
        struct abc_mesh *mesh = abc->mesh + m;
        code = abc_put_counts(abc, mesh, error);
        code = code ? code : abc_put_numbers(abc, mesh, false, &mesh->corners, error);
        code = code || !mesh->has_uv ? code : abc_put_uv(abc, mesh, error);
    }
    for (uint64_t k = abc->first; k <= abc->last && !code; k++) {
        code = view_export_at(&abc->from, k, error);
        for (uint32_t m = 0; m < abc->n_meshes && !code; m++)
            if (abc->mesh[m].moves || k == abc->first)
                code = abc_put_points(abc, abc->mesh + m, k - abc->first, error);
    }
    return code;
}

/* ---- The file ---- */

static int abc_take_meshes(struct abc *abc, struct cloth_error *error)
{
    const struct output_cache *cache = abc->from.cache;
    const struct view_obstacles *obstacles = abc->from.obstacles;
    const uint32_t n_cloths = cache->apart.end ? cache->apart.n_cloths : 1;
    double uv[2];
    abc->n_meshes = n_cloths + (obstacles->n_triangles ? 1 : 0);
    abc->mesh = cloth_alloc(abc->n_meshes, sizeof *abc->mesh, error);
    abc->child = cloth_alloc(abc_frames(abc), 2 * sizeof *abc->child, error);
    if (!abc->mesh || !abc->child)
        return CLOTH_E_MEMORY;
    struct view_export_cloth cloth = {.n = 0};
    for (uint32_t m = 0; m < abc->n_meshes; m++) {
        struct abc_mesh *mesh = abc->mesh + m;
        mesh->is_cloth = view_export_next(cache, &cloth);
        mesh->part = mesh->is_cloth
                         ? cloth
                         : (struct view_export_cloth){.name = "obstacles",
                                                      .end = obstacles->n_vertices,
                                                      .end_face = obstacles->n_triangles};
        mesh->moves = mesh->is_cloth || view_export_moves(cache);
        mesh->has_uv = mesh->is_cloth && mesh_uv(&cache->mesh, 0, uv);
        mesh->points = cloth_alloc(mesh->moves ? abc_frames(abc) : 1, sizeof *mesh->points, error);
        mesh->boxes = cloth_alloc(mesh->moves ? abc_frames(abc) : 1, sizeof *mesh->boxes, error);
        if (!mesh->points || !mesh->boxes)
            return CLOTH_E_MEMORY;
    }
    return 0;
}

struct abc_writing {
    struct abc *abc;
    const char *path;
    struct cloth_error *error;
};

static int abc_fill(FILE *file, const void *what)
{
    const struct abc_writing *of = what;
    ogawa_begin(&of->abc->out, file);
    const int code = abc_put_samples(of->abc, of->error);
    return code ? code : abc_put_root(of->abc, of->path, of->error);
}

int view_export_abc(struct output_cache *cache, uint64_t first, uint64_t last, const char *path,
                    struct cloth_error *error)
{
    struct abc abc = {.first = first, .last = last};
    const struct abc_writing writing = {&abc, path, error};
    int code = view_export_open(&abc.from, cache, error);
    code = code ? code : abc_take_meshes(&abc, error);
    code = code ? code : output_replace_file(path, abc_fill, &writing, error);
    for (uint32_t m = 0; m < abc.n_meshes && abc.mesh; m++) {
        free(abc.mesh[m].points);
        free(abc.mesh[m].boxes);
    }
    free(abc.mesh);
    free(abc.bytes);
    free(abc.child);
    view_export_close(&abc.from);
    return code;
}
