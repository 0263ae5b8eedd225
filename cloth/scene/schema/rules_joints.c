/* Keys of what joins vertices: joints, welds, seams and bands; and of folds. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
#define END_KEYS \
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"}, \
    {"vertex", SCENE_INTEGER, .choice = true, ARRAY(struct model_end, vertices, n), \
     .about = "in the mesh's numbering"}, \
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_vertex, \
     ARRAY(struct model_end, vertices, n), \
     .about = "several, each with its own of the other end"}
static const struct scene_rule end_keys[] = {
    END_KEYS,
    {0}};
static const struct scene_rule point_keys[] = {
    END_KEYS,
    {"edge", SCENE_LIST, .choice = true, .length = 2, .inside = &scene_vertex,
     ARRAY(struct model_end, edges, n),
     .about = "ends of an edge of the mesh: the joint ends at a point on it"},
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_edge,
     ARRAY(struct model_end, edges, n),
     .about = "several, each with its own of the other end"},
    {"at", SCENE_NUMBER_OR_LIST, .inside = &scene_number,
     .about = "where on the edge, or on each: 0 at its first end, 1 at its second"},
    {0}};
static const struct scene_rule weld_keys[] = {
    {"from", SCENE_MAP, .required = true, .inside = end_keys,
     INTO(struct model_weld, pairs.end[0]),
     .about = "vertices of one side"},
    {"to", SCENE_MAP, .required = true, .inside = end_keys, INTO(struct model_weld, pairs.end[1]),
     .about = "as many of the other"},
    {"tolerance", SCENE_NUMBER, "m", "1e-6", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_weld, tolerance),
     .about = "how far from each other the two of a pair may start"},
    {0}};
const struct scene_rule scene_weld = {
    .type = SCENE_MAP, .inside = weld_keys, PLACE(struct model_weld, pairs.place)};
static const struct scene_rule joint_keys[] = {
    {"from", SCENE_MAP, .required = true, .inside = end_keys,
     INTO(struct model_joint, pairs.end[0]),
     .about = "the vertices at one end"},
    {"to", SCENE_MAP, .required = true, .inside = point_keys,
     INTO(struct model_joint, pairs.end[1]),
     .about = "as many at the other, or points on edges"},
    {"stiffness", SCENE_NUMBER, "N/m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_joint, stiffness),
     .about = "of each pair's spring"},
    {"damping", SCENE_NUMBER, "kg/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_joint, damping),
     .about = "along it"},
    {"length", SCENE_NUMBER_OR_WORD, "m", "start", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_joint, length), WORDS({"start", MODEL_START_LENGTH}),
     .about = "at rest; start: the distance of each pair at the start"},
    {"begin", SCENE_NUMBER, "s", "0", .range = SCENE_NOT_NEGATIVE, INTO(struct model_joint, begin),
     .about = "steps that begin from then on have the joint"},
    {"end", SCENE_NUMBER_OR_WORD, "s", "never", .range = SCENE_POSITIVE,
     INTO(struct model_joint, end), WORDS({"never", 0}),
     .about = "steps that begin from then on have it no more"},
    {0}};
const struct scene_rule scene_joint = {
    .type = SCENE_MAP, .inside = joint_keys, PLACE(struct model_joint, pairs.place)};

/* Keys of the struct model_sewing of a type, with the defaults of three. */
#define SEWING(type, of_state, of_stiffness, of_tolerance) \
    {"state", SCENE_CHOICE, .fallback = of_state, INTO(type, sewing.state), \
     WORDS({"pulled", MODEL_SEAMS_PULLED}, {"welded", MODEL_SEAMS_WELDED}, {"open", \
     MODEL_SEAMS_OPEN}), \
     .about = "pulled: a joint of rest length 0 for each pair of vertices; welded: a weld for " \
     "each; open: nothing"}, \
    {"stiffness", SCENE_NUMBER, "N/m", of_stiffness, .range = SCENE_POSITIVE, \
     INTO(type, sewing.stiffness), \
     .about = "pulled: of each joint"}, \
    {"damping", SCENE_NUMBER, "kg/s", .range = SCENE_NOT_NEGATIVE, INTO(type, sewing.damping), \
     .about = "pulled: along each joint; else 0.1 s times the stiffness"}, \
    {"tolerance", SCENE_NUMBER, "m", of_tolerance, .range = SCENE_NOT_NEGATIVE, \
     INTO(type, sewing.tolerance), \
     .about = "welded: partners start at most so far from each other"}, \
    {"bending", SCENE_NUMBER, "N m", .range = SCENE_NOT_NEGATIVE, INTO(type, sewing.bending), \
     .about = "welded: rigidity of the hinges across them; else the materials'"}

static const struct scene_rule some_keys[] = {
    {"numbers", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_vertex,
     ARRAY(struct model_some_seams, number, n),
     .about = "of the seams, from 0"},
    {"of", SCENE_LIST, .choice = true, .length = 2, .inside = &scene_text,
     .about = "all seams between two panels, by their names; * stands for any characters"},
    SEWING(struct model_some_seams, NULL, NULL, NULL),
    {0}};
static const struct scene_rule some = {.type = SCENE_MAP, .inside = some_keys};
const struct scene_rule scene_seams_keys[] = {
    SEWING(struct model_seams, "pulled", "200", "0.002"),
    {"some", SCENE_LIST, .fallback = "[]", .inside = &some,
     ARRAY(struct model_seams, some, n_some),
     .about = "seams that are sewn otherwise; keys that are not given are the cloth's, and the "
     "last one that has a seam counts"},
    {"reversed", SCENE_LIST, .fallback = "[]", .inside = &scene_vertex,
     ARRAY(struct model_seams, reversed, n_reversed),
     .about = "numbers of seams, from 0, that are sewn the other way round than was found"},
    {"file", SCENE_TEXT,
     .about = "of an OBJ mesh: its .seams.json, as duite-garment writes it, relative to the "
     "scene's folder"},
    {0}};

static const struct scene_rule fold_keys[] = {
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_vertex,
     ARRAY(struct model_fold, vertices, n),
     .about = "along it: an edge of the mesh joins each with the next"},
    {"edge", SCENE_MAP, .choice = true, .inside = scene_panel_edge_keys,
     .about = "of a panel, one that is sewn: it folds where the seam is welded"},
    {"angle", SCENE_NUMBER, "degrees", .required = true, INTO(struct model_fold, angle),
     .about = "at rest, -180 to 180; above 0: a ridge on the front"},
    {0}};
const struct scene_rule scene_fold = {
    .type = SCENE_MAP, .inside = fold_keys, PLACE(struct model_fold, place)};

static const struct scene_rule band_keys[] = {
    PICK_VERTICES(struct model_band, pick.),
    PICK_EDGE(struct model_band, pick.),
    {"length", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_band, length),
     .about = "at rest, of all of it; its parts have it as edges have theirs"},
    {"ea", SCENE_NUMBER, "N", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_band, ea),
     .about = "force / strain"},
    {"damping", SCENE_NUMBER, "s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_band, damping),
     .about = "along it, times its stiffness"},
    {"size", SCENE_LIST, .filled = true, .inside = &scene_curve_key,
     .about = "[time in s, factor] of the length, times ascending, linear in between: it is drawn "
     "tight; else it stays"},
    {0}};
const struct scene_rule scene_band = {
    .type = SCENE_MAP, .inside = band_keys, PLACE(struct model_band, pick.place)};
