/* Triangles of a membrane (cloth/physics/triangle.h). A list has gradients, areas, and the membrane
 * of each material, whose number stands behind the corners. */
#include "cloth/element/cloths.h"
#include "cloth/physics/triangle.h"

static bool triangles_has(const struct model *model, const struct model_cloth *cloth)
{
    return model_has_triangles(model, cloth);
}

static int triangle_rest(const struct element_cloths *cloths, uint32_t cloth, uint32_t triangle,
                         const uint32_t corner[3], double gradient[4], double *area)
{
    double local[6];
    element_rest_local(cloths, cloth, triangle, corner, local);
    return phys_triangle_rest(local, gradient, area);
}

static int triangles_check(const struct element_cloths *cloths, uint32_t c,
                           struct cloth_error *error)
{
    const struct model_cloth *cloth = cloths->model->cloths + c;
    for (uint32_t t = 0; t < cloth->mesh.n_triangles; t++) {
        uint32_t corner[3];
        double gradient[4], area;
        mesh_corners(&cloth->mesh, t, corner);
        if (triangle_rest(cloths, c, t, corner, gradient, &area))
            return model_fail(cloth->mesh_place, error,
                              "mesh: triangle %u of cloth '%.60s' (vertices %u, %u and %u, all "
                              "counted from 1) has no area at rest; an area above 0 is expected",
                              t + 1, cloth->name, corner[0] + 1, corner[1] + 1, corner[2] + 1);
    }
    return CLOTH_OK;
}

static void triangles_pack(const struct element_cloths *cloths, const struct element *element,
                           const struct phys_elements *list, uint32_t e)
{
    double gradient[4];
    triangle_rest(cloths, element->cloth, element->triangle[0], element->corner, gradient,
                  list->number[PHYS_TRIANGLE_AREA] + e);
    list->vector[e] = (phys_vec){gradient[0], gradient[1], gradient[2], gradient[3]};
    list->corner[e][3] = element_material(cloths, element, 3);
}

static void triangles_resize(const struct phys_elements *list, uint32_t e,
                             const struct element_scale *scale)
{
    list->vector[e] /= (phys_vec){scale->warp, scale->weft, scale->warp, scale->weft};
    list->number[PHYS_TRIANGLE_AREA][e] *= scale->area;
}

static void triangles_material(const struct model_material *material, void *to)
{
    struct phys_membrane *membrane = to;
    *membrane = (struct phys_membrane){0};
    if (material->model != MODEL_TRIANGLES)
        return;
    phys_membrane_make(material->stretch, model_weft(material), material->shear, material->poisson,
                       material->damping_stiffness, membrane); /* the model was checked */
    phys_membrane_stiffen(membrane, &material->stiffening);
    membrane->uncorrected = material->uncorrected;
}

const struct element_kind element_triangles = {
    .name = "triangles",
    .part = ELEMENT_TRIANGLES,
    .corners = 3,
    .pairs = 3,
    .vectors = 1,
    .numbers = 1,
    .material_bytes = sizeof(struct phys_membrane),
    .has = triangles_has,
    .check = triangles_check,
    .pack = triangles_pack,
    .resize = triangles_resize,
    .material = triangles_material,
    .force = phys_triangles_force,
    .matrix = phys_triangles_matrix,
    .system = phys_triangles_system,
    .energy = phys_triangles_energy,
    .torque = phys_triangles_torque,
    .stiffest = phys_triangles_stiffest,
};
