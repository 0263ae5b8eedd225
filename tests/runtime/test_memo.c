/* Repeated forks are recognised, and nobody can tell but by the counters. What the main program
 * forks is worked out here as well, one task after the other. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OBJECTS = 8, ROUNDS = 60, ALWAYS = 2 };

struct argument {
    uint32_t number;
    int32_t fails;
    char padding[56];
};

static atomic_int n_over;        /* bodies */
static atomic_int held, held_at; /* the number of the task that is held; 0: none */

static uint32_t mixed(uint32_t to, uint32_t from, uint32_t number)
{
    return to * 31 + from * 7 + number;
}

static int mix(const duite_call *call)
{
    const struct argument *args = call->args;
    uint32_t *to = duite_out(call, 0, uint32_t);

    *to = mixed(*to, *duite_in(call, 1, uint32_t), args->number);
    while (args->number && args->number == (uint32_t)atomic_load(&held_at))
        ;
    atomic_fetch_add(&n_over, 1);
    if (call->round)
        return duite_fail(call, 18, "there is no replay");
    return args->fails ? duite_fail(call, args->fails, "mix %u", args->number) : 0;
}

static int hold(const duite_call *call)
{
    (void)call;
    while (atomic_load(&held))
        ;
    return 0;
}

static int look(const duite_call *call)
{
    (void)call;
    return 0;
}

static int put(const duite_call *call)
{
    const struct argument *args = call->args;

    *duite_out(call, 0, uint32_t) = mixed(1, *duite_in(call, 1, uint32_t), args->number);
    return args->fails;
}

static const duite_kernel PUT = {
    .name = "put", .body = put, .access = {DUITE_W, DUITE_R}, .args_size = sizeof(struct argument)};
#define MIX_ACCESS                                                                                 \
    {                                                                                              \
        DUITE_RW, DUITE_R                                                                          \
    }
static const duite_kernel MIX = {.name = "mix",
                                 .body = mix,
                                 .access = MIX_ACCESS,
                                 .args_size = sizeof(struct argument)},
                          TWIN = {.name = "twin",
                                  .body = mix,
                                  .access = MIX_ACCESS,
                                  .args_size = sizeof(struct argument)},
                          HOLD = {.name = "hold", .body = hold, .access = {DUITE_RW}},
                          LOOK = {.name = "look", .body = look, .access = {DUITE_R}};

struct program {
    duite *rt;
    duite_object object[OBJECTS];
    uint32_t value[OBJECTS]; /* as it should be */
    uint32_t forks;
};

static duite_options memo_options(int memo)
{
    static const duite_kernel *const KERNELS[] = {&MIX, &TWIN, &PUT, &HOLD, &LOOK, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.threads = 2;
    options.memo = memo;
    return options;
}

static void start(struct program *program, const duite_options *options)
{
    misuse_mpi();
    *program = (struct program){0};
    atomic_store(&n_over, 0);
    ck_assert_int_eq(duite_start(&program->rt, options), DUITE_OK);
    for (int i = 0; i < OBJECTS; i++)
        program->object[i] = misuse_new(program->rt, 1);
}

static void fork_mix(struct program *program, const duite_kernel *kernel, int to, int from,
                     int fails)
{
    struct argument args = {.number = program->forks++, .fails = fails};

    ck_assert_int_eq(
        DUITE_FORK(program->rt, kernel, &args, program->object[to], program->object[from]),
        DUITE_OK);
    memset(&args, 0xee, sizeof args);
    program->value[to] = mixed(program->value[to], program->value[from], program->forks - 1);
}

static void fork_round(struct program *program)
{
    for (int i = 0; i < OBJECTS; i++)
        fork_mix(program, &MIX, i, (i + 3) % OBJECTS, 0);
}

static void expect_value(struct program *program, int i)
{
    uint32_t value = 0;

    ck_assert_int_eq(duite_get(program->rt, program->object[i], &value), DUITE_OK);
    ck_assert_uint_eq(value, program->value[i]);
}

static uint64_t recognised(struct program *program)
{
    duite_counters counters;

    ck_assert_int_eq(duite_count_all(program->rt, &counters), DUITE_OK);
    ck_assert_uint_le(counters.recognised_rounds, counters.recognised);
    return counters.recognised;
}

/* Returns the tasks that were recognised. */
static uint64_t stop(struct program *program)
{
    const uint64_t tasks = recognised(program);

    for (int i = 0; i < OBJECTS; i++) {
        expect_value(program, i);
        duite_free(program->rt, program->object[i]);
    }
    ck_assert_int_eq(duite_stop(&program->rt), DUITE_OK);
    return tasks;
}

static uint64_t run_rounds(const duite_options *options)
{
    struct program program;

    start(&program, options);
    for (int i = 0; i < ROUNDS; i++)
        fork_round(&program);
    return stop(&program);
}

START_TEST(rounds_are_recognised)
{
    duite_options options = memo_options(ALWAYS);

    for (options.threads = 1; options.threads <= 3; options.threads++)
        for (options.window = 0; options.window < 20; options.window = 4 * options.window + 1)
            ck_assert_uint_ge(run_rounds(&options), OBJECTS * ROUNDS / 2);
}
END_TEST

START_TEST(nothing_is_recognised_where_it_is_off)
{
    duite_options off = memo_options(0), checked = memo_options(ALWAYS);
    duite_options traced = memo_options(ALWAYS), renamed = memo_options(ALWAYS);
    char trace[] = "/tmp/test_memo_XXXXXX";
    const int file = mkstemp(trace);

    ck_assert_int_ge(file, 0);
    checked.check = 1;
    traced.trace = trace;
    renamed.rename_bytes = 1 << 20;
    ck_assert_uint_eq(run_rounds(&off), 0);
    ck_assert_uint_eq(run_rounds(&checked), 0);
    ck_assert_uint_eq(run_rounds(&traced), 0);
    ck_assert_uint_eq(run_rounds(&renamed), 0);
    close(file);
    unlink(trace);
}
END_TEST

START_TEST(the_environment_switches_it_off)
{
    duite_options options;

    setenv("DUITE_MEMO", "0", 1);
    ck_assert_int_eq(duite_options_default().memo, 0);
    setenv("DUITE_MEMO", "always", 1);
    ck_assert_int_eq(duite_options_default().memo, ALWAYS);
    setenv("DUITE_MEMO", "perhaps", 1);
    options = memo_options(duite_options_default().memo);
    misuse_mpi();
    duite *rt = NULL;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    ck_assert_str_eq(
        duite_message(),
        "duite_start: DUITE_MEMO=perhaps in the environment: 0, 1 or always is expected");
    unsetenv("DUITE_MEMO");
    ck_assert_int_eq(duite_options_default().memo, 1);
}
END_TEST

/* In the middle of a round. */
static void do_other(struct program *program, int what, int i)
{
    const uint32_t value = 5;
    const struct argument args = {.number = program->forks};
    const duite_object pair[] = {program->object[i], program->object[0]};
    const int here = 0;
    const duite_task_options how = {.priority = 3, .at = &here};
    duite_object spare;

    if (what == 0) {
        expect_value(program, i);
    } else if (what == 1) {
        ck_assert_int_eq(duite_wait(program->rt), DUITE_OK);
    } else if (what == 2) {
        ck_assert_int_eq(duite_set(program->rt, program->object[i], &value), DUITE_OK);
        program->value[i] = value;
    } else if (what == 3) {
        fork_mix(program, &TWIN, i, 0, 0);
    } else if (what == 4) {
        fork_mix(program, &MIX, i, 0, 0);
    } else if (what == 5) {
        ck_assert_int_eq(duite_fork_with(program->rt, &how, &MIX, &args, 2, pair), DUITE_OK);
        program->value[i] = mixed(program->value[i], program->value[0], program->forks++);
    } else if (what == 6) {
        ck_assert_int_eq(duite_fork(program->rt, &MIX, NULL, 2, pair), DUITE_E_ARGUMENT);
        ck_assert_int_eq(duite_wait(program->rt), DUITE_E_ARGUMENT);
    } else if (what == 7) {
        ck_assert_int_eq(duite_new(program->rt, DUITE_I32, 1, &spare), DUITE_OK);
        ck_assert_int_eq(duite_free(program->rt, spare), DUITE_OK);
    } else {
        ck_assert_int_eq(duite_free(program->rt, program->object[i]), DUITE_OK);
        program->object[i] = misuse_new(program->rt, 1);
        program->value[i] = 0;
    }
}

START_TEST(anything_else_ends_it)
{
    duite_options options = memo_options(ALWAYS);

    for (int what = 0; what < 9; what++)
        for (options.window = 0; options.window < 3; options.window += 2) {
            struct program program;

            start(&program, &options);
            for (int i = 0; i < 3 * ROUNDS; i++) {
                for (int k = 0; k < OBJECTS; k++) {
                    if (i % ROUNDS == 40 && k == 5)
                        do_other(&program, what, 1 + i / ROUNDS);
                    fork_mix(&program, &MIX, k, (k + 3) % OBJECTS, 0);
                }
            }
            ck_assert_uint_ge(stop(&program), ROUNDS * OBJECTS / 3);
        }
}
END_TEST

/* The message names the task by its number. */
static void fail_at(int memo, int fails_at, char *message, size_t size)
{
    const duite_options options = memo_options(memo);
    struct program program;

    start(&program, &options);
    for (int i = 0; i < ROUNDS * OBJECTS; i++)
        fork_mix(&program, &MIX, i % OBJECTS, (i + 3) % OBJECTS, i == fails_at ? 17 : 0);
    ck_assert_int_eq(duite_wait(program.rt), 17);
    snprintf(message, size, "%s", duite_message());
    ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
    for (int i = 0; i < OBJECTS; i++) {
        ck_assert_int_eq(duite_set(program.rt, program.object[i], NULL), DUITE_OK);
        program.value[i] = 0;
    }
    ck_assert_uint_ge(stop(&program), memo ? 100 : 0);
}

START_TEST(failures_are_the_same)
{
    char without[1000], with[1000];

    for (int at = 0; at < ROUNDS * OBJECTS; at += 37) {
        fail_at(0, at, without, sizeof without);
        fail_at(ALWAYS, at, with, sizeof with);
        ck_assert_str_eq(with, without);
    }
}
END_TEST

/* A round that ends early leaves the poison of what it would have overwritten. */
static void end_early(int forks, int fails_at)
{
    const duite_options options = memo_options(ALWAYS);
    int poisoned[OBJECTS] = {0};
    struct program program;
    uint32_t value;

    start(&program, &options);
    for (int i = 0; i < forks; i++) {
        const int to = i % OBJECTS, from = (i + 3) % OBJECTS;
        const struct argument args = {.number = program.forks++, .fails = i == fails_at ? 17 : 0};

        DUITE_FORK(program.rt, &PUT, &args, program.object[to], program.object[from]);
        poisoned[to] = args.fails || poisoned[from];
        program.value[to] = mixed(1, program.value[from], args.number);
    }
    for (int i = 0; i < OBJECTS; i++)
        if (poisoned[i])
            ck_assert_int_eq(duite_get(program.rt, program.object[i], &value), 17);
        else
            expect_value(&program, i);
    for (int i = 0; i < OBJECTS; i++)
        duite_free(program.rt, program.object[i]);
    ck_assert_int_eq(duite_stop(&program.rt), 17);
}

START_TEST(a_round_may_end_anywhere)
{
    for (int forks = 70; forks < 70 + 3 * OBJECTS; forks++)
        for (int back = 1; back < OBJECTS; back++)
            end_early(forks, forks - back);
}
END_TEST

/* The main program runs ahead of the bodies by more rounds than a ring has. */
START_TEST(rings_turn)
{
    duite_options options = memo_options(ALWAYS);

    for (options.window = 0; options.window <= 1000; options.window += 1000) {
        struct program program;

        start(&program, &options);
        for (int i = 0; i < (unit_quick() ? 4000 : 12000); i++)
            fork_round(&program);
        ck_assert_uint_ge(stop(&program), 1000);
    }
}
END_TEST

/* A task in the middle of a replay is held until a ring is full; its slot is not written again. */
START_TEST(a_full_ring_is_left)
{
    const duite_options options = memo_options(ALWAYS);
    struct program program;

    start(&program, &options);
    atomic_store(&held_at, 300 * OBJECTS);
    for (int i = 0; i < 6000; i++)
        fork_round(&program);
    atomic_store(&held_at, 0);
    ck_assert_uint_ge(stop(&program), 1000);
}
END_TEST

/* More arguments than a ring has room for, and no task of theirs can run. */
START_TEST(forks_go_ahead)
{
    const duite_options options = memo_options(ALWAYS);
    struct program program;

    start(&program, &options);
    for (int again = 0; again < 2; again++) {
        atomic_store(&held, 1);
        for (int i = 0; i < OBJECTS; i++)
            ck_assert_int_eq(DUITE_FORK(program.rt, &HOLD, NULL, program.object[i]), DUITE_OK);
        for (int i = 0; i < 4000; i++)
            fork_round(&program);
        ck_assert_int_eq(atomic_load(&n_over), again * 4000 * OBJECTS);
        atomic_store(&held, 0);
        ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
    }
    ck_assert_uint_ge(stop(&program), 1000);
}
END_TEST

/* A task may run as soon as it is forked, whatever comes after it. */
START_TEST(forks_are_not_held_back)
{
    const duite_options options = memo_options(ALWAYS);
    struct program program;

    start(&program, &options);
    for (int i = 0; i < ROUNDS; i++)
        for (int k = 0; k < OBJECTS; k++) {
            fork_mix(&program, &MIX, k, (k + 3) % OBJECTS, 0);
            while (atomic_load(&n_over) < i * OBJECTS + k + 1)
                ;
        }
    ck_assert_uint_ge(stop(&program), OBJECTS * ROUNDS / 2);
}
END_TEST

/* More rounds than there are plans, each of them again and again. */
START_TEST(rounds_take_turns)
{
    const duite_options options = memo_options(ALWAYS);
    struct program program;

    start(&program, &options);
    for (int turn = 0; turn < 3; turn++)
        for (int kind = 1; kind < 13; kind++)
            for (int i = 0; i < ROUNDS; i++)
                for (int k = 0; k < 2 + kind; k++)
                    fork_mix(&program, k % 3 ? &MIX : &TWIN, k * kind % OBJECTS,
                             (k * kind + 1) % OBJECTS, 0);
    ck_assert_uint_ge(stop(&program), 5000);
}
END_TEST

/* Such rounds are compiled at once: when bodies are known to be short, a few rounds are enough.
 * They look long where another program takes the core meanwhile, which does not happen every time.
 */
START_TEST(short_rounds_are_recognised_at_once)
{
    duite_options options = memo_options(1);
    uint64_t most = 0;

    options.threads = 1;
    for (int attempt = 0; attempt < 10 && most < 5 * OBJECTS; attempt++) {
        struct program program;

        start(&program, &options);
        for (int i = 0; i < 5; i++) /* too few to be recognised */
            fork_round(&program);
        ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
        for (int i = 0; i < 20; i++)
            fork_round(&program);
        most = stop(&program);
    }
    ck_assert_uint_ge(most, 5 * OBJECTS);
}
END_TEST

/* So long that a thread compiles them; how many forks come before it has done so is anybody's
 * guess. */
START_TEST(long_rounds_are_right)
{
    const duite_options options = memo_options(1);
    struct program program;

    start(&program, &options);
    for (int i = 0; i < 200; i++)
        for (int k = 0; k < 300; k++) {
            const int to = k * k / 3 % OBJECTS;

            fork_mix(&program, k % 7 ? &MIX : &TWIN, to, (to + 1 + k % 5) % OBJECTS, 0);
        }
    stop(&program);
}
END_TEST

START_TEST(tasks_that_write_nothing_stay_forks)
{
    const duite_options options = memo_options(ALWAYS);
    struct program program;

    start(&program, &options);
    for (int i = 0; i < ROUNDS * OBJECTS; i++)
        ck_assert_int_eq(DUITE_FORK(program.rt, &LOOK, NULL, program.object[0]), DUITE_OK);
    ck_assert_uint_eq(stop(&program), 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("memo");
    TCase *memo = tcase_create("memo");

    tcase_add_test(memo, rounds_are_recognised);
    tcase_add_test(memo, nothing_is_recognised_where_it_is_off);
    tcase_add_test(memo, the_environment_switches_it_off);
    tcase_add_test(memo, anything_else_ends_it);
    tcase_add_test(memo, failures_are_the_same);
    tcase_add_test(memo, a_round_may_end_anywhere);
    tcase_add_test(memo, rings_turn);
    tcase_add_test(memo, a_full_ring_is_left);
    tcase_add_test(memo, forks_go_ahead);
    tcase_add_test(memo, forks_are_not_held_back);
    tcase_add_test(memo, rounds_take_turns);
    tcase_add_test(memo, short_rounds_are_recognised_at_once);
    tcase_add_test(memo, long_rounds_are_right);
    tcase_add_test(memo, tasks_that_write_nothing_stay_forks);
    suite_add_tcase(suite, memo);
    return unit_run(suite);
}
