#ifndef CLOTH_SCENE_SCHEMA_TABLES_H
#define CLOTH_SCENE_SCHEMA_TABLES_H

#include "cloth/scene/schema/rules.h"

/* Macros for tables of rules. INTO: where the value goes. ARRAY: where a list of any length goes,
 * and the number of its items. PLACE: where the place of the value goes (model.h). MEANS: which
 * field says, by a value, that this key was chosen, or given. WORDS: the words of a choice, each
 * with its meaning. ITEM: the type of an item of a list. */
/* clang-format off */
#define FIELD(type, member) \
    {offsetof(type, member), sizeof(((type *)0)->member), #type, sizeof(type)}
#define INTO(type, member) .field = FIELD(type, member)
#define ARRAY(type, member, number) \
    .field = FIELD(type, member), .count = FIELD(type, number), .item = sizeof *((type *)0)->member
#define PLACE(type, member) .place = FIELD(type, member)
#define MEANS(type, member, is) .kind = FIELD(type, member), .value = (is)
#define WORDS(...) .words = (const struct model_word[]){__VA_ARGS__, {0}}
#define ITEM(type) .field = {.width = sizeof(type)}
/* Keys of the struct mesh_transform `within` the type; number and positive are the file's own. */
#define TRANSFORM(type, within) \
    {"scale", SCENE_NUMBER_OR_LIST, .fallback = "1", .range = SCENE_POSITIVE, .length = 3, \
     .inside = &positive, INTO(type, within scale), \
     .about = "first: a factor, or one for each axis"}, \
    {"rotate", SCENE_LIST, .fallback = "[1, 0, 0, 0]", .length = 4, .inside = &number, \
     INTO(type, within rotate), .about = "then: a quaternion [w, x, y, z]"}, \
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number, \
     INTO(type, within translate), .about = "last: a shift"}
/* clang-format on */

/* Shared by the tables. */
extern const struct scene_rule scene_cloth, scene_probe;
extern const struct scene_rule scene_curve_kinds[], scene_motion_keys[], scene_mannequin_keys[];
extern const struct scene_rule scene_output_keys[];

#endif
