/* A material by what instruments print: KES (Kawabata 1980, The Standardization and Analysis of
 * Hand Evaluation) and FAST (De Boos & Tester 1994, SiroFAST, CSIRO WT92.02). Its values are filled
 * in as those of a fabric are, where the scene has none, and checked like these; what is no number
 * is left to the check.
 *
 * Extension. KES prints the strain EMT at 500 gf/cm and the linearity LT, which a curve
 * F = F_m (e / e_m)^n has for n = 2 / LT - 1; FAST the strains at 5, 20 and 100 gf/cm. `stretch` is
 * the secant to 5 gf/cm, which cloth carries as it hangs. Shear and bending are straight lines.
 *
 * Damping. A loop whose area is that of the instrument's hysteresis, at one swing a second: the
 * force b k w a of a rate b (s), amplitude a and w = 2 pi / s takes pi b k w a^2 a swing. */
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdio.h>

static const double GF_PER_CM = 0.980665;       /* N/m */
static const double GF_CM = 9.80665e-5;         /* N m */
static const double HANGS = 5, KES_MOST = 500;  /* gf/cm */
static const double KES_SHEARED = 8;            /* degrees, either way */
static const double KES_BENT = 2.5;             /* 1/cm, either way */
static const double FAST_SHEAR = 123;           /* N/m: G = 123 / EB5 */
static const double FAST_BEND = 9.81e-12;       /* N m of g/m^2 and mm^3 */
static const double SWINGS = 6.283185307179586; /* rad/s: one a second */

struct sheet {
    struct scene_tree *tree;
    int material, values; /* maps */
};

/* Value i of a key, 0 for the warp and 1 for the weft, which may be one for both; 0: none. */
static double value_of(const struct sheet *sheet, const char *key, size_t i)
{
    const struct scene_tree *tree = sheet->tree;
    int node = scene_tree_get(tree, sheet->values, key);
    double value = 0;
    if (scene_tree_is(tree, node, YAML_SEQUENCE_NODE))
        node = i < scene_tree_length(tree, node) ? scene_tree_item(tree, node, i) : 0;
    const char *text = node ? scene_tree_scalar(tree, node) : NULL;
    return text && scene_scalar_number(text, &value) ? value : 0;
}

static double mean_of(const struct sheet *sheet, const char *key)
{
    return (value_of(sheet, key, 0) + value_of(sheet, key, 1)) / 2;
}

static int fill_text(const struct sheet *sheet, const char *key, const char *text)
{
    return scene_tree_get(sheet->tree, sheet->material, key)
               ? CLOTH_OK
               : scene_edit_default(sheet->tree, sheet->material, key, text);
}

/* A value of 0, which the sheet does not have, fills nothing in. */
static int fill_number(const struct sheet *sheet, const char *key, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.9g", value);
    return value > 0 && isfinite(value) ? fill_text(sheet, key, text) : CLOTH_OK;
}

static int fill_pair(const struct sheet *sheet, const char *key, const char *format,
                     const double value[2])
{
    char text[100];
    snprintf(text, sizeof text, format, value[0], value[1]);
    const bool there = value[0] > 0 && value[1] > 0 && isfinite(value[0]) && isfinite(value[1]);
    return there ? fill_text(sheet, key, text) : CLOTH_OK;
}

/* N/m: the secant to 5 gf/cm of the curve that KES sums up. */
static double kes_stretch(const struct sheet *sheet, size_t i)
{
    const double most = value_of(sheet, "EMT", i) / 100, linear = value_of(sheet, "LT", i);
    const double power = linear > 0 ? 2 / linear - 1 : 1;
    return HANGS * GF_PER_CM / (most * pow(HANGS / KES_MOST, 1 / power));
}

static int fill_damping(const struct sheet *sheet)
{
    const double lost = 1 - mean_of(sheet, "RT") / 100;
    const double sheared = mean_of(sheet, "2HG"), bent = mean_of(sheet, "2HB");
    const bool by_tension = mean_of(sheet, "RT") > 0 && lost > 0;
    double stretch = 0, bend = 0;
    char text[100];
    if (by_tension) /* from 0 to the most and back is a swing of half of it */
        stretch = 2 * lost / (M_PI * SWINGS);
    else if (sheared > 0)
        stretch = 2 * sheared / (M_PI * mean_of(sheet, "G") * SWINGS * KES_SHEARED);
    if (bent > 0)
        bend = 2 * bent / (M_PI * mean_of(sheet, "B") * SWINGS * KES_BENT);
    if (!(stretch > 0 || bend > 0) || !isfinite(stretch) || !isfinite(bend))
        return CLOTH_OK;
    if (bend > 0)
        snprintf(text, sizeof text, "{stiffness: %.9g, bending: %.9g}", stretch, bend);
    else
        snprintf(text, sizeof text, "{stiffness: %.9g}", stretch);
    return fill_text(sheet, "damping", text);
}

static int fill_kes(const struct sheet *sheet)
{
    const double stretch[2] = {kes_stretch(sheet, 0), kes_stretch(sheet, 1)};
    const double bend[2] = {GF_CM * value_of(sheet, "B", 0), GF_CM * value_of(sheet, "B", 1)};
    return fill_number(sheet, "density", value_of(sheet, "W", 0) / 100) ||
           fill_pair(sheet, "stretch", "[%.9g, %.9g]", stretch) ||
           fill_number(sheet, "shear", mean_of(sheet, "G") * GF_PER_CM * 180 / M_PI) ||
           fill_pair(sheet, "bending", "{rigidity: [%.9g, %.9g]}", bend) || fill_damping(sheet) ||
           fill_number(sheet, "friction", mean_of(sheet, "MIU"));
}

static int fill_fast(const struct sheet *sheet)
{
    const double weight = value_of(sheet, "W", 0), given = mean_of(sheet, "G");
    double stretch[2], bend[2];
    for (size_t i = 0; i < 2; i++) {
        stretch[i] = HANGS * GF_PER_CM / (value_of(sheet, "E5", i) / 100);
        bend[i] = value_of(sheet, "B", i) > 0
                      ? 1e-6 * value_of(sheet, "B", i)
                      : FAST_BEND * weight * pow(value_of(sheet, "C", i), 3);
    }
    return fill_number(sheet, "density", weight / 1000) ||
           fill_pair(sheet, "stretch", "[%.9g, %.9g]", stretch) ||
           fill_number(sheet, "shear", given > 0 ? given : FAST_SHEAR / mean_of(sheet, "EB5")) ||
           fill_pair(sheet, "bending", "{rigidity: [%.9g, %.9g]}", bend);
}

int scene_instruments_fill(struct scene_tree *tree, int material)
{
    static const struct {
        const char *key;
        int (*fill)(const struct sheet *);
    } instruments[] = {{"kes", fill_kes}, {"fast", fill_fast}};
    int code = CLOTH_OK;
    for (size_t i = 0; i < sizeof instruments / sizeof *instruments && !code; i++) {
        const bool is_map = scene_tree_is(tree, material, YAML_MAPPING_NODE);
        const int values = is_map ? scene_tree_get(tree, material, instruments[i].key) : 0;
        const struct sheet sheet = {tree, material, values};
        if (scene_tree_is(tree, values, YAML_MAPPING_NODE))
            code = fill_text(&sheet, "model", "triangles") || instruments[i].fill(&sheet);
    }
    return code;
}
