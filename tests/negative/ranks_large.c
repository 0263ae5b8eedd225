/* A message that takes MPI longer to copy than a rank may be silent: nobody is lost, in forks and
 * in a recorded graph. Run under mpirun on 2 ranks. Without an argument MPI is slow here, and the
 * message short; with the argument N it has N doubles, and MPI is as fast as it is. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdlib.h>
#include <time.h>

enum {
    SHORT = (1 << 24) + 3,     /* doubles: 128 MiB and no multiple of a piece */
    BYTES_A_SECOND = 80000000, /* of slow MPI: the message takes 1.7 s, ... */
    LARGE = 1 << 20,           /* bytes of a message that it is slow with */
    PERIOD = 1000003           /* of the values, which are never 0 */
};
#define LOST_SECONDS 1.0 /* ... a rank may be silent for less */

static int is_slow;

/* As if MPI copied a message, or a piece of it, where it is received. */
static void copy_slowly(int count, MPI_Datatype type)
{
    int size = 0;
    MPI_Type_size(type, &size);
    const double bytes = (double)count * size;
    if (!is_slow || bytes < LARGE)
        return;
    const double seconds = bytes / BYTES_A_SECOND;
    struct timespec left = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
    while (nanosleep(&left, &left))
        ;
}

int MPI_Imrecv(void *buffer, int count, MPI_Datatype type, MPI_Message *message,
               MPI_Request *request)
{
    copy_slowly(count, type);
    return PMPI_Imrecv(buffer, count, type, message, request);
}

int MPI_Irecv(void *buffer, int count, MPI_Datatype type, int source, int tag, MPI_Comm comm,
              MPI_Request *request)
{
    copy_slowly(count, type);
    return PMPI_Irecv(buffer, count, type, source, tag, comm, request);
}

static double value(size_t i)
{
    return (double)(i % PERIOD) + 1;
}

KERNEL(FILL, "fill", .access = {DUITE_W})
{
    double *values = duite_out(call, 0, double);
    for (size_t i = 0; i < duite_count(call, 0); i++)
        values[i] = value(i);
    return 0;
}

/* How many values are wrong. */
KERNEL(CHECK, "check", .access = {DUITE_R, DUITE_W})
{
    const double *values = duite_in(call, 0, double);
    int64_t wrong = 0;
    for (size_t i = 0; i < duite_count(call, 0); i++)
        wrong += values[i] != value(i);
    duite_out(call, 1, int64_t)[0] = wrong;
    return 0;
}

static int build(duite *rt, void *context)
{
    const duite_object *object = context;
    const int code = duite_fork_at(rt, 0, &FILL, NULL, 1, object);
    return code ? code : duite_fork_at(rt, 1, &CHECK, NULL, 2, object);
}

/* All values came; and nothing is left to be sent when ranks meet in MPI. */
static int came(duite *rt, duite_object wrong)
{
    int64_t n = -1;
    return !duite_get(rt, wrong, &n) && !duite_wait(rt) && n == 0;
}

/* A short message goes through the other buffer, too, which a large one has no memory for. */
static int recorded(duite *rt, duite_object *object)
{
    const int twice = is_slow;
    duite_graph graph;
    if (duite_graph_new(rt, build, object, &graph))
        return 0;
    int right = !duite_replay(rt, graph, 1) && came(rt, object[1]);
    is_slow = 0;
    if (twice)
        right = right && !duite_replay(rt, graph, 1) && came(rt, object[1]);
    return !duite_graph_free(rt, graph) && right;
}

RANKS_CASE(large)
{
    static const duite_kernel *const LIST[] = {&FILL, &CHECK, NULL};
    const size_t n = argc > 1 ? strtoull(argv[1], NULL, 10) : SHORT;
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_object object[2];
    duite *rt;
    misuse_mpi();
    is_slow = argc < 2;
    options.kernels = LIST;
    options.threads = 1;
    options.lost_seconds = LOST_SECONDS;
    tap_case(duite_start(&rt, &options) == DUITE_OK, "starts");
    duite_new(rt, DUITE_F64, n, &object[0]);
    duite_new(rt, DUITE_I64, 1, &object[1]);
    tap_case(!build(rt, object) && came(rt, object[1]), "a large message of a task");
    tap_case(recorded(rt, object), "a large message of a recorded graph");
    duite_free(rt, object[0]);
    duite_free(rt, object[1]);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
    return tap_done();
}
