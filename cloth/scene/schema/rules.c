/* The schema 1 of scenes. This table is the only place that knows keys, units, ranges and defaults:
 * files are checked against it, defaults are taken from it, and the list of keys is printed from
 * it. docs/scene.md describes it. */
#include "cloth/scene/schema/rules.h"

#include "cloth/scene/schema/fabrics.h"

static const struct scene_rule number = {.type = SCENE_NUMBER};
static const struct scene_rule positive = {.type = SCENE_NUMBER, .range = SCENE_POSITIVE};
static const struct scene_rule vertex = {.type = SCENE_INTEGER};
static const struct scene_rule point = {
    .type = SCENE_LIST, .length = 3, .inside = &number, .unit = "m"};
static const struct scene_rule edge = {.type = SCENE_LIST, .length = 2, .inside = &vertex};
static const struct scene_rule triangle = {.type = SCENE_LIST, .length = 3, .inside = &vertex};

static const char *const cells[] = {"mirrored", "alternate", "same", "equilateral", NULL};
/* clang-format off */
static const struct scene_rule grid_keys[] = {
    {"width", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE, .about = "along x"},
    {"height", SCENE_NUMBER, "m", .range = SCENE_POSITIVE,
     .about = "along z; left out where cells are equilateral, of which it follows"},
    {"nx", SCENE_INTEGER, .required = true, .least = 2, .about = "vertices along x"},
    {"ny", SCENE_INTEGER, .required = true, .least = 2, .about = "vertices along z"},
    {"cells", SCENE_CHOICE, .fallback = "mirrored", .words = cells,
     .about = "how their diagonals run: mirrored at the middle lines of the sheet, by turns, alike; "
              "or equilateral triangles"},
    {0}};

static const struct scene_rule inline_keys[] = {
    {"vertices", SCENE_LIST, "m", .required = true, .filled = true, .inside = &point,
     .about = "positions [x, y, z]"},
    {"edges", SCENE_LIST, .fallback = "[]", .inside = &edge,
     .about = "pairs of vertices: edges without triangles"},
    {"triangles", SCENE_LIST, .fallback = "[]", .inside = &triangle,
     .about = "triples of vertices"},
    {0}};

static const struct scene_rule mesh_kinds[] = {
    {"grid", SCENE_MAP, .inside = grid_keys, .about = "a flat sheet in the x-z plane"},
    {"file", SCENE_TEXT, .about = "an OBJ file, relative to the scene's folder"},
    {"inline", SCENE_MAP, .inside = inline_keys, .about = "a mesh written out"},
    {0}};

static const struct scene_rule transform_keys[] = {
    {"scale", SCENE_NUMBER_OR_LIST, .fallback = "1", .range = SCENE_POSITIVE, .length = 3,
     .inside = &positive, .about = "first: a factor, or one for each axis"},
    {"rotate", SCENE_LIST, .fallback = "[1, 0, 0, 0]", .length = 4, .inside = &number,
     .about = "then: a quaternion [w, x, y, z]"},
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "last: a shift"},
    {0}};

static const struct scene_rule quaternion = {
    .type = SCENE_LIST, .length = 4, .inside = &number};
static const struct scene_rule motion_keys[] = {
    {"times", SCENE_LIST, "s", .required = true, .filled = true, .inside = &number,
     .about = "of the key frames, ascending"},
    {"translate", SCENE_LIST, "m", .inside = &point, .about = "a shift for each time"},
    {"rotate", SCENE_LIST, .inside = &quaternion,
     .about = "a quaternion [w, x, y, z] for each time"},
    {"about", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "the point that is rotated about"},
    {0}};

/* How vertices are chosen, one of these. */
/* clang-format off */
#define PICK \
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &vertex, \
     .about = "in the mesh's numbering"}, \
    {"nearest", SCENE_LIST, "m", .choice = true, .length = 3, .inside = &number, \
     .about = "the vertex nearest to a point"}, \
    {"radius", SCENE_NUMBER, "m", .range = SCENE_NOT_NEGATIVE, \
     .about = "of nearest: and all vertices within it"}, \
    {"box", SCENE_LIST, "m", .choice = true, .length = 2, .inside = &point, \
     .about = "all vertices in the box between two corners"}
/* clang-format on */

static const char *const guides[] = {"point", "line", "plane", NULL};
static const struct scene_rule pin_keys[] = {
    PICK,
    {"to", SCENE_CHOICE, .fallback = "point", .words = guides,
     .about = "where they are held: each at a point, or on a line or plane through it"},
    {"direction", SCENE_LIST, .length = 3, .inside = &number,
     .about = "of the line, of any length but 0"},
    {"normal", SCENE_LIST, .length = 3, .inside = &number,
     .about = "to the plane, of any length but 0"},
    {"motion", SCENE_MAP, .inside = motion_keys,
     .about = "of the vertices, or of their lines or planes, by key frames"},
    {0}};
static const struct scene_rule pin = {.type = SCENE_MAP, .inside = pin_keys};

static const char *const probe_values[] = {"position", "velocity", "reaction", "total", NULL};
static const struct scene_rule probe_value = {.type = SCENE_CHOICE, .words = probe_values};
static const struct scene_rule probe_keys[] = {
    {"name", SCENE_TEXT, .about = "unique, of letters, digits, _ and -; else probe1, probe2, ..."},
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"},
    PICK,
    {"values", SCENE_LIST, .filled = true, .fallback = "[position, velocity, reaction]",
     .inside = &probe_value,
     .about = "of each vertex position, velocity, reaction; total: the sum of their reactions"},
    {0}};
static const struct scene_rule probe = {.type = SCENE_MAP, .inside = probe_keys};

static const struct scene_rule beat = {.type = SCENE_LIST, .length = 2, .inside = &number};
static const struct scene_rule sine_keys[] = {
    {"frequency", SCENE_NUMBER, "1/s", .required = true, .range = SCENE_POSITIVE,
     .about = "turns a second"},
    {"phase", SCENE_NUMBER, .fallback = "0", .about = "turns at time 0; 0.25: a cosine"},
    {0}};
static const struct scene_rule course_kinds[] = {
    {"keys", SCENE_LIST, .filled = true, .inside = &beat,
     .about = "[time in s, factor], times ascending; linear in between"},
    {"sine", SCENE_MAP, .inside = sine_keys, .about = "sin 2 pi (frequency t + phase)"},
    {0}};

static const struct scene_rule load_keys[] = {
    PICK,
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &edge,
     .about = "pairs of vertices: the force is along them, in N/m of their length at rest"},
    {"force", SCENE_LIST, "N", .required = true, .length = 3, .inside = &number,
     .about = "on each of the vertices"},
    {"course", SCENE_ONE_OF, .inside = course_kinds,
     .about = "what the force is multiplied by in time; else it is constant"},
    {0}};
static const struct scene_rule load = {.type = SCENE_MAP, .inside = load_keys};

static const struct scene_rule mass_keys[] = {PICK,
                                              {"mass", SCENE_NUMBER, "kg", .required = true,
                                               .range = SCENE_POSITIVE,
                                               .about = "more, at each of the vertices"},
                                              {0}};
static const struct scene_rule mass = {.type = SCENE_MAP, .inside = mass_keys};

static const struct scene_rule wave_keys[] = {
    {"vector", SCENE_LIST, "1/m", .required = true, .length = 3, .inside = &number,
     .about = "waves a metre along each axis, by where the mesh has the vertices"},
    {"phase", SCENE_NUMBER, .fallback = "0", .about = "in waves, at the point `about`"},
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "a shift, times the sine"},
    {"velocity", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "added, times the sine"},
    {0}};

static const struct scene_rule start_keys[] = {
    PICK,
    {"scale", SCENE_NUMBER_OR_LIST, .fallback = "1", .range = SCENE_POSITIVE, .length = 3,
     .inside = &positive, .about = "first: a factor, or one for each axis"},
    {"rotate", SCENE_LIST, .fallback = "[1, 0, 0, 0]", .length = 4, .inside = &number,
     .about = "then: a quaternion [w, x, y, z]"},
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "last: a shift"},
    {"about", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "the point that is scaled, rotated and spun about"},
    {"velocity", SCENE_LIST, "m/s", .length = 3, .inside = &number,
     .about = "instead of what it was before"},
    {"spin", SCENE_LIST, "rad/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "added: the velocity of a rigid turn about the point"},
    {"wave", SCENE_MAP, .inside = wave_keys,
     .about = "added: a sine over the mesh, of the place or the velocity"},
    {0}};
static const struct scene_rule start = {.type = SCENE_MAP, .inside = start_keys};

static const struct scene_rule region_keys[] = {
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &vertex,
     .about = "in the mesh's numbering"},
    {"box", SCENE_LIST, "m", .choice = true, .length = 2, .inside = &point,
     .about = "all vertices in the box between two corners"},
    {"material", SCENE_TEXT, .required = true, .about = "of what has all its vertices there"},
    {0}};
static const struct scene_rule region = {.type = SCENE_MAP, .inside = region_keys};

static const char *const rests[] = {"position", "uv", NULL};
static const struct scene_rule cloth_keys[] = {
    {"name", SCENE_TEXT, .about = "unique; else cloth1, cloth2, ..."},
    {"mesh", SCENE_ONE_OF, .required = true, .inside = mesh_kinds, .about = "its shape at rest"},
    {"transform", SCENE_MAP, .fallback = "{}", .inside = transform_keys,
     .about = "of the mesh, before lengths and masses are taken"},
    {"material", SCENE_TEXT, .required = true, .about = "a name in materials"},
    {"regions", SCENE_LIST, .fallback = "[]", .inside = &region,
     .about = "parts of other materials; the last one that has an element counts"},
    {"rest", SCENE_CHOICE, .fallback = "position", .words = rests,
     .about = "where the shape at rest is taken from; uv: in m"},
    {"mass_per_vertex", SCENE_NUMBER, "kg", .range = SCENE_POSITIVE,
     .about = "instead of density times area"},
    {"velocity", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "at the start"},
    {"pins", SCENE_LIST, .fallback = "[]", .inside = &pin, .about = "vertices held, or moved"},
    {"loads", SCENE_LIST, .fallback = "[]", .inside = &load, .about = "forces on vertices"},
    {"masses", SCENE_LIST, .fallback = "[]", .inside = &mass, .about = "more mass of vertices"},
    {"start", SCENE_LIST, .fallback = "[]", .inside = &start,
     .about = "how vertices start, where that is not the mesh's shape"},
    {0}};
static const struct scene_rule cloth = {.type = SCENE_MAP, .inside = cloth_keys};

static const struct scene_rule damping_keys[] = {
    {"viscous", SCENE_NUMBER, "kg/s", "0", .range = SCENE_NOT_NEGATIVE, .about = "a vertex"},
    {"mass", SCENE_NUMBER, "1/s", "0", .range = SCENE_NOT_NEGATIVE, .about = "times the mass"},
    {"stiffness", SCENE_NUMBER, "s", "0", .range = SCENE_NOT_NEGATIVE,
     .about = "along a spring, times its stiffness"},
    {"bending", SCENE_NUMBER, "s", .range = SCENE_NOT_NEGATIVE,
     .about = "times the stiffness of what resists bending; else as stiffness"},
    {0}};

static const char *const models[] = {"springs", "triangles", NULL};
static const char *const bendings[] = {"hinge", "quadratic", NULL};
static const char *const exactness[] = {"exact", "uncorrected", NULL};
static const struct scene_rule not_negative = {.type = SCENE_NUMBER, .range = SCENE_NOT_NEGATIVE};
static const struct scene_rule bending_keys[] = {
    {"model", SCENE_CHOICE, .fallback = "hinge", .words = bendings,
     .about = "quadratic: of cloths that are flat at rest"},
    {"rigidity", SCENE_NUMBER_OR_LIST, "N m", .required = true, .range = SCENE_NOT_NEGATIVE,
     .length = 2, .inside = &not_negative, .about = "one, or those of warp and weft"},
    {0}};
static const char *const diagonals[] = {"both", "one", NULL};

static const struct scene_rule material_keys[] = {
    {"like", SCENE_CHOICE, .words = scene_fabric_names,
     .about = "a measured one, whose values stand where none are given"},
    {"density", SCENE_NUMBER, "kg/m^2", .range = SCENE_POSITIVE,
     .about = "mass of an area; but where cloths have mass_per_vertex"},
    {"model", SCENE_CHOICE, .fallback = "springs", .words = models,
     .about = "what resists being stretched"},
    {"stretch", SCENE_NUMBER_OR_LIST, "N/m", .range = SCENE_NOT_NEGATIVE, .length = 2,
     .inside = &not_negative,
     .about = "modulus of triangles, or along threads or edges: one, or those of warp and weft"},
    {"ea", SCENE_NUMBER, "N", .range = SCENE_NOT_NEGATIVE,
     .about = "force / strain of edges without triangles: chains, ropes"},
    {"shear", SCENE_NUMBER, "N/m", "0", .range = SCENE_NOT_NEGATIVE,
     .about = "of springs along the diagonals of grids; of triangles"},
    {"poisson", SCENE_NUMBER, .fallback = "0",
     .about = "triangles: how much a pull along the warp narrows along the weft"},
    {"forces", SCENE_CHOICE, .fallback = "exact", .words = exactness,
     .about = "triangles: uncorrected ones leave a torque, as in the papers"},
    {"bend", SCENE_NUMBER, "N/m", "0", .range = SCENE_NOT_NEGATIVE,
     .about = "of springs over two edges"},
    {"bending", SCENE_MAP, .inside = bending_keys, .about = "rigidity about edges"},
    {"damping", SCENE_MAP, .fallback = "{}", .inside = damping_keys, .about = "of motion"},
    {"diagonals", SCENE_CHOICE, .fallback = "both", .words = diagonals,
     .about = "shear springs in a cell of a grid"},
    {0}};
static const struct scene_rule material = {.type = SCENE_MAP, .inside = material_keys};

static const struct scene_rule plane_keys[] = {
    {"point", SCENE_LIST, "m", .required = true, .length = 3, .inside = &number,
     .about = "any point of it"},
    {"normal", SCENE_LIST, .required = true, .length = 3, .inside = &number,
     .about = "towards the free side, of any length but 0"},
    {0}};
static const struct scene_rule obstacle_kinds[] = {
    {"plane", SCENE_MAP, .inside = plane_keys, .about = "a floor or wall"}, {0}};
static const struct scene_rule obstacle = {.type = SCENE_ONE_OF, .inside = obstacle_kinds};

static const struct scene_rule air_keys[] = {
    {"density", SCENE_NUMBER, "kg/m^3", "1.2", .range = SCENE_POSITIVE, .about = "of the air"},
    {"wind", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "the same everywhere"},
    {"course", SCENE_ONE_OF, .inside = course_kinds,
     .about = "what the wind is multiplied by in time; else it is constant"},
    {"normal", SCENE_NUMBER, .fallback = "1.2", .range = SCENE_NOT_NEGATIVE,
     .about = "coefficient of the drag across a triangle"},
    {"tangent", SCENE_NUMBER, .fallback = "0.01", .range = SCENE_NOT_NEGATIVE,
     .about = "of the friction along it"},
    {0}};

static const struct scene_rule rest_keys[] = {
    {"speed", SCENE_NUMBER, "m/s", "0.001", .range = SCENE_POSITIVE,
     .about = "no vertex is faster"},
    {"hold", SCENE_NUMBER, "s", "0.1", .range = SCENE_NOT_NEGATIVE, .about = "for so long"},
    {0}};
static const char *const switches[] = {"on", "off", NULL};
static const struct scene_rule time_keys[] = {
    {"h", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE, .about = "of a step"},
    {"end", SCENE_NUMBER, "s", .required = true, .range = SCENE_POSITIVE,
     .about = "round(end / h) steps are made"},
    {"fps", SCENE_NUMBER, "1/s", "25", .range = SCENE_POSITIVE, .about = "frames a second"},
    {"halving", SCENE_CHOICE, .fallback = "on", .words = switches,
     .about = "a step that fails is made anew with half the length, down to h/1024"},
    {"stretch_growth", SCENE_NUMBER, .fallback = "0.1", .range = SCENE_NOT_NEGATIVE,
     .about = "largest stretch of an edge may grow by so much in a step; 0: by any"},
    {"stretch_limit", SCENE_NUMBER, .fallback = "0", .range = SCENE_NOT_NEGATIVE,
     .about = "and no step may stretch beyond, length / length at rest; 0: no limit"},
    {"energy_growth", SCENE_NUMBER, .fallback = "0.005", .range = SCENE_NOT_NEGATIVE,
     .about =
         "an implicit step may end so much above an earlier energy, where nothing does work on "
         "the cloth, as part of the energy of motion and strain, or of what weights and loads "
         "can set free; 0: by any"},
    {"rest", SCENE_MAP, .inside = rest_keys, .about = "the run ends when the cloth is at rest"},
    {0}};

static const struct scene_rule stop_kinds[] = {
    {"relative", SCENE_NUMBER, .range = SCENE_FRACTION, .about = "residual against the right side"},
    {"absolute", SCENE_NUMBER, "kg m/s", .range = SCENE_POSITIVE, .about = "residual"},
    {"mass_norm", SCENE_NUMBER, .range = SCENE_FRACTION,
     .about = "error of the change of velocity against it, by mass"},
    {"normalised", SCENE_NUMBER, .range = SCENE_POSITIVE,
     .about = "distance that the residual moves vertices in the step, against that of neighbours"},
    {"count", SCENE_INTEGER, .least = 1, .about = "so many iterations, no test"},
    {0}};
static const char *const preconditioners[] = {"none",   "jacobi",     "ic0",
                                              "coarse", "ic0_coarse", NULL};
static const char *const formats[] = {"springs", "half", "half_float", NULL};
static const char *const jacobians[] = {"definite", "full", "absolute", NULL};
static const char *const guesses[] = {"auto", "zero", "previous", NULL};
static const struct scene_rule solver_keys[] = {
    {"stop", SCENE_ONE_OF, .fallback = "{mass_norm: 0.01}", .inside = stop_kinds,
     .about = "when conjugate gradients end"},
    {"guess", SCENE_CHOICE, .fallback = "auto", .words = guesses,
     .about = "of the change of velocity: nothing, or that of the step before"},
    {"preconditioner", SCENE_CHOICE, .fallback = "ic0_coarse", .words = preconditioners,
     .about = "of conjugate gradients"},
    {"patches", SCENE_INTEGER, .least = 1, .most = 4,
     .about = "of a block, each with motions of its own in the coarse space; else as many as pay"},
    {"format", SCENE_CHOICE, .fallback = "springs", .words = formats,
     .about =
         "how the matrix is kept: four numbers a spring, or nine a pair of vertices, in double "
         "or float; triangles and bending take half for springs"},
    {"jacobian", SCENE_CHOICE, .fallback = "definite", .words = jacobians,
     .about = "definite: without what could make the matrix indefinite; full: the whole slope; "
              "absolute: of compressed springs its absolute value"},
    {"max_iterations", SCENE_INTEGER, .fallback = "10000", .least = 1,
     .about = "a solve that needs more fails"},
    {0}};

static const char *const contacts[] = {"project", "filter", NULL};
static const char *const integrators[] = {
    "implicit_euler", "explicit_euler", "symplectic_euler", "verlet", "rk4", "bdf2", NULL};
static const char *const energies[] = {"ends", "steps", NULL};
static const struct scene_rule newton_keys[] = {
    {"steps", SCENE_INTEGER, .fallback = "1", .least = 1, .most = 100,
     .about = "at most; 1: one linear step"},
    {"tolerance", SCENE_NUMBER, .fallback = "1e-4", .range = SCENE_FRACTION,
     .about = "last change of velocity against that of the step, by mass"},
    {0}};

static const struct scene_rule scene_keys[] = {
    {"schema", SCENE_INTEGER, .required = true, .least = 1, .most = 1,
     .about = "version of these rules"},
    {"name", SCENE_TEXT, .about = "of the scene; else the file's name"},
    {"gravity", SCENE_LIST, "m/s^2", .fallback = "[0, -9.81, 0]", .length = 3, .inside = &number,
     .about = "+y is up"},
    {"air", SCENE_MAP, .inside = air_keys,
     .about = "drag and wind on triangles; else there is none"},
    {"cloths", SCENE_LIST, .required = true, .filled = true, .inside = &cloth,
     .about = "what moves"},
    {"materials", SCENE_NAMED, .inside = &material,
     .about = "NAME is yours; rib_knit, silk, denim and polycotton are there"},
    {"obstacles", SCENE_LIST, .fallback = "[]", .inside = &obstacle, .about = "what does not move"},
    {"contact", SCENE_CHOICE, .fallback = "project", .words = contacts,
     .about = "how obstacles are met"},
    {"time", SCENE_MAP, .required = true, .inside = time_keys, .about = "of the simulation"},
    {"integrator", SCENE_CHOICE, .fallback = "implicit_euler", .words = integrators,
     .about = "how a step is made"},
    {"energies", SCENE_CHOICE, .fallback = "ends", .words = energies,
     .about = "the report's: of start and end, or after each step too"},
    {"newton", SCENE_MAP, .fallback = "{}", .inside = newton_keys,
     .about = "Newton steps, with a line search, of implicit steps"},
    {"solver", SCENE_MAP, .fallback = "{}", .inside = solver_keys, .about = "of implicit steps"},
    {"probes", SCENE_LIST, .fallback = "[]", .inside = &probe,
     .about = "what probes.csv tells after each step"},
    {"grain", SCENE_INTEGER, .fallback = "1000", .least = 1, .about = "vertices a block"},
    {0}};
/* clang-format on */

const struct scene_rule scene_root = {.type = SCENE_MAP, .inside = scene_keys};
