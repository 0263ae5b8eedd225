/* A cloth's mesh from a sewing pattern, or an own garment: its panels, meshed, where the pattern
 * places them. Faults of a pattern are in tree->inner, without the place in the scene. */
#include "cloth/scene/build/build.h"

#include "cloth/garment/garment.h"
#include "cloth/garment/own/own.h"
#include "cloth/scene/pattern.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The panels of a garment as one mesh; uv is that of the panels, and each is a group. */
static int build_pattern_take_mesh(struct mesh *mesh, const struct garment *garment,
                                   const struct garment_pattern *pattern, struct cloth_error *error)
{
    int code = mesh_inline(mesh, garment->n_vertices, *garment->position, 0, NULL,
                           garment->n_triangles, *garment->triangle, error);
    for (uint32_t i = 0; i < garment->n_pieces && !code; i++)
        code = mesh_group_add(mesh, pattern->panel[i].name, garment->piece[i].first_triangle,
                              garment->piece[i].n_triangles, error);
    if (code)
        return code;
    mesh->uv = cloth_alloc(garment->n_vertices, sizeof *garment->uv, error);
    if (mesh->uv)
        memcpy(mesh->uv, garment->uv, garment->n_vertices * sizeof *garment->uv);
    return error->code;
}

/* The vertices along the edges of a panel, which are one range; the last edge ends at the first
 * vertex again. */
static int take_border(struct model_cloth *cloth, const struct garment_panel *panel,
                       const struct garment_piece *piece, struct cloth_error *error)
{
    struct model_border *border =
        scene_build_add(&cloth->borders, &cloth->n_borders, panel->n_edges, sizeof *border, error);
    for (uint32_t e = 0; e < panel->n_edges && border && !error->code; e++) {
        const uint32_t from = piece->start[e], n = piece->start[e + 1] - from + 1;
        border[e].edge = e;
        border[e].panel = scene_build_copy(panel->name, error);
        border[e].vertices = cloth_alloc(n, sizeof *border->vertices, error);
        for (uint32_t i = 0; i < n && border[e].vertices; i++)
            border[e].vertices[border[e].n++] =
                piece->first + (from + i) % piece->start[panel->n_edges];
    }
    return error->code;
}

static int take_borders(struct model_cloth *cloth, const struct garment *garment,
                        const struct garment_pattern *pattern, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < garment->n_pieces && !code; i++)
        code = take_border(cloth, pattern->panel + i, garment->piece + i, error);
    return code;
}

static int take_seam(struct model_seam *to, const struct garment_seam *from,
                     const struct garment_stitch *stitch, const struct garment_pattern *pattern,
                     struct cloth_error *error)
{
    *to = (struct model_seam){.n_pairs = from->n_pairs,
                              .reversed = from->reversed,
                              .unsure = from->unsure,
                              .distance = {from->distance[0], from->distance[1]}};
    for (int k = 0; k < 2; k++) {
        to->side[k].edge = stitch->side[k].edge;
        to->side[k].panel = scene_build_copy(pattern->panel[stitch->side[k].panel].name, error);
    }
    to->pair = cloth_alloc(from->n_pairs, sizeof *to->pair, error);
    if (error->code)
        return error->code;
    memcpy(to->pair, from->pair, from->n_pairs * sizeof *to->pair);
    return CLOTH_OK;
}

static int take_seams(struct model_seams *to, const struct garment *garment,
                      const struct garment_pattern *pattern, struct cloth_error *error)
{
    int code = CLOTH_OK;
    to->seam = cloth_alloc(garment->n_seams, sizeof *to->seam, error);
    if (!to->seam)
        return error->code;
    for (; to->n < garment->n_seams && !code; to->n++)
        code = take_seam(to->seam + to->n, garment->seam + to->n, pattern->stitch + to->n, pattern,
                         error);
    return code;
}

/* Edge or vertices, one of the two. */
static int build_pattern_check_fineness(const struct scene_pattern *asked,
                                        const struct scene_tree *tree, int node)
{
    const int edge = scene_tree_get(tree, node, "edge");
    const int vertices = scene_tree_get(tree, node, "vertices");
    if (edge && vertices)
        return scene_tree_fail(tree, vertices,
                               "mesh.pattern has both edge and vertices; one of them is expected");
    if (!edge && !vertices)
        return scene_tree_fail(tree, node,
                               "mesh.pattern has neither edge nor vertices; one of them is "
                               "expected, which says how fine the mesh is");
    return scene_build_check_memory(asked->vertices, "the pattern is to have", tree, vertices);
}

/* A file has its own measures. */
static int read_file(struct garment_pattern *pattern, const char *path,
                     const struct scene_pattern *asked, struct scene_tree *tree, int node)
{
    const int measures = scene_tree_get(tree, node, "measures");
    if (measures)
        return scene_tree_fail(tree, measures,
                               "mesh.pattern.measures is of an own garment, which this pattern is "
                               "not: it is a file");
    const struct garment_choice choice = {asked->size, asked->notches};
    return scene_read_pattern(pattern, path, &choice, &tree->inner);
}

/* ---- What the scene says of a pattern's panels ---- */

/* The number of the panel that a node names, a value or a key. */
static int find_panel(uint32_t *panel, const struct garment_pattern *pattern,
                      const struct scene_tree *tree, int node)
{
    const char *name = scene_tree_scalar(tree, node);
    char names[300] = "";
    for (*panel = 0; *panel < pattern->n_panels; ++*panel) {
        if (!strcmp(pattern->panel[*panel].name, name))
            return CLOTH_OK;
        cloth_text_add(names, sizeof names, "%s%s", *panel ? ", " : "",
                       pattern->panel[*panel].name);
    }
    return scene_tree_fail(tree, node, "the pattern has no panel '%.60s'; there are %s", name,
                           names);
}

static int place_panels(struct garment_pattern *pattern, const struct scene_tree *tree, int map)
{
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        uint32_t p;
        if (find_panel(&p, pattern, tree, pair.key))
            return tree->error->code;
        struct garment_panel *panel = pattern->panel + p;
        scene_tree_vector(tree, scene_tree_get(tree, pair.value, "rotation"), 3, panel->rotate);
        scene_tree_vector(tree, scene_tree_get(tree, pair.value, "translation"), 3,
                          panel->translate);
    }
    return CLOTH_OK;
}

int scene_build_pattern_side(struct garment_side *side, const struct garment_pattern *pattern,
                             const struct scene_tree *tree, int node)
{
    side->edge = (uint32_t)scene_tree_number(tree, node, "edge");
    if (find_panel(&side->panel, pattern, tree, scene_tree_get(tree, node, "panel")))
        return tree->error->code;
    const struct garment_panel *panel = pattern->panel + side->panel;
    return side->edge < panel->n_edges
               ? CLOTH_OK
               : scene_tree_fail(tree, scene_tree_get(tree, node, "edge"),
                                 "panel '%.60s' has the edges 0 to %u, but no edge %u", panel->name,
                                 panel->n_edges - 1, side->edge);
}

/* Behind those that the pattern has. */
static int add_stitches(struct garment_pattern *pattern, struct scene_tree *tree, int list)
{
    const size_t n = scene_tree_length(tree, list);
    struct garment_stitch *stitch =
        n ? scene_build_add(&pattern->stitch, &pattern->n_stitches, n, sizeof *stitch, tree->error)
          : NULL;
    for (size_t i = 0; i < n && !tree->error->code; i++)
        for (size_t k = 0; k < 2 && !tree->error->code; k++)
            scene_build_pattern_side(&stitch[i].side[k], pattern, tree,
                                     scene_tree_item(tree, scene_tree_item(tree, list, i), k));
    return tree->error->code ? tree->error->code
           : n               ? garment_pattern_check(pattern, &tree->inner)
                             : CLOTH_OK;
}

static int take_measures(const struct garment_own *own, double *value,
                         const struct scene_pattern *asked, const struct scene_tree *tree, int node)
{
    const int measures = scene_tree_get(tree, node, "measures");
    const int size = garment_size_find(asked->size ? asked->size : "M");
    if (size < 0)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "size"),
                               "mesh.pattern.size is %s; one of %s is expected", asked->size,
                               garment_size_words);
    garment_own_size(own, size, value);
    for (uint32_t i = 0; i < asked->n_measures; i++) {
        const char *name = asked->measures[i].name;
        const int k = garment_own_measure(own, name);
        if (k < 0)
            return scene_tree_fail(tree, scene_tree_get(tree, measures, name),
                                   "mesh.pattern.measures: there is no measure %s of the garment "
                                   "%s; 'duite-garment --measures %s' lists them",
                                   name, own->name, own->name);
        value[k] = asked->measures[i].value;
    }
    return CLOTH_OK;
}

static int make_own(struct garment_pattern *pattern, const struct scene_pattern *asked,
                    struct scene_tree *tree, int node)
{
    const struct garment_own *own = garment_own_find(asked->garment);
    double value[GARMENT_MEASURES];
    if (asked->notches)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "notches"),
                               "mesh.pattern.notches is of a DXF file; own garments have none");
    if (!own)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "garment"),
                               "mesh.pattern.garment is %s; one of %s is expected", asked->garment,
                               garment_own_words);
    return take_measures(own, value, asked, tree, node) ||
           garment_own_make(pattern, own, value, &tree->inner);
}

static void free_asked(struct scene_pattern *asked)
{
    for (uint32_t i = 0; asked->measures && i < asked->n_measures; i++)
        free(asked->measures[i].name);
    free(asked->measures);
    free(asked->garment);
    free(asked->size);
}

/* path: NULL for an own garment. */
static int make_garment(struct scene_made_part *to, const char *path, struct scene_tree *tree,
                        int node)
{
    struct scene_pattern asked = {0};
    int code = scene_fill(&asked, &scene_pattern, tree, node) ||
               build_pattern_check_fineness(&asked, tree, node) ||
               (path ? read_file(&to->pattern, path, &asked, tree, node)
                     : make_own(&to->pattern, &asked, tree, node)) ||
               place_panels(&to->pattern, tree, scene_tree_get(tree, node, "place")) ||
               add_stitches(&to->pattern, tree, scene_tree_get(tree, node, "stitches")) ||
               scene_build_pleats(&to->pattern, tree, scene_tree_get(tree, node, "pleats"));
    const struct garment_fineness fineness = {asked.edge, asked.vertices};
    if (!code && asked.edge > 0)
        code = scene_build_check_memory(
            (uint64_t)fmin(garment_vertices(&to->pattern, asked.edge), 1e18),
            "the pattern is to have", tree, scene_tree_get(tree, node, "edge"));
    code = code || garment_make(&to->garment, &to->pattern, &fineness, &tree->inner);
    to->is_made = !code;
    free_asked(&asked);
    return code;
}

int scene_build_pattern(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    const int file = scene_tree_get(tree, node, "file");
    char *path = file ? scene_build_path(tree, file) : NULL;
    char *key = scene_build_text(tree, node, "mesh.pattern");
    char text[200];
    struct scene_made_part *of = NULL;
    const int code =
        tree->error->code || !(of = scene_made_part(tree->made, key, strlen(key), tree->error)) ||
        (!of->is_made && make_garment(of, path, tree, node)) ||
        (path && garment_pattern_unusual(&of->pattern, text, sizeof text) &&
         scene_build_warn(tree, file, "mesh: %.200s: %s", path, text)) ||
        build_pattern_take_mesh(&cloth->mesh, &of->garment, &of->pattern, &tree->inner) ||
        take_borders(cloth, &of->garment, &of->pattern, tree->error) ||
        take_seams(&cloth->seams, &of->garment, &of->pattern, tree->error);
    free(key);
    free(path);
    return code;
}
