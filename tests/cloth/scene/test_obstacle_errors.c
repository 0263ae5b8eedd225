/* Obstacles that cannot be made, their motions and the files of bodies: each has its own sentence,
 * as in test_errors.c. Bodies that draw a warning. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the scene that is right has, and the tests replace. */
#define PLANE "plane: {point: [0, -1, 0], normal: [0, 3, 4]}"

START_TEST(shapes)
{
    EXPECT(
        {PLANE, "sphere: {centre: [0, -1, 0], radius: 0}",
         .error = ":11:51: obstacles[0].sphere.radius is 0; a finite number > 0 (m) is expected"},
        {PLANE, "sphere: {centre: [0, -1, 0]}",
         .error =
             ":11:22: obstacles[0].sphere.radius is missing; a finite number > 0 (m) is expected"},
        {PLANE, "sphere: {centre: [0, -1, 0], radius: 1, size: [1, 1, 1]}",
         .error = ":11:54: size is not a key of obstacles[0].sphere; allowed: centre, ..."},
        {PLANE, "box: {centre: [0, -1, 0], size: [1, -2, 1]}",
         .error = ":11:50: obstacles[0].box.size[1] is -2; a finite number > 0 (m) is expected"},
        {PLANE, "box: {centre: [0, -1, 0], size: [1, 2, 1], rotate: [0, 0, 0, 0]}",
         .error = ":11:65: the rotate of a box is zero; a quaternion [w, x, y, z] that is not is "
                  "expected"},
        {PLANE, "ball: {centre: [0, -1, 0], radius: 1}",
         .error = ":11:14: ball is not a key of obstacles[0]; allowed: plane, ..."},
        {PLANE, "capsule: {from: [0, -1, 0], to: [0, -1e160, 0], radius: 0.1}",
         .error = ":11:50: the to of a capsule is -1e+160 m; a magnitude of less than 1e+06 m is "
                  "expected"},
        {PLANE, "cylinder: {centre: [0, -1, 0], axis: [0, 0, 0], radius: 1, length: 1}",
         .error = ":11:51: the axis of a cylinder is zero; a direction is expected"},
        {PLANE, "sphere: {centre: [0, -1, 0], radius: 1e6}",
         .error = ":11:51: the radius of a sphere is 1e+06 m; a magnitude of less than 1e+06 m is "
                  "expected"});
}
END_TEST

#define SPHERE "sphere: {centre: [0, -1, 0], radius: 0.5, motion: "
START_TEST(motions)
{
    EXPECT(
        {PLANE, SPHERE "{times: [0, 1], translate: [[0, 0, 0], [0, 1e99, 0]]}}",
         .error = ":11:107: a translate of a motion is 1e+99 m; a magnitude of less than 1e+06 m "
                  "is expected"},
        {PLANE, SPHERE "{times: [0], translate: [[0, 0, 0]], about: [0, 0, 1e7]}}",
         .error = ":11:115: the about of a motion is 1e+07 m; a magnitude of less than 1e+06 m is "
                  "expected"},
        {PLANE, SPHERE "{times: [0, 1, 1], translate: [[0, 0, 0], [0, 1, 0], [0, 2, 0]]}}",
         .error = ":11:79: motion.times[2] is 1, which does not come after 1, the one before it; "
                  "times in ascending order are expected"},
        {PLANE, SPHERE "{times: [0, 1], translate: [[0, 0, 0]]}}",
         .error = ":11:91: translate of a motion has 1 entries, but there are 2 times; as many are "
                  "expected"},
        {PLANE, SPHERE "{times: [0], rotate: [[0, 0, 0, 0]]}}",
         .error =
             ":11:86: a rotation of a motion is zero; a quaternion [w, x, y, z] that is not is "
             "expected"});
}
END_TEST

/* Corners and faces of a tetrahedron. */
#define CORNERS "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
#define WHOLE   "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
static void write_body(const char *name, const char *faces)
{
    char text[400];
    snprintf(text, sizeof text, "%s%s", CORNERS, faces);
    scene_write_file(name, text, strlen(text));
}

START_TEST(bodies)
{
    write_body("whole.obj", WHOLE);
    write_body("open.obj", "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
    write_body("against.obj", "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n");
    write_body("flat.obj", "v 2 0 0\nf 1 3 2\nf 1 2 5\n");
    write_body("none.obj", "");
    EXPECT(
        {PLANE, "body: {scale: 2}",
         .error = ":11:20: obstacles[0].body has no obj or mannequin; one of them is expected"},
        {PLANE, "body: {obj: open.obj}",
         .error = ":11:26: body: open.obj: the mesh is not closed: the edge between vertices 2 and "
                  "3 has 1 triangle where 2 are expected, as 3 edges have in all (vertices count "
                  "from 1); fill the holes, or join the parts"},
        {PLANE, "body: {obj: against.obj}",
         .error =
             ":11:26: body: against.obj: triangles 1 and 4, at the edge between vertices 2 and "
             "3, are wound against each other (triangles and vertices count from 1); turn one "
             "round"},
        {PLANE, "body: {obj: flat.obj}",
         .error = ":11:26: body: flat.obj: triangle 2, of vertices 1, 2 and 5, has no area; remove "
                  "it, or move a vertex (triangles and vertices count from 1)"},
        {PLANE, "body: {obj: none.obj}",
         .error = ":11:26: body: none.obj: the mesh has no triangles; a closed surface is "
                  "expected"},
        {PLANE, "body: {obj: whole.obj, scale: 0}",
         .error = ":11:44: obstacles[0].body.scale is 0; ..."},
        {PLANE, "body: {obj: whole.obj, rotate: [0, 0, 0, 0]}",
         .error =
             ":11:45: the quaternion [w, x, y, z] has no direction; its length must be neither "
             "zero nor huge"},
        {PLANE, "body: {obj: whole.obj, translate: [0, 2e6, 0]}",
         .error =
             ":11:26: body: whole.obj: vertex 1 is 2e+06 m from the origin along an axis; less "
             "than 1e+06 m is expected (vertices count from 1)"},
        {PLANE, "body: {obj: whole.obj, size: 1}",
         .error = ":11:37: size is not a key of obstacles[0].body; allowed: obj, ..."});
}
END_TEST

START_TEST(bodies_that_cannot_be_read)
{
    struct cloth_error error = {0};
    struct model model;
    write_body("third.obj", "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 2 3 1\n");
    static const char *const unread[][2] = {
        {"nowhere.obj", "nowhere.obj: cannot be opened: No such file"},
        {"third.obj", "third.obj:9: this face is the third"}};
    for (int i = 0; i < 2; i++) {
        char body[80];
        snprintf(body, sizeof body, "body: {obj: %s}", unread[i][0]);
        char *text = scene_changed(scene_right, PLANE, body);
        memset(&error, 0, sizeof error);
        ck_assert_int_eq(scene_read_text(&model, text, 0, NULL, &error), CLOTH_E_INPUT);
        ck_assert_ptr_nonnull(strstr(error.text, ":11:26: body: "));
        ck_assert_msg(strstr(error.text, unread[i][1]) != NULL, "%s", error.text);
        model_free(&model);
        free(text);
    }
}
END_TEST

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

START_TEST(frames_that_are_wrong)
{
    write_body("whole.obj", WHOLE);
    write_body("turned.obj", "f 3 2 1\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write_body("less.obj", "f 1 3 2\nf 1 2 4\n");
    write_pc2("three.pc2", 3, 2, 0, 3);
    write_pc2("short.pc2", 4, 2, 4, 3);
    write_pc2("none.pc2", 4, 0, 0, 3);
    write_pc2("nan.pc2", 4, 2, 0, NAN);
#define FRAMES "body: {obj: whole.obj, frames: "
    EXPECT({PLANE, FRAMES "{fps: 2}}",
            .error = ":11:45: obstacles[0].body.frames has no pc2 or obj; "
                     "one of them is expected"},
           {PLANE, FRAMES "{obj: []}}",
            .error = ":11:51: obstacles[0].body.frames.obj is an empty "
                     "list; a non-empty list of texts is expected"},
           {PLANE, FRAMES "{obj: [whole.obj, less.obj]}}",
            .error =
                ":11:63: frames: less.obj has 4 vertices and 2 faces, but the mesh of the body "
                "has 4 and 4"},
           {PLANE, FRAMES "{obj: [turned.obj]}}",
            .error = ":11:52: frames: the faces of turned.obj have other corners than those of the "
                     "mesh of the body"},
           {PLANE, FRAMES "{obj: [whole.obj]}, motion: {times: [0], translate: [[0, 1, 0]]}}",
            .error = ":11:73: a body with frames has no motion: its frames say where it is"});
    static const char *const wrong[][2] = {
        {"three.pc2", "three.pc2: its frames have 3 vertices, but the mesh has 4"},
        {"short.pc2", "short.pc2: it ends within frame 2"},
        {"none.pc2", "none.pc2: it has no frames"},
        {"nan.pc2", "nan.pc2: vertex 1 of frame 2 has a coordinate that is no finite number"},
        {"whole.obj", "whole.obj: no PC2 file of version 1"},
        {"nowhere.pc2", "nowhere.pc2: cannot be read: No such file"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct cloth_error error = {0};
        struct model model;
        char body[120];
        snprintf(body, sizeof body, FRAMES "{pc2: %s}}", wrong[i][0]);
        char *text = scene_changed(scene_right, PLANE, body);
        ck_assert_int_eq(scene_read_text(&model, text, 0, NULL, &error), CLOTH_E_INPUT);
        ck_assert_ptr_nonnull(strstr(error.text, ":11:51: frames: "));
        ck_assert_msg(strstr(error.text, wrong[i][1]) != NULL, "%s", error.text);
        model_free(&model);
        free(text);
    }
}
END_TEST

/* Twice as large, 1 m up; the second frame is 3.5 m away. */
START_TEST(frames_that_jump)
{
    write_body("whole.obj", WHOLE);
    write_pc2("jumps.pc2", 4, 2, 0, 3);
    char *text = scene_changed(scene_right, PLANE,
                               FRAMES "{pc2: jumps.pc2, fps: 2, start: 1}, scale: 2, translate: "
                                      "[0, 1, 0]}");
    struct model model = scene_read_right(text, 0, NULL);
    ck_assert_uint_eq(model.n_warnings, 2); /* it is a point, too */
    ck_assert_msg(strstr(model.warnings[0], ":11:45: vertex 1 of the body jumps by 6.9282 m from "
                                            "frame 1 to the next, by more than a quarter") != NULL,
                  "%s", model.warnings[0]);
    const struct contact_body *body = contact_bodies_at(&model.bodies, 1);
    phys_vec x[4];
    ck_assert_uint_eq(body->n_frames, 2);
    contact_body_places(body, 1.25, x);
    ck_assert(x[3][0] == 4 && x[3][1] == 5 && x[3][2] == 4);
    ck_assert(model_obstacles_move(&model) && model_moves_after(&model, 1.4));
    ck_assert(!model_moves_after(&model, 1.5));
    model_free(&model);
    free(text);
}
END_TEST

START_TEST(a_body_in_centimetres)
{
    write_body("whole.obj", WHOLE);
    char *large = scene_changed(scene_right, PLANE, "body: {obj: whole.obj, scale: 12.5}");
    struct model model = scene_read_right(large, 0, NULL);
    ck_assert_uint_eq(model.n_warnings, 1);
    ck_assert_ptr_nonnull(strstr(model.warnings[0],
                                 ":11:26: the body is 12.5 m long in its largest extent, more than "
                                 "10 m: is its mesh in metres?"));
    model_free(&model);
    free(large);
}
END_TEST

START_TEST(a_body_that_is_inside_out)
{
    write_body("whole.obj", WHOLE);
    write_body("out.obj", "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
    for (int i = 0; i < 2; i++) {
        char *text =
            scene_changed(scene_right, PLANE,
                          i ? "body: {obj: out.obj, scale: [1, 2, 3], translate: [5, 0, 0], "
                              "motion: {times: [1], translate: [[0, 1, 0]]}}"
                            : "body: {obj: whole.obj}");
        struct model model = scene_read_right(text, 0, NULL);
        ck_assert_uint_eq(model.n_warnings, (uint32_t)i);
        const char *warning = ":11:26: the mesh of a body is inside out: its triangles are "
                              "clockwise as seen from outside; they are turned round";
        ck_assert(!i || strstr(model.warnings[0], warning));
        const struct contact_body *body = contact_bodies_at(&model.bodies, model.obstacles->body);
        ck_assert(body->n_triangles == 4 && model.obstacles->n == (uint32_t)i);
        ck_assert(body->low[0] == 5 * i && body->high[0] == 5 * i + 1);
        ck_assert(body->high[1] == 1 + i && body->high[2] == 1 + 2 * i);
        model_free(&model);
        free(text);
    }
}
END_TEST

/* A second tetrahedron, in a corner of the first or away from it. */
START_TEST(a_body_that_goes_through_itself)
{
    const char *const at[] = {"0.1", "3"};
    for (int i = 0; i < 2; i++) {
        char rest[300];
        snprintf(rest, sizeof rest,
                 "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nv %s 0.1 0.1\nv 9 0.1 0.1\nv %s 9 0.1\n"
                 "v %s 0.1 9\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n",
                 at[i], at[i], at[i]);
        write_body("twice.obj", rest);
        char *text = scene_changed(scene_right, PLANE, "body: {obj: twice.obj}");
        struct model model = scene_read_right(text, 0, NULL);
        ck_assert_uint_eq(model.n_warnings, i ? 0 : 1);
        ck_assert(i || strstr(model.warnings[0], ":11:26: the body goes through itself: 3 pairs of "
                                                 "its triangles intersect, the first are 2 3 4 "
                                                 "and 5 7 6 (vertices count from 1)"));
        model_free(&model);
        free(text);
    }
}
END_TEST

#define MAPS "body: {obj: whole.obj, "
START_TEST(maps_that_are_wrong)
{
    write_body("whole.obj", WHOLE);
    EXPECT({PLANE, MAPS "meet: images}",
            .error = ":11:43: obstacles[0].body.meet is images; bvh or image is expected"},
           {PLANE, MAPS "meet: image, resolution: 8}",
            .error = ":11:62: obstacles[0].body.resolution is 8; a whole number from 16 to 4096 is "
                     "expected"},
           {PLANE, MAPS "meet: image, view: w}",
            .error = ":11:56: obstacles[0].body.view is w; thinnest or x or y or z is expected"});
    char *text = scene_changed(scene_right, PLANE, MAPS "meet: image}");
    scene_expect_error(
        text, "contact.mode=certified",
        ":11:43: a body that is met by image, in contact.mode certified: maps of its "
        "front and back do not show all of it, so nothing can be proven of them; "
        "meet: bvh, or contact: {mode: project}, is expected");
    scene_expect_error(
        text, "contact.mode=repulsion",
        ":11:43: a body that is met by image, in contact.mode repulsion, which looks for the "
        "nearest points of bodies; meet: bvh, or contact: {mode: project}, is expected");
    free(text);
}
END_TEST

/* Along which axis, in how many pixels; what is of maps says nothing where there are none. */
START_TEST(maps)
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
        struct model model = scene_read_right(text, 0, NULL);
        const struct contact_view *view = &model.obstacles->view;
        ck_assert_uint_eq(view->axis, cases[i].axis);
        ck_assert_uint_eq(view->width, cases[i].width);
        ck_assert_uint_eq(view->height, cases[i].height);
        ck_assert_uint_eq(model.n_warnings, cases[i].warnings);
        ck_assert_int_eq(model.contact.mode,
                         view->height ? MODEL_CONTACT_PROJECT : MODEL_CONTACT_CERTIFIED);
        if (cases[i].warnings)
            ck_assert_ptr_nonnull(
                strstr(model.warnings[1], "resolution means nothing: it needs meet = image"));
        model_free(&model);
        free(text);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("obstacle errors");
    TCase *cases = tcase_create("errors");
    tcase_add_test(cases, shapes);
    tcase_add_test(cases, motions);
    tcase_add_test(cases, bodies);
    tcase_add_test(cases, bodies_that_cannot_be_read);
    tcase_add_test(cases, frames_that_are_wrong);
    tcase_add_test(cases, frames_that_jump);
    tcase_add_test(cases, maps_that_are_wrong);
    tcase_add_test(cases, maps);
    tcase_add_test(cases, a_body_in_centimetres);
    tcase_add_test(cases, a_body_that_is_inside_out);
    tcase_add_test(cases, a_body_that_goes_through_itself);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
