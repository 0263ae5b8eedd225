/* Keys of materials. */
#include "cloth/scene/schema/tables.h"

#include "cloth/scene/schema/fabrics.h"

/* clang-format off */
static const struct scene_rule damping_keys[] = {
    {"viscous", SCENE_NUMBER, "kg/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_viscous),
     .about = "a vertex"},
    {"mass", SCENE_NUMBER, "1/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_mass),
     .about = "times the mass"},
    {"stiffness", SCENE_NUMBER, "s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_stiffness),
     .about = "along a spring, times its stiffness; of triangles and bending likewise, on what "
     "changes their shape"},
    {"bending", SCENE_NUMBER, "s", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, damping_excess),
     .about = "times the stiffness of bending and of bend springs; else as stiffness",
     .needs = "bend or bending"},
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
     INTO(struct model_material, limit_strain),
     .about = "strain from which on it acts; 0.1: 10 %"},
    {"stiffness", SCENE_NUMBER, "N/m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_material, limit_stiffness),
     .about = "of one more spring of each edge beyond it"},
    {0}};

static const struct scene_rule correction_keys[] = {
    {"at", SCENE_NUMBER, .fallback = "0.1", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, correction.at),
     .about = "strain that no edge is to end a step beyond"},
    {"tolerance", SCENE_NUMBER, .fallback = "0.01", .range = SCENE_POSITIVE,
     INTO(struct model_material, correction.tolerance),
     .about = "strain beyond it that corrections may leave"},
    {"rounds", SCENE_INTEGER, .fallback = "100", .min = 1,
     INTO(struct model_material, correction.rounds),
     .about = "at most in a step"},
    {0}};

/* The list of two takes the member that follows, too. */
#define STRETCH_AND_WEFT \
    .field = {offsetof(struct model_material, stretch), sizeof(double[2]), \
              "struct model_material", sizeof(struct model_material)}
_Static_assert(offsetof(struct model_material, weft_excess) ==
               offsetof(struct model_material, stretch) + sizeof(double), "weft after warp");
const struct scene_section scene_materials_section = {"Materials",
    "[physics.md](physics.md#fabrics) has the values of the four fabrics that every scene knows. "
    "Triangles whose `shear` is 0 draw a warning, as nothing resists their being sheared; so do "
    "a `density` outside 0.005 to 5 kg/m^2, a `bending.rigidity` above 0.01 N m, and a `stretch` "
    "of 0 that triangles have.",
    "materials:\n"
    "  cotton: {density: 0.2, stretch: 5000, shear: 2500, bend: 10, damping: {viscous: 0.0001, "
    "mass: 0.1, stiffness: 0.01}}\n"
    "  canvas: {like: denim, damping: {stiffness: 0.001}}       # denim, but with damping\n"
    "  rope: {ea: 500}                                          # of a chain\n"
    "  woven: {density: 0.15, model: triangles, stretch: [4000, 2000], shear: 30, poisson: 0.2, "
    "bending: {rigidity: [2e-6, 1e-6]}}\n"};
static const struct scene_rule material_keys[] = {
    {"like", SCENE_CHOICE, .words = scene_fabrics,
     .about = "a measured one, whose values stand where none are given"},
    {"density", SCENE_NUMBER, "kg/m^2", .range = SCENE_POSITIVE,
     INTO(struct model_material, density),
     .about = "mass of an area; optional where all its cloths have mass_per_vertex"},
    {"model", SCENE_CHOICE, .fallback = "springs", INTO(struct model_material, model),
     WORDS({"springs", MODEL_SPRINGS}, {"triangles", MODEL_TRIANGLES}),
     .about = "what resists being stretched: springs, or the mesh's triangles as a membrane "
     "([physics.md](physics.md#triangles))"},
    {"stretch", SCENE_NUMBER_OR_LIST, "N/m", .range = SCENE_NOT_NEGATIVE, .length = 2,
     .inside = &not_negative, STRETCH_AND_WEFT,
     .about = "modulus of triangles, or along threads or edges: one, or those of warp and weft",
     .more = "Required where a cloth of the material has triangles. Threads are those of grids; "
     "of other meshes with springs it is of edges, which need uv for two moduli. "
     "[physics.md](physics.md#springs) has the E, G and nu of a lattice of springs.",
     .needs = NEEDS_OWN_TRIANGLES},
    {"ea", SCENE_NUMBER, "N", .range = SCENE_NOT_NEGATIVE, INTO(struct model_material, ea),
     .about = "force / strain of edges without triangles: chains, ropes",
     .more = "Required where a cloth of the material has such edges. An edge is one spring of "
     "`ea` / its length at rest (N/m), so a chain is as stiff however many links it has.",
     .needs = NEEDS_OWN_LINKS},
    {"shear", SCENE_NUMBER, "N/m", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, shear),
     .about = "modulus of springs along the diagonals of grids; of triangles",
     .needs = NEEDS_DIAGONALS},
    {"poisson", SCENE_NUMBER, .fallback = "0", INTO(struct model_material, poisson),
     .about = "nu12: how much a pull along the warp narrows along the weft; nu12^2 weft / warp "
     "is below 1", .needs = "model = triangles"},
    {"forces", SCENE_CHOICE, .fallback = "exact", INTO(struct model_material, uncorrected),
     WORDS({"exact", false}, {"uncorrected", true}),
     .about = "uncorrected ones leave a torque, as in the papers",
     .needs = "uncorrected: model = triangles"},
    {"bend", SCENE_NUMBER, "N/m", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_material, bend),
     .about = "of springs over two edges; flat ones have no rigidity",
     .needs = "model = springs and " NEEDS_OWN_TRIANGLES},
    {"bending", SCENE_MAP, .inside = bending_keys,
     .about = "rigidity about all inner edges of the mesh ([physics.md](physics.md#bending)); "
     "else there is none", .needs = NEEDS_OWN_TRIANGLES},
    {"strain_limit", SCENE_MAP, .inside = limit_keys,
     .about = "springs that pull edges back which are stretched too far "
     "([physics.md](physics.md#limits-of-strain))",
     .more = "It is of all edges, with or without triangles; on grids of springs it is of the "
     "edges along the threads.", .needs = NEEDS_OWN_EDGES},
    {"velocity_correction", SCENE_MAP, .inside = correction_keys,
     .about = "impulses after a step's solve, so that no edge ends it stretched too far "
     "([physics.md](physics.md#velocity-correction))",
     .more = "`strain_limit` is a spring, which gives way under a load; this is no force and "
     "does not. It is of the same edges, across welds too: where a weld makes two edges one, the "
     "first one's counts. `{}` is all defaults.", .needs = NEEDS_OWN_EDGES},
    {"damping", SCENE_MAP, .fallback = "{}", .inside = damping_keys, .about = "of motion"},
    {"friction", SCENE_NUMBER, .range = SCENE_COEFFICIENT, INTO(struct model_material, friction),
     .about = "coefficient of contact; else that of contact",
     .more = "A cloth with `regions` has that of its own material.", .needs = NEEDS_MET},
    {"diagonals", SCENE_CHOICE, .fallback = "both", INTO(struct model_material, both_diagonals),
     WORDS({"both", true}, {"one", false}),
     .about = "shear springs in a cell of a grid"},
    {0}};
const struct scene_rule scene_material = {.type = SCENE_MAP, .inside = material_keys};
