/* Clocks: rank 0 asks each rank in turn for its time. The shortest of several round trips counts:
 * the other rank answered between its two ends, so that half of it bounds the error (Cristian,
 * 1989). The buffers that MPI may still write to belong to the trace, which is not freed if a rank
 * did not answer in time. */
#include "runtime/trace/internal.h"

#include <math.h>
#include <sched.h>
#include <unistd.h>

enum { TRIPS = 16 };
#define PATIENCE 10.0 /* seconds; and this for each rank */
#define EACH     0.05

static bool clock_request_end(struct trace *trace, MPI_Request *request, double until)
{
    int done = 0;
    while (!MPI_Test(request, &done, MPI_STATUS_IGNORE) && !done && base_seconds() < until)
        sched_yield();
    trace->stuck |= !done;
    return done;
}

static bool clock_say(struct trace *trace, int to, double until)
{
    MPI_Request request;
    return !MPI_Isend(&trace->said, sizeof trace->said, MPI_BYTE, to, 0, trace->mpi, &request) &&
           clock_request_end(trace, &request, until);
}

static bool clock_hear(struct trace *trace, int from, double until)
{
    MPI_Request request;
    return !MPI_Irecv(&trace->heard, sizeof trace->heard, MPI_BYTE, from, 0, trace->mpi,
                      &request) &&
           clock_request_end(trace, &request, until);
}

/* Rank 0 with one other. */
static bool clock_compare_with(struct trace *trace, int other, double until)
{
    struct trace_word best = {.run = trace->header.run, .bound = INFINITY};
    for (int i = 0; i < TRIPS; i++) {
        trace->said = (struct trace_word){.more = 1};
        double begin = trace_seconds(trace);
        if (!clock_say(trace, other, until) || !clock_hear(trace, other, until))
            return false;
        double end = trace_seconds(trace), half = (end - begin) / 2;
        if (half >= best.bound)
            continue;
        best.bound = half;
        best.at = trace->heard.at;
        best.ahead = trace->heard.at - (begin + half);
    }
    trace->said = best;
    if (!(trace->header.latency > 0 && trace->header.latency < best.bound))
        trace->header.latency = best.bound;
    return clock_say(trace, other, until);
}

static bool clock_answer(struct trace *trace, double until)
{
    while (clock_hear(trace, 0, until)) {
        if (!(trace->heard.more > 0))
            return true;
        trace->said = (struct trace_word){.at = trace_seconds(trace)};
        if (!clock_say(trace, 0, until))
            return false;
    }
    return false;
}

void trace_align(struct trace *trace, MPI_Comm mpi)
{
    const int n = (int)trace->header.n_ranks, rank = (int)trace->header.rank;
    const double until = base_seconds() + PATIENCE + EACH * n;
    struct trace_clock clock = {0};
    uint64_t random = trace->header.epoch ^ (uint64_t)getpid() << 40;
    if (!trace->header.run && !rank)
        trace->header.run = duite_random(&random);
    if (n > 1 && trace->mpi == MPI_COMM_NULL && MPI_Comm_dup(mpi, &trace->mpi))
        return;
    bool fine = !trace->stuck;
    for (int other = 1; other < n && !rank && fine; other++)
        fine = clock_compare_with(trace, other, until);
    if (rank && fine && clock_answer(trace, until)) {
        trace->header.run = trace->heard.run;
        clock = (struct trace_clock){trace->heard.at, trace->heard.ahead, trace->heard.bound};
    } else if (rank) {
        return;
    } else {
        clock.at = trace_seconds(trace);
    }
    pthread_mutex_lock(&trace->lock);
    trace_write(trace, TRACE_CLOCK, 0, &(struct trace_part){&clock, sizeof clock}, 1);
    pthread_mutex_unlock(&trace->lock);
}
