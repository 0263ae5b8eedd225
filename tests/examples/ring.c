/* Rows of numbers that go once round all ranks by messages of the program itself: a task begins
 * them, and ends when they are over. No worker waits, and no MPI_Wait stands anywhere. */

#include <duite.h>

#include <stdio.h>

enum { LENGTH = 1000, MOST = 64 /* ranks */ };

/* Sends parameter 0 to the next rank; parameter 1 comes from the one before. */
static int pass(const duite_call *call)
{
    const int ranks = duite_ranks(call->rt), rank = call->rank;
    MPI_Request request[2];
    int code = duite_mpi_begin(call->rt);
    if (code)
        return code;
    code = MPI_Irecv(duite_out(call, 1, double), LENGTH, MPI_DOUBLE, (rank + ranks - 1) % ranks, 0,
                     MPI_COMM_WORLD, &request[0]) ||
           MPI_Isend(duite_in(call, 0, double), LENGTH, MPI_DOUBLE, (rank + 1) % ranks, 0,
                     MPI_COMM_WORLD, &request[1]);
    duite_mpi_end(call->rt);
    return code ? code : duite_await_mpi(call, 2, request);
}

static int grow(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 1, double)[i] = duite_in(call, 0, double)[i] + 1;
    return 0;
}

static const duite_kernel PASS = {
    .name = "pass", .body = pass, .access = {DUITE_R, DUITE_W}, .events = 1};
static const duite_kernel GROW = {.name = "grow", .body = grow, .access = {DUITE_R, DUITE_W}};

static int run(duite *rt)
{
    const int ranks = duite_ranks(rt);
    duite_object row[MOST], next[MOST];
    double got[LENGTH] = {0};
    int wrong = 0;
    for (int r = 0; r < ranks; r++) {
        for (int i = 0; i < LENGTH; i++)
            got[i] = r * LENGTH + i;
        duite_new(rt, DUITE_F64, LENGTH, &row[r]);
        duite_new(rt, DUITE_F64, LENGTH, &next[r]);
        duite_set(rt, row[r], got);
    }
    for (int step = 0; step < ranks; step++)
        for (int r = 0; r < ranks; r++) {
            duite_fork_at(rt, r, &PASS, NULL, 2, (duite_object[]){row[r], next[r]});
            duite_fork_at(rt, r, &GROW, NULL, 2, (duite_object[]){next[r], row[r]});
        }
    for (int r = 0; r < ranks; r++) {
        if (duite_get(rt, row[r], got))
            fprintf(stderr, "ring: %s\n", duite_message());
        for (int i = 0; i < LENGTH; i++)
            wrong |= got[i] != r * LENGTH + i + ranks;
        duite_free(rt, row[r]);
        duite_free(rt, next[r]);
    }
    return wrong;
}

int main(int argc, char **argv) /* ring [SCHEDULER] */
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&PASS, &GROW, NULL};
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "ring: %s\n", duite_message()), 1;
    int wrong = duite_ranks(rt) > MOST || run(rt);
    if (duite_stop(&rt))
        return fprintf(stderr, "ring: %s\n", duite_message()), 1;
    return wrong;
}
