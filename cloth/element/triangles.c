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
                           const struct element_list *list, uint32_t e)
{
    double gradient[4];
    triangle_rest(cloths, element->cloth, element->triangle[0], element->corner, gradient,
                  list->number[0] + e);
    list->vector[e] = (phys_vec){gradient[0], gradient[1], gradient[2], gradient[3]};
    list->corner[e][3] = element_material(cloths, element, 3);
}

static void triangles_material(const struct model_material *material, void *to)
{
    struct phys_membrane *membrane = to;
    *membrane = (struct phys_membrane){0};
    if (material->model != MODEL_TRIANGLES)
        return;
    phys_membrane_make(material->stretch, model_weft(material), material->shear, material->poisson,
                       material->damping_stiffness, membrane); /* the model was checked */
    membrane->uncorrected = material->uncorrected;
}

static struct phys_triangles triangles_of(const struct element_list *list)
{
    return (struct phys_triangles){list->n, (const uint32_t(*)[4])list->corner, list->vector,
                                   list->number[0], list->material};
}

static void triangles_force(const struct element_list *list, const struct element_world *world,
                            const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_triangles triangles = triangles_of(list);
    (void)world;
    phys_triangles_force(&triangles, sight, f);
}

static void triangles_matrix(const struct element_list *list, size_t from, size_t to,
                             const struct phys_step *step, const struct phys_sight *sight,
                             const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_triangles triangles = triangles_of(list);
    phys_triangles_matrix(&triangles, from, to, step, sight, at, pair);
}

static void triangles_system(const struct element_list *list, size_t from, size_t to,
                             const struct phys_step *step, double push,
                             const struct phys_sight *sight, const uint32_t *at, phys_vec *b,
                             struct phys_pair *pair)
{
    const struct phys_triangles triangles = triangles_of(list);
    phys_triangles_system(&triangles, from, to, step, push, sight, at, b, pair);
}

static double triangles_energy(const struct element_list *list, const struct phys_sight *sight)
{
    const struct phys_triangles triangles = triangles_of(list);
    return phys_triangles_energy(&triangles, sight);
}

static void triangles_torque(const struct element_list *list, const struct phys_sight *sight,
                             double torque[3])
{
    const struct phys_triangles triangles = triangles_of(list);
    phys_triangles_torque(&triangles, sight, torque);
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
    .material = triangles_material,
    .force = triangles_force,
    .matrix = triangles_matrix,
    .system = triangles_system,
    .energy = triangles_energy,
    .torque = triangles_torque,
};
