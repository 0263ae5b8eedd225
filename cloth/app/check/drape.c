/* The meshes of a model are forgotten before its first frame, so triangles and areas are copied. */
#include "cloth/app/check/drape.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

int drape_of(struct drape *drape, const struct model *model, struct cloth_error *error)
{
    if (!(model->drape.radius > 0))
        return CLOTH_OK;
    const struct model_cloth *cloth = model->cloths + model->drape.cloth;
    const struct mesh *mesh = &cloth->mesh;
    drape->corner = cloth_alloc(mesh->n_triangles, sizeof *drape->corner, error);
    drape->position = cloth_alloc(mesh->n_vertices, 3 * sizeof *drape->position, error);
    if (!drape->corner || !drape->position)
        return CLOTH_E_MEMORY;
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        mesh_corners(mesh, t, drape->corner[t]);
    drape->n = 3 * (size_t)mesh->n_vertices;
    drape->first = model_first(model, model->drape.cloth);
    drape->shape = (struct mesh_shape){.n_vertices = mesh->n_vertices,
                                       .n_triangles = mesh->n_triangles,
                                       .position = drape->position,
                                       .corner = (const uint32_t(*)[3])drape->corner};
    drape->flat = model_area(cloth);
    drape->disc = model_disc(&model->drape);
    memcpy(drape->axis, model->drape.axis, sizeof drape->axis);
    return CLOTH_OK;
}

void drape_frame(const struct drape *drape, const double *position)
{
    if (drape->n)
        memcpy(drape->position, position + 3 * (size_t)drape->first, drape->n * sizeof *position);
}

int drape_find(const struct drape *drape, struct drape_found *found, struct cloth_error *error)
{
    const int code = mesh_shadow(&drape->shape, drape->axis, &found->shadow, error);
    found->coefficient = 100 * (found->shadow - drape->disc) / (drape->flat - drape->disc);
    return code;
}

void drape_free(struct drape *drape)
{
    free(drape->corner);
    free(drape->position);
    *drape = (struct drape){0};
}
