/* The rules of cloths and their keys, and of probes, which pick vertices in the same way. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
static const struct scene_rule number = {.type = SCENE_NUMBER, ITEM(double)};
static const struct scene_rule text = {.type = SCENE_TEXT};
static const struct scene_rule positive = {
    .type = SCENE_NUMBER, .range = SCENE_POSITIVE, ITEM(double)};
static const struct scene_rule vertex = {.type = SCENE_INTEGER, ITEM(uint32_t)};
static const struct scene_rule point = {
    .type = SCENE_LIST, .length = 3, .inside = &number, .unit = "m", ITEM(double[3])};
static const struct scene_rule edge = {
    .type = SCENE_LIST, .length = 2, .inside = &vertex, ITEM(uint32_t[2])};
static const struct scene_rule triangle = {
    .type = SCENE_LIST, .length = 3, .inside = &vertex, ITEM(uint32_t[3])};

static const struct scene_rule grid_keys[] = {
    {"width", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct scene_grid, width), .about = "along x"},
    {"height", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct scene_grid, height),
     .about = "along z; left out where cells are equilateral, of which it follows"},
    {"nx", SCENE_INTEGER, .required = true, .min = 2, INTO(struct scene_grid, nx),
     .about = "vertices along x"},
    {"ny", SCENE_INTEGER, .required = true, .min = 2, INTO(struct scene_grid, ny),
     .about = "vertices along z"},
    {"cells", SCENE_CHOICE, .fallback = "mirrored", INTO(struct scene_grid, cells),
     WORDS({"mirrored", MESH_MIRRORED}, {"alternate", MESH_ALTERNATE}, {"same", MESH_SAME},
           {"equilateral", MESH_EQUILATERAL}),
     .about = "how their diagonals run: mirrored at the middle lines of the sheet, by turns, "
              "alike; or equilateral triangles"},
    {0}};

static const struct scene_rule disc_keys[] = {
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct scene_disc, radius), .about = "from the middle to the border"},
    {"rings", SCENE_INTEGER, .required = true, .min = 1, .max = MESH_DISC_RINGS,
     INTO(struct scene_disc, rings), .about = "of vertices around the one in the middle"},
    {0}};

static const struct scene_rule inline_keys[] = {
    {"vertices", SCENE_LIST, "m", .required = true, .filled = true, .inside = &point,
     ARRAY(struct scene_inline, vertices, n_vertices), .about = "positions [x, y, z]"},
    {"edges", SCENE_LIST, .fallback = "[]", .inside = &edge,
     ARRAY(struct scene_inline, edges, n_edges),
     .about = "pairs of vertices: edges without triangles"},
    {"triangles", SCENE_LIST, .fallback = "[]", .inside = &triangle,
     ARRAY(struct scene_inline, triangles, n_triangles), .about = "triples of vertices"},
    {0}};

static const struct scene_rule measure = {.type = SCENE_NUMBER,
                                          INTO(struct scene_measure, value),
                                          .about = "a measure, mostly in metres"};

static const struct scene_rule pattern_keys[] = {
    {"file", SCENE_TEXT, .choice = true,
     .about = "a sewing pattern (JSON, docs/garments.md), relative to the scene's folder"},
    {"garment", SCENE_TEXT, .choice = true, INTO(struct scene_pattern, garment),
     .about = "an own garment (docs/garments.md): tshirt, trousers or skirt"},
    {"size", SCENE_TEXT, INTO(struct scene_pattern, size),
     .about = "of the garment: XS, S, M, L or XL; M unless told"},
    {"measures", SCENE_NAMED, .inside = &measure,
     ARRAY(struct scene_pattern, measures, n_measures), .name = FIELD(struct scene_measure, name),
     .about = "NAME: VALUE of those of the garment that differ from its size's"},
    {"edge", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct scene_pattern, edge),
     .about = "how long the edges of its triangles are, about"},
    {"vertices", SCENE_INTEGER, .min = 3, INTO(struct scene_pattern, vertices),
     .about = "in place of edge: how many all panels have, about"},
    {0}};

#define MESH_PLACE PLACE(struct model_cloth, mesh_place)
static const struct scene_rule mesh_keys[] = {
    {"grid", SCENE_MAP, .choice = true, .inside = grid_keys, .apart = true, MESH_PLACE,
     .about = "a flat sheet in the x-z plane"},
    {"disc", SCENE_MAP, .choice = true, .inside = disc_keys, .apart = true, MESH_PLACE,
     .about = "a round sheet in the x-z plane"},
    {"file", SCENE_TEXT, .choice = true, MESH_PLACE, .about = "an OBJ file, relative to the scene's folder"},
    {"inline", SCENE_MAP, .choice = true, .inside = inline_keys, .apart = true, MESH_PLACE,
     .about = "a mesh written out"},
    {"pattern", SCENE_MAP, .choice = true, .inside = pattern_keys, .apart = true, MESH_PLACE,
     .about = "the panels of a sewing pattern, where it places them"},
    {"weld", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct model_cloth, weld),
     .about = "vertices that lie so near to each other are one, as by welds"},
    {0}};

static const struct scene_rule transform_keys[] = {
    TRANSFORM(struct mesh_transform, ),
    {0}};

const struct model_word scene_rests[] = {{"position", false}, {"uv", true}, {0}};
const struct model_word scene_holds[] = {
    {"point", SCENE_POINT}, {"line", SCENE_LINE}, {"plane", SCENE_PLANE}, {0}};
const struct model_word scene_probe_values[] = {
    {"position", (int)offsetof(struct model_probe, position)},
    {"velocity", (int)offsetof(struct model_probe, velocity)},
    {"reaction", (int)offsetof(struct model_probe, reaction)},
    {"contact", (int)offsetof(struct model_probe, contact)},
    {"total", (int)offsetof(struct model_probe, total)},
    {"contact_total", (int)offsetof(struct model_probe, contact_total)},
    {0}};

static const struct scene_rule quaternion = {
    .type = SCENE_LIST, .length = 4, .inside = &number};
const struct scene_rule scene_motion_keys[] = {
    {"times", SCENE_LIST, "s", .required = true, .filled = true, .inside = &number,
     .about = "of the key frames, ascending"},
    {"translate", SCENE_LIST, "m", .inside = &point, .about = "a shift for each time"},
    {"rotate", SCENE_LIST, .inside = &quaternion,
     .about = "a quaternion [w, x, y, z] for each time"},
    {"about", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     .about = "the point that is rotated about"},
    {0}};

/* Ways to choose vertices, one of these: into the struct model_pick `pick` of a type. */
#define PICK_VERTICES(type, pick) \
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &vertex, \
     ARRAY(type, pick vertices, pick n_vertices), MEANS(type, pick kind, MODEL_PICK_VERTICES), \
     .about = "in the mesh's numbering"}
#define PICK_BOX(type, pick) \
    {"box", SCENE_LIST, "m", .choice = true, .length = 2, .inside = &point, \
     INTO(type, pick box), MEANS(type, pick kind, MODEL_PICK_BOX), \
     .about = "all vertices in the box between two corners"}
#define PICK_GROUP(type, pick) \
    {"group", SCENE_TEXT, .choice = true, MEANS(type, pick kind, MODEL_PICK_VERTICES), \
     .about = "all vertices of a group of the mesh's faces: of an OBJ file, or a panel"}
#define PICK(type) \
    PICK_VERTICES(type, pick.), \
    {"nearest", SCENE_LIST, "m", .choice = true, .length = 3, .inside = &number, \
     INTO(type, pick.point), MEANS(type, pick.kind, MODEL_PICK_NEAREST), \
     .about = "the vertex nearest to a point"}, \
    {"radius", SCENE_NUMBER, "m", .range = SCENE_NOT_NEGATIVE, INTO(type, pick.radius), \
     .about = "of nearest: and all vertices within it"}, \
    PICK_BOX(type, pick.), \
    PICK_GROUP(type, pick.)

static const struct scene_rule pin_keys[] = {
    PICK(struct model_pin),
    {"to", SCENE_CHOICE, .fallback = "point", .words = scene_holds,
     .about = "where they are held: each at a point, or on a line or plane through it"},
    {"direction", SCENE_LIST, .length = 3, .inside = &number,
     .about = "of the line, of any length but 0"},
    {"normal", SCENE_LIST, .length = 3, .inside = &number,
     .about = "to the plane, of any length but 0"},
    {"follow", SCENE_TEXT,
     .about = "name of an obstacle that takes the vertices along; they do not meet it"},
    {"motion", SCENE_MAP, .inside = scene_motion_keys,
     .about = "of the vertices, or of their lines or planes, by key frames"},
    {0}};
static const struct scene_rule pin = {
    .type = SCENE_MAP, .inside = pin_keys, PLACE(struct model_pin, pick.place)};

static const struct scene_rule probe_value = {.type = SCENE_CHOICE, .words = scene_probe_values};
static const struct scene_rule probe_keys[] = {
    {"name", SCENE_TEXT, INTO(struct model_probe, name),
     .about = "unique, of letters, digits, _ and -; else probe1, probe2, ..."},
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"},
    PICK(struct model_probe),
    {"obstacle", SCENE_TEXT, .choice = true, MEANS(struct model_probe, by_obstacle, true),
     .about = "its name, or number from 0: the force that it puts on all cloth"},
    {"values", SCENE_LIST, .filled = true, .fallback = "[position, velocity, reaction]",
     .inside = &probe_value,
     .about = "of each vertex position, velocity, reaction, contact: the force of it; total, "
              "contact_total: the sums of reactions, of these forces"},
    {0}};
const struct scene_rule scene_probe = {
    .type = SCENE_MAP, .inside = probe_keys, PLACE(struct model_probe, pick.place)};

static const struct scene_rule curve_key = {.type = SCENE_LIST, .length = 2, .inside = &number};
static const struct scene_rule sine_keys[] = {
    {"frequency", SCENE_NUMBER, "1/s", .required = true, .range = SCENE_POSITIVE,
     .about = "turns a second"},
    {"phase", SCENE_NUMBER, .fallback = "0", .about = "turns at time 0; 0.25: a cosine"},
    {0}};
const struct scene_rule scene_curve_kinds[] = {
    {"keys", SCENE_LIST, .filled = true, .inside = &curve_key,
     .about = "[time in s, factor], times ascending; linear in between"},
    {"sine", SCENE_MAP, .inside = sine_keys, .about = "sin 2 pi (frequency t + phase)"},
    {0}};

static const struct scene_rule load_keys[] = {
    PICK(struct model_load),
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &edge,
     ARRAY(struct model_load, edges, n_edges),
     .about = "pairs of vertices: the force is along them, in N/m of their length at rest"},
    {"force", SCENE_LIST, "N", .required = true, .length = 3, .inside = &number,
     INTO(struct model_load, force), .about = "on each of the vertices"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "what the force is multiplied by in time; else it is constant"},
    {0}};
static const struct scene_rule load = {
    .type = SCENE_MAP, .inside = load_keys, PLACE(struct model_load, pick.place)};

static const struct scene_rule mass_keys[] = {
    PICK(struct model_mass),
    {"mass", SCENE_NUMBER, "kg", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_mass, mass), .about = "more, at each of the vertices"},
    {0}};
static const struct scene_rule mass = {
    .type = SCENE_MAP, .inside = mass_keys, PLACE(struct model_mass, pick.place)};

static const struct scene_rule wave_keys[] = {
    {"vector", SCENE_LIST, "1/m", .required = true, .length = 3, .inside = &number,
     INTO(struct model_wave, vector),
     .about = "waves a metre along each axis, by where the mesh has the vertices"},
    {"phase", SCENE_NUMBER, .fallback = "0", INTO(struct model_wave, phase),
     .about = "in waves, at the point `about`"},
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     INTO(struct model_wave, translate), .about = "a shift, times the sine"},
    {"velocity", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     INTO(struct model_wave, velocity), .about = "added, times the sine"},
    {0}};

static const struct scene_rule start_keys[] = {
    PICK(struct model_start),
    TRANSFORM(struct model_start, transform.),
    {"about", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     INTO(struct model_start, about), .about = "the point that is scaled, rotated and spun about"},
    {"velocity", SCENE_LIST, "m/s", .length = 3, .inside = &number,
     INTO(struct model_start, velocity), MEANS(struct model_start, has_velocity, true),
     .about = "instead of what it was before"},
    {"spin", SCENE_LIST, "rad/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     INTO(struct model_start, spin),
     .about = "added: the velocity of a rigid turn about the point"},
    {"wave", SCENE_MAP, .inside = wave_keys, INTO(struct model_start, wave),
     .about = "added: a sine over the mesh, of the place or the velocity"},
    {0}};
static const struct scene_rule start = {
    .type = SCENE_MAP, .inside = start_keys, PLACE(struct model_start, pick.place)};

static const struct scene_rule settled_keys[] = {
    {"frames", SCENE_TEXT, .required = true,
     .about = "folder of an earlier run's --output, relative to the scene's"},
    {"frame", SCENE_NUMBER_OR_WORD, .fallback = "last", .range = SCENE_NOT_NEGATIVE,
     INTO(struct scene_settled, frame), WORDS({"last", SCENE_LAST_FRAME}),
     .about = "which one, from 0"},
    {"cloth", SCENE_TEXT, INTO(struct scene_settled, cloth),
     .about = "its name there; else the same as here"},
    {0}};
const struct scene_rule scene_settled = {.type = SCENE_MAP, .inside = settled_keys};

static const struct scene_rule region_keys[] = {
    PICK_VERTICES(struct model_pick, ),
    PICK_BOX(struct model_pick, ),
    PICK_GROUP(struct model_pick, ),
    {"material", SCENE_TEXT, .required = true, .about = "of what has all its vertices there"},
    {0}};
const struct scene_rule scene_region = {.type = SCENE_MAP, .inside = region_keys};

/* Keys of the struct model_sewing of a type, with the defaults of three. */
#define SEWING(type, of_state, of_stiffness, of_tolerance) \
    {"state", SCENE_CHOICE, .fallback = of_state, INTO(type, sewing.state), \
     WORDS({"pulled", MODEL_SEAMS_PULLED}, {"welded", MODEL_SEAMS_WELDED}, \
           {"open", MODEL_SEAMS_OPEN}), \
     .about = "pulled: a joint of rest length 0 for each pair of vertices; welded: a weld for each; " \
              "open: nothing"}, \
    {"stiffness", SCENE_NUMBER, "N/m", of_stiffness, .range = SCENE_POSITIVE, \
     INTO(type, sewing.stiffness), .about = "pulled: of each joint"}, \
    {"damping", SCENE_NUMBER, "kg/s", .range = SCENE_NOT_NEGATIVE, INTO(type, sewing.damping), \
     .about = "pulled: along each joint; else 0.1 s times the stiffness"}, \
    {"tolerance", SCENE_NUMBER, "m", of_tolerance, .range = SCENE_NOT_NEGATIVE, \
     INTO(type, sewing.tolerance), \
     .about = "welded: partners start at most so far from each other"}, \
    {"bending", SCENE_NUMBER, "N m", .range = SCENE_NOT_NEGATIVE, INTO(type, sewing.bending), \
     .about = "welded: rigidity of the hinges across them; else the materials'"}

static const struct scene_rule some_keys[] = {
    {"numbers", SCENE_LIST, .choice = true, .filled = true, .inside = &vertex,
     ARRAY(struct model_some_seams, number, n), .about = "of the seams, from 0"},
    {"of", SCENE_LIST, .choice = true, .length = 2, .inside = &text,
     .about = "names of the two panels; * stands for any characters"},
    SEWING(struct model_some_seams, NULL, NULL, NULL),
    {0}};
static const struct scene_rule some = {.type = SCENE_MAP, .inside = some_keys};

static const struct scene_rule seams_keys[] = {
    SEWING(struct model_seams, "pulled", "200", "0.002"),
    {"some", SCENE_LIST, .fallback = "[]", .inside = &some,
     ARRAY(struct model_seams, some, n_some),
     .about = "seams that are sewn otherwise; keys that are not given are the cloth's, and the last "
              "one that has a seam counts"},
    {"reversed", SCENE_LIST, .fallback = "[]", .inside = &vertex,
     ARRAY(struct model_seams, reversed, n_reversed),
     .about = "numbers of seams, from 0, that are sewn the other way round than was found"},
    {"file", SCENE_TEXT,
     .about = "of an OBJ mesh: its .seams.json, as duite-garment writes it, relative to the scene's "
              "folder"},
    {0}};

static const struct scene_rule panel_keys[] = {
    {"group", SCENE_TEXT, .required = true, .about = "of the mesh's faces, by its name"},
    {"material", SCENE_TEXT, .about = "of its triangles; else that of the cloth"},
    {"grain", SCENE_NUMBER, "degrees",
     .about = "by which the warp is turned from u towards v of its uv; else 0"},
    {0}};
static const struct scene_rule panel = {.type = SCENE_MAP, .inside = panel_keys};

static const struct scene_rule fold_edge_keys[] = {
    {"panel", SCENE_TEXT, .required = true, .about = "its name"},
    {"edge", SCENE_INTEGER, .required = true, .about = "of its edges, from 0: one that is sewn"},
    {0}};
static const struct scene_rule fold_keys[] = {
    {"vertices", SCENE_LIST, .choice = true, .filled = true, .inside = &vertex,
     ARRAY(struct model_fold, vertices, n),
     .about = "along it: an edge of the mesh joins each with the next"},
    {"edge", SCENE_MAP, .choice = true, .inside = fold_edge_keys,
     .about = "of a panel: it folds where the seam is welded"},
    {"angle", SCENE_NUMBER, "degrees", .required = true, INTO(struct model_fold, angle),
     .about = "at rest, -180 to 180; above 0: a ridge on the front"},
    {0}};
static const struct scene_rule fold = {
    .type = SCENE_MAP, .inside = fold_keys, PLACE(struct model_fold, place)};

static const struct scene_rule cloth_keys[] = {
    {"name", SCENE_TEXT, INTO(struct model_cloth, name),
     .about = "unique; else cloth1, cloth2, ..."},
    {"mesh", SCENE_MAP, .required = true, .inside = mesh_keys, .about = "its shape at rest"},
    {"transform", SCENE_MAP, .fallback = "{}", .inside = transform_keys, .apart = true,
     .about = "of the mesh, before lengths and masses are taken"},
    {"material", SCENE_TEXT, .required = true, .about = "a name in materials"},
    {"panels", SCENE_LIST, .fallback = "[]", .inside = &panel,
     .about = "groups of other materials or directions of threads; the last one counts"},
    {"regions", SCENE_LIST, .fallback = "[]", .inside = &scene_region,
     .about = "parts of other materials; the last one that has an element counts"},
    {"layer", SCENE_INTEGER, .fallback = "0", INTO(struct model_cloth, layer),
     .about = "contact.untangle: of two cloths the higher one is outside"},
    {"rest", SCENE_CHOICE, .fallback = "position", .words = scene_rests,
     .about = "where the shape at rest is taken from; uv: in m"},
    {"groups", SCENE_LIST, .filled = true, .inside = &text,
     .about = "names for contact.ignore, of your choice"},
    {"mass_per_vertex", SCENE_NUMBER, "kg", .range = SCENE_POSITIVE,
     INTO(struct model_cloth, mass_per_vertex), .about = "instead of density times area"},
    {"velocity", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &number,
     INTO(struct model_cloth, velocity), PLACE(struct model_cloth, velocity_place),
     .about = "at the start"},
    {"pins", SCENE_LIST, .fallback = "[]", .inside = &pin, ARRAY(struct model_cloth, pins, n_pins),
     .about = "vertices held, or moved"},
    {"loads", SCENE_LIST, .fallback = "[]", .inside = &load,
     ARRAY(struct model_cloth, loads, n_loads), .about = "forces on vertices"},
    {"masses", SCENE_LIST, .fallback = "[]", .inside = &mass,
     ARRAY(struct model_cloth, masses, n_masses), .about = "more mass of vertices"},
    {"folds", SCENE_LIST, .fallback = "[]", .inside = &fold,
     ARRAY(struct model_cloth, folds, n_folds), .about = "edges whose angle at rest is given"},
    {"from", SCENE_MAP, .inside = settled_keys, .apart = true,
     .about = "a frame of an earlier run, in which it starts at rest"},
    {"start", SCENE_LIST, .fallback = "[]", .inside = &start,
     ARRAY(struct model_cloth, starts, n_starts),
     .about = "how vertices start, where that is not the mesh's shape"},
    {"seams", SCENE_MAP, .inside = seams_keys, INTO(struct model_cloth, seams),
     .about = "of a mesh that has them: what joins the panels; without the key nothing does"},
    {0}};
const struct scene_rule scene_cloth = {
    .type = SCENE_MAP, .inside = cloth_keys, PLACE(struct model_cloth, place)};

/* clang-format on */

const struct scene_rule scene_grid = {.type = SCENE_MAP, .inside = grid_keys};
const struct scene_rule scene_disc = {.type = SCENE_MAP, .inside = disc_keys};
const struct scene_rule scene_inline = {.type = SCENE_MAP, .inside = inline_keys};
const struct scene_rule scene_pattern = {.type = SCENE_MAP, .inside = pattern_keys};
const struct scene_rule scene_transform = {.type = SCENE_MAP, .inside = transform_keys};
