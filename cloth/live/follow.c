/* One request is under way at most: the next one is sent when the caller looks again, so that it
 * gets the frame that is newest then. A connection that is lost comes back by itself, and ZeroMQ's
 * monitor tells of both. */
#include "cloth/live/live.h"
#include "cloth/live/scene.h"
#include "cloth/live/socket.h"

#include "cloth/base/clock.h"
#include "cloth/base/memory.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PATH = 300, STATE = 500 };
static const double END_OLD = 2; /* s: a run that ends is gone by then */

struct live_follower {
    struct live_socket link;
    char host[PATH];
    bool connected, asked; /* asked: an answer is due */
    double ended;          /* s: when the run said so; 0: it has not */
    uint64_t run, scene;   /* had; 0: none */
    uint64_t next;         /* the first frame that is not had */
    double time;           /* s: of the one before it */
    struct output_cache cache,
        coming; /* coming: of a scene without a frame so far, or adopted yet */
    bool is_coming;
    char state[STATE];
};

/* ---- Opening ---- */

/* ZMQ_IMMEDIATE would drop messages received before a connection ended, such as the last frame. */
static int live_follow_start(struct live_follower *follower, struct cloth_error *error)
{
    const int again = 250; /* ms between two attempts to connect */
    char endpoint[PATH + 10];
    struct live_socket *link = &follower->link;
    snprintf(endpoint, sizeof endpoint, "tcp://%s", follower->host);
    if (live_socket_open(link, "--connect", ZMQ_DEALER, follower->host, LIVE_MAX_BYTES,
                         ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_DISCONNECTED, error))
        return CLOTH_E_LIBRARY;
    if (zmq_setsockopt(link->socket, ZMQ_RECONNECT_IVL, &again, sizeof again))
        return live_socket_fail(link, "set up its socket", error);
    return zmq_connect(link->socket, endpoint)
               ? cloth_fail(error, CLOTH_E_INPUT, "--connect %s: %s", follower->host,
                            zmq_strerror(errno))
               : 0;
}

int live_follow_open(struct live_follower **follower, const char *host, struct cloth_error *error)
{
    struct live_follower *made = *follower = cloth_alloc(1, sizeof *made, error);
    if (!made)
        return CLOTH_E_MEMORY;
    snprintf(made->host, sizeof made->host, "%s", host);
    return live_follow_start(made, error);
}

/* ---- What comes ---- */

static void take_events(struct live_follower *follower)
{
    for (uint16_t event; live_socket_event(&follower->link, &event);) {
        follower->connected = event == ZMQ_EVENT_HANDSHAKE_SUCCEEDED;
        follower->asked = false;
        follower->ended = follower->connected ? 0 : follower->ended;
    }
}

/* A run that has ended is not asked, unless the end is older than END_OLD: then it was that of an
 * earlier run. */
static bool may_ask(const struct live_follower *follower)
{
    return follower->connected && !follower->asked &&
           (!(follower->ended > 0) || cloth_seconds() - follower->ended > END_OLD);
}

static void ask(struct live_follower *follower)
{
    follower->ended = 0;
    const struct live_message request = {.kind = LIVE_REQUEST,
                                         .run = follower->run,
                                         .scene = follower->scene,
                                         .number = follower->next};
    unsigned char bytes[LIVE_REQUEST_BYTES];
    const size_t n = live_message_write(bytes, &request);
    follower->asked = zmq_send(follower->link.socket, bytes, n, ZMQ_DONTWAIT) >= 0;
}

static int follow_take_scene(struct live_follower *follower, const struct live_message *scene,
                             struct cloth_error *error)
{
    if (follower->is_coming)
        output_cache_close(&follower->coming);
    follower->is_coming = false;
    const int code = live_scene_open(scene, &follower->coming, error);
    if (code)
        return code;
    follower->is_coming = true;
    follower->next = scene->run == follower->run ? follower->next : 0;
    follower->run = scene->run;
    follower->scene = scene->scene;
    return 0;
}

/* One of a run that is not the scene's comes when runs change: the next answer is the scene. */
static int live_follow_take_frame(struct live_follower *follower, const struct live_message *frame,
                                  enum live_news *news, struct cloth_error *error)
{
    if (!follower->scene || frame->run != follower->run)
        return 0;
    const int code =
        live_frame_show(frame, follower->is_coming ? &follower->coming : &follower->cache, error);
    if (code)
        return code;
    follower->next = frame->number + 1;
    follower->time = frame->time;
    *news = follower->is_coming ? LIVE_NEW_SCENE : LIVE_NEW_FRAME;
    return 0;
}

static int take_message(struct live_follower *follower, zmq_msg_t *message, enum live_news *news,
                        struct cloth_error *error)
{
    struct cloth_error inner = {0};
    struct live_message said;
    int code = live_message_read(zmq_msg_data(message), zmq_msg_size(message), &said, &inner);
    follower->asked = false;
    if (!code && said.kind == LIVE_SCENE)
        code = follow_take_scene(follower, &said, &inner);
    else if (!code && said.kind == LIVE_FRAME)
        code = live_follow_take_frame(follower, &said, news, &inner);
    else if (!code && said.kind == LIVE_END)
        follower->ended = cloth_seconds();
    return code ? cloth_fail(error, code, "--connect %s: %s", follower->host, inner.text) : 0;
}

/* Parts beyond the first are no message of ours: each is read as one. */
static int take_messages(struct live_follower *follower, enum live_news *news,
                         struct cloth_error *error)
{
    zmq_msg_t message;
    int code = 0;
    zmq_msg_init(&message);
    while (!code && *news == LIVE_NOTHING &&
           zmq_msg_recv(&message, follower->link.socket, ZMQ_DONTWAIT) >= 0)
        code = take_message(follower, &message, news, error);
    zmq_msg_close(&message);
    return code;
}

int live_follow(struct live_follower *follower, double seconds, enum live_news *news,
                struct cloth_error *error)
{
    const double end = cloth_seconds() + seconds;
    int code = 0;
    for (*news = LIVE_NOTHING; !code && *news == LIVE_NOTHING;) {
        zmq_pollitem_t item[2] = {{.socket = follower->link.socket, .events = ZMQ_POLLIN},
                                  {.socket = follower->link.monitor, .events = ZMQ_POLLIN}};
        code = take_messages(follower, news, error); /* messages received precede the events */
        take_events(follower);
        const double left = end - cloth_seconds();
        if (!code && may_ask(follower) && *news == LIVE_NOTHING)
            ask(follower);
        if (!(left > 0) || code || *news != LIVE_NOTHING)
            break;
        const double nap = follower->ended > 0 ? fmin(left, END_OLD) : left;
        if (zmq_poll(item, 2, (long)ceil(1e3 * nap)) < 0 && errno != EINTR)
            code = live_socket_fail(&follower->link, "wait", error);
    }
    return code;
}

/* ---- Results ---- */

struct output_cache *live_follow_cache(struct live_follower *follower)
{
    if (follower->is_coming) {
        output_cache_close(&follower->cache);
        follower->cache = follower->coming;
        follower->coming = (struct output_cache){0};
        follower->is_coming = false;
    }
    return &follower->cache;
}

uint64_t live_follow_frame(const struct live_follower *follower)
{
    return follower->next ? follower->next - 1 : 0;
}

const char *live_follow_state(struct live_follower *follower, bool *waits)
{
    const bool sends = follower->connected && !(follower->ended > 0);
    char *to = follower->state;
    *waits = !sends || !follower->next;
    if (!*waits)
        snprintf(to, STATE, "frame %" PRIu64 ", %.4g s, live from %s", follower->next - 1,
                 follower->time, follower->host);
    else if (sends)
        snprintf(to, STATE, "connected to %s: waits for the first frame", follower->host);
    else if (!follower->next)
        snprintf(to, STATE, "waits for a run at %s", follower->host);
    else
        snprintf(to, STATE, "the run %s at frame %" PRIu64 "; waits for the next one at %s",
                 follower->ended > 0 ? "has ended" : "was lost", follower->next - 1,
                 follower->host);
    return to;
}

void live_follow_close(struct live_follower **follower)
{
    struct live_follower *gone = *follower;
    *follower = NULL;
    if (!gone)
        return;
    live_socket_close(&gone->link);
    output_cache_close(&gone->cache);
    if (gone->is_coming)
        output_cache_close(&gone->coming);
    free(gone);
}
