/* The thread that has the socket. A viewer is answered when it asks and there is something that it
 * lacks; only the end of the run is sent unasked. All viewers share the bytes of a message. */
#include "cloth/base/clock.h"
#include "cloth/live/publisher.h"
#include "cloth/live/scene.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double LATELY = 2; /* s: a viewer that asked or was answered within it is awake */
static const double GRACE = 1;  /* s that viewers have at the end */
enum { LINGER = 2000 };         /* ms that ZeroMQ then has to send its messages */
enum { SHUT = 100 };            /* ms between two looks while the door is shut */

/* ---- News of the run ---- */

/* Takes over messages of the run. True: it has ended. */
static bool take_news(struct live_publisher *p)
{
    uint64_t wakes;
    const bool woken = read(p->wake, &wakes, sizeof wakes) > 0;
    if (!woken)
        return false;
    pthread_mutex_lock(&p->lock);
    if (zmq_msg_size(&p->scene.message)) {
        zmq_msg_move(&p->scene_message, &p->scene.message);
        p->scene_number = p->scene.number;
    }
    if (zmq_msg_size(&p->frame.message)) {
        zmq_msg_move(&p->frame_message, &p->frame.message);
        p->frames = p->frame.number + 1;
        p->is_sealed = false;
    }
    const bool ends = p->ends;
    pthread_mutex_unlock(&p->lock);
    return ends;
}

/* The frame's message gets its header when the first viewer asks. */
static zmq_msg_t *sealed_frame(struct live_publisher *p)
{
    zmq_msg_t *frame = &p->frame_message;
    if (!p->is_sealed)
        live_message_seal(zmq_msg_data(frame), zmq_msg_size(frame), LIVE_FRAME);
    p->is_sealed = true;
    return frame;
}

/* ---- Answers ---- */

/* The socket drops messages that a viewer has no room for; no call waits. */
static void send_message(struct live_publisher *p, const struct live_viewer *to, zmq_msg_t *message)
{
    zmq_msg_t copy;
    zmq_send(p->link.socket, to->id, to->n_id, ZMQ_SNDMORE | ZMQ_DONTWAIT);
    if (to->delimited)
        zmq_send(p->link.socket, "", 0, ZMQ_SNDMORE | ZMQ_DONTWAIT);
    zmq_msg_init(&copy);
    zmq_msg_copy(&copy, message);
    if (zmq_msg_send(&copy, p->link.socket, ZMQ_DONTWAIT) < 0)
        zmq_msg_close(&copy);
}

static void send_end(struct live_publisher *p, const struct live_viewer *to)
{
    const struct live_message end = {.kind = LIVE_END, .run = p->run, .number = p->frames};
    zmq_msg_t message;
    if (zmq_msg_init_size(&message, LIVE_REQUEST_BYTES))
        return;
    live_message_write(zmq_msg_data(&message), &end);
    send_message(p, to, &message);
    zmq_msg_close(&message);
}

/* Answers if there is something that the viewer lacks. */
static void answer_viewer(struct live_publisher *p, struct live_viewer *viewer)
{
    const bool lacks_scene = viewer->scene != p->scene_number;
    if (!viewer->waits || !p->scene_number || (!lacks_scene && p->frames <= viewer->next))
        return;
    send_message(p, viewer, lacks_scene ? &p->scene_message : sealed_frame(p));
    viewer->waits = false;
    viewer->seen = cloth_seconds();
    if (!lacks_scene)
        viewer->next = p->frames;
}

/* The viewer's entry, else the one that was active longest ago. */
static struct live_viewer *find_viewer(struct live_publisher *p, const struct live_viewer *who)
{
    struct live_viewer *oldest = p->viewer;
    for (int i = 0; i < LIVE_VIEWERS; i++) {
        struct live_viewer *viewer = p->viewer + i;
        if (viewer->n_id == who->n_id && !memcmp(viewer->id, who->id, who->n_id))
            return viewer;
        if (viewer->seen < oldest->seen)
            oldest = viewer;
    }
    return oldest;
}

static void warn_once(struct live_publisher *p, bool *warned, const char *text)
{
    char line[400];
    snprintf(line, sizeof line, "--live: what came to port %s is left without an answer: %.200s",
             strrchr(p->address, ':') + 1, text);
    if (!*warned)
        p->warn(line);
    *warned = true;
}

static void take_request(struct live_publisher *p, struct live_viewer *who, zmq_msg_t *body)
{
    struct cloth_error error = {0};
    struct live_message request;
    if (live_message_read(zmq_msg_data(body), zmq_msg_size(body), &request, &error) ||
        request.kind != LIVE_REQUEST) {
        cloth_fail(&error, CLOTH_E_INPUT, "it is no request of a viewer");
        const bool other = request.version && request.version != LIVE_VERSION;
        if (other)
            send_end(p, who); /* its version tells the viewer */
        warn_once(p, other ? &p->warned_version : &p->warned_bytes, error.text);
        return;
    }
    struct live_viewer *viewer = find_viewer(p, who);
    *viewer = *who;
    viewer->seen = cloth_seconds();
    viewer->scene = request.run == p->run ? request.scene : 0;
    viewer->next = request.run == p->run ? request.number : 0;
    viewer->waits = true;
}

/* ---- Requests ---- */

/* Receives a message: its sender, and its last part. false: there is none. *good: it has the parts
 * of a request. */
static bool receive(struct live_publisher *p, struct live_viewer *who, zmq_msg_t *part, bool *good)
{
    int parts = 0;
    bool more = true;
    *who = (struct live_viewer){0};
    for (; more; parts++) {
        if (parts == 2)
            who->delimited = !zmq_msg_size(part);
        if (zmq_msg_recv(part, p->link.socket, ZMQ_DONTWAIT) < 0)
            return false;
        more = zmq_msg_more(part);
        if (parts == 0 && zmq_msg_size(part) <= LIVE_ID) {
            who->n_id = zmq_msg_size(part);
            memcpy(who->id, zmq_msg_data(part), who->n_id);
        }
    }
    *good = who->n_id && (parts == 2 || (parts == 3 && who->delimited));
    return true;
}

/* Takes the waiting requests, up to a limit: frames must be served, too. */
static void take_requests(struct live_publisher *p)
{
    struct live_viewer who;
    zmq_msg_t part;
    bool good = false;
    zmq_msg_init(&part);
    for (int i = 0; i < LIVE_VIEWERS && receive(p, &who, &part, &good); i++)
        if (good)
            take_request(p, &who, &part);
    zmq_msg_close(&part);
}

/* ---- The end ---- */

/* True if a viewer that is awake has not asked for the last frame yet. */
static bool is_behind(const struct live_publisher *p, double at)
{
    for (int i = 0; i < LIVE_VIEWERS; i++) {
        const struct live_viewer *viewer = p->viewer + i;
        if (viewer->n_id && !viewer->waits && viewer->next < p->frames &&
            at - viewer->seen < LATELY)
            return true;
    }
    return false;
}

static void end_all(struct live_publisher *p)
{
    const int linger = LINGER;
    const double at = cloth_seconds();
    for (int i = 0; i < LIVE_VIEWERS; i++) {
        const struct live_viewer *viewer = p->viewer + i;
        if (!viewer->waits && !(viewer->n_id && at - viewer->seen < LATELY))
            continue;
        send_end(p, viewer);
        zmq_setsockopt(p->link.socket, ZMQ_LINGER, &linger, sizeof linger);
    }
}

void *live_serve(void *context)
{
    struct live_publisher *p = context;
    double ended = 0;
    for (;;) {
        zmq_pollitem_t item[3] = {{.socket = p->link.socket, .events = ZMQ_POLLIN},
                                  {.fd = p->wake, .events = ZMQ_POLLIN},
                                  {.socket = p->link.monitor, .events = ZMQ_POLLIN}};
        const bool ending = ended > 0;
        if (zmq_poll(item, 3, ending ? 10 : p->door.is_shut ? SHUT : -1) < 0 && errno != EINTR)
            break;
        live_connections_look(p, cloth_seconds());
        const bool ends = take_news(p);
        take_requests(p);
        for (int i = 0; i < LIVE_VIEWERS; i++)
            answer_viewer(p, p->viewer + i);
        if (!ending && ends)
            ended = cloth_seconds();
        if (ended > 0 && (!is_behind(p, ended) || cloth_seconds() - ended > GRACE))
            break;
    }
    end_all(p);
    return NULL;
}
