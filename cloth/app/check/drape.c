/* The meshes of a model are forgotten before its first frame, so triangles and areas are copied. */
#include "cloth/app/check/drape.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct drape {
    struct mesh_shape shape;
    uint32_t (*corner)[3];
    double *position;  /* of the cloth's vertices */
    uint32_t first;    /* of them, among those of all cloths */
    double flat, disc; /* m^2: the cloth at rest, the disc that carries it */
    double axis[3];
};

int drape_of(struct drape **drape, const struct model *model, struct cloth_error *error)
{
    *drape = NULL;
    if (!(model->drape.radius > 0))
        return CLOTH_OK;
    const struct model_cloth *cloth = model->cloths + model->drape.cloth;
    const struct mesh *mesh = &cloth->mesh;
    struct drape *made = *drape = cloth_alloc(1, sizeof *made, error);
    if (!made)
        return error->code;
    made->corner = cloth_alloc(mesh->n_triangles, sizeof *made->corner, error);
    made->position = cloth_alloc(mesh->n_vertices, 3 * sizeof *made->position, error);
    if (!made->corner || !made->position) {
        drape_close(drape);
        return error->code;
    }
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        mesh_corners(mesh, t, made->corner[t]);
    made->shape = (struct mesh_shape){.n_vertices = mesh->n_vertices,
                                      .n_triangles = mesh->n_triangles,
                                      .position = made->position,
                                      .corner = (const uint32_t(*)[3])made->corner};
    made->first = model_first(model, model->drape.cloth);
    made->flat = model_area(cloth);
    made->disc = model_disc(&model->drape);
    memcpy(made->axis, model->drape.axis, sizeof made->axis);
    return CLOTH_OK;
}

void drape_frame(struct drape *drape, const double *position)
{
    memcpy(drape->position, position + 3 * (size_t)drape->first,
           3 * (size_t)drape->shape.n_vertices * sizeof *position);
}

size_t drape_numbers(const struct drape *drape)
{
    return 3 * (size_t)drape->shape.n_vertices;
}

void drape_get(const struct drape *drape, double *numbers)
{
    memcpy(numbers, drape->position, drape_numbers(drape) * sizeof *numbers);
}

void drape_set(struct drape *drape, const double *numbers)
{
    memcpy(drape->position, numbers, drape_numbers(drape) * sizeof *numbers);
}

int drape_find(const struct drape *drape, struct drape_found *found, struct cloth_error *error)
{
    const int code = mesh_shadow(&drape->shape, drape->axis, &found->shadow, error);
    found->coefficient = 100 * (found->shadow - drape->disc) / (drape->flat - drape->disc);
    return code;
}

void drape_close(struct drape **drape)
{
    struct drape *gone = *drape;
    *drape = NULL;
    if (!gone)
        return;
    free(gone->corner);
    free(gone->position);
    free(gone);
}
