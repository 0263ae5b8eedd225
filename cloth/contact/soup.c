/* The soup has no places: triangles and welds do not change with them. */
#include "cloth/contact/soup.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

static int count_surfaces(struct contact_soup *soup, const struct mesh *const *mesh,
                          const struct contact_shape *obstacles,
                          const struct contact_bodies *bodies, struct cloth_error *error)
{
    const uint32_t n = soup->n_cloths + soup->n_obstacles;
    uint64_t points = 0, triangles = 0;
    soup->surface = cloth_alloc(n + (size_t)1, sizeof *soup->surface, error);
    if (!soup->surface)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i <= n; i++) {
        const struct contact_body *body =
            i < soup->n_cloths || i == n
                ? NULL
                : contact_bodies_at(bodies, obstacles[i - soup->n_cloths].body);
        soup->surface[i] = (struct contact_surface){(uint32_t)points, (uint32_t)triangles};
        points += i < soup->n_cloths ? mesh[i]->n_vertices : body ? body->n_vertices : 0;
        triangles += i < soup->n_cloths ? mesh[i]->n_triangles : body ? body->n_triangles : 0;
    }
    if (points > UINT32_MAX || triangles > UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "cloths and bodies have more than %u vertices or triangles", UINT32_MAX);
    return CLOTH_OK;
}

static void soup_take_cloth(struct contact_soup *soup, uint32_t cloth, const struct mesh *mesh)
{
    const struct contact_surface first = soup->surface[cloth];
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t *corner = soup->corner[first.triangle + t];
        mesh_corners(mesh, t, corner);
        for (int k = 0; k < 3; k++) {
            corner[k] += first.point;
            soup->welded[first.triangle + t][k] = soup->same ? soup->same[corner[k]] : corner[k];
        }
    }
}

static void soup_take_body(struct contact_soup *soup, uint32_t surface,
                           const struct contact_body *body)
{
    const struct contact_surface first = soup->surface[surface];
    for (uint32_t t = 0; body && t < body->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            soup->welded[first.triangle + t][k] = soup->corner[first.triangle + t][k] =
                first.point + contact_body_facets(body)[t].corner[k];
}

int contact_soup_make(struct contact_soup *soup, uint32_t n_cloths, const struct mesh *const *mesh,
                      uint32_t *same, uint32_t n_obstacles, const struct contact_shape *obstacles,
                      const struct contact_bodies *bodies, struct cloth_error *error)
{
    *soup = (struct contact_soup){.n_cloths = n_cloths, .n_obstacles = n_obstacles, .same = same};
    const int code = count_surfaces(soup, mesh, obstacles, bodies, error);
    if (code)
        return code;
    const uint32_t n = contact_soup_all(soup).triangle;
    soup->corner = cloth_alloc(n, sizeof *soup->corner, error);
    soup->welded = cloth_alloc(n, sizeof *soup->welded, error);
    if (!soup->corner || !soup->welded)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < n_cloths; i++)
        soup_take_cloth(soup, i, mesh[i]);
    for (uint32_t i = 0; i < n_obstacles; i++)
        soup_take_body(soup, n_cloths + i, contact_bodies_at(bodies, obstacles[i].body));
    return CLOTH_OK;
}

void contact_soup_free(struct contact_soup *soup)
{
    free(soup->surface);
    free(soup->same);
    free(soup->corner);
    free(soup->welded);
    *soup = (struct contact_soup){0};
}
