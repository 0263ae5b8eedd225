/* A key that does nothing beside the others draws one warning, with its place; the scene is read
 * all the same. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SETS = 4 };

/* Sets, of which the last one but for NULLs is that of the idle key, and what it is told; NULL:
 * there is no warning. */
static const struct {
    const char *set[MAX_SETS], *warning;
} cases[] = {
    {{"contact.mode=project"}, NULL},
    {{"contact.self=on"}, NULL},
    {{"contact.mode=project", "contact.self=on"},
     "contact.self means nothing: it is of contact.mode certified and repulsion"},
    {{"contact.stiffness=5"}, "contact.stiffness means nothing: it is of contact.mode repulsion"},
    {{"contact.damping=0.3"}, "contact.damping means nothing: it is of contact.mode repulsion"},
    {{"contact.mode=certified", "contact.damping=0.3"}, "contact.damping means nothing"},
    {{"contact={mode: repulsion, self: on, stiffness: 5, damping: 0.3, friction: 0.3}"}, NULL},
    {{"contact.self=off"}, NULL},
    {{"contact.untangle=on"}, "contact.untangle means nothing: it is of contact.mode certified"},
    {{"contact.untangle=off"}, NULL},
    {{"cloths[0].layer=1"}, "layer means nothing: it is of contact.untangle"},
    {{"contact.mode=certified", "cloths[0].layer=1"}, "layer means nothing"},
    {{"contact.mode=certified", "contact.untangle=on"}, NULL},
    {{"contact.mode=project", "contact.force=on"},
     "contact.force means nothing: it is of contact.mode certified"},
    {{"contact.thickness=0.002"}, "contact.thickness means nothing"},
    {{"contact.friction=0.3"}, "contact.friction means nothing"},
    {{"contact.friction=0"}, NULL},
    {{"contact.pairs=[{of: [cotton, cotton], friction: 1}]"}, "contact.pairs means nothing"},
    {{"contact.mode=certified", "contact.thickness=0.01", "obstacles[0].plane.name=floor",
      "contact.pairs=[{of: [floor, floor], friction: 1}]"},
     "contact.pairs[0] means nothing: obstacles do not touch each other"},
    {{"contact.ignore=[[sheet, sheet]]"}, "contact.ignore means nothing: by project cloths meet"},
    {{"obstacles[0].plane.name=floor", "contact.ignore=[[sheet, floor]]"}, NULL},
    {{"materials.cotton.friction=0.3"}, "friction means nothing"},
    {{"obstacles[0].plane.friction=0.3"}, "friction means nothing"},
    {{"solver.stop.count=3"}, NULL},
    {{"integrator=rk4", "solver.stop.count=3"}, "solver means nothing: explicit steps"},
    {{"integrator=rk4", "newton.steps=3"}, "newton means nothing: explicit steps"},
    {{"newton.steps=3", "newton.tolerance=0.1"}, NULL},
    {{"newton.tolerance=0.1"}, "newton.tolerance means nothing: it spares Newton steps"},
    {{"solver.guess=previous"}, NULL},
    {{"integrator=bdf2", "solver.guess=previous"}, "solver.guess previous is of implicit_euler"},
    {{"newton.steps=2", "solver.guess=previous"}, "solver.guess previous is of implicit_euler"},
    {{"solver.max_iterations=9"}, NULL},
    {{"solver.stop.count=3", "solver.max_iterations=9"}, "solver.max_iterations means nothing"},
    {{"solver.patches=2"}, NULL},
    {{"solver.preconditioner=ic0", "solver.patches=2"}, "solver.patches means nothing"},
    {{"solver.jacobian=absolute"}, NULL},
    {{"materials.cotton.model=triangles", "solver.jacobian=absolute"},
     "solver.jacobian absolute is of springs"},
    {{"solver.format=springs"}, NULL},
    {{"materials.cotton.model=triangles", "solver.format=half"}, NULL},
    {{"materials.cotton.model=triangles", "solver.format=springs"},
     "solver.format springs holds springs alone"},
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
      "materials.cotton.ea=1", "air={}"},
     "air means nothing: it blows on triangles"},
    {{"cloths[0].start=[{vertices: [1], velocity: [0, 0, 0]}]"}, NULL},
    {{"cloths[0].start=[{vertices: [1]}]"}, "a start changes nothing"},
    {{"cloths[0].start=[{vertices: [1], spin: [1, 0, 0], about: [1, 0, 0]}]"}, NULL},
    {{"cloths[0].start=[{vertices: [1], velocity: [1, 0, 0], about: [1, 0, 0]}]"},
     "about means nothing: the start has no scale, rotate or spin"},
    {{"cloths[0].start=[{vertices: [1], wave: {vector: [1, 0, 0], translate: [0, 1, 0]}}]"}, NULL},
    {{"cloths[0].start=[{vertices: [1], wave: {vector: [1, 0, 0]}}]"}, "a wave has neither"},
    {{"cloths[0].pins[0].motion={times: [0], rotate: [[1, 0, 0, 0]], about: [1, 0, 0]}"}, NULL},
    {{"cloths[0].pins[0].motion={times: [0]}"}, "a motion has neither translate nor rotate"},
    {{"cloths[0].pins[0].motion={times: [0], translate: [[0, 0, 0]], about: [1, 0, 0]}"},
     "about means nothing: the motion does not rotate"},
    {{"obstacles[0].plane.motion={times: [0], translate: [[0, 1, 0]]}"}, NULL},
    {{"obstacles[0].plane.motion={times: [0, 1]}"}, "a motion has neither translate nor rotate"},
    {{"obstacles[0].plane.motion={times: [0], translate: [[0, 1, 0]], about: [1, 0, 0]}"},
     "about means nothing: the motion does not rotate"},
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

UNIT_LOOP(idle_keys_are_warned_of, 0, sizeof cases / sizeof *cases)
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

/* In the file the place is that of the value. */
UNIT_TEST(places_in_files)
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
