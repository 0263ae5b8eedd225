/* Where forks are recognised the main program goes as far ahead as without: rings of arguments turn
 * or are left, no task waits for a later fork, and plans make room for others. */
#include "tests/runtime/repeated.h"
#include "tests/support/unit.h"

/* The main program runs ahead of the bodies by more rounds than a ring has. */
UNIT_TEST(rings_turn)
{
    duite_options options = repeated_options(ALWAYS);

    for (options.window = 0; options.window <= 1000; options.window += 1000) {
        struct repeated program = repeated_start(&options);
        for (int i = 0; i < (unit_quick() ? 4000 : 12000); i++)
            repeated_round(&program);
        ck_assert_uint_ge(repeated_stop(&program), 1000);
    }
}

/* A task in the middle of a replay is held until a ring is full; its slot is not written again. */
UNIT_TEST(a_full_ring_is_left)
{
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    atomic_store(&repeated_held_at, 300 * OBJECTS);
    for (int i = 0; i < 6000; i++)
        repeated_round(&program);
    atomic_store(&repeated_held_at, 0);
    ck_assert_uint_ge(repeated_stop(&program), 1000);
}

/* More arguments than a ring has room for, and no task of theirs can run. */
UNIT_TEST(forks_go_ahead)
{
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int again = 0; again < 2; again++) {
        atomic_store(&repeated_held, 1);
        for (int i = 0; i < OBJECTS; i++)
            ck_assert_int_eq(DUITE_FORK(program.rt, &HOLD, NULL, program.object[i]), DUITE_OK);
        for (int i = 0; i < 4000; i++)
            repeated_round(&program);
        ck_assert_int_eq(atomic_load(&repeated_over), again * 4000 * OBJECTS);
        atomic_store(&repeated_held, 0);
        ck_assert_int_eq(duite_wait(program.rt), DUITE_OK);
    }
    ck_assert_uint_ge(repeated_stop(&program), 1000);
}

/* A task may run as soon as it is forked, whatever comes after it. */
UNIT_TEST(forks_are_not_held_back)
{
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int i = 0; i < ROUNDS; i++)
        for (int k = 0; k < OBJECTS; k++) {
            repeated_fork(&program, &MIX, k, (k + 3) % OBJECTS, 0);
            while (atomic_load(&repeated_over) < i * OBJECTS + k + 1)
                ;
        }
    ck_assert_uint_ge(repeated_stop(&program), OBJECTS * ROUNDS / 2);
}

/* More rounds than there are plans, each of them again and again. */
UNIT_TEST(rounds_take_turns)
{
    const duite_options options = repeated_options(ALWAYS);

    struct repeated program = repeated_start(&options);
    for (int turn = 0; turn < 3; turn++)
        for (int kind = 1; kind < 13; kind++)
            for (int i = 0; i < ROUNDS; i++)
                for (int k = 0; k < 2 + kind; k++)
                    repeated_fork(&program, k % 3 ? &MIX : &TWIN, k * kind % OBJECTS,
                                  (k * kind + 1) % OBJECTS, 0);
    ck_assert_uint_ge(repeated_stop(&program), 5000);
}
