/* Events: tasks end when their bodies are over and their events are completed, in any order and by
 * any thread; until then nobody sees their results. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LATE = 3000 /* microseconds after the body */, AT_ONCE = 200 };

static duite *rt;

/* ---- A thread of the program that completes events ---- */

struct late {
    duite_event event[2];
    int n, code, wait; /* wait: microseconds before it begins */
    int64_t *value;    /* where it adds 1 for each event */
};

static void *complete_late(void *argument)
{
    struct late *late = argument;

    usleep((useconds_t)late->wait);
    for (int i = 0; i < late->n; i++) {
        if (late->value)
            ++*late->value;
        ck_assert_int_eq(duite_complete(rt, late->event[i], i ? 0 : late->code), DUITE_OK);
    }
    free(late);
    return NULL;
}

struct hold_args {
    int events, code, wait; /* events: 0, 1 or 2 */
    int own;                /* the body returns this code */
    int at_once;            /* the body completes them itself */
};

/* Adds 1, and leaves another 1 for each event to another thread. */
KERNEL(HOLD, "hold", .access = {DUITE_RW}, .args_size = sizeof(struct hold_args), .events = 1)
{
    const struct hold_args *args = call->args;
    struct late *late = malloc(sizeof *late);
    pthread_t thread;

    *late = (struct late){.n = args->events,
                          .code = args->code,
                          .wait = args->wait,
                          .value = duite_out(call, 0, int64_t)};
    ++*late->value;
    for (int i = 0; i < args->events; i++)
        ck_assert_int_eq(duite_event_new(call, &late->event[i]), DUITE_OK);
    if (args->at_once) {
        complete_late(late);
    } else {
        ck_assert_int_eq(pthread_create(&thread, NULL, complete_late, late), 0);
        pthread_detach(thread);
    }
    return args->own;
}

/* Leaves its event to the main thread. */
static duite_event left[AT_ONCE];
static _Atomic int n_left;

KERNEL(LEAVE, "leave", .access = {DUITE_RW}, .events = 1)
{
    duite_event event;
    const int code = duite_event_new(call, &event);

    *duite_out(call, 0, int64_t) = 1;
    left[atomic_load(&n_left)] = event;
    atomic_fetch_add(&n_left, 1); /* one worker runs them all */
    return code;
}

KERNEL(TWICE, "twice", .access = {DUITE_R, DUITE_W})
{
    *duite_out(call, 1, int64_t) = 2 * *duite_in(call, 0, int64_t);
    return 0;
}

/* Its kernel has no events. */
KERNEL(WITHOUT, "without")
{
    duite_event event = {1, 1};
    const int code = duite_event_new(call, &event);

    ck_assert_uint_eq(event.slot, 0);
    ck_assert_ptr_nonnull(strstr(duite_message(), "without"));
    return code == DUITE_E_STATE ? 0 : 1;
}

/* Forks a child that is held, and waits for it. */
KERNEL(PARENT, "parent", .access = {DUITE_RWP})
{
    const struct hold_args args = {.events = 2, .wait = LATE};
    int64_t value = 0;

    DUITE_FORK(call->rt, &HOLD, &args, call->param[0].object);
    if (duite_get(call->rt, call->param[0].object, &value))
        return 1;
    return value == 3 ? duite_wait(call->rt) : 2;
}

static void start_with(const duite_kernel *const *kernels, unsigned threads, int check,
                       size_t window)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = kernels;
    options.threads = threads;
    options.check = check;
    options.window = window;
    ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
}

static void start(unsigned threads, int check, size_t window)
{
    static const duite_kernel *const KERNELS[] = {&HOLD, &LEAVE, &TWICE, &WITHOUT, &PARENT, NULL};

    start_with(KERNELS, threads, check, window);
}

static duite_object number(void)
{
    duite_object object;

    ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &object), DUITE_OK);
    return object;
}

static int64_t value_of(duite_object object)
{
    int64_t value = -1;

    ck_assert_msg(!duite_get(rt, object, &value), "%s", duite_message());
    return value;
}

/* Readers see what the other thread wrote, for any number of events, workers and windows. */
UNIT_TEST(results_wait)
{
    for (unsigned threads = 1; threads < 4; threads++)
        for (int check = 0; check < 2; check++) {
            start(threads, check, threads == 2);
            for (int i = 0; i < 12; i++) {
                const struct hold_args args = {
                    .events = i % 3, .wait = i % 2 ? LATE : 0, .at_once = i % 4 == 3};
                const duite_object a = number(), b = number();

                DUITE_FORK(rt, &HOLD, &args, a);
                DUITE_FORK(rt, &HOLD, &args, a);
                DUITE_FORK(rt, &TWICE, NULL, a, b);
                ck_assert_int_eq(value_of(b), 4 * (1 + args.events));
                duite_free(rt, a);
                duite_free(rt, b);
            }
            ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
        }
}

/* Held tasks keep no worker: the one beside the main thread runs many bodies before any event is
 * completed. */
UNIT_TEST(many_at_once)
{
    duite_object object[AT_ONCE];

    start(2, 0, 0);
    for (int i = 0; i < AT_ONCE; i++) {
        object[i] = number();
        DUITE_FORK(rt, &LEAVE, NULL, object[i]);
    }
    for (int ms = 0; ms < 20000 && atomic_load(&n_left) < AT_ONCE; ms++)
        usleep(1000);
    ck_assert_int_eq(atomic_load(&n_left), AT_ONCE);
    for (int i = 0; i < AT_ONCE; i++)
        ck_assert_int_eq(duite_complete(rt, left[i], 0), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    for (int i = 0; i < AT_ONCE; i++) {
        ck_assert_int_eq(value_of(object[i]), 1);
        duite_free(rt, object[i]);
    }
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

struct round {
    const struct hold_args *args;
    duite_object a, b;
};

static int build(duite *runtime, void *context)
{
    const struct round *round = context;

    DUITE_FORK(runtime, &HOLD, round->args, round->a);
    return DUITE_FORK(runtime, &TWICE, NULL, round->a, round->b);
}

static void replay(struct round *round, uint64_t rounds)
{
    duite_graph graph;

    ck_assert_int_eq(duite_graph_new(rt, build, round, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, rounds), DUITE_OK);
    duite_graph_free(rt, graph);
}

/* An event, or the body, fails the task: it poisons, once, and only after the other events. */
UNIT_LOOP(failures, 0, 2)
{
    static const struct hold_args CASES[] = {{.events = 1, .code = 7},
                                             {.events = 2, .code = 7, .wait = LATE},
                                             {.events = 2, .code = 7, .at_once = 1},
                                             {.events = 0, .own = 7},
                                             {.events = 1, .own = 7, .wait = LATE}};
    int64_t value;

    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        start(2, 0, 0);
        const duite_object a = number(), b = number();
        struct round round = {&CASES[i], a, b};
        if (_i)
            replay(&round, 3);
        else
            build(rt, &round);
        ck_assert_int_eq(duite_get(rt, b, &value), 7);
        ck_assert_ptr_nonnull(strstr(duite_message(), "kernel hold"));
        ck_assert_int_eq(duite_wait(rt), 7);
        ck_assert_int_eq(duite_set(rt, a, NULL), DUITE_OK); /* a w heals */
        ck_assert_int_eq(value_of(a), 0);
        duite_free(rt, a);
        duite_free(rt, b);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
}

UNIT_TEST(misuse)
{
    start(1, 0, 0);
    ck_assert_int_eq(duite_fork(rt, &WITHOUT, NULL, 0, NULL), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_complete(rt, (duite_event){0, 0}, 0), DUITE_E_OBJECT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "never made"));
    const struct hold_args args = {.events = 1, .at_once = 1};
    const duite_object a = number();
    DUITE_FORK(rt, &HOLD, &args, a);
    ck_assert_int_eq(value_of(a), 2);
    ck_assert_int_eq(duite_complete(rt, (duite_event){1, 1}, 0), DUITE_E_OBJECT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "completed already"));
    ck_assert_int_eq(duite_complete(rt, (duite_event){9, 1}, 0), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_complete(NULL, (duite_event){1, 1}, 0), DUITE_E_ARGUMENT);
    duite_free(rt, a);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* A body waits for a child that is held, also on its only thread. */
UNIT_TEST(children)
{
    for (unsigned threads = 1; threads < 3; threads++) {
        start(threads, 0, 0);
        const duite_object a = number();
        DUITE_FORK(rt, &PARENT, NULL, a);
        ck_assert_int_eq(value_of(a), 3);
        duite_free(rt, a);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
}

/* Gets the object for longer than a standstill: the report has the sentence. */
static void reports(duite_object object, void *value, const char *sentence)
{
    const int standard_error = dup(STDERR_FILENO);
    FILE *said = tmpfile();
    char text[2000] = "";

    ck_assert_ptr_nonnull(said);
    dup2(fileno(said), STDERR_FILENO);
    const int code = duite_get(rt, object, value);
    dup2(standard_error, STDERR_FILENO);
    ck_assert_int_eq(code, DUITE_OK);
    rewind(said);
    ck_assert_uint_gt(fread(text, 1, sizeof text - 1, said), 0);
    ck_assert_msg(strstr(text, sentence), "%s", text);
    fclose(said);
    close(standard_error);
}

/* The report of a standstill names the task and its event. */
UNIT_TEST(never_completed)
{
    const struct hold_args args = {.events = 1, .wait = 1000000};
    int64_t value = 0;

    setenv("DUITE_STUCK_SECONDS", "0.2", 1);
    start(2, 0, 0);
    const duite_object a = number();
    DUITE_FORK(rt, &HOLD, &args, a);
    reports(a, &value, "(kernel hold) ends when the program completes event 1.1");
    ck_assert_int_eq(value, 2);
    duite_free(rt, a);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* ---- Requests of MPI ---- */

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

/* Keeps MPI: ends, or waits for a child. */
KERNEL(KEEP, "keep", .access = {DUITE_RWP}, .args_size = sizeof(int))
{
    const int waits = *(const int *)call->args;
    int code = duite_mpi_begin(call->rt);

    if (waits && !code) {
        code = DUITE_FORK(call->rt, &HOLD, DUITE_ARGS(struct hold_args, .at_once = 0),
                          call->param[0].object);
        code = code ? code : duite_wait(call->rt);
        duite_fail(call, code, "%s", duite_message());
        ck_assert_int_eq(duite_mpi_end(call->rt), DUITE_OK);
    }
    return code;
}

static const duite_kernel *const MPI_KERNELS[] = {&HOLD,    &TWICE,          &RECEIVE, &SEND_LATE,
                                                  &MISUSES, &WITHOUT_EVENTS, &KEEP,    NULL};

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

UNIT_TEST(replays)
{
    const struct hold_args args = {.events = 1, .wait = 200};
    start(2, 0, 0);
    struct round round = {&args, number(), number()};
    replay(&round, 5);
    ck_assert_int_eq(value_of(round.b), 20);
    duite_free(rt, round.a);
    duite_free(rt, round.b);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}
