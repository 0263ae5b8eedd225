/* Keys of what picks vertices: pins, loads, masses, starts and probes. */
#include "cloth/scene/schema/tables.h"

/* clang-format off */
const struct scene_section scene_picks = {"Picking vertices",
    "Vertices are picked by one of these keys, by their place in the transformed mesh. `box` has "
    "two opposite corners, and picks all vertices in or on it. With a `radius` (m) `nearest` "
    "picks all vertices that are not farther from the point, and at least the nearest.\n\n"
    "A mesh from an OBJ file has the groups that its `g` and `o` lines name. A face is in each "
    "of the groups that the last `g` line before it names, and in the one of the last `o` line, "
    "whose name is the whole line; after a line without a name it is in none. A name that comes "
    "again goes on, and a name without faces is no group. A mesh from a pattern has a group for "
    "each panel, of the panel's name. Other meshes have no groups. The groups stand in "
    "`cloth.obj`, too, as `g` lines. `group: front` picks all vertices of the group's faces; "
    "where groups share vertices, those on the border belong to both.", NULL};

const struct scene_section scene_motion = {"Motion", "Key frames of a rigid motion. Between two "
    "times both shift and rotation are interpolated linearly, quaternions along the shorter way "
    "and then normalised; before the first time and after the last the motion rests. At time 0 "
    "the motion of a pin must leave its vertices where they are. After each step they are "
    "exactly where the motion has them; in a step they have the velocity that brings them there, "
    "and forces see this velocity.",
    "motion: {times: [0, 1, 3], translate: [[0, 0, 0], [0, 0.2, 0], [0, 0.2, 0]],\n"
    "         rotate: [[1, 0, 0, 0], [1, 0, 0, 0], [0.92388, 0, 0.38268, 0]],\n"
    "         about: [0, 0, -0.5]}\n"};
const struct scene_rule scene_motion_keys[] = {
    {"times", SCENE_LIST, "s", .required = true, .filled = true, .inside = &scene_number,
     .about = "of the key frames, ascending"},
    {"translate", SCENE_LIST, "m", .inside = &scene_point, .about = "a shift for each time"},
    {"rotate", SCENE_LIST, .inside = &scene_quaternion,
     .about = "a quaternion [w, x, y, z] for each time"},
    {"about", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     .about = "the point that is rotated about", .needs = "rotate"},
    {0}};

const struct model_word scene_holds[] = {
    {"point", SCENE_POINT}, {"line", SCENE_LINE}, {"plane", SCENE_PLANE}, {0}};
const struct scene_section scene_pins_section = {"Pins",
    "Pinned vertices stay where they start, or move by `motion`, or `follow` an obstacle. A "
    "vertex may be pinned several times, if its pins hold and move alike.\n\n"
    "A pin of one vertex, like a load on one, is a point: it stands for less cloth the finer the "
    "mesh is, and the strain next to it grows with the number of vertices without limit "
    "([physics.md](physics.md#pins-their-motion-and-reactions)). Where that strain matters, or "
    "several resolutions are compared, pin a part of the cloth that is the same on all meshes: a "
    "`box`, or `nearest` with a `radius` of several edges.\n\n"
    "*Lines and planes.* `to: line` leaves a vertex free along the line through its start in "
    "`direction`, `to: plane` in the plane through its start across `normal`. All integrators "
    "know these pins, implicit solves by their filter. With a `motion` the line or plane moves, "
    "and the vertex is free along it where it is then. A start's velocity across it is dropped. "
    "A vertex leaves an obstacle along its own line or plane; one whose line never leaves the "
    "obstacle is not moved. A reaction is what the pin carries: nothing along a line, or in a "
    "plane.\n\n"
    "*Following an obstacle.* A rigid obstacle takes the vertices along by its motion, whatever "
    "this is at time 0. With a body that has `frames` each vertex goes with the triangle that is "
    "nearest to it at the start, by the nearest point of it and its offset from there. "
    "Triangles, edges and vertices with an attached corner do not meet the obstacle that it "
    "follows, so the cloth may lie on its surface or begin in it; they meet all else. "
    "`--check-intersections`, the check of the start and that of `duite-view` in the frames of a "
    "folder (`scene.json` has these vertices) leave the same out. Pins that follow and stretch "
    "an edge by more than 20 % draw a warning.",
    "pins:\n"
    "  - {vertices: [0, 19]}\n"
    "  - {nearest: [0, 0.5, 0.5], radius: 0.06}\n"
    "  - {box: [[-0.5, 0, -0.5], [0.5, 0, -0.5]], to: line, direction: [1, 0, 0]}   # a curtain "
    "on its rail\n"
    "  - {vertices: [399], to: plane, normal: [0, 0, 1]}                            # symmetry\n"
    "  - {group: waist, follow: figure}\n"};
static const struct scene_rule pin_keys[] = {
    PICK(struct model_pin),
    {"to", SCENE_CHOICE, .fallback = "point", .words = scene_holds,
     .about = "where they are held: each at a point, or on a line or plane through it"},
    {"direction", SCENE_LIST, .length = 3, .inside = &scene_number,
     .about = "of the line, of any length but 0"},
    {"normal", SCENE_LIST, .length = 3, .inside = &scene_number,
     .about = "to the plane, of any length but 0"},
    {"follow", SCENE_TEXT,
     .about = "name of an obstacle that takes the vertices along; they do not meet it"},
    {"motion", SCENE_MAP, .inside = scene_motion_keys,
     .about = "of the vertices, or of their lines or planes, by key frames", .needs = NEEDS_MOVING,
     .section = &scene_motion},
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
const struct scene_section scene_probes_section = {"Probes",
    "A run with `--output DIR` writes the values to `DIR/probes.csv`: a line of names, then a "
    "row for the start and for each step. A run that is killed leaves all rows so far. Numbers "
    "have 17 digits; the bytes are the same for any ranks, threads, schedulers and balancers. "
    "These columns stand before those of the probes:\n\n"
    "| column | |\n"
    "|---|---|\n"
    "| `step`, `time [s]` | steps made, and their time |\n"
    "| `iterations` | of the step's conjugate gradients |\n"
    "| `longest [1]`, `shortest [1]` | largest and smallest length of a stretch spring against "
    "its length at rest |\n"
    "| `kinetic [J]`, `elastic [J]`, `gravity [J]`, `loads [J]` | energies: of motion, of "
    "springs, of weights, of loads; the last two are 0 with every vertex at the origin |\n\n"
    "Values of a probe are these:\n\n"
    "| value | columns | |\n"
    "|---|---|---|\n"
    "| `position` | `NAME.VERTEX.x [m]`, `.y`, `.z` | of each vertex |\n"
    "| `velocity` | `NAME.VERTEX.vx [m/s]`, ... | of each vertex |\n"
    "| `reaction` | `NAME.VERTEX.rx [N]`, ... | the force with which its pin holds each vertex; "
    "0 where it is free |\n"
    "| `contact` | `NAME.VERTEX.cx [N]`, ... | the force that contact puts on each vertex, "
    "friction included (`contact.mode: certified`) |\n"
    "| `total` | `NAME.total.rx [N]`, ... | the sum of the reactions, each vertex once, in their "
    "order |\n"
    "| `contact_total` | `NAME.total.cx [N]`, ... | the sum of the forces of contact |\n\n"
    "A probe `{obstacle: NAME, name}` picks no vertices and has no values: it reports the force "
    "that this obstacle puts on all cloth, in `NAME.cx [N]`, `.cy`, `.cz`. All values are of the "
    "state at the end of the step. A reaction is m a - f: f are the forces on the pin's vertex "
    "in that state (springs and their damping, weight, loads), and a is the acceleration by "
    "which the pin moves the vertex. At rest the reaction is what the pin carries. Forces of "
    "contact are those of the step that ended; of a sheet that rests on a floor their total is "
    "the weight.",
    "probes:\n"
    "  - {name: corners, vertices: [0, 19], values: [reaction, total]}\n"
    "  - {name: tip, nearest: [0, 1, 0], radius: 0.05}\n"
    "  - {name: floor, obstacle: 0}\n"};
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

const struct scene_section scene_curve = {"Curves", "A curve is a factor that varies in time: of "
    "the force of a load, or of the velocity of the wind. It is linear between two of its "
    "`keys`, and constant before the first and after the last; or it is a sine. Explicit schemes "
    "take loads at the time of the state whose forces they compute, implicit ones at the end of "
    "the step, so the order of the integrator is kept. The energy of loads at a time t is that "
    "of their forces then, -f(t) . x. A run does not rest (`time.rest`) before the last key of "
    "each curve.", NULL};
static const struct scene_rule curve_key = {
    .type = SCENE_LIST, .length = 2, .inside = &scene_number};
static const struct scene_rule sine_keys[] = {
    {"frequency", SCENE_NUMBER, "1/s", .required = true, .range = SCENE_POSITIVE,
     .about = "turns a second; less than half the steps a second"},
    {"phase", SCENE_NUMBER, .fallback = "0", .about = "turns at time 0; 0.25: a cosine"},
    {0}};
const struct scene_rule scene_curve_kinds[] = {
    {"keys", SCENE_LIST, .filled = true, .inside = &curve_key,
     .about = "[time in s, factor], times ascending; linear in between"},
    {"sine", SCENE_MAP, .inside = sine_keys, .about = "sin 2 pi (frequency t + phase)"},
    {0}};

const struct scene_section scene_loads_section = {"Loads", "Loads of a vertex add up; it stands "
    "only once in each list of `vertices`. A mean and a sine make a pulsating force, a sine and "
    "a cosine across make one that turns.",
    "loads:\n"
    "  - {vertices: [399], force: [0, 0, 0.01], curve: {sine: {frequency: 2.5}}}                 "
    "# shaken\n"
    "  - {box: [[-1, 0, 0], [1, 0, 0]], force: [0, 0.02, 0], curve: {keys: [[0, 0], [0.5, 1]]}}  "
    "# grows for half a second\n"
    "  - {vertices: [0], force: [1, 0, 0], curve: {keys: [[0.1, 1], [0.101, 0]]}}                "
    "# lets go\n"
    "  - {edges: [[0, 1], [1, 2]], force: [0, 0, 2]}                                             "
    "# N/m\n"};
static const struct scene_rule load_keys[] = {
    PICK(struct model_load),
    {"edges", SCENE_LIST, .choice = true, .filled = true, .inside = &scene_edge,
     ARRAY(struct model_load, edges, n_edges),
     .about = "pairs of vertices: the force is along them, in N/m of their length at rest, half "
     "of an edge's on each end"},
    {"force", SCENE_LIST, "N", .required = true, .length = 3, .inside = &scene_number,
     INTO(struct model_load, force),
     .about = "on each of the vertices"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "what the force is multiplied by in time; else it is constant",
     .section = &scene_curve},
    {0}};
const struct scene_rule scene_load = {
    .type = SCENE_MAP, .inside = load_keys, PLACE(struct model_load, pick.place)};

const struct scene_section scene_masses_section = {"Masses", NULL,
    "masses:\n"
    "  - {group: hem, mass: 0.0002}\n"};
static const struct scene_rule mass_keys[] = {
    PICK(struct model_mass),
    {"mass", SCENE_NUMBER, "kg", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_mass, mass),
     .about = "more, at each of the vertices"},
    {0}};
const struct scene_rule scene_mass = {
    .type = SCENE_MAP, .inside = mass_keys, PLACE(struct model_mass, pick.place)};

static const struct scene_rule wave_keys[] = {
    {"vector", SCENE_LIST, "1/m", .required = true, .length = 3, .inside = &scene_number,
     INTO(struct model_wave, vector),
     .about = "waves a metre along each axis, by where the mesh has the vertices"},
    {"phase", SCENE_NUMBER, .fallback = "0", INTO(struct model_wave, phase),
     .about = "in waves, at the point `about`"},
    {"translate", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     INTO(struct model_wave, translate),
     .about = "a shift, times the sine"},
    {"velocity", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     INTO(struct model_wave, velocity),
     .about = "added, times the sine"},
    {0}};
const struct scene_section scene_starts_section = {"How vertices start", "Lengths, angles and "
    "masses are those of the mesh; `start` says where its vertices are at time 0, and how fast "
    "they are. Each entry picks vertices by their place in the mesh. Then it applies `scale`, "
    "`rotate` and `translate`, in this order, about the point `about`. Entries apply one after "
    "the other. Pins hold their vertices where they start. The wave of a vertex is sin(2 pi "
    "(vector . (p - about) + phase)), p its place in the mesh; the velocity of `spin` is spin x "
    "(x - about), x the position that the entry leaves.",
    "start:\n"
    "  - {box: [[-9, -9, -9], [9, 9, 9]], scale: [1.1, 1, 1.1]}      # taut from the begin\n"
    "  - {nearest: [0, 0, 0], translate: [0, 0.01, 0]}               # plucked\n"
    "  - {vertices: [3, 4], velocity: [0, 0, 1], spin: [0, 2, 0], about: [0, 0, 0.5]}\n"
    "  - {box: [[-9, -9, -9], [9, 9, 9]], wave: {vector: [0.5, 0, 0], phase: 0.25, translate: "
    "[0, 0.01, 0]}}   # half a wave, a crest at x = 0\n"};
static const struct scene_rule start_keys[] = {
    PICK(struct model_start),
    TRANSFORM(struct model_start, transform.),
    {"about", SCENE_LIST, "m", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     INTO(struct model_start, about),
     .about = "the point that is scaled, rotated and spun about",
     .needs = "scale or rotate or spin"},
    {"velocity", SCENE_LIST, "m/s", .length = 3, .inside = &scene_number,
     INTO(struct model_start, velocity), MEANS(struct model_start, has_velocity, true),
     .about = "instead of what it was before"},
    {"spin", SCENE_LIST, "rad/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     INTO(struct model_start, spin),
     .about = "added: the velocity of a rigid turn about the point"},
    {"wave", SCENE_MAP, .inside = wave_keys, INTO(struct model_start, wave),
     .about = "added: a sine over the mesh, of the place or the velocity",
     .needs = "translate or velocity"},
    {0}};
const struct scene_rule scene_start = {
    .type = SCENE_MAP, .inside = start_keys, PLACE(struct model_start, pick.place),
    .needs = "scale or rotate or translate or velocity or spin or wave"};
