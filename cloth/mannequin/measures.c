/* The measures of figures, and the errors that name them. */
#include "cloth/mannequin/mannequin.h"

#include <string.h>

const struct mannequin_measure mannequin_measures[MANNEQUIN_GIRTHS] = {
    [MANNEQUIN_NECK] = {"neck", 0.38, 0.33, 0.46, 1.50, "level, 1.50 m high"},
    [MANNEQUIN_CHEST] = {"chest", 0.98, 0.82, 1.28, 1.28, "level, 1.28 m high"},
    [MANNEQUIN_WAIST] = {"waist", 0.84, 0.65, 1.20, 1.08, "level, 1.08 m high"},
    [MANNEQUIN_HIP] = {"hip", 1.00, 0.84, 1.30, 0.90, "level, 0.90 m high"},
    [MANNEQUIN_THIGH] = {"thigh", 0.57, 0.47, 0.72, 0.765, "level, 0.765 m high"},
    [MANNEQUIN_KNEE] = {"knee", 0.39, 0.33, 0.48, 0.48, "level, 0.48 m high"},
    [MANNEQUIN_CALF] = {"calf", 0.37, 0.31, 0.47, 0.33, "level, 0.33 m high"},
    [MANNEQUIN_ANKLE] = {"ankle", 0.24, 0.21, 0.28, 0.10, "level, 0.10 m high"},
    [MANNEQUIN_UPPER_ARM] = {"upper_arm", 0.30, 0.25, 0.39, 0.17, "across the arm, 0.17 m along"},
    [MANNEQUIN_ELBOW] = {"elbow", 0.26, 0.22, 0.32, 0.29, "across the arm, 0.29 m along"},
    [MANNEQUIN_WRIST] = {"wrist", 0.17, 0.15, 0.20, 0.545, "across the arm, 0.545 m along"},
};

/* So many times the second girth the first one has to be at least. */
struct relation {
    uint32_t one, two;
    double least;
};
static const struct relation RELATIONS[] = {
    {MANNEQUIN_CHEST, MANNEQUIN_WAIST, 0.85},     {MANNEQUIN_HIP, MANNEQUIN_WAIST, 0.85},
    {MANNEQUIN_WAIST, MANNEQUIN_HIP, 0.60},       {MANNEQUIN_WAIST, MANNEQUIN_CHEST, 0.60},
    {MANNEQUIN_CHEST, MANNEQUIN_NECK, 2.15},      {MANNEQUIN_CHEST, MANNEQUIN_UPPER_ARM, 2.7},
    {MANNEQUIN_HIP, MANNEQUIN_THIGH, 1.6},        {MANNEQUIN_THIGH, MANNEQUIN_KNEE, 1.2},
    {MANNEQUIN_CALF, MANNEQUIN_ANKLE, 1.2},       {MANNEQUIN_KNEE, MANNEQUIN_CALF, 0.85},
    {MANNEQUIN_UPPER_ARM, MANNEQUIN_ELBOW, 0.95}, {MANNEQUIN_ELBOW, MANNEQUIN_WRIST, 1.2}};

uint32_t mannequin_find(const char *name)
{
    uint32_t i = 0;
    while (i < MANNEQUIN_GIRTHS && strcmp(mannequin_measures[i].name, name) != 0)
        i++;
    return i;
}

static int check_range(const char *name, double value, double least, double most, double height,
                       struct cloth_error *error)
{
    if (value >= least && value <= most)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT, "%s is %g m; a figure of %g m has %.3g to %.3g m", name,
                      value, height, least, most);
}

int mannequin_complete(struct mannequin *mannequin, struct cloth_error *error)
{
    double *girth = mannequin->girth;
    mannequin->height = mannequin->height != 0 ? mannequin->height : MANNEQUIN_HEIGHT;
    mannequin->edge = mannequin->edge != 0 ? mannequin->edge : MANNEQUIN_EDGE;
    const double height = mannequin->height, scale = height / MANNEQUIN_HEIGHT;
    if (!(height >= MANNEQUIN_LEAST_HEIGHT && height <= MANNEQUIN_MOST_HEIGHT))
        return cloth_fail(error, CLOTH_E_INPUT, "height is %g m; figures have %g to %g m", height,
                          MANNEQUIN_LEAST_HEIGHT, MANNEQUIN_MOST_HEIGHT);
    int code = check_range("edge", mannequin->edge, MANNEQUIN_LEAST_EDGE * scale,
                           MANNEQUIN_MOST_EDGE * scale, height, error);
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS && !code; i++) {
        const struct mannequin_measure *measure = &mannequin_measures[i];
        girth[i] = girth[i] != 0 ? girth[i] : measure->girth * scale;
        code = check_range(measure->name, girth[i], measure->least * scale, measure->most * scale,
                           height, error);
    }
    for (size_t i = 0; i < sizeof RELATIONS / sizeof *RELATIONS && !code; i++) {
        const struct relation *r = &RELATIONS[i];
        if (girth[r->one] < r->least * girth[r->two])
            code = cloth_fail(error, CLOTH_E_INPUT,
                              "a %s of %g m does not go with a %s of %g m: it has to be at least "
                              "%g times that",
                              mannequin_measures[r->one].name, girth[r->one],
                              mannequin_measures[r->two].name, girth[r->two], r->least);
    }
    return code;
}
