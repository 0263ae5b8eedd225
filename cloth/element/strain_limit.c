/* Limits of edges (cloth/physics/strain_limit.h). A list has the stiffness and the limit of each;
 * where a region of a cloth has none, its edges have no stiffness. */
#include "cloth/physics/strain_limit.h"
#include "cloth/element/cloths.h"

#include <math.h>

static bool strain_limit_has(const struct model *model, const struct model_cloth *cloth)
{
    bool has = false;
    for (uint32_t i = 0; i <= cloth->n_regions; i++)
        has = has || model_material(model, cloth, i)->limit_stiffness > 0;
    return has;
}

static void strain_limit_pack(const struct element_cloths *cloths, const struct element *element,
                              const struct phys_elements *list, uint32_t e)
{
    const struct model_material *material =
        cloths->model->materials + element_material(cloths, element, 2);
    list->number[PHYS_LIMIT_STIFFNESS][e] = material->limit_stiffness;
    list->number[PHYS_LIMIT_LENGTH][e] =
        (1 + material->limit_strain) * element_rest_length(cloths, element);
}

static void strain_limit_resize(const struct phys_elements *list, uint32_t e,
                                const struct element_scale *scale)
{
    list->number[PHYS_LIMIT_LENGTH][e] *= sqrt(scale->square);
}

const struct element_kind element_strain_limit = {
    .name = "limits of strain",
    .part = ELEMENT_EDGES,
    .corners = 2,
    .pairs = 1,
    .numbers = 2,
    .has = strain_limit_has,
    .pack = strain_limit_pack,
    .resize = strain_limit_resize,
    .force = phys_strain_limits_force,
    .matrix = phys_strain_limits_matrix,
    .stiffness = phys_strain_limits_stiffness,
    .energy = phys_strain_limits_energy,
    .stiffest = phys_strain_limits_stiffest,
};
