/* Surfaces are made in the axes that the parameters are in, those of bodies for each time anew,
 * since bodies may change their shapes; a time moves them. Planes have no surface of their own:
 * they are drawn as ground. */
#include "cloth/contact/surface.h"
#include "cloth/view/view.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Counts vertices and triangles of obstacle i's surface; 0: it is a plane. */
static void count_surface(const struct view_obstacles *obstacles, size_t i, uint32_t *n_vertices,
                          uint32_t *n_triangles)
{
    const struct contact_shape *shape = obstacles->shape + i;
    contact_surface_count(shape, contact_bodies_at(obstacles->bodies, shape->body), n_vertices,
                          n_triangles);
}

static int view_obstacles_take_room(struct view_obstacles *obstacles, struct cloth_error *error)
{
    uint64_t n_vertices = 0, n_triangles = 0;
    for (size_t i = 0; i < obstacles->n; i++) {
        uint32_t vertices, triangles;
        count_surface(obstacles, i, &vertices, &triangles);
        n_vertices += vertices;
        n_triangles += triangles;
    }
    obstacles->plane = calloc(obstacles->n + 1, sizeof *obstacles->plane);
    obstacles->own = calloc(n_vertices + 1, sizeof *obstacles->own);
    obstacles->vertex = calloc(n_vertices + 1, sizeof *obstacles->vertex);
    obstacles->triangle = calloc(n_triangles + 1, sizeof *obstacles->triangle);
    if (n_vertices > UINT32_MAX || !obstacles->plane || !obstacles->own || !obstacles->vertex ||
        !obstacles->triangle)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to show %zu obstacles", obstacles->n);
    obstacles->n_vertices = (uint32_t)n_vertices;
    obstacles->n_triangles = (uint32_t)n_triangles;
    return 0;
}

/* Makes the surfaces of all obstacles, or of bodies alone. */
static void make_surfaces(struct view_obstacles *obstacles, bool bodies_alone)
{
    uint32_t first = 0, vertices, triangles;
    uint32_t(*triangle)[3] = obstacles->triangle;
    for (size_t i = 0; i < obstacles->n; i++, first += vertices, triangle += triangles) {
        const struct contact_shape *shape = obstacles->shape + i;
        count_surface(obstacles, i, &vertices, &triangles);
        if (!vertices || (bodies_alone && !shape->body))
            continue;
        contact_surface(shape, contact_bodies_at(obstacles->bodies, shape->body),
                        obstacles->own + first, triangle);
        for (uint32_t t = 0; t < triangles; t++)
            for (int k = 0; k < 3; k++)
                triangle[t][k] += first;
    }
}

int view_obstacles_make(struct view_obstacles *obstacles, size_t n,
                        const struct contact_shape *shape, const struct phys_key *keys,
                        const struct contact_bodies *bodies, struct cloth_error *error)
{
    *obstacles = (struct view_obstacles){.n = n, .shape = shape, .keys = keys, .bodies = bodies};
    if (view_obstacles_take_room(obstacles, error))
        return CLOTH_E_MEMORY;
    make_surfaces(obstacles, false);
    view_obstacles_at(obstacles, 0);
    return 0;
}

/* A point and a direction, moved. */
static void view_obstacles_move(const struct contact_pose *pose, const double from[6], double to[6])
{
    phys_vec x = {from[0], from[1], from[2], 0}, normal = {from[3], from[4], from[5], 0};
    if (pose->moves) {
        phys_pose_point(&pose->to, &x, &x);
        phys_pose_direction(&pose->to, &normal, &normal);
    }
    for (int k = 0; k < 3; k++) {
        to[k] = x[k];
        to[3 + k] = normal[k];
    }
}

void view_obstacles_at(struct view_obstacles *obstacles, double time)
{
    size_t at = 0;
    obstacles->n_planes = 0;
    make_surfaces(obstacles, true);
    for (size_t i = 0; i < obstacles->n; i++) {
        const struct contact_shape *shape = obstacles->shape + i;
        struct contact_pose pose;
        uint32_t vertices, triangles;
        contact_pose_over(shape, obstacles->keys, obstacles->bodies, time, time, &pose);
        count_surface(obstacles, i, &vertices, &triangles);
        if (!vertices)
            view_obstacles_move(&pose, shape->value, obstacles->plane[obstacles->n_planes++]);
        for (uint32_t v = 0; v < vertices; v++, at++)
            view_obstacles_move(&pose, obstacles->own[at], obstacles->vertex[at]);
    }
}

void view_obstacles_free(struct view_obstacles *obstacles)
{
    free(obstacles->plane);
    free(obstacles->own);
    free(obstacles->vertex);
    free(obstacles->triangle);
    memset(obstacles, 0, sizeof *obstacles);
}
