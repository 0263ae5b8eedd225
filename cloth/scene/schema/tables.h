#ifndef CLOTH_SCENE_SCHEMA_TABLES_H
#define CLOTH_SCENE_SCHEMA_TABLES_H

#include "cloth/scene/schema/needs.h"
#include "cloth/scene/schema/rules.h"

/* Macros for tables of rules. INTO: where the value goes. ARRAY: where a list of any length goes,
 * or one value as a list of one, and the number of its items. PLACE: where the place of the value
 * goes (model.h). MEANS: which field says, by a value, that this key was chosen, or given. WORDS:
 * the words of a choice, each with its meaning. ITEM: the type of an item of a list. VECTOR: a
 * list of three numbers. ROTATION: one that cloth/scene/build turns into a quaternion. */
/* clang-format off */
#define FIELD(type, member) \
    {offsetof(type, member), sizeof(((type *)0)->member), #type, sizeof(type)}
#define INTO(type, member) .field = FIELD(type, member)
#define ARRAY(type, member, number) \
    .field = FIELD(type, member), .count = FIELD(type, number), .item = sizeof *((type *)0)->member
#define PLACE(type, member) .place = FIELD(type, member)
#define MEANS(type, member, is) .kind = FIELD(type, member), .value = (is)
#define WORDS(...) .words = (const struct model_word[]){__VA_ARGS__, {0}}
#define VECTOR .length = 3, .inside = &scene_number
#define ROTATION SCENE_ROTATION, .inside = scene_turn_keys, .section = "Rotations"
#define ITEM(type) .field = {.width = sizeof(type)}

/* Keys of the struct mesh_transform `within` the type. */
#define TRANSFORM(type, within) \
    {"scale", SCENE_NUMBER_OR_LIST, .fallback = "1", .range = SCENE_POSITIVE, .length = 3, \
     .inside = &scene_positive, INTO(type, within scale), \
     .about = "first: a factor, or one for each axis"}, \
    {"rotate", ROTATION, .fallback = "[1, 0, 0, 0]", .about = "then"}, \
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", VECTOR, \
     INTO(type, within translate), .about = "last: a shift"}

/* How a mesh stands in its file, before it is transformed. */
#define AS_IN_FILE \
    {"units", SCENE_CHOICE, .fallback = "m", .words = scene_units, \
     .about = "of lengths in the mesh's file"}, \
    {"up", SCENE_CHOICE, .fallback = "y", .words = scene_ups, \
     .about = "the axis that is up in the mesh's file; z becomes the scene's y, and y its -z"}

/* Ways to choose vertices, one of these: into the struct model_pick `pick` of a type. */
#define PICK_VERTICES(type, pick) \
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_vertex, \
     ARRAY(type, pick vertices, pick n_vertices), MEANS(type, pick kind, MODEL_PICK_VERTICES), \
     .about = "in the mesh's numbering, from 0", .shared = "Picking vertices"}
#define PICK_BOX(type, pick) \
    {"box", SCENE_LIST, "m", .choice = true, .length = 2, .inside = &scene_point, \
     INTO(type, pick box), MEANS(type, pick kind, MODEL_PICK_BOX), \
     .about = "all vertices in the box between two corners", .shared = "Picking vertices"}
#define PICK_GROUP(type, pick) \
    {"group", SCENE_TEXT, .choice = true, MEANS(type, pick kind, MODEL_PICK_VERTICES), \
     .about = "all vertices of a group of the mesh's faces: of an OBJ file, or a panel", \
     .shared = "Picking vertices"}
#define PICK_EDGE(type, pick) \
    {"edge", SCENE_MAP, .choice = true, .inside = scene_panel_edge_keys, \
     MEANS(type, pick kind, MODEL_PICK_VERTICES), \
     .about = "all vertices along an edge of a panel, both ends included", \
     .shared = "Picking vertices"}
#define PICK(type) \
    PICK_VERTICES(type, pick.), \
    {"nearest", SCENE_LIST, "m", .choice = true, VECTOR, \
     INTO(type, pick.point), MEANS(type, pick.kind, MODEL_PICK_NEAREST), \
     .about = "the vertex nearest to a point", .shared = "Picking vertices"}, \
    {"radius", SCENE_NUMBER, "m", .range = SCENE_NOT_NEGATIVE, INTO(type, pick.radius), \
     .about = "of nearest: and all vertices within it", .shared = "Picking vertices"}, \
    PICK_BOX(type, pick.), \
    PICK_GROUP(type, pick.), \
    PICK_EDGE(type, pick.)
/* clang-format on */

/* Names are compared with each other; a scene is read once for each phase. */
enum { SCENE_MOST_NAMED = 4096, SCENE_MOST_PHASES = 100 };

/* Items of lists. */
extern const struct scene_rule scene_number, scene_positive, scene_text, scene_vertex;
extern const struct scene_rule scene_point, scene_edge;

/* Tables of other files; keys end with a rule without a key. */
extern const struct scene_rule scene_cloth, scene_material, scene_obstacle;
extern const struct scene_rule scene_pin, scene_load, scene_mass, scene_start, scene_probe;
extern const struct scene_rule scene_joint, scene_weld, scene_fold, scene_band;
extern const struct scene_rule scene_seams_keys[], scene_time_keys[], scene_contact_keys[];
extern const struct scene_rule scene_solver_keys[], scene_newton_keys[], scene_output_keys[];
extern const struct scene_rule scene_curve_kinds[], scene_motion_keys[], scene_turn_keys[];
extern const struct scene_rule scene_curve_key;
extern const struct scene_rule scene_panel_edge_keys[];
#endif
