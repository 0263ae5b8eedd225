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
     "alike; or equilateral triangles",
     SECTION("Cells of a grid",
     "Two triangles make a cell of a grid. The diagonal between them matters to `model: "
     "triangles`, to `bending`, to the one shear spring of `diagonals: one` and, with triangles, "
     "to the masses. [physics.md](physics.md#cells-and-masses) compares them by measurement.\n\n"
     "| `cells` | diagonals | symmetric under u -> -u, v -> -v |\n"
     "|---|---|---|\n"
     "| `mirrored` | alike in each quarter of the sheet, mirrored at its two middle lines: they "
     "point to the centre | yes, each where the number of cells along it (nx - 1, ny - 1) is "
     "even |\n"
     "| `alternate` | one way and the other by turns, as on a chessboard | the same |\n"
     "| `same` | all alike, from (i, j) to (i + 1, j + 1), as papers draw them | no: a sheet "
     "leans to one side |\n\n"
     "An odd number of cells leaves a row or column of them on the middle line, and no diagonal "
     "is its own mirror image. There, `mirrored` sets the diagonals by turns along the line, so "
     "that no side is preferred. For a symmetric scene take odd nx and ny, a symmetric start, "
     "and a solve that is tight enough (`solver.stop`): where cloth crumples, the error of a "
     "loose solve grows.\n\n"
     "`equilateral` makes a sheet of equilateral triangles. Rows have nx and nx - 1 vertices by "
     "turns, a = width / (nx - 1) from each other; the shorter rows stand in the middle between "
     "the longer ones. So the side edges (along v) are ragged, and the other two are straight. "
     "The sheet is symmetric under u -> -u, and with an odd ny under v -> -v. Rows are a "
     "sqrt(3)/2 apart, so the height is (ny - 1) a sqrt(3)/2: leave `height` out (one that "
     "differs by more than 0.1 % is an error). Row j begins with vertex j nx - floor(j/2). All "
     "springs of such a sheet are equally stiff, except that those at the border are half as "
     "stiff. The sheet is isotropic: E is `stretch` and nu is 1/3 in every direction, and "
     "`bending` has the same rigidity in every direction. It has no rows and columns of cells, "
     "so `shear` and `diagonals` of springs mean nothing.",
     "mesh: {grid: {width: 1, nx: 31, ny: 35, cells: equilateral}}\n")},
    {0}};

static const struct scene_rule disc_keys[] = {
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct scene_disc, radius),
     .about = "from the middle to the border"},
    {"rings", SCENE_INTEGER, .required = true, .min = 1, .max = MESH_DISC_RINGS,
     INTO(struct scene_disc, rings),
     .about = "of vertices around the one in the middle",
     .more = "Ring k has 6 k vertices; it begins with vertex 1 + 3 k (k - 1), on +x, and goes on "
     "towards +z."},
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

static const struct scene_rule pattern_keys[] = {
    {"file", SCENE_TEXT, .choice = true,
     .about = "a sewing pattern (JSON, [garments.md](garments.md#patterns)), relative to the "
     "scene's folder"},
    {"garment", SCENE_TEXT, .choice = true, INTO(struct scene_pattern, garment),
     .about = "an own garment ([garments.md](garments.md#own-garments)): tshirt, trousers or "
     "skirt"},
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
     .about = "a flat sheet in the x-z plane, centred; vertex j nx + i is column i of row j"},
    {"disc", SCENE_MAP, .choice = true, .inside = disc_keys, .apart = true, MESH_PLACE,
     .about = "a flat round sheet in the x-z plane, centred, of almost equal triangles"},
    {"file", SCENE_TEXT, .choice = true, MESH_PLACE,
     .about = "an OBJ file, relative to the scene's folder ([mesh.md](mesh.md))",
     .more = "A convex polygon is cut into a fan of triangles from its first corner, a concave "
     "one by clipping ears in its own plane (of Newell's normal). A polygon without area, or one "
     "that crosses itself, is an error. The output keeps the polygons. `l` lines are edges "
     "without triangles, each given once. `g` and `o` lines name [groups](#picking-vertices)."},
    {"inline", SCENE_MAP, .choice = true, .inside = inline_keys, .apart = true, MESH_PLACE,
     .about = "a mesh written out"},
    {"pattern", SCENE_MAP, .choice = true, .inside = pattern_keys, .apart = true, MESH_PLACE,
     .about = "the panels of a sewing pattern, where it places them",
     .more = "uv is that of the panels, and each is a [group](#picking-vertices) of its name. A "
     "largest panel shorter than 5 cm or longer than 4 m, by `units_in_meter`, draws a warning."},
    {"weld", SCENE_NUMBER, "m", .range = SCENE_POSITIVE, INTO(struct model_cloth, weld),
     .about = "vertices that lie so near to each other, after the transform, are one, as by "
     "[welds](#welds)",
     .more = "For meshes in pieces, and slits, whose borders a program wrote twice; 1e-5 does "
     "for these. Vertices at borders of an OBJ or inline mesh that lie on another's place, "
     "unjoined, draw a warning. So does a mesh whose triangles are wound against each other."},
    {0}};

static const struct scene_rule transform_keys[] = {
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
     .about = "its shape at rest",
     SECTION("Meshes", NULL, "mesh: {grid: {width: 1, height: 2, nx: 21, ny: 41}}\n")},
    {"transform", SCENE_MAP, .fallback = "{}", .inside = transform_keys, .apart = true,
     .about = "of the mesh, before lengths and masses are taken",
     .more = "The transformed mesh lies within 10^6 m of the origin along each axis. A mesh with "
     "faces draws a warning if its largest extent is above 10 m or below 1 cm: lengths are "
     "metres."},
    {"material", SCENE_TEXT, .required = true,
     .about = "a name in materials, or a fabric that every scene knows"},
    {"pins", SCENE_LIST, .fallback = "[]", .inside = &scene_pin,
     ARRAY(struct model_cloth, pins, n_pins),
     .about = "vertices held, or moved", .section = &scene_pins_section},
    {"loads", SCENE_LIST, .fallback = "[]", .inside = &scene_load,
     ARRAY(struct model_cloth, loads, n_loads),
     .about = "forces on vertices", .section = &scene_loads_section},
    {"masses", SCENE_LIST, .fallback = "[]", .inside = &scene_mass,
     ARRAY(struct model_cloth, masses, n_masses),
     .about = "more mass of vertices: a weight, a hem; they add up",
     .section = &scene_masses_section},
    {"layer", SCENE_INTEGER, .fallback = "0", INTO(struct model_cloth, layer),
     .about = "of two cloths that meet the higher one is outside, where a start is untangled",
     .more = "Out is the side that the triangles of the inner cloth face.",
     .needs = "contact.untangle = on"},
    {"rest", SCENE_CHOICE, .fallback = "position", .words = scene_rests,
     .about = "where the shape at rest, which gives lengths, angles and masses, is taken from: "
     "the transformed mesh, or its uv, flat and in m",
     .more = "Where islands of uv meet, an edge has the mean length of both sides; `uv` takes no "
     "transform."},
    {"groups", SCENE_LIST, .filled = true, .inside = &scene_text,
     .about = "names for contact.ignore, of your choice, for the whole cloth"},
    {"mass_per_vertex", SCENE_NUMBER, "kg", .range = SCENE_POSITIVE,
     INTO(struct model_cloth, mass_per_vertex),
     .about = "instead of density times area"},
    {"velocity", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     INTO(struct model_cloth, velocity), PLACE(struct model_cloth, velocity_place),
     .about = "at the start; less than 10^6 along each axis"},
    {"panels", SCENE_LIST, .fallback = "[]", .inside = &panel,
     .about = "groups of other materials or directions of threads; the last one counts",
     SECTION("Panels", "An entry has a `material`, a `grain` or both. The grain turns warp and "
     "weft of `model: triangles`, of springs and of `bending`; in a pattern, and wherever uv "
     "shows the front, it is counterclockwise as seen from the front. The three corners of a "
     "triangle lie in the group, and both ends of a spring or hinge. A grain is an error where "
     "the mesh has no uv, and a warning where no material has two numbers for warp and weft. A "
     "triangle outside the group whose corners all lie on its border counts as the group's own, "
     "which draws a warning.",
     "panels:\n"
     "  - {group: front, grain: 45}                       # cut on the bias\n"
     "  - {group: collar, material: canvas, grain: 90}\n")},
    {"regions", SCENE_LIST, .fallback = "[]", .inside = &scene_region,
     .about = "parts of other materials; the last one that has an element counts, and all count "
     "more than panels",
     SECTION("Regions: a cloth of several materials", "An element with all its vertices in a "
     "region is of that material. For a triangle (its stiffness and mass) these are its three "
     "corners, for a spring its two ends, and for a hinge the two ends of its edge. The drag of "
     "a vertex (`viscous` and `mass` damping) goes by the vertex itself. An element in no region "
     "is of the cloth's own material. So a box whose faces run along lines of the mesh cuts it "
     "there. Materials of one cloth have the same `model` and `diagonals`, and those that have "
     "`bending` have the same model of it. A region without even one edge is an error. A cloth "
     "has at most 64 regions and panels.",
     "regions:\n"
     "  - {box: [[-0.5, 0, 0.4], [0.5, 0, 0.5]], material: hem}       # the last tenth of a "
     "sheet\n"
     "  - {vertices: [1, 2], material: weak}                          # one link of a chain\n")},
    {"folds", SCENE_LIST, .fallback = "[]", .inside = &scene_fold,
     ARRAY(struct model_cloth, folds, n_folds),
     .about = "creases: edges whose angle at rest is given", .section = &scene_folds_section},
    {"from", SCENE_MAP, .inside = settled_keys, .apart = true,
     .about = "a frame of an earlier run, in which it starts at rest",
     SECTION("Starting from an earlier run", "The cloth starts where the run with `--output` had "
     "it in that frame; the mesh must have as many vertices. It is at rest there but for its "
     "`velocity`. Lengths and angles at rest, masses, and what pins and boxes pick are those of "
     "the mesh as without `from`; pins hold where the vertices start. `start` changes what "
     "`from` gives. Frames are floats, and forces of contact begin at 0, so a settled cloth "
     "moves a little before it is at rest again. `certified` contact checks this start as any "
     "other; what ended a run certified is free.",
     "from: {frames: ../draped}\n")},
    {"start", SCENE_LIST, .fallback = "[]", .inside = &scene_start,
     ARRAY(struct model_cloth, starts, n_starts),
     .about = "how vertices start, where that is not the mesh's shape at rest",
     .section = &scene_starts_section},
    {"seams", SCENE_MAP, .inside = scene_seams_keys, INTO(struct model_cloth, seams),
     .about = "of a mesh that has them: what joins the panels; without the key nothing does",
     .section = &scene_seams_section},
    {0}};
const struct scene_rule scene_cloth = {
    .type = SCENE_MAP, .inside = cloth_keys, PLACE(struct model_cloth, place)};

/* clang-format on */

const struct scene_rule scene_grid = {.type = SCENE_MAP, .inside = grid_keys};
const struct scene_rule scene_disc = {.type = SCENE_MAP, .inside = disc_keys};
const struct scene_rule scene_inline = {.type = SCENE_MAP, .inside = inline_keys};
const struct scene_rule scene_pattern = {.type = SCENE_MAP, .inside = pattern_keys};
const struct scene_rule scene_transform = {.type = SCENE_MAP, .inside = transform_keys};
