/* Cloths, materials, meshes, regions, starts and probes that cannot be made: each has its own
 * sentence, as in test_errors.c. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

UNIT_TEST(values_out_of_range)
{
    EXPECT(
        {"density: 0.2", "density: 0",
         .error =
             ":10:21: materials.cotton.density is 0; a finite number > 0 (kg/m^2) is expected"},
        {"stretch: 50", "stretch: -1",
         .error = ":10:35: materials.cotton.stretch is -1; a finite number >= 0 or a list of 2 "
                  "of them (N/m) is expected"},
        {"mass: 0.1", "mass: -0.1",
         .error = ":10:55: materials.cotton.damping.mass is -0.1; a finite number >= 0 (1/s) is "
                  "expected"},
        {"nx: 4", "nx: 1",
         .error =
             ":5:44: cloths[0].mesh.grid.nx is 1; a whole number from 2 to 4294967295 is expected"},
        {"height: 2, ", "",
         .error = ":5:18: mesh.grid.height is missing; a finite number > 0 (m) is expected"},
        {"nx: 4, ny: 3", "nx: 4, ny: 3, cells: equilateral",
         .error = ":5:37: mesh.grid.height is 2, but the height of 3 rows of equilateral triangles "
                  "follows of the width and nx: 0.57735 m is expected, or no height"},
        {"nx: 4, ny: 3", "nx: 4, ny: 3, cells: square",
         .error = ":5:61: cloths[0].mesh.grid.cells is square; mirrored or alternate or same or "
                  "equilateral is expected"},
        {"nx: 4, ny: 3", "nx: 65536, ny: 65536",
         .error = ":5:44: nx times ny is 4294967296; at most 2^31 vertices are possible"},
        {"schema: 1", "schema: 1\ngrain: 0",
         .error = ":2:8: grain is 0; a whole number from 1 to 4294967295 is expected"},
        {"schema: 1", "schema: 1\nsolver: {stop: {relative: 0}}",
         .error = ":2:27: solver.stop.relative is 0; a finite number > 0 and < 1 is expected"},
        {"schema: 1", "schema: 1\nsolver: {stop: {count: 0}}",
         .error = ":2:24: solver.stop.count is 0; a whole number from 1 to 4294967295 is expected"},
        {"normal: [0, 3, 4]", "normal: [0, 0, 0]",
         .error = ":11:49: the normal of a plane is zero; a direction is expected"},
        {"material: cotton", "material: cotton\n    transform: {rotate: [0, 0, 0, 0]}",
         .error = ":7:25: the quaternion [w, x, y, z] has no direction; its length must be neither "
                  "zero nor huge"},
        {"material: cotton", "material: cotton\n    transform: {scale: 0}",
         .error = ":7:24: cloths[0].transform.scale is 0; a finite number > 0 or a list of 3 of "
                  "them is expected"},
        {"material: cotton", "material: cotton\n    transform: {scale: [1, 1, -1]}",
         .error = ":7:31: cloths[0].transform.scale[2] is -1; a finite number > 0 is expected"},
        {"material: cotton", "material: cotton\n    mass_per_vertex: 0",
         .error = ":7:22: cloths[0].mass_per_vertex is 0; a finite number > 0 (kg) is expected"});
}

UNIT_TEST(triangles_out_of_range)
{
    EXPECT(
        {"stretch: 50", "stretch: [50, -1], model: triangles",
         .error = ":10:40: materials.cotton.stretch[1] is -1; a finite number >= 0 (N/m) is "
                  "expected"},
        {"stretch: 50", "stretch: [50], model: triangles",
         .error = ":10:35: materials.cotton.stretch is a list of 1; a finite number >= 0 or a list "
                  "of 2 of them (N/m) is expected"},
        {"stretch: 50", "stretch: 50, model: triangle",
         .error = ":10:46: materials.cotton.model is triangle; springs or triangles is expected"},
        {"stretch: 50", "stretch: 50, model: triangles, shear: .nan",
         .error = ":10:64: materials.cotton.shear is .nan; a finite number >= 0 (N/m) is expected"},
        {"stretch: 50", "stretch: [50, 200], model: triangles, poisson: 0.5",
         .error = ":10:73: materials.cotton.poisson is 0.5: nu12 nu21 = nu12^2 weft / warp is 1; "
                  "less than 1 is expected, here a ratio between -0.5 and 0.5"},
        {"stretch: 50", "stretch: [0, 5], model: triangles, poisson: 0.5",
         .error = ":10:70: materials.cotton.poisson is 0.5, but stretch is 0 along the warp; 0 is "
                  "expected here"},
        {"stretch: 50", "stretch: 50, strain_limit: {at: 0.1, stiffness: 0}",
         .error = ":10:74: materials.cotton.strain_limit.stiffness is 0; a finite number > 0 (N/m) "
                  "is expected"},
        {"stretch: 50", "stretch: 50, velocity_correction: {at: 0.1, tolerance: 0}",
         .error = ":10:81: materials.cotton.velocity_correction.tolerance is 0; a finite number > "
                  "0 is expected"},
        {"stretch: 50", "stretch: 50, velocity_correction: {at: -0.1}",
         .error = ":10:65: materials.cotton.velocity_correction.at is -0.1; a finite number >= 0 "
                  "is expected"},
        {"stretch: 50", "stretch: 50, velocity_correction: {rounds: 0}",
         .error = ":10:69: materials.cotton.velocity_correction.rounds is 0; a whole number from 1 "
                  "to 4294967295 is expected"},
        {"stretch: 50", "stretch: 50, bending: {rigidity: [1, .nan]}",
         .error =
             ":10:63: materials.cotton.bending.rigidity[1] is .nan; a finite number >= 0 (N m) is "
             "expected"},
        {"mesh: {grid: {width: 1, height: 2, nx: 4, ny: 3}}",
         "rest: uv\n    mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [0, 0, 1]], triangles: "
         "[[0, 1, 2]]}}",
         .error = ":5:11: rest is uv, but the mesh of cloth 'sheet' has none; a grid, an OBJ file "
                  "with vt, or rest: position is expected"});
}

UNIT_TEST(grids_larger_than_the_machine)
{
    const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (memory > 4.8e10)
        return;
    char error[200];
    snprintf(error, sizeof error,
             ":5:44: nx times ny is 324000000 vertices, which take 49 GB of memory or more; this "
             "machine has %.0f GB",
             memory / 1e9);
    scene_expect_errors(&(struct scene_wrong){"nx: 4, ny: 3", "nx: 18000, ny: 18000", NULL, error},
                        1);
}

UNIT_TEST(discs)
{
    EXPECT(
        {"grid: {width: 1, height: 2, nx: 4, ny: 3}", "disc: {radius: 1, rings: 0}",
         .error = ":5:37: cloths[0].mesh.disc.rings is 0; a whole number from 1 to 10000 is ..."},
        {"grid: {width: 1, height: 2, nx: 4, ny: 3}", "disc: {radius: 1}",
         .error = ":5:18: cloths[0].mesh.disc.rings is missing; a whole number ..."});
}

UNIT_TEST(names_and_indices)
{
    EXPECT(
        {"material: cotton", "material: coton",
         .error = ":6:15: there is no material 'coton'; did you mean 'cotton'? Allowed: cotton, "
                  "rib_knit, silk, denim, polycotton"},
        {"material: cotton", "material: polyester",
         .error = ":6:15: there is no material 'polyester'; allowed: cotton, rib_knit, "
                  "silk, denim, polycotton"},
        {"density: 0.2, ", "",
         .error = ":6:15: material 'cotton' has no density and the cloth no mass_per_vertex; one "
                  "of them is expected"},
        {"stretch: 50, ", "",
         .error =
             ":6:15: cloth 'sheet' has triangles, for which material 'cotton' has no stretch; a "
             "finite number >= 0 or a list of 2 of them (N/m) is expected"},
        {"stretch: 50, ", "stretch: 50, ea: -1, ",
         .error = ":10:43: materials.cotton.ea is -1; a finite number >= 0 (N) is expected"},
        {"density: 0.2, stretch: 50", "like: wool",
         .error = ":10:18: materials.cotton.like is wool; rib_knit or silk or denim or "
                  "polycotton is expected"},
        {"materials:\n",
         "  - {name: sheet, mesh: {grid: {width: 1, height: 1, nx: 2, ny: 2}}, material: "
         "cotton}\nmaterials:\n",
         .error = ":9:12: a second cloth is named 'sheet'; names must differ"},
        {"vertices: [0, 3]", "vertices: [0, 12]",
         .error = ":7:27: vertex 12 is outside the mesh of cloth 'sheet', which has 12 "
                  "vertices; 0 to 11 are allowed"},
        {"vertices: [11]", "vertices: [99]",
         .error = ":8:25: vertex 99 is outside the mesh of cloth 'sheet', which has 12 "
                  "vertices; 0 to 11 are allowed"},
        {"vertices: [11]", "vertices: [11, 4, 11]",
         .error = ":8:32: vertex 11 stands twice in one load; to load it twice, write another "
                  "load or a larger force"},
        {"material: cotton", "material: cotton\n    cost: {factor: 3, box: [[9, 9, 9], [8, 8, 8]]}",
         .error = ":7:5: cost is no longer a key of cloths[0]: uneven work to try balancers on is "
                  "of duite-bench ranks (migrate) and duite-compare (irregular)"},
        {"{vertices: [0, 3]}", "{box: [[9, 9, 9], [8, 8, 8]]}",
         .error = ":7:18: the box holds no vertex of cloth 'sheet'; it is meant for positions "
                  "after the transform"});
}

#define MORE(text) "material: cotton", "material: cotton\n    " text

UNIT_TEST(regions_that_cannot_be_made)
{
    EXPECT({MORE("regions: [{vertices: [0, 1], material: wool}]"),
            .error = ":7:44: there is no material 'wool'; allowed: cotton, rib_knit, silk, denim, "
                     "polycotton"},
           {MORE("regions: [{vertices: [0, 1]}]"),
            .error = ":7:15: cloths[0].regions[0].material is missing; a text is expected"},
           {MORE("regions: [{nearest: [0, 0, 0], material: cotton}]"),
            .error = ":7:16: nearest is not a key of cloths[0].regions[0]; allowed: vertices, box, "
                     "group, material"},
           {MORE("regions: [{vertices: [0, 12], material: cotton}]"),
            .error = ":7:30: vertex 12 is outside the mesh of cloth 'sheet', which has 12 "
                     "vertices; 0 to 11 are allowed"},
           {MORE("regions: [{vertices: [0, 2], material: cotton}]"),
            .error = ":7:15: no edge of cloth 'sheet' lies whole in this region; both ends of one, "
                     "at least, are expected"},
           {MORE("regions: [{vertices: [0, 1], material: silk}]"),
            .error = ":7:44: material 'silk' of a region has another model than 'cotton', that of "
                     "the cloth; the same is expected"},
           {MORE("regions: [{vertices: [0, 1], material: [1]}]"),
            .error = ":7:44: cloths[0].regions[0].material is a list of 1; a text is expected"});
}

UNIT_TEST(starts_and_masses_that_cannot_be_made)
{
    EXPECT(
        {MORE("masses: [{vertices: [1], mass: 0}]"),
         .error = ":7:36: cloths[0].masses[0].mass is 0; a finite number > 0 (kg) is expected"},
        {MORE("masses: [{vertices: [1]}]"),
         .error = ":7:14: cloths[0].masses[0].mass is missing; a finite number > 0 (kg) is "
                  "expected"},
        {MORE("masses: [{vertices: [1, 1], mass: 1}]"),
         .error = ":7:29: vertex 1 stands twice in one mass"},
        {MORE("start: [{spin: [1, 0, 0]}]"),
         .error =
             ":7:13: cloths[0].start[0] has no vertices or nearest or box or group; one of them is "
             "expected"},
        {MORE("start: [{vertices: [1, 2, 1]}]"),
         .error = ":7:31: vertex 1 stands twice in one start"},
        {MORE("start: [{vertices: [12]}]"),
         .error = ":7:25: vertex 12 is outside the mesh of cloth 'sheet', which has 12 "
                  "vertices; 0 to 11 are allowed"},
        {MORE("start: [{vertices: [1], scale: 0}]"),
         .error = ":7:36: cloths[0].start[0].scale is 0; a finite number > 0 or a list of 3 of "
                  "them is expected"},
        {MORE("start: [{vertices: [1], rotate: [0, 0, 0, 0]}]"),
         .error = ":7:37: the quaternion [w, x, y, z] has no direction; its length must be "
                  "neither zero nor huge"},
        {MORE("start: [{vertices: [1], wave: {phase: 1}}]"),
         .error = ":7:35: cloths[0].start[0].wave.vector is missing; a list of 3 numbers (1/m) is "
                  "expected"},
        {MORE("start: [{vertices: [1], spin: [0, .nan, 0]}]"),
         .error =
             ":7:39: cloths[0].start[0].spin[1] is .nan; a finite number (rad/s) is expected"});
}

#define DRAPE(text) "\ntime: {h", "\ndrape: " text "\ntime: {h"

UNIT_TEST(drape_tests_without_a_border)
{
    EXPECT({DRAPE("{}"),
            .error = ":12:8: drape.radius is missing; a finite number > 0 (m) is expected"},
           {DRAPE("{radius: 0}"),
            .error = ":12:17: drape.radius is 0; a finite number > 0 (m) is expected"},
           {DRAPE("{radius: 1}"),
            .error = ":12:17: drape.radius is 1 m, a disc of 3.14 m2; the triangles of cloth "
                     "'sheet' have 2 m2: a smaller disc is expected"},
           {DRAPE("{radius: 0.1, axis: [0, 0, 0]}"),
            .error = ":12:28: drape.axis is zero; a direction is expected"},
           {DRAPE("{radius: 0.1, cloth: shet}"),
            .error = ":12:29: there is no cloth 'shet'; did you mean 'sheet'? Allowed: sheet"});
}

#define PROBE(text) "\ntime: {h", "\nprobes: [" text "]\ntime: {h"

UNIT_TEST(probes_that_tell_nothing)
{
    EXPECT(
        {PROBE("{name: a}"),
         .error =
             ":12:10: probes[0] has no vertices or nearest or box or group or obstacle; one of "
             "them is expected"},
        {PROBE("{vertices: [0], radius: 1}"),
         .error = ":12:34: radius is given without nearest, the point that it is measured from; "
                  "both or neither are expected"},
        {PROBE("{nearest: [0, 0, 0], radius: -0.1}"),
         .error = ":12:39: probes[0].radius is -0.1; a finite number >= 0 (m) is expected"},
        {PROBE("{vertices: [0], nearest: [0, 0, 0]}"),
         .error = ":12:26: probes[0] has both vertices and nearest; one of vertices or nearest or "
                  "box or group or obstacle is expected"},
        {PROBE("{vertices: [12]}"),
         .error =
             ":12:22: vertex 12 is outside the mesh of cloth 'sheet', which has 12 vertices; 0 "
             "to 11 are allowed"},
        {PROBE("{vertices: [1, 1]}"), .error = ":12:25: vertex 1 stands twice in one probe"},
        {PROBE("{vertices: [1], name: 'a,b'}"),
         .error = ":12:32: the name of a probe is 'a,b'; at most 60 letters, digits, _ and - are "
                  "expected"},
        {PROBE("{vertices: [1], name: probe2}, {vertices: [1]}"),
         .error = ":12:41: a second probe is named 'probe2'; names must differ"},
        {PROBE("{vertices: [1], cloth: shet}"),
         .error = ":12:33: there is no cloth 'shet'; did you mean 'sheet'? Allowed: sheet"},
        {PROBE("{vertices: [1], values: [total, mass]}"),
         .error = ":12:42: probes[0].values[1] is mass; position or velocity or reaction or "
                  "contact or total or contact_total is expected"},
        {PROBE("{vertices: [1], values: [total, total]}"),
         .error = ":12:42: total stands twice in the values of a probe"},
        {PROBE("{obstacle: 5}"),
         .error = ":12:21: there is no obstacle '5'; there are 1, counted from 0, and none has a "
                  "name"},
        {PROBE("{obstacle: 0, values: [contact]}"),
         .error = ":12:32: probe 'probe1' is of an obstacle: its force on all cloth is reported, "
                  "and values means nothing"},
        {PROBE("{obstacle: 0}"),
         .error = ":12:21: probe 'probe1' reports the force of contact, which contact.mode "
                  "certified knows; here it is project, which reports none"},
        {PROBE("{vertices: [1], values: [contact_total]}"),
         .error = ":12:34: probe 'probe1' reports the force of contact, which contact.mode "
                  "certified knows; here it is project, which reports none"},
        {"end: 0.1", "end: 0.1, rest: {speed: 0}",
         .error = ":12:42: time.rest.speed is 0; a finite number > 0 (m/s) is expected"});
}

UNIT_TEST(meshes_that_cannot_be_used)
{
    struct model model;
    struct cloth_error error = {0};
    char *text =
        scene_changed(scene_right, "grid: {width: 1, height: 2, nx: 4, ny: 3}", "file: a.obj");
    ck_assert_int_eq(scene_read_text(&model, text, 0, NULL, &error), CLOTH_E_INPUT);
    ck_assert_ptr_nonnull(strstr(error.text, "scene.yaml:5:18: mesh: "));
    ck_assert_ptr_nonnull(strstr(error.text, "a.obj"));
    model_free(&model);
    error = (struct cloth_error){0};
    scene_write_file("a.obj", "v 0 0 0\nv nan 0 0\n", 18);
    ck_assert_int_eq(scene_read(&model, scene_path(), 0, NULL, &error), CLOTH_E_INPUT);
    ck_assert_ptr_nonnull(strstr(error.text, "scene.yaml:5:18: mesh: "));
    ck_assert_ptr_nonnull(strstr(error.text, "a.obj:2"));
    model_free(&model);
    free(text);
    text = scene_changed(scene_right, "grid: {width: 1, height: 2, nx: 4, ny: 3}",
                         "inline: {vertices: [[0, 0, 0]], edges: [[0, 7]]}");
    error = (struct cloth_error){0};
    ck_assert_int_eq(scene_read_text(&model, text, 0, NULL, &error), CLOTH_E_INPUT);
    ck_assert_ptr_nonnull(strstr(error.text, "scene.yaml:5:20: mesh: "));
    model_free(&model);
    free(text);
}
