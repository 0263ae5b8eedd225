/* Vertices of a cloth that the scene chooses: by numbers, a place, a box, a group or an edge
 * of a panel. Numbers are checked here against the mesh, each with its own place in the file. */
#include "cloth/scene/build/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int scene_build_check_vertices(const uint32_t *vertices, uint32_t n,
                               const struct model_cloth *cloth, const struct scene_tree *tree,
                               int node)
{
    for (uint32_t i = 0; i < n; i++)
        if (vertices[i] >= cloth->mesh.n_vertices)
            return scene_tree_fail(tree, scene_tree_part(tree, node, i),
                                   "vertex %u is outside the mesh of cloth '%.60s', which has %u "
                                   "vertices; 0 to %u are allowed",
                                   vertices[i], cloth->name, cloth->mesh.n_vertices,
                                   cloth->mesh.n_vertices - 1);
    return CLOTH_OK;
}

/* Turns two opposite corners into the lower and the upper one. */
static int build_box(double (*box)[3], const struct scene_tree *tree, int node,
                     const struct model_cloth *cloth)
{
    for (int i = 0; i < 3; i++) {
        const double a = box[0][i], b = box[1][i];
        box[0][i] = fmin(a, b);
        box[1][i] = fmax(a, b);
    }
    for (size_t v = 0; v < cloth->mesh.n_vertices; v++)
        if (model_in_box(cloth->mesh.position + 3 * v, (const double(*)[3])box))
            return CLOTH_OK;
    return scene_tree_fail(tree, node,
                           "the box holds no vertex of cloth '%.60s'; it is meant for positions "
                           "after the transform",
                           cloth->name);
}

static int check_radius(const struct scene_tree *tree, int node)
{
    const int radius = scene_tree_get(tree, node, "radius");
    if (!radius || scene_tree_get(tree, node, "nearest"))
        return CLOTH_OK;
    return scene_tree_fail(tree, radius,
                           "radius is given without nearest, the point that it is measured from; "
                           "both or neither are expected");
}

int scene_build_group(uint32_t *group, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node)
{
    const struct mesh *mesh = &cloth->mesh;
    *group = mesh_group_of(mesh, scene_tree_scalar(tree, node));
    if (*group != UINT32_MAX)
        return CLOTH_OK;
    if (!mesh->n_groups)
        return scene_tree_fail(tree, node,
                               "the mesh of cloth '%.60s' has no groups; an OBJ file with lines "
                               "`g NAME` before faces, or a pattern, is expected",
                               cloth->name);
    return scene_build_no_such(tree, node, "group of faces", (const char *const *)mesh->group,
                               mesh->n_groups);
}

/* The vertices of a group, as if they were listed. */
static int pick_group(struct model_pick *pick, const struct scene_tree *tree, int node,
                      const struct model_cloth *cloth)
{
    const struct mesh *mesh = &cloth->mesh;
    uint32_t group, n = 0;
    if (scene_build_group(&group, cloth, tree, node))
        return tree->error->code;
    unsigned char *mark = cloth_alloc(mesh->n_vertices, 1, tree->error);
    if (!mark)
        return tree->error->code;
    mesh_group_vertices(mesh, group, mark);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        n += mark[v];
    pick->vertices = cloth_alloc(n, sizeof *pick->vertices, tree->error);
    for (uint32_t v = 0; v < mesh->n_vertices && pick->vertices; v++)
        if (mark[v])
            pick->vertices[pick->n_vertices++] = v;
    free(mark);
    return tree->error->code;
}

/* The error that a cloth has no such edge of a panel. */
static int no_border(const struct scene_tree *tree, int node, const struct model_cloth *cloth)
{
    const char *panel = scene_tree_text(tree, node, "panel"), **names;
    size_t n = 0;
    uint32_t edges = 0;
    if (!cloth->n_borders)
        return scene_tree_fail(tree, node,
                               "the edges of panels are not known in cloth '%.60s'; a "
                               "mesh.pattern, or seams.file beside an OBJ file, is expected",
                               cloth->name);
    names = cloth_alloc(cloth->n_borders, sizeof *names, tree->error);
    for (uint32_t i = 0; i < cloth->n_borders && names; i++) {
        const struct model_border *border = cloth->borders + i;
        if (!n || strcmp(names[n - 1], border->panel) != 0)
            names[n++] = border->panel;
        edges += !strcmp(border->panel, panel);
    }
    if (edges)
        scene_tree_fail(tree, scene_tree_get(tree, node, "edge"),
                        "panel '%.60s' has no edge %.20s; it has the edges 0 to %u", panel,
                        scene_tree_text(tree, node, "edge"), edges - 1);
    else if (names)
        scene_build_no_such(tree, scene_tree_get(tree, node, "panel"), "panel", names, n);
    free(names);
    return tree->error->code;
}

/* The vertices along an edge of a panel, as if they were listed. */
static int pick_border(struct model_pick *pick, const struct scene_tree *tree, int node,
                       const struct model_cloth *cloth)
{
    const char *panel = scene_tree_text(tree, node, "panel");
    const uint32_t edge = (uint32_t)scene_tree_number(tree, node, "edge");
    for (uint32_t i = 0; i < cloth->n_borders; i++) {
        const struct model_border *border = cloth->borders + i;
        if (border->edge != edge || strcmp(border->panel, panel) != 0)
            continue;
        pick->vertices = cloth_alloc(border->n, sizeof *pick->vertices, tree->error);
        if (pick->vertices)
            memcpy(pick->vertices, border->vertices, border->n * sizeof *pick->vertices);
        pick->n_vertices = pick->vertices ? border->n : 0;
        return tree->error->code;
    }
    return no_border(tree, node, cloth);
}

int scene_build_pick(struct model_pick *pick, const struct scene_tree *tree, int node,
                     const struct model_cloth *cloth)
{
    const int group = scene_tree_get(tree, node, "group");
    const int edge = scene_tree_get(tree, node, "edge");
    if (check_radius(tree, node))
        return tree->error->code;
    if (edge)
        return pick_border(pick, tree, edge, cloth);
    if (group)
        return pick_group(pick, tree, group, cloth);
    if (pick->kind == MODEL_PICK_VERTICES)
        return scene_build_check_vertices(pick->vertices, pick->n_vertices, cloth, tree,
                                          scene_tree_get(tree, node, "vertices"));
    if (pick->kind == MODEL_PICK_BOX)
        return build_box(pick->box, tree, scene_tree_get(tree, node, "box"), cloth);
    return CLOTH_OK;
}

int scene_build_pick_once(struct model_pick *pick, const struct scene_tree *tree, int node,
                          const struct model_cloth *cloth, const char *what)
{
    const int list = scene_tree_get(tree, node, "vertices");
    int code = scene_build_pick(pick, tree, node, cloth);
    if (code || pick->n_vertices < 2 || !list)
        return code;
    unsigned char *seen = cloth_alloc(cloth->mesh.n_vertices, 1, tree->error);
    code = tree->error->code;
    for (uint32_t i = 0; i < pick->n_vertices && !code; i++)
        if (seen[pick->vertices[i]]++)
            code = scene_tree_fail(tree, scene_tree_item(tree, list, i),
                                   "vertex %u stands twice in %s", pick->vertices[i], what);
    free(seen);
    return code;
}

int scene_build_starts(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    const int masses = scene_tree_get(tree, node, "masses");
    const int starts = scene_tree_get(tree, node, "start");
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_masses && !code; i++)
        code = scene_build_pick_once(&cloth->masses[i].pick, tree, scene_tree_item(tree, masses, i),
                                     cloth, "one mass");
    for (uint32_t i = 0; i < cloth->n_starts && !code; i++) {
        struct model_start *start = cloth->starts + i;
        const int item = scene_tree_item(tree, starts, i);
        code = scene_build_transform(&start->transform, tree, item) ||
               scene_build_pick_once(&start->pick, tree, item, cloth, "one start");
    }
    return code;
}
