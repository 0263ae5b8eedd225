/* Values of a fabric are filled in as defaults are, and checked as if the scene had them: the check
 * finds the faults of a tree of another shape, too. */
#include "cloth/scene/schema/check.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum {
    RIB_KNIT,
    SILK,
    DENIM,
    POLYCOTTON,
    INTERLOCK,
    JERSEY,
    SWEATSHIRT,
    SWIMWEAR,
    TABLECLOTH,
    POPLIN,
    WOOL_SUITING,
    FAILLE,
    WOOL_PLAIN,
    COTTON_DENIM
};
const struct model_word scene_fabrics[] = {{"rib_knit", RIB_KNIT},
                                           {"silk", SILK},
                                           {"denim", DENIM},
                                           {"polycotton", POLYCOTTON},
                                           {"interlock", INTERLOCK},
                                           {"jersey", JERSEY},
                                           {"sweatshirt", SWEATSHIRT},
                                           {"swimwear", SWIMWEAR},
                                           {"tablecloth", TABLECLOTH},
                                           {"poplin", POPLIN},
                                           {"wool_suiting", WOOL_SUITING},
                                           {"faille", FAILLE},
                                           {"wool_plain", WOOL_PLAIN},
                                           {"cotton_denim", COTTON_DENIM},
                                           {0}};

enum { KEYS = 7 }; /* and the end */
struct value {
    const char *key, *yaml;
};

/* ---- Wang, O'Brien & Ramamoorthi 2011 ----
 *
 * The files of their simulator ARCSim have C11, C22, C12, C33 at the least strain (0) and, for a
 * pull along one of five directions, at 1/6; of the first of these directions
 *
 *     ivory rib knit        42.87    65.17   -0.23   83.18
 *     11 oz black denim    205.35  1013.89   10.23   53.39
 *     royal target        2016.55  2034.98    9.17  104.76
 *     white dots on black 2002.09  2027.49    0.35   19.19
 *     gray interlock        16.59    34.48  -14.70   36.86   at 1/6:  46.36  261.01
 *     camel ponte roma      31.15    44.03  -12.80   31.90            78.71  268.68
 *     navy sparkle sweat    12.49     3.27  -19.88   17.62            32.17  283.47
 *     white swim solid      47.97   104.62    6.83   60.77            40.37  169.67
 *
 * ARCSim doubles these, and its shear force is C33 e12, twice ours. So E = 2 C (1 - nu12 nu21),
 * nu12 = C12 / C22 (0 where that is below 0), G = C33. The warp is the stiffer direction; the
 * sweatshirt's is the one that is stiffer at 1/6. Knits have the curve 2 (C + 6 e (C' - C)) e at
 * e = 1/48, 1/12, 1/6, as ARCSim mixes both rows.
 *
 * Its hinge has the energy k L^2 theta^2 / (8 (A1 + A2)), which is ours with D = k / 4. k is the
 * mean of three directions at the least curvature, in the order above, uN m: 46.24, 30.02, 32.24;
 * 64.20, 73.38, 96.95; 125.41, 108.00, 125.41; 51.71, 40.66, 31.28; 23.19, 24.75, 14.27; 36.35,
 * 33.01, 37.16; 59.47, 40.07, 45.63; 60.24, 58.80, 51.02.
 *
 * ---- Instruments ----
 *
 * Matsudaira, Masuda, Wada & Yokura 2015 (J. Textile Engineering 61, 69, tables 1 and 2): B and
 * 2HB of cotton broadcloth, wool tropical and polyester faille; W, G, EMT and LT are chosen, as
 * such fabrics have them. Kumari & Khurana 2016 (Journal of Textiles, 4614168, table 5): their
 * denim B, all but W, which is printed as 109 mg/cm^2, thrice that of any denim; here that of the
 * denim above. The plain wool is that of one published FAST report (Fabric Assurance by Simple
 * Testing, 2014). */
static const struct value fabrics[][KEYS] = {
    /* ivory rib knit, 95 % cotton and 5 % spandex */
    [RIB_KNIT] = {{"model", "triangles"},
                  {"density", "0.276"},
                  {"stretch", "[130.3, 85.7]"},
                  {"shear", "83.2"},
                  {"bending", "{rigidity: 9.04e-6}"}},
    /* 8 momme; bent as its filaments are, which slide (Meredith 1945); moduli chosen */
    [SILK] = {{"model", "triangles"},
              {"density", "0.0347"},
              {"stretch", "2000"},
              {"shear", "20"},
              {"bending", "{rigidity: 9.8e-7}"}},
    /* 11 oz, 99 % cotton and 1 % spandex */
    [DENIM] = {{"model", "triangles"},
               {"density", "0.324"},
               {"stretch", "[2026.8, 410.5]"},
               {"shear", "53.4"},
               {"poisson", "0.0498"},
               {"bending", "{rigidity: 1.954e-5}"}},
    /* "royal target", of trousers, 65 % cotton, 35 % polyester */
    [POLYCOTTON] = {{"model", "triangles"},
                    {"density", "0.22"},
                    {"stretch", "[4069.9, 4033.0]"},
                    {"shear", "104.8"},
                    {"poisson", "0.00455"},
                    {"bending", "{rigidity: 2.99e-5}"}},
    /* of T-shirts, 60 % cotton, 40 % polyester */
    [INTERLOCK] = {{"model", "triangles"},
                   {"density", "0.187"},
                   {"stretch_curve", "{warp: [[0.0208, 2.617], [0.0833, 24.62], [0.1667, 87]], "
                                     "weft: [[0.0208, 0.8463], [0.0833, 5.246], [0.1667, 15.45]]}"},
                   {"shear", "36.9"},
                   {"bending", "{rigidity: 5.184e-06}"}},
    /* ponte roma, a double jersey of jackets, 60 % polyester, 40 % rayon */
    [JERSEY] = {{"model", "triangles"},
                {"density", "0.284"},
                {"stretch_curve", "{warp: [[0.0208, 3.005], [0.0833, 26.06], [0.1667, 89.56]], "
                                  "weft: [[0.0208, 1.546], [0.0833, 9.155], [0.1667, 26.24]]}"},
                {"shear", "31.9"},
                {"bending", "{rigidity: 8.877e-06}"}},
    /* of sweaters, 96 % polyester, 4 % spandex */
    [SWEATSHIRT] = {{"model", "triangles"},
                    {"density", "0.224"},
                    {"stretch_curve",
                     "{warp: [[0.0208, 1.596], [0.0833, 23.9], [0.1667, 94.49]], "
                     "weft: [[0.0208, 0.6229], [0.0833, 3.722], [0.1667, 10.72]]}"},
                    {"shear", "17.6"},
                    {"bending", "{rigidity: 1.21e-05}"}},
    /* 87 % nylon, 13 % spandex */
    [SWIMWEAR] = {{"model", "triangles"},
                  {"density", "0.204"},
                  {"stretch_curve", "{warp: [[0.0208, 4.698], [0.0833, 22.86], [0.1667, 56.56]], "
                                    "weft: [[0.0208, 1.959], [0.0833, 7.362], [0.1667, 13.46]]}"},
                  {"shear", "60.8"},
                  {"bending", "{rigidity: 1.417e-05}"}},
    /* white dots on black, 100 % polyester */
    [TABLECLOTH] = {{"model", "triangles"},
                    {"density", "0.128"},
                    {"stretch", "[4055.0, 4004.2]"},
                    {"shear", "19.2"},
                    {"bending", "{rigidity: 1.0305e-5}"}},
    /* cotton broadcloth */
    [POPLIN] = {{"kes", "{W: 12, EMT: 4, LT: 0.8, G: 0.8, B: 0.118, 2HB: 0.124}"}},
    /* a light wool suiting */
    [WOOL_SUITING] = {{"kes", "{W: 16, EMT: 5, LT: 0.65, G: 0.5, B: 0.067, 2HB: 0.033}"}},
    /* polyester faille */
    [FAILLE] = {{"kes", "{W: 12, EMT: 3, LT: 0.8, G: 0.4, B: 0.019, 2HB: 0.007}"}},
    /* a plain wool */
    [WOOL_PLAIN] = {{"fast", "{W: 168, E5: [0.67, 0.40], E20: [1.87, 1.87], E100: [4.60, 5.87], "
                             "EB5: 4.7, C: [15.0, 14.5]}"}},
    /* denim B */
    [COTTON_DENIM] = {{"kes", "{W: 32.4, EMT: 5.735, LT: 0.655, RT: 52.39, G: 1.538, 2HG: 3.575, "
                              "B: 0.144, 2HB: 0.142}"}}};

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

/* True of a key that says how threads stretch, where the material says so by another one. */
static bool stretches(const struct scene_tree *tree, int material, const char *key)
{
    return !strncmp(key, "stretch", 7) && (scene_tree_get(tree, material, "stretch") ||
                                           scene_tree_get(tree, material, "stretch_curve"));
}

static int fill_fabric(struct scene_tree *tree, int material, const struct value *value)
{
    int code = CLOTH_OK;
    for (; value->key && !code; value++)
        if (!scene_tree_get(tree, material, value->key) && !stretches(tree, material, value->key))
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
               (fabric >= 0 && (fill_fabric(tree, material, fabrics[fabric]) ||
                                scene_instruments_fill(tree, material)));
    }
    return code;
}
