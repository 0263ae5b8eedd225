/* Joints of vertices of any cloths: keys at the top of a scene that name pairs of vertices. */
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

/* ---- Ends on edges ---- */

/* One edge is a list of one. */
static int joint_take_edge(struct model_end *end, const struct scene_tree *tree, int node,
                           struct cloth_error *error)
{
    const int one = scene_tree_get(tree, node, "edge");
    double number[2];
    if (!one)
        return CLOTH_OK;
    end->edges = scene_build_array(1, sizeof *end->edges, error);
    if (!end->edges)
        return error->code;
    end->n = 1;
    scene_tree_vector(tree, one, 2, number);
    for (int i = 0; i < 2; i++)
        end->edges[0][i] = (uint32_t)number[i];
    return CLOTH_OK;
}

/* Checks that the mesh has the edges. all: those of the cloth. */
static int check_end_edges(const struct model_end *end, const struct model *model,
                           const struct mesh_edges *all, const struct scene_tree *tree, int node,
                           struct cloth_error *error)
{
    const int one = scene_tree_get(tree, node, "edge");
    const int list = scene_tree_get(tree, node, "edges");
    const struct model_cloth *cloth = model->cloths + end->cloth;
    for (uint32_t i = 0; i < end->n; i++) {
        const uint32_t a = end->edges[i][0], b = end->edges[i][1];
        if (!mesh_edges_get(all, a, b))
            return scene_tree_fail(tree, one ? one : scene_tree_item(tree, list, i), error,
                                   "vertices %u and %u are not the ends of an edge of cloth "
                                   "'%.60s'; such two are expected",
                                   a, b, cloth->name);
    }
    return CLOTH_OK;
}

static int fail_at(const struct scene_tree *tree, int node, double at, struct cloth_error *error)
{
    return scene_tree_fail(tree, node, error,
                           "a joint ends at %g of an edge; a number from 0, its first end, to 1, "
                           "its second, is expected",
                           at);
}

/* The places on its edges where a joint ends. */
static int build_at(struct model_end *end, const struct scene_tree *tree, int node,
                    struct cloth_error *error)
{
    const int at = scene_tree_get(tree, node, "at");
    if (!at)
        return scene_tree_fail(tree, node, error,
                               "the end of a joint on an edge has no at; a number from 0 to 1 is "
                               "expected, or a list of them, one for each edge");
    const size_t n = scene_tree_scalar(tree, at) ? 1 : scene_tree_length(tree, at);
    if (n != end->n)
        return scene_tree_fail(tree, at, error,
                               "at has %zu numbers for %u edges; as many are expected", n, end->n);
    end->at = scene_build_array(n, sizeof *end->at, error);
    if (!end->at)
        return error->code;
    if (scene_tree_scalar(tree, at))
        end->at[0] = scene_tree_number(tree, node, "at");
    else
        scene_tree_vector(tree, at, n, end->at);
    for (size_t i = 0; i < n; i++)
        if (!(end->at[i] >= 0 && end->at[i] <= 1))
            return fail_at(tree, scene_tree_scalar(tree, at) ? at : scene_tree_item(tree, at, i),
                           end->at[i], error);
    return CLOTH_OK;
}

/* all: of each cloth, those that have been needed. */
static int joint_build_edges(struct model_end *end, const struct model *model,
                             struct mesh_edges *all, const struct scene_tree *tree, int node,
                             struct cloth_error *error)
{
    const int at = scene_tree_get(tree, node, "at");
    int code = joint_take_edge(end, tree, node, error);
    if (!code && at && !end->edges)
        return scene_tree_fail(tree, at, error,
                               "at is given without an edge, which it is a place on; edge or edges "
                               "is expected");
    if (code || !end->edges)
        return code;
    if (!all[end->cloth].edge)
        code = mesh_edges_find(all + end->cloth, &model->cloths[end->cloth].mesh, error);
    if (!code)
        code = check_end_edges(end, model, all + end->cloth, tree, node, error);
    return code ? code : build_at(end, tree, node, error);
}

/* ---- Pairs ---- */

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
    for (uint32_t i = 0; i < end->n && end->vertices; i++)
        if (end->vertices[i] >= cloth->mesh.n_vertices)
            return scene_build_no_vertex(end->vertices[i], cloth, tree,
                                         one ? one : scene_tree_item(tree, list, i), error);
    return CLOTH_OK;
}

/* The keys from and to of a map. edges: of each cloth, as above. */
static int build_pairs(struct model_pairs *pairs, const char *what, const struct model *model,
                       struct mesh_edges *edges, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    const int from = scene_tree_get(tree, node, "from"), to = scene_tree_get(tree, node, "to");
    int code = build_end(&pairs->end[0], what, model, tree, from, error);
    if (!code)
        code = build_end(&pairs->end[1], what, model, tree, to, error);
    if (!code)
        code = joint_build_edges(&pairs->end[1], model, edges, tree, to, error);
    if (code || pairs->end[0].n == pairs->end[1].n)
        return code;
    return scene_tree_fail(tree, to, error,
                           "%s has %u vertices in from and %u%s in to; as many are expected", what,
                           pairs->end[0].n, pairs->end[1].n, pairs->end[1].edges ? " edges" : "");
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

static void free_edges(struct mesh_edges *edges, uint32_t n)
{
    for (uint32_t c = 0; c < n; c++)
        mesh_edges_free(edges + c);
    free(edges);
}

int scene_build_joints(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "joints");
    struct mesh_edges *edges = scene_build_array(model->n_cloths, sizeof *edges, error);
    int code = edges ? CLOTH_OK : error->code;
    for (size_t i = 0; !code && i < model->n_joints; i++) {
        const int node = scene_tree_item(tree, list, i);
        code = build_pairs(&model->joints[i].pairs, "a joint", model, edges, tree, node, error);
        if (!code)
            code = check_times(model->joints + i, tree, node, error);
    }
    if (edges)
        free_edges(edges, model->n_cloths);
    return code;
}

int scene_build_welds(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "welds");
    int code = CLOTH_OK;
    for (size_t i = 0; !code && i < model->n_welds; i++)
        code = build_pairs(&model->welds[i].pairs, "a weld", model, NULL, tree,
                           scene_tree_item(tree, list, i), error);
    return code;
}

struct model_weld *scene_build_add_weld(struct model *model, double tolerance, uint32_t cloth,
                                        uint32_t n, struct cloth_error *error)
{
    struct model_weld *grown =
        scene_build_grow(model->welds, model->n_welds, 1, sizeof *grown, error);
    if (!grown)
        return NULL;
    model->welds = grown;
    struct model_weld *weld = grown + model->n_welds++;
    weld->tolerance = tolerance;
    bool made = true;
    for (int k = 0; k < 2; k++) {
        weld->pairs.end[k].cloth = cloth;
        weld->pairs.end[k].vertices = scene_build_array(n, sizeof(uint32_t), error);
        made = made && weld->pairs.end[k].vertices;
    }
    return made ? weld : NULL;
}
