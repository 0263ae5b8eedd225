/* A T-shirt. Front and back have the same armholes, and both halves of a sleeve the same cap, which
 * is as high as its length needs to be the armhole's. */
#include "cloth/garment/own/draw.h"

#include <math.h>

enum { HEIGHT, CHEST, EASE, SHOULDERS, NECK, LENGTH, ARMHOLE, ARM, SLEEVE, APART };
const struct garment_measure draw_tshirt_measures[] = {
    [HEIGHT] = {"height", 1.75, 0, 1, 2.3,
                "how tall the body is that wears it; it says where the panels start"},
    [CHEST] = {"chest", 0.98, 0.05, 0.5, 1.8, "the girth of the body's chest"},
    [EASE] = {"ease", 0.1, 0, 0, 0.6, "how much wider the shirt is than chest and upper arm"},
    [SHOULDERS] = {"shoulders", 0.4, 0.012, 0.2, 0.7, "from one shoulder point to the other"},
    [NECK] = {"neck", 0.38, 0.01, 0.2, 0.7, "the girth of the body's neck"},
    [LENGTH] = {"length", 0.66, 0.015, 0.2, 1.3, "from the neck down to the hem"},
    [ARMHOLE] = {"armhole", 0.23, 0.008, 0.1, 0.45,
                 "from the shoulder down to the armhole's bottom"},
    [ARM] = {"arm", 0.3, 0.014, 0.15, 0.7, "the girth of the body's upper arm"},
    [SLEEVE] = {"sleeve", 0.22, 0.005, 0.05, 0.8, "from the shoulder to the sleeve's hem"},
    [APART] = {"apart", 0.34, 0.01, 0.1, 1, "how far front and back start from each other"},
    {0}};

enum { HEM, SIDE, HOLE, SHOULDER, TOP, OTHER_SHOULDER, OTHER_HOLE, OTHER_SIDE };
enum { UNDERARM, CUFF, OVERARM, CAP };

static const double DIAGONAL = 0.70710678118654752; /* the arms hang at 45 degrees */
static const double LEAST_UNDERARM = 0.02;          /* m */

/* Half measures, m; the neck point, where shoulder and neckline meet, is at y = 0. */
struct shirt {
    double chest, shoulder, neck, drop; /* drop: how much lower the shoulder point is */
    double bottom;                      /* y of the armhole's bottom */
    double sleeve, cap;                 /* the sleeve's width, and how high its cap is */
    double scale;                       /* of the body, to the one for which places are given */
};

static int tshirt_check(struct draw *draw, const struct shirt *shirt, const double *value)
{
    const double length = shirt->drop + value[ARMHOLE] + 0.05;
    if (shirt->shoulder < shirt->neck + 0.03)
        return DRAW_FAIL(draw,
                         "shoulders of %g m are too narrow for a neck of %g m; shoulders have to "
                         "be at least %g",
                         value[SHOULDERS], value[NECK], 2 * (shirt->neck + 0.02));
    if (shirt->chest < shirt->shoulder + 0.01)
        return DRAW_FAIL(draw,
                         "a chest of %g m with an ease of %g m is too narrow for shoulders of %g "
                         "m; chest has to be at least %g",
                         value[CHEST], value[EASE], value[SHOULDERS],
                         4 * (shirt->shoulder + 0.01) - value[EASE]);
    if (shirt->chest > shirt->shoulder + 0.6 * value[ARMHOLE])
        return DRAW_FAIL(draw,
                         "a chest of %g m with an ease of %g m is too wide for shoulders of %g m "
                         "and an armhole of %g m; chest has to be at most %g",
                         value[CHEST], value[EASE], value[SHOULDERS], value[ARMHOLE],
                         4 * (shirt->shoulder + 0.6 * value[ARMHOLE]) - value[EASE]);
    if (value[LENGTH] < length)
        return DRAW_FAIL(draw,
                         "a length of %g m ends above the armholes; length has to be at least %g",
                         value[LENGTH], length);
    return CLOTH_OK;
}

/* A half of the body, unfolded; depth: of the neckline. */
static struct draw_outline draw_body(const struct shirt *shirt, double length, double depth,
                                     double round)
{
    const double hole = -shirt->drop - shirt->bottom, edge = shirt->shoulder;
    struct draw_outline outline = {
        .n = TOP + 1,
        .line = {
            [SIDE] = {.corner = {shirt->chest, -length}},
            [HOLE] = {{shirt->chest, shirt->bottom},
                      GARMENT_CUBIC,
                      {{edge - 0.07 * edge, shirt->bottom},
                       {edge - 0.14 * edge, shirt->bottom + 0.5 * hole}},
                      0},
            [SHOULDER] = {.corner = {edge, -shirt->drop}},
            [TOP] = {{shirt->neck, 0},
                     GARMENT_CUBIC,
                     {{round * shirt->neck, -depth / 0.75}, {-round * shirt->neck, -depth / 0.75}},
                     0}}};
    draw_unfold(&outline);
    return outline;
}

/* A half of a sleeve, x along the arm from the cap's top on, y = 0 in its middle. */
static struct draw_outline draw_sleeve(const struct shirt *shirt, double length)
{
    const double half = 0.5 * shirt->sleeve, cuff = 0.9 * shirt->sleeve;
    return (struct draw_outline){
        .n = CAP + 1,
        .line = {
            [UNDERARM] = {.corner = {shirt->cap, -half}},
            [CUFF] = {.corner = {length, half - cuff}},
            [OVERARM] = {.corner = {length, half}},
            [CAP] = {{0, half}, GARMENT_CUBIC, {{0, 0.1 * half}, {shirt->cap, -0.1 * half}}, 0}}};
}

/* True if a cap of this height is longer than the armhole, m. */
static bool is_longer(struct shirt *shirt, double cap, double sleeve, double hole)
{
    shirt->cap = cap;
    const struct draw_outline outline = draw_sleeve(shirt, sleeve);
    return draw_length(&outline, CAP) > hole;
}

/* Finds the height of the cap by halving. hole: the armhole's length, m. */
static int fit_cap(struct draw *draw, struct shirt *shirt, const double *value, double hole)
{
    double low = 0.02, high = hole;
    if (is_longer(shirt, low, value[SLEEVE], hole))
        return DRAW_FAIL(draw,
                         "an armhole of %g m is too small for a sleeve of %g m, the girth of arm "
                         "and ease: a larger armhole or a smaller arm is needed",
                         value[ARMHOLE], value[ARM] + value[EASE]);
    for (int i = 0; i < 60; i++) {
        const double cap = 0.5 * (low + high);
        if (is_longer(shirt, cap, value[SLEEVE], hole))
            high = cap;
        else
            low = cap;
    }
    if (value[SLEEVE] < shirt->cap + LEAST_UNDERARM)
        return DRAW_FAIL(draw,
                         "a sleeve of %g m ends above the armhole's bottom; sleeve has to be at "
                         "least %g",
                         value[SLEEVE], shirt->cap + LEAST_UNDERARM);
    return CLOTH_OK;
}

/* Sleeves start so far along the arm that they are beside the body's panels. */
static void sew_sleeve(struct draw *draw, const struct shirt *shirt, const double *value,
                       const uint32_t body[2], bool right)
{
    static const char *const name[2][2] = {{"left_sleeve_front", "left_sleeve_back"},
                                           {"right_sleeve_front", "right_sleeve_back"}};
    const double x = 0.19 * shirt->scale, y = 1.4 * shirt->scale; /* where the arm begins */
    const double beside = (shirt->chest + 0.02 - x) / DIAGONAL + 0.5 * shirt->sleeve - shirt->cap;
    const double along = fmax(beside, 0.03) * DIAGONAL;
    const struct draw_outline outline = draw_sleeve(shirt, value[SLEEVE]);
    uint32_t half[2];
    for (int back = 0; back < 2; back++) {
        const struct draw_place place = {right,     back,      45,
                                         x + along, y - along, (back ? -0.3 : 0.3) * value[APART]};
        half[back] = draw_panel(draw, name[right][back], &outline, &place);
        draw_sew(draw, body[back], right ? OTHER_HOLE : HOLE, half[back], CAP);
    }
    draw_sew(draw, half[0], OVERARM, half[1], OVERARM);
    draw_sew(draw, half[0], UNDERARM, half[1], UNDERARM);
}

static void draw_all(struct draw *draw, struct shirt *shirt, const double *value)
{
    const struct draw_outline outline[2] = {
        draw_body(shirt, value[LENGTH], value[NECK] / 6 + 0.03, 0.95),
        draw_body(shirt, value[LENGTH], 0.025, 0.6)};
    uint32_t body[2];
    draw->code = fit_cap(draw, shirt, value, draw_length(&outline[0], HOLE));
    for (int back = 0; back < 2; back++) {
        const struct draw_place place = {
            .back = back, .y = 1.51 * shirt->scale, .z = draw_apart(back, value[APART])};
        body[back] = draw_panel(draw, back ? "back" : "front", &outline[back], &place);
    }
    static const uint32_t seams[4] = {SIDE, OTHER_SIDE, SHOULDER, OTHER_SHOULDER};
    for (int i = 0; i < 4; i++)
        draw_sew(draw, body[0], seams[i], body[1], seams[i]);
    sew_sleeve(draw, shirt, value, body, false);
    sew_sleeve(draw, shirt, value, body, true);
}

void draw_tshirt(struct draw *draw, const double *value)
{
    struct shirt shirt = {.chest = 0.25 * (value[CHEST] + value[EASE]),
                          .shoulder = 0.5 * value[SHOULDERS] + 0.01,
                          .neck = 0.2 * value[NECK] + 0.015,
                          .sleeve = 0.5 * (value[ARM] + value[EASE]),
                          .scale = value[HEIGHT] / 1.75};
    shirt.drop = 0.35 * (shirt.shoulder - shirt.neck);
    shirt.bottom = -shirt.drop - value[ARMHOLE];
    draw->code = tshirt_check(draw, &shirt, value);
    if (!draw->code)
        draw_all(draw, &shirt, value);
}
