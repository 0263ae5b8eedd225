/* Garments that are too small for the bodies that wear them draw a warning. */
#include "cloth/scene/build/build.h"

#include "cloth/garment/girth.h"

#include <stdlib.h>

/* The places of a body at time 0, n_vertices x 3, and then its triangles. */
static void build_girth_take_body(struct slice_mesh *mesh, const struct contact_body *body,
                                  struct cloth_error *error)
{
    const phys_vec *x = contact_body_vertices(body);
    const struct contact_facet *facet = contact_body_facets(body);
    double(*place)[3] = cloth_alloc(body->n_vertices, sizeof *place, error);
    uint32_t(*triangle)[3] = cloth_alloc(body->n_triangles, sizeof *triangle, error);
    *mesh = (struct slice_mesh){body->n_triangles, (const double(*)[3])place,
                                (const uint32_t(*)[3])triangle};
    for (uint32_t v = 0; v < body->n_vertices && place; v++)
        for (int k = 0; k < 3; k++)
            place[v][k] = x[v][k];
    for (uint32_t t = 0; t < body->n_triangles && triangle; t++)
        for (int k = 0; k < 3; k++)
            triangle[t][k] = facet[t].corner[k];
}

static int compare_girths(struct girth_worst *worst, const struct model_cloth *cloth,
                          const struct contact_body *body, struct cloth_error *error)
{
    const struct slice_mesh garment = {cloth->mesh.n_triangles,
                                       (const double(*)[3])cloth->mesh.position,
                                       (const uint32_t(*)[3])cloth->mesh.triangle};
    const struct model_seams *seams = &cloth->seams;
    struct slice_mesh wearer;
    struct girth_seam *seam = cloth_alloc(seams->n, sizeof *seam, error);
    build_girth_take_body(&wearer, body, error);
    for (uint32_t s = 0; s < seams->n && seam; s++)
        seam[s] =
            (struct girth_seam){seams->seam[s].n_pairs, (const uint32_t(*)[2])seams->seam[s].pair};
    if (!error->code)
        girth_compare(worst, &garment, seams->n, seam, &wearer, error);
    free((void *)wearer.x);
    free((void *)wearer.triangle);
    free(seam);
    return error->code;
}

static int warn_of_girth(uint32_t cloth, uint32_t obstacle, const struct scene_tree *tree, int node)
{
    const struct model *model = tree->model;
    const struct contact_body *body =
        contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
    const char *name = model->obstacle_names[obstacle];
    struct girth_worst worst;
    if (!compare_girths(&worst, &model->cloths[cloth], body, tree->error) &&
        girth_too_small(&worst))
        scene_build_warn(tree, node,
                         "the garment is too small for the body%s%s: at y = %.3g m its girth is "
                         "%.3g m, the body's %.3g m",
                         name ? " " : "", name ? name : "", worst.y, worst.garment, worst.body);
    return tree->error->code;
}

int scene_build_girths(struct scene_tree *tree, uint32_t c, int node)
{
    const struct model *model = tree->model;
    bool sewn = false;
    for (uint32_t s = 0; s < model->cloths[c].seams.n; s++)
        sewn = sewn || model->cloths[c].seams.seam[s].sewing.state != MODEL_SEAMS_OPEN;
    for (uint32_t k = 0; k < model->n_obstacles && sewn; k++)
        if (model->obstacles[k].body && !model->obstacles[k].n && warn_of_girth(c, k, tree, node))
            return tree->error->code;
    return CLOTH_OK;
}
