/* A scene's obstacles and contact arrive in the model. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

static void same_vector(const double *a, double x, double y, double z)
{
    ck_assert_double_eq(a[0], x);
    ck_assert_double_eq(a[1], y);
    ck_assert_double_eq(a[2], z);
}

/* Parameters in the order of their kind, directions and rotations made of length 1; keys of
 * obstacles come before those of pins. */
UNIT_TEST(obstacles)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_set(
        "obstacles=[{box: {centre: [1, 2, 3], size: [4, 5, 6], rotate: [3, 0, 4, 0]}}, {sphere: "
        "{radius: 7, motion: {times: [1, 2], translate: [[1, 0, 0], [0, 0, 8]], about: [0, 9, 0]}, "
        "centre: [1, 0, 0]}}]");
    ck_assert_uint_eq(model.n_obstacles, 2);
    const struct contact_shape *box = model.obstacles, *ball = model.obstacles + 1;
    ck_assert_str_eq(contact_kinds[box->kind]->name, "box");
    ck_assert_str_eq(contact_kinds[ball->kind]->name, "sphere");
    same_vector(box->value, 1, 2, 3);
    same_vector(box->value + 3, 4, 5, 6);
    ck_assert_double_eq_tol(box->value[6], 0.6, 1e-15);
    same_vector(box->value + 7, 0, box->value[8], 0);
    ck_assert_double_eq_tol(box->value[8], 0.8, 1e-15);
    ck_assert_uint_eq(box->n, 0);
    same_vector(ball->value, 1, 0, 0);
    ck_assert_double_eq(ball->value[3], 7);
    same_vector(ball->about, 0, 9, 0);
    ck_assert_uint_eq(ball->n, 2);
    ck_assert_double_eq(model.keys[ball->first + 1].time, 2);
    same_vector(model.keys[ball->first + 1].translate, 0, 0, 8);
    ck_assert(model_obstacles_move(&model) && !model_is_driven(&model));
    ck_assert(model_moves_after(&model, 1.5) && !model_moves_after(&model, 2));
}

/* Key frames that are all the same move nothing, so that the energy is guarded. */
UNIT_TEST(still_motions)
{
    static const char *const sets[] = {
        "obstacles[0].plane.motion={times: [0, 2], translate: [[0, 1, 0], [0, 1, 0]]}",
        "obstacles[0].plane.motion={times: [0, 2], translate: [[0, 1, 0], [0, 1, 1]]}",
        "obstacles[0].plane.motion={times: [0, 2], rotate: [[1, 0, 0, 0], [1, 0, 0, 0]]}",
        "obstacles[0].plane.motion={times: [0, 2], rotate: [[1, 0, 0, 0], [1, 0, 1, 0]]}"};
    for (int i = 0; i < 4; i++) {
        UNIT_OWNED(model_free) struct model model = scene_read_set(sets[i]);
        ck_assert_int_eq(model_obstacles_move(&model), i % 2);
        ck_assert_int_eq(model_moves_after(&model, 1), i % 2);
        ck_assert_int_eq(model_is_guarded(&model), 1 - i % 2);
    }
    UNIT_OWNED(model_free)
    struct model model = scene_read_set(
        "cloths[0].pins[0].motion={times: [0, 1, 2], translate: [[0, 0, 0], [0, 1, 0], [0, 1, "
        "0]]}");
    ck_assert(model_moves_after(&model, 0.5) && !model_moves_after(&model, 1));
}

#define SECOND "cloths[1]={mesh: {grid: {width: 1, height: 1, nx: 3, ny: 3}}, material: cotton}"
#define CHAIN                                                                                      \
    "cloths[1]={mesh: {inline: {vertices: [[9, 0, 0], [9, 1, 0]], edges: [[0, 1]]}}, material: "   \
    "wire, mass_per_vertex: 1}"
#define BALL "obstacles[1]={sphere: {centre: [0, 9, 0], radius: 1}}"

/* The mode of contact where the scene does not say it: a plane alone is projected onto. */
static const struct {
    const char *set[3];
    enum model_contact_mode mode;
} modes[] = {
    {{"obstacles=[]"}, MODEL_CONTACT_PROJECT},
    {{"time.fps=25"}, MODEL_CONTACT_PROJECT}, /* one cloth and a plane */
    {{BALL}, MODEL_CONTACT_CERTIFIED},
    {{BALL, "integrator=bdf2"}, MODEL_CONTACT_CERTIFIED},
    {{BALL, "integrator=verlet"}, MODEL_CONTACT_PROJECT},
    {{"contact.self=on"}, MODEL_CONTACT_CERTIFIED},
    {{SECOND}, MODEL_CONTACT_CERTIFIED},
    {{CHAIN, "materials.wire={ea: 1}"}, MODEL_CONTACT_PROJECT},
    {{CHAIN, "materials.wire={ea: 1}", BALL}, MODEL_CONTACT_PROJECT},
    {{CHAIN, "materials.wire={ea: 1}", "contact.self=on"}, MODEL_CONTACT_PROJECT},
};

UNIT_LOOP(contact_modes, 0, sizeof modes / sizeof *modes)
{
    const char *sets[4] = {"contact.thickness=0.01"};
    size_t n = 1;
    for (; n < 4 && modes[_i].set[n - 1]; n++)
        sets[n] = modes[_i].set[n - 1];
    UNIT_OWNED(model_free) struct model model = scene_read_right(scene_right, n, sets);
    ck_assert(model.contact.assumed);
    ck_assert_int_eq((int)model.contact.mode, (int)modes[_i].mode);
    unit_says(model_contact_cure(&model), "mode: project");
    model_free(&model);
    model = scene_read_set("contact.mode=certified");
    ck_assert(!model.contact.assumed && !model_contact_cure(&model)[0]);
}

/* Steps look for contact where something can touch, or where it is reported. */
static const struct {
    const char *set[2];
    bool certifies;
} idle_scenes[] = {
    {{"obstacles=[]"}, true},
    {{"obstacles=[]", "contact.self=off"}, false},
    {{"obstacles=[{plane: {point: [0, -9, 0], normal: [0, 1, 0]}}]", "contact.self=off"}, true},
    {{"obstacles=[]", "probes=[{cloth: sheet, vertices: [1], values: [contact], name: p}]"}, true},
};

UNIT_LOOP(contact_with_nothing, 0, sizeof idle_scenes / sizeof *idle_scenes)
{
    const char *sets[3] = {"contact.mode=certified"};
    size_t n = 1;
    for (; n < 3 && idle_scenes[_i].set[n - 1]; n++)
        sets[n] = idle_scenes[_i].set[n - 1];
    UNIT_OWNED(model_free) struct model model = scene_read_right(scene_right, n, sets);
    ck_assert_int_eq(model_promise(&model).apart, idle_scenes[_i].certifies);
    ck_assert_int_eq((int)model.contact.mode, MODEL_CONTACT_CERTIFIED);
}

/* An obstacle without a coefficient has that of contact. */
UNIT_TEST(frictions)
{
    UNIT_OWNED(model_free)
    struct model model =
        scene_read_changed("  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n",
                           "  linen: {density: 1, stretch: 2, friction: 0}\n"
                           "  cotton: {density: 0.2, stretch: 50}\n"
                           "contact: {friction: 0.25}\n");
    ck_assert_double_eq(model.contact.thickness, 0.001);
    ck_assert(!model.contact.self && !model_promise(&model).apart);
    ck_assert_double_eq(model.materials[0].friction, 0);
    ck_assert_double_eq(model.materials[1].friction, 0.25);
    ck_assert_double_eq(model.obstacles[0].friction, 0.25);
    model_free(&model);
    model = scene_read_set("obstacles[0].plane.friction=0.5");
    ck_assert_double_eq(model.obstacles[0].friction, 0.5);
    ck_assert_double_eq(model.materials[0].friction, 0);
}

/* Halves of both sides' thickness; a pressure that leaves half of both halves together. */
UNIT_TEST(sides_of_contact)
{
    UNIT_OWNED(model_free)
    struct model model =
        scene_read_changed("  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n",
                           "  cotton: {density: 0.2, stretch: 50}\n"
                           "contact: {mode: certified, thickness: 0.003, pressure: 700}\n");
    struct model_sides self = model_sides(&model, 0, 0), floor = model_sides(&model, 0, 1);
    ck_assert_double_eq(self.thickness, 0.003);
    ck_assert_double_eq(self.pressure, 700);
    ck_assert_double_eq(floor.thickness, 0.003);
    ck_assert_double_eq(floor.pressure, 700);
    model_free(&model);
    model = scene_read_changed(
        "  cotton: {density: 0.2, stretch: 50, damping: {mass: 0.1}}\n",
        "  cotton: {density: 0.2, stretch: 50, thickness: 0.004, pressure: 100}\n"
        "  silk: {density: 0.1, stretch: 50, thickness: 0.001, pressure: 6400}\n"
        "contact: {mode: certified, thickness: 0.003, pressure: 700}\n");
    self = model_sides(&model, 0, 0);
    floor = model_sides(&model, 0, 1);
    ck_assert_double_eq(self.thickness, 0.004);
    ck_assert_double_eq(self.pressure, 100);
    ck_assert_double_eq(floor.thickness, 0.0035);
    ck_assert_double_eq(floor.pressure, 100); /* as hard as the cloth */
    model.materials[0].thickness = 0.001;
    model.obstacles[0].thickness = 0.002;
    ck_assert_double_eq(model_sides(&model, 0, 1).thickness, 0.0015);
}

UNIT_TEST(probes_of_contact)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed(
        "\ntime: {h",
        "\ncontact: {mode: certified}\nintegrator: implicit_euler\n"
        "probes: [{vertices: [3, 1], values: [contact, contact_total]}, {obstacle: 0}]\ntime: {h");
    const struct model_probe *probe = model.probes;
    ck_assert(probe[0].contact && probe[0].contact_total && !probe[0].by_obstacle);
    ck_assert(!probe[0].position && !probe[0].total);
    ck_assert(probe[1].by_obstacle && !probe[1].contact && !probe[1].position);
    ck_assert_uint_eq(probe[1].obstacle, 0);
    ck_assert(model_feels_contact(&model));
}

UNIT_TEST(huge_and_tiny_normals)
{
    UNIT_OWNED(model_free)
    struct model model = scene_read_changed("normal: [0, 3, 4]", "normal: [0, 3e300, 4e300]");
    ck_assert_double_eq_tol(model.obstacles[0].value[4], 0.6, 1e-15);
    model_free(&model);
    model = scene_read_changed("normal: [0, 3, 4]", "normal: [0, 3e-300, 4e-300]");
    ck_assert_double_eq_tol(model.obstacles[0].value[5], 0.8, 1e-15);
}
