#ifndef CLOTH_LIVE_LIVE_H
#define CLOTH_LIVE_LIVE_H

#include "cloth/base/error.h"
#include "cloth/output/output.h"

#include <stdbool.h>
#include <stdint.h>

/* The live view of a run: it publishes frames (publish.c), viewers follow it (follow.c), over
 * ZeroMQ, in the messages of message.h. Local functions. */

/* ---- A run: a thread of its own answers viewers ----
 *
 * Only the newest frame is kept. A viewer gets it when it asks, so the run waits for no viewer, and
 * a slow or stopped viewer keeps at most one message in memory. */
struct live_publisher;

/* The reason why this build cannot publish or follow; NULL: it can. */
const char *live_lacks(void);

/* True if text is PORT or ADDRESS:PORT. PORT is 0 to 65535, 0 for any free one. ADDRESS is a
 * number, such as 127.0.0.1, [::1] or 0.0.0.0, or `*' for all. */
bool live_is_address(const char *text);

/* True if text is HOST:PORT, with PORT 1 to 65535. */
bool live_is_host(const char *text);

/* Listens there; without an ADDRESS, on 127.0.0.1. `warn` says a sentence at once, from any thread.
 * Call it before the runtime binds its threads to cores. Errors: CLOTH_E_INPUT, the address cannot
 * be listened on, and why; CLOTH_E_LIBRARY, CLOTH_E_MEMORY. */
int live_publish_open(struct live_publisher **publisher, const char *address,
                      void (*warn)(const char *text), struct cloth_error *error);
/* The actual ADDRESS:PORT. */
const char *live_publish_address(const struct live_publisher *publisher);

/* Replaces the scene. The bodies are at their time 0 when the time of frames, s, is `begin`, and
 * must outlive the frames. The rest of the setup is read only during the call. Call it before the
 * first frame; later with the same meshes only. Error: CLOTH_E_MEMORY. */
int live_publish_scene(struct live_publisher *publisher, const struct output_setup *setup,
                       double begin, struct cloth_error *error);
/* Replaces the newest frame; one with a vertex that is not finite, or without memory for it, is
 * left out. position:
 * n_vertices x 3, m, is copied. */
void live_publish_frame(struct live_publisher *publisher, uint64_t frame, double time,
                        const double *position);
/* Ends the run for viewers. Those that wait for a frame, or asked or got one in the last 2 s, have
 * a second to take the last one, and are told that it is the last. *publisher becomes NULL. */
void live_publish_close(struct live_publisher **publisher);

/* ---- A viewer ---- */

struct live_follower;
enum live_news {
    LIVE_NOTHING,   /* no news within the time */
    LIVE_NEW_FRAME, /* live_follow_cache has a newer frame */
    LIVE_NEW_SCENE  /* the same, with another scene: drop pointers into the old one before the
                     * call */
};

/* host: HOST:PORT. live_follow finds out later if a run listens there. Errors: CLOTH_E_INPUT, it is
 * no HOST:PORT; CLOTH_E_LIBRARY, CLOTH_E_MEMORY. */
int live_follow_open(struct live_follower **follower, const char *host, struct cloth_error *error);

/* Waits at most so many seconds for news. Runs may end, be lost and start again meanwhile. Errors:
 * CLOTH_E_INPUT, the messages are of another version or no live view; CLOTH_E_MEMORY,
 * CLOTH_E_LIBRARY. */
int live_follow(struct live_follower *follower, double seconds, enum live_news *news,
                struct cloth_error *error);
/* After news: the newest frame, as the only one of a folder (number 0). It stays the follower's. */
struct output_cache *live_follow_cache(struct live_follower *follower);

/* The state as a sentence, valid until the next call; *waits: no run sends frames now. */
const char *live_follow_state(struct live_follower *follower, bool *waits);
/* The number of the frame in the run. */
uint64_t live_follow_frame(const struct live_follower *follower);
void live_follow_close(struct live_follower **follower);

#endif
