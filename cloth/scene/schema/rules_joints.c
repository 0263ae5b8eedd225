/* Keys of what joins vertices: joints, welds and seams; and of folds. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
#define END_KEYS \
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"}, \
    {"vertex", SCENE_INTEGER, .choice = true, .about = "in the mesh's numbering"}, \
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_vertex, \
     ARRAY(struct model_end, vertices, n), \
     .about = "several, each with its own of the other end"}
static const struct scene_rule end_keys[] = {
    END_KEYS,
    {0}};
static const struct scene_rule point_keys[] = {
    END_KEYS,
    {"edge", SCENE_LIST, .choice = true, .length = 2, .inside = &scene_vertex,
     .about = "ends of an edge of the mesh: the joint ends at a point on it"},
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_edge,
     ARRAY(struct model_end, edges, n),
     .about = "several, each with its own of the other end"},
    {"at", SCENE_NUMBER_OR_LIST, .inside = &scene_number,
     .about = "where on the edge, or on each: 0 at its first end, 1 at its second"},
    {0}};
const struct scene_section scene_welds_section = {"Welds",
    "A weld makes two vertices one: two panels become one cloth, a strip becomes a tube. Both "
    "start at their mean place, with their common momentum. Welds chain: with a = b and b = c, "
    "all three are one. A welded vertex keeps all its names: frames, `state_hash` and probes "
    "show it by each, and pins, loads and masses may use any; pins on the names of one vertex "
    "must hold and move alike. Masses, loads and mass damping of the parts add up; the viscous "
    "damping, which is that of a vertex, is the largest of the parts'. Springs and triangles of "
    "both sides remain; springs between the same two vertices with the same length at rest "
    "become one with the sum of their stiffness.\n\n"
    "Welds may bring two border edges together. If both cloths have `bending` of the same model, "
    "the cloth bends about that edge as about an inner one ([physics.md](physics.md#bending)). "
    "An edge that three panels or more share does not bend, and `bend` springs do not reach "
    "across a weld.\n\n"
    "Two halves of a sheet that are welded are the whole sheet, bit for bit, if the vertices "
    "have the same order, places and lengths in the halves and in the whole, the stiffness of "
    "two border springs adds up to that of the whole (equal areas on both sides do), the cells "
    "are `same`, and there is no `bend`, no `mass_per_vertex` and no `strain_limit` (the last "
    "two count twice on the seam). The scale of `time.energy_growth` is taken cloth by cloth and "
    "that of `stop.normalised` is summed in another order, so decisions by them may differ.\n\n"
    "Errors are: a vertex welded to itself, a pair that stands twice, vertices that nothing "
    "uses. A weld may not make one vertex of two corners of a triangle, of the two ends of an "
    "edge, or of the two vertices opposite an edge of a cloth that bends.",
    "welds:\n"
    "  - {from: {cloth: front, vertices: [56, 57, 58]}, to: {cloth: back, vertices: [0, 1, "
    "2]}}\n"};
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
const struct scene_section scene_joints_section = {"Joints",
    "A joint is a spring between two vertices, of two cloths or of one; with lists of equal "
    "length each vertex is joined to the one in the same place of the other list. A joint has no "
    "mass. A vertex without a face or an edge takes part in the motion if a joint has it, and "
    "needs `mass_per_vertex`. Joints are in the matrix, in the limits of explicit steps and in "
    "the elastic energy. They do not count for the largest stretch, which is the cloth's "
    "(`time.stretch_growth`, `time.stretch_limit`, `longest` of probes). Two joints between the "
    "same vertices, also under other names of welded vertices, are an error.\n\n"
    "A joint with `begin` or `end` is *timed*; every integrator takes it. Its energy counts as "
    "elastic energy from its begin to its end; `time.energy_growth` ignores these changes. A "
    "step by `bdf2` after such a time is by `implicit_euler`. Two vertices may have several "
    "timed joints. A joint whose time has no step draws a warning.\n\n"
    "The other end of a joint may be a point on an edge of the mesh, (1 - w) x_a + w x_b; the "
    "joint pulls at a with 1 - w of its force and at b with w. So two borders of different "
    "divisions are joined: each vertex of the finer one to the edge of the coarser one that is "
    "opposite. Such a joint is as soft as its `stiffness` says, and integrators take it as they "
    "take timed joints. Two vertices and an edge may have several. Errors are: two vertices "
    "without an edge between them, an edge whose end the vertex is, and as many `at` as there "
    "are not edges.\n\n"
    "Cloths that joints pull together end a `contact.thickness` apart, and a vertex comes no "
    "nearer to the edge that it is joined to: give such joints that `length` or a larger one (0 "
    "for two vertices). Where a start has both ends in one place, `certified` contact refuses "
    "it, since they touch: [weld](#welds) them, or let them start apart.",
    "joints:\n"
    "  - {from: {cloth: front, vertices: [56, 57, 58]}, to: {cloth: back, vertices: [0, 1, 2]}, "
    "stiffness: 50, damping: 0.05, length: 0}\n"
    "  - {from: {cloth: bob, vertex: 0}, to: {cloth: front, vertex: 3}, stiffness: 200, begin: "
    "0.1, end: 0.2}\n"
    "  - {from: {cloth: sleeve, vertices: [0, 1]}, to: {cloth: front, edges: [[8, 9], [9, 10]], "
    "at: [0, 0.4]}, stiffness: 200, length: 0.003}\n"};
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
const struct scene_section scene_seams_section = {"Seams",
    "A cloth with a pattern as its mesh knows its seams: the stitches of the pattern, each a row "
    "of pairs of vertices ([garments.md](garments.md#the-seams)). The mesh of an OBJ file has "
    "those of the `file` that `duite-garment` wrote beside it. A pair that stands in several "
    "seams is joined once. A dart begins with a pair of one vertex, which is no pair. The "
    "summary says of each seam which way round it is sewn, its state, and how far its partners "
    "are from each other so and the other way round.\n\n"
    "*Pulled.* The two vertices of a pair count as one in contact: triangles, edges and vertices "
    "that share it do not meet. All else does, and is certified from the first step on: also the "
    "neighbours of a seam. So seams that are pulled shut may be welded later. "
    "`--check-intersections`, the check of the start and that of `duite-view` leave the same out "
    "(`scene.json` has the pairs). Partners that nothing else holds come together by exp(-t "
    "`stiffness` / `damping`). Stiffer joints close gathers, and cost iterations: where one edge "
    "is half as long again as the other, 200 N/m leave partners millimetres apart, and 3000 N/m "
    "close them. The report has `seams_open` (open by more than `time.sewn.distance`, or 1 mm), "
    "`seam_distance` (m, the largest distance) and `sewn_seconds`. A pair both of whose vertices "
    "are pinned is an error. Pulled seams of one cloth a quarter of whose threads, or more, go "
    "through those of another where the run starts draw a warning.\n\n"
    "*Welded.* Lengths and angles inside a panel are those of its own mesh, wherever the pattern "
    "places it. Both partners start at their mean; where several panels meet at one vertex, at "
    "the mean of all. With `certified` contact their way there is certified as that of a step "
    "is: a run that would weld through an obstacle or other cloth is refused (unless it "
    "untangles its start). Across a seam the cloth is flat at rest. All else is as with "
    "[welds](#welds). A pair that welds make one vertex is not pulled.\n\n"
    "[Phases](#phases) sew first and weld then. Seams that close before others leave them room: "
    "sleeves are shut around the arms, then the body, and then they are sewn on.",
    "cloths:\n"
    "  - mesh: {pattern: {garment: tshirt, edge: 0.02}}\n"
    "    material: polycotton\n"
    "    seams: {state: open, some: [{of: ['*sleeve*', '*sleeve*'], state: pulled}, {of: "
    "['*sleeve*', '*torso'], state: open}]}\n"
    "phases:\n"
    "  - {name: sleeves, set: {time.sewn: {}}}\n"
    "  - {name: body, set: {'cloths[0].seams.state': pulled}}\n"
    "  - {name: armholes, set: {'cloths[0].seams': {state: pulled}}}\n"
    "  - {name: wear, set: {'cloths[0].seams': {state: welded}, time.sewn: null}}\n"};
const struct scene_rule scene_seams_keys[] = {
    SEWING(struct model_seams, "pulled", "200", "0.002"),
    {"some", SCENE_LIST, .fallback = "[]", .inside = &some,
     ARRAY(struct model_seams, some, n_some),
     .about = "seams that are sewn otherwise; keys that are not given are the cloth's, and the "
     "last one that has a seam counts"},
    {"reversed", SCENE_LIST, .fallback = "[]", .inside = &scene_vertex,
     ARRAY(struct model_seams, reversed, n_reversed),
     .about = "numbers of seams, from 0, that are sewn the other way round than was found",
     .more = "Panels have a front, and their seams the direction that follows."},
    {"file", SCENE_TEXT,
     .about = "of an OBJ mesh: its .seams.json, as duite-garment writes it, relative to the "
     "scene's folder"},
    {0}};

static const struct scene_rule fold_edge_keys[] = {
    {"panel", SCENE_TEXT, .required = true, .about = "its name"},
    {"edge", SCENE_INTEGER, .required = true, .about = "of its edges, from 0: one that is sewn"},
    {0}};
const struct scene_section scene_folds_section = {"Folds",
    "A fold is a crease: an ironed trouser leg, a turned hem. Along it the hinges of `bending: "
    "{model: hinge}` are at rest at `angle`, whatever the shape of the mesh. Above 0 the fold is "
    "a ridge on the front, the side from which the triangles are counterclockwise; below 0 it is "
    "a valley there. 0 is flat.\n\n"
    "An edge at a border folds only if it is welded, and one side of the weld names it. An "
    "`edge` of a panel, named as in its pattern, folds where its seam is welded, and waits while "
    "the seam is pulled.\n\n"
    "A fold has the rigidity and damping of the hinges that are there. The cloth turns towards "
    "the angle from where it starts. If that is far and the cloth has little damping, it may "
    "swing through itself, unless contact keeps it from that. Errors are: two vertices without "
    "an edge between them, a border, an edge that is folded twice, and a cloth whose bending is "
    "`quadratic` or that has none.",
    "folds:\n"
    "  - {vertices: [40, 61, 82, 103], angle: 150}            # along edges of the mesh\n"
    "  - {edge: {panel: cuff, edge: 2}, angle: -170}          # along an edge of a panel that is "
    "sewn\n"};
static const struct scene_rule fold_keys[] = {
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_vertex,
     ARRAY(struct model_fold, vertices, n),
     .about = "along it: an edge of the mesh joins each with the next"},
    {"edge", SCENE_MAP, .choice = true, .inside = fold_edge_keys,
     .about = "of a panel: it folds where the seam is welded"},
    {"angle", SCENE_NUMBER, "degrees", .required = true, INTO(struct model_fold, angle),
     .about = "at rest, -180 to 180; above 0: a ridge on the front"},
    {0}};
const struct scene_rule scene_fold = {
    .type = SCENE_MAP, .inside = fold_keys, PLACE(struct model_fold, place)};
