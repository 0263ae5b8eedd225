/* Garments that are too small for the bodies that wear them draw a warning. */
#include "cloth/scene/build/build.h"

#include "cloth/garment/girth.h"

#include <stdlib.h>

/* The places of a body at time 0, n_vertices x 3, and then its triangles. */
static int build_girth_take_body(struct girth_mesh *mesh, const struct contact_body *body,
                                 struct cloth_error *error)
{
    const phys_vec *x = contact_body_vertices(body);
    const struct contact_facet *facet = contact_body_facets(body);
    double(*place)[3] = scene_build_array(body->n_vertices, sizeof *place, error);
    uint32_t(*triangle)[3] = scene_build_array(body->n_triangles, sizeof *triangle, error);
    *mesh = (struct girth_mesh){body->n_triangles, (const double(*)[3])place,
                                (const uint32_t(*)[3])triangle};
    if (!place || !triangle)
        return error->code;
    for (uint32_t v = 0; v < body->n_vertices; v++)
        for (int k = 0; k < 3; k++)
            place[v][k] = x[v][k];
    for (uint32_t t = 0; t < body->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            triangle[t][k] = facet[t].corner[k];
    return CLOTH_OK;
}

static int compare_girths(struct girth_worst *worst, const struct model_cloth *cloth,
                          const struct contact_body *body, struct cloth_error *error)
{
    const struct girth_mesh garment = {cloth->mesh.n_triangles,
                                       (const double(*)[3])cloth->mesh.position,
                                       (const uint32_t(*)[3])cloth->mesh.triangle};
    struct girth_mesh wearer;
    struct girth_seam *seam = scene_build_array(cloth->seams.n, sizeof *seam, error);
    int code = build_girth_take_body(&wearer, body, error);
    code = seam ? code : error->code;
    for (uint32_t s = 0; s < cloth->seams.n && !code; s++)
        seam[s] = (struct girth_seam){cloth->seams.seam[s].n_pairs,
                                      (const uint32_t(*)[2])cloth->seams.seam[s].pair};
    code = code ? code : girth_compare(worst, &garment, cloth->seams.n, seam, &wearer, error);
    free((void *)wearer.x);
    free((void *)wearer.triangle);
    free(seam);
    return code;
}

static bool is_sewn(const struct model_seams *seams)
{
    bool sewn = false;
    for (uint32_t s = 0; s < seams->n; s++)
        sewn = sewn || seams->seam[s].sewing.state != MODEL_SEAMS_OPEN;
    return sewn;
}

static int warn_of_girth(struct model *model, uint32_t cloth, uint32_t obstacle,
                         const struct scene_tree *tree, struct cloth_error *error)
{
    const struct contact_body *body =
        contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
    const int list = scene_tree_get(tree, 1, "cloths");
    const char *name = model->obstacle_names ? model->obstacle_names[obstacle] : NULL;
    struct girth_worst worst;
    const int code = compare_girths(&worst, &model->cloths[cloth], body, error);
    if (code || !girth_too_small(&worst))
        return code;
    return scene_build_warn(model, tree, scene_tree_item(tree, list, cloth), error,
                            "the garment is too small for the body%s%s: at y = %.3g m its girth is "
                            "%.3g m, the body's %.3g m",
                            name ? " " : "", name ? name : "", worst.y, worst.garment, worst.body);
}

int scene_build_girths(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < model->n_cloths; i++)
        for (uint32_t k = 0; k < model->n_obstacles && !code; k++)
            if (is_sewn(&model->cloths[i].seams) && model->obstacles[k].body &&
                !model->obstacles[k].n)
                code = warn_of_girth(model, i, k, tree, error);
    return code;
}
