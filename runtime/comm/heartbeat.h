#ifndef DUITE_COMM_HEARTBEAT_H
#define DUITE_COMM_HEARTBEAT_H

#include "runtime/base/monitor.h"

#include <mpi.h>
#include <stdbool.h>

/* Ranks stand in a ring: each sends the next one a heartbeat sixteen times in `seconds`, and
 * listens to the one before it. If that one is not heard at sixteen looks in a row it is lost: then
 * communication breaks, and abort messages tell all others. So a rank sends and hears one message a
 * look, however many there are; and wherever the ring is cut in two, both parts find out, since on
 * each side somebody listens to the other.
 *
 * The monitor does it, not the poll of the workers: all of them may be inside long bodies, and such
 * a rank is not lost. It touches MPI under the lock, like everybody, and the path of a task or a
 * message not at all. Silence is counted in looks, not in seconds, so that the time in which this
 * process itself was stopped, or got no core, is nobody's silence. */
enum { COMM_SILENT_LOOKS = 16, COMM_HOST_NAME = 64 };

struct comm_heartbeat {
    struct base_monitor *monitor;
    struct base_look look;
    double seconds;            /* until a silent rank is lost; 0: nobody listens */
    char host[COMM_HOST_NAME]; /* of the rank before this one */
    /* Under the lock of the comm: */
    bool last_sent, last_heard;
    unsigned silent; /* looks in a row */
    char out, in;    /* a heartbeat, or the last one */
    MPI_Request sent, heard;
};

struct comm;

/* Registers with the monitor, which does nothing before comm_heartbeat_open. comm_heartbeat_stop is
 * due all the same. Errors: DUITE_E_SYSTEM, memory. */
int comm_heartbeat_start(struct comm *comm, struct base_monitor *monitor);

/* Under the lock of the comm: heartbeats begin, if `seconds`, the same on all ranks, is > 0.
 * `host`: of the rank before this one. */
void comm_heartbeat_open(struct comm *comm, double seconds, const char *host);

/* No other thread but the monitor is left, which looks no more. With all ranks at their end, and
 * communication whole or broken but not lost, takes leave of both neighbours, so that no heartbeat
 * is on its way afterwards. */
void comm_heartbeat_stop(struct comm *comm);

#endif
