#ifndef CLOTH_LIVE_MESSAGE_H
#define CLOTH_LIVE_MESSAGE_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Messages of the live view, as bytes. A viewer sends requests; a run answers each with one
 * message. It sends its scene if the viewer has another one; else the newest frame, once there is
 * one that the viewer lacks. Numbers are little-endian:
 *
 *    0  "DUITELV\n"
 *    8  u32 version (LIVE_VERSION; the rest may differ in others)
 *   12  u32 kind
 *   16  u64 bytes of the payload, which is the rest of the message
 *   24  u64 XXH64 of the payload, seed: the kind
 *   32  u64 run, a random number that is not 0; u64 scene, counted from 1 in a run; then
 *
 *   REQUEST  u64 next: the first frame that the viewer lacks. Run and scene are the viewer's, or 0.
 *   SCENE    u32 vertices V, edges E, triangles T, bodies B; V x 3 f32, the start (m); E x 2 and
 *            T x 3 u32, vertices from 0; E are edges without triangles. For each body u32
 *            vertices, u32 triangles, vertices x 3 f64 (m), triangles x 3 u32. Up to the end:
 *            scene.json of a folder of frames (output.h).
 *   FRAME    u64 number, f64 time (s), u32 V, u32 W; V x 3 and W x 3 f32 (m): of the cloth, and of
 *            those bodies, one after the other, that change their shapes (scene.json: "pc2").
 *   END      u64 frames of the run, which is over.
 *
 * Pure functions. */
enum { LIVE_VERSION = 1, LIVE_HEADER = 32, LIVE_REQUEST_BYTES = LIVE_HEADER + 24 };
enum live_kind { LIVE_REQUEST = 1, LIVE_SCENE, LIVE_FRAME, LIVE_END };

/* No message has more bytes. */
#define LIVE_MAX_BYTES (INT64_C(1) << 36)

/* The contents of a message. */
struct live_message {
    uint32_t version;
    enum live_kind kind;
    uint64_t run, scene;
    uint64_t number; /* next; of the frame; of frames */
    double time;     /* s */
    uint32_t n_vertices, n_edges, n_triangles, n_bodies;
    uint32_t n_body_vertices;  /* W */
    const unsigned char *rest; /* the arrays and the text, in the bytes that were read */
    size_t n_rest;
};

/* Reads a message from any bytes. On success, all that it counts is there, and numbers of a frame
 * are finite; live_scene_open checks corners and the text of a scene. Errors: CLOTH_E_INPUT: it is
 * no message, damaged, or of another version. message->version is that version; LIVE_VERSION if it
 * is the same, 0 for no message. */
int live_message_read(const void *bytes, size_t n, struct live_message *message,
                      struct cloth_error *error);

/* Writes a message without arrays: a request or an end. Returns its bytes. */
size_t live_message_write(unsigned char bytes[LIVE_REQUEST_BYTES],
                          const struct live_message *message);

/* live_frame_bytes: the bytes of a frame's message. live_frame_write: writes all but the header,
 * whose place is left. false: a number is not finite as float. position: n_vertices x 3, m; those
 * of bodies follow by live_frame_put. */
size_t live_frame_bytes(uint32_t n_vertices, uint32_t n_body_vertices);
bool live_frame_write(unsigned char *bytes, const struct live_message *frame,
                      const double *position);
/* Puts n vertices, each `stride` doubles after the one before it, from number `at` on. As above. */
bool live_frame_put(unsigned char *bytes, size_t at, size_t n, const double *x, size_t stride);

/* Writes the header of a message of n bytes, in front of its payload. */
void live_message_seal(unsigned char *bytes, size_t n, enum live_kind kind);

#endif
