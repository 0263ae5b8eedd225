/* Requests lie without gaps, as MPI_Testsome needs them. */
#include "runtime/comm/requests.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

bool comm_requests_room(struct comm_requests *requests, size_t needed)
{
    void *moved[3] = {
        base_grow(requests->request, &requests->capacity[0], needed, sizeof(MPI_Request)),
        base_grow(requests->what, &requests->capacity[1], needed, sizeof(void *)),
        base_grow(requests->index, &requests->capacity[2], needed, sizeof(int))};
    if (moved[0])
        requests->request = moved[0];
    if (moved[1])
        requests->what = moved[1];
    if (moved[2])
        requests->index = moved[2];
    return moved[0] && moved[1] && moved[2];
}

MPI_Request *comm_requests_place(struct comm_requests *requests)
{
    return comm_requests_room(requests, (size_t)requests->n + 1) ? &requests->request[requests->n]
                                                                 : NULL;
}

void comm_requests_started(struct comm_requests *requests, void *what)
{
    requests->what[requests->n++] = what;
}

int comm_requests_test(struct comm_requests *requests, int *done)
{
    int n = requests->n;
    *done = 0;
    if (!n)
        return MPI_SUCCESS;
    int mpi = MPI_Testsome(n, requests->request, done, requests->index, MPI_STATUSES_IGNORE);
    if (mpi != MPI_SUCCESS || *done == MPI_UNDEFINED)
        *done = 0;
    for (int i = n - 1, left = *done; i >= 0 && left; i--) {
        if (requests->request[i] != MPI_REQUEST_NULL)
            continue;
        void *finished = requests->what[i];
        requests->n--;
        left--;
        requests->request[i] = requests->request[requests->n];
        requests->what[i] = requests->what[requests->n];
        requests->what[requests->n] = finished;
    }
    return mpi;
}

void comm_requests_free(struct comm_requests *requests)
{
    free(requests->request);
    free(requests->what);
    free(requests->index);
}
