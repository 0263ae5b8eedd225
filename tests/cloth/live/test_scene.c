/* Scenes: a viewer has the mesh, the obstacles and the bodies of the run, and refuses what is none.
 */
#include "cloth/live/scene.h"
#include "tests/cloth/contact/bodies.h"
#include "tests/cloth/output/sample.h"

#include <string.h>

static struct contact_bodies bodies;
static bool posed[2] = {false, true};
static struct contact_shape obstacles[3];
static unsigned char *bytes;
static size_t n;
static struct live_message said;
static struct output_cache cache;
static struct cloth_error error;

/* The floor of the sample, and two boxes that are bodies; the second one changes its shape. */
static void start(void)
{
    static struct surface box;
    sample_make();
    for (uint32_t i = 0; i < 2; i++) {
        UNIT_OWNED(mesh_free) struct mesh mesh;
        bool turned;
        surface_box(&box, 1, 2, 3 + i);
        surface_mesh(&box, &mesh);
        UNIT_FINE(contact_bodies_add(&bodies, &mesh, &turned, &error));
    }
    uint32_t kind = 0;
    while (contact_kinds[kind] != &contact_body_kind)
        kind++;
    obstacles[0] = sample.setup.obstacles[0];
    for (uint32_t i = 1; i < 3; i++)
        obstacles[i] = (struct contact_shape){.kind = kind, .body = i};
    sample.setup.n_obstacles = 3;
    sample.setup.obstacles = obstacles;
    sample.setup.bodies = &bodies;
    sample.setup.posed = posed;
    UNIT_FINE(live_scene_write(&sample.setup, 9, 4, &bytes, &n, &error));
}

static void end(void)
{
    output_cache_close(&cache);
    sample_free();
    free(bodies.memory);
    free(bytes);
}

static int open_scene(void)
{
    live_message_seal(bytes, n, LIVE_SCENE);
    error = (struct cloth_error){0};
    UNIT_FINE(live_message_read(bytes, n, &said, &error));
    return live_scene_open(&said, &cache, &error);
}

UNIT_FIXTURE(start, end)

UNIT_TEST(meshes)
{
    ck_assert_msg(!open_scene(), "%s", error.text);
    ck_assert_uint_eq(said.run, 9);
    ck_assert_uint_eq(said.scene, 4);
    ck_assert_uint_eq(cache.mesh.n_vertices, SAMPLE_POINTS);
    ck_assert_uint_eq(cache.mesh.n_triangles, 12 + 2);
    uint32_t corner[3];
    for (uint32_t t = 0; t < 12; t++) {
        mesh_corners(&sample.mesh[0], t, corner);
        ck_assert_mem_eq(cache.mesh.triangle + 3 * t, corner, sizeof corner);
    }
    for (uint32_t k = 0; k < 6; k++)
        ck_assert_uint_eq(cache.mesh.triangle[36 + k], 12 + sample.mesh[1].triangle[k]);
    ck_assert_uint_eq(cache.mesh.n_lone_edges, 1);
    ck_assert_uint_eq(cache.mesh.lone_edge[0], 12);
    ck_assert_uint_eq(cache.mesh.lone_edge[1], 14);
    ck_assert_double_eq(cache.mesh.position[3 * 13], 3);
}

UNIT_TEST(obstacles_and_bodies)
{
    ck_assert_msg(!open_scene(), "%s", error.text);
    ck_assert_double_eq(cache.fps, 25);
    ck_assert_uint_eq(cache.n_obstacles, 3);
    ck_assert_double_eq(cache.obstacles[0].value[1], -0.1);
    ck_assert_uint_eq(cache.n_bodies, 2);
    ck_assert(!cache.posed[0] && cache.posed[1]);
    for (uint32_t i = 1; i <= 2; i++) {
        const struct contact_body *here = contact_bodies_at(&cache.bodies, i),
                                  *there = contact_bodies_at(&bodies, i);
        ck_assert_uint_eq(here->bytes, there->bytes);
        ck_assert_mem_eq(here, there, there->bytes);
    }
}

/* Positions as floats, and those of the second body. */
static void make_frame(unsigned char *frame, uint32_t n_body_vertices)
{
    double x[3 * SAMPLE_POINTS], body[3 * 8];
    const struct live_message message = {.run = 9,
                                         .scene = 4,
                                         .number = 3,
                                         .time = 0.12,
                                         .n_vertices = SAMPLE_POINTS,
                                         .n_body_vertices = n_body_vertices};
    sample_positions(1, 3, x);
    for (int i = 0; i < 3 * 8; i++)
        body[i] = 2 * contact_body_vertices(contact_bodies_at(&bodies, 2))[i / 3][i % 3];
    ck_assert(live_frame_write(frame, &message, x));
    ck_assert(live_frame_put(frame, SAMPLE_POINTS, n_body_vertices, body, 3));
    live_message_seal(frame, live_frame_bytes(SAMPLE_POINTS, n_body_vertices), LIVE_FRAME);
}

static int show_frame(uint32_t n_body_vertices)
{
    static unsigned char frame[1000];
    struct live_message read;
    make_frame(frame, n_body_vertices);
    ck_assert_msg(
        !live_message_read(frame, live_frame_bytes(SAMPLE_POINTS, n_body_vertices), &read, &error),
        "%s", error.text);
    return live_frame_show(&read, &cache, &error);
}

UNIT_TEST(frames)
{
    double wanted[3 * SAMPLE_POINTS], x[3 * SAMPLE_POINTS];
    ck_assert_msg(!open_scene(), "%s", error.text);
    ck_assert_msg(!show_frame(8), "%s", error.text);
    sample_positions(1, 3, wanted);
    ck_assert_uint_eq(cache.n_frames, 1);
    UNIT_FINE(output_cache_frame(&cache, 0, x, &error));
    UNIT_FINE(output_cache_pose(&cache, 0, &error));
    ck_assert_mem_eq(x, wanted, sizeof x);
    ck_assert_double_eq(cache.time[0], 0.12);
    const phys_vec *body = contact_body_vertices(contact_bodies_at(&cache.bodies, 2));
    for (int i = 0; i < 24; i++)
        ck_assert_double_eq(body[i / 3][i % 3],
                            2 * contact_body_vertices(contact_bodies_at(&bodies, 2))[i / 3][i % 3]);
}

UNIT_TEST(frames_of_another_mesh)
{
    ck_assert_msg(!open_scene(), "%s", error.text);
    ck_assert_int_eq(show_frame(7), CLOTH_E_INPUT);
    unit_says(error.text, "16 and 7 vertices, its scene 16 and 8");
}

static void expect_fail(const char *why)
{
    ck_assert_int_eq(open_scene(), CLOTH_E_INPUT);
    unit_says(error.text, why);
}

UNIT_TEST(scenes_that_are_none)
{
    const size_t arrays = LIVE_HEADER + 32 + 12 * SAMPLE_POINTS;
    static const unsigned char far[4] = {SAMPLE_POINTS, 0, 0, 0}, nan[4] = {255, 255, 255, 255};
    unsigned char was[4];
    memcpy(was, bytes + arrays + 8, 4);
    memcpy(bytes + arrays + 8, far, 4);
    expect_fail("cannot be used: triangles[0]");
    memcpy(bytes + arrays + 8, was, 4);
    memcpy(was, bytes + LIVE_HEADER + 32, 4);
    memcpy(bytes + LIVE_HEADER + 32, nan, 4);
    expect_fail("vertices[0]");
    memcpy(bytes + LIVE_HEADER + 32, was, 4);
    ck_assert_msg(!open_scene(), "%s", error.text);
    output_cache_close(&cache);
    bytes[n - 2]++; /* the last bracket of the text */
    expect_fail("the scene of the live view:");
    bytes[n - 2]--;
    bytes[LIVE_HEADER + 28] = 1; /* a body less: its bytes are taken for the text */
    expect_fail("the scene of the live view:");
}
