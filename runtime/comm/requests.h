#ifndef DUITE_COMM_REQUESTS_H
#define DUITE_COMM_REQUESTS_H

#include <mpi.h>

#include <stdbool.h>
#include <stddef.h>

/* MPI requests under way, and for each the thing that it sends or receives. */
struct comm_requests {
    MPI_Request *request;
    void **what;
    int *index; /* scratch for MPI_Testsome */
    int n;
    size_t capacity[3];
};

/* A place for one more request, which counts once its `what` is set by comm_requests_started. NULL
 * without memory. */
MPI_Request *comm_requests_place(struct comm_requests *requests);
void comm_requests_started(struct comm_requests *requests, void *what);

/* Memory for so many at once, so that places are always there. False without. */
bool comm_requests_room(struct comm_requests *requests, size_t n);

/* Tests all; moves the finished ones to the end of the arrays: what[n .. n + *done). Returns MPI's
 * code. */
int comm_requests_test(struct comm_requests *requests, int *done);

void comm_requests_free(struct comm_requests *requests);

#endif
