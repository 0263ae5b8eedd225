/* Values that the bodies and the main program share are atomic; the expected values are the main
 * program's. */
#include "tests/runtime/repeated.h"

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <string.h>

atomic_int repeated_over, repeated_held, repeated_held_at;

uint32_t repeated_mixed(uint32_t to, uint32_t from, uint32_t number)
{
    return to * 31 + from * 7 + number;
}

#define MIX_ACCESS                                                                                 \
    {                                                                                              \
        DUITE_RW, DUITE_R                                                                          \
    }
KERNEL_SHARED(MIX, "mix", .access = MIX_ACCESS, .args_size = sizeof(struct repeated_argument))
{
    const struct repeated_argument *args = call->args;
    uint32_t *to = duite_out(call, 0, uint32_t);

    *to = repeated_mixed(*to, *duite_in(call, 1, uint32_t), args->number);
    while (args->number && args->number == (uint32_t)atomic_load(&repeated_held_at))
        ;
    atomic_fetch_add(&repeated_over, 1);
    if (call->round)
        return duite_fail(call, 18, "there is no replay");
    return args->fails ? duite_fail(call, args->fails, "mix %u", args->number) : 0;
}

KERNEL_SHARED(HOLD, "hold", .access = {DUITE_RW})
{
    (void)call;
    while (atomic_load(&repeated_held))
        ;
    return 0;
}

KERNEL_SHARED(LOOK, "look", .access = {DUITE_R})
{
    (void)call;
    return 0;
}

/* Waits in its body for what it was lent. */
KERNEL_SHARED(ASK, "ask", .access = {DUITE_RP, DUITE_W})
{
    return duite_get(call->rt, call->param[0].object, duite_out(call, 1, uint32_t));
}

KERNEL_SHARED(PUT, "put", .access = {DUITE_W, DUITE_R},
              .args_size = sizeof(struct repeated_argument))
{
    const struct repeated_argument *args = call->args;

    *duite_out(call, 0, uint32_t) = repeated_mixed(1, *duite_in(call, 1, uint32_t), args->number);
    return args->fails;
}

const duite_kernel TWIN = {.name = "twin",
                           .body = MIX_body,
                           .access = MIX_ACCESS,
                           .args_size = sizeof(struct repeated_argument)};

duite_options repeated_options(int memo)
{
    static const duite_kernel *const KERNELS[] = {&MIX, &TWIN, &PUT, &HOLD, &LOOK, &ASK, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.threads = 2;
    options.memo = memo;
    return options;
}

struct repeated repeated_start(const duite_options *options)
{
    struct repeated program = {0};

    misuse_mpi();
    atomic_store(&repeated_over, 0);
    ck_assert_int_eq(duite_start(&program.rt, options), DUITE_OK);
    for (int i = 0; i < OBJECTS; i++)
        program.object[i] = misuse_new(program.rt, 1);
    return program;
}

void repeated_fork(struct repeated *program, const duite_kernel *kernel, int to, int from,
                   int fails)
{
    struct repeated_argument args = {.number = program->forks++, .fails = fails};

    ck_assert_int_eq(
        DUITE_FORK(program->rt, kernel, &args, program->object[to], program->object[from]),
        DUITE_OK);
    memset(&args, 0xee, sizeof args);
    program->value[to] =
        repeated_mixed(program->value[to], program->value[from], program->forks - 1);
}

void repeated_round(struct repeated *program)
{
    for (int i = 0; i < OBJECTS; i++)
        repeated_fork(program, &MIX, i, (i + 3) % OBJECTS, 0);
}

void repeated_expect(struct repeated *program, int i)
{
    uint32_t value = 0;

    ck_assert_int_eq(duite_get(program->rt, program->object[i], &value), DUITE_OK);
    ck_assert_uint_eq(value, program->value[i]);
}

uint64_t repeated_recognised(struct repeated *program)
{
    duite_counters counters;

    ck_assert_int_eq(duite_count_all(program->rt, &counters), DUITE_OK);
    ck_assert_uint_le(counters.recognised_rounds, counters.recognised);
    return counters.recognised;
}

uint64_t repeated_stop(struct repeated *program)
{
    const uint64_t tasks = repeated_recognised(program);

    for (int i = 0; i < OBJECTS; i++) {
        repeated_expect(program, i);
        duite_free(program->rt, program->object[i]);
    }
    ck_assert_int_eq(duite_stop(&program->rt), DUITE_OK);
    return tasks;
}
