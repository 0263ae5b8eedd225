/* Cloths with their pins. Indices are checked here against the mesh, each with its own
 * place in the file. */
#include "cloth/element/kind.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/fabrics.h"
#include "cloth/scene/schema/rules.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int scene_build_no_vertex(uint32_t vertex, const struct model_cloth *cloth,
                          const struct scene_tree *tree, int node, struct cloth_error *error)
{
    return scene_tree_fail(tree, node, error,
                           "vertex %u is outside the mesh of cloth '%.60s', which has %u vertices; "
                           "0 to %u are allowed",
                           vertex, cloth->name, cloth->mesh.n_vertices, cloth->mesh.n_vertices - 1);
}

int scene_build_check_vertices(const uint32_t *vertices, uint32_t n,
                               const struct model_cloth *cloth, const struct scene_tree *tree,
                               int list, struct cloth_error *error)
{
    for (uint32_t i = 0; i < n; i++)
        if (vertices[i] >= cloth->mesh.n_vertices)
            return scene_build_no_vertex(vertices[i], cloth, tree, scene_tree_item(tree, list, i),
                                         error);
    return CLOTH_OK;
}

/* Turns two opposite corners into the lower and the upper one. */
static int build_box(double (*box)[3], const struct scene_tree *tree, int node,
                     const struct model_cloth *cloth, struct cloth_error *error)
{
    for (int i = 0; i < 3; i++) {
        const double a = box[0][i], b = box[1][i];
        box[0][i] = fmin(a, b);
        box[1][i] = fmax(a, b);
    }
    for (size_t v = 0; v < cloth->mesh.n_vertices; v++)
        if (model_in_box(cloth->mesh.position + 3 * v, (const double(*)[3])box))
            return CLOTH_OK;
    return scene_tree_fail(tree, node, error,
                           "the box holds no vertex of cloth '%.60s'; it is meant for positions "
                           "after the transform",
                           cloth->name);
}

int scene_build_check_radius(const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const int radius = scene_tree_get(tree, node, "radius");
    if (!radius || scene_tree_get(tree, node, "nearest"))
        return CLOTH_OK;
    return scene_tree_fail(tree, radius, error,
                           "radius is given without nearest, the point that it is measured from; "
                           "both or neither are expected");
}

int scene_build_group(uint32_t *group, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const struct mesh *mesh = &cloth->mesh;
    const char *name = scene_tree_scalar(tree, node);
    *group = mesh_group_of(mesh, name);
    if (*group != UINT32_MAX)
        return CLOTH_OK;
    if (!mesh->n_groups)
        return scene_tree_fail(tree, node, error,
                               "the mesh of cloth '%.60s' has no groups; an OBJ file with lines "
                               "`g NAME` before faces, or a pattern, is expected",
                               cloth->name);
    return scene_build_no_such("group of faces", name, (const char *const *)mesh->group,
                               mesh->n_groups, tree, node, error);
}

/* The vertices of a group, as if they were listed. */
static int pick_group(struct model_pick *pick, const struct scene_tree *tree, int node,
                      const struct model_cloth *cloth, struct cloth_error *error)
{
    const struct mesh *mesh = &cloth->mesh;
    uint32_t group, n = 0;
    if (scene_build_group(&group, cloth, tree, node, error))
        return error->code;
    unsigned char *mark = scene_build_array(mesh->n_vertices, 1, error);
    if (!mark)
        return error->code;
    mesh_group_vertices(mesh, group, mark);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        n += mark[v];
    pick->vertices = scene_build_array(n, sizeof *pick->vertices, error);
    for (uint32_t v = 0; v < mesh->n_vertices && pick->vertices; v++)
        if (mark[v])
            pick->vertices[pick->n_vertices++] = v;
    free(mark);
    return pick->vertices ? CLOTH_OK : error->code;
}

int scene_build_pick(struct model_pick *pick, const struct scene_tree *tree, int node,
                     const struct model_cloth *cloth, struct cloth_error *error)
{
    if (scene_build_check_radius(tree, node, error))
        return error->code;
    const int group = scene_tree_get(tree, node, "group");
    if (group)
        return pick_group(pick, tree, group, cloth, error);
    if (pick->kind == MODEL_PICK_VERTICES)
        return scene_build_check_vertices(pick->vertices, pick->n_vertices, cloth, tree,
                                          scene_tree_get(tree, node, "vertices"), error);
    if (pick->kind == MODEL_PICK_BOX)
        return build_box(pick->box, tree, scene_tree_get(tree, node, "box"), cloth, error);
    return CLOTH_OK;
}

int scene_build_pick_once(struct model_pick *pick, const struct scene_tree *tree, int node,
                          const struct model_cloth *cloth, const char *what,
                          struct cloth_error *error)
{
    const int list = scene_tree_get(tree, node, "vertices");
    int code = scene_build_pick(pick, tree, node, cloth, error);
    if (code || pick->n_vertices < 2 || !list)
        return code;
    unsigned char *seen = scene_build_array(cloth->mesh.n_vertices, 1, error);
    code = seen ? CLOTH_OK : error->code;
    for (uint32_t i = 0; i < pick->n_vertices && !code; i++)
        if (seen[pick->vertices[i]]++)
            code = scene_tree_fail(tree, scene_tree_item(tree, list, i), error,
                                   "vertex %u stands twice in %s", pick->vertices[i], what);
    free(seen);
    return code;
}

static int build_pins(struct model *model, struct model_cloth *cloth, const struct scene_tree *tree,
                      int node, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, node, "pins");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < cloth->n_pins; i++) {
        const int pin = scene_tree_item(tree, list, i);
        code = scene_build_pick(&cloth->pins[i].pick, tree, pin, cloth, error);
        if (!code)
            code = scene_build_constraint(model, &cloth->pins[i], tree, pin, error);
    }
    return code;
}

int scene_build_no_such(const char *what, const char *name, const char *const *names, size_t n,
                        const struct scene_tree *tree, int node, struct cloth_error *error)
{
    char allowed[400];
    scene_allowed_words(name, names, n, allowed, sizeof allowed);
    return scene_tree_fail(tree, node, error, "there is no %s '%.60s'%s", what, name, allowed);
}

static bool is_among(const char *word, const char *const *names, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!strcmp(names[i], word))
            return true;
    return false;
}

static int no_material(const char *name, const struct model *model, const struct scene_tree *tree,
                       int node, struct cloth_error *error)
{
    size_t n = model->n_materials, n_fabrics = 0;
    while (scene_fabrics[n_fabrics].word)
        n_fabrics++;
    const char **names = scene_build_array(n + n_fabrics, sizeof *names, error);
    if (!names)
        return error->code;
    for (uint32_t i = 0; i < model->n_materials; i++)
        names[i] = model->materials[i].name;
    for (size_t i = 0; i < n_fabrics; i++)
        if (!is_among(scene_fabrics[i].word, names, n))
            names[n++] = scene_fabrics[i].word;
    int code = scene_build_no_such("material", name, names, n, tree, node, error);
    free(names);
    return code;
}

/* The density may be left out if it is not needed. */
static int check_density(const struct model_cloth *cloth, const struct model_material *material,
                         const struct scene_tree *tree, int node, struct cloth_error *error)
{
    if (material->density > 0 || cloth->mass_per_vertex > 0)
        return CLOTH_OK;
    return scene_tree_fail(
        tree, scene_tree_get(tree, node, "material"), error,
        "material '%.60s' has no density and the cloth no mass_per_vertex; one of "
        "them is expected",
        material->name);
}

int scene_build_material(uint32_t *material, const struct model_cloth *cloth,
                         const struct model *model, const struct scene_tree *tree, int node,
                         struct cloth_error *error)
{
    const char *name = scene_tree_text(tree, node, "material");
    for (uint32_t i = 0; i < model->n_materials; i++) {
        if (!strcmp(model->materials[i].name, name)) {
            *material = i;
            return check_density(cloth, model->materials + i, tree, node, error);
        }
    }
    return no_material(name, model, tree, scene_tree_get(tree, node, "material"), error);
}

static int name_cloth(struct model *model, uint32_t i, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    char usual[32];
    snprintf(usual, sizeof usual, "cloth%u", i + 1);
    const int at = scene_tree_get(tree, node, "name");
    const char *name = at ? model->cloths[i].name : usual;
    for (uint32_t j = 0; j < i; j++)
        if (!strcmp(model->cloths[j].name, name))
            return scene_tree_fail(tree, at ? at : node, error,
                                   "a second cloth is named '%.60s'; names must differ", name);
    if (!at)
        model->cloths[i].name = scene_build_copy(name, error);
    return model->cloths[i].name ? CLOTH_OK : error->code;
}

/* A shape of its own at rest, from uv. */
static int build_rest(struct model_cloth *cloth, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    const uint32_t n = cloth->mesh.n_vertices + cloth->mesh.n_more_uv;
    if (!scene_word_value(scene_rests, scene_tree_text(tree, node, "rest"), NULL))
        return CLOTH_OK;
    cloth->rest = scene_build_array(1, sizeof *cloth->rest, error);
    if (!cloth->rest)
        return error->code;
    *cloth->rest = cloth->mesh;
    cloth->rest->placed_by_uv = true;
    cloth->rest->position = scene_build_array(n, 3 * sizeof(double), error);
    if (!cloth->rest->position)
        return error->code;
    for (uint32_t v = 0; v < n; v++)
        if (!mesh_uv(&cloth->mesh, v, cloth->rest->position + 3 * (size_t)v))
            return scene_tree_fail(tree, scene_tree_get(tree, node, "rest"), error,
                                   "rest is uv, but the mesh of cloth '%.60s' has none; a grid, an "
                                   "OBJ file with vt, or rest: position is expected",
                                   cloth->name);
    return CLOTH_OK;
}

/* A matrix of springs can hold no other elements. */
static void choose_format(struct model *model, const struct model_cloth *cloth)
{
    if (model->format == SOLVE_SPRINGS && element_in_matrix(model, cloth))
        model->format = SOLVE_HALF;
}

static int build_cloth(struct model *model, uint32_t i, struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    struct model_cloth *cloth = &model->cloths[i];
    int code = name_cloth(model, i, tree, node, error);
    if (!code)
        code = scene_build_material(&cloth->material, cloth, model, tree, node, error);
    if (!code)
        code = scene_build_mesh(model, cloth, tree, node, error);
    if (!code)
        code = build_rest(cloth, tree, node, error);
    if (!code)
        code = scene_build_parts(cloth, model, tree, node, error);
    if (!code)
        code = scene_build_check_moduli(cloth, model, tree, node, error);
    if (!code)
        choose_format(model, cloth);
    if (!code)
        code = build_pins(model, cloth, tree, node, error);
    if (!code)
        code = scene_build_settled(model, cloth, tree, node, error);
    if (!code)
        code = scene_build_starts(cloth, tree, node, error);
    return code ? code : scene_build_loads(model, cloth, tree, node, error);
}

int scene_build_cloths(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "cloths");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < model->n_cloths; i++)
        code = build_cloth(model, i, tree, scene_tree_item(tree, list, i), error);
    return code;
}
