/* All requests under way stand in one table, without gaps, as MPI_Testsome needs them. A large
 * message goes in pieces, which are received one after the other: the table posts the next receive
 * when the one before is over. The last piece is sent synchronously, so its request is over only
 * when the receiver has all others: their requests are not kept. */
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

size_t comm_piece_bytes = COMM_PIECE_BYTES;

/* ---- The table ---- */

bool comm_requests_room(struct comm *comm, size_t n)
{
    struct comm_requests *requests = &comm->requests;
    const size_t needed = (size_t)requests->n + requests->reserved + n;
    return BASE_GROW(requests->request, requests->capacity[0], needed) &&
           BASE_GROW(requests->of, requests->capacity[1], needed) &&
           BASE_GROW(requests->index, requests->capacity[2], needed) &&
           BASE_GROW(requests->status, requests->capacity[3], needed);
}

MPI_Request *comm_request_next(struct comm *comm)
{
    return &comm->requests.request[comm->requests.n];
}

void comm_request_add(struct comm *comm, comm_over *over, void *what)
{
    comm->requests.of[comm->requests.n++] = (struct comm_request){.over = over, .what = what};
}

/* ---- Pieces ---- */

static int piece_bytes(size_t left)
{
    return (int)(left < comm_piece_bytes ? left : comm_piece_bytes);
}

int comm_pieces_send(struct comm *comm, const void *from, size_t bytes, int to, int tag,
                     MPI_Request *request)
{
    for (size_t at = 0; at < bytes; at += comm_piece_bytes) {
        const bool last = bytes - at <= comm_piece_bytes;
        int mpi = (last ? MPI_Issend : MPI_Isend)((const char *)from + at, piece_bytes(bytes - at),
                                                  MPI_BYTE, to, tag, comm->mpi, request);
        if (mpi == MPI_SUCCESS && !last)
            mpi = MPI_Request_free(request);
        if (mpi != MPI_SUCCESS)
            return mpi;
    }
    return MPI_SUCCESS;
}

/* Posts the receive of the next piece. */
static int piece_receive(struct comm *comm, struct comm_request *of, MPI_Request *request)
{
    const int bytes = piece_bytes(of->left);
    char *into = of->into;
    of->into += bytes;
    of->left -= (size_t)bytes;
    return MPI_Irecv(into, bytes, MPI_BYTE, of->from, of->tag, comm->mpi, request);
}

bool comm_pieces_receive(struct comm *comm, struct comm_request of)
{
    const int mpi = piece_receive(comm, &of, comm_request_next(comm));
    if (!comm_mpi_ok(comm, mpi, "MPI_Irecv"))
        return false;
    comm->requests.of[comm->requests.n++] = of;
    return true;
}

void comm_pieces_forget(struct comm *comm, size_t bytes, int from, int tag)
{
    bool fine = true;
    for (size_t at = 0; at < bytes && fine; at += comm_piece_bytes)
        fine = comm_mpi_cut(
            comm, MPI_Recv(NULL, 0, MPI_BYTE, from, tag, comm->mpi, MPI_STATUS_IGNORE), "MPI_Recv");
}

/* ---- Requests that are over ---- */

/* Tests all; returns how many are over. Those that failed are told and stay: MPI knows them no
 * more, and nothing comes of them but comm_channels_give_up. */
static int requests_test(struct comm *comm)
{
    struct comm_requests *requests = &comm->requests;
    int done = 0, failed = 0;
    const int mpi =
        MPI_Testsome(requests->n, requests->request, &done, requests->index, requests->status);
    if (mpi == MPI_SUCCESS || comm_mpi_class(mpi) != MPI_ERR_IN_STATUS)
        return comm_mpi_ok(comm, mpi, "MPI_Testsome") && done != MPI_UNDEFINED ? done : 0;
    for (int k = 0; k < done; k++) {
        const bool fine = comm_mpi_ok(comm, requests->status[k].MPI_ERROR, "MPI_Testsome");
        requests->of[requests->index[k]].failed = !fine;
        failed += !fine;
    }
    return done - failed;
}

/* The request is over. True if it goes on with the next piece of its message. */
static bool request_goes_on(struct comm *comm, struct comm_found *found, int i)
{
    struct comm_request *of = &comm->requests.of[i];
    if (!of->left)
        return false;
    found->more = true;
    atomic_fetch_add_explicit(&comm->came, 1, memory_order_relaxed);
    of->failed =
        !comm_mpi_ok(comm, piece_receive(comm, of, &comm->requests.request[i]), "MPI_Irecv");
    return true;
}

struct comm_request comm_request_take(struct comm *comm, int i)
{
    struct comm_requests *requests = &comm->requests;
    const struct comm_request of = requests->of[i];
    requests->n--;
    requests->request[i] = requests->request[requests->n];
    requests->of[i] = requests->of[requests->n];
    return of;
}

void comm_requests_pass(struct comm *comm, struct comm_found *found)
{
    const struct comm_requests *requests = &comm->requests;
    int left = requests_test(comm);
    for (int i = requests->n - 1; i >= 0 && left; i--) {
        if (requests->request[i] != MPI_REQUEST_NULL || requests->of[i].failed)
            continue;
        left--;
        if (request_goes_on(comm, found, i))
            continue;
        const struct comm_request of = comm_request_take(comm, i);
        of.over(comm, found, of.what);
    }
}
