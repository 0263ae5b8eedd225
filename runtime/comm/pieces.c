/* The pieces of a message are received one after the other: the next receive is posted when the one
 * before is over. The last piece is sent synchronously, so its request is over only when the
 * receiver has all others: their requests are not kept. */
#include "runtime/comm/internal.h"

size_t comm_piece_bytes = COMM_PIECE_BYTES;

/* Bytes of the piece that begins at `at`. */
static int piece_bytes(size_t bytes, size_t at)
{
    return (int)(bytes - at < comm_piece_bytes ? bytes - at : comm_piece_bytes);
}

int comm_pieces_send(struct comm *comm, const void *from, size_t bytes, int to, int tag,
                     MPI_Request *request)
{
    const char *piece = from;
    for (size_t at = 0; at < bytes; at += comm_piece_bytes) {
        const bool last = comm_is_last_piece(bytes, at);
        int mpi = (last ? MPI_Issend : MPI_Isend)(piece + at, piece_bytes(bytes, at), MPI_BYTE, to,
                                                  tag, comm->mpi, request);
        if (mpi == MPI_SUCCESS && !last)
            mpi = MPI_Request_free(request);
        if (mpi != MPI_SUCCESS)
            return mpi;
    }
    return MPI_SUCCESS;
}

int comm_piece_receive(struct comm *comm, void *into, size_t bytes, size_t at, int from, int tag,
                       MPI_Request *request)
{
    return MPI_Irecv((char *)into + at, piece_bytes(bytes, at), MPI_BYTE, from, tag, comm->mpi,
                     request);
}

void comm_pieces_forget(struct comm *comm, size_t bytes, int from, int tag)
{
    for (size_t at = 0; at < bytes; at += comm_piece_bytes) /* truncated on purpose */
        MPI_Recv(NULL, 0, MPI_BYTE, from, tag, comm->mpi, MPI_STATUS_IGNORE);
}
