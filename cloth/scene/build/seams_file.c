/* The seams of an OBJ mesh, from the file that duite-garment writes beside it, and the
 * vertices along the edges of its panels. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/pattern/reader.h"

#include <stdlib.h>

static const struct scene_words WORDS = {
    .noun = "file of seams", .form = "JSON", .start = "it is a map of \"seams\""};

enum { SCHEMA, VERTICES, TRIANGLES, PANELS, SEAMS };
static const char *const FILE_KEYS[PATTERN_KEYS] = {"schema", "vertices", "triangles", "panels",
                                                    "seams"};
enum { SIDES, PAIRS, REVERSED, DISTANCES };
static const char *const SEAM_KEYS[PATTERN_KEYS] = {"sides", "pairs", "reversed", "distances"};
static const char *const SIDE_KEYS[PATTERN_KEYS] = {"panel", "edge", "length"};
static const char *const PANEL_KEYS[PATTERN_KEYS] = {"name", "edges", "vertices", "triangles"};

static int seams_file_read_count(const struct pattern_reader *reader, int node, const char *what,
                                 uint32_t expected)
{
    uint32_t n;
    const int code = pattern_index(reader, node, what, UINT32_MAX, what, &n);
    if (code || n == expected)
        return code;
    return pattern_wrong(reader, node, "it is of a mesh of %u %s, but the OBJ file has %u", n, what,
                         expected);
}

static int read_seam_side(const struct pattern_reader *reader, struct model_seam *seam, int k,
                          int node)
{
    int value[PATTERN_KEYS];
    if (pattern_both(reader, node, "a side", SIDE_KEYS, value))
        return reader->tree->error->code;
    seam->side[k].panel = pattern_name(reader, value[0]);
    if (!seam->side[k].panel)
        return reader->tree->error->code;
    return pattern_index(reader, value[1], "an edge", UINT32_MAX, "edges", &seam->side[k].edge);
}

static int read_pairs(const struct pattern_reader *reader, struct model_seam *seam,
                      const struct mesh *mesh, int node)
{
    const size_t most = UINT32_MAX, n = scene_tree_length(reader->tree, node);
    int code = pattern_list(reader, node, "pairs", 1, most);
    seam->pair = code ? NULL : cloth_alloc(n, sizeof *seam->pair, reader->tree->error);
    for (size_t i = 0; i < n && !code && seam->pair; i++) {
        const int pair = scene_tree_item(reader->tree, node, i);
        code = pattern_list(reader, pair, "a pair", 2, 2);
        for (size_t k = 0; k < 2 && !code; k++)
            code = pattern_index(reader, scene_tree_item(reader->tree, pair, k), "a vertex",
                                 mesh->n_vertices, "vertices", &seam->pair[i][k]);
    }
    seam->n_pairs = (uint32_t)n;
    return code ? code : reader->tree->error->code;
}

/* A list of n > 0 vertices. NULL: an error. */
static uint32_t *read_vertices(const struct pattern_reader *reader, const struct mesh *mesh,
                               int node)
{
    const size_t n = scene_tree_length(reader->tree, node);
    int code = pattern_list(reader, node, "an edge", 1, UINT32_MAX);
    uint32_t *vertices = code ? NULL : cloth_alloc(n, sizeof *vertices, reader->tree->error);
    for (size_t i = 0; i < n && !code && vertices; i++)
        code = pattern_index(reader, scene_tree_item(reader->tree, node, i), "a vertex",
                             mesh->n_vertices, "vertices", vertices + i);
    if (!code)
        return vertices;
    free(vertices);
    return NULL;
}

/* The edges of a panel, behind those of the panels before it. */
static int read_panel(const struct pattern_reader *reader, struct model_cloth *cloth, int node)
{
    int value[PATTERN_KEYS];
    const struct scene_tree *tree = reader->tree;
    if (pattern_both(reader, node, "a panel", PANEL_KEYS, value) ||
        pattern_list(reader, value[1], "edges", 1, UINT32_MAX))
        return tree->error->code;
    const uint32_t n = (uint32_t)scene_tree_length(tree, value[1]);
    struct model_border *border =
        scene_build_add(&cloth->borders, &cloth->n_borders, n, sizeof *border, tree->error);
    for (uint32_t e = 0; e < n && border && !tree->error->code; e++) {
        const int list = scene_tree_item(tree, value[1], e);
        border[e].edge = e;
        border[e].n = (uint32_t)scene_tree_length(tree, list);
        border[e].panel = pattern_name(reader, value[0]);
        border[e].vertices = read_vertices(reader, &cloth->mesh, list);
    }
    return tree->error->code;
}

static int read_panels(const struct pattern_reader *reader, struct model_cloth *cloth, int node)
{
    int code = pattern_list(reader, node, "panels", 0, UINT32_MAX);
    for (size_t i = 0; i < scene_tree_length(reader->tree, node) && !code; i++)
        code = read_panel(reader, cloth, scene_tree_item(reader->tree, node, i));
    return code;
}

static int read_seam(const struct pattern_reader *reader, struct model_seam *seam,
                     const struct mesh *mesh, int node)
{
    int value[PATTERN_KEYS];
    int code = pattern_both(reader, node, "a seam", SEAM_KEYS, value) ||
               pattern_list(reader, value[SIDES], "sides", 2, 2);
    for (int k = 0; k < 2 && !code; k++)
        code =
            read_seam_side(reader, seam, k, scene_tree_item(reader->tree, value[SIDES], (size_t)k));
    return code ||
           (value[REVERSED] &&
            pattern_flag(reader, value[REVERSED], "reversed", &seam->reversed)) ||
           (value[DISTANCES] &&
            pattern_vector(reader, value[DISTANCES], "distances", 2, seam->distance)) ||
           read_pairs(reader, seam, mesh, value[PAIRS]);
}

static int read_seams_tree(const struct pattern_reader *reader, struct model_cloth *cloth)
{
    const struct mesh *mesh = &cloth->mesh;
    struct model_seams *seams = &cloth->seams;
    int value[PATTERN_KEYS];
    uint32_t schema = 0;
    int code = pattern_map(reader, 1, "the file", FILE_KEYS, value);
    for (int k = 0; k <= SEAMS && !code; k++)
        if (!value[k] && k != PANELS)
            return pattern_wrong(reader, 1, "the file has no \"%s\"", FILE_KEYS[k]);
    code = code || pattern_index(reader, value[SCHEMA], "schema", 2, "schemas", &schema);
    if (!code && schema != 1)
        return pattern_wrong(reader, value[SCHEMA], "schema is %u; it has to be 1", schema);
    if (code || seams_file_read_count(reader, value[VERTICES], "vertices", mesh->n_vertices) ||
        seams_file_read_count(reader, value[TRIANGLES], "triangles", mesh->n_triangles) ||
        pattern_list(reader, value[SEAMS], "seams", 0, UINT32_MAX))
        return reader->tree->error->code;
    code = value[PANELS] ? read_panels(reader, cloth, value[PANELS]) : CLOTH_OK;
    const size_t n = scene_tree_length(reader->tree, value[SEAMS]);
    seams->seam = cloth_alloc(n, sizeof *seams->seam, reader->tree->error);
    for (size_t s = 0; s < n && seams->seam && !code; s++) {
        seams->n++;
        code = read_seam(reader, seams->seam + s, mesh,
                         scene_tree_item(reader->tree, value[SEAMS], s));
    }
    return reader->tree->error->code;
}

int scene_read_seams(struct model_cloth *cloth, const char *path, struct cloth_error *error)
{
    struct scene_tree tree;
    const struct pattern_reader reader = {.tree = &tree, .edge = -1, .stitch = -1};
    int code = scene_tree_load(&tree, path, &WORDS, error) || read_seams_tree(&reader, cloth);
    scene_tree_free(&tree);
    return code;
}
