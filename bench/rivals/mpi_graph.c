/* mpi-graph: the twin of duite-graph as one would write it by hand for MPI. Tasks of a level (the
 * longest way to them) are dealt out in ranges, a rank a core; a rank runs its tasks in their
 * order, and sends a value to each rank that reads it as soon as it is there. All receives of a
 * round are posted first. Both sides go through the tasks in the same order, so that values between
 * two ranks need no tag. */
#include "bench/rivals/twin.h"

#include "bench/serve.h"

#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_RANKS = 64, TAG = 0 };

static int ranks;
static int *owner;        /* of task i */
static uint64_t *readers; /* of its value: a bit for each rank */
static MPI_Request *arrival, *departure;

static size_t *find_levels(const struct compare_graph *graph, size_t *width)
{
    size_t *level = calloc(graph->n, sizeof *level);
    for (size_t i = 0; i < graph->n && level; i++) {
        for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
            if (level[i] <= level[graph->from[k]])
                level[i] = level[graph->from[k]] + 1;
        width[level[i]]++;
    }
    return level;
}

static int deal_out(const struct compare_graph *graph)
{
    size_t *width = calloc(2 * graph->n, sizeof *width), *dealt = width + graph->n;
    size_t *level = width ? find_levels(graph, width) : NULL;
    owner = calloc(graph->n, sizeof *owner);
    readers = calloc(graph->n, sizeof *readers);
    arrival = calloc(graph->n, sizeof *arrival);
    departure = calloc(graph->n * (size_t)ranks, sizeof *departure);
    const bool fine = level && owner && readers && arrival && departure;
    for (size_t i = 0; i < graph->n && fine; i++) {
        owner[i] = (int)(dealt[level[i]]++ * (size_t)ranks / width[level[i]]);
        for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
            readers[graph->from[k]] |= UINT64_C(1) << owner[i];
    }
    free(level);
    free(width);
    return !fine;
}

static int start(struct twin *twin)
{
    if (MPI_Init(NULL, NULL) || MPI_Comm_rank(MPI_COMM_WORLD, &twin->rank) ||
        MPI_Comm_size(MPI_COMM_WORLD, &ranks) || ranks > MOST_RANKS)
        return 1;
    serve_bind(twin->rank);
    return deal_out(&twin->graph);
}

static int post_arrivals(const struct twin *twin)
{
    int code = 0;
    for (size_t i = 0; i < twin->graph.n && !code; i++) {
        arrival[i] = MPI_REQUEST_NULL;
        if (owner[i] != twin->rank && readers[i] >> twin->rank & 1)
            code = MPI_Irecv(twin->values[i], (int)twin->count[i], MPI_UINT64_T, owner[i], TAG,
                             MPI_COMM_WORLD, &arrival[i]);
    }
    return code;
}

static int send(const struct twin *twin, size_t i, int *sent)
{
    int code = 0;
    for (int to = 0; to < ranks && !code; to++)
        if (to != twin->rank && readers[i] >> to & 1)
            code = MPI_Isend(twin->values[i], (int)twin->count[i], MPI_UINT64_T, to, TAG,
                             MPI_COMM_WORLD, &departure[(*sent)++]);
    return code;
}

static int run_round(struct twin *twin)
{
    const struct compare_graph *graph = &twin->graph;
    int sent = 0, code = post_arrivals(twin);
    for (size_t i = 0; i < graph->n && !code; i++) {
        if (owner[i] != twin->rank)
            continue;
        for (size_t k = graph->start[i]; k < graph->start[i + 1] && !code; k++)
            code = MPI_Wait(&arrival[graph->from[k]], MPI_STATUS_IGNORE);
        twin_body(twin, i);
        if (!code)
            code = send(twin, i, &sent);
    }
    return code ? code : MPI_Waitall(sent, departure, MPI_STATUSES_IGNORE);
}

static void meet(void)
{
    MPI_Barrier(MPI_COMM_WORLD);
}

/* Values of other ranks go to rank 0. */
static int stop(struct twin *twin)
{
    int code = 0;
    for (size_t i = 0; i < twin->graph.n && !code; i++)
        if (owner[i] && !twin->rank)
            code = MPI_Recv(twin->values[i], (int)twin->count[i], MPI_UINT64_T, owner[i], TAG,
                            MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        else if (owner[i] && owner[i] == twin->rank)
            code = MPI_Send(twin->values[i], (int)twin->count[i], MPI_UINT64_T, 0, TAG,
                            MPI_COMM_WORLD);
    free(owner);
    free(readers);
    free(arrival);
    free(departure);
    return MPI_Finalize() || code;
}

static const char *scheduler(size_t i)
{
    return i ? NULL : "isend";
}

int main(int argc, char **argv)
{
    static const struct twin_runtime runtime = {.name = "mpi-graph",
                                                .usual = "isend",
                                                .scheduler = scheduler,
                                                .start = start,
                                                .round = run_round,
                                                .meet = meet,
                                                .stop = stop};
    return twin_main(argc, argv, &runtime);
}
