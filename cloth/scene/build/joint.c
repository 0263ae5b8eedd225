/* What joins vertices of any cloths: keys at the top of a scene that name pairs of them. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>
#include <string.h>

static int no_cloth(const char *name, const struct model *model, const struct scene_tree *tree,
                    int node, struct cloth_error *error)
{
    const char **names = scene_build_array(model->n_cloths, sizeof *names, error);
    if (!names)
        return error->code;
    for (uint32_t i = 0; i < model->n_cloths; i++)
        names[i] = model->cloths[i].name;
    int code = scene_build_no_such("cloth", name, names, model->n_cloths, tree, node, error);
    free(names);
    return code;
}

int scene_build_cloth_of(uint32_t *cloth, const char *what, const struct model *model,
                         const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const char *name = scene_tree_text(tree, node, "cloth");
    *cloth = 0;
    if (!name && model->n_cloths == 1)
        return CLOTH_OK;
    if (!name)
        return scene_tree_fail(tree, node, error,
                               "%s does not name its cloth, of which there are %u", what,
                               model->n_cloths);
    for (; *cloth < model->n_cloths; (*cloth)++)
        if (!strcmp(model->cloths[*cloth].name, name))
            return CLOTH_OK;
    return no_cloth(name, model, tree, scene_tree_get(tree, node, "cloth"), error);
}

/* Finds the cloth, and checks the vertices, of one end. what: "a joint" */
static int build_end(struct model_end *end, const char *what, const struct model *model,
                     const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const int one = scene_tree_get(tree, node, "vertex");
    const int list = scene_tree_get(tree, node, "vertices");
    const int code = scene_build_cloth_of(&end->cloth, what, model, tree, node, error);
    if (code)
        return code;
    if (one) {
        end->vertices = scene_build_array(1, sizeof *end->vertices, error);
        if (!end->vertices)
            return error->code;
        end->n = 1;
        end->vertices[0] = scene_tree_integer(tree, node, "vertex");
    }
    const struct model_cloth *cloth = model->cloths + end->cloth;
    for (uint32_t i = 0; i < end->n; i++)
        if (end->vertices[i] >= cloth->mesh.n_vertices)
            return scene_build_no_vertex(end->vertices[i], cloth, tree,
                                         one ? one : scene_tree_item(tree, list, i), error);
    return CLOTH_OK;
}

/* The keys from and to of a map. */
static int build_pairs(struct model_pairs *pairs, const char *what, const struct model *model,
                       const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const int from = scene_tree_get(tree, node, "from"), to = scene_tree_get(tree, node, "to");
    int code = build_end(&pairs->end[0], what, model, tree, from, error);
    if (!code)
        code = build_end(&pairs->end[1], what, model, tree, to, error);
    if (code || pairs->end[0].n == pairs->end[1].n)
        return code;
    return scene_tree_fail(tree, to, error,
                           "%s has %u vertices in from and %u in to; as many are expected", what,
                           pairs->end[0].n, pairs->end[1].n);
}

static int check_times(const struct model_joint *joint, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    if (!(joint->end > 0) || joint->end > joint->begin)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "end"), error,
                           "a joint ends at %g s; a time after its begin, %g s, is expected",
                           joint->end, joint->begin);
}

int scene_build_joints(struct model *model, const struct scene_tree *tree,
                       struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "joints");
    int code = CLOTH_OK;
    for (size_t i = 0; !code && i < model->n_joints; i++) {
        const int node = scene_tree_item(tree, list, i);
        code = build_pairs(&model->joints[i].pairs, "a joint", model, tree, node, error);
        if (!code)
            code = check_times(model->joints + i, tree, node, error);
    }
    return code;
}

int scene_build_welds(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "welds");
    int code = CLOTH_OK;
    for (size_t i = 0; !code && i < model->n_welds; i++)
        code = build_pairs(&model->welds[i].pairs, "a weld", model, tree,
                           scene_tree_item(tree, list, i), error);
    return code;
}
