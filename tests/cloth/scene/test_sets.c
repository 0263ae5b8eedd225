/* A --set arrives in the model: it changes values, makes absent ones, appends to lists, and leaves
 * other uses of an alias alone. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

UNIT_TEST(sets_change_values)
{
    UNIT_OWNED(model_free) struct model model = scene_read_set("time.h=0.002");
    ck_assert_double_eq(model.h, 0.002);
    model_free(&model);
    model = scene_read_set("cloths[0].mesh.grid.nx=40");
    ck_assert_uint_eq(model.cloths[0].mesh.n_vertices, 120);
    model_free(&model);
    model = scene_read_set("obstacles[0].plane={point: [0, 0, 0], normal: [1, 0, 0]}");
    ck_assert_double_eq(model.obstacles[0].value[3], 1);
    ck_assert_double_eq(model.obstacles[0].value[4], 0);
    model_free(&model);
    static const char *const kinds[] = {"none", "jacobi", "ic0", "coarse", "ic0_coarse"};
    for (int i = 0; i < 5; i++) {
        char set[64];
        snprintf(set, sizeof set, "solver.preconditioner=%s", kinds[i]);
        model = scene_read_set(set);
        ck_assert_int_eq(model.preconditioner, (enum model_preconditioner)i);
        model_free(&model);
    }
    model = scene_read_set("solver.stop={relative: 0.25}");
    ck_assert_int_eq(model.stop, MODEL_STOP_RELATIVE);
    ck_assert_double_eq(model.tolerance, 0.25);
    model_free(&model);
    model = scene_read_set("solver.stop={normalised: 1e-4}");
    ck_assert_int_eq(model.stop, MODEL_STOP_NORMALISED);
    ck_assert_double_eq(model.tolerance, 1e-4);
    ck_assert_int_eq(model.guess, MODEL_GUESS_AUTO);
    model_free(&model);
    model = scene_read_set("solver.guess=previous");
    ck_assert_int_eq(model.guess, MODEL_GUESS_PREVIOUS);
    model_free(&model);
    model = scene_read_set("solver.guess=zero");
    ck_assert_int_eq(model.guess, MODEL_GUESS_ZERO);
    model_free(&model);
    model = scene_read_set("solver.stop={count: 10}");
    ck_assert_int_eq(model.stop, MODEL_STOP_COUNT);
    ck_assert_uint_eq(model.max_iterations, 10);
    model_free(&model);
    model = scene_read_set("name=a=b");
    ck_assert_str_eq(model.name, "a=b");
}

UNIT_TEST(sets_find_entries_by_name)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_set("cloths.sheet.mesh.grid.nx=40");
    ck_assert_uint_eq(model.cloths[0].mesh.n_vertices, 120);
    model_free(&model);
    char *text = scene_changed(scene_right, "plane: {", "plane: {name: floor, friction: 1, ");
    const char *const sets[] = {"obstacles.floor.friction=2", "obstacles.floor.name=sea",
                                "obstacles.sea.point=[0, -2, 0]"};
    model = scene_read_right(text, 3, sets);
    ck_assert_double_eq(model.obstacles[0].friction, 2);
    ck_assert_double_eq(model.obstacles[0].value[1], -2);
    free(text);
    model_free(&model);
    const char *const phase[] = {"phases=[{name: one, set: {}}]", "phases.one.set.time.h=0.002"};
    model = scene_read_right(scene_right, 2, phase);
    ck_assert_double_eq(model.h, 0.002);
}

/* The file that includes decides over the included one, sets over both; a choice replaces a choice,
 * and files are looked for beside the scene that names them. */
UNIT_TEST(scenes_include_scenes)
{
    const char *middle = "schema: 1\ninclude: base.yaml\ntime.h: 0.004\ntime.end: 0.2\n"
                         "cloths.sheet.mesh.file: square.obj\n";
    const char *square = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 4 3 2 1\n";
    scene_write_file("below/base.yaml", scene_right, strlen(scene_right));
    scene_write_file("below/middle.yaml", middle, strlen(middle));
    scene_write_file("below/square.obj", square, strlen(square));
    const char *const sets[] = {"time.end=0.3"};
    UNIT_OWNED(model_free)
    struct model model =
        scene_read_right("include: below/middle.yaml\nschema: 1\ntime.h: 0.002\n"
                         "time.end: 0.4\nmaterials.cotton.stretch: 7\ncloths.sheet.loads: []\n"
                         "cloths[1]: {mesh: {grid: {width: 1, height: 1, nx: 2, "
                         "ny: 2}}, material: cotton}\n",
                         1, sets);
    ck_assert_double_eq(model.h, 0.002);
    ck_assert_double_eq(model.end, 0.3);
    ck_assert_double_eq(model.materials[0].stretch, 7);
    ck_assert_double_eq(model.materials[0].damping_mass, 0.1);
    ck_assert_uint_eq(model.n_cloths, 2);
    ck_assert_uint_eq(model.cloths[0].mesh.n_vertices, 4);
    ck_assert_str_eq(model.name, "scene");
    ck_assert_uint_eq(model.n_files, 4);
}

UNIT_TEST(sets_make_and_append)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_set("materials.cotton.damping.viscous=2");
    ck_assert_double_eq(model.materials[0].damping_viscous, 2);
    ck_assert_double_eq(model.materials[0].damping_mass, 0.1);
    model_free(&model);
    model = scene_read_set("solver.stop.absolute=0.5"); /* neither solver nor stop is in the file */
    ck_assert_int_eq(model.stop, MODEL_STOP_ABSOLUTE);
    model_free(&model);
    model = scene_read_set("cloths[0].pins[1].nearest=[0, 0, 0]");
    ck_assert_uint_eq(model.cloths[0].n_pins, 2);
    ck_assert_str_eq(model.cloths[0].pins[1].pick.place,
                     "--set cloths[0].pins[1].nearest=[0, 0, 0]");
    model_free(&model);
    model = scene_read_set("cloths[0].pins[0].vertices[2]=5");
    ck_assert_uint_eq(model.cloths[0].pins[0].pick.n_vertices, 3);
    ck_assert_uint_eq(model.cloths[0].pins[0].pick.vertices[2], 5);
    model_free(&model);
    model = scene_read_right(scene_right, 3,
                             (const char *const[]){"materials.wool={density: 1, stretch: 1}",
                                                   "cloths[0].material=wool",
                                                   "materials.wool.density=3"});
    ck_assert_double_eq(model.materials[model.cloths[0].material].density, 3);
}

/* The last one of those that exclude each other; what an alias shares has its own. */
UNIT_TEST(a_choice_replaces_a_choice)
{
    char *text = scene_changed(scene_right, "time:", "solver: {stop: {relative: 0.1}}\ntime:");
    static const char *const sets[] = {"solver.stop.mass_norm=0.2", "solver.stop.absolute=0.3",
                                       "solver.stop.relative=0.4"};
    static const enum model_stop stop[] = {MODEL_STOP_MASS_NORM, MODEL_STOP_ABSOLUTE,
                                           MODEL_STOP_RELATIVE};
    static const double tolerance[] = {0.2, 0.3, 0.4};
    for (size_t n = 1; n <= 3; n++) {
        UNIT_OWNED(model_free) struct model model = scene_read_right(text, n, sets);
        ck_assert_int_eq(model.stop, stop[n - 1]);
        ck_assert_double_eq(model.tolerance, tolerance[n - 1]);
    }
    free(text);
    text = scene_changed(scene_right, "[{vertices: [0, 3]}]",
                         "[&p {vertices: [0, 3], motion: {times: [0]}}, *p]");
    UNIT_OWNED(model_free)
    struct model model =
        scene_read_right(text, 1, (const char *const[]){"cloths[0].pins[1].nearest=[1, 2, 3]"});
    ck_assert_int_eq(model.cloths[0].pins[0].pick.kind, MODEL_PICK_VERTICES);
    ck_assert_int_eq(model.cloths[0].pins[1].pick.kind, MODEL_PICK_NEAREST);
    ck_assert_ptr_null(model.cloths[0].pins[1].pick.vertices);
    ck_assert_double_eq(model.cloths[0].pins[1].pick.point[2], 3);
    ck_assert_uint_eq(model.n_motions, 2);
    free(text);
}

/* Also one inside what the file or an earlier set has. */
UNIT_TEST(the_last_choice_is_inside)
{
    char *text = scene_changed(scene_right, "plane: {point: [0, -1, 0], normal: [0, 3, 4]}",
                               "sphere: {centre: [0, -1, 0], radius: 0.5}");
    static const char *const sets[] = {"obstacles[0].box={centre: [0, 0, 0], size: [1, 1, 1]}",
                                       "obstacles[0].sphere.radius=0.1",
                                       "obstacles[0].box.size[1]=2"};
    static const char *const kind[] = {"box", "sphere", "box"};
    for (size_t n = 1; n <= 3; n++) {
        UNIT_OWNED(model_free) struct model model = scene_read_right(text, n, sets);
        ck_assert_str_eq(contact_kinds[model.obstacles[0].kind]->name, kind[n - 1]);
        ck_assert_double_eq(model.obstacles[0].value[4], n == 2 ? 0 : n == 3 ? 2 : 1);
    }
    free(text);
}

UNIT_TEST(sets_leave_aliases_alone)
{
    char *text =
        scene_changed(scene_right, "  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}",
                      "  cotton: &c {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n"
                      "  other: *c");
    static const char *const sets[] = {"materials.other.damping.mass=9",
                                       "materials.cotton.stretch=1"};
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 2, sets);
    ck_assert_double_eq(model.materials[0].damping_mass, 0.1);
    ck_assert_double_eq(model.materials[0].stretch, 1);
    ck_assert_double_eq(model.materials[1].damping_mass, 9);
    ck_assert_double_eq(model.materials[1].stretch, 50);
    free(text);
}
