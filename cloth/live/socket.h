#ifndef CLOTH_LIVE_SOCKET_H
#define CLOTH_LIVE_SOCKET_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stdint.h>
#include <zmq.h>

/* A ZeroMQ socket of the live view, and a monitor that tells of its connections. Local. */
struct live_socket {
    const char *option; /* it begins errors: "--live" or "--connect" */
    void *zmq, *socket, *monitor;
};

/* type, events: ZeroMQ's; address: with a number in brackets it is one of IPv6; most: bytes of a
 * message that is taken. In any case live_socket_close follows. Error: CLOTH_E_LIBRARY. */
int live_socket_open(struct live_socket *socket, const char *option, int type, const char *address,
                     int64_t most, int events, struct cloth_error *error);
/* Takes a message of the monitor, and its event. False: there is none. */
bool live_socket_event(const struct live_socket *socket, uint16_t *event);
void live_socket_close(struct live_socket *socket);

/* "OPTION: ZeroMQ cannot WHAT: its reason", as CLOTH_E_LIBRARY. */
int live_socket_fail(const struct live_socket *socket, const char *what, struct cloth_error *error);

#endif
