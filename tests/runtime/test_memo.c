/* Repeated forks are recognised, and nobody can tell but by the counters: values, failures, and
 * whatever comes in between are as of forks. */
#include "runtime/api/instance.h"
#include "runtime/plan/memo_round.h"
#include "tests/negative/misuse.h"
#include "tests/runtime/repeated.h"
#include "tests/support/unit.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static uint64_t run_rounds(const duite_options *options)
{
    struct repeated program = repeated_start(options);
    for (int i = 0; i < ROUNDS; i++)
        repeated_round(&program);
    return repeated_stop(&program);
}

UNIT_TEST(rounds_are_recognised)
{
    duite_options options = repeated_options(ALWAYS);

    for (options.threads = 1; options.threads <= 3; options.threads++)
        for (options.window = 0; options.window < 20; options.window = 4 * options.window + 1)
            ck_assert_uint_ge(run_rounds(&options), OBJECTS * ROUNDS / 2);
}

UNIT_TEST(nothing_is_recognised_where_it_is_off)
{
    duite_options off = repeated_options(0), checked = repeated_options(ALWAYS);
    duite_options traced = repeated_options(ALWAYS);
    char trace[] = "/tmp/test_memo_XXXXXX";
    const int file = mkstemp(trace);

    ck_assert_int_ge(file, 0);
    checked.check = 1;
    traced.trace = trace;
    ck_assert_uint_eq(run_rounds(&off), 0);
    ck_assert_uint_eq(run_rounds(&checked), 0);
    ck_assert_uint_eq(run_rounds(&traced), 0);
    close(file);
    unlink(trace);
}

UNIT_TEST(the_environment_switches_it_off)
{
    duite_options options;

    setenv("DUITE_MEMO", "0", 1);
    ck_assert_int_eq(duite_options_default().memo, 0);
    setenv("DUITE_MEMO", "always", 1);
    ck_assert_int_eq(duite_options_default().memo, ALWAYS);
    setenv("DUITE_MEMO", "perhaps", 1);
    options = repeated_options(duite_options_default().memo);
    misuse_mpi();
    duite *rt = NULL;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    ck_assert_str_eq(
        duite_message(),
        "duite_start: DUITE_MEMO=perhaps in the environment: 0, 1 or always is expected");
    unsetenv("DUITE_MEMO");
    ck_assert_int_eq(duite_options_default().memo, 1);
}

/* In the middle of a round. */
static void do_other(struct repeated *program, int what, int i)
{
    const uint32_t value = 5;
    const struct repeated_argument args = {.number = program->forks};
    const duite_object pair[] = {program->object[i], program->object[0]};
    const int here = 0;
    const duite_task_options how = {.priority = 3, .at = &here};
    duite_object spare;

    if (what == 0) {
        repeated_expect(program, i);
    } else if (what == 1) {
        ck_assert_int_eq(duite_wait(program->rt), DUITE_OK);
    } else if (what == 2) {
        ck_assert_int_eq(duite_set(program->rt, program->object[i], &value), DUITE_OK);
        program->value[i] = value;
    } else if (what == 3) {
        repeated_fork(program, &TWIN, i, 0, 0);
    } else if (what == 4) {
        repeated_fork(program, &MIX, i, 0, 0);
    } else if (what == 5) {
        ck_assert_int_eq(duite_fork_with(program->rt, &how, &MIX, &args, 2, pair), DUITE_OK);
        program->value[i] = repeated_mixed(program->value[i], program->value[0], program->forks++);
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

UNIT_TEST(anything_else_ends_it)
{
    duite_options options = repeated_options(ALWAYS);

    for (int what = 0; what < 9; what++)
        for (options.window = 0; options.window < 3; options.window += 2) {
            struct repeated program = repeated_start(&options);
            for (int i = 0; i < 3 * ROUNDS; i++) {
                for (int k = 0; k < OBJECTS; k++) {
                    if (i % ROUNDS == 40 && k == 5)
                        do_other(&program, what, 1 + i / ROUNDS);
                    repeated_fork(&program, &MIX, k, (k + 3) % OBJECTS, 0);
                }
            }
            ck_assert_uint_ge(repeated_stop(&program), ROUNDS * OBJECTS / 3);
        }
}

/* Rounds on half of the objects, and after them tasks that begin at once and wait in their bodies
 * for what the rounds wrote. */
static void ask_after_rounds(const duite_options *options)
{
    const int half = OBJECTS / 2;

    struct repeated program = repeated_start(options);
    for (int turn = 0; turn < 3; turn++) {
        repeated_round(&program);
        repeated_expect(&program, 0);
        for (int i = 0; i < ROUNDS * half; i++)
            ck_assert_int_eq(DUITE_FORK(program.rt, &HOLD, NULL, program.object[i % half]),
                             DUITE_OK);
        for (int i = 0; i <= turn; i++) {
            const duite_object to = program.object[half + i];
            ck_assert_int_eq(DUITE_FORK(program.rt, &ASK, NULL, program.object[i], to), DUITE_OK);
            program.value[half + i] = program.value[i];
        }
        repeated_expect(&program, half);
    }
    ck_assert_uint_ge(repeated_stop(&program), ROUNDS * half);
}

UNIT_TEST(tasks_that_wait_come_after_rounds)
{
    duite_options options = repeated_options(ALWAYS);

    for (options.threads = 1; options.threads <= 4; options.threads++)
        ask_after_rounds(&options);
}

/* The message names the task by its number. */
static void fail_at(int memo, int fails_at, char *message, size_t size)
{
    const duite_options options = repeated_options(memo);

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < ROUNDS * OBJECTS; i++)
        repeated_fork(&program, &MIX, i % OBJECTS, (i + 3) % OBJECTS, i == fails_at ? 17 : 0);
    ck_assert_int_eq(duite_wait(program.rt), 17);
    snprintf(message, size, "%s", duite_message());
    ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
    for (int i = 0; i < OBJECTS; i++) {
        ck_assert_int_eq(duite_set(program.rt, program.object[i], NULL), DUITE_OK);
        program.value[i] = 0;
    }
    ck_assert_uint_ge(repeated_stop(&program), memo ? 100 : 0);
}

UNIT_TEST(failures_are_the_same)
{
    char without[1000], with[1000];

    for (int at = 0; at < ROUNDS * OBJECTS; at += 37) {
        fail_at(0, at, without, sizeof without);
        fail_at(ALWAYS, at, with, sizeof with);
        ck_assert_str_eq(with, without);
    }
}

/* A round that ends early leaves the poison of what it would have overwritten. */
static void end_early(int forks, int fails_at)
{
    const duite_options options = repeated_options(ALWAYS);
    int poisoned[OBJECTS] = {0};
    uint32_t value;

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < forks; i++) {
        const int to = i % OBJECTS, from = (i + 3) % OBJECTS;
        const struct repeated_argument args = {.number = program.forks++,
                                               .fails = i == fails_at ? 17 : 0};

        DUITE_FORK(program.rt, &PUT, &args, program.object[to], program.object[from]);
        poisoned[to] = args.fails || poisoned[from];
        program.value[to] = repeated_mixed(1, program.value[from], args.number);
    }
    for (int i = 0; i < OBJECTS; i++)
        if (poisoned[i])
            ck_assert_int_eq(duite_get(program.rt, program.object[i], &value), 17);
        else
            repeated_expect(&program, i);
    for (int i = 0; i < OBJECTS; i++)
        duite_free(program.rt, program.object[i]);
    ck_assert_int_eq(duite_stop(&program.rt), 17);
}

UNIT_TEST(a_round_may_end_anywhere)
{
    for (int forks = 70; forks < 70 + 3 * OBJECTS; forks++)
        for (int back = 1; back < OBJECTS; back++)
            end_early(forks, forks - back);
}

/* Such rounds are compiled at once: when bodies are known to be short, a few rounds are enough.
 * They look long where another program takes the core meanwhile, which does not happen every time.
 */
UNIT_TEST(short_rounds_are_recognised_at_once)
{
    duite_options options = repeated_options(1);
    uint64_t most = 0;

    options.threads = 1;
    for (int attempt = 0; attempt < 10 && most < 5 * OBJECTS; attempt++) {
        struct repeated program = repeated_start(&options);
        for (int i = 0; i < 5; i++) /* too few to be recognised */
            repeated_round(&program);
        ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
        for (int i = 0; i < 20; i++)
            repeated_round(&program);
        most = repeated_stop(&program);
    }
    ck_assert_uint_ge(most, 5 * OBJECTS);
}

/* Each fork is there up to three times in a round. */
UNIT_TEST(long_rounds_are_recognised)
{
    enum { LENGTH = 300, OTHERS = OBJECTS - 1 };
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < ROUNDS; i++)
        for (int k = 0; k < LENGTH; k++) {
            const int to = k % OBJECTS, pair = k / OBJECTS;

            repeated_fork(&program, pair / OTHERS % 2 ? &MIX : &TWIN, to,
                          (to + 1 + pair % OTHERS) % OBJECTS, 0);
        }
    ck_assert_uint_ge(repeated_stop(&program), ROUNDS / 2 * LENGTH);
}

UNIT_TEST(tasks_that_write_nothing_stay_forks)
{
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < ROUNDS * OBJECTS; i++)
        ck_assert_int_eq(DUITE_FORK(program.rt, &LOOK, NULL, program.object[0]), DUITE_OK);
    ck_assert_uint_eq(repeated_stop(&program), 0);
}

/* Each fork is there twice in a round, with another one after it: a round that comes again is found
 * by more than the fork that it begins with. */
UNIT_TEST(rounds_begin_where_they_did)
{
    enum { LENGTH = 6 };
    static const int TO[LENGTH] = {0, 1, 0, 2, 1, 2};
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int begin = 0; begin < LENGTH; begin++) {
        for (int i = begin; i < begin + ROUNDS * LENGTH; i++)
            repeated_fork(&program, &MIX, TO[i % LENGTH], 3, 0);
        ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
    }
    ck_assert_uint_ge(repeated_stop(&program), LENGTH * ROUNDS * LENGTH * 3 / 4);
}

/* Forks repeat themselves until the next round is recorded, and then no more: no plan is kept of
 * that. */
UNIT_TEST(almost_a_round)
{
    const duite_options options = repeated_options(ALWAYS);
    int kept = 0, n = 0;

    struct repeated program = repeated_start(&options);
    const struct plan_memo *memo = program.rt->memo;

    for (; memo->state != MEMO_RECORD && n < ROUNDS * OBJECTS; n++)
        repeated_fork(&program, &MIX, n % OBJECTS, (n + 3) % OBJECTS, 0);
    ck_assert_int_eq(memo->state, MEMO_RECORD);
    for (int i = 0; i < OBJECTS; i++)
        repeated_fork(&program, &TWIN, i, (i + 1) % OBJECTS, 0);
    for (int i = 0; i < MEMO_PLANS; i++)
        kept += memo->rounds_kept[i].record != NULL;
    ck_assert_int_eq(kept, 0);
    repeated_stop(&program);
}

/* A round that was recognised is forked again when one of its objects is no more, and another one
 * has its slot. */
UNIT_TEST(rounds_of_a_freed_object)
{
    enum { FREED = 5 };
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < ROUNDS; i++)
        repeated_round(&program);
    ck_assert_int_eq(duite_wait(program.rt), DUITE_OK); /* so that its plan is free */
    const uint64_t before = repeated_recognised(&program);
    const duite_object freed = program.object[FREED];

    ck_assert_int_eq(duite_free(program.rt, freed), DUITE_OK);
    const duite_object other = misuse_new(program.rt, 1);

    ck_assert_uint_eq(other.slot, freed.slot);
    for (int i = 0; i < ROUNDS * OBJECTS; i++) {
        const int to = i % OBJECTS, from = (i + 3) % OBJECTS;
        const struct repeated_argument none = {0};

        if (to != FREED && from != FREED)
            repeated_fork(&program, &MIX, to, from, 0);
        else
            ck_assert_int_eq(
                DUITE_FORK(program.rt, &MIX, &none, program.object[to], program.object[from]),
                DUITE_E_OBJECT);
    }
    program.object[FREED] = other;
    program.value[FREED] = 0;
    ck_assert_int_eq(duite_wait(program.rt), DUITE_E_OBJECT);
    ck_assert_uint_ge(before, ROUNDS * OBJECTS / 2);
    ck_assert_uint_eq(repeated_stop(&program), before);
}

/* Arguments in a round that is recognised, too. */
UNIT_TEST(arguments_that_no_body_finds)
{
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < ROUNDS * OBJECTS; i++)
        ck_assert_int_eq(DUITE_FORK(program.rt, &HOLD, NULL, program.object[i % OBJECTS]),
                         DUITE_OK);
    ck_assert_uint_ge(repeated_recognised(&program), ROUNDS * OBJECTS / 2);
    for (int i = 0; i < ROUNDS * OBJECTS; i++)
        ck_assert_int_eq(
            DUITE_FORK(program.rt, &HOLD, i % 100 == 99 ? &i : NULL, program.object[i % OBJECTS]),
            i % 100 == 99 ? DUITE_E_ARGUMENT : DUITE_OK);
    ck_assert_int_eq(duite_wait(program.rt), DUITE_E_ARGUMENT);
    repeated_stop(&program);
}
