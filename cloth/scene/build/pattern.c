/* A cloth's mesh from a sewing pattern: its panels, meshed, where the pattern places them. What is
 * wrong with a pattern is in `inner`, without the place in the scene. */
#include "cloth/scene/build/build.h"

#include "cloth/garment/garment.h"
#include "cloth/scene/pattern.h"
#include "cloth/scene/schema/check.h"

#include <stdlib.h>
#include <string.h>

/* The panels of a garment as one mesh; uv is that of the panels. */
static int take_mesh(struct mesh *mesh, const struct garment *garment, struct cloth_error *error)
{
    const size_t n = garment->n_vertices;
    const int code = mesh_inline(mesh, garment->n_vertices, *garment->position, 0, NULL,
                                 garment->n_triangles, *garment->triangle, error);
    if (code)
        return code;
    mesh->uv = malloc(n * sizeof *garment->uv);
    if (!mesh->uv)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a mesh");
    memcpy(mesh->uv, garment->uv, n * sizeof *garment->uv);
    return CLOTH_OK;
}

/* Edge or vertices, one of the two. */
static int check_fineness(const struct scene_pattern *asked, const struct scene_tree *tree,
                          int node, struct cloth_error *error)
{
    const int edge = scene_tree_get(tree, node, "edge");
    const int vertices = scene_tree_get(tree, node, "vertices");
    if (edge && vertices)
        return scene_tree_fail(tree, vertices, error,
                               "mesh.pattern has both edge and vertices; one of them is expected");
    if (!edge && !vertices)
        return scene_tree_fail(tree, node, error,
                               "mesh.pattern has neither edge nor vertices; one of them is "
                               "expected, which says how fine the mesh is");
    return scene_build_check_memory(asked->vertices, "the pattern is to have", tree, vertices,
                                    error);
}

static int read_file(struct model *model, struct garment_pattern *pattern,
                     const struct scene_tree *tree, int node, struct cloth_error *error,
                     struct cloth_error *inner)
{
    char *path = scene_build_path(model, tree, scene_tree_get(tree, node, "file"), error);
    const int code = path ? scene_read_pattern(pattern, path, inner) : error->code;
    free(path);
    return code == CLOTH_E_IO ? CLOTH_E_INPUT : code; /* a scene that names no readable file */
}

int scene_build_pattern(struct model *model, struct model_cloth *cloth, struct scene_tree *tree,
                        int node, struct cloth_error *error, struct cloth_error *inner)
{
    struct scene_pattern asked = {0};
    struct garment_pattern pattern = {0};
    struct garment garment = {0};
    int code = scene_fill(&asked, &scene_pattern, tree, node, error);
    code = code ? code : check_fineness(&asked, tree, node, error);
    code = code ? code : read_file(model, &pattern, tree, node, error, inner);
    const struct garment_fineness fineness = {asked.edge, asked.vertices};
    code = code ? code : garment_make(&garment, &pattern, &fineness, inner);
    code = code ? code : take_mesh(&cloth->mesh, &garment, inner);
    garment_free(&garment);
    garment_pattern_free(&pattern);
    return code;
}
