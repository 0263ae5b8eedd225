/* How many control messages a check of the ranks takes. MPI's calls are counted on their way to
 * MPI. */
#include "runtime/data/packet.h"
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

static int counts;                      /* whether MPI's calls are counted: in this case */
static _Atomic int control, values;     /* packets that this rank sent */
static _Atomic long collectives, bytes; /* calls, and bytes of one rank in them */

/* A packet of a version or a task is of a kind of data/packet.h; what is not is a control message.
 */
int MPI_Isend(const void *buffer, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
              MPI_Request *request)
{
    const struct data_packet *packet = buffer;
    if (counts && tag == 0 && packet->kind >= DATA_VALUE && packet->kind <= DATA_RESULT)
        values++;
    else if (counts && tag == 0)
        control++;
    return PMPI_Isend(buffer, count, type, to, tag, comm, request);
}

static void count_collective(int count, MPI_Datatype type)
{
    int size = 0;
    MPI_Type_size(type, &size);
    collectives++;
    bytes += (long)count * size;
}

int MPI_Iallgather(const void *send, int n, MPI_Datatype type, void *receive, int m,
                   MPI_Datatype of, MPI_Comm comm, MPI_Request *request)
{
    count_collective(n * ranks, type); /* what a rank has to receive */
    return PMPI_Iallgather(send, n, type, receive, m, of, comm, request);
}

int MPI_Iallreduce(const void *send, void *receive, int n, MPI_Datatype type, MPI_Op op,
                   MPI_Comm comm, MPI_Request *request)
{
    count_collective(n, type);
    return PMPI_Iallreduce(send, receive, n, type, op, comm, request);
}

KERNEL(SLOW, "slow", .access = {DUITE_RW})
{
    usleep(800000);
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

/* The largest of all ranks. */
static int max(duite *rt, int own)
{
    int all = 0;
    duite_mpi_begin(rt);
    MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    duite_mpi_end(rt);
    return all;
}

static int log2_of_ranks(void)
{
    int n = 0;
    while (1 << n < ranks)
        n++;
    return n;
}

/* All ranks wait for long in a get of a task of one rank: each begins a check, or hears of one. */
static void check(duite *rt, duite_object object, int maker, int late)
{
    char line[120];
    int32_t value = 0;
    control = 0;
    duite_fork_at(rt, maker, &SLOW, NULL, 1, &object);
    if (rank == late)
        usleep(500000); /* it hears of the call before it makes it */
    const int code = duite_get(rt, object, &value);
    const int sent = max(rt, control), bound = 2 * log2_of_ranks();
    snprintf(line, sizeof line, "a get of 0.8 s: at most %d control messages of a rank (%d)", bound,
             sent);
    tap_case(!code && value > 0 && (ranks == 1 || late >= 0 || sent > 0) && sent <= bound, line);
}

/* A wait is one small reduction; what failed is gathered only where something did. */
static void reduce(duite *rt)
{
    collectives = bytes = 0;
    const int code = duite_wait(rt);
    tap_case(!code && collectives == (ranks > 1) && bytes <= 64,
             "a wait: one collective call of at most 64 bytes");
}

RANKS_CASE(control)
{
    duite_options options;
    duite *rt = NULL;
    int32_t value;

    counts = 1;
    misuse_mpi();
    options = misuse_options(MPI_COMM_WORLD);
    options.threads = 1;
    options.kernels = (const duite_kernel *const[]){&SET, &SLOW, NULL};
    duite_start(&rt, &options);
    const duite_object object = misuse_new(rt, 1);
    duite_fork_at(rt, 0, &SET, &(int32_t){3}, 1, &object);
    duite_get(rt, object, &value);
    check(rt, object, 0, -1);
    check(rt, object, ranks - 1, 0);
    reduce(rt);
    duite_free(rt, object);
    tap_case(duite_stop(&rt) == DUITE_OK, "and nothing is left at stop");
    return tap_done();
}
