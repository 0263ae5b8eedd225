/* Values of a fabric are filled in as defaults are, and checked as if the scene had them. A tree of
 * another shape does no harm here: the check finds its faults. */
#include "cloth/scene/schema/check.h"

#include <stdbool.h>
#include <stdio.h>

enum { RIB_KNIT, SILK, DENIM, POLYCOTTON };
const struct model_word scene_fabrics[] = {
    {"rib_knit", RIB_KNIT}, {"silk", SILK}, {"denim", DENIM}, {"polycotton", POLYCOTTON}, {0}};

enum { KEYS = 7 }; /* and the end */
struct value {
    const char *key, *yaml;
};

/* Measured ones are of Wang, O'Brien & Ramamoorthi 2011, as the files of their simulator ARCSim
 * have them at the least strain and curvature. C11, C22, C12, C33 of the first row of `stretching`
 * are
 *
 *     ivory rib knit       42.87    65.17  -0.23   83.18
 *     11 oz black denim   205.35  1013.89  10.23   53.39
 *     royal target       2016.55  2034.98   9.17  104.76
 *
 * ARCSim doubles the row, and its shear force is C33 e12, twice ours. So E = 2 C (1 - nu12 nu21),
 * nu12 = C12 / C22, G = C33; the stiffer direction is the warp. Its hinge has the energy
 * k L^2 theta^2 / (8 (A1 + A2)), which is ours with D = k / 4, k the mean of the three directions
 * measured: 46.24, 30.02, 32.24; 64.20, 73.38, 96.95; 125.41, 108.00, 125.41 uN m. KES-F gave
 * denims 0.14 to 0.23 gf cm^2/cm (Kumari & Khurana, Journal of Textiles 2016, 4614168, table 5);
 * this one has 0.20. */
static const struct value fabrics[][KEYS] = {
    /* Wang, O'Brien & Ramamoorthi 2011: ivory rib knit, 95 % cotton and 5 % spandex */
    [RIB_KNIT] = {{"model", "triangles"},
                  {"density", "0.276"},
                  {"stretch", "[130.3, 85.7]"},
                  {"shear", "83.2"},
                  {"bending", "{rigidity: 9.04e-6}"}},
    /* 8 momme; bent as its filaments are, which slide (Meredith 1945); moduli chosen, not measured
     */
    [SILK] = {{"model", "triangles"},
              {"density", "0.0347"},
              {"stretch", "2000"},
              {"shear", "20"},
              {"bending", "{rigidity: 9.8e-7}"}},
    /* Wang, O'Brien & Ramamoorthi 2011: 11 oz black denim, 99 % cotton and 1 % spandex */
    [DENIM] = {{"model", "triangles"},
               {"density", "0.324"},
               {"stretch", "[2026.8, 410.5]"},
               {"shear", "53.4"},
               {"poisson", "0.0498"},
               {"bending", "{rigidity: 1.954e-5}"}},
    /* Wang, O'Brien & Ramamoorthi 2011: "royal target", of trousers, 65 % cotton, 35 % polyester */
    [POLYCOTTON] = {{"model", "triangles"},
                    {"density", "0.22"},
                    {"stretch", "[4069.9, 4033.0]"},
                    {"shear", "104.8"},
                    {"poisson", "0.00455"},
                    {"bending", "{rigidity: 2.99e-5}"}}};

/* The number of the fabric that a key of a map names; -1: none. */
static int named_by(const struct scene_tree *tree, int map, const char *key)
{
    const bool is_map = scene_tree_is(tree, map, YAML_MAPPING_NODE);
    const int node = is_map ? scene_tree_get(tree, map, key) : 0;
    const char *name = node ? scene_tree_scalar(tree, node) : NULL;
    bool known = false;
    const int fabric = name ? scene_word_value(scene_fabrics, name, &known) : -1;
    return known ? fabric : -1;
}

/* Adds a material with only `like`, if the scene has none of this name. */
static int add_fabric(struct scene_tree *tree, const char *name)
{
    char like[40];
    int code = CLOTH_OK;
    snprintf(like, sizeof like, "{like: %s}", name);
    if (!scene_tree_get(tree, 1, "materials"))
        code = scene_edit_default(tree, 1, "materials", "{}");
    const int materials = scene_tree_get(tree, 1, "materials");
    if (code || !scene_tree_is(tree, materials, YAML_MAPPING_NODE) ||
        scene_tree_get(tree, materials, name))
        return code;
    return scene_edit_default(tree, materials, name, like);
}

/* Adds the materials that the maps of a list name, and with `parts` those in their lists panels and
 * regions. */
static int add_all_named(struct scene_tree *tree, int list, bool parts)
{
    const size_t n =
        scene_tree_is(tree, list, YAML_SEQUENCE_NODE) ? scene_tree_length(tree, list) : 0;
    for (size_t i = 0; i < n; i++) {
        const int map = scene_tree_item(tree, list, i), fabric = named_by(tree, map, "material");
        if (fabric >= 0 && add_fabric(tree, scene_fabrics[fabric].word))
            return tree->error->code;
        if (parts && scene_tree_is(tree, map, YAML_MAPPING_NODE) &&
            (add_all_named(tree, scene_tree_get(tree, map, "panels"), false) ||
             add_all_named(tree, scene_tree_get(tree, map, "regions"), false)))
            return tree->error->code;
    }
    return CLOTH_OK;
}

static int fill_fabric(struct scene_tree *tree, int material, const struct value *value)
{
    int code = CLOTH_OK;
    for (; value->key && !code; value++)
        if (!scene_tree_get(tree, material, value->key))
            code = scene_edit_default(tree, material, value->key, value->yaml);
    return code;
}

int scene_fabrics_fill(struct scene_tree *tree)
{
    if (!scene_tree_is(tree, 1, YAML_MAPPING_NODE)) /* the check of keys says so */
        return CLOTH_OK;
    int code = add_all_named(tree, scene_tree_get(tree, 1, "cloths"), true);
    const int materials = scene_tree_get(tree, 1, "materials");
    const bool is_map = scene_tree_is(tree, materials, YAML_MAPPING_NODE);
    for (size_t i = 0; !code && is_map && i < scene_tree_length(tree, materials); i++) {
        const int material = scene_tree_pair(tree, materials, i).value;
        const int fabric = named_by(tree, material, "like");
        code = scene_instruments_fill(tree, material) ||
               (fabric >= 0 && fill_fabric(tree, material, fabrics[fabric]));
    }
    return code;
}
