/* The schema 1 of scenes: keys of the whole scene; other maps stand in the files rules_*.c. These
 * tables alone know keys, words, units, ranges, defaults and fields. Files are checked against
 * them, defaults come from them, they fill the model, --keys prints them, and docs/scene.md is made
 * of them. */
#include "cloth/scene/schema/tables.h"

const struct scene_rule scene_number = {.type = SCENE_NUMBER, ITEM(double)};
const struct scene_rule scene_positive = {
    .type = SCENE_NUMBER, .range = SCENE_POSITIVE, ITEM(double)};
const struct scene_rule scene_text = {.type = SCENE_TEXT};
const struct scene_rule scene_vertex = {.type = SCENE_INTEGER, ITEM(uint32_t)};
const struct scene_rule scene_point = {
    .type = SCENE_LIST, .length = 3, .inside = &scene_number, .unit = "m", ITEM(double[3])};
const struct scene_rule scene_edge = {
    .type = SCENE_LIST, .length = 2, .inside = &scene_vertex, ITEM(uint32_t[2])};
const struct scene_rule scene_quaternion = {
    .type = SCENE_LIST, .length = 4, .inside = &scene_number};

/* clang-format off */
static const struct scene_rule air_keys[] = {
    {"density", SCENE_NUMBER, "kg/m^3", "1.2", .range = SCENE_POSITIVE,
     INTO(struct phys_air, density),
     .about = "of the air"},
    {"wind", SCENE_LIST, "m/s", .fallback = "[0, 0, 0]", .length = 3, .inside = &scene_number,
     INTO(struct phys_air, wind),
     .about = "velocity of the air, the same everywhere"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "what the wind is multiplied by in time; else it is constant", .needs = NEEDS_WIND,
     .section = &scene_curve},
    {"normal", SCENE_NUMBER, .fallback = "1.2", .range = SCENE_NOT_NEGATIVE,
     INTO(struct phys_air, normal),
     .about = "coefficient of the drag across a triangle"},
    {"tangent", SCENE_NUMBER, .fallback = "0.01", .range = SCENE_NOT_NEGATIVE,
     INTO(struct phys_air, tangent),
     .about = "of the friction along it"},
    {0}};

static const struct scene_rule drape_keys[] = {
    {"cloth", SCENE_TEXT, .about = "its name; optional where there is one only"},
    {"radius", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE,
     INTO(struct model_drape, radius),
     .about = "of the disc that carries the cloth"},
    {"axis", SCENE_LIST, .fallback = "[0, 1, 0]", .length = 3, .inside = &scene_number,
     INTO(struct model_drape, axis),
     .about = "of the disc, along which the light falls; of any length but 0"},
    {0}};

static const struct scene_rule phase_keys[] = {
    {"name", SCENE_TEXT, .required = true, INTO(struct model_phase, name),
     .about = "of the phase, in messages and in the report; no other phase has it"},
    {"set", SCENE_EDITS, .fallback = "{}",
     .about = "keys of the scene that are others from it on, KEY: VALUE as of `--set`; null: the "
     "default again"},
    {0}};
static const struct scene_rule phase = {
    .type = SCENE_MAP, .inside = phase_keys, PLACE(struct model_phase, place)};

static const struct scene_rule scene_keys[] = {
    {"schema", SCENE_INTEGER, .required = true, .min = 1, .max = 1,
     .about = "version of these rules"},
    {"name", SCENE_TEXT, INTO(struct model, name),
     .about = "of the scene; else the file's name, without its ending"},
    {"gravity", SCENE_LIST, "m/s^2", .fallback = "[0, -9.81, 0]", .length = 3,
     .inside = &scene_number, INTO(struct model, gravity),
     .about = "+y is up"},
    {"air", SCENE_MAP, .inside = air_keys, INTO(struct model, air),
     .about = "drag and wind on triangles; else there is none", .needs = NEEDS_TRIANGLES,
     SECTION("Air", "Air pushes on all triangles of all cloths: "
     "[physics.md](physics.md#air) has the force.",
     "air: {wind: [3, 0, 0], curve: {sine: {frequency: 0.5}}}\n")},
    {"cloths", SCENE_LIST, .required = true, .filled = true, .max = SCENE_MOST_NAMED,
     .inside = &scene_cloth, ARRAY(struct model, cloths, n_cloths),
     .about = "what moves",
     SECTION("Cloths", NULL,
     "cloths:\n"
     "  - name: shirt\n"
     "    mesh: {file: shirt.obj}\n"
     "    material: polycotton\n"
     "    layer: 1\n"
     "    mass_per_vertex: 0.0001\n"
     "    velocity: [0, 0, 1]\n"
     "    groups: [worn]\n")},
    {"materials", SCENE_NAMED, .inside = &scene_material,
     ARRAY(struct model, materials, n_materials), .name = FIELD(struct model_material, name),
     .about = "NAME is yours; rib_knit, silk, denim and polycotton are there",
     .section = &scene_materials_section},
    {"obstacles", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &scene_obstacle,
     .about = "what the cloth meets, still or moving by key frames",
     .section = &scene_obstacles_section},
    {"contact", SCENE_MAP, .fallback = "{}", .inside = scene_contact_keys,
     INTO(struct model, contact),
     .about = "how obstacles are met, and cloth", .section = &scene_contact_section},
    {"time", SCENE_MAP, .required = true, .inside = scene_time_keys,
     .about = "of the simulation", .section = &scene_time_section},
    {"integrator", SCENE_CHOICE, .fallback = "implicit_euler", INTO(struct model, integrator),
     .words = model_integrators,
     .about = "how a step is made",
     .more = "`implicit_euler` and `bdf2` are implicit. Of the others `explicit_euler` moves x "
     "by the old velocity, `symplectic_euler` by the new one, and `verlet` is velocity Verlet "
     "([physics.md](physics.md#integrators))."},
    {"energies", SCENE_CHOICE, .fallback = "ends", INTO(struct model, energy_steps),
     WORDS({"ends", false}, {"steps", true}),
     .about = "the report's: of start and end; or also how they rose and fell from step to step"},
    {"newton", SCENE_MAP, .fallback = "{}", .inside = scene_newton_keys,
     .about = "Newton steps, with a line search, of implicit steps", .needs = NEEDS_IMPLICIT,
     .section = &scene_newton_section},
    {"solver", SCENE_MAP, .fallback = "{}", .inside = scene_solver_keys,
     .about = "of implicit steps", .needs = NEEDS_IMPLICIT, .section = &scene_solver_section},
    {"probes", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &scene_probe,
     ARRAY(struct model, probes, n_probes),
     .about = "what probes.csv reports after each step", .section = &scene_probes_section},
    {"drape", SCENE_MAP, .inside = drape_keys, INTO(struct model, drape),
     .about = "the drape test of textile laboratories: its coefficient is printed; else there is "
     "none",
     SECTION("The drape test",
     "A round cloth lies on a smaller disc and its border hangs down. The summary of the run and "
     "its report then have the drape coefficient of ISO 9073-9 and BS 5058:\n\n"
     "    100 % * (area of the cloth's shadow - area of the disc) / (area of the cloth at rest - "
     "area of the disc)\n\n"
     "A border that stands out stiffly has 100 %, one that hangs straight down 0 %. The "
     "coefficient is that of the last frame, so let the run end at rest (`time.rest`). "
     "[physics.md](physics.md#fabrics) has those of the fabrics that every scene knows. "
     "`cloth/scenes/drape.yaml` is such a test:\n\n"
     "```sh\n"
     "duite-cloth drape.yaml --set materials.fabric.like=silk\n"
     "```",
     "drape: {radius: 0.09}\n")},
    {"joints", SCENE_LIST, .fallback = "[]", .inside = &scene_joint,
     ARRAY(struct model, joints, n_joints),
     .about = "springs between any two vertices", .section = &scene_joints_section},
    {"welds", SCENE_LIST, .fallback = "[]", .inside = &scene_weld,
     ARRAY(struct model, welds, n_welds),
     .about = "vertices of any cloths that are one", .section = &scene_welds_section},
    {"output", SCENE_MAP, .fallback = "{}", .inside = scene_output_keys,
     .about = "files in the folder of --output that not every run has"},
    {"phases", SCENE_LIST, .filled = true, .max = SCENE_MOST_PHASES, .inside = &phase,
     ARRAY(struct model, phases, n_phases),
     .about = "runs of the scene, each from where the one before ended; else it is one run",
     SECTION("Phases",
     "A garment is first sewn, then dropped: one command runs the phases of a scene one after "
     "the other. A phase changes the scene by its `set`, and the change stays until another "
     "phase sets that key; `KEY: null` gives the key its default again. `--set` of the command "
     "line comes last, and holds in every phase. `--set phases[0].set={...}` changes a phase "
     "itself, and `--set phases[0].set.time.end=0.2` one KEY of its set.\n\n"
     "A phase starts where the one before ended: all vertices have the same positions and "
     "velocities, to the last bit. Shapes at rest are those of the meshes. `start`, `from` and "
     "`velocity` are of the first phase alone. A pin holds a vertex where the phase starts, and "
     "a joint of length `start` has its length of then. `bdf2` begins a phase with a step by "
     "implicit Euler.\n\n"
     "The time of a phase begins at 0: its `motion`, `curve`, frames of bodies, joints, "
     "`time.end` and `time.rest` count so. Frames, rows of probes and their times go on, frames "
     "on one clock of `time.fps` over all phases: an end of a phase between two frames is no "
     "frame, but a row of probes.\n\n"
     "All phases have the same cloths with the same vertices and triangles, the same obstacles, "
     "probes, `time.fps` and `name`, and `contact.force` all or none. An obstacle may move in "
     "one phase and stand still in another, about one point. `scene.json` in the folder of "
     "frames has its motion over the time of all phases; it is written again when a phase "
     "begins.\n\n"
     "All scenes are read and checked before the first phase runs. Checks that depend on where a "
     "phase starts are made when it begins. If a phase fails, the frames up to then stay, and "
     "the message names the phase. SIGUSR1 and SIGTERM end the whole run. The report has a list "
     "`phases`; duite-cloth(1) says which of its other keys are of all phases and which of the "
     "last. The drape test, `--save-system` and the trace are of the last phase that runs.",
     "phases:\n"
     "  - {name: fall, set: {time.end: 0.5}}\n"
     "  - name: rest\n"
     "    set: {gravity: [0, -1.62, 0], 'cloths[0].pins': [], time.rest: {speed: 0.001}}\n")},
    {"grain", SCENE_INTEGER, .fallback = "1000", .min = 1, INTO(struct model, grain),
     .about = "vertices a block, about: the size of a task's data",
     .more = "From 16 blocks on their number becomes a multiple of four."},
    {0}};
/* clang-format on */

const struct scene_rule scene_root = {.type = SCENE_MAP, .inside = scene_keys};
