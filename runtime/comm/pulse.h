#ifndef DUITE_COMM_PULSE_H
#define DUITE_COMM_PULSE_H

#include <mpi.h>
#include <pthread.h>
#include <stdbool.h>

/* Ranks stand in a ring: each gives the next one a sign of life sixteen times in `seconds`, and
 * listens to the one before it. If that one is not heard at sixteen looks in a row it is lost: then
 * communication breaks, and the farewell tells all others. So a rank sends and hears one message a
 * look, however many there are; and wherever the ring is cut in two, both parts find out, since on
 * each side somebody listens to the other.
 *
 * A thread does it, not the poll of the workers: all of them may be inside long bodies, and such a
 * rank is not lost. It touches MPI under the lock, like everybody, and the path of a task or a
 * message not at all. Silence is counted in looks, not in seconds, so that the time in which this
 * process itself was stopped, or got no core, is nobody's silence. */
enum { COMM_SILENT_LOOKS = 16, COMM_HOST_NAME = 64 };

struct comm_pulse {
    double seconds;            /* until a silent rank is lost; 0: nobody listens */
    char host[COMM_HOST_NAME]; /* of the rank before this one */
    pthread_t thread;
    bool made, started; /* wake; the thread */
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool open, stop; /* looks may begin; they end */
    /* Under the lock of the comm: */
    bool last_given, last_heard;
    unsigned silent; /* looks in a row */
    char out, in;    /* a sign of life, or the last one */
    MPI_Request sent, heard;
};

struct comm;

/* Starts the thread; it does nothing before comm_pulse_open. comm_pulse_stop is due all the same.
 * Errors: DUITE_E_SYSTEM, memory. */
int comm_pulse_start(struct comm *comm);

/* Under the lock of the comm: looks begin, if `seconds`, the same on all ranks, is > 0. `host`: of
 * the rank before this one. */
void comm_pulse_open(struct comm *comm, double seconds, const char *host);

/* Ends the thread; no other one is left. With all ranks at their end, and communication whole or
 * broken but not lost, it takes leave of both neighbours, so that no sign is on its way afterwards.
 */
void comm_pulse_stop(struct comm *comm);

#endif
