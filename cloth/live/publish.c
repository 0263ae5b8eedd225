/* The run makes a message of a frame; the newest one waits under the lock until the thread takes
 * it, or the next one replaces it. So the run copies a frame once, and waits for no viewer. */
#include "cloth/base/memory.h"
#include "cloth/base/thread.h"
#include "cloth/live/publisher.h"
#include "cloth/live/scene.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/random.h>
#include <unistd.h>

const char *live_lacks(void)
{
    return NULL;
}

/* ---- Opening ---- */

static int fail_bind(const char *address, struct cloth_error *error)
{
    const char *why = zmq_strerror(errno);
    if (errno == EADDRINUSE)
        why = "the port is in use, perhaps by another run: give another one, or 0 for any free one";
    else if (errno == EADDRNOTAVAIL || errno == ENODEV || errno == EINVAL)
        why = "this machine has no such address; give one of its own as a number, such as "
              "127.0.0.1, or `*' for all";
    else if (errno == EACCES)
        why = "ports below 1024 are root's: give another one";
    return cloth_fail(error, CLOTH_E_INPUT, "--live %s: %s", address, why);
}

static int listen_on(struct live_publisher *publisher, const char *address,
                     struct cloth_error *error)
{
    static const char scheme[] = "tcp://";
    char endpoint[LIVE_ADDRESS];
    size_t n = sizeof endpoint;
    const bool whole = strchr(address, ':');
    if (!live_is_address(address))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--live %s: PORT, up to 65535, or ADDRESS:PORT is expected", address);
    const int length =
        snprintf(endpoint, sizeof endpoint, "%s%s%s", scheme, whole ? "" : "127.0.0.1:", address);
    if (length >= (int)sizeof endpoint)
        return cloth_fail(error, CLOTH_E_INPUT, "--live %.40s...: no address is so long", address);
    if (zmq_bind(publisher->link.socket, endpoint))
        return fail_bind(address, error);
    if (zmq_getsockopt(publisher->link.socket, ZMQ_LAST_ENDPOINT, endpoint, &n))
        return live_socket_fail(&publisher->link, "tell its port", error);
    memcpy(publisher->address, endpoint + strlen(scheme), n - strlen(scheme));
    return 0;
}

/* Messages to a viewer beyond a few are dropped; viewers' messages are short. */
static int publish_start(struct live_publisher *publisher, const char *address,
                         struct cloth_error *error)
{
    enum { LONGEST = 256 }; /* bytes */
    const int few = 4, many = 16;
    struct live_socket *link = &publisher->link;
    publisher->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (publisher->wake < 0 || getrandom(&publisher->run, sizeof publisher->run, 0) < 0)
        return cloth_fail(error, CLOTH_E_LIBRARY, "--live: %s", strerror(errno));
    publisher->run |= 1; /* not 0 */
    publisher->door.most = live_connections_most();
    if (live_socket_open(link, "--live", ZMQ_ROUTER, address, LONGEST, LIVE_CONNECTIONS, error))
        return CLOTH_E_LIBRARY;
    if (zmq_setsockopt(link->socket, ZMQ_SNDHWM, &few, sizeof few) ||
        zmq_setsockopt(link->socket, ZMQ_RCVHWM, &many, sizeof many))
        return live_socket_fail(link, "set up its socket", error);
    const int code = listen_on(publisher, address, error);
    if (code)
        return code;
    const int failed = cloth_thread_start(&publisher->thread, live_serve, publisher);
    publisher->has_thread = !failed;
    return failed ? cloth_fail(error, CLOTH_E_LIBRARY, "--live: no thread: %s", strerror(failed))
                  : 0;
}

int live_publish_open(struct live_publisher **publisher, const char *address,
                      void (*warn)(const char *text), struct cloth_error *error)
{
    struct live_publisher *made = *publisher = cloth_alloc(1, sizeof *made, error);
    if (!made)
        return CLOTH_E_MEMORY;
    made->wake = -1;
    made->warn = warn;
    pthread_mutex_init(&made->lock, NULL);
    zmq_msg_init(&made->scene.message);
    zmq_msg_init(&made->frame.message);
    zmq_msg_init(&made->scene_message);
    zmq_msg_init(&made->frame_message);
    const int code = publish_start(made, address, error);
    if (code)
        live_publish_close(publisher);
    return code;
}

const char *live_publish_address(const struct live_publisher *publisher)
{
    return publisher->address;
}

/* ---- Publishing ---- */

static void wake(const struct live_publisher *publisher)
{
    const uint64_t one = 1;
    if (write(publisher->wake, &one, sizeof one) < 0 && errno != EAGAIN)
        publisher->warn("--live: its thread cannot be woken; viewers may wait in vain");
}

static int publish_make_room(struct live_publisher *publisher, const struct output_setup *setup,
                             struct cloth_error *error)
{
    uint32_t most = 0;
    for (size_t i = 0; i < setup->n_meshes; i++)
        publisher->n_vertices += setup->meshes[i]->n_vertices;
    publisher->n_bodies = setup->posed && setup->bodies ? setup->bodies->n : 0;
    publisher->posed = cloth_alloc(publisher->n_bodies, sizeof *publisher->posed, error);
    for (uint32_t i = 0; publisher->posed && i < publisher->n_bodies; i++) {
        const uint32_t n = contact_bodies_at(setup->bodies, i + 1)->n_vertices;
        publisher->posed[i] = setup->posed[i];
        publisher->n_body_vertices += setup->posed[i] ? n : 0;
        most = setup->posed[i] && n > most ? n : most;
    }
    publisher->place =
        aligned_alloc(CONTACT_ALIGN, (most + most % 2 + 2) * sizeof *publisher->place);
    return publisher->posed && publisher->place
               ? 0
               : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the bodies of --live");
}

/* Replaces what waits for the thread. */
static void publish_hand_over(struct live_publisher *publisher, struct live_newest *newest,
                              zmq_msg_t *message, uint64_t number)
{
    pthread_mutex_lock(&publisher->lock);
    zmq_msg_move(&newest->message, message);
    newest->number = number;
    pthread_mutex_unlock(&publisher->lock);
    zmq_msg_close(message);
    wake(publisher);
}

static void free_bytes(void *bytes, void *hint)
{
    (void)hint;
    free(bytes);
}

int live_publish_scene(struct live_publisher *publisher, const struct output_setup *setup,
                       double begin, struct cloth_error *error)
{
    const uint64_t number = publisher->scenes + 1;
    unsigned char *bytes = NULL;
    size_t n = 0;
    zmq_msg_t message;
    int code = publisher->scenes ? 0 : publish_make_room(publisher, setup, error);
    if (!code)
        code = live_scene_write(setup, publisher->run, number, &bytes, &n, error);
    if (!code && zmq_msg_init_data(&message, bytes, n, free_bytes, NULL))
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the scene of --live");
    if (code) {
        free(bytes);
        return code;
    }
    publisher->scenes = number;
    publisher->bodies = setup->bodies;
    publisher->begin = begin;
    publish_hand_over(publisher, &publisher->scene, &message, number);
    return 0;
}

/* The bodies that change their shape, without the motion of the obstacle. */
static bool put_bodies(const struct live_publisher *publisher, unsigned char *bytes, double time)
{
    size_t at = publisher->n_vertices;
    bool finite = true;
    for (uint32_t i = 0; i < publisher->n_bodies && finite; i++) {
        if (!publisher->posed[i])
            continue;
        const struct contact_body *body = contact_bodies_at(publisher->bodies, i + 1);
        const phys_vec *x = body->n_frames ? publisher->place : contact_body_vertices(body);
        if (body->n_frames)
            contact_body_places(body, time - publisher->begin, publisher->place);
        finite = live_frame_put(bytes, at, body->n_vertices, (const double *)x,
                                sizeof *x / sizeof(double));
        at += body->n_vertices;
    }
    return finite;
}

void live_publish_frame(struct live_publisher *publisher, uint64_t frame, double time,
                        const double *position)
{
    const struct live_message message = {.kind = LIVE_FRAME,
                                         .run = publisher->run,
                                         .scene = publisher->scenes,
                                         .number = frame,
                                         .time = time,
                                         .n_vertices = publisher->n_vertices,
                                         .n_body_vertices = publisher->n_body_vertices};
    zmq_msg_t made;
    if (zmq_msg_init_size(&made, live_frame_bytes(message.n_vertices, message.n_body_vertices)))
        return;
    unsigned char *bytes = zmq_msg_data(&made);
    if (live_frame_write(bytes, &message, position) && put_bodies(publisher, bytes, time))
        publish_hand_over(publisher, &publisher->frame, &made, frame);
    else
        zmq_msg_close(&made);
}

void live_publish_close(struct live_publisher **publisher)
{
    struct live_publisher *gone = *publisher;
    *publisher = NULL;
    if (!gone)
        return;
    if (gone->has_thread) {
        pthread_mutex_lock(&gone->lock);
        gone->ends = true;
        pthread_mutex_unlock(&gone->lock);
        wake(gone);
        pthread_join(gone->thread, NULL);
    }
    zmq_msg_t *const messages[] = {&gone->scene.message, &gone->frame.message, &gone->scene_message,
                                   &gone->frame_message};
    for (size_t i = 0; i < sizeof messages / sizeof *messages; i++)
        zmq_msg_close(messages[i]);
    live_socket_close(&gone->link);
    if (gone->wake >= 0)
        close(gone->wake);
    pthread_mutex_destroy(&gone->lock);
    free(gone->posed);
    free(gone->place);
    free(gone);
}
