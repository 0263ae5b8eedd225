/* The keys of a figure; its ranges are those of cloth/mannequin. */
#include "cloth/mannequin/mannequin.h"
#include "cloth/scene/schema/tables.h"

/* clang-format off */
#define GIRTH(name, number, text) \
    {name, SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct mannequin, girth[number]), \
     .about = text}
static const struct scene_rule measure_keys[] = {
    GIRTH("neck", MANNEQUIN_NECK, "girth of the neck; of all: that of the figure, if not given"),
    GIRTH("chest", MANNEQUIN_CHEST, "at its widest"),
    GIRTH("waist", MANNEQUIN_WAIST, "at its narrowest"),
    GIRTH("hip", MANNEQUIN_HIP, "over the seat"),
    GIRTH("thigh", MANNEQUIN_THIGH, "of one, below the crotch"),
    GIRTH("knee", MANNEQUIN_KNEE, "of one"),
    GIRTH("calf", MANNEQUIN_CALF, "at its widest"),
    GIRTH("ankle", MANNEQUIN_ANKLE, "above the foot"),
    GIRTH("upper_arm", MANNEQUIN_UPPER_ARM, "at the middle of it"),
    GIRTH("elbow", MANNEQUIN_ELBOW, "of the straight arm"),
    GIRTH("wrist", MANNEQUIN_WRIST, "above the hand"),
    {0}};

const struct scene_rule scene_mannequin_keys[] = {
    {"height", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct mannequin, height),
     .about = "from soles to crown; else 1.75"},
    {"measures", SCENE_MAP, .inside = measure_keys,
     .about = "girths; those that are not given grow with the height"},
    {"edge", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct mannequin, edge),
     .about = "how long the edges of its triangles are; else 0.02"},
    {0}};
/* clang-format on */
const struct scene_rule scene_mannequin = {.type = SCENE_MAP, .inside = scene_mannequin_keys};
