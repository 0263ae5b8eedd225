/* ZeroMQ accepts every connection, and would leave no descriptor for the run's files. So a monitor
 * reports each connection. If there are too many, the socket is closed with all of them, and opens
 * again a moment later: viewers come back by themselves. Viewers get a quarter of all
 * descriptors. */
#include "cloth/live/publisher.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

static const double SHUT = 1; /* s */
enum { MOST = 256, SHARE = 4 };

int live_connections_most(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur > MOST * SHARE)
        return MOST;
    return (int)limit.rlim_cur / SHARE;
}

static void connections_count(const struct live_socket *socket, struct live_door *door)
{
    for (uint16_t event; live_socket_event(socket, &event);)
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
    connections_count(&p->link, door);
    if (!door->is_shut && door->n > door->most && !zmq_unbind(p->link.socket, endpoint)) {
        door->is_shut = true;
        door->opens = now + SHUT;
        connections_warn(p);
    } else if (door->is_shut && now >= door->opens) {
        door->is_shut = zmq_bind(p->link.socket, endpoint) != 0;
    }
}
