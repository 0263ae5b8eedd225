/* What the environment chooses for a program that chooses nothing itself, what goes before it, and
 * what is refused. */

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <duite_policy.h>

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const VARIABLES[] = {"DUITE_SCHEDULER", "DUITE_MAPPING", "DUITE_BALANCE",
                                        "DUITE_THREADS",   "DUITE_SEED",    "DUITE_TRACE"};
enum { N_VARIABLES = sizeof VARIABLES / sizeof *VARIABLES };

static void start_and_stop(const duite_options *options, unsigned threads)
{
    duite *rt;

    misuse_mpi();
    ck_assert_msg(duite_start(&rt, options) == DUITE_OK, "%s", duite_message());
    if (threads)
        ck_assert_uint_eq(duite_threads(rt), threads);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* The defaults with kernels, and nothing else that a program sets. */
static duite_options plain(void)
{
    duite_options options = duite_options_default();

    options.kernels = misuse_options(MPI_COMM_WORLD).kernels;
    return options;
}

START_TEST(nothing_is_chosen)
{
    for (int i = 0; i < N_VARIABLES; i++)
        unsetenv(VARIABLES[i]);
    const duite_options options = plain();

    ck_assert_ptr_eq(options.scheduler, duite_scheduler_find("steal"));
    ck_assert_ptr_eq(options.mapping, duite_mapping_find("metis"));
    ck_assert_ptr_eq(options.balance, duite_balancer_find("none"));
    ck_assert_uint_eq(options.threads, 0);
    ck_assert_uint_eq(options.seed, 1);
    ck_assert_ptr_null(options.trace);
    start_and_stop(&options, 0);
}
END_TEST

START_TEST(the_environment_chooses)
{
    char folder[] = "/tmp/duite.XXXXXX", trace[64];

    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(trace, sizeof trace, "%s/trace", folder);
    setenv("DUITE_SCHEDULER", "fifo", 1);
    setenv("DUITE_MAPPING", "cyclic", 1);
    setenv("DUITE_BALANCE", "delegate", 1);
    setenv("DUITE_THREADS", "3", 1);
    setenv("DUITE_SEED", "18446744073709551614", 1);
    setenv("DUITE_TRACE", trace, 1);
    const duite_options options = plain();

    ck_assert_ptr_eq(options.scheduler, duite_scheduler_find("fifo"));
    ck_assert_ptr_eq(options.mapping, duite_mapping_find("cyclic"));
    ck_assert_ptr_eq(options.balance, duite_balancer_find("delegate"));
    ck_assert_uint_eq(options.seed, UINT64_MAX - 1);
    start_and_stop(&options, 3);
    ck_assert_int_eq(unlink(trace), 0);
    rmdir(folder);
}
END_TEST

/* Even where the environment makes no sense. */
START_TEST(the_program_goes_first)
{
    for (int i = 0; i < N_VARIABLES; i++)
        setenv(VARIABLES[i], i % 2 ? "" : "-/-", 1);
    duite_options options = plain();

    options.scheduler = duite_scheduler_find("lifo");
    options.mapping = duite_mapping_find("block");
    options.balance = duite_balancer_find("none");
    options.threads = 2;
    options.seed = 5;
    options.trace = NULL;
    start_and_stop(&options, 2);
}
END_TEST

/* Starting with this value of a variable is refused, in a sentence with both, and these words. */
static void refuses(const char *variable, const char *value, const char *const *words)
{
    setenv(variable, value, 1);
    const duite_options options = plain();
    duite *rt = (duite *)&rt;

    misuse_mpi();
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    ck_assert_msg(strstr(duite_message(), variable) != NULL, "'%s' does not name %s",
                  duite_message(), variable);
    ck_assert_msg(strstr(duite_message(), value) != NULL, "'%s' does not name '%s'",
                  duite_message(), value);
    for (; *words; words++)
        ck_assert_msg(strstr(duite_message(), *words) != NULL, "'%s' does not say '%s'",
                      duite_message(), *words);
    unsetenv(variable);
}

START_TEST(wrong_names)
{
    refuses("DUITE_SCHEDULER", "lazy", duite_scheduler_names());
    refuses("DUITE_MAPPING", "flat", duite_mapping_names());
    refuses("DUITE_BALANCE", "fair", duite_balancer_names());
    refuses("DUITE_SCHEDULER", "", duite_scheduler_names());
    refuses("DUITE_SCHEDULER", "lazy", (const char *[]){", for tests shuffle, and", NULL});
    refuses("DUITE_MAPPING", "flat", (const char *[]){"list, and shared", NULL});
    refuses("DUITE_BALANCE", "fair", (const char *[]){", for tests scatter, wander, and", NULL});
    refuses("DUITE_SCHEDULER", "./no-such-file.so", (const char *[]){"cannot be loaded", NULL});
    refuses("DUITE_TRACE", "", (const char *[]){"empty", NULL});
}
END_TEST

START_TEST(wrong_numbers)
{
    static const char *const threads[] = {"from 0 to 4096", NULL};
    static const char *const seed[] = {"from 0 to 18446744073709551614", NULL};

    refuses("DUITE_THREADS", "many", threads);
    refuses("DUITE_THREADS", "2x", threads);
    refuses("DUITE_THREADS", "-1", threads);
    refuses("DUITE_THREADS", " 2", threads);
    refuses("DUITE_THREADS", "", threads);
    refuses("DUITE_THREADS", "4097", threads);
    refuses("DUITE_THREADS", "4294967298", threads);
    refuses("DUITE_SEED", "soon", seed);
    refuses("DUITE_SEED", "-1", seed);
    refuses("DUITE_SEED", "18446744073709551615", seed);
    refuses("DUITE_SEED", "18446744073709551616", seed);
}
END_TEST

/* What the program set wrongly is not blamed on the environment. */
START_TEST(the_fault_of_the_program)
{
    setenv("DUITE_SCHEDULER", "fifo", 1);
    setenv("DUITE_THREADS", "2", 1);
    duite_options options = plain();
    duite *rt;

    misuse_mpi();
    options.scheduler = duite_scheduler_find("lazy");
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(strstr(duite_message(), "DUITE_SCHEDULER"));
    options = plain();
    options.threads = UINT32_MAX;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(strstr(duite_message(), "DUITE_THREADS"));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("environment");
    TCase *cases = tcase_create("environment");

    tcase_add_test(cases, nothing_is_chosen);
    tcase_add_test(cases, the_environment_chooses);
    tcase_add_test(cases, the_program_goes_first);
    tcase_add_test(cases, wrong_names);
    tcase_add_test(cases, wrong_numbers);
    tcase_add_test(cases, the_fault_of_the_program);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
