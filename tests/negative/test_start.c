/* Starting and stopping: malformed kernels and options, objects left over, many runtimes after one
 * another. */

#include "tests/negative/refused.h"

#include <duite_policy.h>

#include <stdint.h>
#include <string.h>

/* Starting with this kernel beside a good one is refused with a sentence, and leaves no runtime. */
static void refuses(duite_kernel kernel, const char *word)
{
    const duite_kernel *list[] = {&SET, &kernel, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = list;
    rt = (duite *)&options;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_KERNEL);
    ck_assert_ptr_null(rt);
    says(word);
}

/* The same of a good one that the test changes by the name `kernel`. */
#define KERNEL_REFUSED(GOOD, CHANGE, WORD)                                                         \
    do {                                                                                           \
        duite_kernel kernel = GOOD;                                                                \
        CHANGE;                                                                                    \
        refuses(kernel, WORD);                                                                     \
    } while (0)

UNIT_TEST(malformed_kernels)
{
    KERNEL_REFUSED(ADD, kernel.body = NULL, "add");
    KERNEL_REFUSED(ADD, kernel.name = NULL, "name");
    KERNEL_REFUSED(COPY, kernel.access[5] = DUITE_R, "copy");
    KERNEL_REFUSED(COPY, kernel.access[1] = (duite_mode)17, "copy");
    KERNEL_REFUSED(MANY, kernel.variadic = (duite_mode)-1, "many");
}

/* Starts on several ranks must leave the same everywhere. */
UNIT_TEST(replicated_kernels)
{
    KERNEL_REFUSED(EVERYWHERE, (kernel.name = "alike", kernel.side_effects = 1), "side effects");
    KERNEL_REFUSED(ADD, kernel.replicated = 1, "add");
    KERNEL_REFUSED(MANY, (kernel.replicated = 1, kernel.variadic = DUITE_CW), "accumulates");
    KERNEL_REFUSED(MANY, (kernel.replicated = 1, kernel.variadic = DUITE_RP), "postponed");
    KERNEL_REFUSED(COPY, (kernel.replicated = 1, kernel.access[1] = DUITE_RWP), "postponed");
}

UNIT_TEST(kernel_twice)
{
    const duite_kernel *list[] = {&SET, &ADD, &SET, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = list;
    rt = (duite *)&options;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_KERNEL);
    ck_assert_ptr_null(rt);
    refuses((duite_kernel){.name = "set", .body = ADD.body}, "set");
}

static void refuses_options(const duite_options *options, const char *sentence)
{
    rt = (duite *)&rt;
    ck_assert_int_eq(duite_start(&rt, options), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    says(sentence);
}

/* The same of good ones that the test changes by the name `options`. */
#define OPTIONS_REFUSED(CHANGE, SENTENCE)                                                          \
    do {                                                                                           \
        duite_options options = misuse_options(MPI_COMM_WORLD);                                    \
        CHANGE;                                                                                    \
        refuses_options(&options, SENTENCE);                                                       \
    } while (0)

UNIT_TEST(malformed_options)
{
    duite_options many = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    refuses_options(NULL, "");
    OPTIONS_REFUSED(options.kernels = NULL, "");
    OPTIONS_REFUSED(options.comm = MPI_COMM_NULL, "");
    OPTIONS_REFUSED(options.spin_seconds = -1, "");
    OPTIONS_REFUSED(options.spin_seconds = __builtin_nan(""), "");
    OPTIONS_REFUSED(options.lost_seconds = -1, "");
    OPTIONS_REFUSED((options.lost_seconds = 8, options.stuck_seconds = -1), "");
    OPTIONS_REFUSED((options.lost_seconds = 8, options.stuck_seconds = __builtin_nan("")), "");
    many.threads = 1000000;
    rt = (duite *)&rt;
    ck_assert_int_ne(duite_start(&rt, &many), DUITE_OK);
    ck_assert_ptr_null(rt);
}

/* Filled by hand and in part: each is refused by its name, or means what duite.h says of 0. */
UNIT_TEST(options_left_at_zero)
{
    const duite_options whole = misuse_options(MPI_COMM_WORLD);
    duite_options options = {0};

    refuses_options(&options, "options of 0 bytes (size)"); /* before MPI is initialised */
    options.size = whole.size;
    refuses_options(&options, "no communicator (comm)");
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
        ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
    options = whole;
    memset(&options.comm, 0, sizeof options.comm);
    refuses_options(&options, "no communicator (comm)");
}

UNIT_TEST(malformed_policies)
{
    duite_scheduler scheduler = *duite_scheduler_find("fifo");
    duite_mapping mapping = *misuse_options(MPI_COMM_WORLD).mapping;
    duite_balancer balance = *duite_balancer_find("delegate");

    misuse_mpi();
    OPTIONS_REFUSED(options.scheduler = NULL, "scheduler");
    OPTIONS_REFUSED((options.scheduler = &scheduler, scheduler.victim = NULL), "scheduler");
    scheduler = *duite_scheduler_find("fifo");
    OPTIONS_REFUSED((options.scheduler = &scheduler, scheduler.name = NULL), "scheduler");
    scheduler.name = "large";
    for (scheduler.state_size = SIZE_MAX; scheduler.state_size > SIZE_MAX - 200;
         scheduler.state_size -= 8)
        OPTIONS_REFUSED(options.scheduler = &scheduler,
                        "the scheduler large wants a state of 184467440737095");
    OPTIONS_REFUSED(options.mapping = NULL, "mapping");
    OPTIONS_REFUSED((options.mapping = &mapping, mapping.map = NULL), "mapping");
    OPTIONS_REFUSED(options.balance = NULL, "balancer");
    OPTIONS_REFUSED((options.balance = &balance, balance.grant = NULL), "balancer");
    balance = *duite_balancer_find("delegate");
    OPTIONS_REFUSED((options.balance = &balance, balance.state_size = SIZE_MAX),
                    "the balancer delegate wants a state of 18446744073709551615 bytes");
    balance = *duite_balancer_find("none");
    OPTIONS_REFUSED((options.balance = &balance, balance.name = NULL), "balancer");
}

/* A table of another duite_policy.h: longer or shorter, or without its size. */
UNIT_TEST(policies_of_other_versions)
{
    duite_scheduler scheduler = *duite_scheduler_find("fifo");
    duite_mapping mapping = *duite_mapping_find("block");
    duite_balancer balance = *duite_balancer_find("none");
    size_t *const sizes[] = {&scheduler.size, &mapping.size, &balance.size};
    const char *const sentences[] = {"the table of the scheduler has",
                                     "the table of the mapping has",
                                     "the table of the balancer has"};

    misuse_mpi();
    for (int i = 0; i < 3; i++)
        for (size_t change = 0; change < 3; change++) {
            const size_t size = *sizes[i];
            *sizes[i] = change ? size + 8 * (2 * change - 3) : 0;
            OPTIONS_REFUSED((options.scheduler = &scheduler, options.mapping = &mapping,
                             options.balance = &balance),
                            sentences[i]);
            *sizes[i] = size;
        }
}

/* Options of a shorter header, followed by the program's own data, and of a longer one. */
UNIT_TEST(options_of_other_versions)
{
    struct {
        duite_options options;
        char beyond[16];
    } own;

    misuse_mpi();
    own.options = misuse_options(MPI_COMM_WORLD);
    for (size_t size = 0; size < own.options.size; size++)
        OPTIONS_REFUSED((options.size = size), "have never been");
    OPTIONS_REFUSED((options.size += 8), "a library at least as new as the header is needed");
    memset(&own, 1, sizeof own);
    ck_assert_int_eq(duite_options_set(&own.options, sizeof own.options + 8), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_options_set(NULL, sizeof own.options), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_options_set(&own.options, sizeof own.options), DUITE_OK);
    ck_assert_uint_eq(own.options.size, sizeof own.options);
    ck_assert_int_eq(duite_version(), DUITE_VERSION);
}

/* The communicator by Fortran's handle of it. */
UNIT_TEST(communicators_of_fortran)
{
    duite_options options = misuse_options(MPI_COMM_NULL);

    misuse_mpi();
    ck_assert_int_eq(duite_options_comm(NULL, MPI_Comm_c2f(MPI_COMM_SELF)), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_options_comm(&options, MPI_Comm_c2f(MPI_COMM_SELF)), DUITE_OK);
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* A shorter structure of counters is not written beyond its end; of a longer one the rest is 0. */
UNIT_TEST(counters_of_other_versions)
{
    struct {
        duite_counters counters;
        unsigned char beyond[16];
    } of;

    rt = misuse_start(MPI_COMM_WORLD, 1);
    memset(&of, 1, sizeof of);
    ck_assert_int_eq(duite_count_sized(rt, &of.counters, sizeof of), DUITE_OK);
    for (size_t i = 0; i < sizeof of.beyond; i++)
        ck_assert_uint_eq(of.beyond[i], 0);
    memset(&of, 1, sizeof of);
    ck_assert_int_eq(duite_count_sized(rt, &of.counters, sizeof(uint64_t)), DUITE_OK);
    ck_assert_uint_eq(of.counters.tasks, 0);
    ck_assert_uint_eq(of.counters.placed, UINT64_C(0x0101010101010101));
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* After refusals a start works. */
static void one_life(MPI_Comm comm, unsigned threads)
{
    int32_t value = 5;

    rt = misuse_start(comm, threads);
    ck_assert_ptr_nonnull(rt);
    ck_assert_uint_ge(duite_threads(rt), 1);
    if (threads)
        ck_assert_uint_eq(duite_threads(rt), threads);
    ck_assert_int_eq(duite_rank(rt), 0);
    ck_assert_int_eq(duite_ranks(rt), 1);
    a = misuse_new(rt, 1);
    b = misuse_new(rt, 1);
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

    MPI_Init(NULL, NULL);
    MPI_Finalize();
    rt = (duite *)&options;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_MPI);
    ck_assert_ptr_null(rt);
}

/* Workers call MPI, whichever thread they are. */
UNIT_TEST(mpi_for_one_thread)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    int level;

    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &level);
    if (level < MPI_THREAD_SERIALIZED) {
        rt = (duite *)&options;
        ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_MPI);
        ck_assert_ptr_null(rt);
        says("MPI_Init_thread");
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
        says("MPI_THREAD_MULTIPLE");
    } else {
        ck_assert_int_eq(code, DUITE_OK);
        ck_assert_int_eq(duite_stop(&second), DUITE_OK);
    }
    ck_assert_int_eq(duite_stop(&first), DUITE_OK);
    one_life(MPI_COMM_SELF, 2);
}

UNIT_TEST(not_freed)
{
    rt = misuse_start(MPI_COMM_WORLD, 2);
    a = misuse_new(rt, 1);
    misuse_new(rt, 1);
    misuse_new(rt, 1);
    ck_assert_int_eq(duite_free(rt, a), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_E_NOT_FREED);
    ck_assert_ptr_null(rt);
    says("2");
}
