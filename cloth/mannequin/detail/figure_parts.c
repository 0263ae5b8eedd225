/* The shape of the figure: where its parts lie, and their sections. */
#include "cloth/base/vector.h"
#include "cloth/mannequin/detail/figure.h"

#include <string.h>

/* A station as it is written: widths for girths of the table. They are multiplied by the factor of
 * `one`, or by one between it and that of `two`. */
struct drawn_station {
    double t, value[FIGURE_VALUES];
    uint32_t one, two;
    double mix; /* 0: only one, 1: only two */
};

struct drawn_part {
    struct figure_part part;
    struct drawn_station station[FIGURE_STATIONS];
};

enum {
    NECK = MANNEQUIN_NECK,
    CHEST = MANNEQUIN_CHEST,
    WAIST = MANNEQUIN_WAIST,
    HIP = MANNEQUIN_HIP,
    THIGH = MANNEQUIN_THIGH,
    KNEE = MANNEQUIN_KNEE,
    CALF = MANNEQUIN_CALF,
    ANKLE = MANNEQUIN_ANKLE,
    UPPER = MANNEQUIN_UPPER_ARM,
    ELBOW = MANNEQUIN_ELBOW,
    WRIST = MANNEQUIN_WRIST
};
enum { TORSO, YOKE, THROAT, HEAD, LEG, FOOT, ARM, THUMB, PARTS };

/* m: where joints are; along the arm, that of the elbow. */
static const double WAIST_HEIGHT = 1.06, HIP_HEIGHT = 0.88, KNEE_HEIGHT = 0.48;
static const double ANKLE_HEIGHT = 0.085, ELBOW_AT = 0.29;

#define UPRIGHT .side = {1, 0, 0}, .axis = {0, 1, 0}, .front = {0, 0, 1}
/* clang-format off */
static const struct drawn_part DRAWN[PARTS] = {
[TORSO] = {{UPRIGHT, .cap = {0.032, 0.035}, .square = 0.04, .blend = 0.03}, {
    {0.825, {0, -0.010, 0.110, 0.060, 0.080}, HIP, HIP, 0},
    {0.855, {0, -0.004, 0.150, 0.088, 0.122}, HIP, HIP, 0},
    {0.900, {0, 0.000, 0.172, 0.110, 0.144}, HIP, HIP, 0},
    {0.970, {0, 0.002, 0.168, 0.112, 0.130}, HIP, WAIST, 0.4},
    {1.080, {0, 0.004, 0.140, 0.114, 0.108}, WAIST, WAIST, 0},
    {1.180, {0, 0.000, 0.149, 0.126, 0.118}, WAIST, CHEST, 0.5},
    {1.280, {0, -0.004, 0.161, 0.142, 0.130}, CHEST, CHEST, 0},
    {1.350, {0, -0.008, 0.158, 0.118, 0.124}, CHEST, CHEST, 0},
    {1.410, {0, -0.016, 0.132, 0.082, 0.098}, CHEST, CHEST, 0},
    {1.445, {0, -0.022, 0.090, 0.060, 0.072}, CHEST, NECK, 0.5}}},
/* From the neck to the shoulder; its side is up. */
[YOKE] = {{.origin = {0, 1.422, -0.018}, .axis = {0.98480775301220802, -0.17364817766693033, 0},
           .side = {0.17364817766693033, 0.98480775301220802, 0}, .front = {0, 0, 1},
           .cap = {0.03, 0.03}, .blend = 0.04, .paired = true}, {
    {-0.040, {0, 0, 0.060, 0.060, 0.070}, CHEST, CHEST, 0},
    {0.050, {0, 0, 0.055, 0.062, 0.068}, CHEST, CHEST, 0},
    {0.110, {0, 0, 0.048, 0.060, 0.062}, CHEST, CHEST, 0},
    {0.155, {0, 0, 0.046, 0.054, 0.056}, CHEST, UPPER, 0.5}}},
[THROAT] = {{UPRIGHT, .cap = {0.03, 0.03}, .blend = 0.045}, {
    {1.430, {0, -0.026, 0.078, 0.062, 0.066}, NECK, NECK, 0},
    {1.470, {0, -0.022, 0.062, 0.060, 0.062}, NECK, NECK, 0},
    {1.500, {0, -0.016, 0.0575, 0.060, 0.060}, NECK, NECK, 0},
    {1.560, {0, -0.006, 0.055, 0.056, 0.060}, NECK, NECK, 0}}},
[HEAD] = {{UPRIGHT, .cap = {0.030, 0.062}, .square = 0.02, .blend = 0.03}, {
    {1.550, {0, 0.016, 0.042, 0.068, 0.056}, MANNEQUIN_GIRTHS, 0, 0},
    {1.590, {0, 0.013, 0.060, 0.086, 0.080}, MANNEQUIN_GIRTHS, 0, 0},
    {1.640, {0, 0.008, 0.074, 0.094, 0.098}, MANNEQUIN_GIRTHS, 0, 0},
    {1.688, {0, 0.003, 0.075, 0.088, 0.098}, MANNEQUIN_GIRTHS, 0, 0}}},
[LEG] = {{UPRIGHT, .cap = {0.03, 0.06}, .square = 0.02, .blend = 0.070, .paired = true}, {
    {0.060, {0.146, -0.026, 0.034, 0.042, 0.040}, ANKLE, ANKLE, 0},
    {0.100, {0.144, -0.026, 0.0335, 0.041, 0.042}, ANKLE, ANKLE, 0},
    {0.160, {0.141, -0.026, 0.038, 0.043, 0.046}, ANKLE, CALF, 0.4},
    {0.250, {0.137, -0.024, 0.050, 0.050, 0.060}, CALF, CALF, 0},
    {0.330, {0.133, -0.020, 0.0555, 0.054, 0.066}, CALF, CALF, 0},
    {0.410, {0.128, -0.010, 0.0555, 0.058, 0.062}, CALF, KNEE, 0.6},
    {0.480, {0.122, -0.002, 0.0580, 0.065, 0.062}, KNEE, KNEE, 0},
    {0.560, {0.116, 0.004, 0.0655, 0.072, 0.070}, KNEE, THIGH, 0.4},
    {0.660, {0.107, 0.004, 0.0760, 0.086, 0.084}, THIGH, THIGH, 0},
    {0.765, {0.099, 0.000, 0.0830, 0.096, 0.098}, THIGH, THIGH, 0},
    {0.860, {0.092, -0.006, 0.0800, 0.092, 0.104}, THIGH, THIGH, 0}}},
/* Along the foot from below the ankle; its front is up. */
[FOOT] = {{.origin = {0.145, 0.020, -0.030}, .axis = {0.12186934340514748, 0, 0.992546151641322},
           .side = {0.992546151641322, 0, -0.12186934340514748}, .front = {0, 1, 0},
           .cap = {0.022, 0.030}, .square = 0.06, .blend = 0.025, .paired = true}, {
    {-0.030, {0, 0, 0.030, 0.052, 0.032}, MANNEQUIN_GIRTHS, 0, 0},
    {0.010, {0, 0, 0.034, 0.066, 0.032}, MANNEQUIN_GIRTHS, 0, 0},
    {0.060, {0.001, 0, 0.036, 0.052, 0.032}, MANNEQUIN_GIRTHS, 0, 0},
    {0.110, {0.002, 0, 0.043, 0.032, 0.032}, MANNEQUIN_GIRTHS, 0, 0},
    {0.155, {0.000, 0, 0.042, 0.020, 0.032}, MANNEQUIN_GIRTHS, 0, 0}}},
/* From the shoulder, 45 degrees down; its side is up and outwards. */
[ARM] = {{.origin = {0.166, 1.388, -0.016}, .axis = {0.7071067811865476, -0.7071067811865476, 0},
          .side = {0.7071067811865476, 0.7071067811865476, 0}, .front = {0, 0, 1},
          .cap = {0.045, 0.024}, .square = 0.02, .blend = 0.045, .paired = true}, {
    {0.000, {0, 0, 0.058, 0.058, 0.060}, UPPER, UPPER, 0},
    {0.060, {0, 0, 0.054, 0.056, 0.056}, UPPER, UPPER, 0},
    {0.170, {0, 0, 0.0465, 0.048, 0.048}, UPPER, UPPER, 0},
    {0.240, {0, 0.001, 0.0425, 0.044, 0.044}, UPPER, ELBOW, 0.5},
    {0.290, {0, 0.002, 0.0395, 0.042, 0.042}, ELBOW, ELBOW, 0},
    {0.350, {0, 0.006, 0.0395, 0.043, 0.042}, ELBOW, ELBOW, 0},
    {0.450, {0, 0.014, 0.0310, 0.035, 0.034}, ELBOW, WRIST, 0.5},
    {0.545, {0, 0.022, 0.0245, 0.0290, 0.0290}, WRIST, WRIST, 0},
    {0.580, {0, 0.025, 0.0230, 0.034, 0.033}, WRIST, WRIST, 0},
    {0.630, {-0.002, 0.028, 0.0215, 0.040, 0.038}, WRIST, WRIST, 0},
    {0.680, {-0.006, 0.029, 0.0195, 0.038, 0.036}, WRIST, WRIST, 0},
    {0.712, {-0.009, 0.029, 0.0175, 0.030, 0.029}, WRIST, WRIST, 0}}},
/* From the palm; its place is along the arm's axes, see place_thumb. */
[THUMB] = {{.cap = {0.015, 0.014}, .blend = 0.025, .paired = true}, {
    {0.000, {0, 0, 0.0165, 0.0165, 0.0165}, MANNEQUIN_GIRTHS, 0, 0},
    {0.045, {0, 0, 0.0145, 0.0145, 0.0145}, MANNEQUIN_GIRTHS, 0, 0},
    {0.072, {0, 0, 0.0130, 0.0130, 0.0130}, MANNEQUIN_GIRTHS, 0, 0}}},
};
/* clang-format on */

/* ---- Factors ---- */

static double factor_of(const struct drawn_station *drawn, const double *factor)
{
    if (drawn->one == MANNEQUIN_GIRTHS)
        return 1;
    return factor[drawn->one] + drawn->mix * (factor[drawn->two] - factor[drawn->one]);
}

/* Thighs grow outwards and not towards each other, and stay below hips that are wide. */
static double shift_of_leg(const struct drawn_station *drawn, const double *factor)
{
    const double up = fmin(1, fmax(0, (drawn->t - 0.40) / 0.35));
    return up * up * (3 - 2 * up) *
           (drawn->value[2] * fmax(0, factor_of(drawn, factor) - 1) +
            0.05 * fmax(0, factor[HIP] - 1));
}

/* Shoulders lie beside the chest. An arm that is thicker is further out. */
static double shift_of_arm(const double *factor)
{
    return 0.15 * (factor[CHEST] - 1) + 0.05 * fmax(0, factor[UPPER] - 1);
}

/* ---- Parts ---- */

/* Slopes of Catmull and Rom; none at both ends, where the round ends begin. */
static void find_slopes(struct figure_part *part)
{
    for (uint32_t k = 1; k + 1 < part->n; k++) {
        const struct figure_station *before = &part->station[k - 1];
        struct figure_station *here = &part->station[k];
        const double width = here[1].t - before->t;
        for (int i = 0; i < FIGURE_VALUES; i++)
            here->slope[i] = (here[1].value[i] - before->value[i]) / width;
    }
}

/* A box around the boxes of all stations; its margin is more than curves overshoot. */
static void figure_parts_find_box(struct figure_part *part)
{
    static const double margin = 0.015;
    const double *const direction[2] = {part->side, part->front};
    for (int c = 0; c < 3; c++) {
        part->low[c] = INFINITY;
        part->high[c] = -INFINITY;
    }
    for (uint32_t k = 0; k < part->n; k++) {
        const struct figure_station *s = &part->station[k];
        const double cap = k == 0 ? -part->cap[0] : k + 1 == part->n ? part->cap[1] : 0;
        const double wide[2] = {s->value[2], fmax(s->value[3], s->value[4])};
        for (int c = 0; c < 3; c++) {
            double middle = part->origin[c] + part->axis[c] * (s->t + cap), reach = margin;
            for (int i = 0; i < 2; i++) {
                middle += direction[i][c] * s->value[i];
                reach += fabs(direction[i][c]) * wide[i];
            }
            part->low[c] = fmin(part->low[c], middle - reach);
            part->high[c] = fmax(part->high[c], middle + reach);
        }
    }
}

static void make_part(struct figure_part *part, const struct drawn_part *drawn,
                      const double *factor, bool leg)
{
    *part = drawn->part;
    while (part->n < FIGURE_STATIONS && drawn->station[part->n].value[2] > 0) {
        const struct drawn_station *from = &drawn->station[part->n];
        struct figure_station *to = &part->station[part->n++];
        *to = (struct figure_station){.t = from->t};
        for (int i = 0; i < FIGURE_VALUES; i++)
            to->value[i] = from->value[i] * (i < 2 ? 1 : factor_of(from, factor));
        if (leg)
            to->value[0] += shift_of_leg(from, factor);
    }
}

/* Forwards and to the fingertips, beside the palm. */
static void place_thumb(struct figure_part *thumb, const struct figure_part *arm)
{
    for (int c = 0; c < 3; c++) {
        thumb->origin[c] =
            arm->origin[c] + 0.572 * arm->axis[c] - 0.004 * arm->side[c] + 0.034 * arm->front[c];
        thumb->axis[c] = 0.8 * arm->axis[c] + 0.6 * arm->front[c];
        thumb->front[c] = 0.8 * arm->front[c] - 0.6 * arm->axis[c];
        thumb->side[c] = arm->side[c];
    }
}

void figure_make(struct figure *figure, const double factor[MANNEQUIN_GIRTHS])
{
    figure->n = PARTS;
    for (uint32_t i = 0; i < PARTS; i++)
        make_part(&figure->part[i], &DRAWN[i], factor, i == LEG);
    figure->part[ARM].origin[0] += shift_of_arm(factor);
    figure->part[YOKE].origin[0] += shift_of_arm(factor);
    place_thumb(&figure->part[THUMB], &figure->part[ARM]);
    for (uint32_t i = 0; i < PARTS; i++) {
        find_slopes(&figure->part[i]);
        figure_parts_find_box(&figure->part[i]);
    }
}

void figure_section(const struct figure *figure, uint32_t measure, double point[3],
                    double normal[3])
{
    const struct figure_part *arm = &figure->part[ARM], *leg = &figure->part[LEG];
    const double at = mannequin_measures[measure].at;
    const bool of_arm = measure >= MANNEQUIN_UPPER_ARM;
    const bool of_leg = measure >= MANNEQUIN_THIGH && !of_arm;
    uint32_t k = 0;
    while (of_leg && k + 1 < leg->n && leg->station[k].t < at)
        k++;
    for (int c = 0; c < 3; c++) {
        point[c] = of_arm ? arm->origin[c] + at * arm->axis[c] : c == 1 ? at : 0;
        normal[c] = of_arm ? arm->axis[c] : c == 1;
    }
    if (of_leg)
        point[0] = leg->station[k].value[0];
}

enum figure_bone figure_bone(const struct figure *figure, const double x[3])
{
    const struct figure_part *arm = &figure->part[ARM];
    const double *origin = arm->origin;
    const double from[3] = {fabs(x[0]) - origin[0], x[1] - origin[1], x[2] - origin[2]};
    const double along = cloth_dot(from, arm->axis);
    switch (figure_near(figure, x).part) {
    case TORSO:
        return x[1] < WAIST_HEIGHT ? FIGURE_PELVIS : FIGURE_CHEST;
    case LEG:
        return x[1] > KNEE_HEIGHT ? FIGURE_THIGH : x[1] > ANKLE_HEIGHT ? FIGURE_SHIN : FIGURE_FOOT;
    case FOOT:
        return FIGURE_FOOT;
    case ARM:
        return along < ELBOW_AT ? FIGURE_UPPER_ARM : FIGURE_FOREARM;
    case THUMB:
        return FIGURE_FOREARM;
    default:
        return FIGURE_CHEST;
    }
}

/* The middle of the leg at a height. */
static void place_in_leg(const struct figure_part *leg, double height, double joint[3])
{
    uint32_t k = 0;
    while (k + 2 < leg->n && leg->station[k + 1].t < height)
        k++;
    const struct figure_station *a = &leg->station[k], *b = a + 1;
    const double part = fmin(1, (height - a->t) / (b->t - a->t));
    joint[0] = a->value[0] + part * (b->value[0] - a->value[0]);
    joint[1] = height;
    joint[2] = a->value[1] + part * (b->value[1] - a->value[1]);
}

void figure_joint(const struct figure *figure, enum figure_bone bone, double joint[3])
{
    const struct figure_part *arm = &figure->part[ARM];
    const double along = bone == FIGURE_FOREARM ? ELBOW_AT : 0;
    if (bone == FIGURE_UPPER_ARM || bone == FIGURE_FOREARM) {
        for (int c = 0; c < 3; c++)
            joint[c] = arm->origin[c] + along * arm->axis[c];
    } else if (bone == FIGURE_CHEST) {
        memcpy(joint, (const double[3]){0, WAIST_HEIGHT, -0.03}, 3 * sizeof *joint);
    } else {
        place_in_leg(&figure->part[LEG],
                     bone == FIGURE_THIGH  ? HIP_HEIGHT
                     : bone == FIGURE_SHIN ? KNEE_HEIGHT
                                           : ANKLE_HEIGHT,
                     joint);
    }
}
