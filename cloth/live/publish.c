/* Three rooms for frames: the run fills `spare`, the newest whole frame waits in `frame`, and the
 * thread sends from its own. They are exchanged under the lock, so that the run copies a frame
 * once, and waits for no viewer: for an exchange, or for the copy of a scene. */
#include "cloth/base/memory.h"
#include "cloth/live/publisher.h"
#include "cloth/live/scene.h"

#include <errno.h>
#include <signal.h>
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

static int publish_fail_zmq(const char *what, struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_LIBRARY, "--live: ZeroMQ cannot %s: %s", what,
                      zmq_strerror(errno));
}

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

/* Messages to a viewer beyond four are dropped; viewers' messages are short. */
static int publish_set_options(void *socket, const char *address, struct cloth_error *error)
{
    const int none = 0, yes = 1, few = 4, many = 16, six = *address == '[';
    const int64_t most = 256;
    if (zmq_setsockopt(socket, ZMQ_LINGER, &none, sizeof none) ||
        zmq_setsockopt(socket, ZMQ_SNDHWM, &few, sizeof few) ||
        zmq_setsockopt(socket, ZMQ_RCVHWM, &many, sizeof many) ||
        zmq_setsockopt(socket, ZMQ_MAXMSGSIZE, &most, sizeof most) ||
        zmq_setsockopt(socket, ZMQ_IPV6, &six, sizeof six) ||
        zmq_setsockopt(socket, ZMQ_TCP_KEEPALIVE, &yes, sizeof yes))
        return publish_fail_zmq("set up its socket", error);
    return 0;
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
    if (zmq_bind(publisher->socket, endpoint))
        return fail_bind(address, error);
    if (zmq_getsockopt(publisher->socket, ZMQ_LAST_ENDPOINT, endpoint, &n))
        return publish_fail_zmq("tell its port", error);
    memcpy(publisher->address, endpoint + strlen(scheme), n - strlen(scheme));
    return 0;
}

static int publish_start(struct live_publisher *publisher, const char *address,
                         struct cloth_error *error)
{
    publisher->zmq = zmq_ctx_new();
    publisher->socket = publisher->zmq ? zmq_socket(publisher->zmq, ZMQ_ROUTER) : NULL;
    if (!publisher->socket)
        return publish_fail_zmq("start", error);
    publisher->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (publisher->wake < 0 || getrandom(&publisher->run, sizeof publisher->run, 0) < 0)
        return cloth_fail(error, CLOTH_E_LIBRARY, "--live: %s", strerror(errno));
    publisher->run |= 1; /* not 0 */
    if (live_connections_open(publisher))
        return publish_fail_zmq("count connections", error);
    int code = publish_set_options(publisher->socket, address, error);
    code = code ? code : listen_on(publisher, address, error);
    if (code)
        return code;
    sigset_t all, before; /* signals are for the run's threads */
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&publisher->thread, NULL, live_serve, publisher);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
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
    const size_t bytes = live_frame_bytes(publisher->n_vertices, publisher->n_body_vertices);
    publisher->place =
        aligned_alloc(CONTACT_ALIGN, (most + most % 2 + 2) * sizeof *publisher->place);
    publisher->spare = cloth_alloc(bytes, 1, error);
    publisher->own = cloth_alloc(bytes, 1, error);
    publisher->frame.data = cloth_alloc(bytes, 1, error);
    publisher->frame.n = bytes;
    if (!publisher->place)
        cloth_fail(error, CLOTH_E_MEMORY, "no memory for the bodies of --live");
    return error->code;
}

int live_publish_scene(struct live_publisher *publisher, const struct output_setup *setup,
                       double begin, struct cloth_error *error)
{
    struct live_bytes scene = {.number = publisher->scenes + 1, .fresh = true};
    int code = publisher->scenes ? 0 : publish_make_room(publisher, setup, error);
    if (!code)
        code = live_scene_write(setup, publisher->run, scene.number, &scene.data, &scene.n, error);
    if (code) {
        free(scene.data);
        return code;
    }
    publisher->scenes = scene.number;
    publisher->bodies = setup->bodies;
    publisher->begin = begin;
    pthread_mutex_lock(&publisher->lock);
    free(publisher->scene.data);
    publisher->scene = scene;
    pthread_mutex_unlock(&publisher->lock);
    wake(publisher);
    return 0;
}

/* The bodies that change their shape, without the motion of the obstacle. */
static bool put_bodies(const struct live_publisher *publisher, double time)
{
    size_t at = publisher->n_vertices;
    bool finite = true;
    for (uint32_t i = 0; i < publisher->n_bodies; i++) {
        if (!publisher->posed[i])
            continue;
        const struct contact_body *body = contact_bodies_at(publisher->bodies, i + 1);
        const phys_vec *x = body->n_frames ? publisher->place : contact_body_vertices(body);
        if (body->n_frames)
            contact_body_places(body, time - publisher->begin, publisher->place);
        finite = live_frame_put(publisher->spare, at, body->n_vertices, (const double *)x,
                                sizeof *x / sizeof(double)) &&
                 finite;
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
    if (!live_frame_write(publisher->spare, &message, position) || !put_bodies(publisher, time))
        return;
    pthread_mutex_lock(&publisher->lock);
    unsigned char *older = publisher->frame.data;
    publisher->frame.data = publisher->spare;
    publisher->frame.number = frame;
    publisher->frame.fresh = true;
    publisher->spare = older;
    pthread_mutex_unlock(&publisher->lock);
    wake(publisher);
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
    zmq_msg_close(&gone->scene_message);
    zmq_msg_close(&gone->frame_message);
    live_connections_close(gone);
    if (gone->socket)
        zmq_close(gone->socket);
    if (gone->zmq)
        zmq_ctx_term(gone->zmq);
    if (gone->wake >= 0)
        close(gone->wake);
    pthread_mutex_destroy(&gone->lock);
    free(gone->posed);
    free(gone->place);
    free(gone->spare);
    free(gone->own);
    free(gone->scene.data);
    free(gone->frame.data);
    free(gone);
}
