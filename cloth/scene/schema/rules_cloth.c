/* Keys of cloths: meshes, materials of their parts, how they start. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
static const struct scene_rule triangle = {
    .type = SCENE_LIST, .length = 3, .inside = &scene_vertex, ITEM(uint32_t[3])};

static const struct scene_rule grid_keys[] = {
    {"width", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct scene_grid, width),
     .about = "along x"},
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
     "alike; or equilateral triangles", .section = "Cells of a grid"},
    {0}};

static const struct scene_rule disc_keys[] = {
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct scene_disc, radius),
     .about = "from the middle to the border"},
    {"rings", SCENE_INTEGER, .required = true, .min = 1, .max = MESH_DISC_RINGS,
     INTO(struct scene_disc, rings),
     .about = "of vertices around the one in the middle"},
    {0}};

static const struct scene_rule inline_keys[] = {
    {"vertices", SCENE_LIST, "m", .required = true, .filled = true, .inside = &scene_point,
     ARRAY(struct scene_inline, vertices, n_vertices),
     .about = "positions [x, y, z]"},
    {"edges", SCENE_LIST, .fallback = "[]", .inside = &scene_edge,
     ARRAY(struct scene_inline, edges, n_edges),
     .about = "pairs of vertices, each once: edges without triangles, which take ea of the "
     "material"},
    {"triangles", SCENE_LIST, .fallback = "[]", .inside = &triangle,
     ARRAY(struct scene_inline, triangles, n_triangles),
     .about = "triples of vertices"},
    {0}};

static const struct scene_rule measure = {.type = SCENE_NUMBER, INTO(struct scene_measure, value),
    .about = "a measure, mostly in metres"};

static const struct scene_rule panel_place_keys[] = {
    {"rotation", SCENE_LIST, "degrees", "[0, 0, 0]", VECTOR,
     .about = "first: about x, then y, then z, axes that stay"},
    {"translation", SCENE_LIST, "m", "[0, 0, 0]", VECTOR, .about = "then"},
    {0}};
static const struct scene_rule panel_place = {.type = SCENE_MAP, .inside = panel_place_keys};
static const struct scene_rule side_keys[] = {
    {"panel", SCENE_TEXT, .required = true, .about = "its name"},
    {"edge", SCENE_INTEGER, .required = true, .about = "of its edges, from 0"},
    {0}};
static const struct scene_rule side = {.type = SCENE_MAP, .inside = side_keys};
static const struct scene_rule stitch = {.type = SCENE_LIST, .length = 2, .inside = &side};

static const struct scene_rule pleats_keys[] = {
    {"panel", SCENE_TEXT, .required = true, .about = "its name"},
    {"edge", SCENE_INTEGER, .required = true,
     .about = "of its edges, from 0: the longer one of a stitch"},
    {"count", SCENE_INTEGER, .required = true, .min = 1, .max = 10000,
     .about = "how many there are, each in the middle of its part of the shorter edge"},
    {"depth", SCENE_NUMBER, "m", .range = SCENE_POSITIVE,
     .about = "of each, which takes twice as much cloth; else they take all of the longer edge"},
    {0}};
static const struct scene_rule pleats = {.type = SCENE_MAP, .inside = pleats_keys};

static const struct scene_rule pattern_keys[] = {
    {"file", SCENE_TEXT, .choice = true,
     .about = "a sewing pattern (JSON or DXF, [garments.md](garments.md#patterns)), relative to the "
     "scene's folder"},
    {"garment", SCENE_TEXT, .choice = true, INTO(struct scene_pattern, garment),
     .about = "an own garment ([garments.md](garments.md#own-garments)): tshirt, trousers or "
     "skirt"},
    {"size", SCENE_TEXT, INTO(struct scene_pattern, size),
     .about = "of the garment: XS, S, M, L or XL; M unless told. Of a DXF file: one of its sizes; its "
     "sample size unless told"},
    {"notches", SCENE_CHOICE, .fallback = "off", INTO(struct scene_pattern, notches),
     WORDS({"on", true}, {"off", false}),
     .about = "of a DXF file: edges end at notches, too, so stitches can begin there; the numbers of "
     "edges change"},
    {"measures", SCENE_NAMED, .inside = &measure,
     ARRAY(struct scene_pattern, measures, n_measures), .name = FIELD(struct scene_measure, name),
     .about = "NAME: VALUE of those of the garment that differ from its size's"},
    {"edge", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct scene_pattern, edge),
     .about = "how long the edges of its triangles are, about"},
    {"vertices", SCENE_INTEGER, .min = 3, INTO(struct scene_pattern, vertices),
     .about = "in place of edge: how many all panels have, about"},
    {"place", SCENE_NAMED, .inside = &panel_place,
     .about = "PANEL: where it is, in place of what the pattern says"},
    {"stitches", SCENE_LIST, .fallback = "[]", .inside = &stitch,
     .about = "pairs of edges that are sewn together, behind those of the pattern: each a list of "
     "two {panel, edge}"},
    {"pleats", SCENE_LIST, .fallback = "[]", .inside = &pleats,
     .about = "of edges that are sewn to shorter ones ([Seams](#seams))"},
    {0}};

#define MESH_PLACE PLACE(struct model_cloth, mesh_place)
static const struct scene_rule mesh_keys[] = {
    {"grid", SCENE_MAP, .choice = true, .inside = grid_keys, .apart = true, MESH_PLACE,
     .about = "a flat sheet in the x-z plane, centred; vertex j nx + i is column i of row j"},
    {"disc", SCENE_MAP, .choice = true, .inside = disc_keys, .apart = true, MESH_PLACE,
     .about = "a flat round sheet in the x-z plane, centred, of almost equal triangles"},
    {"file", SCENE_TEXT, .choice = true, MESH_PLACE,
     .about = "an OBJ file, or one of another program, relative to the scene's folder "
     "([mesh.md](mesh.md))"},
    {"inline", SCENE_MAP, .choice = true, .inside = inline_keys, .apart = true, MESH_PLACE,
     .about = "a mesh written out"},
    {"pattern", SCENE_MAP, .choice = true, .inside = pattern_keys, .apart = true, MESH_PLACE,
     .about = "the panels of a sewing pattern, where it places them"},
    {"weld", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct model_cloth, weld),
     .about = "vertices that lie so near to each other, after the transform, are one, as by "
     "[welds](#welds)"},
    {0}};

const struct model_word scene_units[] = {{"m", 10000}, {"cm", 100}, {"mm", 10}, {"in", 254}, {0}};
const struct model_word scene_ups[] = {{"y", 1}, {"z", 2}, {0}};
static const struct scene_rule transform_keys[] = {
    AS_IN_FILE,
    TRANSFORM(struct mesh_transform, ),
    {0}};

const struct model_word scene_rests[] = {{"position", false}, {"uv", true}, {0}};

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

static const struct scene_rule panel_keys[] = {
    {"group", SCENE_TEXT, .required = true, .about = "of the mesh's faces, by its name, each once"},
    {"material", SCENE_TEXT,
     .about = "of its elements, by the rules of regions; else that of the cloth"},
    {"grain", SCENE_NUMBER, "degrees",
     .about = "by which the warp is turned from u towards v of its uv; else 0"},
    {0}};
static const struct scene_rule panel = {.type = SCENE_MAP, .inside = panel_keys};

static const struct scene_rule cloth_keys[] = {
    {"name", SCENE_TEXT, INTO(struct model_cloth, name),
     .about = "unique; else cloth1, cloth2, ..."},
    {"mesh", SCENE_MAP, .required = true, .inside = mesh_keys,
     .about = "its shape at rest", .section = "Meshes"},
    {"transform", SCENE_MAP, .fallback = "{}", .inside = transform_keys, .apart = true,
     .about = "of the mesh, before lengths and masses are taken"},
    {"material", SCENE_TEXT, .required = true,
     .about = "a name in materials, or a fabric that every scene knows"},
    {"pins", SCENE_LIST, .fallback = "[]", .inside = &scene_pin,
     ARRAY(struct model_cloth, pins, n_pins),
     .about = "vertices held, or moved", .section = "Pins"},
    {"loads", SCENE_LIST, .fallback = "[]", .inside = &scene_load,
     ARRAY(struct model_cloth, loads, n_loads),
     .about = "forces on vertices", .section = "Loads"},
    {"masses", SCENE_LIST, .fallback = "[]", .inside = &scene_mass,
     ARRAY(struct model_cloth, masses, n_masses),
     .about = "more mass of vertices: a weight, a hem; they add up", .section = "Masses"},
    {"layer", SCENE_INTEGER, .fallback = "0", INTO(struct model_cloth, layer),
     .about = "of two cloths that meet the higher one is outside, where a start is untangled",
     .needs = "contact.untangle = on"},
    {"rest", SCENE_CHOICE, .fallback = "position", .words = scene_rests,
     .about = "where the shape at rest, which gives lengths, angles and masses, is taken from: "
     "the transformed mesh, or its uv, flat and in m"},
    {"groups", SCENE_LIST, .filled = true, .inside = &scene_text,
     .about = "names for contact.ignore, of your choice, for the whole cloth"},
    {"mass_per_vertex", SCENE_NUMBER, "kg", .range = SCENE_POSITIVE,
     INTO(struct model_cloth, mass_per_vertex),
     .about = "instead of density times area"},
    {"pressure", SCENE_NUMBER, "Pa", "0", INTO(struct model_cloth, pressure),
     .about = "of a gas behind the triangles: it pushes them to the side from which their corners "
     "are counter-clockwise; 30 to 100 fills a cushion of light cloth", .needs = NEEDS_TRIANGLES},
    {"velocity", SCENE_LIST, "m/s", "[0, 0, 0]", VECTOR, INTO(struct model_cloth, velocity),
     PLACE(struct model_cloth, velocity_place),
     .about = "at the start; less than 10^6 along each axis"},
    {"panels", SCENE_LIST, .fallback = "[]", .inside = &panel,
     .about = "groups of other materials or directions of threads; the last one counts",
     .section = "Panels"},
    {"regions", SCENE_LIST, .fallback = "[]", .inside = &scene_region,
     .about = "parts of other materials; the last one that has an element counts, and all count "
     "more than panels", .section = "Regions: a cloth of several materials"},
    {"folds", SCENE_LIST, .fallback = "[]", .inside = &scene_fold,
     ARRAY(struct model_cloth, folds, n_folds),
     .about = "creases: edges whose angle at rest is given", .section = "Folds"},
    {"bands", SCENE_LIST, .fallback = "[]", .inside = &scene_band,
     ARRAY(struct model_cloth, bands, n_bands),
     .about = "elastics along edges: hems and cuffs that gather cloth", .section = "Bands"},
    {"from", SCENE_MAP, .inside = settled_keys, .apart = true,
     .about = "a frame of an earlier run, in which it starts at rest",
     .section = "Starting from an earlier run"},
    {"start", SCENE_LIST, .fallback = "[]", .inside = &scene_start,
     ARRAY(struct model_cloth, starts, n_starts),
     .about = "how vertices start, where that is not the mesh's shape at rest",
     .section = "How vertices start"},
    {"seams", SCENE_MAP, .inside = scene_seams_keys, INTO(struct model_cloth, seams),
     .about = "of a mesh that has them: what joins the panels; without the key nothing does",
     .section = "Seams"},
    {0}};
const struct scene_rule scene_cloth = {
    .type = SCENE_MAP, .inside = cloth_keys, PLACE(struct model_cloth, place)};

/* clang-format on */

const struct scene_rule scene_grid = {.type = SCENE_MAP, .inside = grid_keys};
const struct scene_rule scene_disc = {.type = SCENE_MAP, .inside = disc_keys};
const struct scene_rule scene_inline = {.type = SCENE_MAP, .inside = inline_keys};
const struct scene_rule scene_pattern = {.type = SCENE_MAP, .inside = pattern_keys};
const struct scene_rule scene_transform = {.type = SCENE_MAP, .inside = transform_keys};
