/* The other side of a live view, for tests.
 *
 *   live_peer follow HOST:PORT          each frame that comes, until the run ends: number and hash;
 *                                       fails where none comes for two minutes
 *   live_peer frames DIR                the same of a folder of frames
 *   live_peer send HOST:PORT WHAT       sends WHAT ten times; prints the version of an answer
 *   live_peer crowd ADDRESS:PORT N      connects N times, says so, and then sends nothing
 *   live_peer serve WHAT                prints a free port, and answers each request there by WHAT
 *
 * WHAT: foreign (bytes that are no message), version (a message of the next version), large (a
 * message of a megabyte), parts (too many of them). */
#include "cloth/base/bytes.h"
#include "cloth/live/live.h"
#include "cloth/live/message.h"

#include <arpa/inet.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>
#include <zmq.h>

enum { LARGE = 1 << 20, REPEAT = 10, PATIENCE = 5000, LINGER = 100 /* ms */, LOOKS = 1200 };

static int fail(const char *what)
{
    fprintf(stderr, "live_peer: %s\n", what);
    return 1;
}

static void print_frame(uint64_t number, const double *x, size_t n_vertices)
{
    printf("%" PRIu64 " %016" PRIx64 "\n", number,
           (uint64_t)XXH64(x, 3 * n_vertices * sizeof *x, 0));
    fflush(stdout);
}

static int follow(const char *host)
{
    struct live_follower *follower;
    struct cloth_error error = {0};
    bool waits = true, begun = false;
    int code = live_follow_open(&follower, host, &error);
    for (int looks = 0; !code && !(begun && waits); looks++) {
        enum live_news news;
        code = live_follow(follower, 0.1, &news, &error);
        if (!code && !begun && looks == LOOKS)
            code = cloth_fail(&error, CLOTH_E_INPUT, "no frame comes from %s", host);
        live_follow_state(follower, &waits);
        if (code || news == LIVE_NOTHING)
            continue;
        const struct output_cache *cache = live_follow_cache(follower);
        print_frame(live_follow_frame(follower), cache->held, cache->mesh.n_vertices);
        begun = true;
        waits = false;
    }
    if (!code)
        printf("# %s\n", live_follow_state(follower, &waits));
    live_follow_close(&follower);
    return code ? fail(error.text) : 0;
}

static int print_frames(const char *folder)
{
    struct output_cache cache;
    struct cloth_error error = {0};
    int code = output_cache_open(&cache, folder, &error);
    if (code)
        return fail(error.text);
    const size_t n = cache.mesh.n_vertices;
    double *x = calloc(3 * n, sizeof *x);
    for (uint64_t i = 0; x && i < cache.n_frames && !code; i++) {
        code = output_cache_frame(&cache, i, x, &error);
        print_frame(i, x, n);
    }
    free(x);
    output_cache_close(&cache);
    return code ? fail(error.text) : 0;
}

static int send_what(void *socket, const char *what)
{
    static unsigned char bytes[LARGE];
    const struct live_message request = {.kind = LIVE_REQUEST};
    size_t n = live_message_write(bytes, &request);
    if (!strcmp(what, "version"))
        bytes[8] = LIVE_VERSION + 1;
    else if (!strcmp(what, "foreign"))
        memcpy(bytes, "GET / HTTP/1.1\r\n", 16);
    else if (!strcmp(what, "large"))
        n = LARGE;
    else if (strcmp(what, "parts") != 0)
        return -1;
    for (int i = 0; !strcmp(what, "parts") && i < 5; i++)
        if (zmq_send(socket, bytes, n, ZMQ_SNDMORE) < 0)
            return -1;
    return zmq_send(socket, bytes, n, 0);
}

/* 0: nothing came. */
static unsigned receive_version(void *socket)
{
    unsigned char bytes[LIVE_HEADER];
    return zmq_recv(socket, bytes, sizeof bytes, 0) >= LIVE_HEADER ? cloth_get_u32(bytes + 8) : 0;
}

static int send_to(void *zmq, const char *host, const char *what)
{
    char endpoint[200];
    const int patience = PATIENCE, linger = LINGER;
    void *socket = zmq_socket(zmq, ZMQ_DEALER);
    snprintf(endpoint, sizeof endpoint, "tcp://%s", host);
    int code = zmq_setsockopt(socket, ZMQ_RCVTIMEO, &patience, sizeof patience) ||
               zmq_setsockopt(socket, ZMQ_LINGER, &linger, sizeof linger) ||
               zmq_connect(socket, endpoint);
    for (int i = 0; i < REPEAT && !code; i++)
        code = send_what(socket, what) < 0;
    if (!code)
        printf("version %u\n", strcmp(what, "version") ? 0 : receive_version(socket));
    zmq_close(socket);
    return code ? fail(zmq_strerror(zmq_errno())) : 0;
}

static int print_port(void *socket)
{
    char endpoint[200] = "";
    size_t n = sizeof endpoint;
    if (zmq_bind(socket, "tcp://127.0.0.1:*") ||
        zmq_getsockopt(socket, ZMQ_LAST_ENDPOINT, endpoint, &n))
        return fail(zmq_strerror(zmq_errno()));
    printf("%s\n", strrchr(endpoint, ':') + 1);
    fflush(stdout);
    return 0;
}

/* Until it is killed. */
static int serve(void *zmq, const char *what)
{
    void *socket = zmq_socket(zmq, ZMQ_ROUTER);
    int code = print_port(socket);
    while (!code) {
        char id[300], body[300];
        const int n = zmq_recv(socket, id, sizeof id, 0);
        if (n < 0 || zmq_recv(socket, body, sizeof body, 0) < 0 ||
            zmq_send(socket, id, (size_t)n, ZMQ_SNDMORE) < 0 || send_what(socket, what) < 0)
            code = fail("serve");
    }
    zmq_close(socket);
    return code;
}

/* Until it is killed. */
static int crowd(const char *host, int n)
{
    const char *colon = strchr(host, ':');
    char address[64];
    struct sockaddr_in to = {.sin_family = AF_INET};
    snprintf(address, sizeof address, "%.*s", colon ? (int)(colon - host) : 0, host);
    if (!colon || inet_pton(AF_INET, address, &to.sin_addr) != 1)
        return fail("no address");
    to.sin_port = htons((uint16_t)atoi(colon + 1));
    for (int i = 0; i < n; i++) {
        const int one = socket(AF_INET, SOCK_STREAM, 0);
        if (one < 0)
            return fail("no socket");
        if (connect(one, (const struct sockaddr *)&to, sizeof to) != 0)
            close(one); /* nobody listens now */
    }
    printf("connected\n");
    fflush(stdout);
    return pause();
}

int main(int argc, char **argv)
{
    const char *mode = argc > 1 ? argv[1] : "";
    void *zmq = zmq_ctx_new();
    int code = 2;
    if (!strcmp(mode, "follow") && argc == 3)
        code = follow(argv[2]);
    else if (!strcmp(mode, "frames") && argc == 3)
        code = print_frames(argv[2]);
    else if (!strcmp(mode, "send") && argc == 4)
        code = send_to(zmq, argv[2], argv[3]);
    else if (!strcmp(mode, "crowd") && argc == 4)
        code = crowd(argv[2], atoi(argv[3]));
    else if (!strcmp(mode, "serve") && argc == 3)
        code = serve(zmq, argv[2]);
    zmq_ctx_term(zmq);
    return code;
}
