/* Keys of what picks vertices: pins, loads, masses, starts and probes. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */

const struct scene_rule scene_turn_keys[] = {
    {"axis", SCENE_LIST, .required = true, VECTOR, .about = "of any length but 0"},
    {"degrees", SCENE_NUMBER, "degrees", .choice = true,
     .about = "counter-clockwise for someone whom the axis points at"},
    {"turns", SCENE_NUMBER, .choice = true, .about = "the same, 1 for 360 degrees"},
    {0}};
static const struct scene_rule rotation = {.type = SCENE_ROTATION, .inside = scene_turn_keys};

const struct scene_rule scene_motion_keys[] = {
    {"times", SCENE_LIST, "s", .required = true, .filled = true, .inside = &scene_number,
     .about = "of the key frames, ascending"},
    {"translate", SCENE_LIST, "m", .inside = &scene_point, .about = "a shift for each time"},
    {"rotate", SCENE_LIST, .inside = &rotation, .about = "a rotation for each time"},
    {"about", SCENE_LIST, "m", "[0, 0, 0]", VECTOR, .about = "the point that is rotated about",
     .needs = "rotate"},
    {0}};

const struct scene_rule scene_panel_edge_keys[] = {
    {"panel", SCENE_TEXT, .required = true, .about = "its name"},
    {"edge", SCENE_INTEGER, .required = true, .about = "of its edges, from 0 as in its pattern"},
    {0}};

const struct model_word scene_columns[] = {{"u", 0}, {"v", 1}, {0}};
static const struct scene_rule weight_kinds[] = {
    {"uv", SCENE_CHOICE, .choice = true, .words = scene_columns,
     .about = "the first or second number of a vertex's `vt` in the OBJ file"},
    {"file", SCENE_TEXT, .choice = true,
     .about = "a text file, relative to the scene's folder: a line for each vertex"},
    {0}};
const struct model_word scene_holds[] = {
    {"point", SCENE_POINT}, {"line", SCENE_LINE}, {"plane", SCENE_PLANE}, {0}};
static const struct scene_rule pin_keys[] = {
    PICK(struct model_pin),
    {"weights", SCENE_ONE_OF, .choice = true, .inside = weight_kinds,
     MEANS(struct model_pin, pick.kind, MODEL_PICK_VERTICES),
     .about = "0 to 1 of each vertex, times stiffness and damping; all above 0 are pinned"},
    {"stiffness", SCENE_NUMBER, "N/m", .range = SCENE_POSITIVE, INTO(struct model_pin, stiffness),
     .about = "a soft pin: of the spring that pulls each vertex to where it would be held"},
    {"damping", SCENE_NUMBER, "kg/s", "0", .range = SCENE_NOT_NEGATIVE,
     INTO(struct model_pin, damping),
     .about = "a soft pin: of the vertex's velocity against that of its place",
     .needs = "stiffness"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "a soft pin: what stiffness and damping are multiplied by in time; never below 0",
     .needs = "stiffness", .section = "Curves"},
    {"to", SCENE_CHOICE, .fallback = "point", .words = scene_holds,
     .about = "where they are held: each at a point, or on a line or plane through it"},
    {"direction", SCENE_LIST, VECTOR, .about = "of the line, of any length but 0"},
    {"normal", SCENE_LIST, VECTOR, .about = "to the plane, of any length but 0"},
    {"follow", SCENE_TEXT,
     .about = "name of an obstacle that takes the vertices along; they do not meet it"},
    {"motion", SCENE_MAP, .inside = scene_motion_keys,
     .about = "of the vertices, or of their lines or planes, by key frames", .needs = NEEDS_MOVING,
     .section = "Motion"},
    {0}};
const struct scene_rule scene_pin = {
    .type = SCENE_MAP, .inside = pin_keys, PLACE(struct model_pin, pick.place)};

const struct model_word scene_probe_values[] = {
    {"position", (int)offsetof(struct model_probe, position)},
    {"velocity", (int)offsetof(struct model_probe, velocity)},
    {"reaction", (int)offsetof(struct model_probe, reaction)},
    {"contact", (int)offsetof(struct model_probe, contact)},
    {"total", (int)offsetof(struct model_probe, total)},
    {"contact_total", (int)offsetof(struct model_probe, contact_total)},
    {0}};
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

const struct scene_rule scene_curve_key = {
    .type = SCENE_LIST, .length = 2, .inside = &scene_number};
static const struct scene_rule sine_keys[] = {
    {"frequency", SCENE_NUMBER, "1/s", .required = true, .range = SCENE_POSITIVE,
     .about = "turns a second; less than half the steps a second"},
    {"phase", SCENE_NUMBER, .fallback = "0", .about = "turns at time 0; 0.25: a cosine"},
    {0}};
const struct scene_rule scene_curve_kinds[] = {
    {"keys", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_curve_key,
     .about = "[time in s, factor], times ascending; linear in between"},
    {"sine", SCENE_MAP, .choice = true, .inside = sine_keys,
     .about = "sin 2 pi (frequency t + phase)"},
    {0}};

static const struct scene_rule load_keys[] = {
    PICK(struct model_load),
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_edge,
     ARRAY(struct model_load, edges, n_edges),
     .about = "pairs of vertices: the force is along them, in N/m of their length at rest, half "
     "of an edge's on each end"},
    {"force", SCENE_LIST, "N", .required = true, VECTOR, INTO(struct model_load, force),
     .about = "on each of the vertices"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "what the force is multiplied by in time; else it is constant", .section = "Curves"},
    {0}};
const struct scene_rule scene_load = {
    .type = SCENE_MAP, .inside = load_keys, PLACE(struct model_load, pick.place)};

static const struct scene_rule mass_keys[] = {
    PICK(struct model_mass),
    {"mass", SCENE_NUMBER, "kg", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_mass, mass),
     .about = "more, at each of the vertices"},
    {0}};
const struct scene_rule scene_mass = {
    .type = SCENE_MAP, .inside = mass_keys, PLACE(struct model_mass, pick.place)};

static const struct scene_rule wave_keys[] = {
    {"vector", SCENE_LIST, "1/m", .required = true, VECTOR, INTO(struct model_wave, vector),
     .about = "waves a metre along each axis, by where the mesh has the vertices"},
    {"phase", SCENE_NUMBER, .fallback = "0", INTO(struct model_wave, phase),
     .about = "in waves, at the point `about`"},
    {"translate", SCENE_LIST, "m", "[0, 0, 0]", VECTOR, INTO(struct model_wave, translate),
     .about = "a shift, times the sine. A sheet that `scale` narrows to the part s keeps its "
              "lengths, to 4 %, by a quarter of a wave times the root of 1 / s^2 - 1"},
    {"velocity", SCENE_LIST, "m/s", "[0, 0, 0]", VECTOR, INTO(struct model_wave, velocity),
     .about = "added, times the sine"},
    {0}};
static const struct scene_rule start_keys[] = {
    PICK(struct model_start),
    TRANSFORM(struct model_start, transform.),
    {"about", SCENE_LIST, "m", "[0, 0, 0]", VECTOR, INTO(struct model_start, about),
     .about = "the point that is scaled, rotated and spun about",
     .needs = "scale or rotate or spin"},
    {"velocity", SCENE_LIST, "m/s", VECTOR, INTO(struct model_start, velocity),
     MEANS(struct model_start, has_velocity, true), .about = "instead of what it was before"},
    {"spin", SCENE_LIST, "rad/s", "[0, 0, 0]", VECTOR, INTO(struct model_start, spin),
     .about = "added: the velocity of a rigid turn about the point"},
    {"wave", SCENE_MAP, .inside = wave_keys, INTO(struct model_start, wave),
     .about = "added: a sine over the mesh, of the place or the velocity",
     .needs = "translate or velocity"},
    {0}};
const struct scene_rule scene_start = {
    .type = SCENE_MAP, .inside = start_keys, PLACE(struct model_start, pick.place),
    .needs = "scale or rotate or translate or velocity or spin or wave"};
