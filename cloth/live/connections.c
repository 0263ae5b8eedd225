/* ZeroMQ accepts every connection, and would leave no descriptor for the run's files. So a monitor
 * reports each connection. If there are too many, the socket is closed with all of them, and opens
 * again a moment later: viewers come back by themselves. Viewers get a quarter of all
 * descriptors. */
#include "cloth/live/publisher.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

static const char MONITOR[] = "inproc://connections";
static const double SHUT = 1; /* s */
enum { MOST = 256, SHARE = 4 };

static int most_connections(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur > MOST * SHARE)
        return MOST;
    return (int)limit.rlim_cur / SHARE;
}

int live_connections_open(struct live_publisher *p)
{
    const int events =
        ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_ACCEPT_FAILED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_CLOSED;
    p->door.most = most_connections();
    p->door.monitor = zmq_socket(p->zmq, ZMQ_PAIR);
    return p->door.monitor && !zmq_socket_monitor(p->socket, MONITOR, events) &&
                   !zmq_connect(p->door.monitor, MONITOR)
               ? 0
               : -1;
}

void live_connections_close(struct live_publisher *p)
{
    if (p->door.monitor)
        zmq_close(p->door.monitor);
}

/* An event's first part is its number and a value, the second one the address. false: no event. */
static bool take_event(const struct live_door *door, uint16_t *event)
{
    unsigned char bytes[LIVE_ADDRESS];
    if (zmq_recv(door->monitor, bytes, sizeof bytes, ZMQ_DONTWAIT) < (int)sizeof *event)
        return false;
    memcpy(event, bytes, sizeof *event);
    zmq_recv(door->monitor, bytes, sizeof bytes, ZMQ_DONTWAIT);
    return true;
}

static void connections_count(struct live_door *door)
{
    for (uint16_t event; take_event(door, &event);)
        if (event == ZMQ_EVENT_ACCEPTED)
            door->n++;
        else if (event == ZMQ_EVENT_ACCEPT_FAILED)
            door->n = door->most + 1;
        else if (event == ZMQ_EVENT_CLOSED)
            door->n = 0;
        else if (door->n)
            door->n--;
}

static void connections_warn(struct live_publisher *p)
{
    char line[200];
    snprintf(line, sizeof line,
             "--live: more than %d connections came to port %s: all are closed, and viewers "
             "connect again (this is said once)",
             p->door.most, strrchr(p->address, ':') + 1);
    if (!p->door.warned)
        p->warn(line);
    p->door.warned = true;
}

void live_connections_look(struct live_publisher *p, double now)
{
    struct live_door *door = &p->door;
    char endpoint[LIVE_ADDRESS + 8];
    snprintf(endpoint, sizeof endpoint, "tcp://%s", p->address);
    connections_count(door);
    if (!door->is_shut && door->n > door->most && !zmq_unbind(p->socket, endpoint)) {
        door->is_shut = true;
        door->opens = now + SHUT;
        connections_warn(p);
    } else if (door->is_shut && now >= door->opens) {
        door->is_shut = zmq_bind(p->socket, endpoint) != 0;
    }
}
