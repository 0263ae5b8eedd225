/* A message of a recorded graph that is longer than its receive, as from a rank that recorded
 * another graph: all ranks are told so, and can stop. Run under mpirun. */
#include "runtime/comm/internal.h"
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdio.h>

static int cuts; /* whether receives are too short: in this case */

int MPI_Irecv(void *buffer, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm,
              MPI_Request *request)
{
    const int cut = cuts && tag >= COMM_CHANNELS;
    return PMPI_Irecv(buffer, cut ? 1 : count, type, from, tag, comm, request);
}

static int build(duite *rt, void *context)
{
    const duite_object *pair = context;
    duite_fork_at(rt, 0, &SET, &(int32_t){7}, 1, pair);
    return duite_fork_at(rt, ranks - 1, &COPY, NULL, 2, pair);
}

RANKS_CASE(cut)
{
    misuse_mpi();
#ifdef MPICH_VERSION
    if (ranks > 1) {
        puts("MPICH's MPI_Testsome asks MPI_COMM_WORLD what to do and ends the job");
        return 77;
    }
#endif
    duite *rt = misuse_start(MPI_COMM_WORLD, 2);
    duite_object pair[] = {misuse_new(rt, 1), misuse_new(rt, 1)};
    duite_graph graph;
    int code = duite_graph_new(rt, build, pair, &graph);
    cuts = 1;
    code = code || duite_replay(rt, graph, 3);
    const int told = duite_wait(rt);
    misuse_keep_message();
    tap_case(!code && told == (ranks > 1 ? DUITE_E_DIFFERENT : DUITE_OK), "a message is cut");
    tap_case(ranks == 1 || misuse_all_told("a message of a recorded graph does not fit"),
             "and all ranks are told");
    duite_stop(&rt);
    tap_case(!rt, "and can stop");
    return tap_done();
}
