/* A scene's values arrive in the model: every key, every default, aliases. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The scene's path and what follows it. */
static void same_place(const char *place, const char *after)
{
    const size_t path = strlen(scene_path());
    ck_assert_ptr_nonnull(place);
    ck_assert(strncmp(place, scene_path(), path) == 0);
    ck_assert_str_eq(place + path, after);
}

static void same_vector(const double *a, double x, double y, double z)
{
    ck_assert_double_eq(a[0], x);
    ck_assert_double_eq(a[1], y);
    ck_assert_double_eq(a[2], z);
}

UNIT_TEST(world_and_time)
{
    UNIT_OWNED(model_free) struct model model = scene_read_right(scene_right, 0, NULL);
    ck_assert_str_eq(model.name, "scene");
    same_vector(model.gravity, 0, -9.81, 0);
    ck_assert_double_eq(model.h, 0.001);
    ck_assert_double_eq(model.end, 0.1);
    ck_assert_double_eq(model.fps, 25);
    ck_assert_int_eq(model.integrator, MODEL_IMPLICIT_EULER);
    ck_assert_int_eq(model.energy_steps, 0);
    ck_assert_uint_eq(model.newton_steps, 1);
    ck_assert_double_eq(model.newton_tolerance, 1e-4);
    ck_assert_int_eq(model.stop, MODEL_STOP_MASS_NORM);
    ck_assert_double_eq(model.tolerance, 0.01);
    ck_assert_int_eq(model.preconditioner, MODEL_IC0_COARSE);
    ck_assert_uint_eq(model.max_iterations, 10000);
    ck_assert_uint_eq(model.grain, 1000);
    ck_assert_uint_eq(model.n_obstacles, 1);
    same_vector(model.obstacles[0].value, 0, -1, 0);
    same_vector(model.obstacles[0].value + 3, 0, 3. / 4 / 1.25, 1 / 1.25);
}

UNIT_TEST(usual_grain)
{
    ck_assert_uint_eq(model_usual_grain(1), 1000);
    ck_assert_uint_eq(model_usual_grain(160000), 2500);
    ck_assert_uint_eq(model_usual_grain(1000000), 4000);
}

UNIT_TEST(cloth_and_material)
{
    UNIT_OWNED(model_free) struct model model = scene_read_right(scene_right, 0, NULL);
    ck_assert_uint_eq(model.n_cloths, 1);
    const struct model_cloth *cloth = &model.cloths[0];
    ck_assert_str_eq(cloth->name, "sheet");
    ck_assert_uint_eq(cloth->mesh.n_vertices, 12);
    ck_assert_uint_eq(cloth->mesh.grid_nx, 4);
    ck_assert_uint_eq(cloth->mesh.grid_ny, 3);
    same_vector(cloth->mesh.position, -0.5, 0, -1);
    ck_assert_double_eq(cloth->mass_per_vertex, 0);
    same_vector(cloth->velocity, 0, 0, 0);
    ck_assert_uint_eq(cloth->n_pins, 1);
    ck_assert_int_eq(cloth->pins[0].pick.kind, MODEL_PICK_VERTICES);
    ck_assert_uint_eq(cloth->pins[0].pick.n_vertices, 2);
    ck_assert_uint_eq(cloth->pins[0].pick.vertices[1], 3);
    same_place(cloth->pins[0].pick.place, ":7:12");
    ck_assert_uint_eq(cloth->n_loads, 1);
    ck_assert_uint_eq(cloth->loads[0].pick.vertices[0], 11);
    same_vector(cloth->loads[0].force, 0, 1, 0);
    same_place(cloth->loads[0].pick.place, ":8:13");
    same_place(cloth->place, ":4:5");
    same_place(cloth->mesh_place, ":5:18");
    same_place(cloth->velocity_place, ""); /* a default */
    const struct model_material *material = &model.materials[cloth->material];
    ck_assert_str_eq(material->name, "cotton");
    ck_assert_double_eq(material->density, 0.2);
    ck_assert_double_eq(material->stretch, 50);
    ck_assert_double_eq(material->shear, 0);
    ck_assert_double_eq(material->bend, 0);
    ck_assert_double_eq(material->damping_viscous, 0);
    ck_assert_double_eq(material->damping_mass, 0.1);
    ck_assert_double_eq(material->damping_stiffness, 0);
    ck_assert_int_eq(material->both_diagonals, 1);
}

/* A density is wanted only where it is needed. */
UNIT_TEST(mass_without_density)
{
    static const char *const sets[] = {"materials={cotton: {stretch: 50}}",
                                       "cloths[0].mass_per_vertex=0.1"};
    UNIT_OWNED(model_free) struct model model = scene_read_right(scene_right, 2, sets);
    ck_assert_double_eq(model.materials[0].density, 0);
}

UNIT_TEST(every_other_key)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed(
        "  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n",
        "  silk: &silk {density: 1, stretch: 2, shear: 3, bend: 4, diagonals: one,\n"
        "               damping: {viscous: 5, mass: 6, stiffness: 7}}\n"
        "  cotton: *silk\n"
        "name: more\ngrain: 7\nintegrator: explicit_euler\n"
        "contact: {mode: project, self: on, thickness: 0.002, friction: 0.25}\n"
        "energies: steps\nnewton: {steps: 5, tolerance: 1e-7}\n"
        "solver: {stop: {absolute: 1e-9}, max_iterations: 12}\n");
    ck_assert_str_eq(model.name, "more");
    ck_assert_uint_eq(model.grain, 7);
    ck_assert_int_eq(model.integrator, MODEL_EXPLICIT_EULER);
    ck_assert_int_eq(model.contact.mode, MODEL_CONTACT_PROJECT);
    ck_assert(model.contact.self);
    ck_assert_double_eq(model.contact.thickness, 0.002);
    ck_assert_double_eq(model.contact.friction, 0.25);
    ck_assert_int_eq(model.energy_steps, 1);
    ck_assert_uint_eq(model.newton_steps, 5);
    ck_assert_double_eq(model.newton_tolerance, 1e-7);
    ck_assert_int_eq(model.stop, MODEL_STOP_ABSOLUTE);
    ck_assert_double_eq(model.tolerance, 1e-9);
    ck_assert_uint_eq(model.max_iterations, 12);
    ck_assert_uint_eq(model.n_materials, 2);
    ck_assert_uint_eq(model.cloths[0].material, 1);
    for (int i = 0; i < 2; i++) {
        const struct model_material *material = &model.materials[i];
        ck_assert_double_eq(material->shear, 3);
        ck_assert_double_eq(material->bend, 4);
        ck_assert_double_eq(material->damping_viscous, 5);
        ck_assert_double_eq(material->damping_mass, 6);
        ck_assert_double_eq(material->damping_stiffness, 7);
        ck_assert_int_eq(material->both_diagonals, 0);
    }
}

UNIT_TEST(slopes)
{
    static const char *const words[] = {"definite", "full", "absolute"};
    static const int kind[] = {PHYS_DEFINITE, PHYS_FULL, PHYS_ABSOLUTE};
    for (int i = 0; i < 3; i++) {
        char set[60];
        snprintf(set, sizeof set, "solver.jacobian=%s", words[i]);
        UNIT_OWNED(model_free) struct model model = scene_read_set(set);
        ck_assert_int_eq(model.full_slope, kind[i]);
    }
}

UNIT_TEST(triangles_and_bending)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed(
        "  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n",
        "  cotton: {density: 1, model: triangles, stretch: [30, 20], shear: 3, poisson: -0.5,\n"
        "           forces: uncorrected, bending: {model: quadratic, rigidity: [5, 6]},\n"
        "           strain_limit: {at: 0.1, stiffness: 7}}\n"
        "solver: {jacobian: full}\n");
    const struct model_material *m = model.materials;
    ck_assert_int_eq(model.format, SOLVE_HALF);
    ck_assert_int_eq(model.full_slope, PHYS_FULL);
    ck_assert_int_eq(m->model, MODEL_TRIANGLES);
    ck_assert_double_eq(m->stretch, 30);
    ck_assert_double_eq(model_weft(m), 20);
    ck_assert_double_eq(m->poisson, -0.5);
    ck_assert(m->uncorrected);
    ck_assert_int_eq(m->bending, MODEL_QUADRATIC);
    ck_assert_double_eq(m->rigidity[0], 5);
    ck_assert_double_eq(m->rigidity[1], 6);
    ck_assert_double_eq(m->limit_strain, 0.1);
    ck_assert_double_eq(m->limit_stiffness, 7);
    model_free(&model);
    model = scene_read_changed("stretch: 50", "stretch: 50, velocity_correction: {}");
    ck_assert_double_eq(model.materials->correction.at, 0.1);
    ck_assert_double_eq(model.materials->correction.tolerance, 0.01);
    ck_assert_uint_eq(model.materials->correction.rounds, 100);
    ck_assert_uint_eq(model.correction_rounds, 100);
    model_free(&model);
    model = scene_read_changed("stretch: 50", "stretch: 50, strain_limit: {at: 0, stiffness: 7}");
    ck_assert_int_eq(model.format, SOLVE_HALF);
    model_free(&model);
    model = scene_read_changed("material: cotton", "rest: uv\n    material: cotton\n"
                                                   "    transform: {scale: 3}");
    ck_assert_int_eq(model.format, SOLVE_SPRINGS);
    ck_assert_double_eq(model_rest(model.cloths)->position[3 * 11], 1);
    ck_assert_double_eq(model_rest(model.cloths)->position[3 * 11 + 1], 2);
    ck_assert_double_eq(model.cloths[0].mesh.position[3 * 11], 1.5);
}

UNIT_TEST(cloths_of_every_mesh)
{
    const char *triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    char *text = scene_changed(
        scene_right, "materials:\n",
        "  - {mesh: {file: a.obj}, material: cotton, mass_per_vertex: 0.5, velocity: [1, 2, 3]}\n"
        "  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}\n"
        "    material: wire\n"
        "    transform: {scale: [1, 2, 3], rotate: [0, 0, 2, 0], translate: [0, 0, 5]}\n"
        "    pins: [{nearest: [0, 0, 4]}, {box: [[1, 1, 9], [-2, 0, 0]]}]\n"
        "  - {mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [0, 0, 1]], triangles: [[2, 1, "
        "0]]}},\n"
        "     material: cotton, transform: {scale: 2}}\n"
        "  - {mesh: {disc: {radius: 0.5, rings: 2}}, material: cotton}\n"
        "materials:\n  wire: {density: 1, ea: 7}\n");
    scene_write_file("a.obj", triangle, strlen(triangle));
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    ck_assert_uint_eq(model.n_cloths, 5);
    ck_assert_str_eq(model.cloths[1].name, "cloth2");
    ck_assert_uint_eq(model.cloths[1].mesh.n_triangles, 1);
    ck_assert_double_eq(model.cloths[1].mass_per_vertex, 0.5);
    same_vector(model.cloths[1].velocity, 1, 2, 3);
    const struct model_cloth *chain = &model.cloths[2];
    ck_assert_uint_eq(chain->mesh.n_lone_edges, 1);
    ck_assert_double_eq(model.materials[chain->material].ea, 7);
    same_vector(chain->mesh.position + 3, -1, 0, 5); /* turned by half a circle about y */
    ck_assert_int_eq(chain->pins[0].pick.kind, MODEL_PICK_NEAREST);
    same_vector(chain->pins[0].pick.point, 0, 0, 4);
    ck_assert_int_eq(chain->pins[1].pick.kind, MODEL_PICK_BOX);
    same_vector(chain->pins[1].pick.box[0], -2, 0, 0);
    same_vector(chain->pins[1].pick.box[1], 1, 1, 9);
    ck_assert_uint_eq(model.cloths[3].mesh.triangle[0], 2);
    same_vector(model.cloths[3].mesh.position + 6, 0, 0, 2);
    ck_assert_uint_eq(model.cloths[4].mesh.n_vertices, 19);
    same_vector(model.cloths[4].mesh.position + 21, 0.5, 0, 0);
    free(text);
}

/* A figure of 1.8 m that stands along z, in centimetres. */
UNIT_TEST(files_of_other_units_and_axes)
{
    const char *triangle = "v 0 0 0\nv 50 0 0\nv 0 20 180\nf 1 2 3\n";
    char *text = scene_changed(
        scene_right, "materials:\n",
        "  - {mesh: {file: tall.obj}, material: cotton, transform: {units: cm, up: z}}\n"
        "  - {mesh: {file: tall.obj}, material: cotton, transform: {units: mm, scale: [1, 2, 3], "
        "up: z, rotate: {axis: [0, 1, 0], degrees: 90}, translate: [1, 0, 0]}}\n"
        "materials:\n");
    scene_write_file("tall.obj", triangle, strlen(triangle));
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    const double right[2][2][3] = {{{0.5, 0, 0}, {0, 1.8, -0.2}}, {{1, 0, -0.05}, {0.96, 0.54, 0}}};
    for (int c = 0; c < 2; c++)
        for (int v = 0; v < 2; v++)
            for (int i = 0; i < 3; i++)
                ck_assert_double_eq_tol(model.cloths[1 + c].mesh.position[3 * (v + 1) + i],
                                        right[c][v][i], 1e-15);
    free(text);
}

/* A part of the way through 2.5 turns in 3 s, and 1 m aside meanwhile. */
static void turned_round(const struct model *model, const struct model_motion *motion, double time)
{
    const double angle = 2 * M_PI * 2.5 * time / 3, about[3] = {0};
    struct phys_pose pose;
    phys_pose_at(motion->n, model->keys + motion->first, about, time, &pose);
    ck_assert_double_eq_tol(pose.turn[0][0], cos(angle), 1e-4);
    ck_assert_double_eq_tol(pose.turn[0][2], sin(angle), 1e-4);
    ck_assert_double_eq_tol(pose.translate[0], time / 3, 1e-14);
}

UNIT_TEST(rotations_by_axis_and_angle)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed(
        "pins: [{vertices: [0, 3]}]",
        "start: [{vertices: [1], rotate: {axis: [0, 0, -3], degrees: 60}}, "
        "{vertices: [2], rotate: {axis: [0, 1, 0], turns: 4.5}}]\n"
        "    pins: [{vertices: [0], motion: {times: [0, 3], translate: [[0, 0, 0], [1, 0, 0]], "
        "rotate: [{axis: [0, 2, 0], turns: 0}, {axis: [0, 2, 0], degrees: 900}]}},\n"
        "           {vertices: [5], motion: {times: [0, 3], rotate: [[1, 0, 0, 0], "
        "{axis: [0, 1, 0], degrees: 170}]}}]");
    const struct model_start *starts = model.cloths[0].starts;
    ck_assert_double_eq_tol(starts[0].transform.rotate[0], cos(M_PI / 6), 1e-15);
    ck_assert_double_eq_tol(starts[0].transform.rotate[3], -0.5, 1e-15);
    ck_assert_double_eq_tol(fabs(starts[1].transform.rotate[2]), 1, 1e-15);
    ck_assert_uint_eq(model.n_motions, 2);
    for (int i = 0; i <= 30; i++)
        turned_round(&model, model.motions, i / 10.0);
    ck_assert_uint_eq(model.motions[1].n, 2);
}

UNIT_TEST(starts_and_masses)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed(
        "material: cotton",
        "material: cotton\n    masses: [{vertices: [3, 5], mass: 0.25}]\n"
        "    start: [{nearest: [0, 0, 9], radius: 0.5}, {box: [[1, 1, 1], [-1, -1, "
        "-1]], scale: 2,\n"
        "             rotate: [0, 2, 0, 0], translate: [1, 2, 3], about: [4, 5, 6],\n"
        "             velocity: [0, 0, 0], spin: [7, 8, 9],\n"
        "             wave: {vector: [1, 2, 3], phase: 0.5, velocity: [4, 5, 6]}}]");
    const struct model_cloth *cloth = model.cloths;
    ck_assert_uint_eq(cloth->n_masses, 1);
    ck_assert_double_eq(cloth->masses[0].mass, 0.25);
    ck_assert_uint_eq(cloth->masses[0].pick.vertices[1], 5);
    ck_assert_uint_eq(cloth->n_starts, 2);
    const struct model_start *plain = cloth->starts, *full = cloth->starts + 1;
    ck_assert_int_eq(plain->pick.kind, MODEL_PICK_NEAREST);
    ck_assert_double_eq(plain->pick.radius, 0.5);
    ck_assert_double_eq(full->pick.radius, 0);
    same_place(plain->pick.place, ":8:13");
    ck_assert(!plain->has_velocity && full->has_velocity);
    same_vector(plain->transform.scale, 1, 1, 1);
    same_vector(plain->spin, 0, 0, 0);
    same_vector(full->transform.scale, 2, 2, 2);
    ck_assert_double_eq(full->transform.rotate[1], 2);
    same_vector(full->transform.translate, 1, 2, 3);
    same_vector(full->about, 4, 5, 6);
    same_vector(full->spin, 7, 8, 9);
    same_vector(full->wave.vector, 1, 2, 3);
    ck_assert_double_eq(full->wave.phase, 0.5);
    same_vector(full->wave.translate, 0, 0, 0);
    same_vector(full->wave.velocity, 4, 5, 6);
}

UNIT_TEST(probes_and_rest)
{
    UNIT_OWNED(model_free) struct model model;
    char *text = scene_changed(
        scene_right, "\ntime: {h: 0.001, end: 0.1",
        "\nprobes: [{vertices: [3, 1]}, {box: [[-9, -9, -9], [9, 9, 9]], name: all-1, cloth: "
        "sheet, values: [total, velocity]}]\ntime: {h: 0.001, end: 0.1, rest: {hold: 0}");
    UNIT_FINE(scene_read_text(&model, text, 0, NULL, &error));
    ck_assert_double_eq(model.rest.speed, 0.001);
    ck_assert_double_eq(model.rest.hold, 0);
    ck_assert_uint_eq(model.n_probes, 2);
    const struct model_probe *probe = model.probes;
    ck_assert_str_eq(probe[0].name, "probe1");
    ck_assert(probe[0].position && probe[0].velocity && probe[0].reaction && !probe[0].total);
    ck_assert_int_eq(probe[0].pick.kind, MODEL_PICK_VERTICES);
    ck_assert_uint_eq(probe[0].pick.vertices[0], 3);
    ck_assert_str_eq(probe[1].name, "all-1");
    ck_assert(!probe[1].position && probe[1].velocity && !probe[1].reaction && probe[1].total);
    ck_assert_int_eq(probe[1].pick.kind, MODEL_PICK_BOX);
    free(text);
}

UNIT_TEST(drape_test)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed("\ntime: {h", "\ndrape: {radius: 0.5}\ntime: {h");
    ck_assert_double_eq(model.drape.radius, 0.5);
    ck_assert_double_eq_tol(model_disc(&model.drape), acos(-1) / 4, 1e-15);
    ck_assert_double_eq_tol(model_area(model.cloths), 2, 1e-15);
    same_vector(model.drape.axis, 0, 1, 0);
    model_free(&model);
    model = scene_read_changed("\ntime: {h",
                               "\ndrape: {radius: 0.5, axis: [3, 0, 4], cloth: sheet}\ntime: {h");
    ck_assert_uint_eq(model.drape.cloth, 0);
    ck_assert_double_eq_tol(model.drape.axis[0], 0.6, 1e-15);
    model_free(&model);
    model = scene_read_right(scene_right, 0, NULL);
    ck_assert_double_eq(model.drape.radius, 0);
}

UNIT_TEST(numbers_of_every_form)
{
    static const struct {
        const char *text;
        double value;
    } forms[] = {{"3", 3},  {"+3", 3},      {"-3", -3},    {".5", 0.5},    {"-.5e1", -5},
                 {"1.", 1}, {"1e-3", 1e-3}, {"1E+3", 1e3}, {"2.5e2", 250}, {"0", 0}};
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        char set[64];
        snprintf(set, sizeof set, "gravity[0]=%s", forms[i].text);
        UNIT_OWNED(model_free) struct model model = scene_read_set(set);
        ck_assert_double_eq(model.gravity[0], forms[i].value);
    }
}

UNIT_TEST(shared_empty_map_takes_defaults)
{
    char *text = scene_changed(scene_right, "    material: cotton",
                               "    transform: &e {}\n    material: cotton");
    char *more = scene_changed(text, "damping: {mass: 0.1}", "damping: *e");
    UNIT_OWNED(model_free) struct model model = scene_read_right(more, 0, NULL);
    ck_assert_double_eq(model.materials[0].damping_mass, 0);
    ck_assert_double_eq(model.cloths[0].mesh.position[0], -0.5);
    free(text);
    free(more);
}
