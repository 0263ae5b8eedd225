/* Trousers. A leg's panel is drawn from the crotch's tip, x away from the body's middle. Back
 * panels are wider than front ones, at the crotch most, and higher in the middle, as a body needs
 * to sit. */
#include "cloth/garment/own/draw.h"

#include <math.h>

enum { HEIGHT, WAIST, HIP, EASE, RISE, INSEAM, KNEE, HEM, BAND, APART };
const struct garment_measure draw_trousers_measures[] = {
    [HEIGHT] = {"height", 1.75, 0, 1, 2.3,
                "how tall the body is that wears them; it says where the panels start"},
    [WAIST] = {"waist", 0.84, 0.045, 0.4, 1.7, "the girth of the body's waist"},
    [HIP] = {"hip", 1, 0.045, 0.5, 1.8, "the girth of the body's hips"},
    [EASE] = {"ease", 0.04, 0, 0, 0.4,
              "how much wider the trousers are than the hips; than the waist it is half of that"},
    [RISE] = {"rise", 0.31, 0.006, 0.16, 0.5, "from the crotch up to the waistband's top"},
    [INSEAM] = {"inseam", 0.7, 0, 0.08, 1.1, "from the crotch down to the hem"},
    [KNEE] = {"knee", 0.46, 0.014, 0.25, 1, "how wide a leg of the trousers is at the knee"},
    [HEM] = {"hem", 0.4, 0.01, 0.2, 1.2, "how wide a leg of the trousers is at the hem"},
    [BAND] = {"band", 0.04, 0, 0.015, 0.06, "the waistband's height"},
    [APART] = {"apart", 0.34, 0.01, 0.1, 1, "how far front and back start from each other"},
    {0}};

enum { CUFF, CALF, THIGH, HIP_SIDE, TOP, CROTCH, INNER_THIGH, INNER_CALF };
enum { SEAMS = 5 }; /* of front to back, in a leg */
enum { BAND_RIGHT, BAND_LEFT, BAND_SIDE, BAND_TOP, BAND_OTHER_SIDE };

static const double GAP = 0.01;      /* m: from the body's middle to the crotch's tip */
static const double KNEE_AT = 0.45;  /* of the inseam */
static const double STEEPEST = 0.25; /* m a m: how fast a leg narrows on each side */

/* One of the four panels, m. */
struct leg {
    double fork, hip, waist; /* how far the crotch goes beyond the middle; then widths */
    double knee, hem, raise; /* widths; how much higher the middle is than the side */
    double top, middle;      /* y of the waist's side; x of the crease */
    double side, centre;     /* how much narrower the waist is, at the side and in the middle */
};

static struct leg leg_of(const double *value, bool back)
{
    const double sign = back ? 1 : -1, hip = 0.25 * (value[HIP] + value[EASE]);
    struct leg leg = {.fork = (back ? 0.07 : 0.038) * value[HIP],
                      .hip = hip + sign * 0.005,
                      .waist = 0.25 * (value[WAIST] + 0.5 * value[EASE]),
                      .knee = 0.5 * value[KNEE] + sign * 0.01,
                      .hem = 0.5 * value[HEM] + sign * 0.01,
                      .raise = back ? 0.02 : -0.01,
                      .top = value[RISE] - value[BAND]};
    leg.middle = 0.5 * (leg.fork + leg.hip);
    leg.side = 0.7 * (hip - leg.waist); /* as much before as behind */
    leg.centre = leg.hip - leg.waist - leg.side;
    return leg;
}

static struct draw_outline draw_leg(const struct leg *leg, double inseam)
{
    const double knee = -KNEE_AT * inseam, side = leg->fork + leg->hip, top = leg->top;
    const double inner = leg->middle - 0.5 * leg->knee, outer = leg->middle + 0.5 * leg->knee;
    return (struct draw_outline){
        .n = INNER_CALF + 1,
        .line = {[CUFF] = {.corner = {leg->middle - 0.5 * leg->hem, -inseam}},
                 [CALF] = {.corner = {leg->middle + 0.5 * leg->hem, -inseam}},
                 [THIGH] = {{outer, knee}, GARMENT_QUADRATIC, {{side, 0.3 * knee}}, 0},
                 [HIP_SIDE] = {{side, 0.36 * top}, GARMENT_QUADRATIC, {{side, 0.6 * top}}, 0},
                 [TOP] = {.corner = {side - leg->side, top}},
                 [CROTCH] = {{leg->fork + leg->centre, top + leg->raise},
                             GARMENT_CUBIC,
                             {{leg->fork + 0.2 * leg->centre, 0.4 * top}, {leg->fork, 0}},
                             0},
                 [INNER_THIGH] = {{0, 0}, GARMENT_QUADRATIC, {{0.6 * inner, 0.3 * knee}}, 0},
                 [INNER_CALF] = {.corner = {inner, knee}}}};
}

/* The leg's width `below` the crotch, m, is between what narrows too fast, which would make front
 * and back of different lengths, and the thigh's. */
static int check_width(struct draw *draw, const double *value, int measure, double below)
{
    const struct leg front = leg_of(value, false), back = leg_of(value, true);
    const double most = 2 * (front.fork + front.hip + 0.01);
    const double least = 2 * (back.fork + back.hip - 0.01 - 2 * STEEPEST * below);
    if (value[measure] >= least && value[measure] <= most)
        return CLOTH_OK;
    return DRAW_FAIL(draw,
                     "a leg of %g m at the %s does not go with a hip of %g m and an inseam of %g "
                     "m; %s has to be %g to %g",
                     value[measure], draw_trousers_measures[measure].name, value[HIP],
                     value[INSEAM], draw_trousers_measures[measure].name, fmax(least, 0), most);
}

/* The waistband's half; `waist`: the line that it is sewn to on either side, m. */
static uint32_t put_band(struct draw *draw, const double *value, double waist, bool back)
{
    const double y = value[HEIGHT] / 1.75 * 0.79 + value[RISE] - value[BAND] + 0.035;
    const struct draw_place place = {.back = back, .y = y, .z = draw_apart(back, value[APART])};
    const struct draw_outline outline = {
        .n = BAND_OTHER_SIDE + 1,
        .line = {[BAND_RIGHT] = {.corner = {-waist, 0}},
                 [BAND_LEFT] = {.corner = {0, 0}},
                 [BAND_SIDE] = {.corner = {waist, 0}},
                 [BAND_TOP] = {.corner = {waist, value[BAND]}},
                 [BAND_OTHER_SIDE] = {.corner = {-waist, value[BAND]}}}};
    return draw_panel(draw, back ? "band_back" : "band_front", &outline, &place);
}

/* Both legs before or behind the body, and their half of the band; leg: left, right, band. */
static void put_half(struct draw *draw, const double *value, bool back, uint32_t leg[3])
{
    static const char *const name[2][2] = {{"left_front", "right_front"},
                                           {"left_back", "right_back"}};
    const struct leg shape = leg_of(value, back);
    const struct draw_outline outline = draw_leg(&shape, value[INSEAM]);
    for (int right = 0; right < 2; right++) {
        const struct draw_place place = {.right = right,
                                         .back = back,
                                         .x = GAP,
                                         .y = value[HEIGHT] / 1.75 * 0.79,
                                         .z = draw_apart(back, value[APART])};
        leg[right] = draw_panel(draw, name[back][right], &outline, &place);
    }
    leg[2] = put_band(draw, value, draw_length(&outline, TOP), back);
    draw_sew(draw, leg[0], CROTCH, leg[1], CROTCH);
    draw_sew(draw, leg[0], TOP, leg[2], BAND_LEFT);
    draw_sew(draw, leg[1], TOP, leg[2], BAND_RIGHT);
}

void draw_trousers(struct draw *draw, const double *value)
{
    static const uint32_t seams[SEAMS] = {CALF, THIGH, HIP_SIDE, INNER_THIGH, INNER_CALF};
    uint32_t front[3], back[3];
    int code = check_width(draw, value, KNEE, KNEE_AT * value[INSEAM]);
    code = code ? code : draw_check_waist(draw, value[WAIST], value[HIP]);
    draw->code = code ? code : check_width(draw, value, HEM, value[INSEAM]);
    if (draw->code)
        return;
    put_half(draw, value, false, front);
    put_half(draw, value, true, back);
    for (int right = 0; right < 2; right++)
        for (int i = 0; i < SEAMS; i++)
            draw_sew(draw, front[right], seams[i], back[right], seams[i]);
    draw_sew(draw, front[2], BAND_SIDE, back[2], BAND_SIDE);
    draw_sew(draw, front[2], BAND_OTHER_SIDE, back[2], BAND_OTHER_SIDE);
}
