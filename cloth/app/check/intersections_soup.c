/* The soup is complete before the first frame, except the places of vertices: triangles and joins
 * do not change. */
#include "cloth/app/check/intersections_soup.h"

#include "cloth/app/check/intersections_parts.h"
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static int count_points(struct intersections *all, const struct intersections_setup *setup,
                        struct cloth_error *error)
{
    uint64_t points = 0, triangles = 0;
    for (size_t i = 0; i <= setup->n_meshes; i++) {
        all->cloth[i].point = (uint32_t)points;
        all->cloth[i].triangle = (uint32_t)triangles;
        points += i < setup->n_meshes ? setup->meshes[i]->n_vertices : 0;
        triangles += i < setup->n_meshes ? setup->meshes[i]->n_triangles : 0;
    }
    all->soup.n_first = (uint32_t)triangles;
    for (size_t i = 0; i <= setup->n_obstacles; i++) {
        const struct contact_body *body =
            i < setup->n_obstacles ? contact_bodies_at(setup->bodies, setup->obstacles[i].body)
                                   : NULL;
        all->obstacle[i].point = (uint32_t)points;
        all->obstacle[i].triangle = (uint32_t)triangles;
        points += body ? body->n_vertices : 0;
        triangles += body ? body->n_triangles : 0;
    }
    if (points > UINT32_MAX || triangles > UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--check-intersections: cloths and bodies have more than %" PRIu32
                          " vertices or triangles",
                          UINT32_MAX);
    all->soup.n_points = (uint32_t)points;
    all->soup.n_triangles = (uint32_t)triangles;
    return CLOTH_OK;
}

static void take_cloth(struct intersections *all, const struct intersections_setup *setup, size_t i)
{
    const struct mesh *mesh = setup->meshes[i];
    const struct surface *cloth = all->cloth + i;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t *corner = all->corner[cloth->triangle + t];
        mesh_corners(mesh, t, corner);
        for (int c = 0; c < 3; c++) {
            corner[c] += cloth->point;
            all->joined[cloth->triangle + t][c] = setup->same ? setup->same[corner[c]] : corner[c];
        }
    }
}

static int take_body(struct intersections *all, size_t i, struct cloth_error *error)
{
    const struct contact_body *body = contact_bodies_at(all->bodies, all->obstacles[i].body);
    const struct surface *obstacle = all->obstacle + i;
    struct mesh mesh;
    if (!body)
        return CLOTH_OK;
    const int code = contact_body_mesh(body, &mesh, error);
    for (uint32_t t = 0; t < body->n_triangles && !code; t++) {
        uint32_t *corner = all->corner[obstacle->triangle + t];
        mesh_corners(&mesh, t, corner);
        for (int c = 0; c < 3; c++)
            corner[c] += obstacle->point;
        memcpy(all->joined[obstacle->triangle + t], corner, sizeof *all->joined);
    }
    mesh_free(&mesh);
    return code;
}

static int take_arrays(struct intersections *all, struct cloth_error *error)
{
    all->x = cloth_alloc(all->soup.n_points, sizeof *all->x, error);
    all->corner = cloth_alloc(all->soup.n_triangles, sizeof *all->corner, error);
    all->joined = cloth_alloc(all->soup.n_triangles, sizeof *all->joined, error);
    const uint32_t in_cloths = all->cloth[all->n_cloths].point;
    all->seen = cloth_alloc(in_cloths, sizeof *all->seen, error);
    if (!all->x || !all->corner || !all->joined || !all->seen)
        return CLOTH_E_MEMORY;
    const uint64_t in_bodies = all->soup.n_points - in_cloths;
    all->place = aligned_alloc(sizeof *all->place, (in_bodies + 1) * sizeof *all->place);
    if (!all->place)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the vertices of bodies");
    all->soup.x = (const double(*)[3])all->x;
    all->soup.corner = (const uint32_t(*)[3])all->joined;
    return CLOTH_OK;
}

/* Vertices that seams or welds join share one number. */
static int take_sewn(struct intersections *all, const struct intersections_setup *setup,
                     struct cloth_error *error)
{
    const uint32_t *joined = setup->apart->joined, n = all->cloth[all->n_cloths].point;
    if (!joined)
        return CLOTH_OK;
    all->sewn = cloth_alloc(all->soup.n_points, sizeof *all->sewn, error);
    if (!all->sewn)
        return CLOTH_E_MEMORY;
    cloth_sets_start(all->sewn, all->soup.n_points);
    for (uint32_t v = 0; v < n; v++) {
        cloth_sets_join(all->sewn, v, joined[v]);
        cloth_sets_join(all->sewn, v, setup->same ? setup->same[v] : v);
    }
    for (uint32_t v = 0; v < n; v++)
        all->sewn[v] = cloth_sets_root(all->sewn, v);
    all->soup.joined = all->sewn;
    return CLOTH_OK;
}

static int take_names(struct intersections *all, const struct intersections_setup *setup,
                      struct cloth_error *error)
{
    for (size_t i = 0; i < setup->n_meshes && setup->names; i++)
        if (!(all->cloth[i].name = strdup(setup->names[i])))
            return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the names of cloths");
    return CLOTH_OK;
}

static int fill(struct intersections *all, const struct intersections_setup *setup,
                struct cloth_error *error)
{
    all->cloth = cloth_alloc(setup->n_meshes + 1, sizeof *all->cloth, error);
    all->obstacle = cloth_alloc(setup->n_obstacles + 1, sizeof *all->obstacle, error);
    int code = all->cloth && all->obstacle ? count_points(all, setup, error) : CLOTH_E_MEMORY;
    code = code ? code : take_names(all, setup, error);
    code = code ? code : take_arrays(all, error);
    code = code ? code : take_sewn(all, setup, error);
    for (size_t i = 0; i < setup->n_meshes && !code; i++)
        take_cloth(all, setup, i);
    for (size_t i = 0; i < setup->n_obstacles && !code; i++)
        code = take_body(all, i, error);
    return code ? code
                : intersections_parts(all->cloth[all->n_cloths].point, all->soup.n_first,
                                      (const uint32_t(*)[3])all->joined, &all->part, error);
}

int intersections_open(struct intersections **intersections,
                       const struct intersections_setup *setup, struct cloth_error *error)
{
    struct intersections *all = *intersections = cloth_alloc(1, sizeof *all, error);
    if (!all)
        return CLOTH_E_MEMORY;
    all->program = setup->program;
    all->obstacles = setup->obstacles;
    all->keys = setup->keys;
    all->bodies = setup->bodies;
    all->apart = setup->apart;
    all->self_off = setup->self_off;
    all->n_cloths = setup->n_meshes;
    all->n_obstacles = setup->n_obstacles;
    const int code = fill(all, setup, error);
    if (code)
        intersections_close(intersections);
    return code;
}

void intersections_close(struct intersections **intersections)
{
    struct intersections *all = *intersections;
    *intersections = NULL;
    if (!all)
        return;
    for (size_t i = 0; i < all->n_cloths && all->cloth; i++)
        free(all->cloth[i].name);
    free(all->cloth);
    free(all->obstacle);
    free(all->part);
    free(all->seen);
    free(all->x);
    free(all->place);
    free(all->corner);
    free(all->joined);
    free(all->sewn);
    free(all->pairs.items);
    free(all->entered.items);
    free(all);
}
