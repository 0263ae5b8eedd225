/* By ZMQ_IPV6 `localhost' would be ::1 alone, where a run does not listen: so it is set for
 * addresses of IPv6 only. */
#include "cloth/live/socket.h"

#include <errno.h>
#include <string.h>

static const char MONITOR[] = "inproc://connections";

int live_socket_fail(const struct live_socket *socket, const char *what, struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_LIBRARY, "%s: ZeroMQ cannot %s: %s", socket->option, what,
                      zmq_strerror(errno));
}

int live_socket_open(struct live_socket *socket, const char *option, int type, const char *address,
                     int64_t most, int events, struct cloth_error *error)
{
    const int none = 0, yes = 1, six = *address == '[';
    socket->option = option;
    socket->zmq = zmq_ctx_new();
    socket->socket = socket->zmq ? zmq_socket(socket->zmq, type) : NULL;
    socket->monitor = socket->socket ? zmq_socket(socket->zmq, ZMQ_PAIR) : NULL;
    if (!socket->monitor)
        return live_socket_fail(socket, "start", error);
    if (zmq_setsockopt(socket->socket, ZMQ_LINGER, &none, sizeof none) ||
        zmq_setsockopt(socket->socket, ZMQ_MAXMSGSIZE, &most, sizeof most) ||
        zmq_setsockopt(socket->socket, ZMQ_IPV6, &six, sizeof six) ||
        zmq_setsockopt(socket->socket, ZMQ_TCP_KEEPALIVE, &yes, sizeof yes))
        return live_socket_fail(socket, "set up its socket", error);
    if (zmq_setsockopt(socket->monitor, ZMQ_LINGER, &none, sizeof none) ||
        zmq_socket_monitor(socket->socket, MONITOR, events) ||
        zmq_connect(socket->monitor, MONITOR))
        return live_socket_fail(socket, "watch its socket", error);
    return 0;
}

/* An event's first part is its number and a value, the second one the address. */
bool live_socket_event(const struct live_socket *socket, uint16_t *event)
{
    unsigned char bytes[300];
    if (zmq_recv(socket->monitor, bytes, sizeof bytes, ZMQ_DONTWAIT) < (int)sizeof *event)
        return false;
    memcpy(event, bytes, sizeof *event);
    zmq_recv(socket->monitor, bytes, sizeof bytes, ZMQ_DONTWAIT);
    return true;
}

void live_socket_close(struct live_socket *socket)
{
    if (socket->monitor)
        zmq_close(socket->monitor);
    if (socket->socket)
        zmq_close(socket->socket);
    if (socket->zmq)
        zmq_ctx_term(socket->zmq);
}
