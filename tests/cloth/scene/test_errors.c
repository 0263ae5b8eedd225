/* What is wrong with a file as such, its keys, numbers, times and with sets has its own sentence,
 * with the line and column where it is wrong. Each case changes one place of the scene that is
 * right and expects the whole text of the error. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

START_TEST(times_out_of_range)
{
    EXPECT(
        {"h: 0.001", "h: 0", .error = ":12:11: time.h is 0; a finite number > 0 (s) is expected"},
        {"h: 0.001", "h: -1", .error = ":12:11: time.h is -1; a finite number > 0 (s) is expected"},
        {"end: 0.1", "end: -0",
         .error = ":12:23: time.end is -0; a finite number > 0 (s) is expected"},
        {"end: 0.1", "end: 0.0004",
         .error = ":12:23: time.end is 0.0004, less than half a step; at least time.h = 0.001 is "
                  "expected"},
        {"end: 0.1", "end: 1e9",
         .error = ":12:23: time.end / time.h is 1e+12 steps; at most 4294967294 are possible"},
        {"end: 0.1", "end: 0.1, fps: 0",
         .error = ":12:33: time.fps is 0; a finite number > 0 (1/s) is expected"});
}
END_TEST

START_TEST(what_is_no_number)
{
    static const char *const not_numbers[] = {".nan",  "nan", "NaN",   ".inf", "-inf", "0x10",
                                              "1_000", "1e",  "1e+",   ".",    "-",    "1.2.3",
                                              "1 2",   "abc", "1e999", "true"};
    for (size_t i = 0; i < sizeof not_numbers / sizeof not_numbers[0]; i++) {
        char to[64], error[200];
        snprintf(to, sizeof to, "stretch: %s", not_numbers[i]);
        snprintf(error, sizeof error,
                 ":10:35: materials.cotton.stretch is %s; a finite number >= 0 or a list of 2 of "
                 "them (N/m) is expected",
                 not_numbers[i]);
        scene_expect_errors(&(struct scene_wrong){"stretch: 50", to, NULL, error}, 1);
    }
    EXPECT({"stretch: 50", "stretch: '50'",
            .error = ":10:35: materials.cotton.stretch is the text '50'; a finite number >= 0 or a "
                     "list of 2 of them (N/m) is expected"},
           {"stretch: 50", "stretch: ",
            .error =
                ":10:35: materials.cotton.stretch is empty; a finite number >= 0 or a list of 2 of "
                "them (N/m) is expected"},
           {"nx: 4", "nx: 4.0",
            .error = ":5:44: cloths[0].mesh.grid.nx is 4.0; a whole number from 2 to 4294967295 is "
                     "expected"},
           {"nx: 4", "nx: 4294967296",
            .error = ":5:44: cloths[0].mesh.grid.nx is 4294967296; a whole number from 2 to "
                     "4294967295 is expected"},
           {"vertices: [0, 3]", "vertices: [0, -1]",
            .error =
                ":7:27: cloths[0].pins[0].vertices[1] is -1; a whole number from 0 to 4294967295 "
                "is expected"});
}
END_TEST

/* In a map without line breaks the comma begins a key. */
START_TEST(decimal_commas)
{
    EXPECT({"density: 0.2", "density: 0,2",
            .error = ":10:21: materials.cotton.density is 0,2; a number has no comma: its decimals "
                     "follow a point, as in 0.2"},
           {"stretch: 50", "stretch: 1,000",
            .error = ":10:35: materials.cotton.stretch is 1,000; a number has no comma: its "
                     "decimals follow a point, as in 0.2"},
           {"gravity: [0, -9.81, 0]", "name: a\nair:\n  density: 1,2",
            .error = ":4:12: air.density is 1,2; a finite number > 0 (kg/m^3) is expected: a "
                     "number has no comma: its decimals follow a point, as in 0.2"},
           {.set = "time.h=0,001",
            .error = "--set time.h=0,001: time.h is 0,001; a finite number > 0 (s) is expected: a "
                     "number has no comma: its decimals follow a point, as in 0.2"});
}
END_TEST

START_TEST(wrong_kinds)
{
    EXPECT({"gravity: [0, -9.81, 0]", "gravity: 9.81",
            .error = ":2:10: gravity is 9.81; a list of 3 numbers (m/s^2) is expected"},
           {"gravity: [0, -9.81, 0]", "gravity: [0, 1]",
            .error = ":2:10: gravity is a list of 2; a list of 3 numbers (m/s^2) is expected"},
           {"gravity: [0, -9.81, 0]", "gravity: [0, {a: 1}, 0]",
            .error = ":2:14: gravity[1] is a map of 1; a finite number (m/s^2) is expected"},
           {"time: {h: 0.001, end: 0.1}", "time: 3", .error = ":12:7: time is 3; a map of h, ..."},
           {"name: sheet", "name: ''",
            .error = ":4:11: cloths[0].name is the text ''; a text is expected"},
           {"name: sheet", "name: [a]",
            .error = ":4:11: cloths[0].name is a list of 1; a text is expected"},
           {"name: sheet", "name: !mine a",
            .error = ":4:11: cloths[0].name has the tag !mine; a value without a tag is expected"},
           {"gravity: [0, -9.81, 0]", "integrator: rk5",
            .error = ":2:13: integrator is rk5; implicit_euler or explicit_euler or "
                     "symplectic_euler or verlet or rk4 or bdf2 is expected"},
           {"gravity: [0, -9.81, 0]", "integrator: midpoint",
            .error = ":2:13: integrator is midpoint; implicit_euler or explicit_euler or "
                     "symplectic_euler or verlet or rk4 or bdf2 is expected: use verlet, which has "
                     "its order at half the work"});
}
END_TEST

START_TEST(wrong_contact)
{
    EXPECT(
        {"gravity: [0, -9.81, 0]", "contact: {mode: projekt}",
         .error = ":2:17: contact.mode is projekt; certified or repulsion or project is expected"},
        {"gravity: [0, -9.81, 0]", "contact: project",
         .error = ":2:10: contact is project; a map of mode, self, untangle, force, "
                  "thickness, friction, pairs, ignore, stiffness, damping is expected: write "
                  "contact: {mode: project}"},
        {"gravity: [0, -9.81, 0]", "contact: filter",
         .error = ":2:10: contact is filter; a map of mode, self, untangle, force, "
                  "thickness, friction, pairs, ignore, stiffness, damping is expected: it is gone; "
                  "contact: {mode: "
                  "certified} or {mode: "
                  "project} is there"},
        {"gravity: [0, -9.81, 0]", "contact: {mode: filter}",
         .error =
             ":2:17: contact.mode is filter; certified or repulsion or project is expected: it "
             "is gone; certified knows of contact in the solve, too"},
        {"gravity: [0, -9.81, 0]", "contact: {friction: -0.1}",
         .error = ":2:21: contact.friction is -0.1; a finite number >= 0 and <= 1000 is expected"},
        {"gravity: [0, -9.81, 0]", "contact: {thickness: 0}",
         .error = ":2:22: contact.thickness is 0; a finite number > 0 (m) is expected"},
        {"gravity: [0, -9.81, 0]", "contact: {mode: certified}\nintegrator: verlet",
         .error = ":2:17: contact.mode is certified, which implicit_euler and bdf2 can do: "
                  "explicit steps (integrator: verlet) solve no system that knows of contact; "
                  "repulsion or project is expected"},
        {"gravity: [0, -9.81, 0]", "contact: {mode: repulsion, stiffness: 0}",
         .error = ":2:39: contact.stiffness is 0; a finite number > 0 (N/m) is expected"},
        {"gravity: [0, -9.81, 0]", "contact: {mode: repulsion, damping: -1}",
         .error = ":2:37: contact.damping is -1; a finite number >= 0 is expected"},
        {"gravity: [0, -9.81, 0]", "contact: {mode: certified, thickness: 1e-8}",
         .error = ":2:39: contact.thickness is 1e-08 m; at least ..."},
        {"gravity: [0, -9.81, 0]", "contact: {pairs: [{of: [cotton], friction: 1}]}",
         .error = ":2:24: contact.pairs[0].of is a list of 1; a list of 2 texts is expected"},
        {"gravity: [0, -9.81, 0]", "contact: {self: on, thickness: 1e-8}",
         .error = ":2:32: contact.thickness is 1e-08 m; at least 2.07e-06 m is expected: frames "
                  "are in float, and cloth that is 1 m from the origin needs that much; contact "
                  "is certified by default in this scene, contact: {mode: project} is the way "
                  "without"});
}
END_TEST

START_TEST(wrong_pins)
{
    EXPECT(
        {"pins: [{vertices: [0, 3]}]",
         "pins: [{vertices: [0, 3], follow: a, motion: {times: [0], translate: [[0, 0, 0]]}}]",
         .error = ":7:50: a pin follows an obstacle and has a motion; one of the two is expected"},
        {"pins: [{vertices: [0, 3]}]",
         "pins: [{vertices: [0, 3], follow: a, to: line, direction: [1, 0, 0]}]",
         .error = ":7:39: a pin to a line cannot follow an obstacle; to: point is expected"},
        {"[{vertices: [0, 3]}]", "[]\n    loads: []",
         .error = ":9:5: loads is twice in cloths[0]; each key is allowed once"},
        {"pins: [{vertices: [0, 3]}]", "pins: [{}]",
         .error = ":7:12: cloths[0].pins[0] has no vertices or nearest or box or group; one of "
                  "them is expected"},
        {"{vertices: [0, 3]}", "{vertices: [0], nearest: [0, 0, 0]}",
         .error = ":7:28: cloths[0].pins[0] has both vertices and nearest; one of vertices or "
                  "nearest or box or group is expected"},
        {"vertices: [0, 3]", "vertices: []",
         .error = ":7:23: cloths[0].pins[0].vertices is an empty list; a non-empty list of "
                  "whole numbers is expected"});
}
END_TEST

START_TEST(wrong_names)
{
    EXPECT(
        {"gravity: [0, -9.81, 0]", "contact: {pairs: [{of: [coton, sheet], friction: 1}]}",
         .error = ":2:25: there is no material or obstacle 'coton'; did you mean 'cotton'? "
                  "Allowed: cotton"},
        {"gravity: [0, -9.81, 0]",
         "contact: {pairs: [{of: [cotton, cotton], friction: 1}, {of: [cotton, cotton], friction: "
         "2}]}",
         .error = ":2:61: contact.pairs[0] and contact.pairs[1] are of the same two; one is "
                  "expected"},
        {"gravity: [0, -9.81, 0]", "contact: {ignore: [[sheet, shet]]}",
         .error = ":2:28: there is no cloth, obstacle or group 'shet'; did you mean 'sheet'? "
                  "Allowed: sheet"},
        {"obstacles: [{plane: {",
         "contact: {ignore: [[sheet, warn]]}\nobstacles: [{plane: {groups: [warm, warm], ",
         .error = ":11:28: there is no cloth, obstacle or group 'warn'; did you mean 'warm'? "
                  "Allowed: sheet, warm"},
        {"gravity: [0, -9.81, 0]", "contact: {friction: 1001}",
         .error = ":2:21: contact.friction is 1001; a finite number >= 0 and <= 1000 is expected"},
        {"plane: {", "plane: {name: cotton, ",
         .error = ":11:28: an obstacle is named 'cotton', as a material is; another name is "
                  "expected, since contact.pairs has names of both"},
        {"[{plane: {", "[{sphere: {name: a, centre: [0, 9, 0], radius: 1}}, {plane: {name: a, ",
         .error = ":11:79: a second obstacle is named 'a'; names must differ"},
        {"pins: [{vertices: [0, 3]}]", "pins: [{vertices: [0, 3], follow: flor}]",
         .error = ":7:39: there is no obstacle 'flor'; there are 1, counted from 0, and none has a "
                  "name"});
}
END_TEST

START_TEST(unknown_and_missing_keys)
{
    EXPECT({"time:", "tiem:",
            .error =
                ":12:1: tiem is not a key of the scene; did you mean 'time'? Allowed: schema, ..."},
           {"h: 0.001", "h: 0.001, dt: 1",
            .error = ":12:18: dt is not a key of time; allowed: h, ..."},
           {"h: 0.001", "h: 0.001, fsp: 1",
            .error = ":12:18: fsp is not a key of time; did you mean 'fps'? Allowed: h, ..."},
           {"stretch: 50", "strech: 50",
            .error = ":10:26: strech is not a key of materials.cotton; did you mean 'stretch'? "
                     "Allowed: like, ..."},
           {"gravity: [0, -9.81, 0]", "solver: {form: classic}",
            .error = ":2:10: form is no longer a key of solver: conjugate gradients have one form, "
                     "with one sum an iteration"},
           {"vertices: [11]", "vertex: [11]",
            .error = ":8:14: vertex is not a key of cloths[0].loads[0]; allowed: vertices, ..."},
           {"plane:", "plan:",
            .error = ":11:14: plan is not a key of obstacles[0]; did you mean 'plane'? "
                     "Allowed: plane, ..."},
           {"end: 0.1", "fps: 1",
            .error = ":12:7: time.end is missing; a finite number > 0 (s) is expected"},
           {"schema: 1\n", "", .error = ":1:1: schema is missing; 1 is expected"},
           {"schema: 1", "schema: 2\nfuture: 1", .error = ":1:9: schema is 2; 1 is expected"},
           {"    material: cotton\n", "",
            .error = ":4:5: cloths[0].material is missing; a text is expected"},
           {"h: 0.001", "h: 0.001, h: 0.002",
            .error = ":12:18: h is twice in time; each key is allowed once"},
           {"name: sheet", "[1]: sheet",
            .error = ":4:5: a key of cloths[0] is a list of 1; a text is expected"},
           {"  cotton: {", "  cotton: {}\n  cotton: {",
            .error = ":11:3: cotton is twice in materials; each key is allowed once"});
}
END_TEST

START_TEST(files_that_are_no_scenes)
{
    scene_expect_error("", NULL, ":1:1: the file is empty; a scene starts with 'schema: 1'");
    scene_expect_error("# nothing\n", NULL,
                       ":1:1: the file is empty; a scene starts with 'schema: 1'");
    scene_expect_error("---\n...\n", NULL,
                       ":2:1: the file is empty; a scene starts with 'schema: 1'");
    scene_expect_error("- 1\n", NULL,
                       ":1:1: the file is not a map; a scene starts with 'schema: 1'");
    scene_expect_error("schema: 1\n--- \nschema: 1\n", NULL,
                       ":2:1: a second document starts here; a scene file holds one");
    scene_expect_error(
        "schema: 1\ntime: {h: 1\n", NULL,
        ":3:1: not YAML: did not find expected ',' or '}', while parsing a flow mapping");
    scene_expect_error(
        "schema: 1\n\tname: a\n", NULL,
        ":2:1: not YAML: found a tab character that violates indentation, while scanning a "
        "plain scalar");
    scene_expect_error("schema: *nobody\n", NULL, ":1:9: not YAML: found undefined alias");
    scene_expect_error(
        "schema: 1\nname: \303\244\377b\n", NULL,
        ":2:8: not readable as text: invalid leading UTF-8 octet; a scene is YAML in UTF-8");
    scene_expect_error("a: &a [*a]\n", NULL,
                       ":1:4: this list is in itself, by an alias * of its anchor & in or below "
                       "line 1; an alias may stand "
                       "only behind what its anchor is of");
    scene_expect_error("schema: 1\nmaterials: &m\n  a:\n    like: *m\n", NULL,
                       ":2:12: this map is in itself, by an alias * of its anchor & in or below "
                       "line 4; an alias may stand "
                       "only behind what its anchor is of");
}
END_TEST

START_TEST(files_that_cannot_be_read)
{
    struct model model;
    struct cloth_error error = {0};
    ck_assert_int_eq(scene_read(&model, "/nowhere/x.yaml", 0, NULL, &error), CLOTH_E_INPUT);
    ck_assert_str_eq(error.text,
                     "/nowhere/x.yaml: cannot open the scene file: No such file or directory");
    model_free(&model);
    error = (struct cloth_error){0};
    ck_assert_int_eq(scene_read(&model, "/tmp", 0, NULL, &error), CLOTH_E_INPUT);
    ck_assert_str_eq(error.text, "/tmp: cannot read the scene file: Is a directory");
    model_free(&model);
    ck_assert_int_eq(scene_read(&model, "/tmp", 0, NULL, NULL), CLOTH_E_INPUT);
    model_free(&model);
}
END_TEST

START_TEST(sets_that_are_wrong)
{
    static const struct {
        const char *set, *error;
    } all[] = {
        {"time.h=-1", "time.h is -1; a finite number > 0 (s) is expected"},
        {"time.hh=1", "hh is not a key of time; did you mean 'h'? Allowed: h, ..."},
        {"time.h.x=1", "'time.h' is not a map"},
        {"cloths.x=1", "'cloths' is not a map"},
        {"time[0]=1", "'time' is not a list"},
        {"cloths[7].name=a", "'cloths' has 1 entries; an index from 0 to 1 is expected"},
        {"cloths[-1].name=a", "an index is written [0], [1], ..."},
        {"cloths[0.name=a", "an index is written [0], [1], ..."},
        {"cloths[1].name=a", "cloths[1].mesh is missing; a map of grid, disc, "
                             "file, inline, pattern, weld is expected"},
        {"cloths[0].pins[0].vertices[0]=12", "vertex 12 is outside the mesh of cloth 'sheet', "
                                             "which has 12 vertices; 0 to 11 are allowed"},
        {"cloths[0].pins[0]={vertices: [0], nearest: [0, 0, 0]}",
         "cloths[0].pins[0] has both vertices and nearest; one of vertices or nearest or box or "
         "group is "
         "expected"},
        {"solver.stop={count: 3, absolute: 1}",
         "solver.stop has 2 keys; a map with exactly one of relative, absolute, mass_norm, "
         "normalised, count is expected"},
        {"time", "KEY=VALUE is expected, such as time.h=0.002"},
        {"", "KEY=VALUE is expected, such as time.h=0.002"},
        {"=1", "KEY=VALUE is expected, such as time.h=0.002"},
        {"[0]=1", "KEY=VALUE is expected, such as time.h=0.002"},
        {".time=1", "KEY=VALUE is expected, such as time.h=0.002"},
        {"time..h=1", "KEY=VALUE is expected, such as time.h=0.002"},
        {"time.=1", "KEY=VALUE is expected, such as time.h=0.002"},
        {"time.h=", "there is no value; KEY=VALUE is expected"},
        {"time.h=[1", "the value is not YAML: did not find expected ',' or ']'"},
        {"time.h=*a", "the value is not YAML: found undefined alias"},
        {"time.h=!t 1", "time.h has the tag !t; a value without a tag is expected"},
        {"name=&a [*a]",
         "the value is in itself, by an alias * of its anchor &; an alias may stand only behind "
         "what its anchor is of"},
        {"materials=[1]", "materials is a list of 1; a non-empty map of names is expected"},
        {"cloths=[]", "cloths is an empty list; a list of 1 to 4096 maps is expected"}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        char error[300];
        snprintf(error, sizeof error, "--set %s: %s", all[i].set, all[i].error);
        scene_expect_error(scene_right, all[i].set, error);
    }
}
END_TEST

START_TEST(sets_of_other_options)
{
    struct model model;
    struct cloth_error error = {0};
    const struct scene_set sets[] = {{"time.h=1e-3", NULL}, {"grain=0", "--grain 0"}};
    ck_assert_int_eq(scene_read_text(&model, scene_right, 2, sets, &error), CLOTH_E_INPUT);
    ck_assert_str_eq(error.text,
                     "--grain 0: grain is 0; a whole number from 1 to 4294967295 is expected");
    model_free(&model);
    error = (struct cloth_error){0};
    const struct scene_set open[] = {{"time.end=[", "--end ["}};
    ck_assert_int_eq(scene_read_text(&model, scene_right, 1, open, &error), CLOTH_E_INPUT);
    ck_assert_ptr_eq(strstr(error.text, "--end [: the value is not YAML: "), error.text);
    model_free(&model);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scene errors");
    TCase *cases = tcase_create("errors");
    tcase_add_test(cases, times_out_of_range);
    tcase_add_test(cases, what_is_no_number);
    tcase_add_test(cases, decimal_commas);
    tcase_add_test(cases, wrong_kinds);
    tcase_add_test(cases, wrong_contact);
    tcase_add_test(cases, wrong_pins);
    tcase_add_test(cases, wrong_names);
    tcase_add_test(cases, unknown_and_missing_keys);
    tcase_add_test(cases, files_that_are_no_scenes);
    tcase_add_test(cases, files_that_cannot_be_read);
    tcase_add_test(cases, sets_that_are_wrong);
    tcase_add_test(cases, sets_of_other_options);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
