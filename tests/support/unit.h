#ifndef TESTS_SUPPORT_UNIT_H
#define TESTS_SUPPORT_UNIT_H

/* Unit tests with the check library, printed as TAP. A test makes itself known, so that none is
 * forgotten and a program needs no main():
 *
 *     UNIT_TEST(adds)
 *     {
 *         ck_assert_int_eq(1 + 1, 2);
 *     }
 *
 * Each test runs in a process of its own, so that a crash fails one test; under mpirun all run in
 * the one process that MPI knows. A test that takes 20 minutes is taken to hang. */

#include <check.h>
#include <string.h>

/* A file's cases. */
struct unit_cases {
    void (*add)(TCase *cases);
    struct unit_cases *next;
};

/* Called before main(); files and what they add keep their order. */
void unit_register(struct unit_cases *cases);

/* UNIT_CASES(NAME, CASES) { ... } adds to the program's TCase: more than the macros below know. */
#define UNIT_CASES(NAME, CASES)                                                                    \
    static void unit_add_##NAME(TCase *CASES);                                                     \
    __attribute__((constructor)) static void unit_register_##NAME(void)                            \
    {                                                                                              \
        static struct unit_cases unit_more = {.add = unit_add_##NAME};                             \
        unit_register(&unit_more);                                                                 \
    }                                                                                              \
    static void unit_add_##NAME(TCase *CASES)

/* A test, once for each _i from FROM to END - 1; both may be of what is known at run time. */
#define UNIT_LOOP(NAME, FROM, END)                                                                 \
    static void unit_test_##NAME(int _i);                                                          \
    START_TEST(NAME)                                                                               \
    {                                                                                              \
        unit_test_##NAME(_i);                                                                      \
    }                                                                                              \
    END_TEST                                                                                       \
    UNIT_CASES(NAME, unit_tcase)                                                                   \
    {                                                                                              \
        tcase_add_loop_test(unit_tcase, NAME, FROM, END);                                          \
    }                                                                                              \
    static void unit_test_##NAME(__attribute__((unused)) int _i)
#define UNIT_TEST(NAME) UNIT_LOOP(NAME, 0, 1)

/* Before and after each test, in its process. NULL: nothing. */
#define UNIT_FIXTURE(SETUP, TEARDOWN)                                                              \
    UNIT_CASES(fixture, unit_tcase)                                                                \
    {                                                                                              \
        tcase_add_checked_fixture(unit_tcase, SETUP, TEARDOWN);                                    \
    }

/* The text has the part. */
#define unit_says(TEXT, PART)                                                                      \
    ck_assert_msg(strstr(TEXT, PART) != NULL, "'%s' does not say '%s'", TEXT, PART)

/* A call of the cloth's, which is given &error: an error of the macro's own, whatever the test has
 * of that name. Then what is asserted of them. */
#define UNIT_CALL(CALL, ...)                                                                       \
    do {                                                                                           \
        _Pragma("GCC diagnostic push")                                                             \
            _Pragma("GCC diagnostic ignored \"-Wshadow\"") struct cloth_error error = {0};         \
        _Pragma("GCC diagnostic pop") const int unit_code = (CALL);                                \
        __VA_ARGS__;                                                                               \
    } while (0)
/* It has to succeed: else its sentence is why the test fails. */
#define UNIT_FINE(CALL) UNIT_CALL(CALL, ck_assert_msg(unit_code == 0, "%s", error.text))
/* It has to fail with the code, and a sentence that has the part. */
#define UNIT_REFUSED(CALL, CODE, PART)                                                             \
    UNIT_CALL(CALL, ck_assert_int_eq(unit_code, CODE); unit_says(error.text, PART))

/* Before a variable of a test: FREE(&variable) at the end of its scope. */
#define UNIT_OWNED(FREE) __attribute__((cleanup(FREE), unused))

/* The main() of a program that has none of its own: runs what is registered. Returns the exit
 * status: 0 if all passed, else 1. Under mpirun rank 0 prints; a failure on another rank goes to
 * its standard error and its status. */
int unit_main(void);
/* The same of a suite, which it takes over and frees. */
int unit_run(Suite *suite);

/* True if only the quick subset is wanted (DUITE_QUICK=1): fewer repetitions, smaller sizes. */
int unit_quick(void);
/* True if mpirun started no other rank. */
int unit_alone(void);

#endif
