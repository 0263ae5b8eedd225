/* Messages as bytes: what is written is read again, and nothing else is taken for one. */
#include "cloth/base/bytes.h"
#include "cloth/live/live.h"
#include "cloth/live/message.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 5, BODY_POINTS = 2, ROOM = 1000 };

static unsigned char bytes[ROOM];
static struct live_message said;
static struct cloth_error error;

static int read_message(size_t n)
{
    /* A block of its own size, so that a sanitizer sees what is read beyond it. */
    unsigned char *copy = malloc(n ? n : 1);
    ck_assert_ptr_nonnull(copy);
    memcpy(copy, bytes, n);
    error = (struct cloth_error){0};
    const int code = live_message_read(copy, n, &said, &error);
    ck_assert_int_eq(code, error.code);
    free(copy);
    return code;
}

/* A frame in `bytes`; returns its size. */
static size_t make_frame(void)
{
    double x[3 * POINTS], body[4 * BODY_POINTS];
    for (int i = 0; i < 3 * POINTS; i++)
        x[i] = 0.25 * i - 1;
    for (int i = 0; i < 4 * BODY_POINTS; i++)
        body[i] = 100 + i;
    const struct live_message frame = {.kind = LIVE_FRAME,
                                       .run = 7,
                                       .scene = 2,
                                       .number = 41,
                                       .time = 1.64,
                                       .n_vertices = POINTS,
                                       .n_body_vertices = BODY_POINTS};
    const size_t n = live_frame_bytes(POINTS, BODY_POINTS);
    ck_assert(live_frame_write(bytes, &frame, x));
    ck_assert(live_frame_put(bytes, POINTS, BODY_POINTS, body, 4));
    live_message_seal(bytes, n, LIVE_FRAME);
    return n;
}

/* A scene of 3 vertices, an edge, a triangle, a body of 1 vertex and a text; not one that opens. */
static size_t make_scene(void)
{
    const size_t n = LIVE_HEADER + 16 + 16 + 36 + 8 + 12 + 8 + 24 + 2;
    memset(bytes, 0, n);
    bytes[LIVE_HEADER + 16] = 3;
    bytes[LIVE_HEADER + 20] = bytes[LIVE_HEADER + 24] = bytes[LIVE_HEADER + 28] = 1;
    bytes[n - 2 - 24 - 8] = 1;
    live_message_seal(bytes, n, LIVE_SCENE);
    return n;
}

static void expect_fail(size_t n, const char *why)
{
    ck_assert_int_eq(read_message(n), CLOTH_E_INPUT);
    unit_says(error.text, why);
}

UNIT_LOOP(requests_and_ends, 0, 2)
{
    const struct live_message request = {
        .kind = _i ? LIVE_END : LIVE_REQUEST, .run = UINT64_MAX, .scene = 3, .number = 1ULL << 40};
    const size_t n = live_message_write(bytes, &request);
    ck_assert_int_eq(read_message(n), 0);
    ck_assert_int_eq(said.kind, request.kind);
    ck_assert_uint_eq(said.run, request.run);
    ck_assert_uint_eq(said.scene, request.scene);
    ck_assert_uint_eq(said.number, request.number);
    ck_assert_uint_eq(said.version, LIVE_VERSION);
}

UNIT_TEST(frames)
{
    ck_assert_int_eq(read_message(make_frame()), 0);
    ck_assert_int_eq(said.kind, LIVE_FRAME);
    ck_assert_uint_eq(said.number, 41);
    ck_assert_double_eq(said.time, 1.64);
    ck_assert_uint_eq(said.n_vertices, POINTS);
    ck_assert_uint_eq(said.n_body_vertices, BODY_POINTS);
    ck_assert_uint_eq(said.n_rest, 12 * (POINTS + BODY_POINTS));
    const unsigned char *x = bytes + live_frame_bytes(POINTS, BODY_POINTS) - said.n_rest;
    ck_assert_float_eq(cloth_get_float(x + 4 * 14), 2.5F);
    ck_assert_float_eq(cloth_get_float(x + 4 * (3 * POINTS + 3)), 104.0F);
}

UNIT_LOOP(frames_without_a_finite_place, 0, 3)
{
    const double x[3] = {0, _i == 0 ? NAN : _i == 1 ? INFINITY : 1e39, 0};
    const struct live_message frame = {.n_vertices = 1};
    ck_assert(!live_frame_write(bytes, &frame, x));
}

UNIT_TEST(scenes)
{
    ck_assert_int_eq(read_message(make_scene()), 0);
    ck_assert_uint_eq(said.n_vertices, 3);
    ck_assert_uint_eq(said.n_edges, 1);
    ck_assert_uint_eq(said.n_triangles, 1);
    ck_assert_uint_eq(said.n_bodies, 1);
}

/* Whatever is cut off, or changed in any byte. */
UNIT_LOOP(damaged, 0, 2)
{
    const size_t n = _i ? make_scene() : make_frame();
    for (size_t i = 0; i < n; i++)
        ck_assert_int_eq(read_message(i), CLOTH_E_INPUT);
    ck_assert_int_eq(read_message(n + 1), CLOTH_E_INPUT);
    for (size_t i = 0; i < n; i++)
        for (int bit = 0; bit < 8; bit++) {
            bytes[i] ^= (unsigned char)(1 << bit);
            ck_assert_msg(read_message(n), "byte %zu, bit %d", i, bit);
            bytes[i] ^= (unsigned char)(1 << bit);
        }
    ck_assert_int_eq(read_message(n), 0);
}

/* The hash is right, and the sizes are not. */
UNIT_TEST(lies)
{
    static const unsigned char most[4] = {255, 255, 255, 255};
    const size_t n = make_scene();
    for (size_t at = LIVE_HEADER + 16; at < LIVE_HEADER + 32; at += 4) {
        make_scene();
        memcpy(bytes + at, most, 4);
        live_message_seal(bytes, n, LIVE_SCENE);
        expect_fail(n, "counts more than it has");
    }
    make_scene();
    memcpy(bytes + n - 2 - 24 - 4, most, 4); /* triangles of the body */
    live_message_seal(bytes, n, LIVE_SCENE);
    expect_fail(n, "counts more than it has");
    const size_t size = make_frame();
    memcpy(bytes + LIVE_HEADER + 32, most, 4);
    live_message_seal(bytes, size, LIVE_FRAME);
    expect_fail(size, "not the vertices that it counts");
    make_frame();
    memcpy(bytes + size - 4, most, 4);
    live_message_seal(bytes, size, LIVE_FRAME);
    expect_fail(size, "a vertex that is not finite");
    for (size_t i = LIVE_HEADER; i < size; i++)
        for (uint32_t kind = LIVE_REQUEST; kind <= LIVE_END; kind++) {
            make_frame();
            live_message_seal(bytes, i, (enum live_kind)kind);
            ck_assert_msg(read_message(i) || (kind <= LIVE_REQUEST || kind == LIVE_END),
                          "%zu bytes of kind %u", i, kind);
        }
}

UNIT_TEST(other_versions)
{
    const size_t n = make_frame();
    bytes[8] = LIVE_VERSION + 1;
    expect_fail(n, "version 2 of the live view is spoken there, version 1 here");
    ck_assert_uint_eq(said.version, 2);
    bytes[0]++;
    expect_fail(n, "no message of a live view");
    ck_assert_uint_eq(said.version, 0);
}

UNIT_TEST(addresses)
{
    static const char *const good[] = {"5555", "0",       "65535", "127.0.0.1:5555",
                                       "*:1",  "[::1]:0", NULL};
    static const char *const bad[] = {"",           "65536", "-1", ":5555", "5555x",
                                      "127.0.0.1:", "a b",   " 5", "+5",    NULL};
    for (int i = 0; good[i]; i++)
        ck_assert_msg(live_is_address(good[i]), "%s", good[i]);
    for (int i = 0; bad[i]; i++)
        ck_assert_msg(!live_is_address(bad[i]), "%s", bad[i]);
    ck_assert(live_is_host("localhost:5555") && live_is_host("[::1]:1"));
    ck_assert(!live_is_host("5555") && !live_is_host("localhost:0") && !live_is_host(":5555"));
    ck_assert(!live_is_host("localhost") && !live_is_host("localhost:x"));
}
