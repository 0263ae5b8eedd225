/* A material by what instruments print: KES (Kawabata 1980, The Standardization and Analysis of
 * Hand Evaluation) and FAST (De Boos & Tester 1994, SiroFAST, CSIRO WT92.02). Its values are filled
 * in as those of a fabric are, where the scene has none, and checked like these; what is no number
 * is left to the check.
 *
 * Extension. KES prints the strain EMT at 500 gf/cm and the linearity LT, which a curve
 * F = F_m (e / e_m)^n has for n = 2 / LT - 1; FAST the strains at 5, 20 and 100 gf/cm. Both give
 * `stretch_curve`, straight between these loads, so that the modulus at rest is the secant to 5
 * gf/cm, which cloth carries as it hangs. Shear is a straight line.
 *
 * Bending. The moment rises on KES's loop as B k + 2HB / 2 with the curvature k; `rigidity` is the
 * secant to 0.5 1/cm, as cloth hangs: friction holds up a fold, too. FAST's cantilever is a secant
 * by itself.
 *
 * Compression. KES prints the thickness T and, to a load P, the energy WC and the linearity LC = 2
 * WC / (P lost) of what is lost of it; FAST two thicknesses. The law of contact halves T by the
 * pressure P (T / lost - 1).
 *
 * Damping. A loop whose area is that of the instrument's hysteresis, at one swing a second: the
 * force b k w a of a rate b (s), amplitude a and w = 2 pi / s takes pi b k w a^2 a swing. */
#include "cloth/base/number.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdio.h>

static const double GF_PER_CM = 0.980665;        /* N/m */
static const double GF_CM = 9.80665e-5;          /* N m */
static const double LOADS[] = {5, 20, 100, 500}; /* gf/cm: FAST's three, and KES's largest */
enum { FAST_LOADS = 3, KES_LOADS = 4 };
static const double GF_PER_CM2 = 98.0665; /* Pa */
static const double MM_PER_CM = 10;
static const double KES_PRESSED = 50, FAST_PRESSED = 100; /* gf/cm^2 */
static const double KES_SHEARED = 8;                      /* degrees, either way */
static const double KES_BENT = 2.5;                       /* 1/cm, either way */
static const double KES_HANGS = 0.5;                      /* 1/cm */
static const double FAST_SHEAR = 123;                     /* N/m: G = 123 / EB5 */
static const double FAST_BEND = 9.81e-12;                 /* N m of g/m^2 and mm^3 */
static const double SWINGS = 6.283185307179586;           /* rad/s: one a second */

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
    return text && cloth_number(text, &value) ? value : 0;
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

/* rigidity: N m of warp and weft. */
static int fill_rigidity(const struct sheet *sheet, const double rigidity[2])
{
    char text[100];
    snprintf(text, sizeof text, "{rigidity: [%.9g, %.9g]}", rigidity[0], rigidity[1]);
    const bool there = rigidity[0] > 0 && rigidity[1] > 0;
    return there && isfinite(rigidity[0] + rigidity[1]) ? fill_text(sheet, "bending", text)
                                                        : CLOTH_OK;
}

/* Strains of a thread at the loads, 0 where the sheet has none: of the curve that KES sums up. */
static void kes_strains(const struct sheet *sheet, size_t thread, double strain[KES_LOADS])
{
    const double most = value_of(sheet, "EMT", thread) / 100,
                 linear = value_of(sheet, "LT", thread);
    const double power = linear > 0 ? 2 / linear - 1 : 1;
    for (int i = 0; i < KES_LOADS; i++) /* a straight line needs one point */
        strain[i] = power == 1 && i < KES_LOADS - 1
                        ? 0
                        : most * pow(LOADS[i] / LOADS[KES_LOADS - 1], 1 / power);
}

static void fast_strains(const struct sheet *sheet, size_t thread, double strain[KES_LOADS])
{
    static const char *const key[FAST_LOADS] = {"E5", "E20", "E100"};
    for (int i = 0; i < FAST_LOADS; i++)
        strain[i] = value_of(sheet, key[i], thread) / 100;
}

/* Writes "[[e, F], ...]" of the strains that are there. Returns how many. */
static int write_curve(char *text, size_t size, const double strain[KES_LOADS])
{
    size_t at = (size_t)snprintf(text, size, "[");
    int n = 0;
    for (int i = 0; i < KES_LOADS; i++)
        if (strain[i] > 0 && isfinite(strain[i]))
            at += (size_t)snprintf(text + at, size - at, "%s[%.12g, %.12g]", n++ ? ", " : "",
                                   strain[i], LOADS[i] * GF_PER_CM);
    snprintf(text + at, size - at, "]");
    return n;
}

/* Fills in the curve of both threads, unless the scene has a stretch of its own. */
static int fill_curve(const struct sheet *sheet,
                      void (*strains)(const struct sheet *, size_t, double[KES_LOADS]))
{
    char thread[2][200], text[420];
    int least = KES_LOADS;
    for (size_t i = 0; i < 2; i++) {
        double strain[KES_LOADS] = {0};
        strains(sheet, i, strain);
        const int n = write_curve(thread[i], sizeof thread[i], strain);
        least = n < least ? n : least;
    }
    if (!least || scene_tree_get(sheet->tree, sheet->material, "stretch"))
        return CLOTH_OK;
    snprintf(text, sizeof text, "{warp: %s, weft: %s}", thread[0], thread[1]);
    return fill_text(sheet, "stretch_curve", text);
}

/* N m of warp or weft; 0: the sheet has none. */
static double kes_rigidity(const struct sheet *sheet, size_t i)
{
    const double line = value_of(sheet, "B", i);
    return line > 0 ? GF_CM * (line + value_of(sheet, "2HB", i) / (2 * KES_HANGS)) : 0;
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

/* Thickness, mm, of which a load, gf/cm^2, takes some (cloth/contact/row.h). by: the key that says
 * how much. */
static int fill_thickness(const struct sheet *sheet, double thickness, const char *by, double lost,
                          double load)
{
    const struct scene_tree *tree = sheet->tree;
    const bool given = thickness > 0 && value_of(sheet, by, 0) > 0;
    if (given && !(lost > 0 && lost < thickness))
        return scene_tree_fail(tree, scene_tree_get(tree, sheet->values, by),
                               "by this %s a fabric that is %g mm thick loses %.3g mm under %g "
                               "gf/cm^2; it should lose more than 0, and less than it has",
                               by, thickness, lost, load);
    return fill_number(sheet, "thickness", thickness / 1000) ||
           (given && fill_number(sheet, "pressure", load * GF_PER_CM2 * (thickness / lost - 1)));
}

static int fill_kes(const struct sheet *sheet)
{
    const double line = value_of(sheet, "LC", 0);
    const double energy = MM_PER_CM * value_of(sheet, "WC", 0);
    const double lost = 2 * energy / (KES_PRESSED * (line > 0 ? line : 1));
    const double bend[2] = {kes_rigidity(sheet, 0), kes_rigidity(sheet, 1)};
    return fill_number(sheet, "density", value_of(sheet, "W", 0) / 100) ||
           fill_curve(sheet, kes_strains) ||
           fill_number(sheet, "shear", mean_of(sheet, "G") * GF_PER_CM * 180 / M_PI) ||
           fill_rigidity(sheet, bend) || fill_damping(sheet) ||
           fill_number(sheet, "friction", mean_of(sheet, "MIU")) ||
           fill_thickness(sheet, value_of(sheet, "T", 0), "WC", lost, KES_PRESSED);
}

static int fill_fast(const struct sheet *sheet)
{
    const double thick = value_of(sheet, "T2", 0), thin = value_of(sheet, "T100", 0);
    const double weight = value_of(sheet, "W", 0), given = mean_of(sheet, "G");
    double bend[2];
    for (size_t i = 0; i < 2; i++)
        bend[i] = value_of(sheet, "B", i) > 0
                      ? 1e-6 * value_of(sheet, "B", i)
                      : FAST_BEND * weight * pow(value_of(sheet, "C", i), 3);
    return fill_number(sheet, "density", weight / 1000) || fill_curve(sheet, fast_strains) ||
           fill_number(sheet, "shear", given > 0 ? given : FAST_SHEAR / mean_of(sheet, "EB5")) ||
           fill_rigidity(sheet, bend) ||
           fill_thickness(sheet, thick, "T100", thick - thin, FAST_PRESSED);
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
