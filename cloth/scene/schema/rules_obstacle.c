/* Keys of the obstacles that cloth meets. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
#define MOVES \
    {"name", SCENE_TEXT, .shared = "Every obstacle", \
     .about = "for contact.pairs, contact.ignore, pins that follow and probes; no other " \
     "obstacle and no material has it"}, \
    {"groups", SCENE_LIST, .filled = true, .inside = &scene_text, .shared = "Every obstacle", \
     .about = "names for contact.ignore, of your choice"}, \
    {"friction", SCENE_NUMBER, .range = SCENE_COEFFICIENT, .shared = "Every obstacle", \
     .about = "coefficient of contact; else that of contact", .needs = NEEDS_MET}, \
    {"thickness", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, .shared = "Every obstacle", \
     .about = "of which a contact has half on this side; else that of contact", \
     .needs = NEEDS_MET}, \
    {"motion", SCENE_MAP, .inside = scene_motion_keys, .shared = "Every obstacle", \
     .about = "from where the other keys say, by key frames; it need not begin there", \
     .needs = NEEDS_MOVING, .section = "Motion"}

static const struct scene_rule plane_keys[] = {
    {"point", SCENE_LIST, "m", .required = true, VECTOR, .about = "any point of it"},
    {"normal", SCENE_LIST, .required = true, VECTOR,
     .about = "towards the free side, of any length but 0"},
    MOVES,
    {0}};
static const struct scene_rule sphere_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, VECTOR, .about = "its middle"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE, .about = "of a ball"},
    MOVES,
    {0}};
static const struct scene_rule box_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, VECTOR, .about = "its middle"},
    {"size", SCENE_LIST, "m", .required = true, .length = 3, .inside = &scene_positive,
     .about = "lengths of its edges, before it is rotated"},
    {"rotate", ROTATION, .fallback = "[1, 0, 0, 0]", .about = "about its centre"},
    MOVES,
    {0}};
static const struct scene_rule capsule_keys[] = {
    {"from", SCENE_LIST, "m", .required = true, VECTOR,
     .about = "one end of the line in its middle"},
    {"to", SCENE_LIST, "m", .required = true, VECTOR, .about = "the other end"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "around the line and its ends"},
    MOVES,
    {0}};
static const struct scene_rule cylinder_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, VECTOR, .about = "its middle"},
    {"axis", SCENE_LIST, .required = true, VECTOR,
     .about = "from one end to the other, of any length but 0"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "around the axis"},
    {"length", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "from end to end; a short one is a disc"},
    MOVES,
    {0}};

/* ---- A figure; its ranges are those of cloth/mannequin ---- */

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

static const struct scene_rule mannequin_keys[] = {
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

const struct scene_rule scene_mannequin = {.type = SCENE_MAP, .inside = mannequin_keys};

/* ---- Bodies ---- */

static const struct scene_rule frames_keys[] = {
    {"pc2", SCENE_TEXT, .choice = true,
     .about = "a PC2 file (version 1, Blender's Mesh Cache) of the mesh's vertices, relative to "
     "the scene's folder"},
    {"obj", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_text,
     .about = "OBJ files with the mesh's faces, one a frame"},
    {"clip", SCENE_TEXT, .choice = true,
     .about = "an animation of the body's file, by its name, or first: skins, shapes and nodes that "
     "it moves, `fps` times a second"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, .about = "frames a second"},
    {"start", SCENE_NUMBER, "s", "0", .about = "when the first frame is"},
    {0}};
const struct model_word scene_meets[] = {{"bvh", false}, {"image", true}, {0}};
const struct model_word scene_views[] = {
    {"thinnest", CONTACT_THINNEST}, {"x", 0}, {"y", 1}, {"z", 2}, {0}};
static const struct scene_rule body_keys[] = {
    {"obj", SCENE_TEXT, .choice = true,
     .about = "an OBJ file of a closed mesh, relative to the scene's folder"},
    {"file", SCENE_TEXT, .choice = true,
     .about = "the same, of another program: glTF, FBX, Collada, PLY or STL "
     "([mesh.md](mesh.md#meshes-and-figures-of-other-programs))"},
    {"ellipsoid", SCENE_LIST, "m", .choice = true, .length = 3, .inside = &scene_positive,
     .about = "half its axes along x, y and z, the middle at the origin: a mesh of 5120 triangles, "
     "inside it by 0.1 % of them at most"},
    {"mannequin", SCENE_MAP, .choice = true, .inside = mannequin_keys, .apart = true,
     .about = "a standing figure, made to measure", .section = "A figure"},
    AS_IN_FILE,
    TRANSFORM(struct mesh_transform, ),
    {"meet", SCENE_CHOICE, .fallback = "bvh", .words = scene_meets,
     .about = "bvh: its triangles, found by a tree of boxes; image: maps of it, from the front "
     "and the back, not by contact.mode certified", .section = "Bodies that are met by image"},
    {"resolution", SCENE_INTEGER, .fallback = "1024", .min = CONTACT_LEAST_RESOLUTION,
     .max = CONTACT_MOST_RESOLUTION,
     .about = "pixels along the longer side of the maps; a pixel takes 32 bytes, of a body with "
     "frames 56, on every rank", .needs = "meet = image"},
    {"view", SCENE_CHOICE, .fallback = "thinnest", .words = scene_views,
     .about = "the axis along which the maps see the body before it moves; thinnest: that of its "
     "least extent", .needs = "meet = image"},
    {"frames", SCENE_MAP, .inside = frames_keys,
     .about = "where its vertices are in time, before scale, rotate and translate; linear "
     "between frames"},
    MOVES,
    {0}};
const struct scene_rule scene_body = {.type = SCENE_MAP, .inside = body_keys};
static const struct scene_rule obstacle_kinds[] = {
    {"plane", SCENE_MAP, .choice = true, .inside = plane_keys,
     .about = "a floor or wall; two that stand still, face each other and overlap are an error"},
    {"sphere", SCENE_MAP, .choice = true, .inside = sphere_keys, .about = "a ball"},
    {"box", SCENE_MAP, .choice = true, .inside = box_keys, .about = "a block"},
    {"capsule", SCENE_MAP, .choice = true, .inside = capsule_keys,
     .about = "a rod with round ends"},
    {"cylinder", SCENE_MAP, .choice = true, .inside = cylinder_keys,
     .about = "a rod with flat ends, or a disc"},
    {"body", SCENE_MAP, .choice = true, .inside = body_keys, .apart = true,
     .about = "a closed mesh", .section = "Bodies"},
    {0}};
const struct scene_rule scene_obstacle = {.type = SCENE_ONE_OF, .inside = obstacle_kinds};
