/* Keys of the steps of a run: time, contact, solves, and the files in its folder. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
/* ---- Time ---- */

static const struct scene_rule rest_keys[] = {
    {"speed", SCENE_NUMBER, "m/s", "0.001", .range = SCENE_POSITIVE,
     INTO(struct model_rest, speed),
     .about = "no vertex is faster"},
    {"hold", SCENE_NUMBER, "s", "0.1", .range = SCENE_NOT_NEGATIVE, INTO(struct model_rest, hold),
     .about = "for so long"},
    {0}};
static const struct scene_rule sewn_keys[] = {
    {"distance", SCENE_NUMBER, "m", "0.001", .range = SCENE_POSITIVE, INTO(struct model, sewn),
     .about = "partners of pulled seams are at most so far from each other"},
    {0}};
const struct scene_rule scene_time_keys[] = {
    {"h", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, INTO(struct model, h),
     PLACE(struct model, h_place),
     .about = "of a step"},
    {"end", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, INTO(struct model, end),
     .about = "round(end / h) steps are made, more where steps are halved"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, INTO(struct model, fps),
     PLACE(struct model, fps_place),
     .about = "frames a second; frame 0 is the start"},
    {"halving", SCENE_CHOICE, .fallback = "on", INTO(struct model, halving),
     WORDS({"on", true}, {"off", false}),
     .about = "a step that fails is made again with half the length, down to h/1024"},
    {"stretch_growth", SCENE_NUMBER, .fallback = "0.1", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, stretch_growth),
     .about = "the largest stretch (length / length at rest, of the edges of all cloths) may "
     "grow by so much in a step, else it is halved; 0: by any", .needs = "halving = on"},
    {"stretch_limit", SCENE_NUMBER, .fallback = "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, stretch_limit),
     .about = "no step may end with a larger stretch, and higher than it began; 0: no limit"},
    {"energy_growth", SCENE_NUMBER, .fallback = "0.005", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, energy_growth),
     .about = "how far the energy of an implicit step may end above an earlier one where nothing "
     "does work on the cloth; 0: not checked", .needs = NEEDS_GUARDED},
    {"rest", SCENE_MAP, .inside = rest_keys, INTO(struct model, rest),
     .about = "the run ends when the cloth is at rest, and at `end` at the latest",
     .needs = NEEDS_NO_SINE},
    {"sewn", SCENE_MAP, .inside = sewn_keys,
     .about = "the run ends when all [pulled seams](#seams) are closed; it fails if `end` comes "
     "first"},
    {0}};

/* ---- Contact ---- */

static const struct scene_rule pair_keys[] = {
    {"of", SCENE_LIST, .required = true, .length = 2, .inside = &scene_text,
     .about = "names of materials or obstacles; a cloth with `regions` goes by its own material"},
    {"friction", SCENE_NUMBER, .required = true, .range = SCENE_COEFFICIENT,
     INTO(struct model_rub, friction),
     .about = "coefficient of the two"},
    {0}};
static const struct scene_rule pair = {.type = SCENE_MAP, .inside = pair_keys};
static const struct scene_rule ignored = {.type = SCENE_LIST, .length = 2, .inside = &scene_text};
const struct scene_rule scene_contact_keys[] = {
    {"mode", SCENE_CHOICE, INTO(struct model_contact, mode), .words = model_contact_modes,
     .about = "certified: in the solve, and no step ends where a contact is not proven; "
     "repulsion: springs push apart what is too near; project: vertices in obstacles are put out "
     "after the step; else certified in implicit steps where there is more to touch than planes"},
    {"self", SCENE_CHOICE, INTO(struct model_contact, self), WORDS({"on", true}, {"off", false}),
     .about = "a cloth touches itself, too, unless it is `off`; different cloths always touch",
     .needs = NEEDS_MET},
    {"untangle", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, untangle),
     WORDS({"on", true}, {"off", false}),
     .about = "cloths that start in each other or in obstacles are moved apart",
     .needs = NEEDS_CERTIFIED,
     .section = "Starts that are tangled"},
    {"force", SCENE_CHOICE, .fallback = "off", INTO(struct model_contact, force),
     WORDS({"on", true}, {"off", false}),
     .about = "frames have the force of contact on each vertex, in contact.pc2",
     .needs = NEEDS_CERTIFIED},
    {"thickness", SCENE_NUMBER, "m", "0.001", .range = SCENE_POSITIVE,
     INTO(struct model_contact, thickness),
     .about = "how near to each other what touches is; sides a and b: (a + b) / 2",
     .needs = NEEDS_MET},
    {"pressure", SCENE_NUMBER, "Pa", "5000", .range = SCENE_POSITIVE,
     INTO(struct model_contact, pressure),
     .about = "by which the thickness of pinched cloth is half of it; of two cloths that by which "
     "both together are half as thick",
     .needs = NEEDS_CERTIFIED},
    {"friction", SCENE_NUMBER, .fallback = "0", .range = SCENE_COEFFICIENT,
     INTO(struct model_contact, friction),
     .about = "coefficient of materials and obstacles that give none; sides a and b: sqrt(a b)",
     .needs = NEEDS_MET},
    {"pairs", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &pair,
     ARRAY(struct model_contact, pairs, n_pairs),
     .about = "two sides with a friction of their own, in place of sqrt(a b)", .needs = NEEDS_MET},
    {"ignore", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &ignored,
     .about = "[A, B]: cloths, obstacles or groups that do not meet", .needs = NEEDS_MEETINGS,
     .section = "What does not meet"},
    {"stiffness", SCENE_NUMBER, "N/m", .range = SCENE_POSITIVE,
     INTO(struct model_contact, stiffness),
     .about = "force by which a contact pushes apart, for each metre that is missing of the "
     "thickness; else by mass and time.h",
     .needs = NEEDS_REPULSION},
    {"damping", SCENE_NUMBER, .fallback = "0.2", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_contact, damping),
     .about = "part of the critical damping of a vertex of mean mass on one contact",
     .needs = NEEDS_REPULSION},
    {0}};

/* ---- Solves ---- */

static const struct scene_rule stop_kinds[] = {
    {"relative", SCENE_NUMBER, .choice = true, .range = SCENE_FRACTION,
     INTO(struct model, tolerance), MEANS(struct model, stop, MODEL_STOP_RELATIVE),
     .about = "residual against the right side"},
    {"absolute", SCENE_NUMBER, "kg m/s", .choice = true, .range = SCENE_POSITIVE,
     INTO(struct model, tolerance), MEANS(struct model, stop, MODEL_STOP_ABSOLUTE),
     .about = "residual"},
    {"mass_norm", SCENE_NUMBER, .choice = true, .range = SCENE_FRACTION,
     INTO(struct model, tolerance), MEANS(struct model, stop, MODEL_STOP_MASS_NORM),
     .about = "estimated error of the change of velocity against that change, by mass"},
    {"normalised", SCENE_NUMBER, .choice = true, .range = SCENE_POSITIVE,
     INTO(struct model, tolerance), MEANS(struct model, stop, MODEL_STOP_NORMALISED),
     .about = "distance that the residual moves vertices in the step, against that of neighbours"},
    {"count", SCENE_INTEGER, .choice = true, .min = 1, INTO(struct model, max_iterations),
     MEANS(struct model, stop, MODEL_STOP_COUNT),
     .about = "so many iterations, no test"},
    {0}};
const struct scene_rule scene_solver_keys[] = {
    {"stop", SCENE_ONE_OF, .fallback = "{mass_norm: 0.01}", .inside = stop_kinds,
     .about = "when conjugate gradients end"},
    {"guess", SCENE_CHOICE, .fallback = "auto", INTO(struct model, guess),
     WORDS({"auto", MODEL_GUESS_AUTO}, {"zero", MODEL_GUESS_ZERO}, {"previous",
     MODEL_GUESS_PREVIOUS}),
     .about = "of the change of velocity: nothing, or that of the step before; auto: that in "
     "steps shorter than 10 ms",
     .needs = "previous: integrator = implicit_euler and newton.steps = 1"},
    {"preconditioner", SCENE_CHOICE, .fallback = "ic0_coarse", INTO(struct model, preconditioner),
     .words = model_preconditioners,
     .about = "of conjugate gradients"},
    {"patches", SCENE_INTEGER, .min = 1, .max = 4, INTO(struct model, patches),
     .about = "of a block, each with motions of its own in the coarse space; else as many as pay",
     .needs = "preconditioner = coarse or ic0_coarse"},
    {"format", SCENE_CHOICE, .fallback = "springs", INTO(struct model, format),
     WORDS({"springs", SOLVE_SPRINGS}, {"half", SOLVE_HALF}),
     .about = "how the matrix is kept: four numbers a spring, or nine a pair of vertices; half in "
     "place of springs where a cloth has more than springs",
     .needs = "springs: " NEEDS_ONLY_SPRINGS},
    {"jacobian", SCENE_CHOICE, .fallback = "definite", INTO(struct model, full_slope),
     WORDS({"definite", PHYS_DEFINITE}, {"full", PHYS_FULL}, {"absolute", PHYS_ABSOLUTE}),
     .about = "definite: without what could make the matrix indefinite; full: the whole slope; "
     "absolute: of compressed springs its absolute value", .needs = "absolute: " NEEDS_SPRINGS},
    {"max_iterations", SCENE_INTEGER, .fallback = "10000", .min = 1,
     INTO(struct model, max_iterations),
     .about = "a solve that needs more fails", .needs = "no stop.count"},
    {0}};
const struct scene_rule scene_newton_keys[] = {
    {"steps", SCENE_INTEGER, .fallback = "1", .min = 1, .max = 100,
     INTO(struct model, newton_steps),
     .about = "at most; 1: one linear step"},
    {"tolerance", SCENE_NUMBER, .fallback = "1e-4", .range = SCENE_FRACTION,
     INTO(struct model, newton_tolerance),
     .about = "the step ends when a Newton step changed the velocity by at most so much of the "
     "change in the whole step, by mass", .needs = "steps > 1"},
    {0}};

/* ---- Files ---- */

const struct model_word scene_hdf5_fields[] = {
    {"velocity", (int)offsetof(struct model_hdf5, velocity)},
    {"block", (int)offsetof(struct model_hdf5, block)},
    {"rank", (int)offsetof(struct model_hdf5, rank)},
    {"strain", (int)offsetof(struct model_hdf5, strain)},
    {"stress", (int)offsetof(struct model_hdf5, stress)},
    {"contact_force", (int)offsetof(struct model_hdf5, contact_force)},
    {0}};
static const struct scene_rule field = {.type = SCENE_CHOICE, .words = scene_hdf5_fields};
static const struct scene_rule hdf5_keys[] = {
    {"fields", SCENE_LIST, .filled = true, .fallback = "[velocity, block, rank, strain]",
     .inside = &field,
     .about = "of vertices velocity, block, rank, contact_force; of triangles strain, stress"},
    {"precision", SCENE_CHOICE, .fallback = "single", INTO(struct model_hdf5, is_double),
     WORDS({"single", false}, {"double", true}),
     .about = "of numbers in the files"},
    {"every", SCENE_INTEGER, .fallback = "1", .min = 1, INTO(struct model_hdf5, every),
     .about = "of the frames each so many-th, from frame 0 on"},
    {"compression", SCENE_INTEGER, .fallback = "0", .max = 9, INTO(struct model_hdf5, level),
     .about = "level of gzip; 0: none"},
    {0}};
const struct scene_rule scene_output_keys[] = {
    {"hdf5", SCENE_MAP, .inside = hdf5_keys, INTO(struct model, hdf5),
     PLACE(struct model, hdf5_place),
     .about = "frames for ParaView and for analysis, beside the others; else there are none",
     .section = "Scientific frames"},
    {0}};
