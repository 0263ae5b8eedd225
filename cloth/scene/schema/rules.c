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
#define TURBULENCE(member) INTO(struct phys_air, turbulence.member)
static const struct scene_rule turbulence_keys[] = {
    {"intensity", SCENE_NUMBER, .required = true, .range = SCENE_NOT_NEGATIVE,
     TURBULENCE(intensity),
     .about = "root mean square of the gusts along each axis, as a part of the wind's speed; 0.1 to "
     "0.3 near the ground"},
    {"length", SCENE_NUMBER, "m", .required = true, .range = SCENE_POSITIVE, TURBULENCE(length),
     .about = "how large gusts are: along this way they become other ones"},
    {"seed", SCENE_INTEGER, .fallback = "0", TURBULENCE(seed),
     .about = "another number, other gusts"},
    {0}};

static const struct scene_rule air_keys[] = {
    {"density", SCENE_NUMBER, "kg/m^3", "1.2", .range = SCENE_POSITIVE,
     INTO(struct phys_air, density),
     .about = "of the air"},
    {"wind", SCENE_LIST, "m/s", "[0, 0, 0]", VECTOR, INTO(struct phys_air, wind),
     .about = "velocity of the air; the same everywhere, without turbulence"},
    {"curve", SCENE_ONE_OF, .inside = scene_curve_kinds,
     .about = "what the wind is multiplied by in time; else it is constant", .needs = NEEDS_WIND,
     .section = "Curves"},
    {"turbulence", SCENE_MAP, .inside = turbulence_keys,
     .about = "gusts that the wind carries along ([physics.md](physics.md#air)); else there are none",
     .needs = NEEDS_WIND},
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
    {"axis", SCENE_LIST, .fallback = "[0, 1, 0]", VECTOR, INTO(struct model_drape, axis),
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
    {"gravity", SCENE_LIST, "m/s^2", "[0, -9.81, 0]", VECTOR, INTO(struct model, gravity),
     .about = "+y is up"},
    {"air", SCENE_MAP, .inside = air_keys, INTO(struct model, air),
     .about = "drag and wind on triangles; else there is none", .needs = NEEDS_TRIANGLES,
     .section = "Air"},
    {"cloths", SCENE_LIST, .required = true, .filled = true, .max = SCENE_MOST_NAMED,
     .inside = &scene_cloth, ARRAY(struct model, cloths, n_cloths),
     .about = "what moves", .section = "Cloths"},
    {"materials", SCENE_NAMED, .inside = &scene_material,
     ARRAY(struct model, materials, n_materials), .name = FIELD(struct model_material, name),
     .about = "NAME is yours; [fabrics](fabrics.md) are there",
     .section = "Materials"},
    {"obstacles", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &scene_obstacle,
     .about = "what the cloth meets, still or moving by key frames", .section = "Obstacles"},
    {"contact", SCENE_MAP, .fallback = "{}", .inside = scene_contact_keys,
     INTO(struct model, contact),
     .about = "how obstacles are met, and cloth", .section = "Contact"},
    {"time", SCENE_MAP, .required = true, .inside = scene_time_keys,
     .about = "of the simulation", .section = "Time"},
    {"integrator", SCENE_CHOICE, .fallback = "implicit_euler", INTO(struct model, integrator),
     .words = model_integrators,
     .about = "how a step is made"},
    {"energies", SCENE_CHOICE, .fallback = "ends", INTO(struct model, energy_steps),
     WORDS({"ends", false}, {"steps", true}),
     .about = "the report's: of start and end; or also how they rose and fell from step to step"},
    {"newton", SCENE_MAP, .fallback = "{}", .inside = scene_newton_keys,
     .about = "Newton steps, with a line search, of implicit steps", .needs = NEEDS_IMPLICIT,
     .section = "Newton steps"},
    {"solver", SCENE_MAP, .fallback = "{}", .inside = scene_solver_keys,
     .about = "of implicit steps", .needs = NEEDS_IMPLICIT, .section = "Solver"},
    {"probes", SCENE_LIST, .fallback = "[]", .max = SCENE_MOST_NAMED, .inside = &scene_probe,
     ARRAY(struct model, probes, n_probes),
     .about = "what probes.csv reports after each step", .section = "Probes"},
    {"drape", SCENE_MAP, .inside = drape_keys, INTO(struct model, drape),
     .about = "the drape test of textile laboratories: its coefficient is printed; else there is "
     "none", .section = "The drape test"},
    {"joints", SCENE_LIST, .fallback = "[]", .inside = &scene_joint,
     ARRAY(struct model, joints, n_joints),
     .about = "springs between any two vertices", .section = "Joints"},
    {"welds", SCENE_LIST, .fallback = "[]", .inside = &scene_weld,
     ARRAY(struct model, welds, n_welds),
     .about = "vertices of any cloths that are one", .section = "Welds"},
    {"output", SCENE_MAP, .fallback = "{}", .inside = scene_output_keys,
     .about = "files in the folder of --output that not every run has"},
    {"phases", SCENE_LIST, .filled = true, .max = SCENE_MOST_PHASES, .inside = &phase,
     ARRAY(struct model, phases, n_phases),
     .about = "runs of the scene, each from where the one before ended; else it is one run",
     .section = "Phases"},
    {"grain", SCENE_INTEGER, .min = 1, INTO(struct model, grain),
     .about = "vertices a block, about: the size of a task's data; else a 64th of all vertices, "
     "from 1000 to 4000"},
    {0}};
/* clang-format on */

const struct scene_rule scene_root = {.type = SCENE_MAP, .inside = scene_keys};
