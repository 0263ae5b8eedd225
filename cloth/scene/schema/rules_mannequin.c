/* The keys of a figure; its ranges are those of cloth/mannequin. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
#define GIRTH(name, number, text) \
    {name, SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct scene_figure, \
     mannequin.girth[number]), \
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

static const struct scene_rule walk_keys[] = {
    {"speed", SCENE_NUMBER, "1/s", "1", .range = SCENE_POSITIVE,
     INTO(struct scene_figure, walk.speed), .about = "steps a second, at most 3"},
    {"begin", SCENE_NUMBER, "s", "0", INTO(struct scene_figure, walk.begin),
     .about = "until then the figure stands"},
    {0}};

#define ANGLE(name, number, rest, text) \
    {name, SCENE_NUMBER, "degrees", rest, INTO(struct mannequin_pose, angle[number]), .about = text}
#define SIDE(side, right, which) \
    ANGLE(side "_arm_aside", MANNEQUIN_ARM_ASIDE + (right), "45", which "arm, from straight " \
        "down"), \
    ANGLE(side "_arm_swing", MANNEQUIN_ARM_SWING + (right), "0", which "arm, forwards"), \
    ANGLE(side "_elbow_bend", MANNEQUIN_ELBOW_BEND + (right), "0", which "elbow"), \
    ANGLE(side "_leg_aside", MANNEQUIN_LEG_ASIDE + (right), "0", which "leg, from where it " \
        "stands"), \
    ANGLE(side "_leg_swing", MANNEQUIN_LEG_SWING + (right), "0", which "leg, forwards"), \
    ANGLE(side "_knee_bend", MANNEQUIN_KNEE_BEND + (right), "0", which "knee"), \
    ANGLE(side "_ankle_bend", MANNEQUIN_ANKLE_BEND + (right), "0", which "foot, the toes up")
#define RIGHT (MANNEQUIN_SIDE - MANNEQUIN_ARM_ASIDE)
static const struct scene_rule pose_keys[] = {
    {"time", SCENE_NUMBER, "s", .required = true, INTO(struct mannequin_pose, time),
     .about = "when the figure has this pose, ascending"},
    ANGLE("spine_bend", MANNEQUIN_SPINE_BEND, "0", "forwards"),
    ANGLE("spine_turn", MANNEQUIN_SPINE_TURN, "0", "to the figure's left"),
    SIDE("left", 0, "of the left "),
    SIDE("right", RIGHT, "of the right "),
    {0}};
static const struct scene_rule pose = {.type = SCENE_MAP, .inside = pose_keys};

const struct scene_rule scene_mannequin_keys[] = {
    {"height", SCENE_NUMBER, "m", .range = SCENE_POSITIVE,
     INTO(struct scene_figure, mannequin.height), .about = "from soles to crown; else 1.75"},
    {"measures", SCENE_MAP, .inside = measure_keys,
     .about = "girths; those that are not given grow with the height"},
    {"edge", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct scene_figure, mannequin.edge),
     .about = "how long the edges of its triangles are; else 0.02"},
    {"walk", SCENE_MAP, .inside = walk_keys, .about = "on the spot, from the arms held aside on"},
    {"poses", SCENE_LIST, .filled = true, .inside = &pose,
     ARRAY(struct scene_figure, poses, n_poses), .about = "or by key frames"},
    {"fps", SCENE_NUMBER, "1/s", "50", .range = SCENE_POSITIVE, INTO(struct scene_figure, fps),
     .about = "of a walk or poses: frames a second, between which vertices move straight"},
    {0}};
/* clang-format on */
const struct scene_rule scene_mannequin = {.type = SCENE_MAP, .inside = scene_mannequin_keys};
