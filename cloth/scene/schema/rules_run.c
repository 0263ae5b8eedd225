/* Keys of the steps of a run: time, solves, and the files in its folder. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
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
const struct scene_section scene_time_section = {"Time", NULL,
    "time: {h: 0.001, end: 10, fps: 25, rest: {speed: 0.002, hold: 0.2}}\n"};
const struct scene_rule scene_time_keys[] = {
    {"h", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, INTO(struct model, h),
     PLACE(struct model, h_place),
     .about = "of a step"},
    {"end", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, INTO(struct model, end),
     .about = "round(end / h) steps are made"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, INTO(struct model, fps),
     PLACE(struct model, fps_place),
     .about = "frames a second; frame 0 is the start",
     .more = "Where frames are closer than steps, a step is shown several times (10 times and "
     "more: with a warning). A run whose frames and probes do not fit on the disk of `--output` "
     "is refused before it begins; more than 10 GB of them draw a warning."},
    {"halving", SCENE_CHOICE, .fallback = "on", INTO(struct model, halving),
     WORDS({"on", true}, {"off", false}),
     .about = "a step that fails is made again with half the length, down to h/1024",
     .more = "A step fails if its solve breaks down or does not converge, a position or velocity "
     "leaves all bounds, an edge is stretched too much, or `certified` contact finds no end of "
     "it. Steps grow back on multiples of their own length. If the shortest step fails too, the "
     "run ends and says why; by `off` the first failure ends the run."},
    {"stretch_growth", SCENE_NUMBER, .fallback = "0.1", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, stretch_growth),
     .about = "the largest stretch (length / length at rest, of the edges of all cloths) may "
     "grow by so much in a step, else it is halved; 0: by any", .needs = "halving = on"},
    {"stretch_limit", SCENE_NUMBER, .fallback = "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, stretch_limit),
     .about = "no step may end with a larger stretch, unless it began with one; 0: no limit"},
    {"energy_growth", SCENE_NUMBER, .fallback = "0.005", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model, energy_growth),
     .about = "an implicit step may end so much above an earlier energy, where nothing does work "
     "on the cloth, as part of the energy of motion and strain, or of what weights and loads can "
     "set free; 0: by any",
     .more = "The energy is the largest so far. A step that ends higher is made again: first by "
     "implicit Euler if it was by `bdf2`, then with half the length, down to h/16 "
     "([physics.md](physics.md#integrators)). In a step in which contact moved vertices beyond "
     "what was solved it does not count.", .needs = NEEDS_GUARDED},
    {"rest", SCENE_MAP, .inside = rest_keys, INTO(struct model, rest),
     .about = "the run ends when the cloth is at rest, and at `end` at the latest",
     .more = "In the seconds of `hold` no `motion` may move anything, and no `curve` may vary. "
     "The next frame is the last one. The report has the time as `rest_seconds`; a run that does "
     "not come to rest warns.", .needs = NEEDS_NO_SINE},
    {"sewn", SCENE_MAP, .inside = sewn_keys,
     .about = "the run ends when all [pulled seams](#seams) are closed; it fails if `end` comes "
     "first",
     .more = "The next frame is the last one. The error of a run that fails names the seams that "
     "are open most, with their panels and edges; the frames are kept."},
    {0}};

static const struct scene_rule stop_kinds[] = {
    {"relative", SCENE_NUMBER, .range = SCENE_FRACTION, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_RELATIVE),
     .about = "residual against the right side"},
    {"absolute", SCENE_NUMBER, "kg m/s", .range = SCENE_POSITIVE, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_ABSOLUTE),
     .about = "residual"},
    {"mass_norm", SCENE_NUMBER, .range = SCENE_FRACTION, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_MASS_NORM),
     .about = "estimated error of the change of velocity against that change, by mass"},
    {"normalised", SCENE_NUMBER, .range = SCENE_POSITIVE, INTO(struct model, tolerance),
     MEANS(struct model, stop, MODEL_STOP_NORMALISED),
     .about = "distance that the residual moves vertices in the step, against that of neighbours"},
    {"count", SCENE_INTEGER, .min = 1, INTO(struct model, max_iterations),
     MEANS(struct model, stop, MODEL_STOP_COUNT),
     .about = "so many iterations, no test"},
    {0}};
const struct scene_section scene_solver_section = {"Solver",
    "The residual misleads: where the cloth moves as a whole, it is small long before the error "
    "is. `stop.mass_norm` stops by the error itself, which conjugate gradients estimate for "
    "earlier iterations; the report gives this error for every stop (`mass_norm_error`). At the "
    "end of a solve the true residual b - A dv is computed once (but not with `stop.count`). If "
    "it is more than twice what was asked for, or with `mass_norm` as far from its recurrence as "
    "the error may be, the solve goes on from what it has, and the report counts that "
    "(`cg_restarts`). A matrix that is too stiff for the tolerance fails the solve, and its step "
    "is halved. `momentum_lost` of the report is of the true residual.\n\n"
    "`stop.normalised: e` asks for (h / l) sqrt(sum of |r_i|^2 / d_i / m) <= e over all vertices "
    "that are not held: h is the step's length (s), r_i the residual of vertex i (kg m/s), d_i "
    "its mass with h times its drag (kg), m the mass of all these vertices (kg), and l the mean "
    "length at rest of the edges of all cloths (m). The left side is how far the residual would "
    "move the vertices in the step, root mean square by mass, in mean edges, so it is the same "
    "in every system of units.\n\n"
    "Every format of the matrix gives the same motion to the tolerance of the solve. `springs` "
    "needs the least memory for a cloth of springs; half storage holds what joins any vertices. "
    "The diagonal follows from the off-diagonal values as they are rounded, so that what moves "
    "as a whole keeps its momentum in float, too.",
    "solver: {preconditioner: ic0_coarse, format: half, guess: auto, stop: {relative: 1e-6}, "
    "max_iterations: 2000}\n"};
const struct scene_rule scene_solver_keys[] = {
    {"stop", SCENE_ONE_OF, .fallback = "{mass_norm: 0.01}", .inside = stop_kinds,
     .about = "when conjugate gradients end"},
    {"guess", SCENE_CHOICE, .fallback = "auto", INTO(struct model, guess),
     WORDS({"auto", MODEL_GUESS_AUTO}, {"zero", MODEL_GUESS_ZERO}, {"previous",
     MODEL_GUESS_PREVIOUS}),
     .about = "of the change of velocity: nothing, or that of the step before; auto: that in "
     "steps shorter than 10 ms",
     .more = "`previous` begins with the multiple of the last step's change that is nearest to "
     "the solution in the norm of the matrix; it costs one and a half iterations.",
     .needs = "previous: integrator = implicit_euler and newton.steps = 1"},
    {"preconditioner", SCENE_CHOICE, .fallback = "ic0_coarse", INTO(struct model, preconditioner),
     WORDS({"none", MODEL_PLAIN}, {"jacobi", MODEL_JACOBI}, {"ic0", MODEL_IC0}, {"coarse",
     MODEL_COARSE}, {"ic0_coarse", MODEL_IC0_COARSE}),
     .about = "of conjugate gradients",
     .more = "`jacobi` has the inverses of the 3 x 3 blocks on the diagonal, `ic0` incomplete "
     "Cholesky of each block of vertices. `coarse` is `jacobi` and a coarse space of motions "
     "that are affine on each patch of a block; `ic0_coarse` is `ic0` and that space."},
    {"patches", SCENE_INTEGER, .min = 1, .max = 4, INTO(struct model, patches),
     .about = "of a block, each with motions of its own in the coarse space; else as many as pay",
     .more = "With more a solve needs fewer iterations, but all blocks wait longer in each for "
     "the coarse system. More than 256 patches in all are solved by groups, in tasks. The "
     "default is 4; it is halved while a patch would have less than 100 vertices, and once more "
     "if that leaves at most 256 patches.", .needs = "preconditioner = coarse or ic0_coarse"},
    {"format", SCENE_CHOICE, .fallback = "springs", INTO(struct model, format),
     WORDS({"springs", SOLVE_SPRINGS}, {"half", SOLVE_HALF}, {"half_float", SOLVE_HALF_FLOAT}),
     .about = "how the matrix is kept: four numbers a spring, or nine a pair of vertices, in "
     "double or float; what is more than springs takes half for springs",
     .more = "With `half_float` vectors and the diagonal are in double.",
     .needs = "springs: " NEEDS_ONLY_SPRINGS},
    {"jacobian", SCENE_CHOICE, .fallback = "definite", INTO(struct model, full_slope),
     WORDS({"definite", PHYS_DEFINITE}, {"full", PHYS_FULL}, {"absolute", PHYS_ABSOLUTE}),
     .about = "definite: without what could make the matrix indefinite; full: the whole slope; "
     "absolute: of compressed springs its absolute value",
     .more = "`full` leaves out the slope of damping against positions alone. By `absolute` a "
     "compressed spring resists being turned as strongly as it pushes, for cloth that crumples "
     "in long steps.", .needs = "absolute: " NEEDS_SPRINGS},
    {"max_iterations", SCENE_INTEGER, .fallback = "10000", .min = 1,
     INTO(struct model, max_iterations),
     .about = "a solve that needs more fails", .needs = "no stop.count"},
    {0}};
const struct scene_section scene_newton_section = {"Newton steps", "An implicit step makes at "
    "most `steps` Newton steps, each with a line search. A single one is the linear step, "
    "without line search.",
    "newton: {steps: 8, tolerance: 1e-6}\n"};
const struct scene_rule scene_newton_keys[] = {
    {"steps", SCENE_INTEGER, .fallback = "1", .min = 1, .max = 100,
     INTO(struct model, newton_steps),
     .about = "at most; 1: one linear step"},
    {"tolerance", SCENE_NUMBER, .fallback = "1e-4", .range = SCENE_FRACTION,
     INTO(struct model, newton_tolerance),
     .about = "the step ends when a Newton step changed the velocity by at most so much of the "
     "change in the whole step, by mass", .needs = "steps > 1"},
    {0}};

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
     SECTION("Scientific frames",
     "A run with `--output DIR` writes an HDF5 file for each frame, too: "
     "`DIR/hdf5/frame-000000.vtkhdf` and so on. duite needs HDF5 when it is built, which the "
     "summary of `configure` tells; a scene that asks for it in a build without is an error.\n\n"
     "| field | of each | |\n"
     "|---|---|---|\n"
     "| `Points` | vertex | where it is, m; always there |\n"
     "| `velocity` | vertex | m/s; by `symplectic_euler` that of half a step before |\n"
     "| `block`, `rank` | vertex | its block, and the rank that keeps the block; -1 where no "
     "triangle or edge has the vertex |\n"
     "| `contact_force` | vertex | N, as in `contact.pc2`; with `contact: {mode: certified, "
     "force: on}` |\n"
     "| `strain` | cell | the largest principal strain of a triangle, against its shape at rest, "
     "of any material; of an edge without triangles its length against that at rest, less 1 |\n"
     "| `stress` | cell | N/m along warp, along weft, and of shear: what `model: triangles` "
     "resists with, without damping; NaN in other materials |\n\n"
     "Vertices are numbered as in `cloth.obj`; the partners of a weld have the same numbers. "
     "Cells are the triangles of all cloths, then the edges without triangles. The layout is "
     "VTKHDF 1.0, an unstructured grid. Frames are the same on any ranks and threads, but for "
     "`rank`. Two indexes lie in `DIR`: `cloth.xmf`, and `cloth.vtkhdf.series` for ParaView from "
     "5.12 on. ParaView 5.11 opens `cloth.xmf`:\n\n"
     "    paraview DIR/cloth.xmf\n\n"
     "A thread writes the frames while the next steps run. Two frames at most wait in memory; "
     "then the run waits for the disk. A frame has its name when it is whole, and the indexes "
     "name it then: a run that is killed leaves whole frames. A frame that cannot be written is "
     "left out, with a warning at once; the run goes on, and ends with an error that counts such "
     "frames. A run with `--restart` keeps the frames up to its checkpoint, with their entries "
     "in the indexes, and goes on behind them; where its scene has no `output.hdf5`, too, they "
     "stay.",
     "output: {hdf5: {fields: [velocity, strain, stress], precision: double, every: 2, "
     "compression: 4}}\n")},
    {0}};
