/* A file of patterns: its properties first, since they say how to read the rest. Keys for
 * variations of a pattern (parameters, constraints) are ignored. */
#include "cloth/scene/pattern.h"
#include "cloth/base/memory.h"
#include "cloth/scene/pattern/reader.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- Stitches ---- */

/* They name panels, which are looked up in a sorted list; making it finds names that stand twice.
 */
enum { STITCHES = 1 << 18 };

struct name {
    const char *text;
    uint32_t panel;
};

static int pattern_compare_names(const void *a, const void *b)
{
    return strcmp(((const struct name *)a)->text, ((const struct name *)b)->text);
}

static int sort_names(const struct pattern_reader *reader, int node, struct name *names)
{
    const struct garment_pattern *pattern = reader->pattern;
    for (uint32_t p = 0; p < pattern->n_panels; p++)
        names[p] = (struct name){pattern->panel[p].name, p};
    qsort(names, pattern->n_panels, sizeof *names, pattern_compare_names);
    for (uint32_t p = 1; p < pattern->n_panels; p++)
        if (!strcmp(names[p - 1].text, names[p].text))
            return pattern_wrong(reader, node, "two panels have the name '%s'", names[p].text);
    return CLOTH_OK;
}

static int read_stitch_side(const struct pattern_reader *reader, const struct name *names,
                            struct garment_side *side, int node)
{
    static const char *const keys[PATTERN_KEYS] = {"panel", "edge"};
    const struct garment_pattern *pattern = reader->pattern;
    int value[PATTERN_KEYS];
    if (pattern_both(reader, node, "a side", keys, value))
        return reader->tree->error->code;
    char *text = pattern_name(reader, value[0]);
    const struct name key = {text, 0}, *found = NULL;
    if (text)
        found = bsearch(&key, names, pattern->n_panels, sizeof *names, pattern_compare_names);
    if (text && !found)
        pattern_wrong(reader, value[0], "there is no panel '%s'", text);
    free(text);
    if (!found)
        return reader->tree->error->code;
    side->panel = found->panel;
    char what[260];
    snprintf(what, sizeof what, "the edge of panel '%s'", found->text);
    return pattern_index(reader, value[1], what, pattern->panel[side->panel].n_edges, "edges",
                         &side->edge);
}

/* A list of two sides, perhaps with a word; or a map of from and to. */
static int read_stitch(const struct pattern_reader *reader, const struct name *names,
                       struct garment_stitch *stitch, int node)
{
    static const char *const keys[PATTERN_KEYS] = {"from", "to"};
    int side[PATTERN_KEYS];
    int code = CLOTH_OK;
    if (scene_tree_is(reader->tree, node, YAML_MAPPING_NODE)) {
        code = pattern_both(reader, node, "a stitch", keys, side);
    } else {
        code = pattern_list(reader, node, "a stitch", 2, 3);
        for (size_t k = 0; k < 2 && !code; k++)
            side[k] = scene_tree_item(reader->tree, node, k);
        const int word = !code && scene_tree_length(reader->tree, node) == 3
                             ? scene_tree_item(reader->tree, node, 2)
                             : 0;
        const char *text = word ? scene_tree_scalar(reader->tree, word) : NULL;
        stitch->right_wrong = word;
        if (word && (!text || strcmp(text, "right_wrong") != 0))
            return pattern_wrong(reader, word,
                                 "a stitch is two sides, and perhaps the word right_wrong");
    }
    for (int k = 0; k < 2 && !code; k++)
        code = read_stitch_side(reader, names, &stitch->side[k], side[k]);
    return code;
}

/* node 0: there are none. panels: the node of the panels, which are read before. */
static int read_stitches(struct pattern_reader *reader, int node, int panels)
{
    struct garment_pattern *pattern = reader->pattern;
    if (node ? pattern_list(reader, node, "stitches", 0, STITCHES) : CLOTH_OK)
        return reader->tree->error->code;
    const size_t n = scene_tree_length(reader->tree, node);
    struct name *names = cloth_alloc(pattern->n_panels, sizeof *names, reader->tree->error);
    pattern->stitch = cloth_alloc(n, sizeof *pattern->stitch, reader->tree->error);
    int code = reader->tree->error->code || sort_names(reader, panels, names);
    for (size_t s = 0; s < n && !code; s++) {
        reader->stitch = (int64_t)s;
        code =
            read_stitch(reader, names, &pattern->stitch[s], scene_tree_item(reader->tree, node, s));
        pattern->n_stitches += !code;
    }
    reader->stitch = -1;
    free(names);
    return code;
}

/* ---- The file ---- */

static const struct scene_words WORDS = {
    .noun = "pattern",
    .form = "JSON",
    .start = "a pattern is a map of \"pattern\" and \"properties\""};

static const char *const FILE_KEYS[PATTERN_KEYS] = {
    "pattern", "properties", "parameters", "parameter_order", "constraints", "constraint_order"};
static const char *const PATTERN_MAP[PATTERN_KEYS] = {"panels", "stitches", "panel_order"};

enum { COORDS, UNITS, TRANSLATION, LOOPS };
static const char *const PROPERTIES[PATTERN_KEYS] = {
    "curvature_coords", "units_in_meter", "normalize_panel_translation", "normalized_edge_loops"};

static int read_properties(struct pattern_reader *reader, int node)
{
    static const char *const coords[2] = {"relative", "absolute"};
    int value[PATTERN_KEYS];
    double units = 0;
    bool loops;
    int code = pattern_map(reader, node, "properties", PROPERTIES, value);
    if (!code && !value[UNITS])
        return pattern_wrong(reader, node, "properties has no units_in_meter");
    code = code || pattern_number(reader, value[UNITS], "units_in_meter", &units);
    if (!code && !(units >= 1e-3 && units <= 1e6))
        return pattern_wrong(reader, value[UNITS],
                             "units_in_meter is %g; it has to be 0.001 to 1e6", units);
    reader->unit = 1 / units;
    return code ||
           (value[COORDS] &&
            pattern_word(reader, value[COORDS], "curvature_coords", coords, &reader->absolute)) ||
           (value[TRANSLATION] &&
            pattern_flag(reader, value[TRANSLATION], PROPERTIES[TRANSLATION], &reader->centre)) ||
           (value[LOOPS] && pattern_flag(reader, value[LOOPS], PROPERTIES[LOOPS], &loops));
}

static int read_pattern_tree(struct pattern_reader *reader)
{
    int file[PATTERN_KEYS], pattern[PATTERN_KEYS];
    int code = pattern_map(reader, 1, "the file", FILE_KEYS, file);
    if (!code && (!file[0] || !file[1]))
        return pattern_wrong(reader, 1, "the file has no \"%s\"", FILE_KEYS[file[0] ? 1 : 0]);
    code = code || read_properties(reader, file[1]) ||
           pattern_map(reader, file[0], "pattern", PATTERN_MAP, pattern);
    if (!code && !pattern[0])
        return pattern_wrong(reader, file[0], "pattern has no panels");
    return code || pattern_read_panels(reader, pattern[0]) ||
           read_stitches(reader, pattern[1], pattern[0]);
}

static void read_json(struct garment_pattern *pattern, const char *path,
                      const struct garment_choice *choice, struct cloth_error *error)
{
    struct scene_tree tree;
    struct pattern_reader reader = {.tree = &tree, .pattern = pattern, .edge = -1, .stitch = -1};
    if (choice && choice->size) {
        cloth_fail(error, CLOTH_E_INPUT,
                   "%s: a pattern as JSON has one size, so that '%.40s' chooses nothing: leave it "
                   "out",
                   path, choice->size);
        return;
    }
    if (choice && choice->notches) {
        cloth_fail(error, CLOTH_E_INPUT, "%s: a pattern as JSON has no notches: leave them out",
                   path);
        return;
    }
    if (!scene_tree_load(&tree, path, &WORDS, error))
        read_pattern_tree(&reader);
    scene_tree_free(&tree);
}

int scene_read_pattern(struct garment_pattern *pattern, const char *path,
                       const struct garment_choice *choice, struct cloth_error *error)
{
    struct cloth_error own = {0}; /* the caller may want none, the steps below rely on one */
    const char *dot = strrchr(path, '.');
    *pattern = (struct garment_pattern){0};
    if (dot && !strcasecmp(dot, ".dxf"))
        garment_read_dxf(pattern, path, choice, &own);
    else
        read_json(pattern, path, choice, &own);
    if (own.code)
        return cloth_fail(error, own.code, "%s", own.text);
    const int code = garment_pattern_check(pattern, &own);
    return code ? cloth_fail(error, code, "%s: %s", path, own.text) : CLOTH_OK;
}
