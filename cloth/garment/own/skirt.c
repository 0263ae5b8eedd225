/* A skirt. Its panels' upper edges are longer than the waistband, to which they are gathered. The
 * hem is an arc that meets the side seams at right angles, so that it hangs level. */
#include "cloth/garment/own/draw.h"

#include <math.h>

enum { HEIGHT, WAIST, HIP, EASE, GATHER, LENGTH, HEM, BAND, APART };
const struct garment_measure draw_skirt_measures[] = {
    [HEIGHT] = {"height", 1.75, 0, 1, 2.3,
                "how tall the body is that wears it; it says where the panels start"},
    [WAIST] = {"waist", 0.84, 0.045, 0.4, 1.7, "the girth of the body's waist"},
    [HIP] = {"hip", 1, 0.045, 0.5, 1.8, "the girth of the body's hips"},
    [EASE] = {"ease", 0.04, 0, 0, 0.6,
              "how much wider the skirt is than the hips; than the waist it is half of that"},
    [GATHER] = {"gather", 1.15, 0, 1, 1.6,
                "how much longer the panels are than the waistband: a ratio"},
    [LENGTH] = {"length", 0.55, 0.01, 0.25, 1.2, "from the waistband's top down to the hem"},
    [HEM] = {"hem", 1.6, 0.05, 0.5, 4, "how wide the skirt is at its hem"},
    [BAND] = {"band", 0.04, 0, 0.015, 0.1, "the waistband's height"},
    [APART] = {"apart", 0.34, 0.01, 0.1, 1, "how far front and back start from each other"},
    {0}};

enum { BOTTOM, LOWER_SIDE, UPPER_SIDE, TOP, OTHER_UPPER, OTHER_LOWER };
enum { BAND_BOTTOM, BAND_SIDE, BAND_TOP, BAND_OTHER };

/* Half widths of a panel, and how long it is to the hips and to the hem, m. */
struct panel {
    double waist, top, hip, hem, depth, length;
};

static int skirt_check(struct draw *draw, const struct panel *panel, const double *value)
{
    const double out = panel->length - panel->depth;
    const int code = draw_check_waist(draw, value[WAIST], value[HIP]);
    if (code)
        return code;
    if (panel->hem < 0.7 * panel->hip)
        return DRAW_FAIL(draw,
                         "a hem of %g m is too narrow for hips of %g m; hem has to be at least %g",
                         value[HEM], value[HIP], 4 * 0.7 * panel->hip);
    if (panel->hem > panel->hip + 1.5 * out)
        return DRAW_FAIL(draw,
                         "a hem of %g m is too wide for a skirt of %g m length; hem has to be at "
                         "most %g",
                         value[HEM], value[LENGTH], 4 * (panel->hip + 1.5 * out));
    return CLOTH_OK;
}

/* The sides go on below the hips as they arrive there, and bend out to the hem: the control point
 * of this part. */
static void flare_of(const struct panel *panel, double control[2])
{
    const double down = 0.3 * (panel->length - panel->depth);
    control[0] = panel->hip + 0.4 * (panel->hip - panel->top) * down / panel->depth;
    control[1] = -panel->depth - down;
}

/* The whole panel. Its hem is lower in the middle than at its ends, but straight where the sides do
 * not flare. */
static struct draw_outline draw_half(const struct panel *panel)
{
    double control[2];
    flare_of(panel, control);
    const double out = panel->hem - control[0], down = panel->length + control[1];
    const double sine = out / sqrt(out * out + down * down);
    const bool arc = sine > 0.02;
    struct draw_outline outline = {
        .n = TOP + 1,
        .line = {[BOTTOM] = {.curve = arc ? GARMENT_CIRCLE : GARMENT_STRAIGHT,
                             .radius = arc ? panel->hem / sine : 0},
                 [LOWER_SIDE] = {{panel->hem, -panel->length},
                                 GARMENT_QUADRATIC,
                                 {{control[0], control[1]}},
                                 0},
                 [UPPER_SIDE] = {{panel->hip, -panel->depth},
                                 GARMENT_QUADRATIC,
                                 {{0.8 * panel->hip + 0.2 * panel->top, -0.5 * panel->depth}},
                                 0},
                 [TOP] = {{panel->top, 0}, GARMENT_QUADRATIC, {{0, -0.02}}, 0}}};
    draw_unfold(&outline);
    return outline;
}

void draw_skirt(struct draw *draw, const double *value)
{
    const double scale = value[HEIGHT] / 1.75, waist = 0.25 * (value[WAIST] + 0.5 * value[EASE]);
    const double top = value[GATHER] * waist, length = value[LENGTH] - value[BAND];
    const struct panel shape = {waist,
                                top,
                                fmax(0.25 * (value[HIP] + value[EASE]), top),
                                0.25 * value[HEM],
                                fmin(0.16 * scale, 0.5 * length),
                                length};
    struct draw_outline strip = {
        .n = BAND_TOP + 1,
        .line = {
            [BAND_SIDE] = {.corner = {waist, 0}}, [BAND_TOP] = {.corner = {waist, value[BAND]}}}};
    uint32_t panel[2], band[2];
    draw->code = skirt_check(draw, &shape, value);
    if (draw->code)
        return;
    const struct draw_outline outline = draw_half(&shape);
    draw_unfold(&strip);
    for (int back = 0; back < 2; back++) {
        struct draw_place place = {
            .back = back, .y = 1.1 * scale - value[BAND], .z = draw_apart(back, value[APART])};
        panel[back] = draw_panel(draw, back ? "back" : "front", &outline, &place);
        place.y += 0.02;
        band[back] = draw_panel(draw, back ? "band_back" : "band_front", &strip, &place);
        draw_sew(draw, panel[back], TOP, band[back], BAND_BOTTOM);
    }
    for (uint32_t side = LOWER_SIDE; side <= OTHER_LOWER; side++)
        if (side != TOP)
            draw_sew(draw, panel[0], side, panel[1], side);
    draw_sew(draw, band[0], BAND_SIDE, band[1], BAND_SIDE);
    draw_sew(draw, band[0], BAND_OTHER, band[1], BAND_OTHER);
}
