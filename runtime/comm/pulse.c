/* One sign is on its way at a time: a rank whose neighbour does not take it sends no more. The last
 * one of all says so, and nothing follows it. */
#include "runtime/comm/pulse.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/thread.h"
#include "runtime/comm/internal.h"

#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>

enum { SIGN = 1, LAST_SIGN };

/* ---- Looks, under the lock of the comm ---- */

static int before(const struct comm *comm)
{
    return (comm->rank + comm->n_ranks - 1) % comm->n_ranks;
}

static void lost(struct comm *comm)
{
    char sentence[200];
    snprintf(sentence, sizeof sentence,
             "rank %d on host %s is lost: nothing was heard of it for %g s", before(comm),
             comm->pulse.host, comm->pulse.seconds);
    comm_broke(comm, DUITE_E_LOST, sentence);
}

/* Ready for one more sign. */
static bool expect_sign(struct comm *comm)
{
    struct comm_pulse *pulse = &comm->pulse;
    int mpi =
        MPI_Irecv(&pulse->in, 1, MPI_BYTE, before(comm), COMM_SIGNS, comm->mpi, &pulse->heard);
    return comm_mpi_ok(comm, mpi, "MPI_Irecv of a sign of life");
}

/* Whether anything was heard since the last time. */
static bool hear(struct comm *comm)
{
    struct comm_pulse *pulse = &comm->pulse;
    bool any = pulse->last_heard;
    int there = 1;
    while (there && !pulse->last_heard) {
        int mpi = MPI_Test(&pulse->heard, &there, MPI_STATUS_IGNORE);
        if (!comm_mpi_ok(comm, mpi, "MPI_Test of a sign of life"))
            return any;
        any = any || there;
        if (there && pulse->in == LAST_SIGN)
            pulse->last_heard = true;
        else if (there && !expect_sign(comm))
            return any;
    }
    return any;
}

/* Unless the one before is still on its way. */
static void give(struct comm *comm, char sign)
{
    struct comm_pulse *pulse = &comm->pulse;
    int taken = 0, to = (comm->rank + 1) % comm->n_ranks;
    int mpi = MPI_Test(&pulse->sent, &taken, MPI_STATUS_IGNORE);
    if (!comm_mpi_ok(comm, mpi, "MPI_Test of a sign of life") || !taken || pulse->last_given)
        return;
    pulse->out = sign;
    mpi = MPI_Isend(&pulse->out, 1, MPI_BYTE, to, COMM_SIGNS, comm->mpi, &pulse->sent);
    if (comm_mpi_ok(comm, mpi, "MPI_Isend of a sign of life"))
        pulse->last_given = sign == LAST_SIGN;
}

static void look(struct comm *comm)
{
    struct comm_pulse *pulse = &comm->pulse;
    if (comm_is_lost(comm))
        return;
    give(comm, SIGN);
    pulse->silent = hear(comm) ? 0 : pulse->silent + 1;
    if (pulse->silent >= COMM_SILENT_LOOKS)
        lost(comm);
}

/* ---- The thread ---- */

/* For so many seconds, or without an end until it is open. False when it is to stop. */
static bool rest(struct comm_pulse *pulse, double seconds)
{
    struct timespec until;
    int code = 0;
    clock_gettime(CLOCK_MONOTONIC, &until);
    long whole = (long)seconds, parts = until.tv_nsec + (long)(1e9 * (seconds - (double)whole));
    until.tv_sec += whole + parts / 1000000000;
    until.tv_nsec = parts % 1000000000;
    pthread_mutex_lock(&pulse->lock);
    while (!pulse->stop && !pulse->open)
        pthread_cond_wait(&pulse->wake, &pulse->lock);
    while (!pulse->stop && code != ETIMEDOUT)
        code = pthread_cond_timedwait(&pulse->wake, &pulse->lock, &until);
    bool on = !pulse->stop;
    pthread_mutex_unlock(&pulse->lock);
    return on;
}

static void *pulse_main(void *argument)
{
    struct comm *comm = argument;
    struct comm_pulse *pulse = &comm->pulse;
    const double moment = 1e-4;
    bool on = rest(pulse, 0); /* until it is open: only then `seconds` is known */
    double pause = pulse->seconds / COMM_SILENT_LOOKS;
    while (on && pulse->seconds > 0 && (on = rest(pulse, pause))) {
        while (on && !comm_try_lock(comm)) /* somebody polls */
            on = rest(pulse, moment);
        if (!on)
            break;
        look(comm);
        comm_unlock(comm); /* what was posted meanwhile is sent by the next poll */
    }
    return NULL;
}

int comm_pulse_start(struct comm *comm)
{
    struct comm_pulse *pulse = &comm->pulse;
    pthread_condattr_t monotonic;
    sigset_t all, signals;
    pulse->sent = pulse->heard = MPI_REQUEST_NULL;
    pthread_mutex_init(&pulse->lock, NULL);
    if (pthread_condattr_init(&monotonic))
        return base_no_memory("signs of life");
    pulse->made = !pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC) &&
                  !pthread_cond_init(&pulse->wake, &monotonic);
    pthread_condattr_destroy(&monotonic);
    sigfillset(&all); /* signals are for the program's threads */
    pthread_sigmask(SIG_SETMASK, &all, &signals);
    const char *what = "the thread of signs of life";
    const int code = pulse->made
                         ? base_thread_start(&pulse->thread, what, pulse_main, comm)
                         : base_error(DUITE_E_SYSTEM, "cannot start %s: pthread_cond_init", what);
    pulse->started = !code;
    pthread_sigmask(SIG_SETMASK, &signals, NULL);
    return code;
}

void comm_pulse_open(struct comm *comm, double seconds, const char *host)
{
    struct comm_pulse *pulse = &comm->pulse;
    snprintf(pulse->host, sizeof pulse->host, "%s", host);
    if (seconds > 0 && !expect_sign(comm))
        return;
    pthread_mutex_lock(&pulse->lock);
    pulse->seconds = seconds;
    pulse->open = true;
    pthread_cond_signal(&pulse->wake);
    pthread_mutex_unlock(&pulse->lock);
}

/* ---- The end ---- */

/* Gives its last sign and hears that of the rank before, which may take long, if that one's bodies
 * do. A gap between two looks is one in which this process was stopped. */
static void take_leave(struct comm *comm)
{
    struct comm_pulse *pulse = &comm->pulse;
    double heard = base_seconds(), last = heard;
    while (!comm_is_lost(comm) &&
           !(pulse->last_heard && pulse->last_given && pulse->sent == MPI_REQUEST_NULL)) {
        double now = base_seconds();
        give(comm, LAST_SIGN);
        if (hear(comm))
            heard = now;
        else if (now - last > pulse->seconds / COMM_SILENT_LOOKS)
            heard += now - last;
        else if (now - heard > pulse->seconds)
            lost(comm);
        last = now;
        sched_yield();
    }
}

void comm_pulse_stop(struct comm *comm)
{
    struct comm_pulse *pulse = &comm->pulse;
    if (pulse->started) {
        pthread_mutex_lock(&pulse->lock);
        pulse->stop = true;
        pthread_cond_signal(&pulse->wake);
        pthread_mutex_unlock(&pulse->lock);
        pthread_join(pulse->thread, NULL);
    }
    if (pulse->open && pulse->seconds > 0)
        take_leave(comm);
    if (pulse->made)
        pthread_cond_destroy(&pulse->wake);
    pthread_mutex_destroy(&pulse->lock);
}
