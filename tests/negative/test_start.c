/* Starting and stopping: malformed kernels and options, objects left over, many runtimes after one
 * another. */

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <duite_policy.h>

#include <stdint.h>
#include <string.h>

/* Starting with this kernel beside a good one is refused with a sentence, and leaves no runtime. */
static void refuses(duite_kernel kernel, const char *word)
{
    const duite_kernel *list[] = {&SET, &kernel, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = (duite *)&options;

    misuse_mpi();
    options.kernels = list;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_KERNEL);
    ck_assert_ptr_null(rt);
    ck_assert_msg(strstr(duite_message(), word) != NULL, "'%s' does not say '%s'", duite_message(),
                  word);
}

UNIT_TEST(malformed_kernels)
{
    duite_kernel kernel = ADD;

    kernel.body = NULL;
    refuses(kernel, "add");
    kernel = ADD;
    kernel.name = NULL;
    refuses(kernel, "name");
    kernel = COPY;
    kernel.access[5] = DUITE_R;
    refuses(kernel, "copy");
    kernel = COPY;
    kernel.access[1] = (duite_mode)17;
    refuses(kernel, "copy");
    kernel = MANY;
    kernel.variadic = (duite_mode)-1;
    refuses(kernel, "many");
}

/* What runs on several ranks must leave the same everywhere. */
UNIT_TEST(replicated_kernels)
{
    duite_kernel kernel = EVERYWHERE;

    kernel.name = "alike";
    kernel.side_effects = 1;
    refuses(kernel, "side effects");
    kernel = ADD;
    kernel.replicated = 1;
    refuses(kernel, "add");
    kernel = MANY;
    kernel.replicated = 1;
    kernel.variadic = DUITE_CW;
    refuses(kernel, "accumulates");
    kernel.variadic = DUITE_RP;
    refuses(kernel, "postponed");
    kernel = COPY;
    kernel.replicated = 1;
    kernel.access[1] = DUITE_RWP;
    refuses(kernel, "postponed");
}

UNIT_TEST(kernel_twice)
{
    const duite_kernel *list[] = {&SET, &ADD, &SET, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;

    misuse_mpi();
    options.kernels = list;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_KERNEL);
    ck_assert_ptr_null(rt);
    refuses((duite_kernel){.name = "set", .body = ADD.body}, "set");
}

UNIT_TEST(malformed_options)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = (duite *)&options;

    misuse_mpi();
    ck_assert_int_eq(duite_start(&rt, NULL), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    options.kernels = NULL;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options = misuse_options(MPI_COMM_NULL);
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options = misuse_options(MPI_COMM_WORLD);
    options.spin_seconds = -1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options.spin_seconds = __builtin_nan("");
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options = misuse_options(MPI_COMM_WORLD);
    options.lost_seconds = -1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options.lost_seconds = 8;
    options.stuck_seconds = -1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options.stuck_seconds = __builtin_nan("");
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    options = misuse_options(MPI_COMM_WORLD);
    options.threads = 1000000;
    ck_assert_int_ne(duite_start(&rt, &options), DUITE_OK);
    ck_assert_ptr_null(rt);
}

static void refuses_options(const duite_options *options, const char *sentence)
{
    duite *rt = (duite *)&rt;

    ck_assert_int_eq(duite_start(&rt, options), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    ck_assert_msg(strstr(duite_message(), sentence) != NULL, "'%s' does not say '%s'",
                  duite_message(), sentence);
}

/* Filled by hand and in part: each is refused by its name, or means what duite.h says of 0. */
UNIT_TEST(options_left_at_zero)
{
    const duite_options whole = misuse_options(MPI_COMM_WORLD);
    duite_options options = {0};

    refuses_options(&options, "no communicator (comm)"); /* before MPI is initialised */
    misuse_mpi();
    refuses_options(&options, "duite_options_default()");
    options.comm = MPI_COMM_WORLD;
    refuses_options(&options, "no list of kernels");
    options.kernels = whole.kernels;
    refuses_options(&options, "no scheduler");
    options.scheduler = whole.scheduler;
    refuses_options(&options, "no mapping");
    options.mapping = whole.mapping;
    refuses_options(&options, "no balancer");
    options.balance = whole.balance;
    for (options.bind = 0; options.bind < 2; options.bind++) { /* all the rest may be 0 */
        duite *rt = NULL;

        ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
    options = whole;
    memset(&options.comm, 0, sizeof options.comm);
    refuses_options(&options, "no communicator (comm)");
}

UNIT_TEST(malformed_policies)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_scheduler scheduler = *options.scheduler;
    duite_mapping mapping = *options.mapping;

    misuse_mpi();
    options.scheduler = NULL;
    refuses_options(&options, "scheduler");
    options.scheduler = &scheduler;
    scheduler.victim = NULL;
    refuses_options(&options, "scheduler");
    scheduler = *duite_scheduler_find("fifo");
    scheduler.name = NULL;
    refuses_options(&options, "scheduler");
    scheduler = *duite_scheduler_find("fifo");
    scheduler.name = "large";
    for (scheduler.state_size = SIZE_MAX; scheduler.state_size > SIZE_MAX - 200;
         scheduler.state_size -= 8)
        refuses_options(&options, "the scheduler large wants a state of 184467440737095");
    options = misuse_options(MPI_COMM_WORLD);
    options.mapping = NULL;
    refuses_options(&options, "mapping");
    options.mapping = &mapping;
    mapping.map = NULL;
    refuses_options(&options, "mapping");
    options = misuse_options(MPI_COMM_WORLD);
    duite_balancer balance = *duite_balancer_find("delegate");
    options.balance = NULL;
    refuses_options(&options, "balancer");
    options.balance = &balance;
    balance.grant = NULL;
    refuses_options(&options, "balancer");
    balance = *duite_balancer_find("delegate");
    balance.state_size = SIZE_MAX;
    refuses_options(&options, "the balancer delegate wants a state of 18446744073709551615 bytes");
    balance = *duite_balancer_find("none");
    balance.name = NULL;
    refuses_options(&options, "balancer");
}

/* After refusals a start works. */
static void one_life(MPI_Comm comm, unsigned threads)
{
    duite *rt = misuse_start(comm, threads);
    int32_t value = 5;

    ck_assert_ptr_nonnull(rt);
    ck_assert_uint_ge(duite_threads(rt), 1);
    if (threads)
        ck_assert_uint_eq(duite_threads(rt), threads);
    ck_assert_int_eq(duite_rank(rt), 0);
    ck_assert_int_eq(duite_ranks(rt), 1);
    const duite_object a = misuse_new(rt, 1), b = misuse_new(rt, 1);

    ck_assert_int_eq(duite_fork(rt, &SET, &value, 1, &a), DUITE_OK);
    for (int i = 0; i < 20; i++)
        ck_assert_int_eq(duite_fork(rt, &ADD, NULL, 1, &a), DUITE_OK);
    ck_assert_int_eq(DUITE_FORK(rt, &COPY, NULL, a, b), DUITE_OK);
    ck_assert_int_eq(duite_get(rt, b, &value), DUITE_OK);
    ck_assert_int_eq(value, 26);
    ck_assert_int_eq(duite_free(rt, a), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, b), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    ck_assert_ptr_null(rt);
}

UNIT_TEST(fifty_lives)
{
    for (unsigned i = 0; i < 50; i++) {
        one_life(MPI_COMM_WORLD, 1 + i % 4);
        if (i % 10 == 0)
            refuses((duite_kernel){.name = "nothing"}, "nothing");
    }
}

UNIT_TEST(threads_by_default)
{
    one_life(MPI_COMM_WORLD, 0);
    one_life(MPI_COMM_SELF, 0);
}

UNIT_TEST(every_policy)
{
    for (const char *const *scheduler = duite_scheduler_names(); *scheduler; scheduler++)
        for (const char *const *mapping = duite_mapping_names(); *mapping; mapping++) {
            duite_options options = misuse_options(MPI_COMM_WORLD);
            duite *rt = NULL;

            misuse_mpi();
            options.scheduler = duite_scheduler_find(*scheduler);
            options.mapping = duite_mapping_find(*mapping);
            ck_assert_ptr_nonnull(options.scheduler);
            ck_assert_ptr_nonnull(options.mapping);
            ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
            ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
        }
}

/* MPI is initialised by start if nobody else has, and lasts for further starts. */
UNIT_TEST(mpi_of_our_own)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    int is = 0;
    duite *rt;

    for (int i = 0; i < 3; i++) {
        ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
        MPI_Initialized(&is);
        ck_assert(is);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
        MPI_Finalized(&is);
        ck_assert(!is);
    }
}

UNIT_TEST(mpi_is_over)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = (duite *)&options;

    MPI_Init(NULL, NULL);
    MPI_Finalize();
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_MPI);
    ck_assert_ptr_null(rt);
}

/* Workers call MPI, whichever thread they are. */
UNIT_TEST(mpi_for_one_thread)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = (duite *)&options;
    int level;

    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &level);
    if (level < MPI_THREAD_SERIALIZED) {
        ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_MPI);
        ck_assert_ptr_null(rt);
        ck_assert_ptr_nonnull(strstr(duite_message(), "MPI_Init_thread"));
    }
    MPI_Finalize();
}

/* The workers of both would call MPI at the same time. */
UNIT_LOOP(two_at_a_time, 0, 2)
{
    const int levels[] = {MPI_THREAD_SERIALIZED, MPI_THREAD_MULTIPLE};
    duite *first, *second = (duite *)&first;

    misuse_mpi_at(levels[_i]);
    first = misuse_start(MPI_COMM_WORLD, 2);
    ck_assert_ptr_nonnull(first);
    duite_options options = misuse_options(MPI_COMM_SELF);
    const int code = duite_start(&second, &options);

    if (levels[_i] == MPI_THREAD_SERIALIZED) {
        ck_assert_int_eq(code, DUITE_E_STATE);
        ck_assert_ptr_null(second);
        ck_assert_msg(strstr(duite_message(), "MPI_THREAD_MULTIPLE") != NULL, "%s",
                      duite_message());
    } else {
        ck_assert_int_eq(code, DUITE_OK);
        ck_assert_int_eq(duite_stop(&second), DUITE_OK);
    }
    ck_assert_int_eq(duite_stop(&first), DUITE_OK);
    one_life(MPI_COMM_SELF, 2);
}

UNIT_TEST(not_freed)
{
    duite *rt = misuse_start(MPI_COMM_WORLD, 2);
    const duite_object a = misuse_new(rt, 1);

    misuse_new(rt, 1);
    misuse_new(rt, 1);
    ck_assert_int_eq(duite_free(rt, a), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_E_NOT_FREED);
    ck_assert_ptr_null(rt);
    ck_assert_msg(strstr(duite_message(), "2") != NULL, "'%s' does not say how many",
                  duite_message());
}
