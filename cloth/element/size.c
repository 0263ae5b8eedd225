/* Shapes at rest that change in time: as if the mesh had been stretched along warp and weft, by two
 * factors. Springs, which are no elements, change by the same two numbers (struct element_scale).
 */
#include "cloth/element/cloths.h"

/* The square of the cosine between the warp and an edge. Its ends' uv say where the warp is, or the
 * mesh's axes where it has none. */
static double along_warp(const struct element_cloths *cloths, uint32_t cloth, uint32_t triangle,
                         const uint32_t end[2])
{
    const struct mesh *rest = element_rest(cloths, cloth);
    double uv[2][2];
    for (int i = 0; i < 2; i++) {
        const bool known = triangle != UINT32_MAX;
        const uint32_t number = known ? mesh_uv_number(rest, triangle, end[i]) : end[i];
        const double *place = rest->position + 3 * (size_t)end[i];
        if (mesh_uv(rest, number, uv[i]))
            continue;
        for (int d = 0; d < 2; d++) {
            const double *axis = cloths->axis[cloth][d];
            uv[i][d] = place[0] * axis[0] + place[1] * axis[1] + place[2] * axis[2];
        }
    }
    double u = uv[1][0] - uv[0][0], v = uv[1][1] - uv[0][1];
    const double *turn = model_grain(cloths->model->cloths + cloth, 2, end);
    if (turn) {
        const double before = u;
        u = turn[0] * before + turn[1] * v;
        v = turn[0] * v - turn[1] * before;
    }
    return u * u + v * v > 0 ? u * u / (u * u + v * v) : 1;
}

struct element_size element_size_of(const struct element_cloths *cloths, uint32_t cloth, size_t n,
                                    const uint32_t *corner, uint32_t triangle)
{
    const struct model *model = cloths->model;
    const struct model_material *material =
        model->materials + model_material_of(model->cloths + cloth, n, corner);
    struct element_size size = {.curve = {material->size[0], material->size[1]}, .along = 1};
    if (size.curve[0] != size.curve[1])
        size.along = along_warp(cloths, cloth, triangle, corner);
    return size;
}

struct element_scale element_scale_at(const struct model *model, const struct element_size *size,
                                      double time)
{
    const double warp = model_curve_at(model, size->curve[0], time);
    const double weft =
        size->curve[1] == size->curve[0] ? warp : model_curve_at(model, size->curve[1], time);
    return (struct element_scale){warp, weft, warp * weft,
                                  size->along * warp * warp + (1 - size->along) * weft * weft};
}
