/* A mesh is looked through, without an index: a click may take milliseconds. */
#include "cloth/view/pick.h"

#include <inttypes.h>
#include <math.h>

static const double REACH = 12; /* pixels: a fingertip's, at the usual distance of a screen */

/* Where somebody points at, and how. */
struct pointing {
    const struct view_camera *camera;
    double half[2], at[2]; /* of the window; pixels from its middle, y up */
};

/* A point as it is seen: pixels from the place that is pointed at, and 1 / m of the eye, <= 0
 * behind it. */
static void pick_see(const struct pointing *pointing, const double p[3], double seen[3])
{
    double clip[4];
    for (int i = 0; i < 4; i++) {
        clip[i] = (double)pointing->camera->clip[3][i];
        for (int k = 0; k < 3; k++)
            clip[i] += (double)pointing->camera->clip[k][i] * p[k];
    }
    for (int i = 0; i < 2; i++)
        seen[i] = pointing->half[i] * clip[i] / clip[3] - pointing->at[i];
    seen[2] = 1 / clip[3];
}

/* 1 / m of the eye where the triangle is pointed at; 0: it is not. Over a picture 1 / distance is
 * linear on a triangle. *corner: the nearest one. */
static double pick_triangle(const struct pointing *pointing, const double *position,
                            const uint32_t of[3], uint32_t *corner)
{
    double seen[3][3], area[3], all = 0, least = INFINITY, near = 0;
    for (int i = 0; i < 3; i++) {
        pick_see(pointing, position + 3 * (size_t)of[i], seen[i]);
        if (!(seen[i][2] > 0))
            return 0;
    }
    for (int i = 0; i < 3; i++) {
        const double *a = seen[(i + 1) % 3], *b = seen[(i + 2) % 3];
        area[i] = a[0] * b[1] - a[1] * b[0];
        all += area[i];
    }
    for (int i = 0; i < 3; i++) {
        const double away = hypot(seen[i][0], seen[i][1]);
        if (!(area[i] / all >= 0)) /* outside, or seen from its edge */
            return 0;
        near += area[i] / all * seen[i][2];
        if (away < least) {
            least = away;
            *corner = of[i];
        }
    }
    return near;
}

static uint32_t pick_lone(const struct pointing *pointing, const struct mesh *mesh,
                          const double *position)
{
    uint32_t picked = VIEW_PICKED_NONE;
    double seen[3], least = REACH;
    for (size_t i = 0; i < 2 * (size_t)mesh->n_lone_edges; i++) {
        pick_see(pointing, position + 3 * (size_t)mesh->lone_edge[i], seen);
        const double away = hypot(seen[0], seen[1]);
        if (seen[2] > 0 && away < least) {
            least = away;
            picked = mesh->lone_edge[i];
        }
    }
    return picked;
}

uint32_t view_pick(const struct view_camera *camera, int width, int height, const struct mesh *mesh,
                   const double *position, double x, double y)
{
    const struct pointing pointing = {
        camera, {0.5 * width, 0.5 * height}, {x - 0.5 * width, 0.5 * height - y}};
    uint32_t picked = VIEW_PICKED_NONE, corner = 0, of[3];
    double nearest = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        mesh_corners(mesh, t, of);
        const double near = pick_triangle(&pointing, position, of, &corner);
        if (near > nearest) {
            nearest = near;
            picked = corner;
        }
    }
    return picked == VIEW_PICKED_NONE ? pick_lone(&pointing, mesh, position) : picked;
}

/* A face of the mesh with the vertex; n_faces: none has it. */
static uint32_t face_with(const struct mesh *mesh, uint32_t vertex)
{
    uint32_t f = 0;
    for (; f < mesh->n_faces; f++) {
        uint32_t room[3];
        const uint32_t *corner, n = mesh_face(mesh, f, room, &corner);
        for (uint32_t c = 0; c < n; c++)
            if (corner[c] == vertex)
                return f;
    }
    return f;
}

/* The cloth's group has the most faces of those that have a face, and the panel's the least. */
struct view_picked view_picked_of(const struct mesh *mesh, uint32_t n_cloths, const uint32_t *end,
                                  uint32_t vertex)
{
    struct view_picked picked = {.vertex = vertex};
    const uint32_t f = face_with(mesh, vertex);
    uint32_t most = 0, least = UINT32_MAX;
    for (uint32_t c = 0; c + 1 < n_cloths && vertex >= end[c]; c++)
        picked.vertex = vertex - end[c];
    for (uint32_t i = 0; i < mesh->n_group_runs; i++) {
        const struct mesh_group_run *run = mesh->group_run + i;
        if (f < run->first || f >= run->first + run->n)
            continue;
        if (run->n > most)
            picked.cloth = mesh->group[run->group];
        if (run->n < least)
            picked.panel = mesh->group[run->group];
        most = run->n > most ? run->n : most;
        least = run->n < least ? run->n : least;
    }
    if (most == least) /* the only one */
        picked.panel = NULL;
    return picked;
}

void view_picked_probe(const struct view_picked *picked, size_t size, char line[size])
{
    if (picked->cloth)
        snprintf(line, size, "- {name: vertex%" PRIu32 ", cloth: %.60s, vertices: [%" PRIu32 "]}",
                 picked->vertex, picked->cloth, picked->vertex);
    else
        snprintf(line, size, "- {name: vertex%" PRIu32 ", vertices: [%" PRIu32 "]}", picked->vertex,
                 picked->vertex);
}
