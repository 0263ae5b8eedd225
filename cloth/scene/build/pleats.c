/* Pleats of a pattern's stitches: each entry names the longer edge of one. */
#include "cloth/scene/build/build.h"

#include "cloth/garment/pattern.h"

/* So much of the shorter edge may lack for the pleats, and is eased. */
static const double EASED = 0.01;

/* The stitch that has a side, and as which of its two; NULL: none has. */
static struct garment_stitch *pleats_find(struct garment_pattern *pattern,
                                          const struct garment_side *side, int *which)
{
    for (uint32_t s = 0; s < pattern->n_stitches; s++)
        for (*which = 0; *which < 2; ++*which) {
            const struct garment_side *of = pattern->stitch[s].side + *which;
            if (of->panel == side->panel && of->edge == side->edge)
                return pattern->stitch + s;
        }
    return NULL;
}

/* Checks that pleats fit, and finds the depth of those that have none: all of the longer edge. */
static int pleats_fit(struct garment_pleats *pleats, const double length[2],
                      const struct scene_tree *tree, int node)
{
    const int depth = scene_tree_get(tree, node, "depth");
    const double most = (length[0] - length[1]) / (2 * pleats->count),
                 pitch = length[1] / pleats->count;
    pleats->depth = depth ? scene_tree_number(tree, node, "depth") : most;
    if (!(most > 0))
        return scene_tree_fail(tree, node,
                               "pleats need cloth: the edge is %g m long, and the one that it is "
                               "sewn to %g m; the longer edge of a stitch is expected",
                               length[0], length[1]);
    if (pleats->depth > most + EASED * pitch / 2)
        return scene_tree_fail(tree, depth,
                               "%u pleats that are %g m deep take %g m, but the edge is only %g m "
                               "longer than the one that it is sewn to; a depth of at most %g m is "
                               "expected",
                               pleats->count, pleats->depth, 2 * pleats->count * pleats->depth,
                               length[0] - length[1], most);
    if (pleats->depth > pitch * (1 + 1e-9))
        return scene_tree_fail(tree, depth ? depth : node,
                               "pleats that are %g m deep overlap, as there is one in each %g m; a "
                               "smaller count, or a depth of at most that is expected",
                               pleats->depth, pitch);
    return CLOTH_OK;
}

static int add_pleats(struct garment_pattern *pattern, const struct scene_tree *tree, int node)
{
    struct garment_side side;
    double length[2]; /* m: of this edge, and of the one it is sewn to */
    int which;
    if (scene_build_pattern_side(&side, pattern, tree, node))
        return tree->error->code;
    struct garment_stitch *stitch = pleats_find(pattern, &side, &which);
    if (!stitch)
        return scene_tree_fail(tree, node,
                               "edge %u of panel '%.60s' is not stitched, so it has no pleats; an "
                               "edge of a stitch is expected",
                               side.edge, pattern->panel[side.panel].name);
    if (stitch->pleats.count)
        return scene_tree_fail(tree, node,
                               "edge %u of panel '%.60s' is of a stitch that has pleats already",
                               side.edge, pattern->panel[side.panel].name);
    for (int k = 0; k < 2; k++) {
        const struct garment_side *of = stitch->side + (k ? !which : which);
        length[k] = garment_edge_length(pattern->panel + of->panel, of->edge);
    }
    stitch->pleats = (struct garment_pleats){
        .count = (uint32_t)scene_tree_number(tree, node, "count"), .side = which};
    return pleats_fit(&stitch->pleats, length, tree, node);
}

int scene_build_pleats(struct garment_pattern *pattern, const struct scene_tree *tree, int list)
{
    int code = CLOTH_OK;
    for (size_t i = 0; i < scene_tree_length(tree, list) && !code; i++)
        code = add_pleats(pattern, tree, scene_tree_item(tree, list, i));
    return code;
}
