/* Checking mode finds what a body does beyond its declaration, and leaves honest programs as they
 * are. */

#include "tests/support/kernel.h"
#include "tests/support/said.h"
#include "tests/support/unit.h"

#include <duite.h>

#include <setjmp.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 10 };

enum deed {
    HONEST,
    WRITE_READ,
    WRITE_ARGS,
    BEYOND_END,
    BEFORE_START,
    FAR_BEYOND,
    READ_BEHIND,
    READ_BEFORE,
    READ_BEHIND_ARGS,
    RETURN_BEHIND,
    UNWRITTEN,
    UNSTEADY,
    UNSTEADY_CODE,
    KEEP,
    USE_KEPT,
    WRITE_KEPT,
    FAIL
};

struct args {
    int32_t deed, where;
};

static int32_t *kept;
static _Atomic int calls;

/* Parameters: r, w, rw, cw. */
static int body(const duite_call *call)
{
    const struct args *args = call->args;
    const int32_t *r = duite_in(call, 0, int32_t);
    int32_t *w = duite_out(call, 1, int32_t), *rw = duite_out(call, 2, int32_t),
            *cw = duite_out(call, 3, int32_t);
    const int n = atomic_fetch_add(&calls, 1);

    for (int i = 0; i < COUNT; i++)
        w[i] = args->deed == UNWRITTEN && i == args->where ? w[i] : r[i] + 1;
    rw[0] += 2;
    cw[args->where] += 3;
    switch ((enum deed)args->deed) {
    case WRITE_READ:
        ((int32_t *)call->param[0].data)[args->where] = 5;
        break;
    case WRITE_ARGS:
        ((struct args *)(uintptr_t)args)->where = 1;
        break;
    case BEYOND_END:
        w[COUNT + args->where] = 1;
        break;
    case BEFORE_START:
        rw[-1] = 1;
        break;
    case FAR_BEYOND:
        w[0] = r[COUNT + 2000];
        break;
    case READ_BEHIND:
        w[args->where] = rw[COUNT] / 2;
        break;
    case READ_BEFORE:
        w[args->where] = r[-1] / 2;
        break;
    case READ_BEHIND_ARGS:
        cw[0] += (&args->where)[args->where];
        break;
    case RETURN_BEHIND:
        return r[COUNT] > 0;
    case UNSTEADY:
        cw[args->where] += n;
        break;
    case UNSTEADY_CODE:
        return n ? duite_fail(call, 9, "now and then") : 0;
    case KEEP:
        kept = rw;
        break;
    case USE_KEPT:
        w[0] = kept[0];
        break;
    case WRITE_KEPT:
        kept[0] = 1;
        break;
    case FAIL:
        return duite_fail(call, 7, "on purpose");
    default:
        break;
    }
    return 0;
}

static const duite_kernel BODY = {.name = "body",
                                  .body = body,
                                  .access = {DUITE_R, DUITE_W, DUITE_RW, DUITE_CW},
                                  .args_size = sizeof(struct args)};
static const duite_kernel ONCE = {.name = "once",
                                  .body = body,
                                  .access = {DUITE_R, DUITE_W, DUITE_RW, DUITE_CW},
                                  .args_size = sizeof(struct args),
                                  .side_effects = 1};

KERNEL(PEEK, "peek", .access = {DUITE_RW})
{
    int32_t *values = duite_out(call, 0, int32_t);

    values[0] = values[duite_count(call, 0)];
    return 0;
}

static duite *rt;
static duite_object object[4];

static void start(int check)
{
    const duite_kernel *kernels[] = {&BODY, &ONCE, NULL};
    duite_options options = duite_options_default();

    options.kernels = kernels;
    options.threads = 2;
    options.bind = 0;
    options.check = check;
    ck_assert_msg(duite_start(&rt, &options) == DUITE_OK, "%s", duite_message());
    for (int i = 0; i < 4; i++)
        ck_assert_int_eq(duite_new(rt, DUITE_I32, COUNT, &object[i]), DUITE_OK);
    atomic_store(&calls, 0);
}

static void stop(void)
{
    for (int i = 0; i < 4; i++)
        duite_free(rt, object[i]);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

static int run(const duite_kernel *kernel, enum deed deed, int where)
{
    duite_fork(rt, kernel, &(struct args){(int32_t)deed, where}, 4, object);
    return duite_wait(rt);
}

static void found(enum deed deed, int where, const char *sentence)
{
    start(1);
    ck_assert_msg(run(&BODY, deed, where) == DUITE_E_CHECK, "%d: %s", deed, duite_message());
    ck_assert_msg(strstr(duite_message(), sentence) && strstr(duite_message(), "kernel body"), "%s",
                  duite_message());
    duite_set(rt, object[1], NULL);
    duite_set(rt, object[2], NULL);
    duite_set(rt, object[3], NULL);
    ck_assert_msg(run(&BODY, HONEST, 0) == DUITE_OK, "and goes on: %s", duite_message());
    stop();
}

UNIT_TEST(a_write_under_r)
{
    found(WRITE_READ, 3, "writes to parameter 0, which it only reads: byte 12");
}

UNIT_TEST(a_write_to_the_arguments)
{
    found(WRITE_ARGS, 0, "writes to its arguments or beyond (byte 4 of 8)");
}

UNIT_TEST(beyond_the_ends)
{
    found(BEYOND_END, 0, "writes beyond an end of parameter 1 (40 bytes)");
    found(BEYOND_END, 6, "goes beyond parameter 1: to byte 64 of 40");
    found(BEFORE_START, 0, "writes beyond an end of parameter 2");
    found(FAR_BEYOND, 0, "goes beyond parameter 0: to byte 8040 of 40");
}

/* 40 bytes do not end where a page does: these reads do not fault. */
UNIT_TEST(reads_beyond_the_ends)
{
    found(READ_BEHIND, 3, "goes beyond parameter 2: it reads before or behind its 40 bytes");
    found(READ_BEFORE, 0, "goes beyond parameter 0: it reads before or behind its 40 bytes");
    found(READ_BEHIND_ARGS, 1,
          "goes beyond its arguments: it reads before or behind their 8 bytes");
    found(RETURN_BEHIND, 0, "goes beyond parameter 0: it reads");
}

/* As many elements as it has, though there is room for more, which holds no values yet. */
UNIT_TEST(reads_beyond_the_size)
{
    const duite_kernel *kernels[] = {&PEEK, NULL};
    duite_options options = duite_options_default();
    duite_object sized;

    options.kernels = kernels;
    options.check = 1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 3, 20, &sized), DUITE_OK);
    duite_fork(rt, &PEEK, NULL, 1, &sized);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_CHECK);
    unit_says(duite_message(), "goes beyond parameter 0: it reads");
    duite_free(rt, sized);
    duite_stop(&rt);
}

UNIT_TEST(bytes_that_w_left_unwritten)
{
    found(UNWRITTEN, 0, "leaves parameter 1, which it overwrites, unwritten at byte 0");
    found(UNWRITTEN, COUNT - 1, "unwritten at byte 36");
}

UNIT_TEST(kernels_that_are_not_deterministic)
{
    found(UNSTEADY, 4, "is not deterministic: two runs differ in parameter 3 at byte 16");
    found(UNSTEADY_CODE, 0, "is not deterministic: it returns 0 and then 9");
}

UNIT_TEST(stale_pointers)
{
    const enum deed uses[] = {USE_KEPT, WRITE_KEPT};
    for (int i = 0; i < 2; i++) {
        start(1);
        ck_assert_int_eq(run(&BODY, KEEP, 0), DUITE_OK);
        ck_assert_int_eq(run(&BODY, uses[i], 0), DUITE_E_CHECK);
        unit_says(duite_message(),
                  "uses what was parameter 2 of task 1 (kernel body), which is over");
        stop();
    }
}

static void values(int32_t (*value)[COUNT])
{
    for (int i = 0; i < 4; i++)
        ck_assert_int_eq(duite_get(rt, object[i], value[i]), DUITE_OK);
}

UNIT_TEST(honest_programs_are_as_without)
{
    int32_t value[2][4][COUNT];
    for (int check = 0; check < 2; check++) {
        start(check);
        for (int i = 0; i < 20; i++)
            ck_assert_int_eq(run(i % 2 ? &BODY : &ONCE, HONEST, i % COUNT), DUITE_OK);
        ck_assert_int_eq(atomic_load(&calls), check ? 30 : 20); /* ONCE runs once */
        values(value[check]);
        stop();
    }
    ck_assert_mem_eq(value[0], value[1], sizeof value[0]);
    ck_assert_int_eq(value[0][2][0], 40);
}

/* Makes its object as long as its argument says, one element after the other. */
KERNEL(GROW, "grow", .access = {DUITE_RW}, .args_size = sizeof(int32_t))
{
    const int32_t n = *(const int32_t *)call->args;
    int code = duite_resize(call, 0, (size_t)n);
    for (int32_t i = 0; i < n && !code; i++)
        duite_out(call, 0, int32_t)[i] += i;
    return code;
}

UNIT_TEST(objects_that_change_size)
{
    const int32_t sizes[] = {3, 20, 7, 12};
    const duite_kernel *kernels[] = {&GROW, NULL};
    duite_options options = duite_options_default();
    duite_object sized;
    int32_t value[20];
    size_t count = 0;

    options.kernels = kernels;
    options.check = 1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 1, 20, &sized), DUITE_OK);
    for (int i = 0; i < 4; i++)
        duite_fork(rt, &GROW, &sizes[i], 1, &sized);
    ck_assert_int_eq(duite_get_count(rt, sized, &count), DUITE_OK);
    ck_assert_uint_eq(count, 12);
    ck_assert_int_eq(duite_get(rt, sized, value), DUITE_OK);
    for (int32_t i = 0; i < 12; i++)
        ck_assert_int_eq(value[i], i < 3 ? 4 * i : i < 7 ? 3 * i : i);
    duite_fork(rt, &GROW, &(int32_t){21}, 1, &sized);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_SIZE);
    duite_free(rt, sized);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

UNIT_TEST(a_failing_body_keeps_its_code)
{
    start(1);
    ck_assert_int_eq(run(&BODY, FAIL, 0), 7);
    unit_says(duite_message(), "on purpose");
    ck_assert_int_eq(atomic_load(&calls), 1);
    stop();
}

static sigjmp_buf out;

static void on_segv(int signal)
{
    siglongjmp(out, signal);
}

UNIT_TEST(other_faults_go_to_the_handler_there_was)
{
    volatile int *volatile nowhere = (int *)8;
    signal(SIGSEGV, on_segv);
    start(1);
    if (!sigsetjmp(out, 1)) {
        *nowhere = 1;
        ck_abort_msg("nothing happened");
    }
    stop();
    if (!sigsetjmp(out, 1)) {
        *nowhere = 1;
        ck_abort_msg("nothing happened after stop");
    }
}

/* The program uses what it kept, and the handler before is called. */
static void faults_with_a_sentence(const char *sentence)
{
    said_begin();
    if (!sigsetjmp(out, 1)) {
        *(volatile int32_t *)kept = 1;
        ck_abort_msg("nothing happened");
    }
    ck_assert_int_eq(said_lines("duite: the program ", sentence), 1);
    said_end();
}

/* Data of a turn, used by a body and by the program when it is over. */
UNIT_TEST(released_pointers)
{
    signal(SIGSEGV, on_segv);
    for (int mode = DUITE_R; mode <= DUITE_RW; mode++) {
        duite_object mine;
        void *data;
        int32_t value[COUNT];

        start(1);
        ck_assert_int_eq(duite_new(rt, DUITE_I32, COUNT, &mine), DUITE_OK);
        ck_assert_int_eq(duite_acquire(rt, mine, (duite_mode)mode, &data), DUITE_OK);
        kept = data;
        kept[COUNT - 1] = 5;
        ck_assert_int_eq(duite_release(rt, mine), DUITE_OK);
        ck_assert_int_eq(duite_get(rt, mine, value), DUITE_OK);
        ck_assert_int_eq(value[COUNT - 1], mode == DUITE_R ? 0 : 5);
        ck_assert_int_eq(run(&BODY, USE_KEPT, 0), DUITE_E_CHECK);
        unit_says(duite_message(), "after duite_release");
        faults_with_a_sentence("after duite_release");
        duite_free(rt, mine);
        stop();
    }
}

UNIT_TEST(by_the_environment)
{
    setenv("DUITE_CHECK", "accesses", 1);
    ck_assert_int_eq(duite_options_default().check, 1);
    setenv("DUITE_CHECK", "everything", 1);
    duite_options options = duite_options_default();
    options.kernels = (const duite_kernel *[]){&BODY, NULL};
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    unit_says(duite_message(), "DUITE_CHECK");
}
