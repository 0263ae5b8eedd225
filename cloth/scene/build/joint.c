/* Joints and welds: pairs of vertices of two cloths or of one, or of vertices and points on
 * edges. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>

/* ---- Ends on edges ---- */

/* Checks that the mesh has the edges. all: those of the cloth. */
static int check_end_edges(const struct model_end *end, const struct mesh_edges *all,
                           const struct scene_tree *tree, int node)
{
    const int one = scene_tree_get(tree, node, "edge");
    const int list = scene_tree_get(tree, node, "edges");
    for (uint32_t i = 0; i < end->n; i++) {
        const uint32_t a = end->edges[i][0], b = end->edges[i][1];
        if (!mesh_edges_get(all, a, b))
            return scene_tree_fail(tree, one ? one : scene_tree_item(tree, list, i),
                                   "vertices %u and %u are not the ends of an edge of cloth "
                                   "'%.60s'; such two are expected",
                                   a, b, tree->model->cloths[end->cloth].name);
    }
    return CLOTH_OK;
}

/* The places on its edges where a joint ends. */
static int build_at(struct model_end *end, const struct scene_tree *tree, int node)
{
    const int at = scene_tree_get(tree, node, "at");
    if (!at)
        return scene_tree_fail(tree, node,
                               "the end of a joint on an edge has no at; a number from 0 to 1 is "
                               "expected, or a list of them, one for each edge");
    const size_t n = scene_tree_scalar(tree, at) ? 1 : scene_tree_length(tree, at);
    if (n != end->n)
        return scene_tree_fail(tree, at, "at has %zu numbers for %u edges; as many are expected", n,
                               end->n);
    end->at = cloth_alloc(n, sizeof *end->at, tree->error);
    if (!end->at)
        return tree->error->code;
    scene_tree_vector(tree, at, n, end->at);
    for (size_t i = 0; i < n; i++)
        if (!(end->at[i] >= 0 && end->at[i] <= 1))
            return scene_tree_fail(tree, scene_tree_part(tree, at, i),
                                   "a joint ends at %g of an edge; a number from 0, its first end, "
                                   "to 1, its second, is expected",
                                   end->at[i]);
    return CLOTH_OK;
}

/* edges: of each cloth, those that have been needed. */
static int joint_build_edges(struct model_end *end, struct mesh_edges *edges,
                             const struct scene_tree *tree, int node)
{
    const int at = scene_tree_get(tree, node, "at");
    if (at && !end->edges)
        return scene_tree_fail(tree, at,
                               "at is given without an edge, which it is a place on; edge or edges "
                               "is expected");
    if (!end->edges)
        return CLOTH_OK;
    struct mesh_edges *all = edges + end->cloth;
    return (!all->edge &&
            mesh_edges_find(all, &tree->model->cloths[end->cloth].mesh, tree->error)) ||
           check_end_edges(end, all, tree, node) || build_at(end, tree, node);
}

/* ---- Pairs ---- */

/* Finds the cloth, and checks the vertices, of one end. what: "a joint" */
static int build_end(struct model_end *end, const char *what, const struct scene_tree *tree,
                     int node)
{
    const int one = scene_tree_get(tree, node, "vertex");
    return scene_build_cloth_of(&end->cloth, what, tree, node) ||
           (end->vertices &&
            scene_build_check_vertices(end->vertices, end->n, tree->model->cloths + end->cloth,
                                       tree, one ? one : scene_tree_get(tree, node, "vertices")));
}

/* The keys from and to of a map. edges: of each cloth, as above. */
static int build_pairs(struct model_pairs *pairs, const char *what, struct mesh_edges *edges,
                       const struct scene_tree *tree, int node)
{
    struct model_end *end = pairs->end;
    const int to = scene_tree_get(tree, node, "to");
    if (build_end(&end[0], what, tree, scene_tree_get(tree, node, "from")) ||
        build_end(&end[1], what, tree, to) || joint_build_edges(&end[1], edges, tree, to))
        return tree->error->code;
    if (end[0].n == end[1].n)
        return CLOTH_OK;
    return scene_tree_fail(tree, to,
                           "%s has %u vertices in from and %u%s in to; as many are expected", what,
                           end[0].n, end[1].n, end[1].edges ? " edges" : "");
}

static int check_times(const struct model_joint *joint, const struct scene_tree *tree, int node)
{
    if (!(joint->end > 0) || joint->end > joint->begin)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "end"),
                           "a joint ends at %g s; a time after its begin, %g s, is expected",
                           joint->end, joint->begin);
}

int scene_build_joints(struct scene_tree *tree)
{
    struct model *model = tree->model;
    const int list = scene_tree_get(tree, 1, "joints");
    struct mesh_edges *edges = cloth_alloc(model->n_cloths, sizeof *edges, tree->error);
    int code = tree->error->code;
    for (size_t i = 0; !code && i < model->n_joints; i++) {
        const int node = scene_tree_item(tree, list, i);
        code = build_pairs(&model->joints[i].pairs, "a joint", edges, tree, node) ||
               check_times(model->joints + i, tree, node);
    }
    for (uint32_t c = 0; edges && c < model->n_cloths; c++)
        mesh_edges_free(edges + c);
    free(edges);
    return code;
}

int scene_build_welds(struct scene_tree *tree)
{
    const int list = scene_tree_get(tree, 1, "welds");
    int code = CLOTH_OK;
    for (size_t i = 0; !code && i < tree->model->n_welds; i++)
        code = build_pairs(&tree->model->welds[i].pairs, "a weld", NULL, tree,
                           scene_tree_item(tree, list, i));
    return code;
}

/* ---- Pairs that the scene does not list ---- */

int scene_build_room(struct model_pairs *pairs, uint32_t cloth, uint32_t n,
                     const struct scene_tree *tree, int node)
{
    pairs->place = scene_build_place(tree, node);
    for (int k = 0; k < 2; k++) {
        pairs->end[k].cloth = cloth;
        pairs->end[k].vertices = cloth_alloc(n, sizeof(uint32_t), tree->error);
    }
    return tree->error->code;
}

void scene_build_pair(struct model_pairs *pairs, uint32_t a, uint32_t b)
{
    struct model_end *end = pairs->end;
    end[0].vertices[end[0].n++] = a;
    end[1].vertices[end[1].n++] = b;
}
