/* Breaking happens once: the first reason is kept, and travels. */
#include "runtime/comm/farewell.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <stdio.h>
#include <string.h>

void comm_broke(struct comm *comm, int code, const char *sentence)
{
    if (atomic_flag_test_and_set(&comm->breaking))
        return;
    comm->reason.code = code;
    snprintf(comm->reason.sentence, sizeof comm->reason.sentence, "%s", sentence);
    atomic_store(&comm->broken, code);
    work_notify(comm->graph->pool);
}

void comm_broke_memory(struct comm *comm, const char *what)
{
    char sentence[100];
    snprintf(sentence, sizeof sentence, "out of memory for %s", what);
    comm_broke(comm, DUITE_E_MEMORY, sentence);
}

bool comm_mpi_ok(struct comm *comm, int mpi, const char *what)
{
    if (mpi == MPI_SUCCESS)
        return true;
    char reason[MPI_MAX_ERROR_STRING] = "", sentence[MPI_MAX_ERROR_STRING + 64];
    int length = 0;
    MPI_Error_string(mpi, reason, &length);
    snprintf(sentence, sizeof sentence, "%s: %s", what, reason);
    comm_broke(comm, DUITE_E_MPI, sentence);
    return false;
}

int comm_broken(struct comm *comm)
{
    int code = atomic_load_explicit(&comm->broken, memory_order_acquire);
    return code ? base_error(code, "%s", comm->reason.sentence) : DUITE_OK;
}

bool comm_is_cut(struct comm *comm)
{
    return comm_is_lost(comm);
}

bool comm_farewells_start(struct comm_farewells *farewells, int n_ranks)
{
    farewells->packet = data_packet_new(sizeof(struct comm_farewell), true);
    farewells->request = base_alloc((size_t)n_ranks * sizeof(MPI_Request));
    for (int i = 0; i < n_ranks && farewells->request; i++)
        farewells->request[i] = MPI_REQUEST_NULL;
    return farewells->packet && farewells->request;
}

void comm_farewells_stop(struct comm_farewells *farewells)
{
    data_packet_free(farewells->packet);
    base_free(farewells->request);
}

void comm_farewell_say(struct comm *comm)
{
    struct comm_farewells *farewells = &comm->farewells;
    if (farewells->said || !comm_is_broken(comm))
        return;
    struct data_packet *packet = farewells->packet;
    farewells->said = true;
    packet->kind = DATA_FAREWELL;
    packet->key.slot = (uint32_t)comm->rank;
    comm->reason.entered = comm->entered;
    memcpy(data_payload(packet), &comm->reason, sizeof comm->reason);
    int lines = (int)data_packet_lines(packet->bytes);
    for (int to = 0; to < comm->n_ranks; to++)
        if (to != comm->rank) /* a failure here is one of MPI: there is nobody left to tell */
            MPI_Isend(packet, lines, comm->line, to, 0, comm->mpi, &farewells->request[to]);
}

void comm_farewell_hear(struct comm *comm, struct data_packet *packet)
{
    struct comm_farewell *farewell = data_payload(packet);
    char sentence[sizeof farewell->sentence + 32];
    farewell->sentence[sizeof farewell->sentence - 1] = '\0';
    snprintf(sentence, sizeof sentence, "rank %u: %s", packet->key.slot, farewell->sentence);
    comm->farewells.heard++;
    if (farewell->entered > comm->farewells.entered)
        comm->farewells.entered = farewell->entered;
    comm_broke(comm, farewell->code, sentence);
}

bool comm_is_quiet(struct comm *comm)
{
    int sent = 0;
    if (!comm_try_lock(comm))
        return false;
    bool quiet = comm->farewells.said && comm->farewells.heard == comm->n_ranks - 1 &&
                 !comm->sends.n && !comm->receives.n && comm_questions_sent(comm) &&
                 comm_asks_sent(comm);
    if (quiet)
        MPI_Testall(comm->n_ranks, comm->farewells.request, &sent, MPI_STATUSES_IGNORE);
    comm_unlock(comm);
    return quiet && sent;
}
