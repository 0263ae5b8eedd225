/* A mesh that leaves here keeps every promise of mesh.h: corners exist and differ, triangles are
 * the faces cut in order, no edge has a third triangle, no lone edge stands twice. */
#include "cloth/mesh/detail/finish.h"

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/sides.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct finish {
    struct mesh *mesh;
    const struct mesh_source *source;
    struct cloth_error *error;
};

enum finish_item { FINISH_FACE, FINISH_EDGE };

const char *mesh_path_shown(const char *path)
{
    size_t length = strlen(path), max = 600;
    return length > max ? path + (length - max) : path;
}

/* Fails with a sentence about a face or a lone edge, behind where it stands. */
__attribute__((format(printf, 4, 5))) static int
refuse(const struct finish *of, enum finish_item item, size_t index, const char *format, ...)
{
    const struct mesh_source *source = of->source;
    char text[256];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (!source->path)
        return cloth_fail(of->error, CLOTH_E_INPUT, "%s[%zu]: %s",
                          item == FINISH_EDGE ? "edges" : "triangles", index, text);
    if (item == FINISH_FACE && !source->face_line)
        return cloth_fail(of->error, CLOTH_E_INPUT, "%s: face %zu: %s",
                          mesh_path_shown(source->path), index + 1, text);
    return cloth_fail(of->error, CLOTH_E_INPUT, "%s:%zu: %s", mesh_path_shown(source->path),
                      (item == FINISH_EDGE ? source->edge_line : source->face_line)[index], text);
}

/* Files count vertices from 1. */
static uint32_t shown(const struct finish *of, uint32_t vertex)
{
    return vertex + (of->source->path ? 1 : 0);
}

static int check_vertex(const struct finish *of, enum finish_item item, size_t index,
                        uint32_t vertex)
{
    const uint32_t first = shown(of, 0);
    return vertex < of->mesh->n_vertices
               ? CLOTH_OK
               : refuse(of, item, index,
                        "there is no vertex %u; the mesh has the vertices %u to %u",
                        shown(of, vertex), first, first + of->mesh->n_vertices - 1);
}

/* last_face: n_vertices, zeroed: the number + 1 of the last face that used a vertex. */
static int check_faces(const struct finish *of, uint32_t *last_face)
{
    const struct mesh *mesh = of->mesh;
    for (uint32_t f = 0; f < mesh->n_faces; f++) {
        for (uint32_t c = mesh->face_start[f]; c < mesh->face_start[f + 1]; c++) {
            const uint32_t vertex = mesh->face_corner[c];
            const int code = check_vertex(of, FINISH_FACE, f, vertex);
            if (code)
                return code;
            if (last_face[vertex] == f + 1)
                return refuse(of, FINISH_FACE, f,
                              "the face has vertex %u at two corners; corners must differ",
                              shown(of, vertex));
            last_face[vertex] = f + 1;
        }
    }
    return CLOTH_OK;
}

static int check_lone_edges(const struct finish *of)
{
    for (size_t e = 0; e < of->mesh->n_lone_edges; e++) {
        const uint32_t *end = of->mesh->lone_edge + 2 * e;
        int code = check_vertex(of, FINISH_EDGE, e, end[0]);
        code = code ? code : check_vertex(of, FINISH_EDGE, e, end[1]);
        if (!code && end[0] == end[1])
            code = refuse(of, FINISH_EDGE, e,
                          "the edge joins vertex %u to itself; its ends must differ",
                          shown(of, end[0]));
        if (code)
            return code;
    }
    return CLOTH_OK;
}

static int refuse_polygon(const struct finish *of, uint32_t f, enum mesh_polygon why,
                          const uint32_t side[2])
{
    const uint32_t *corner = of->mesh->face_corner + of->mesh->face_start[f];
    const uint32_t n = of->mesh->face_start[f + 1] - of->mesh->face_start[f];
    if (why == MESH_POLYGON_NO_MEMORY)
        return CLOTH_E_MEMORY;
    if (why == MESH_POLYGON_TOO_LARGE)
        return refuse(of, FINISH_FACE, f,
                      "the face is not convex and has %u corners; at most %d can be cut into "
                      "triangles",
                      n, MESH_MAX_CORNERS);
    if (why == MESH_POLYGON_NO_AREA)
        return refuse(of, FINISH_FACE, f,
                      "the face has no area: its corners lie on a line, or it crosses itself");
    return refuse(of, FINISH_FACE, f,
                  "the face crosses or touches itself where its sides between vertices %u and %u "
                  "and between %u and %u meet; cut it into faces that do not",
                  shown(of, corner[side[0]]), shown(of, corner[(side[0] + 1) % n]),
                  shown(of, corner[side[1]]), shown(of, corner[(side[1] + 1) % n]));
}

static int cut_faces(const struct finish *of)
{
    struct mesh *mesh = of->mesh;
    size_t n = mesh->n_faces ? mesh->face_start[mesh->n_faces] - 2 * (size_t)mesh->n_faces : 0;
    uint32_t *to = mesh->triangle = cloth_alloc(3 * n, sizeof *mesh->triangle, of->error);
    if (!to)
        return CLOTH_E_MEMORY;
    for (uint32_t f = 0; f < mesh->n_faces; f++) {
        const uint32_t *corner = mesh->face_corner + mesh->face_start[f];
        const uint32_t n_corners = mesh->face_start[f + 1] - mesh->face_start[f];
        uint32_t side[2];
        const enum mesh_polygon cut =
            mesh_polygon_cut(mesh->position, n_corners, corner, to, side, of->error);
        if (cut == MESH_POLYGON_CROSSES && of->source->fans)
            mesh_polygon_fan(n_corners, corner, to);
        else if (cut != MESH_POLYGON_CUT)
            return refuse_polygon(of, f, cut, side);
        to += 3 * (size_t)(n_corners - 2);
    }
    mesh->n_triangles = (uint32_t)n;
    return CLOTH_OK;
}

static uint32_t face_of(const struct mesh *mesh, uint32_t triangle)
{
    uint32_t face = 0; /* each has two corners more than triangles */
    while (triangle >= mesh->face_start[face + 1] - 2 * (face + 1))
        face++;
    return face;
}

/* An edge that stands twice would be one. That a triangle has it, too, is allowed. */
static int check_twice(const struct finish *of, const struct mesh_sides *sides)
{
    const uint32_t first = 3 * of->mesh->n_triangles;
    uint32_t before = 0, twice = UINT32_MAX;
    for (uint32_t i = 0, end; i < sides->n; i = end) {
        end = mesh_sides_run(sides, i);
        for (uint32_t k = i + 1; k < end; k++)
            if (sides->order[k - 1] >= first && sides->order[k] < twice) {
                before = sides->order[k - 1];
                twice = sides->order[k];
            }
    }
    if (twice == UINT32_MAX)
        return CLOTH_OK;
    const uint32_t *pair = sides->pair + 2 * (size_t)twice;
    const size_t at = before - first;
    return refuse(of, FINISH_EDGE, twice - first,
                  "the edge between vertices %u and %u stands here again, after %s %zu; give it "
                  "once",
                  shown(of, pair[0]), shown(of, pair[1]), of->source->path ? "line" : "entry",
                  of->source->path ? of->source->edge_line[at] : at);
}

/* Puts lone edges that no triangle has first; else their order stays. Uses up the sides. */
static int put_bare_first(const struct finish *of, struct mesh_sides *sides)
{
    struct mesh *mesh = of->mesh;
    const uint32_t first = 3 * mesh->n_triangles, n = mesh->n_lone_edges;
    uint32_t *sorted = cloth_alloc(n, 2 * sizeof *sorted, of->error), *next = sorted;
    if (!sorted)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0, end; i < sides->n; i = end) { /* a run's sides of triangles come first */
        end = mesh_sides_run(sides, i);
        for (uint32_t k = i + 1; k < end && sides->order[i] < first; k++)
            sides->pair[2 * (size_t)sides->order[k]] = UINT32_MAX;
    }
    for (int bare = 1; bare >= 0; bare--) {
        for (uint32_t e = 0; e < n; e++)
            if ((sides->pair[2 * (size_t)(first + e)] != UINT32_MAX) == bare) {
                *next++ = mesh->lone_edge[2 * (size_t)e];
                *next++ = mesh->lone_edge[2 * (size_t)e + 1];
            }
        if (bare)
            mesh->n_bare_edges = (uint32_t)((next - sorted) / 2);
    }
    free(mesh->lone_edge);
    mesh->lone_edge = sorted;
    return CLOTH_OK;
}

static int check_manifold(const struct finish *of)
{
    struct mesh_sides sides;
    uint32_t third;
    int code = mesh_sides_sort(&sides, of->mesh, of->error);
    code = code ? code : check_twice(of, &sides);
    if (!code && mesh_sides_third(&sides, of->mesh->n_triangles, &third)) {
        const uint32_t *pair = sides.pair + 2 * (size_t)third;
        code = refuse(of, FINISH_FACE, face_of(of->mesh, third / 3),
                      "this face is the third at the edge between vertices %u and %u "
                      "(non-manifold); an edge may have at most two triangles",
                      shown(of, pair[0]), shown(of, pair[1]));
    }
    code = code ? code : put_bare_first(of, &sides);
    mesh_sides_free(&sides);
    return code;
}

int mesh_finish(struct mesh *mesh, const struct mesh_source *source, struct cloth_error *error)
{
    const struct finish finish = {mesh, source, error};
    uint32_t *last_face = cloth_alloc(mesh->n_vertices, sizeof *last_face, error);
    int code = last_face ? check_faces(&finish, last_face) : CLOTH_E_MEMORY;
    free(last_face);
    code = code ? code : check_lone_edges(&finish);
    code = code ? code : cut_faces(&finish);
    return code ? code : check_manifold(&finish);
}

/* ---- Meshes of a caller's arrays, which are copied ---- */

static int check_input(uint32_t n_vertices, const double *vertices, uint32_t n_edges,
                       uint32_t n_triangles, struct cloth_error *error)
{
    if (n_vertices == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "the mesh has no vertices; it needs at least one");
    if (n_vertices > MESH_MAX || n_triangles > MESH_MAX / 3 || n_edges > MESH_MAX / 2)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "the mesh is too large: at most %u vertices, %u triangles and %u edges",
                          MESH_MAX, MESH_MAX / 3, MESH_MAX / 2);
    for (size_t i = 0; i < 3 * (size_t)n_vertices; i++)
        if (!isfinite(vertices[i]))
            return cloth_fail(error, CLOTH_E_INPUT, "vertices[%zu]: %g is not a finite number",
                              i / 3, vertices[i]);
    return CLOTH_OK;
}

static void *copy_array(const void *from, size_t n, size_t size, struct cloth_error *error)
{
    void *to = cloth_alloc(n, size, error);
    if (to && n)
        memcpy(to, from, n * size);
    return to;
}

int mesh_inline(struct mesh *mesh, uint32_t n_vertices, const double *vertices, uint32_t n_edges,
                const uint32_t *edges, uint32_t n_triangles, const uint32_t *triangles,
                struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    int code = check_input(n_vertices, vertices, n_edges, n_triangles, error);
    if (code)
        return code;
    mesh->n_vertices = n_vertices;
    mesh->n_lone_edges = n_edges;
    mesh->n_faces = n_triangles;
    mesh->position = copy_array(vertices, n_vertices, 3 * sizeof *vertices, error);
    mesh->lone_edge = copy_array(edges, n_edges, 2 * sizeof *edges, error);
    mesh->face_corner = copy_array(triangles, n_triangles, 3 * sizeof *triangles, error);
    mesh->face_start = cloth_alloc((size_t)n_triangles + 1, sizeof *mesh->face_start, error);
    if (!mesh->position || !mesh->lone_edge || !mesh->face_corner || !mesh->face_start) {
        mesh_free(mesh);
        return CLOTH_E_MEMORY;
    }
    for (uint32_t f = 0; f <= n_triangles; f++)
        mesh->face_start[f] = 3 * f;
    code = mesh_finish(mesh, &(struct mesh_source){0}, error);
    if (code)
        mesh_free(mesh);
    return code;
}
