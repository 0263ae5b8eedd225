/* Reading never goes beyond the bytes received: each count is compared with the bytes left before
 * they are read. */
#include "cloth/live/message.h"

#include "cloth/base/bytes.h"

#include <math.h>
#include <xxhash.h>

enum {
    VERSION_AT = 8,
    KIND_AT = 12,
    SIZE_AT = 16,
    HASH_AT = 24,
    RUN_AT = LIVE_HEADER,
    SCENE_AT = LIVE_HEADER + 8,
    OWN_AT = LIVE_HEADER + 16, /* what is of the kind */
    FIXED_SCENE = OWN_AT + 16,
    FIXED_FRAME = OWN_AT + 24,
    FIXED_BODY = 8
};
static const char MAGIC[8] = {'D', 'U', 'I', 'T', 'E', 'L', 'V', '\n'};

/* ---- Reading ---- */

static int message_fail(struct cloth_error *error, const char *what)
{
    return cloth_fail(error, CLOTH_E_INPUT, "%s", what);
}

static int message_read_header(const unsigned char *bytes, size_t n, struct live_message *message,
                               struct cloth_error *error)
{
    if (n < LIVE_HEADER || memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
        return message_fail(error, "this is no message of a live view");
    message->version = cloth_get_u32(bytes + VERSION_AT);
    if (message->version != LIVE_VERSION)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "version %u of the live view is spoken there, version %d here: take "
                          "duite-cloth and duite-view from the same release",
                          message->version, LIVE_VERSION);
    const uint32_t kind = cloth_get_u32(bytes + KIND_AT);
    if (kind < LIVE_REQUEST || kind > LIVE_END)
        return message_fail(error, "a message of the live view has a kind that there is not");
    message->kind = (enum live_kind)kind;
    if (cloth_get_u64(bytes + SIZE_AT) != n - LIVE_HEADER)
        return message_fail(error, "a message of the live view is cut off, or too long");
    if (XXH64(bytes + LIVE_HEADER, n - LIVE_HEADER, kind) != cloth_get_u64(bytes + HASH_AT))
        return message_fail(error,
                            "a message of the live view is damaged: its hash is another one");
    return 0;
}

/* True if all bodies of a scene, which begin at `at` of n bytes, are there. */
static bool has_bodies(const unsigned char *bytes, uint64_t n, uint64_t at, uint32_t n_bodies)
{
    for (uint32_t i = 0; i < n_bodies; i++) {
        if (n - at < FIXED_BODY)
            return false;
        const uint64_t size = FIXED_BODY + UINT64_C(24) * cloth_get_u32(bytes + at) +
                              UINT64_C(12) * cloth_get_u32(bytes + at + 4);
        if (n - at < size)
            return false;
        at += size;
    }
    return true;
}

static int message_read_scene(const unsigned char *bytes, size_t n, struct live_message *scene,
                              struct cloth_error *error)
{
    if (n < FIXED_SCENE)
        return message_fail(error, "a scene of the live view is too short");
    scene->n_vertices = cloth_get_u32(bytes + OWN_AT);
    scene->n_edges = cloth_get_u32(bytes + OWN_AT + 4);
    scene->n_triangles = cloth_get_u32(bytes + OWN_AT + 8);
    scene->n_bodies = cloth_get_u32(bytes + OWN_AT + 12);
    const uint64_t arrays = UINT64_C(12) * scene->n_vertices + UINT64_C(8) * scene->n_edges +
                            UINT64_C(12) * scene->n_triangles;
    if (!scene->n_vertices || n - FIXED_SCENE < arrays ||
        !has_bodies(bytes, n, FIXED_SCENE + arrays, scene->n_bodies))
        return message_fail(error, "a scene of the live view counts more than it has");
    scene->rest = bytes + FIXED_SCENE;
    scene->n_rest = n - FIXED_SCENE;
    return 0;
}

static int message_read_frame(const unsigned char *bytes, size_t n, struct live_message *frame,
                              struct cloth_error *error)
{
    if (n < FIXED_FRAME)
        return message_fail(error, "a frame of the live view is too short");
    frame->number = cloth_get_u64(bytes + OWN_AT);
    frame->time = cloth_get_double(bytes + OWN_AT + 8);
    frame->n_vertices = cloth_get_u32(bytes + OWN_AT + 16);
    frame->n_body_vertices = cloth_get_u32(bytes + OWN_AT + 20);
    const uint64_t points = (uint64_t)frame->n_vertices + frame->n_body_vertices;
    if (n - FIXED_FRAME != 12 * points)
        return message_fail(error, "a frame of the live view has not the vertices that it counts");
    if (!isfinite(frame->time))
        return message_fail(error, "a frame of the live view has a time that is not finite");
    for (uint64_t i = 0; i < 3 * points; i++)
        if (!isfinite(cloth_get_float(bytes + FIXED_FRAME + 4 * i)))
            return message_fail(error, "a frame of the live view has a vertex that is not finite");
    frame->rest = bytes + FIXED_FRAME;
    frame->n_rest = n - FIXED_FRAME;
    return 0;
}

int live_message_read(const void *bytes, size_t n, struct live_message *message,
                      struct cloth_error *error)
{
    const unsigned char *from = bytes;
    *message = (struct live_message){0};
    if (message_read_header(from, n, message, error))
        return CLOTH_E_INPUT;
    if (n < OWN_AT)
        return message_fail(error, "a message of the live view is too short");
    message->run = cloth_get_u64(from + RUN_AT);
    message->scene = cloth_get_u64(from + SCENE_AT);
    if (message->kind == LIVE_SCENE)
        return message_read_scene(from, n, message, error);
    if (message->kind == LIVE_FRAME)
        return message_read_frame(from, n, message, error);
    if (n != LIVE_REQUEST_BYTES)
        return message_fail(error, "a message of the live view has a size that it cannot have");
    message->number = cloth_get_u64(from + OWN_AT);
    return 0;
}

/* ---- Writing ---- */

void live_message_seal(unsigned char *bytes, size_t n, enum live_kind kind)
{
    memcpy(bytes, MAGIC, sizeof MAGIC);
    cloth_put_u32(bytes + VERSION_AT, LIVE_VERSION);
    cloth_put_u32(bytes + KIND_AT, (uint32_t)kind);
    cloth_put_u64(bytes + SIZE_AT, n - LIVE_HEADER);
    cloth_put_u64(bytes + HASH_AT, XXH64(bytes + LIVE_HEADER, n - LIVE_HEADER, (uint64_t)kind));
}

size_t live_message_write(unsigned char bytes[LIVE_REQUEST_BYTES],
                          const struct live_message *message)
{
    cloth_put_u64(bytes + RUN_AT, message->run);
    cloth_put_u64(bytes + SCENE_AT, message->scene);
    cloth_put_u64(bytes + OWN_AT, message->number);
    live_message_seal(bytes, LIVE_REQUEST_BYTES, message->kind);
    return LIVE_REQUEST_BYTES;
}

size_t live_frame_bytes(uint32_t n_vertices, uint32_t n_body_vertices)
{
    return FIXED_FRAME + 12 * ((size_t)n_vertices + n_body_vertices);
}

bool live_frame_put(unsigned char *bytes, size_t at, size_t n, const double *x, size_t stride)
{
    return cloth_put_points(bytes + FIXED_FRAME + 12 * at, n, x, stride) == n;
}

bool live_frame_write(unsigned char *bytes, const struct live_message *frame,
                      const double *position)
{
    cloth_put_u64(bytes + RUN_AT, frame->run);
    cloth_put_u64(bytes + SCENE_AT, frame->scene);
    cloth_put_u64(bytes + OWN_AT, frame->number);
    cloth_put_double(bytes + OWN_AT + 8, frame->time);
    cloth_put_u32(bytes + OWN_AT + 16, frame->n_vertices);
    cloth_put_u32(bytes + OWN_AT + 20, frame->n_body_vertices);
    return live_frame_put(bytes, 0, frame->n_vertices, position, 3);
}
