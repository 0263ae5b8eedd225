/* Keys of materials. */
#include "cloth/scene/schema/tables.h"

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

#define SIZE(name, text) \
    {name, SCENE_LIST, .filled = true, .inside = &scene_curve_key, .about = text}
static const struct scene_rule size_keys[] = {
    SIZE("both", "[time in s, factor], times ascending, linear in between: of warp and weft"),
    SIZE("warp", "the same along the warp alone"),
    SIZE("weft", "along the weft alone"),
    {0}};

static const struct scene_rule curve_point = {
    .type = SCENE_LIST, .length = 2, .inside = &scene_positive};
static const struct scene_rule curve_keys[] = {
    {"warp", SCENE_LIST, .required = true, .filled = true, .max = PHYS_KNEES + 1,
     .inside = &curve_point, .about = "pairs [strain, N/m], both ascending"},
    {"weft", SCENE_LIST, .filled = true, .max = PHYS_KNEES + 1, .inside = &curve_point,
     .about = "else as the warp"},
    {0}};

/* ---- Sheets of instruments (instruments.c) ---- */

static const struct scene_rule measured = {.type = SCENE_NUMBER, .range = SCENE_POSITIVE,
                                           ITEM(double)};
#define SHEET(name, in, text) \
    {name, SCENE_NUMBER_OR_LIST, in, .range = SCENE_POSITIVE, .length = 2, .inside = &measured, \
     .about = text}
static const struct scene_rule kes_keys[] = {
    SHEET("EMT", "%", "strain at 500 gf/cm: of warp and weft, as all of these, or one for both"),
    SHEET("LT", NULL, "linearity of the extension; else 1"),
    SHEET("RT", "%", "resilience of the extension"),
    SHEET("G", "gf/cm degree", "shear stiffness"),
    SHEET("2HG", "gf/cm", "hysteresis of shear at 0.5 degrees"),
    SHEET("B", "gf cm^2/cm", "bending rigidity"),
    SHEET("2HB", "gf cm/cm", "hysteresis of bending"),
    SHEET("MIU", NULL, "friction of the surface"),
    {"T", SCENE_NUMBER, "mm", .range = SCENE_POSITIVE, .about = "thickness at 0.5 gf/cm^2"},
    {"LC", SCENE_NUMBER, .range = SCENE_POSITIVE, .about = "linearity of the compression; else 1",
     .needs = "WC"},
    {"WC", SCENE_NUMBER, "gf cm/cm^2", .range = SCENE_POSITIVE,
     .about = "energy of the compression to 50 gf/cm^2", .needs = "T"},
    {"W", SCENE_NUMBER, "mg/cm^2", .range = SCENE_POSITIVE, .about = "weight"},
    {0}};
static const struct scene_rule fast_keys[] = {
    SHEET("E5", "%", "strain at 5 gf/cm: of warp and weft, as all of these, or one for both"),
    SHEET("E20", "%", "strain at 20 gf/cm"),
    SHEET("E100", "%", "strain at 100 gf/cm"),
    SHEET("EB5", "%", "strain on the bias at 5 gf/cm"),
    SHEET("G", "N/m", "shear rigidity; else 123 / EB5"),
    SHEET("C", "mm", "bending length"),
    SHEET("B", "uN m", "bending rigidity; else by W and C"),
    {"T2", SCENE_NUMBER, "mm", .range = SCENE_POSITIVE, .about = "thickness at 2 gf/cm^2"},
    {"T100", SCENE_NUMBER, "mm", .range = SCENE_POSITIVE, .about = "thickness at 100 gf/cm^2",
     .needs = "T2"},
    {"W", SCENE_NUMBER, "g/m^2", .range = SCENE_POSITIVE, .about = "weight"},
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
    {"kes", SCENE_MAP, .inside = kes_keys, .apart = true,
     .about = "what Kawabata's instruments print, which gives values where none are given",
     .section = "Sheets of instruments"},
    {"fast", SCENE_MAP, .inside = fast_keys, .apart = true,
     .about = "the same of the FAST instruments", .section = "Sheets of instruments"},
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
     .needs = NEEDS_OWN_TRIANGLES},
    {"stretch_curve", SCENE_MAP, .inside = curve_keys,
     .about = "in place of stretch, of triangles: how threads stiffen",
     .needs = "model = triangles", .section = "Curves of stretch"},
    {"ea", SCENE_NUMBER, "N", .range = SCENE_NOT_NEGATIVE, INTO(struct model_material, ea),
     .about = "force / strain of edges without triangles: chains, ropes",
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
     "([physics.md](physics.md#limits-of-strain))", .needs = NEEDS_OWN_EDGES},
    {"velocity_correction", SCENE_MAP, .inside = correction_keys,
     .about = "impulses after a step's solve, so that no edge ends it stretched too far "
     "([physics.md](physics.md#velocity-correction))", .needs = NEEDS_OWN_EDGES},
    {"damping", SCENE_MAP, .fallback = "{}", .inside = damping_keys, .about = "of motion"},
    {"size", SCENE_MAP, .filled = true, .inside = size_keys,
     .about = "what its lengths at rest are multiplied by in time, to shrink and to grow "
     "([physics.md](physics.md#sizes)); strains and colours of frames are against the mesh", .needs = NEEDS_OWN_EDGES},
    {"friction", SCENE_NUMBER, .range = SCENE_COEFFICIENT, INTO(struct model_material, friction),
     .about = "coefficient of contact; else that of contact", .needs = NEEDS_MET},
    {"thickness", SCENE_NUMBER, "m", .range = SCENE_POSITIVE,
     INTO(struct model_material, thickness),
     .about = "of which a contact has half on this side; else that of contact",
     .needs = NEEDS_MET},
    {"pressure", SCENE_NUMBER, "Pa", .range = SCENE_POSITIVE,
     INTO(struct model_material, pressure),
     .about = "by which it is half as thick; else that of contact", .needs = NEEDS_CERTIFIED},
    {"diagonals", SCENE_CHOICE, .fallback = "both", INTO(struct model_material, both_diagonals),
     WORDS({"both", true}, {"one", false}),
     .about = "shear springs in a cell of a grid"},
    {0}};
const struct scene_rule scene_material = {.type = SCENE_MAP, .inside = material_keys};
