/* Panels and their edges. Control points that are given in parts of their edge become places: x
 * along the edge, y to its left. */
#include "cloth/base/memory.h"
#include "cloth/scene/pattern/reader.h"

#include <stdlib.h>
#include <string.h>

enum {
    PANELS = 1 << 16,
    EDGES = 4096,
    ALL_EDGES = 1 << 18,
    POINTS = 4096
}; /* no garment has more */

enum { EDGE_ENDPOINTS, EDGE_CURVATURE };
static const char *const EDGE_KEYS[PATTERN_KEYS] = {"endpoints", "curvature", "label"};
static const char *const CURVE_KEYS[PATTERN_KEYS] = {"type", "params"};

static int read_control(const struct pattern_reader *reader, const struct garment_panel *panel,
                        const struct garment_edge *edge, int node, double control[2])
{
    double v[2];
    if (pattern_vector(reader, node, "a control point", 2, v))
        return reader->tree->error->code;
    const double *a = panel->corner[edge->end[0]], *b = panel->corner[edge->end[1]];
    const double along[2] = {b[0] - a[0], b[1] - a[1]};
    control[0] = reader->absolute ? v[0] * reader->unit : a[0] + v[0] * along[0] - v[1] * along[1];
    control[1] = reader->absolute ? v[1] * reader->unit : a[1] + v[0] * along[1] + v[1] * along[0];
    return CLOTH_OK;
}

static int read_circle(const struct pattern_reader *reader, struct garment_edge *edge, int params)
{
    if (pattern_list(reader, params, "curvature.params of a circle", 3, 3))
        return reader->tree->error->code;
    const int radius = scene_tree_item(reader->tree, params, 0);
    int code = pattern_number(reader, radius, "the radius", &edge->radius);
    edge->radius *= reader->unit;
    if (!code && !(edge->radius > 0))
        return pattern_wrong(reader, radius, "the radius is not above 0");
    edge->curve = GARMENT_CIRCLE;
    return code ||
           pattern_flag(reader, scene_tree_item(reader->tree, params, 1),
                        "curvature.params[1], whether the arc is the large one,", &edge->large) ||
           pattern_flag(reader, scene_tree_item(reader->tree, params, 2),
                        "curvature.params[2], whether the arc is on the right,", &edge->right);
}

static int read_polyline(const struct pattern_reader *reader, const struct garment_panel *panel,
                         struct garment_edge *edge, int params)
{
    if (pattern_list(reader, params, "curvature.params of a polyline", 1, POINTS))
        return reader->tree->error->code;
    const size_t n = scene_tree_length(reader->tree, params);
    edge->curve = GARMENT_POLYLINE;
    edge->point = cloth_alloc(n, sizeof *edge->point, reader->tree->error);
    int code = reader->tree->error->code;
    for (; edge->n_points < n && !code; edge->n_points++)
        code =
            read_control(reader, panel, edge, scene_tree_item(reader->tree, params, edge->n_points),
                         edge->point[edge->n_points]);
    return code;
}

static int read_curve(const struct pattern_reader *reader, const struct garment_panel *panel,
                      struct garment_edge *edge, int node)
{
    int value[PATTERN_KEYS];
    if (scene_tree_is(reader->tree, node, YAML_SEQUENCE_NODE)) {
        edge->curve = GARMENT_QUADRATIC;
        return read_control(reader, panel, edge, node, edge->control[0]);
    }
    if (pattern_both(reader, node, "curvature", CURVE_KEYS, value))
        return reader->tree->error->code;
    const char *type = scene_tree_scalar(reader->tree, value[0]);
    const bool quadratic = type && !strcmp(type, "quadratic"),
               cubic = type && !strcmp(type, "cubic");
    if (type && !strcmp(type, "circle"))
        return read_circle(reader, edge, value[1]);
    if (type && !strcmp(type, "polyline"))
        return read_polyline(reader, panel, edge, value[1]);
    if (!quadratic && !cubic)
        return pattern_wrong(reader, value[0],
                             "curvature.type is none of quadratic, cubic, circle and polyline");
    edge->curve = quadratic ? GARMENT_QUADRATIC : GARMENT_CUBIC;
    const size_t n = quadratic ? 1 : 2;
    int code = pattern_list(reader, value[1],
                            quadratic ? "curvature.params of a quadratic curve"
                                      : "curvature.params of a cubic curve",
                            n, n);
    for (size_t i = 0; i < n && !code; i++)
        code = read_control(reader, panel, edge, scene_tree_item(reader->tree, value[1], i),
                            edge->control[i]);
    return code;
}

static int read_edge(const struct pattern_reader *reader, struct garment_panel *panel,
                     struct garment_edge *edge, int node)
{
    int value[PATTERN_KEYS];
    if (pattern_map(reader, node, "the edge", EDGE_KEYS, value))
        return reader->tree->error->code;
    if (!value[EDGE_ENDPOINTS])
        return pattern_wrong(reader, node, "endpoints are missing");
    int code = pattern_list(reader, value[EDGE_ENDPOINTS], "endpoints", 2, 2);
    for (size_t i = 0; i < 2 && !code; i++)
        code = pattern_index(reader, scene_tree_item(reader->tree, value[EDGE_ENDPOINTS], i),
                             "an endpoint", panel->n_corners, "vertices", &edge->end[i]);
    if (code || !value[EDGE_CURVATURE])
        return code;
    return read_curve(reader, panel, edge, value[EDGE_CURVATURE]);
}

static int pattern_read_edges(struct pattern_reader *reader, struct garment_panel *panel, int node)
{
    int code = pattern_list(reader, node, "edges", 0, EDGES);
    if (code)
        return code;
    const size_t n = scene_tree_length(reader->tree, node);
    reader->n_edges += n;
    if (reader->n_edges > ALL_EDGES)
        return pattern_wrong(reader, node, "the panels up to here have more than %d edges",
                             ALL_EDGES);
    panel->edge = cloth_alloc(n, sizeof *panel->edge, reader->tree->error);
    if (!panel->edge)
        return CLOTH_E_MEMORY;
    panel->n_edges = (uint32_t)n;
    for (size_t e = 0; e < n && !code; e++) {
        reader->edge = (int64_t)e;
        code = read_edge(reader, panel, &panel->edge[e], scene_tree_item(reader->tree, node, e));
    }
    reader->edge = -1;
    return code;
}

static int read_corners(const struct pattern_reader *reader, struct garment_panel *panel, int node)
{
    int code = pattern_list(reader, node, "vertices", 0, EDGES);
    if (code)
        return code;
    const size_t n = scene_tree_length(reader->tree, node);
    panel->corner = cloth_alloc(n, sizeof *panel->corner, reader->tree->error);
    if (!panel->corner)
        return CLOTH_E_MEMORY;
    panel->n_corners = (uint32_t)n;
    for (size_t i = 0; i < n && !code; i++) {
        code = pattern_vector(reader, scene_tree_item(reader->tree, node, i), "a vertex", 2,
                              panel->corner[i]);
        for (int k = 0; k < 2; k++)
            panel->corner[i][k] *= reader->unit;
    }
    return code;
}

/* The middle of the vertices becomes the origin, and the translation makes up for it as if the
 * panel were not turned: so the format says. */
static void move_to_centre(struct garment_panel *panel)
{
    double middle[2] = {0, 0};
    for (uint32_t i = 0; i < panel->n_corners; i++)
        for (int k = 0; k < 2; k++)
            middle[k] += panel->corner[i][k] / panel->n_corners;
    for (int k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < panel->n_corners; i++)
            panel->corner[i][k] -= middle[k];
        for (uint32_t e = 0; e < panel->n_edges; e++) {
            for (int c = 0; c < 2; c++)
                panel->edge[e].control[c][k] -= middle[k];
            for (uint32_t c = 0; c < panel->edge[e].n_points; c++)
                panel->edge[e].point[c][k] -= middle[k];
        }
        panel->translate[k] += middle[k];
    }
}

enum { PANEL_VERTICES, PANEL_EDGES, PANEL_TRANSLATION, PANEL_ROTATION, PANEL_WARP };
static const char *const PANEL_KEYS[PATTERN_KEYS] = {"vertices", "edges", "translation",
                                                     "rotation", "warp",  "label"};

static int read_panel(struct pattern_reader *reader, struct garment_panel *panel, int node)
{
    static const char *const axes[2] = {"x", "y"};
    int value[PATTERN_KEYS];
    if (pattern_map(reader, node, "the panel", PANEL_KEYS, value))
        return reader->tree->error->code;
    for (int k = 0; k < 4; k++)
        if (!value[k])
            return pattern_wrong(reader, node, "%s: missing", PANEL_KEYS[k]);
    int code =
        read_corners(reader, panel, value[PANEL_VERTICES]) ||
        pattern_vector(reader, value[PANEL_TRANSLATION], "translation", 3, panel->translate) ||
        pattern_vector(reader, value[PANEL_ROTATION], "rotation", 3, panel->rotate) ||
        (value[PANEL_WARP] &&
         pattern_word(reader, value[PANEL_WARP], "warp", axes, &panel->warp_up));
    for (int k = 0; k < 3; k++)
        panel->translate[k] *= reader->unit;
    code = code || pattern_read_edges(reader, panel, value[PANEL_EDGES]);
    if (!code && reader->centre)
        move_to_centre(panel);
    return code;
}

int pattern_read_panels(struct pattern_reader *reader, int node)
{
    struct garment_pattern *pattern = reader->pattern;
    const size_t n = scene_tree_length(reader->tree, node);
    if (!scene_tree_is(reader->tree, node, YAML_MAPPING_NODE) || n > PANELS)
        return pattern_wrong(reader, node, "panels has to be a map of at most %d panels", PANELS);
    pattern->panel = cloth_alloc(n, sizeof *pattern->panel, reader->tree->error);
    if (!pattern->panel)
        return CLOTH_E_MEMORY;
    pattern->n_panels = (uint32_t)n;
    for (size_t i = 0; i < n; i++) {
        const yaml_node_pair_t pair = scene_tree_pair(reader->tree, node, i);
        struct garment_panel *panel = &pattern->panel[i];
        panel->name = pattern_name(reader, pair.key);
        if (!panel->name)
            return reader->tree->error->code;
        reader->panel = panel->name;
        int code = read_panel(reader, panel, pair.value);
        if (code)
            return code;
        reader->panel = NULL;
    }
    return CLOTH_OK;
}
