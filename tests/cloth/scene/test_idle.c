/* A key that does nothing beside the others draws one warning, with its place; the scene is read
 * all the same. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SETS = 4 };

/* Three vertices, two of which may be joined, in place of the sheet. */
#define MESH(elements)                                                                             \
    "cloths[0]={mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [0, 0, 1]], " elements            \
    "}}, material: cotton, mass_per_vertex: 1}"
#define TRIANGLE  "triangles: [[0, 1, 2]]"
#define JOINT     "joints=[{from: {vertex: 0}, to: {vertex: 1}, stiffness: 5}]"
#define TRIANGLES "materials.cotton={density: 0.2, stretch: 50, shear: 9, model: triangles}"

/* Sets, of which the last one but for NULLs is that of the idle key, and what it is told; NULL:
 * there is no warning. */
static const struct {
    const char *set[MAX_SETS], *warning;
} cases[] = {
    {{"contact.mode=project"}, NULL},
    {{"contact.self=on"}, NULL},
    {{"contact.mode=project", "contact.self=on"},
     "contact.self means nothing: it needs contact.mode = certified or repulsion"},
    {{"contact.stiffness=5"}, "contact.stiffness means nothing: it needs contact.mode = repulsion"},
    {{"contact.damping=0.3"}, "contact.damping means nothing: it needs contact.mode = repulsion"},
    {{"contact.mode=certified", "contact.damping=0.3"}, "contact.damping means nothing"},
    {{"contact={mode: repulsion, self: on, stiffness: 5, damping: 0.3, friction: 0.3}"}, NULL},
    {{"contact.self=off"}, NULL},
    {{"contact.untangle=on"}, "contact.untangle means nothing: it needs contact.mode = certified"},
    {{"contact.untangle=off"}, NULL},
    {{"cloths[0].layer=1"}, "cloths[0].layer means nothing: it needs contact.untangle = on"},
    {{"contact.mode=certified", "cloths[0].layer=1"},
     "cloths[0].layer means nothing: it needs contact.untangle = on"},
    {{"contact.mode=certified", "contact.untangle=on"}, NULL},
    {{"contact.mode=project", "contact.force=on"},
     "contact.force means nothing: it needs contact.mode = certified"},
    {{"contact.thickness=0.002"}, "contact.thickness means nothing"},
    {{"contact.friction=0.3"}, "contact.friction means nothing"},
    {{"contact.friction=0"}, NULL},
    {{"contact.pairs=[{of: [cotton, cotton], friction: 1}]"}, "contact.pairs means nothing"},
    {{"contact.mode=certified", "contact.thickness=0.01", "obstacles[0].plane.name=floor",
      "contact.pairs=[{of: [floor, floor], friction: 1}]"},
     "contact.pairs[0] means nothing: obstacles do not touch each other"},
    {{"contact.ignore=[[sheet, sheet]]"},
     "contact.ignore means nothing: it needs a pair that could meet (by project a cloth and an "
     "obstacle)"},
    {{"obstacles[0].plane.name=floor", "contact.ignore=[[sheet, floor]]"}, NULL},
    {{"materials.cotton.friction=0.3"},
     "materials.cotton.friction means nothing: it needs contact.mode = certified or repulsion"},
    {{"obstacles[0].plane.friction=0.3"},
     "obstacles[0].plane.friction means nothing: it needs contact.mode = certified or repulsion"},
    {{"solver.stop.count=3"}, NULL},
    {{"integrator=rk4", "solver.stop.count=3"},
     "solver means nothing: it needs integrator = implicit_euler or bdf2"},
    {{"integrator=rk4", "newton.steps=3"},
     "newton means nothing: it needs integrator = implicit_euler or bdf2"},
    {{"newton.steps=3", "newton.tolerance=0.1"}, NULL},
    {{"newton.tolerance=0.1"}, "newton.tolerance means nothing: it needs steps > 1"},
    {{"solver.guess=previous"}, NULL},
    {{"integrator=bdf2", "solver.guess=previous"},
     "solver.guess previous means nothing: it needs integrator = implicit_euler and newton.steps = "
     "1"},
    {{"newton.steps=2", "solver.guess=previous"},
     "solver.guess previous means nothing: it needs integrator = implicit_euler and newton.steps = "
     "1"},
    {{"solver.max_iterations=9"}, NULL},
    {{"solver.stop.count=3", "solver.max_iterations=9"}, "solver.max_iterations means nothing"},
    {{"solver.patches=2"}, NULL},
    {{"solver.preconditioner=ic0", "solver.patches=2"}, "solver.patches means nothing"},
    {{"solver.jacobian=absolute"}, NULL},
    {{TRIANGLES, "solver.jacobian=absolute"},
     "solver.jacobian absolute means nothing: it needs joints, or a material of springs"},
    {{"solver.format=springs"}, NULL},
    {{TRIANGLES, "solver.format=half"}, NULL},
    {{TRIANGLES, "solver.format=springs"},
     "solver.format springs means nothing: it needs a scene without triangles that resist, bending "
     "and limits of strain"},
    {{"time.stretch_growth=0.2"}, NULL},
    {{"time.halving=off", "time.stretch_growth=0.2"}, "time.stretch_growth means nothing"},
    {{"time.halving=off", "time.stretch_growth=0"}, NULL},
    {{"time.energy_growth=0.2"}, NULL},
    {{"integrator=rk4", "time.energy_growth=0"}, NULL},
    {{"integrator=rk4", "time.energy_growth=0.2"}, "time.energy_growth means nothing"},
    {{"air={wind: [1, 0, 0]}", "time.energy_growth=0.2"}, "time.energy_growth means nothing"},
    {{"time.rest={}", "cloths[0].loads[0].curve.keys=[[0, 1]]"}, NULL},
    {{"cloths[0].loads[0].curve.sine.frequency=1", "time.rest={}"}, "time.rest means nothing"},
    {{"joints=[{from: {vertex: 0}, to: {vertex: 1}, stiffness: 1, begin: 0.01}]"}, NULL},
    {{"joints=[{from: {vertex: 0}, to: {vertex: 1}, stiffness: 1, begin: 100}]"},
     "the joint begins at 100 s, when the run is over"},
    {{"time.h=0.1", "time.end=1",
      "joints=[{from: {vertex: 0}, to: {vertex: 1}, stiffness: 1, begin: 0.95}]"},
     "the joint begins at 0.95 s, after the last step has begun"},
    {{"time.h=0.1", "time.end=1",
      "joints=[{from: {vertex: 0}, to: {vertex: 1}, stiffness: 1, begin: 0.32, end: 0.38}]"},
     "the joint acts from 0.32 s to 0.38 s, when no step of 0.1 s begins"},
    {{"time.h=0.1", "time.end=1",
      "joints=[{from: {vertex: 0}, to: {vertex: 1}, stiffness: 1, begin: 0.3, end: 0.4}]"},
     NULL},
    {{"air={}"}, NULL},
    {{"air={wind: [0, 0, 1], curve: {keys: [[0, 1]]}}"}, NULL},
    {{"air={curve: {keys: [[0, 1]]}}"}, "air.curve means nothing"},
    {{"cloths[0]={mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}, material: "
      "cotton}",
      "materials.cotton={density: 0.2, ea: 1}", "air={}"},
     "air means nothing: it needs a cloth with triangles"},
    {{"cloths[0].start=[{vertices: [1], velocity: [0, 0, 0]}]"}, NULL},
    {{"cloths[0].start=[{vertices: [1]}]"},
     "cloths[0].start[0] means nothing: it needs scale or rotate or translate or velocity or spin "
     "or wave"},
    {{"cloths[0].start=[{vertices: [1], spin: [1, 0, 0], about: [1, 0, 0]}]"}, NULL},
    {{"cloths[0].start=[{vertices: [1], velocity: [1, 0, 0], about: [1, 0, 0]}]"},
     "cloths[0].start[0].about means nothing: it needs scale or rotate or spin"},
    {{"cloths[0].start=[{vertices: [1], wave: {vector: [1, 0, 0], translate: [0, 1, 0]}}]"}, NULL},
    {{"cloths[0].start=[{vertices: [1], wave: {vector: [1, 0, 0]}}]"},
     "cloths[0].start[0].wave means nothing: it needs translate or velocity"},
    {{"cloths[0].pins[0].motion={times: [0], rotate: [[1, 0, 0, 0]], about: [1, 0, 0]}"}, NULL},
    {{"cloths[0].pins[0].motion={times: [0]}"},
     "cloths[0].pins[0].motion means nothing: it needs translate or rotate"},
    {{"cloths[0].pins[0].motion={times: [0], translate: [[0, 0, 0]], about: [1, 0, 0]}"},
     "cloths[0].pins[0].motion.about means nothing: it needs rotate"},
    {{"obstacles[0].plane.motion={times: [0], translate: [[0, 1, 0]]}"}, NULL},
    {{"obstacles[0].plane.motion={times: [0, 1]}"},
     "obstacles[0].plane.motion means nothing: it needs translate or rotate"},
    {{"obstacles[0].plane.motion={times: [0], translate: [[0, 1, 0]], about: [1, 0, 0]}"},
     "obstacles[0].plane.motion.about means nothing: it needs rotate"},
    {{"materials.cotton.poisson=0.3"},
     "materials.cotton.poisson means nothing: it needs model = triangles"},
    {{TRIANGLES, "materials.cotton.poisson=0.3"}, NULL},
    {{"materials.cotton.poisson=0"}, NULL},
    {{"materials.unused={density: 1, ea: 1, shear: 1, strain_limit: {at: 0.1, stiffness: 5}}"},
     NULL},
    {{"materials.cotton.forces=uncorrected"},
     "materials.cotton.forces uncorrected means nothing: it needs model = triangles"},
    {{"materials.cotton.forces=exact"}, NULL},
    {{TRIANGLES, "materials.cotton.bend=1"},
     "materials.cotton.bend means nothing: it needs model = springs and a cloth of"},
    {{"materials.cotton.bend=1"}, NULL},
    {{"materials.cotton.shear=1"}, NULL},
    {{MESH(TRIANGLE), "materials.cotton.shear=1"},
     "materials.cotton.shear means nothing: it needs a grid, or model = triangles"},
    {{"materials.cotton.ea=1"},
     "materials.cotton.ea means nothing: it needs a cloth of the material with edges without"},
    {{MESH("edges: [[0, 1]], " TRIANGLE), "materials.cotton.ea=1"},
     "materials.cotton.ea means nothing: it needs a cloth of"},
    {{MESH("edges: [[0, 1]]"),
      "materials.cotton={density: 0.2, ea: 1, strain_limit: {at: 0.1, stiffness: 5}}"},
     NULL},
    {{MESH("edges: []"), JOINT, "materials.cotton={strain_limit: {at: 0.1, stiffness: 5}}"},
     "materials.cotton.strain_limit means nothing: it needs a cloth of the material with edges"},
    {{MESH("edges: []"), JOINT, "materials.cotton={velocity_correction: {}}"},
     "materials.cotton.velocity_correction means nothing: it needs a cloth of the material with "
     "edges"},
    {{MESH("edges: [[0, 1]]"), "materials.cotton={ea: 1, bend: 1}"},
     "materials.cotton.bend means nothing: it needs model = springs and a cloth of the material "
     "with triangles"},
    {{MESH("edges: [[0, 1]]"), "materials.cotton={ea: 1, bending: {rigidity: 1e-3}}"},
     "materials.cotton.bending means nothing: it needs a cloth of the material with triangles"},
    {{MESH("edges: [[0, 1]]"), "materials.cotton={ea: 1, stretch: 1}"},
     "materials.cotton.stretch means nothing: it needs a cloth of the material with triangles"},
    {{"materials.cotton.damping.bending=1"},
     "materials.cotton.damping.bending means nothing: it needs bend or bending"},
    {{"materials.cotton={density: 0.2, stretch: 5, bend: 1, damping: {bending: 1}}"}, NULL},
    {{"materials.cotton={density: 0.2, stretch: 5, bend: 0, damping: {bending: 1}}"},
     "materials.cotton.damping.bending means nothing"},
    {{"materials.cotton={density: 0.2, stretch: 5, bending: {rigidity: 1e-6}, damping: {bending: "
      "1}}"},
     NULL},
    {{"materials.cotton={like: denim, model: springs}"}, NULL},
    {{"materials.cotton={density: 0.2, stretch: 50, model: triangles}"},
     "materials.cotton.shear is 0: nothing resists its triangles' being sheared"},
    {{"materials.cotton.density=0.005"}, NULL},
    {{"materials.cotton.density=5"}, NULL},
    {{"materials.cotton.density=0.004"},
     "materials.cotton.density is 0.004 kg/m^2; fabrics have 0.005 to 5: is its unit right?"},
    {{"materials.cotton.density=200"}, "materials.cotton.density is 200 kg/m^2; fabrics have"},
    {{"materials.cotton={density: 0.2, stretch: 500, bending: {rigidity: [1e-2, 0]}}"}, NULL},
    {{"materials.cotton.bending={rigidity: 0.5}"},
     "materials.cotton.bending.rigidity is 0.5 N m; fabrics have up to 0.01: is its unit right?"},
    {{"materials.cotton.bending={rigidity: [1e-6, 1]}"},
     "materials.cotton.bending.rigidity is 1 N m; fabrics have up to 0.01"},
    {{"materials.cotton.stretch=0"},
     "materials.cotton.stretch is 0: nothing resists being stretched"},
    {{"materials.cotton.model=triangles", "materials.cotton.shear=10",
      "materials.cotton.stretch=[0, 9]"},
     "materials.cotton.stretch is 0 along the warp: nothing resists being stretched there"},
    {{"materials.cotton.stretch=[9, 0]"},
     "materials.cotton.stretch is 0 along the weft: nothing resists being stretched there"},
    {{"cloths[0].transform.rotate=[1, 1, 0, 0]"}, NULL},
    {{"cloths[0].transform.rotate=[0, 90, 0, 0]"},
     "rotate is a quaternion of length 90, which is taken as if it were 1; [w, x, y, z] is "
     "cos(a/2) and sin(a/2) times the axis"},
    {{"cloths[0].start=[{vertices: [1], rotate: [0, 0.1, 0, 0]}]"},
     "rotate is a quaternion of length 0.1"},
    {{"cloths[0].pins[0].motion={times: [0, 1], rotate: [[1, 0, 0, 0], [1, 0, 0, 9]]}"},
     "rotate is a quaternion of length 9"},
    {{"obstacles[0]={box: {centre: [9, 0, 0], size: [1, 1, 1], rotate: [45, 0, 1, 0]}}"},
     "rotate is a quaternion of length 45"},
    {{"obstacles[0].plane.motion={times: [0, 1], rotate: [[1, 0, 0, 0], [1, 0, 0, 9]]}"},
     "rotate is a quaternion of length 9"},
};

START_TEST(idle_keys_are_warned_of)
{
    struct scene_set sets[MAX_SETS];
    size_t n = 0;
    while (n < MAX_SETS && cases[_i].set[n]) {
        sets[n] = (struct scene_set){.text = cases[_i].set[n]};
        n++;
    }
    char begin[500];
    snprintf(begin, sizeof begin, "--set %s: %s", cases[_i].set[n - 1],
             cases[_i].warning ? cases[_i].warning : "");
    struct model model = scene_read_right(scene_right, n, sets);
    ck_assert_msg(model.n_warnings == (cases[_i].warning != NULL), "%u warnings; %s",
                  model.n_warnings, model.n_warnings ? model.warnings[0] : begin);
    if (cases[_i].warning)
        ck_assert_msg(!strncmp(model.warnings[0], begin, strlen(begin)), "\"%s\", not \"%s\"",
                      model.warnings[0], begin);
    model_free(&model);
}
END_TEST

/* In the file the place is that of the value. */
START_TEST(places_in_files)
{
    char *text = scene_changed(scene_right, "gravity:", "contact: {friction: 1}\ngravity:");
    struct model model = scene_read_right(text, 0, NULL);
    const size_t path = strlen(scene_path());
    ck_assert_uint_eq(model.n_warnings, 1);
    ck_assert_msg(!strncmp(model.warnings[0], scene_path(), path), "%s", model.warnings[0]);
    ck_assert_msg(!strncmp(model.warnings[0] + path, ":2:21: contact", 14), "%s",
                  model.warnings[0]);
    model_free(&model);
    free(text);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("idle keys");
    TCase *all = tcase_create("keys");
    tcase_add_loop_test(all, idle_keys_are_warned_of, 0, sizeof cases / sizeof *cases);
    tcase_add_test(all, places_in_files);
    suite_add_tcase(suite, all);
    return unit_run(suite);
}
