/* Surfaces are made once, in the axes that the parameters are in; a time moves them. Planes have no
 * surface of their own: they are drawn as ground. */
#include "cloth/contact/surface.h"
#include "cloth/view/view.h"

#include <stdlib.h>
#include <string.h>

static size_t count_bounded(size_t n, const struct contact_shape *shape)
{
    size_t bounded = 0;
    for (size_t i = 0; i < n; i++)
        bounded += contact_kinds[shape[i].kind]->around != NULL;
    return bounded;
}

int view_obstacles_make(struct view_obstacles *obstacles, size_t n,
                        const struct contact_shape *shape, const struct phys_key *keys,
                        struct cloth_error *error)
{
    const size_t bounded = count_bounded(n, shape);
    *obstacles = (struct view_obstacles){.n = n, .shape = shape, .keys = keys};
    obstacles->plane = calloc(n - bounded + 1, sizeof *obstacles->plane);
    obstacles->own = calloc(bounded * CONTACT_SURFACE_VERTICES + 1, sizeof *obstacles->own);
    obstacles->vertex = calloc(bounded * CONTACT_SURFACE_VERTICES + 1, sizeof *obstacles->vertex);
    obstacles->triangle =
        calloc(bounded * CONTACT_SURFACE_TRIANGLES + 1, sizeof *obstacles->triangle);
    if (!obstacles->plane || !obstacles->own || !obstacles->vertex || !obstacles->triangle)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to show %zu obstacles", n);
    obstacles->n_vertices = (uint32_t)(bounded * CONTACT_SURFACE_VERTICES);
    obstacles->n_triangles = (uint32_t)(bounded * CONTACT_SURFACE_TRIANGLES);
    size_t at = 0;
    for (size_t i = 0; i < n; i++) {
        if (!contact_kinds[shape[i].kind]->around)
            continue;
        uint32_t(*triangle)[3] = obstacles->triangle + at * CONTACT_SURFACE_TRIANGLES;
        contact_surface(shape + i, obstacles->own + at * CONTACT_SURFACE_VERTICES, triangle);
        for (size_t t = 0; t < CONTACT_SURFACE_TRIANGLES; t++)
            for (int k = 0; k < 3; k++)
                triangle[t][k] += (uint32_t)(at * CONTACT_SURFACE_VERTICES);
        at++;
    }
    view_obstacles_at(obstacles, 0);
    return 0;
}

/* A point and a direction, moved. */
static void move(const struct contact_pose *pose, const double from[6], double to[6])
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
    for (size_t i = 0; i < obstacles->n; i++) {
        const struct contact_shape *shape = obstacles->shape + i;
        struct contact_pose pose;
        contact_pose_over(shape, obstacles->keys, time, time, &pose);
        if (!contact_kinds[shape->kind]->around) {
            move(&pose, shape->value, obstacles->plane[obstacles->n_planes++]);
            continue;
        }
        for (size_t v = 0; v < CONTACT_SURFACE_VERTICES; v++, at++)
            move(&pose, obstacles->own[at], obstacles->vertex[at]);
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
