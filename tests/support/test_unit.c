/* The harness itself: an empty suite, a passing one, and failing ones whose status must say so. */

#include "tests/support/unit.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

START_TEST(case_passes)
{
    ck_assert_int_eq(unit_quick(), unit_quick());
}
END_TEST

START_TEST(case_fails)
{
    ck_abort_msg("on purpose");
}
END_TEST

START_TEST(case_crashes)
{
    raise(SIGKILL);
}
END_TEST

static Suite *suite_of(const char *name, const TTest *test)
{
    Suite *suite = suite_create(name);
    TCase *cases = tcase_create(name);
    tcase_add_test(cases, test);
    suite_add_tcase(suite, cases);
    return suite;
}

/* The exit status of a suite with the one case, run in a child whose output goes nowhere. */
static int status_of(const TTest *test)
{
    pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        int nowhere = open("/dev/null", O_WRONLY);
        if (nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0)
            _exit(99);
        _exit(unit_run(suite_of("inner", test)));
    }
    int status = -1;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

START_TEST(status_says_what_happened)
{
    ck_assert_int_eq(status_of(case_passes), EXIT_SUCCESS);
    ck_assert_int_eq(status_of(case_fails), EXIT_FAILURE);
    ck_assert_int_eq(status_of(case_crashes), EXIT_FAILURE);
}
END_TEST

int main(void)
{
    return unit_run(suite_of("harness", status_says_what_happened));
}
