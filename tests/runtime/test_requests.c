/* Requests of MPI that tasks hand over: the tasks end when the requests are over. */
#include "tests/runtime/events.h"

#include <stdint.h>
#include <stdlib.h>

static int32_t there; /* that goes to this process itself */

/* Receives parameter 0, and a SENDER or this body itself sends it, which may hand Fortran's handles
 * over. */
enum { AWAITS_SENDER, SENDS, SENDS_BY_HANDLES };
KERNEL(RECEIVE, "receive", .access = {DUITE_W}, .args_size = sizeof(int), .events = 1)
{
    const int how = *(const int *)call->args, sends = how != AWAITS_SENDER;
    MPI_Request request[2];
    MPI_Fint handle[2];

    there = 9;
    ck_assert_int_eq(duite_mpi_begin(call->rt), DUITE_OK);
    MPI_Irecv(call->param[0].data, 1, MPI_INT32_T, 0, 5, MPI_COMM_SELF, &request[0]);
    if (sends)
        MPI_Isend(&there, 1, MPI_INT32_T, 0, 5, MPI_COMM_SELF, &request[1]);
    for (int i = 0; i < 2 && how == SENDS_BY_HANDLES; i++)
        handle[i] = MPI_Request_c2f(request[i]);
    ck_assert_int_eq(duite_mpi_end(call->rt), DUITE_OK);
    if (how != SENDS_BY_HANDLES)
        return duite_await_mpi(call, 1 + sends, request);
    const int code = duite_await_fortran(call, 2, handle);
    ck_assert(MPI_Request_f2c(handle[0]) == MPI_REQUEST_NULL);
    ck_assert(MPI_Request_f2c(handle[1]) == MPI_REQUEST_NULL);
    return code;
}

KERNEL(SEND_LATE, "send_late")
{
    usleep(1000000);
    ck_assert_int_eq(duite_mpi_begin(call->rt), DUITE_OK);
    MPI_Send(&there, 1, MPI_INT32_T, 0, 5, MPI_COMM_SELF); /* its receive is there */
    return duite_mpi_end(call->rt);
}

/* Each call is refused with its sentence. */
KERNEL(MISUSES, "misuses", .events = 1)
{
    MPI_Request request[2] = {MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    MPI_Fint handle[2] = {MPI_Request_c2f(MPI_REQUEST_NULL), 0};

    ck_assert_int_eq(duite_await_mpi(call, 0, NULL), DUITE_OK);
    ck_assert_int_eq(duite_await_mpi(call, 1, NULL), DUITE_E_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "at NULL"));
    ck_assert_int_eq(duite_await_mpi(call, -1, request), DUITE_E_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "-1 requests"));
    ck_assert_int_eq(duite_await_mpi(call, 2, request), DUITE_E_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "request 1 of 2 is MPI_REQUEST_NULL"));
    ck_assert_int_eq(duite_await_fortran(call, 1, NULL), DUITE_E_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "at NULL"));
    ck_assert_int_eq(duite_await_fortran(call, 1, handle), DUITE_E_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "request 1 of 1 is MPI_REQUEST_NULL"));
    ck_assert_int_eq(duite_mpi_end(call->rt), DUITE_E_STATE);
    ck_assert_int_eq(duite_mpi_begin(call->rt), DUITE_OK);
    ck_assert_int_eq(duite_mpi_begin(call->rt), DUITE_E_STATE);
    ck_assert_int_eq(duite_mpi_end(call->rt), DUITE_OK);
    return 0;
}

KERNEL(WITHOUT_EVENTS, "without_events")
{
    MPI_Request request;

    MPI_Irecv(&there, 1, MPI_INT32_T, MPI_PROC_NULL, 5, MPI_COMM_SELF, &request);
    ck_assert_int_eq(duite_await_mpi(call, 1, &request), DUITE_E_STATE);
    ck_assert_ptr_nonnull(strstr(duite_message(), "kernel without_events"));
    return MPI_Wait(&request, MPI_STATUS_IGNORE);
}

KERNEL(CHILD, "child", .access = {DUITE_RW})
{
    (void)call;
    return 0;
}

/* Keeps MPI: ends, or waits for a child. */
KERNEL(KEEP, "keep", .access = {DUITE_RWP}, .args_size = sizeof(int))
{
    const int waits = *(const int *)call->args;
    int code = duite_mpi_begin(call->rt);

    if (waits && !code) {
        code = DUITE_FORK(call->rt, &CHILD, NULL, call->param[0].object);
        code = code ? code : duite_wait(call->rt);
        duite_fail(call, code, "%s", duite_message());
        ck_assert_int_eq(duite_mpi_end(call->rt), DUITE_OK);
    }
    return code;
}

static const duite_kernel *const MPI_KERNELS[] = {&RECEIVE,        &SEND_LATE, &CHILD, &MISUSES,
                                                  &WITHOUT_EVENTS, &KEEP,      NULL};

UNIT_TEST(requests)
{
    for (unsigned threads = 1; threads < 4; threads++)
        for (int check = 0; check < 2; check++) {
            start_with(MPI_KERNELS, threads, check, threads == 2);
            for (int i = 0; i < 50; i++) {
                duite_object a;
                int32_t value = 0;

                ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &a), DUITE_OK);
                DUITE_FORK(rt, &RECEIVE, DUITE_ARGS(int, SENDS + i % 2), a);
                ck_assert_int_eq(duite_get(rt, a, &value), DUITE_OK);
                ck_assert_int_eq(value, 9);
                duite_free(rt, a);
            }
            ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
        }
}

/* The report of a standstill names the task. */
UNIT_TEST(requests_late)
{
    duite_object a;
    int32_t value = 0;

    setenv("DUITE_STUCK_SECONDS", "0.2", 1);
    start_with(MPI_KERNELS, 2, 0, 0);
    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &a), DUITE_OK);
    DUITE_FORK(rt, &RECEIVE, DUITE_ARGS(int, AWAITS_SENDER), a);
    duite_fork(rt, &SEND_LATE, NULL, 0, NULL);
    reports(a, &value, "(kernel receive) waits for 1 requests of MPI that it handed over");
    ck_assert_int_eq(value, 9);
    duite_free(rt, a);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

UNIT_TEST(requests_misused)
{
    start_with(MPI_KERNELS, 2, 0, 0);
    ck_assert_int_eq(duite_fork(rt, &MISUSES, NULL, 0, NULL), DUITE_OK);
    ck_assert_int_eq(duite_fork(rt, &WITHOUT_EVENTS, NULL, 0, NULL), DUITE_OK);
    ck_assert_msg(!duite_wait(rt), "%s", duite_message());
    const duite_object a = number();
    for (int waits = 0; waits < 2; waits++) {
        DUITE_FORK(rt, &KEEP, &waits, a);
        ck_assert_int_eq(duite_wait(rt), DUITE_E_STATE);
        ck_assert_ptr_nonnull(
            strstr(duite_message(), waits ? "waits between duite_mpi_begin and duite_mpi_end"
                                          : "returned between duite_mpi_begin and duite_mpi_end"));
        duite_set(rt, a, NULL);
    }
    duite_free(rt, a);
    ck_assert_int_eq(duite_mpi_begin(rt), DUITE_OK); /* no body has kept it */
    ck_assert_int_eq(duite_mpi_end(rt), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}
