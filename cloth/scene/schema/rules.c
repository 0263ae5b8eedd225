/* The schema 1 of scenes: cloths stand in rules_cloth.c. These tables alone know keys, words,
 * units, ranges, defaults and fields. Files are checked against them, defaults come from them, they
 * fill the model, and --keys prints them. docs/scene.md describes them. */
#include "cloth/scene/schema/tables.h"

#include "cloth/scene/schema/fabrics.h"

static const struct scene_rule number = {.type = SCENE_NUMBER, ITEM(double)};
static const struct scene_rule positive = {
    .type = SCENE_NUMBER, .range = SCENE_POSITIVE, ITEM(double)};

/* Names are compared with each other; a scene is read once for each phase. */
#define MOST_NAMED  4096
#define MOST_PHASES 100

/* clang-format off */
static const struct scene_rule damping_keys[] = {
    {"viscous", SCENE_NUMBER, "kg/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_viscous), .about = "a vertex"},
    {"mass", SCENE_NUMBER, "1/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_mass), .about = "times the mass"},
    {"stiffness", SCENE_NUMBER, "s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_stiffness),
     .about = "along a spring, times its stiffness"},
    {"bending", SCENE_NUMBER, "s", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_excess),
     .about = "times the stiffness of what resists bending; else as stiffness"},
    {0}};

static const struct scene_rule not_negative = {
    .type = SCENE_NUMBER, .range = SCENE_NOT_NEGATIVE, ITEM(double)};
static const struct scene_rule bending_keys[] = {
    {"model", SCENE_CHOICE, .fallback = "hinge", INTO(struct model_material, bending),
     WORDS({"hinge", MODEL_HINGES}, {"quadratic", MODEL_QUADRATIC}),
     .about = "quadratic: of cloths that are flat at rest"},
    {"rigidity", SCENE_NUMBER_OR_LIST, "N m", .required = true, .range = SCENE_NOT_NEGATIVE,
     .length = 2, .inside = &not_negative, INTO(struct model_material, rigidity),
     .about = "one, or those of warp and weft"},
    {0}};

static const struct scene_rule limit_keys[] = {
    {"at", SCENE_NUMBER, .required = true, .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, limit_strain), .about = "strain from which on it acts"},
    {"stiffness", SCENE_NUMBER, "N/m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_material, limit_stiffness), .about = "of each edge beyond it"},
    {0}};

static const struct scene_rule correction_keys[] = {
    {"at", SCENE_NUMBER, .fallback = "0.1", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, correction.at), .about = "strain that no edge is to end a step beyond"},
    {"tolerance", SCENE_NUMBER, .fallback = "0.01", .range = SCENE_POSITIVE,
     INTO(struct model_material, correction.tolerance),
     .about = "strain beyond it that corrections may leave"},
    {"rounds", SCENE_INTEGER, .fallback = "100", .min = 1,
     INTO(struct model_material, correction.rounds), .about = "at most in a step"},
    {0}};

/* The list of two takes the member that follows, too. */
#define STRETCH_AND_WEFT \
    .field = {offsetof(struct model_material, stretch), sizeof(double[2]), \
              "struct model_material", sizeof(struct model_material)}
_Static_assert(offsetof(struct model_material, weft_excess) ==
               offsetof(struct model_material, stretch) + sizeof(double), "weft after warp");
static const struct scene_rule material_keys[] = {
    {"like", SCENE_CHOICE, .words = scene_fabrics,
     .about = "a measured one, whose values stand where none are given"},
    {"density", SCENE_NUMBER, "kg/m^2", .range = SCENE_POSITIVE,
     INTO(struct model_material, density),
     .about = "mass of an area; but where cloths have mass_per_vertex"},
    {"model", SCENE_CHOICE, .fallback = "springs", INTO(struct model_material, model),
     WORDS({"springs", MODEL_SPRINGS}, {"triangles", MODEL_TRIANGLES}),
     .about = "what resists being stretched"},
    {"stretch", SCENE_NUMBER_OR_LIST, "N/m", .range = SCENE_NOT_NEGATIVE, .length = 2,
     .inside = &not_negative, STRETCH_AND_WEFT,
     .about = "modulus of triangles, or along threads or edges: one, or those of warp and weft"},
    {"ea", SCENE_NUMBER, "N", .range = SCENE_NOT_NEGATIVE, INTO(struct model_material, ea),
     .about = "force / strain of edges without triangles: chains, ropes"},
    {"shear", SCENE_NUMBER, "N/m", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, shear),
     .about = "of springs along the diagonals of grids; of triangles"},
    {"poisson", SCENE_NUMBER, .fallback = "0", INTO(struct model_material, poisson),
     .about = "triangles: how much a pull along the warp narrows along the weft"},
    {"forces", SCENE_CHOICE, .fallback = "exact", INTO(struct model_material, uncorrected),
     WORDS({"exact", false}, {"uncorrected", true}),
     .about = "triangles: uncorrected ones leave a torque, as in the papers"},
    {"bend", SCENE_NUMBER, "N/m", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, bend), .about = "of springs over two edges"},
    {"bending", SCENE_MAP, .inside = bending_keys, .about = "rigidity about edges"},
    {"strain_limit", SCENE_MAP, .inside = limit_keys,
     .about = "springs that pull edges back which are stretched too far"},
    {"velocity_correction", SCENE_MAP, .inside = correction_keys,
     .about = "impulses after a step's solve, so that no edge ends it stretched too far"},
    {"damping", SCENE_MAP, .fallback = "{}", .inside = damping_keys, .about = "of motion"},
    {"friction", SCENE_NUMBER, .range = SCENE_COEFFICIENT, INTO(struct model_material, friction),
     .about = "coefficient of contact, certified or by repulsion; else that of contact"},
    {"diagonals", SCENE_CHOICE, .fallback = "both", INTO(struct model_material, both_diagonals),
     WORDS({"both", true}, {"one", false}), .about = "shear springs in a cell of a grid"},
    {0}};
static const struct scene_rule material = {.type = SCENE_MAP, .inside = material_keys};

static const struct scene_rule text = {.type = SCENE_TEXT};

/* Keys of every obstacle. */
#define MOVES \
    {"name", SCENE_TEXT, .about = "unique, for contact.pairs, contact.ignore, pins that follow and probes"}, \
    {"groups", SCENE_LIST, .filled = true, .inside = &text, \
     .about = "names for contact.ignore, of your choice"}, \
    {"friction", SCENE_NUMBER, .range = SCENE_COEFFICIENT, \
     .about = "coefficient of contact, certified or by repulsion; else that of contact"}, \
    {"motion", SCENE_MAP, .inside = scene_motion_keys, \
     .about = "from where the other keys say, by key frames; it need not begin there"}

static const struct scene_rule plane_keys[] = {
    {"point", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "any point of it"},
    {"normal", SCENE_LIST, .required = true, .length = 3, .inside = &number,
     .about = "towards the free side, of any length but 0"},
    MOVES,
    {0}};
static const struct scene_rule sphere_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "its middle"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE, .about = "of a ball"},
    MOVES,
    {0}};
static const struct scene_rule box_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "its middle"},
    {"size", SCENE_LIST, "m", .required = true, .length = 3, .inside = &positive,
     .about = "lengths of its edges, before it is rotated"},
    {"rotate", SCENE_LIST, .fallback = "[1, 0, 0, 0]", .length = 4, .inside = &number,
     .about = "about its centre: a quaternion [w, x, y, z]"},
    MOVES,
    {0}};
static const struct scene_rule capsule_keys[] = {
    {"from", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "one end of the line in its middle"},
    {"to", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "the other end"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "around the line and its ends"},
    MOVES,
    {0}};
static const struct scene_rule cylinder_keys[] = {
    {"centre", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "its middle"},
    {"axis", SCENE_LIST, .required = true, .length = 3, .inside = &number,
     .about = "from one end to the other, of any length but 0"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "around the axis"},
    {"length", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     .about = "from end to end; a short one is a disc"},
    MOVES,
    {0}};
static const struct scene_rule frames_keys[] = {
    {"pc2", SCENE_TEXT, .choice = true,
     .about = "a PC2 file of the mesh's vertices, relative to the scene's folder"},
    {"obj", SCENE_LIST, .choice = true, .filled = true, .inside = &text,
     .about = "OBJ files with the mesh's faces, one a frame"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, .about = "frames a second"},
    {"start", SCENE_NUMBER, "s", "0", .about = "when the first frame is"},
    {0}};
const struct model_word scene_meets[] = {{"bvh", false}, {"image", true}, {0}};
const struct model_word scene_views[] = {
    {"thinnest", CONTACT_THINNEST}, {"x", 0}, {"y", 1}, {"z", 2}, {0}};
static const struct scene_rule body_keys[] = {
    {"obj", SCENE_TEXT, .choice = true,
     .about = "an OBJ file of a closed mesh, relative to the scene's folder"},
    {"mannequin", SCENE_MAP, .choice = true, .inside = scene_mannequin_keys, .apart = true,
     .about = "a standing figure, made to measure (docs/garments.md)"},
    TRANSFORM(struct mesh_transform, ),
    {"meet", SCENE_CHOICE, .fallback = "bvh", .words = scene_meets,
     .about = "bvh: its triangles, found by a tree of boxes; image: maps of it, from the front and "
              "the back, not by contact.mode certified"},
    {"resolution", SCENE_INTEGER, .fallback = "1024", .min = CONTACT_LEAST_RESOLUTION,
     .max = CONTACT_MOST_RESOLUTION, .about = "of image: pixels along the longer side of the maps"},
    {"view", SCENE_CHOICE, .fallback = "thinnest", .words = scene_views,
     .about = "of image: the axis along which the maps see the body before it moves; thinnest: "
              "that of its least extent"},
    {"frames", SCENE_MAP, .inside = frames_keys,
     .about = "where its vertices are in time, before scale, rotate and translate; linear between "
              "frames"},
    MOVES,
    {0}};
const struct scene_rule scene_body = {.type = SCENE_MAP, .inside = body_keys};
static const struct scene_rule obstacle_kinds[] = {
    {"plane", SCENE_MAP, .inside = plane_keys, .about = "a floor or wall"},
    {"sphere", SCENE_MAP, .inside = sphere_keys, .about = "a ball"},
    {"box", SCENE_MAP, .inside = box_keys, .about = "a block"},
    {"capsule", SCENE_MAP, .inside = capsule_keys, .about = "a rod with round ends"},
    {"cylinder", SCENE_MAP, .inside = cylinder_keys, .about = "a rod with flat ends, or a disc"},
    {"body", SCENE_MAP, .inside = body_keys, .apart = true, .about = "a closed mesh"},
    {0}};
static const struct scene_rule obstacle = {.type = SCENE_ONE_OF, .inside = obstacle_kinds};

static const struct scene_rule air_keys[] = {
    {"density", SCENE_NUMBER, "kg/m^3", "1.2", .range = SCENE_POSITIVE,
     INTO(struct phys_air, density), .about = "of the air"},
    {"wind", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     INTO(struct phys_air, wind), .about = "the same everywhere"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "what the wind is multiplied by in time; else it is constant"},
    {"normal", SCENE_NUMBER, .fallback = "1.2", .range = SCENE_NOT_NEGATIVE,
     INTO(struct phys_air, normal), .about = "coefficient of the drag across a triangle"},
    {"tangent", SCENE_NUMBER, .fallback = "0.01", .range = SCENE_NOT_NEGATIVE,
     INTO(struct phys_air, tangent), .about = "of the friction along it"},
    {0}};

static const struct scene_rule rest_keys[] = {
    {"speed", SCENE_NUMBER, "m/s", "0.001", .range = SCENE_POSITIVE, INTO(struct model_rest, speed),
     .about = "no vertex is faster"},
    {"hold", SCENE_NUMBER, "s", "0.1", .range = SCENE_NOT_NEGATIVE, INTO(struct model_rest, hold),
     .about = "for so long"},
    {0}};
static const struct scene_rule sewn_keys[] = {
    {"distance", SCENE_NUMBER, "m", "0.001", .range = SCENE_POSITIVE, INTO(struct model, sewn),
     .about = "partners of pulled seams are at most so far from each other"},
    {0}};
static const struct scene_rule time_keys[] = {
    {"h", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, INTO(struct model, h),
     PLACE(struct model, h_place), .about = "of a step"},
    {"end", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, INTO(struct model, end),
     .about = "round(end / h) steps are made"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, INTO(struct model, fps),
     PLACE(struct model, fps_place), .about = "frames a second"},
    {"halving", SCENE_CHOICE, .fallback = "on", INTO(struct model, halving),
     WORDS({"on", true}, {"off", false}),
     .about = "a step that fails is made again with half the length, down to h/1024"},
    {"stretch_growth", SCENE_NUMBER, .fallback = "0.1", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, stretch_growth),
     .about = "largest stretch of an edge may grow by so much in a step; 0: by any"},
    {"stretch_limit", SCENE_NUMBER, .fallback = "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, stretch_limit),
     .about = "and no step may stretch beyond, length / length at rest; 0: no limit"},
    {"energy_growth", SCENE_NUMBER, .fallback = "0.005", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, energy_growth),
     .about = "an implicit step may end so much above an earlier energy, where nothing does work "
              "on the cloth, as part of the energy of motion and strain, or of what weights and loads "
              "can set free; 0: by any"},
    {"rest", SCENE_MAP, .inside = rest_keys, INTO(struct model, rest),
     .about = "the run ends when the cloth is at rest"},
    {"sewn", SCENE_MAP, .inside = sewn_keys,
     .about = "the run ends when all pulled seams are closed; it fails if time.end comes first"},
    {0}};

static const struct scene_rule stop_kinds[] = {
    {"relative", SCENE_NUMBER, .range = SCENE_FRACTION, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_RELATIVE), .about = "residual against the right side"},
    {"absolute", SCENE_NUMBER, "kg m/s", .range = SCENE_POSITIVE, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_ABSOLUTE), .about = "residual"},
    {"mass_norm", SCENE_NUMBER, .range = SCENE_FRACTION, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_MASS_NORM),
     .about = "error of the change of velocity against it, by mass"},
    {"normalised", SCENE_NUMBER, .range = SCENE_POSITIVE, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_NORMALISED),
     .about = "distance that the residual moves vertices in the step, against that of neighbours"},
    {"count", SCENE_INTEGER, .min = 1, INTO(struct model, max_iterations),
     MEANS(struct model, stop, MODEL_STOP_COUNT), .about = "so many iterations, no test"},
    {0}};
static const struct scene_rule solver_keys[] = {
    {"stop", SCENE_ONE_OF, .fallback = "{mass_norm: 0.01}", .inside = stop_kinds,
     .about = "when conjugate gradients end"},
    {"guess", SCENE_CHOICE, .fallback = "auto", INTO(struct model, guess),
     WORDS({"auto", MODEL_GUESS_AUTO}, {"zero", MODEL_GUESS_ZERO},
           {"previous", MODEL_GUESS_PREVIOUS}),
     .about = "of the change of velocity: nothing, or that of the step before"},
    {"preconditioner", SCENE_CHOICE, .fallback = "ic0_coarse", INTO(struct model, preconditioner),
     .words = model_preconditioners,
     .about = "of conjugate gradients"},
    {"patches", SCENE_INTEGER, .min = 1, .max = 4, INTO(struct model, patches),
     .about = "of a block, each with motions of its own in the coarse space; else as many as pay"},
    {"format", SCENE_CHOICE, .fallback = "springs", INTO(struct model, format),
     WORDS({"springs", SOLVE_SPRINGS}, {"half", SOLVE_HALF}, {"half_float", SOLVE_HALF_FLOAT}),
     .about = "how the matrix is kept: four numbers a spring, or nine a pair of vertices, in "
              "double or float; what is more than springs takes half for springs"},
    {"jacobian", SCENE_CHOICE, .fallback = "definite", INTO(struct model, full_slope),
     WORDS({"definite", PHYS_DEFINITE}, {"full", PHYS_FULL}, {"absolute", PHYS_ABSOLUTE}),
     .about = "definite: without what could make the matrix indefinite; full: the whole slope; "
              "absolute: of compressed springs its absolute value"},
    {"max_iterations", SCENE_INTEGER, .fallback = "10000", .min = 1,
     INTO(struct model, max_iterations), .about = "a solve that needs more fails"},
    {0}};

static const struct scene_rule pair_keys[] = {
    {"of", SCENE_LIST, .required = true, .length = 2, .inside = &text,
     .about = "names of materials or obstacles"},
    {"friction", SCENE_NUMBER, .required = true, .range = SCENE_COEFFICIENT,
     INTO(struct model_rub, friction), .about = "coefficient of the two"},
    {0}};
static const struct scene_rule pair = {.type = SCENE_MAP, .inside = pair_keys};
static const struct scene_rule ignored = {.type = SCENE_LIST, .length = 2, .inside = &text};
static const struct scene_rule contact_keys[] = {
    {"mode", SCENE_CHOICE, INTO(struct model_contact, mode),
     .words = model_contact_modes,
     .about = "certified: in the solve, and no step ends where a contact is not proven; repulsion: "
              "springs push apart what is too near; project: vertices in obstacles are put out "
              "after the step; else certified in implicit steps where there is more to touch than "
              "planes"},
    {"self", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, self),
     WORDS({"on", true}, {"off", false}), .about = "certified, repulsion: a cloth touches itself, too"},
    {"untangle", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, untangle),
     WORDS({"on", true}, {"off", false}),
     .about = "certified: cloths that start in each other or in obstacles are moved apart"},
    {"force", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, force),
     WORDS({"on", true}, {"off", false}),
     .about = "certified: frames have the force of contact on each vertex, in contact.pc2"},
    {"thickness", SCENE_NUMBER, "m", "0.001", .range = SCENE_POSITIVE,
     INTO(struct model_contact, thickness), 
     .about = "certified, repulsion: how near to each other what touches is"},
    {"friction", SCENE_NUMBER, .fallback = "0", .range = SCENE_COEFFICIENT,
     INTO(struct model_contact, friction),
     .about = "coefficient of materials and obstacles that give none; sides a and b: sqrt(a b)"},
    {"pairs", SCENE_LIST, .fallback = "[]", .max = MOST_NAMED, .inside = &pair,
     ARRAY(struct model_contact, pairs, n_pairs), .about = "two sides with a friction of their own"},
    {"ignore", SCENE_LIST, .fallback = "[]", .max = MOST_NAMED, .inside = &ignored,
     .about = "[A, B]: cloths, obstacles or groups that do not meet"},
    {"stiffness", SCENE_NUMBER, "N/m", .range = SCENE_POSITIVE,
     INTO(struct model_contact, stiffness),
     .about = "repulsion: force by what is missing of the thickness; else by mass and time.h"},
    {"damping", SCENE_NUMBER, .fallback = "0.2", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_contact, damping),
     .about = "repulsion: part of the critical damping of a vertex of mean mass"},
    {0}};

static const struct scene_rule drape_keys[] = {
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_drape, radius), .about = "of the disc that carries the cloth"},
    {"axis", SCENE_LIST, .fallback = "[0, 1, 0]", .length = 3, .inside = &number,
     INTO(struct model_drape, axis), .about = "along which the light falls; of any length but 0"},
    {0}};

static const struct scene_rule newton_keys[] = {
    {"steps", SCENE_INTEGER, .fallback = "1", .min = 1, .max = 100,
     INTO(struct model, newton_steps), .about = "at most; 1: one linear step"},
    {"tolerance", SCENE_NUMBER, .fallback = "1e-4", .range = SCENE_FRACTION,
     INTO(struct model, newton_tolerance),
     .about = "last change of velocity against that of the step, by mass"},
    {0}};

static const struct scene_rule vertex = {.type = SCENE_INTEGER, ITEM(uint32_t)};
#define END_KEYS \
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"}, \
    {"vertex", SCENE_INTEGER, .choice = true, .about = "in the mesh's numbering"}, \
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &vertex, \
     ARRAY(struct model_end, vertices, n), \
     .about = "several, each with its own of the other end"}
static const struct scene_rule end_keys[] = {
    END_KEYS,
    {0}};
static const struct scene_rule edge = {
    .type = SCENE_LIST, .length = 2, .inside = &vertex, ITEM(uint32_t[2])};
static const struct scene_rule point_keys[] = {
    END_KEYS,
    {"edge", SCENE_LIST, .choice = true, .length = 2, .inside = &vertex,
     .about = "ends of an edge of the mesh: the joint ends at a point on it"},
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &edge,
     ARRAY(struct model_end, edges, n), .about = "several, each with its own of the other end"},
    {"at", SCENE_NUMBER_OR_LIST, .inside = &number,
     .about = "where on the edge, or on each: 0 at its first end, 1 at its second"},
    {0}};
static const struct scene_rule weld_keys[] = {
    {"from", SCENE_MAP, .required = true, .inside = end_keys,
     INTO(struct model_weld, pairs.end[0]), .about = "vertices of one side"},
    {"to", SCENE_MAP, .required = true, .inside = end_keys,
     INTO(struct model_weld, pairs.end[1]), .about = "as many of the other"},
    {"tolerance", SCENE_NUMBER, "m", "1e-6", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_weld, tolerance),
     .about = "how far from each other the two of a pair may start"},
    {0}};
static const struct scene_rule weld = {
    .type = SCENE_MAP, .inside = weld_keys, PLACE(struct model_weld, pairs.place)};
static const struct scene_rule joint_keys[] = {
    {"from", SCENE_MAP, .required = true, .inside = end_keys,
     INTO(struct model_joint, pairs.end[0]), .about = "the vertices at one end"},
    {"to", SCENE_MAP, .required = true, .inside = point_keys,
     INTO(struct model_joint, pairs.end[1]), .about = "as many at the other, or points on edges"},
    {"stiffness", SCENE_NUMBER, "N/m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_joint, stiffness), .about = "of each pair's spring"},
    {"damping", SCENE_NUMBER, "kg/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_joint, damping), .about = "along it"},
    {"length", SCENE_NUMBER_OR_WORD, "m", "start", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_joint, length), WORDS({"start", MODEL_START_LENGTH}),
     .about = "at rest; start: the distance of each pair at the start"},
    {"begin", SCENE_NUMBER, "s", "0", .range = SCENE_NOT_NEGATIVE, INTO(struct model_joint, begin),
     .about = "steps that begin from then on have the joint"},
    {"end", SCENE_NUMBER_OR_WORD, "s", "never", .range = SCENE_POSITIVE,
     INTO(struct model_joint, end), WORDS({"never", 0}),
     .about = "steps that begin from then on have it no more"},
    {0}};
static const struct scene_rule joint = {
    .type = SCENE_MAP, .inside = joint_keys, PLACE(struct model_joint, pairs.place)};

static const struct scene_rule phase_keys[] = {
    {"name", SCENE_TEXT, .required = true, INTO(struct model_phase, name),
     .about = "of the phase, in messages and in the report"},
    {"set", SCENE_EDITS, .fallback = "{}", .about = "keys of the scene that are others from it on; null: the default again"},
    {0}};
static const struct scene_rule phase = {
    .type = SCENE_MAP, .inside = phase_keys, PLACE(struct model_phase, place)};

static const struct scene_rule scene_keys[] = {
    {"schema", SCENE_INTEGER, .required = true, .min = 1, .max = 1,
     .about = "version of these rules"},
    {"name", SCENE_TEXT, INTO(struct model, name), .about = "of the scene; else the file's name"},
    {"gravity", SCENE_LIST, "m/s^2", .fallback = "[0, -9.81, 0]", .length = 3, .inside = &number,
     INTO(struct model, gravity), .about = "+y is up"},
    {"air", SCENE_MAP, .inside = air_keys, INTO(struct model, air),
     .about = "drag and wind on triangles; else there is none"},
    {"cloths", SCENE_LIST, .required = true, .filled = true, .max = MOST_NAMED,
     .inside = &scene_cloth, ARRAY(struct model, cloths, n_cloths), .about = "what moves"},
    {"materials", SCENE_NAMED, .inside = &material, ARRAY(struct model, materials, n_materials),
     .name = FIELD(struct model_material, name),
     .about = "NAME is yours; rib_knit, silk, denim and polycotton are there"},
    {"obstacles", SCENE_LIST, .fallback = "[]", .max = MOST_NAMED, .inside = &obstacle,
     .about = "what the cloth meets, still or moving by key frames"},
    {"contact", SCENE_MAP, .fallback = "{}", .inside = contact_keys, INTO(struct model, contact),
     .about = "how obstacles are met, and cloth"},
    {"time", SCENE_MAP, .required = true, .inside = time_keys, .about = "of the simulation"},
    {"integrator", SCENE_CHOICE, .fallback = "implicit_euler", INTO(struct model, integrator),
     .words = model_integrators, .about = "how a step is made"},
    {"energies", SCENE_CHOICE, .fallback = "ends", INTO(struct model, energy_steps),
     WORDS({"ends", false}, {"steps", true}),
     .about = "the report's: of start and end, or after each step too"},
    {"newton", SCENE_MAP, .fallback = "{}", .inside = newton_keys,
     .about = "Newton steps, with a line search, of implicit steps"},
    {"solver", SCENE_MAP, .fallback = "{}", .inside = solver_keys, .about = "of implicit steps"},
    {"probes", SCENE_LIST, .fallback = "[]", .max = MOST_NAMED, .inside = &scene_probe,
     ARRAY(struct model, probes, n_probes), .about = "what probes.csv reports after each step"},
    {"drape", SCENE_MAP, .inside = drape_keys, INTO(struct model, drape),
     .about = "the drape test: its coefficient is printed; else there is none"},
    {"joints", SCENE_LIST, .fallback = "[]", .inside = &joint,
     ARRAY(struct model, joints, n_joints), .about = "springs between any two vertices"},
    {"welds", SCENE_LIST, .fallback = "[]", .inside = &weld, ARRAY(struct model, welds, n_welds),
     .about = "vertices of any cloths that are one"},
    {"output", SCENE_MAP, .fallback = "{}", .inside = scene_output_keys,
     .about = "files in the folder of --output that not every run has"},
    {"phases", SCENE_LIST, .filled = true, .max = MOST_PHASES, .inside = &phase,
     ARRAY(struct model, phases, n_phases),
     .about = "runs of the scene, each from where the one before ended; else it is one run"},
    {"grain", SCENE_INTEGER, .fallback = "1000", .min = 1, INTO(struct model, grain),
     .about = "vertices a block"},
    {0}};
/* clang-format on */

const struct scene_rule scene_root = {.type = SCENE_MAP, .inside = scene_keys};
