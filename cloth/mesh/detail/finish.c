/* A mesh that leaves here keeps every promise of mesh.h: corners exist and differ, triangles are
 * the faces cut in order, no edge has a third triangle, no lone edge stands twice. */
#include "cloth/mesh/detail/finish.h"

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/polygon.h"
#include "cloth/mesh/detail/sides.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct place {
    char text[700];
};

const char *mesh_path_shown(const char *path)
{
    size_t length = strlen(path), max = 600;
    return length > max ? path + (length - max) : path;
}

static struct place detail_finish_place_of(const struct mesh_source *source, const char *array,
                                           const size_t *lines, size_t index)
{
    struct place place;
    if (source->path)
        snprintf(place.text, sizeof place.text, "%s:%zu", mesh_path_shown(source->path),
                 lines[index]);
    else
        snprintf(place.text, sizeof place.text, "%s[%zu]", array, index);
    return place;
}

static struct place face_place(const struct mesh_source *source, size_t face)
{
    return detail_finish_place_of(source, "triangles", source->face_line, face);
}

/* Files count vertices from 1. */
static uint32_t shown(const struct mesh_source *source, uint32_t vertex)
{
    return vertex + (source->path ? 1 : 0);
}

static int no_such_vertex(const struct mesh *mesh, const struct mesh_source *source,
                          struct place place, uint32_t vertex, struct cloth_error *error)
{
    uint32_t first = shown(source, 0);
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: there is no vertex %u; the mesh has the vertices %u to %u", place.text,
                      shown(source, vertex), first, first + mesh->n_vertices - 1);
}

/* last_face: n_vertices, zeroed: the number + 1 of the last face that used a vertex. */
static int check_faces(const struct mesh *mesh, const struct mesh_source *source,
                       uint32_t *last_face, struct cloth_error *error)
{
    for (uint32_t f = 0; f < mesh->n_faces; f++) {
        for (uint32_t c = mesh->face_start[f]; c < mesh->face_start[f + 1]; c++) {
            uint32_t vertex = mesh->face_corner[c];
            if (vertex >= mesh->n_vertices)
                return no_such_vertex(mesh, source, face_place(source, f), vertex, error);
            if (last_face[vertex] == f + 1)
                return cloth_fail(error, CLOTH_E_INPUT,
                                  "%s: the face has vertex %u at two corners; corners must differ",
                                  face_place(source, f).text, shown(source, vertex));
            last_face[vertex] = f + 1;
        }
    }
    return CLOTH_OK;
}

static int detail_finish_check_edges(const struct mesh *mesh, const struct mesh_source *source,
                                     struct cloth_error *error)
{
    for (size_t i = 0; i < 2 * (size_t)mesh->n_lone_edges; i++) {
        uint32_t vertex = mesh->lone_edge[i];
        struct place place;
        if (vertex < mesh->n_vertices && (i % 2 == 0 || vertex != mesh->lone_edge[i - 1]))
            continue;
        place = detail_finish_place_of(source, "edges", source->edge_line, i / 2);
        if (vertex >= mesh->n_vertices)
            return no_such_vertex(mesh, source, place, vertex, error);
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: the edge joins vertex %u to itself; its ends must differ",
                          place.text, shown(source, vertex));
    }
    return CLOTH_OK;
}

static int refuse_polygon(const struct mesh *mesh, const struct mesh_source *source, uint32_t f,
                          const struct mesh_polygon_fault *fault, struct cloth_error *error)
{
    const uint32_t *corner = mesh->face_corner + mesh->face_start[f];
    const uint32_t n = mesh->face_start[f + 1] - mesh->face_start[f];
    const struct place place = face_place(source, f);
    if (fault->kind == MESH_POLYGON_TOO_LARGE)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: the face is not convex and has %u corners; at most %d can be cut "
                          "into triangles",
                          place.text, n, MESH_MAX_CORNERS);
    if (fault->kind == MESH_POLYGON_NO_AREA)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: the face has no area: its corners lie on a line, or it crosses "
                          "itself",
                          place.text);
    const uint32_t *side = fault->side;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: the face crosses or touches itself where its sides between vertices %u "
                      "and %u and between %u and %u meet; cut it into faces that do not",
                      place.text, shown(source, corner[side[0]]),
                      shown(source, corner[(side[0] + 1) % n]), shown(source, corner[side[1]]),
                      shown(source, corner[(side[1] + 1) % n]));
}

static int cut_faces(struct mesh *mesh, const struct mesh_source *source, struct cloth_error *error)
{
    size_t n = mesh->n_faces ? mesh->face_start[mesh->n_faces] - 2 * (size_t)mesh->n_faces : 0;
    mesh->triangle = cloth_alloc(3 * n, sizeof *mesh->triangle, error);
    if (!mesh->triangle)
        return CLOTH_E_MEMORY;
    uint32_t *to = mesh->triangle;
    for (uint32_t f = 0; f < mesh->n_faces; f++) {
        const uint32_t *corner = mesh->face_corner + mesh->face_start[f];
        const uint32_t n_corners = mesh->face_start[f + 1] - mesh->face_start[f];
        struct mesh_polygon_fault fault;
        int code = mesh_polygon_cut(mesh->position, n_corners, corner, to, &fault, error);
        if (code == CLOTH_E_INPUT && source->fans && fault.kind == MESH_POLYGON_CROSSES) {
            mesh_polygon_fan(n_corners, corner, to);
            code = CLOTH_OK;
        }
        if (code == CLOTH_E_INPUT)
            return refuse_polygon(mesh, source, f, &fault, error);
        if (code)
            return code;
        to += 3 * (size_t)(n_corners - 2);
    }
    mesh->n_triangles = (uint32_t)n;
    return CLOTH_OK;
}

static uint32_t face_of(const struct mesh *mesh, uint32_t triangle)
{
    uint32_t face = 0, before = 0;
    for (; face < mesh->n_faces; face++) {
        before += mesh->face_start[face + 1] - mesh->face_start[face] - 2;
        if (triangle < before)
            break;
    }
    return face;
}

/* An edge that stands twice would be one. That a triangle has it, too, is allowed. */
static int check_twice(const struct mesh *mesh, const struct mesh_source *source,
                       const struct mesh_sides *sides, struct cloth_error *error)
{
    const uint32_t first = 3 * mesh->n_triangles;
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
    return cloth_fail(
        error, CLOTH_E_INPUT,
        "%s: the edge between vertices %u and %u stands here again, after %s %zu; give it once",
        detail_finish_place_of(source, "edges", source->edge_line, twice - first).text,
        shown(source, pair[0]), shown(source, pair[1]), source->path ? "line" : "entry",
        source->path ? source->edge_line[at] : at);
}

/* Of the lone edges those that no triangle has come first, else as they were. Uses up the sides. */
static int put_bare_first(struct mesh *mesh, struct mesh_sides *sides, struct cloth_error *error)
{
    const uint32_t first = 3 * mesh->n_triangles, n = mesh->n_lone_edges;
    uint32_t *sorted = cloth_alloc(n, 2 * sizeof *sorted, error), *next = sorted;
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

static int check_manifold(struct mesh *mesh, const struct mesh_source *source,
                          struct cloth_error *error)
{
    struct mesh_sides sides;
    uint32_t third;
    int code = mesh_sides_sort(&sides, mesh, error);
    if (!code)
        code = check_twice(mesh, source, &sides, error);
    if (!code && mesh_sides_third(&sides, mesh->n_triangles, &third)) {
        const uint32_t *pair = sides.pair + 2 * (size_t)third;
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "%s: this face is the third at the edge between vertices %u and %u "
                          "(non-manifold); an edge may have at most two triangles",
                          face_place(source, face_of(mesh, third / 3)).text, shown(source, pair[0]),
                          shown(source, pair[1]));
    }
    if (!code)
        code = put_bare_first(mesh, &sides, error);
    mesh_sides_free(&sides);
    return code;
}

int mesh_finish(struct mesh *mesh, const struct mesh_source *source, struct cloth_error *error)
{
    uint32_t *last_face = cloth_alloc(mesh->n_vertices, sizeof *last_face, error);
    int code = last_face ? check_faces(mesh, source, last_face, error) : CLOTH_E_MEMORY;
    free(last_face);
    if (!code)
        code = detail_finish_check_edges(mesh, source, error);
    if (!code)
        code = cut_faces(mesh, source, error);
    return code ? code : check_manifold(mesh, source, error);
}
