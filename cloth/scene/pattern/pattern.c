/* A file of patterns: its properties first, since they say how to read the rest. Keys for
 * variations of a pattern (parameters, constraints) are ignored. */
#include "cloth/scene/pattern.h"
#include "cloth/scene/pattern/reader.h"

static const struct scene_words WORDS = {.noun = "pattern",
                                         .form = "JSON",
                                         .start =
                                             "a pattern is a map of \"pattern\" and \"properties\"",
                                         .large = ""};

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
    code = code ? code : pattern_number(reader, value[UNITS], "units_in_meter", &units);
    if (!code && !(units >= 1e-3 && units <= 1e6))
        return pattern_wrong(reader, value[UNITS],
                             "units_in_meter is %g; it has to be 0.001 to 1e6", units);
    if (!code && value[COORDS])
        code = pattern_word(reader, value[COORDS], "curvature_coords", coords, &reader->absolute);
    if (!code && value[TRANSLATION])
        code = pattern_flag(reader, value[TRANSLATION], PROPERTIES[TRANSLATION], &reader->centre);
    if (!code && value[LOOPS])
        code = pattern_flag(reader, value[LOOPS], PROPERTIES[LOOPS], &loops);
    reader->unit = 1 / units;
    return code;
}

static int read_file(struct pattern_reader *reader)
{
    int file[PATTERN_KEYS], pattern[PATTERN_KEYS];
    int code = pattern_map(reader, 1, "the file", FILE_KEYS, file);
    if (code)
        return code;
    if (!file[0] || !file[1])
        return pattern_wrong(reader, 1, "the file has no \"%s\"", FILE_KEYS[file[0] ? 1 : 0]);
    code = read_properties(reader, file[1]);
    code = code ? code : pattern_map(reader, file[0], "pattern", PATTERN_MAP, pattern);
    if (!code && !pattern[0])
        return pattern_wrong(reader, file[0], "pattern has no panels");
    code = code ? code : pattern_read_panels(reader, pattern[0]);
    return code ? code : pattern_read_stitches(reader, pattern[1], pattern[0]);
}

int scene_read_pattern(struct garment_pattern *pattern, const char *path, struct cloth_error *error)
{
    struct cloth_error own = {0}; /* the caller may want none, the steps below rely on one */
    struct scene_tree tree;
    struct pattern_reader reader = {
        .tree = &tree, .pattern = pattern, .error = &own, .edge = -1, .stitch = -1};
    *pattern = (struct garment_pattern){0};
    int code = scene_tree_load(&tree, path, &WORDS, &own);
    code = code ? code : read_file(&reader);
    scene_tree_free(&tree);
    if (code)
        return cloth_fail(error, code, "%s", own.text);
    code = garment_pattern_check(pattern, &own);
    return code ? cloth_fail(error, code, "%s: %s", path, own.text) : CLOTH_OK;
}
