/* A triangle's shape at rest is that of elements (element_rest_local), also where a cloth is made
 * of springs: then its strain is known, its stress is not. */
#include "cloth/element/strain.h"

#include "cloth/element/cloths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int element_strains_room(struct element_strains *strains, struct cloth_error *error)
{
    struct cloth_pool *memory = &strains->memory;
    const size_t n = strains->n_triangles, n_edges = strains->n_edges, m = strains->n_materials;
    strains->corner = cloth_take(memory, n, sizeof *strains->corner, error);
    strains->gradient = cloth_take(memory, n, sizeof *strains->gradient, error);
    strains->area = cloth_take(memory, n, sizeof *strains->area, error);
    strains->edge = cloth_take(memory, n_edges, sizeof *strains->edge, error);
    strains->length = cloth_take(memory, n_edges, sizeof *strains->length, error);
    strains->membrane = cloth_take(memory, m, sizeof *strains->membrane, error);
    strains->has_stress = cloth_take(memory, m, sizeof *strains->has_stress, error);
    strains->x = cloth_take(memory, strains->n_vertices, sizeof *strains->x, error);
    return memory->lacks ? CLOTH_E_MEMORY : CLOTH_OK;
}

static void add_triangle(struct element_strains *strains, const struct element_cloths *cloths,
                         const struct element *element, uint32_t t)
{
    double local[6], gradient[4];
    element_rest_local(cloths, element->cloth, element->triangle[0], element->corner, local);
    if (phys_triangle_rest(local, gradient, strains->area + t)) {
        strains->area[t] = 0;
        memset(gradient, 0, sizeof gradient);
    }
    strains->gradient[t] = (phys_vec){gradient[0], gradient[1], gradient[2], gradient[3]};
    for (int i = 0; i < 3; i++)
        strains->corner[t][i] = element->first + element->corner[i];
    strains->corner[t][3] = element_material(cloths, element, 3);
}

static void strain_add_edge(struct element_strains *strains, const struct element_cloths *cloths,
                            const struct element *element, uint32_t e)
{
    for (int i = 0; i < 2; i++)
        strains->edge[e][i] = element->first + element->corner[i];
    strains->length[e] = element_rest_length(cloths, element);
}

static void add_cloths(struct element_strains *strains, const struct element_cloths *cloths)
{
    uint32_t t = 0, e = 0;
    struct element element = {.first = 0};
    for (; element.cloth < cloths->model->n_cloths; element.cloth++) {
        const struct mesh *mesh = &cloths->model->cloths[element.cloth].mesh;
        for (uint32_t i = 0; i < mesh->n_triangles; i++) {
            mesh_corners(mesh, i, element.corner);
            element.triangle[0] = i;
            add_triangle(strains, cloths, &element, t++);
        }
        element.triangle[0] = element.triangle[1] = UINT32_MAX;
        for (uint32_t i = 0; i < mesh->n_bare_edges; i++) {
            memcpy(element.corner, mesh->lone_edge + 2 * (size_t)i, 2 * sizeof *element.corner);
            strain_add_edge(strains, cloths, &element, e++);
        }
        element.first += mesh->n_vertices;
    }
}

int element_strains_make(struct element_strains *strains, const struct model *model,
                         struct cloth_error *error)
{
    struct element_cloths cloths;
    *strains = (struct element_strains){0};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct mesh *mesh = &model->cloths[c].mesh;
        strains->n_vertices += mesh->n_vertices;
        strains->n_triangles += mesh->n_triangles;
        strains->n_edges += mesh->n_bare_edges;
    }
    strains->n_materials = model->n_materials;
    int code = element_strains_room(strains, error);
    if (code)
        return code;
    code = element_cloths_make(&cloths, model, error);
    if (code)
        return code;
    element_materials(&element_triangles, model, strains->membrane);
    for (uint32_t i = 0; i < model->n_materials; i++)
        strains->has_stress[i] = model->materials[i].model == MODEL_TRIANGLES;
    add_cloths(strains, &cloths);
    element_cloths_free(&cloths);
    return CLOTH_OK;
}

void element_strains_free(struct element_strains *strains)
{
    cloth_pool_free(&strains->memory);
    *strains = (struct element_strains){0};
}

static void strain_find_edges(const struct element_strains *strains, double *strain)
{
    static const unsigned char counts = 1;
    for (uint32_t e = 0; e < strains->n_edges; e++) {
        const struct phys_springs one = {
            .n = 1, .end = (const uint32_t(*)[2])strains->edge + e, .length = strains->length + e};
        double range[2] = {0};
        phys_springs_range(&one, &counts, strains->x, strains->x, range);
        strain[e] = strains->length[e] > 0 ? range[1] - 1 : NAN;
    }
}

void element_strains_find(const struct element_strains *strains, const double *position,
                          double *strain, double (*stress)[3])
{
    const struct phys_elements triangles = {.n = strains->n_triangles,
                                            .corner = strains->corner,
                                            .vector = strains->gradient,
                                            .number = {[PHYS_TRIANGLE_AREA] = strains->area},
                                            .material = strains->membrane};
    const struct phys_sight sight = {.n = strains->n_vertices, .x = strains->x};
    for (size_t v = 0; v < strains->n_vertices; v++)
        strains->x[v] = (phys_vec){position[3 * v], position[3 * v + 1], position[3 * v + 2], 0};
    phys_triangles_strain(&triangles, &sight, strain, stress);
    strain_find_edges(strains, strain + strains->n_triangles);
    for (size_t t = 0; t < strains->n_triangles; t++) {
        const bool known = strains->area[t] > 0;
        strain[t] = known ? strain[t] : NAN;
        for (int i = 0; stress && i < 3; i++)
            if (!known || !strains->has_stress[strains->corner[t][3]])
                stress[t][i] = NAN;
    }
    for (size_t e = 0; stress && e < strains->n_edges; e++)
        for (int i = 0; i < 3; i++)
            stress[strains->n_triangles + e][i] = NAN;
}
