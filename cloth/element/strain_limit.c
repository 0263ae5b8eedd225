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
                              const struct element_list *list, uint32_t e)
{
    const struct model_material *material =
        cloths->model->materials + element_material(cloths, element, 2);
    list->number[0][e] = material->limit_stiffness;
    list->number[1][e] = (1 + material->limit_strain) * element_rest_length(cloths, element);
}

static struct phys_strain_limits strain_limit_of(const struct element_list *list)
{
    return (struct phys_strain_limits){list->n, (const uint32_t(*)[4])list->corner, list->number[0],
                                       list->number[1]};
}

static void strain_limit_force(const struct element_list *list, const struct element_world *world,
                               const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_strain_limits limits = strain_limit_of(list);
    (void)world;
    phys_strain_limits_force(&limits, sight, f);
}

/* Blocks are symmetric, and whole in either matrix. */
static void strain_limit_matrix(const struct element_list *list, size_t from, size_t to,
                                const struct phys_step *step, const struct phys_sight *sight,
                                const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_strain_limits limits = strain_limit_of(list);
    (void)at;
    phys_strain_limits_matrix(&limits, from, to, step->h, sight, pair);
}

static void strain_limit_stiffness(const struct element_list *list, int full, double scale,
                                   const struct phys_sight *sight, phys_vec *y)
{
    const struct phys_strain_limits limits = strain_limit_of(list);
    (void)full;
    phys_strain_limits_stiffness(&limits, scale, sight, y);
}

static double strain_limit_energy(const struct element_list *list, const struct phys_sight *sight)
{
    const struct phys_strain_limits limits = strain_limit_of(list);
    return phys_strain_limits_energy(&limits, sight);
}

static void strain_limit_stiffest(const struct element_list *list, size_t from, size_t to,
                                  const struct phys_step *step, const struct phys_sight *sight,
                                  const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_strain_limits limits = strain_limit_of(list);
    (void)at;
    phys_strain_limits_stiffest(&limits, from, to, step->h, sight, pair);
}

const struct element_kind element_strain_limit = {
    .name = "limits of strain",
    .part = ELEMENT_EDGES,
    .corners = 2,
    .pairs = 1,
    .numbers = 2,
    .has = strain_limit_has,
    .pack = strain_limit_pack,
    .force = strain_limit_force,
    .matrix = strain_limit_matrix,
    .stiffness = strain_limit_stiffness,
    .energy = strain_limit_energy,
    .stiffest = strain_limit_stiffest,
};
