/* Bodies of scenes: what their frames, maps and turned meshes become, and files of frames that are
 * wrong. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The parts of a right scene that the tests replace. */
#define PLANE "plane: {point: [0, -1, 0], normal: [0, 3, 4]}"

#define FRAMES "body: {obj: whole.obj, frames: "

/* Corners and faces of a tetrahedron. */
#define CORNERS "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
#define WHOLE   "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
static void write_body(const char *name, const char *faces)
{
    char text[400];
    snprintf(text, sizeof text, "%s%s", CORNERS, faces);
    scene_write_file(name, text, strlen(text));
}

/* A PC2 file of so many frames of n vertices, all at x = y = z = 1 but for those of the
 * last frame. */
static void write_pc2(const char *name, uint32_t n, uint32_t frames, size_t less, float last)
{
    char bytes[32 + 12 * 20] = "POINTCACHE2";
    const float one = 1;
    const uint32_t version = 1;
    memcpy(bytes + 12, &version, 4);
    memcpy(bytes + 16, &n, 4);
    memcpy(bytes + 28, &frames, 4);
    for (size_t i = 0; i < 3 * (size_t)n * frames; i++)
        memcpy(bytes + 32 + 4 * i, i / 3 / n + 1 < frames ? &one : &last, 4);
    scene_write_file(name, bytes, 32 + 12 * (size_t)n * frames - less);
}

UNIT_TEST(frames_that_are_wrong)
{
    write_body("whole.obj", WHOLE);
    write_pc2("three.pc2", 3, 2, 0, 3);
    write_pc2("short.pc2", 4, 2, 4, 3);
    write_pc2("none.pc2", 4, 0, 0, 3);
    write_pc2("nan.pc2", 4, 2, 0, NAN);
    static const char *const wrong[][2] = {
        {"three.pc2", "three.pc2: its frames have 3 vertices, but the mesh has 4"},
        {"short.pc2", "short.pc2: it ends within frame 2"},
        {"none.pc2", "none.pc2: it has no frames"},
        {"nan.pc2", "nan.pc2: vertex 1 of frame 2 has a coordinate that is no finite number"},
        {"whole.obj", "whole.obj: no PC2 file of version 1"},
        {"nowhere.pc2", "nowhere.pc2: cannot be read: No such file"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        UNIT_OWNED(model_free) struct model model;
        char body[120];
        snprintf(body, sizeof body, FRAMES "{pc2: %s}}", wrong[i][0]);
        char *text = scene_changed(scene_right, PLANE, body);
        UNIT_CALL(scene_read_text(&model, text, 0, NULL, &error),
                  ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
                  unit_says(error.text, ":11:51: frames: "); unit_says(error.text, wrong[i][1]));
        free(text);
    }
}

/* Twice as large, 1 m up; the second frame is 3.5 m away. */
UNIT_TEST(frames_that_jump)
{
    write_body("whole.obj", WHOLE);
    write_pc2("jumps.pc2", 4, 2, 0, 3);
    char *text = scene_changed(scene_right, PLANE,
                               FRAMES "{pc2: jumps.pc2, fps: 2, start: 1}, scale: 2, translate: "
                                      "[0, 1, 0]}");
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    ck_assert_uint_eq(model.n_warnings, 2); /* it is a point, too */
    unit_says(model.warnings[0], ":11:45: vertex 1 of the body jumps by 6.9282 m from "
                                 "frame 1 to the next, by more than a quarter");
    const struct contact_body *body = contact_bodies_at(&model.bodies, 1);
    phys_vec x[4];
    ck_assert_uint_eq(body->n_frames, 2);
    contact_body_places(body, 1.25, x);
    ck_assert(x[3][0] == 4 && x[3][1] == 5 && x[3][2] == 4);
    ck_assert(model_obstacles_move(&model) && model_moves_after(&model, 1.4));
    ck_assert(!model_moves_after(&model, 1.5));
    free(text);
}

UNIT_TEST(a_body_that_is_inside_out)
{
    write_body("whole.obj", WHOLE);
    write_body("out.obj", "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
    for (int i = 0; i < 2; i++) {
        char *text =
            scene_changed(scene_right, PLANE,
                          i ? "body: {obj: out.obj, scale: [1, 2, 3], translate: [5, 0, 0], "
                              "motion: {times: [1], translate: [[0, 1, 0]]}}"
                            : "body: {obj: whole.obj}");
        UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
        ck_assert_uint_eq(model.n_warnings, (uint32_t)i);
        const char *warning = ":11:26: the mesh of a body is inside out: its triangles are "
                              "clockwise as seen from outside; they are turned round";
        ck_assert(!i || strstr(model.warnings[0], warning));
        const struct contact_body *body = contact_bodies_at(&model.bodies, model.obstacles->body);
        ck_assert(body->n_triangles == 4 && model.obstacles->n == (uint32_t)i);
        ck_assert(body->low[0] == 5 * i && body->high[0] == 5 * i + 1);
        ck_assert(body->high[1] == 1 + i && body->high[2] == 1 + 2 * i);
        free(text);
    }
}

#define MAPS "body: {obj: whole.obj, "

/* Along which axis, in how many pixels; what is of maps says nothing where there are none. */
UNIT_TEST(maps)
{
    static const struct {
        const char *keys;
        uint32_t axis, width, height, warnings;
    } cases[] = {{"meet: bvh", 0, 0, 0, 0},
                 {"meet: image", 1, 768, 1024, 0},
                 {"meet: image, view: x, resolution: 90", 0, 60, 90, 0},
                 {"meet: image, view: z, resolution: 90", 2, 90, 45, 0},
                 {"view: z, resolution: 90", 0, 0, 0, 2}};
    write_body("whole.obj", WHOLE);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char body[200];
        snprintf(body, sizeof body, MAPS "scale: [4, 2, 3], %s}", cases[i].keys);
        char *text = scene_changed(scene_right, PLANE, body);
        UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
        const struct contact_view *view = &model.obstacles->view;
        ck_assert_uint_eq(view->axis, cases[i].axis);
        ck_assert_uint_eq(view->width, cases[i].width);
        ck_assert_uint_eq(view->height, cases[i].height);
        ck_assert_uint_eq(model.n_warnings, cases[i].warnings);
        ck_assert_int_eq(model.contact.mode,
                         view->height ? MODEL_CONTACT_PROJECT : MODEL_CONTACT_CERTIFIED);
        if (cases[i].warnings)
            unit_says(model.warnings[1], "resolution means nothing: it needs meet = image");
        free(text);
    }
}

/* Every vertex lies on it, also where it is turned and put. */
UNIT_TEST(an_ellipsoid)
{
    char *text = scene_changed(scene_right, PLANE,
                               "body: {ellipsoid: [0.3, 0.2, 0.1], rotate: {axis: [0, 0, 1], "
                               "degrees: 90}, translate: [1, 0, 0]}");
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    const struct contact_body *body = contact_bodies_at(&model.bodies, 1);
    const phys_vec *x = contact_body_vertices(body);
    ck_assert_uint_eq(body->n_triangles, 5120);
    for (uint32_t v = 0; v < body->n_vertices; v++)
        ck_assert_double_eq_tol(
            pow((x[v][0] - 1) / 0.2, 2) + pow(x[v][1] / 0.3, 2) + pow(x[v][2] / 0.1, 2), 1, 1e-12);
    free(text);
}
