#ifndef TESTS_SUPPORT_UNIT_H
#define TESTS_SUPPORT_UNIT_H

/* Unit tests with the check library, printed as TAP:
 *
 *     START_TEST(adds)
 *     {
 *         ck_assert_int_eq(1 + 1, 2);
 *     }
 *     END_TEST
 *
 *     int main(void)
 *     {
 *         Suite *suite = suite_create("numbers");
 *         TCase *sums = tcase_create("sums");
 *         tcase_add_test(sums, adds);
 *         suite_add_tcase(suite, sums);
 *         return unit_run(suite);
 *     }
 *
 * Each case runs in a process of its own, so that a crash fails one case; under mpirun all run in
 * the one process that MPI knows. A case that takes 20 minutes is taken to hang. */

#include <check.h>

/* Runs the suite, takes it over and frees it. Returns the exit status: 0 if all cases passed,
 * else 1. Under mpirun rank 0 prints; a failure on another rank goes to its standard error and its
 * status. */
int unit_run(Suite *suite);

/* Whether only the quick subset is wanted (DUITE_QUICK=1): fewer repetitions, smaller sizes. */
int unit_quick(void);

#endif
