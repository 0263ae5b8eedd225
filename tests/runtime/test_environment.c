/* The environment chooses for a program that chooses nothing itself; the program goes before it;
 * bad values are refused. A batch system or a container limits the cores of a rank. */

#include "runtime/workers/share.h"
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <duite_policy.h>

#include <errno.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
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

UNIT_TEST(nothing_is_chosen)
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

UNIT_TEST(the_environment_chooses)
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

/* ---- The share of the cores ---- */

static const char *const LIMITS[] = {"SLURM_CPUS_ON_NODE", "SLURM_CPUS_PER_TASK", "OMP_NUM_THREADS",
                                     "OMP_THREAD_LIMIT"};
enum { N_LIMITS = sizeof LIMITS / sizeof *LIMITS };

static void forget_limits(void)
{
    for (int i = 0; i < N_LIMITS; i++)
        unsetenv(LIMITS[i]);
}

/* A rank's share of the cores that the process may use, with these variables (ended by NULL, each
 * with its value) and these cgroups. */
static struct work_share share_of(unsigned cores, unsigned n_ranks, unsigned asked,
                                  const char *const *variables, const char *folder)
{
    struct work_share share;
    char cgroups[64];
    forget_limits();
    for (; *variables; variables += 2)
        setenv(variables[0], variables[1], 1);
    snprintf(cgroups, sizeof cgroups, "%s/cgroup", folder);
    work_share_find(&(struct work_surroundings){.cores = cores,
                                                .ranks = n_ranks,
                                                .asked = asked,
                                                .cgroups = cgroups,
                                                .mounted = folder},
                    &share);
    forget_limits();
    return share;
}

/* A share that does not come from the cores that the process may use is limited. */
static void says(const struct work_share *share, unsigned cores, unsigned workers, const char *from)
{
    const bool limited = strncmp(from, "affinity", strlen("affinity")) != 0;
    ck_assert_msg(share->cores == cores && share->workers == workers && share->limited == limited &&
                      !strcmp(share->from, from),
                  "%u cores, %u workers, %d, %s; not %u, %u, %d, %s", share->cores, share->workers,
                  share->limited, share->from, cores, workers, limited, from);
}

#define TASK         "SLURM_CPUS_PER_TASK"
#define BY(variable) "affinity, 8 cores; workers by " variable

UNIT_TEST(the_least_of_all_is_the_share)
{
    static const struct {
        unsigned ranks, asked;
        const char *variables[7];
        unsigned cores, workers;
        const char *from;
    } rows[] = {
        {1, 0, {NULL}, 8, 8, "affinity, 8 cores"},
        {3, 0, {NULL}, 2, 2, "affinity, 8 cores for 3 ranks"},
        {9, 0, {NULL}, 1, 1, "affinity, 8 cores for 9 ranks"},
        {1, 0, {TASK, "3"}, 3, 3, "SLURM_CPUS_PER_TASK=3"},
        {2, 0, {TASK, "3"}, 3, 3, "SLURM_CPUS_PER_TASK=3"},
        {4, 0, {TASK, "3"}, 2, 2, "affinity, 8 cores for 4 ranks"},
        {1, 0, {TASK, "9"}, 8, 8, "affinity, 8 cores"},
        {1, 0, {"SLURM_CPUS_ON_NODE", "1"}, 1, 1, "SLURM_CPUS_ON_NODE=1"},
        {2, 0, {"SLURM_CPUS_ON_NODE", "6"}, 3, 3, "SLURM_CPUS_ON_NODE=6 for 2 ranks"},
        {1, 0, {"SLURM_CPUS_ON_NODE", "6", TASK, "2"}, 2, 2, "SLURM_CPUS_PER_TASK=2"},
        {1, 4, {TASK, "2"}, 2, 4, "SLURM_CPUS_PER_TASK=2"},
        {1, 0, {"OMP_NUM_THREADS", "2"}, 8, 2, BY("OMP_NUM_THREADS=2")},
        {1, 0, {"OMP_NUM_THREADS", "4,2", "OMP_THREAD_LIMIT", "3"}, 8, 3, BY("OMP_THREAD_LIMIT=3")},
        {1, 4, {"OMP_NUM_THREADS", "2"}, 8, 4, "affinity, 8 cores"},
        {1, 0, {"OMP_NUM_THREADS", "many", TASK, "0"}, 8, 8, "affinity, 8 cores"},
        {1, 0, {"OMP_NUM_THREADS", "-2", TASK, "2x"}, 8, 8, "affinity, 8 cores"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct work_share share =
            share_of(8, rows[i].ranks, rows[i].asked, rows[i].variables, "/nowhere");
        says(&share, rows[i].cores, rows[i].workers, rows[i].from);
    }
}

static void put(const char *folder, const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    for (char *slash = strchr(path + strlen(folder) + 1, '/'); slash;
         slash = strchr(slash + 1, '/')) {
        *slash = 0;
        ck_assert(!mkdir(path, 0700) || errno == EEXIST);
        *slash = '/';
    }
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
}

/* Quotas of a cgroup and of all above it, version 2 and 1, and of one in a container, whose path is
 * not there. Ranks share them, rounded down. */
UNIT_TEST(quotas_of_cgroups)
{
    static const char *const none[] = {NULL}, *const task[] = {"SLURM_CPUS_PER_TASK", "1", NULL};
    static const struct {
        const char *cgroups;
        unsigned ranks, cores;
        const char *from;
    } rows[] = {{"0::/a/b\n", 1, 2, "cgroup quota 2.5"},
                {"0::/a/b\n", 2, 1, "cgroup quota 2.5 for 2 ranks"},
                {"0::/a\n", 1, 2, "cgroup quota 2.5"},
                {"0::/c\n", 1, 1, "cgroup quota 0.5"},
                {"0::/\n", 1, 8, "affinity, 8 cores"},
                {"4:memory:/one\n3:cpu,cpuacct:/one\n0::/d\n", 1, 3, "cgroup quota 3"},
                {"3:cpuacct:/one\n0::/d\n", 1, 8, "affinity, 8 cores"},
                {"2:cpu:/docker/0123\n", 1, 4, "cgroup quota 4"},
                {"no cgroups\n", 1, 8, "affinity, 8 cores"}};
    char folder[] = "/tmp/duite.XXXXXX", command[64];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    put(folder, "a/cpu.max", "250000 100000\n");
    put(folder, "a/b/cpu.max", "400000 100000\n");
    put(folder, "c/cpu.max", "50000 100000\n");
    put(folder, "d/cpu.max", "max 100000\n");
    put(folder, "cpu,cpuacct/one/cpu.cfs_quota_us", "300000\n");
    put(folder, "cpu,cpuacct/one/cpu.cfs_period_us", "100000\n");
    put(folder, "cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    put(folder, "cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    put(folder, "cpu/cpu.cfs_quota_us", "400000\n");
    put(folder, "cpu/cpu.cfs_period_us", "100000\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put(folder, "cgroup", rows[i].cgroups);
        const struct work_share share = share_of(8, rows[i].ranks, 0, none, folder);
        says(&share, rows[i].cores, rows[i].cores, rows[i].from);
    }
    put(folder, "cgroup", rows[0].cgroups);
    const struct work_share share = share_of(8, 1, 0, task, folder);
    says(&share, 1, 1, "SLURM_CPUS_PER_TASK=1");
    snprintf(command, sizeof command, "rm -r %s", folder);
    ck_assert_int_eq(system(command), 0);
}

/* A job of one core on a host with more has one worker, which stays free to run on any of them: all
 * jobs would be bound to the same one. */
UNIT_TEST(a_job_keeps_to_its_cores)
{
    cpu_set_t before, inside;
    const char *from;
    duite *rt;
    for (int i = 0; i < N_VARIABLES; i++)
        unsetenv(VARIABLES[i]);
    setenv("SLURM_CPUS_PER_TASK", "1", 1);
    const duite_options options = plain();
    misuse_mpi();
    ck_assert_int_eq(sched_getaffinity(0, sizeof before, &before), 0);
    ck_assert_msg(duite_start(&rt, &options) == DUITE_OK, "%s", duite_message());
    ck_assert_int_eq(sched_getaffinity(0, sizeof inside, &inside), 0);
    ck_assert_uint_eq(duite_threads(rt), 1);
    ck_assert_uint_eq(duite_cores(rt, &from), 1);
    ck_assert(CPU_EQUAL(&before, &inside));
    if (CPU_COUNT(&before) > 1)
        ck_assert_msg(strstr(from, "=1") || strstr(from, "quota"), "%s", from);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    unsetenv("SLURM_CPUS_PER_TASK");
}

/* Even where the environment makes no sense. */
UNIT_TEST(the_program_goes_first)
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

/* Starting with this value of a variable is refused, in a sentence with both, and these words. */
static void refuses(const char *variable, const char *value, const char *const *words)
{
    setenv(variable, value, 1);
    const duite_options options = plain();
    duite *rt = (duite *)&rt;

    misuse_mpi();
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    unit_says(duite_message(), variable);
    unit_says(duite_message(), value);
    for (; *words; words++)
        unit_says(duite_message(), *words);
    unsetenv(variable);
}

UNIT_TEST(wrong_names)
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

UNIT_TEST(wrong_numbers)
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

/* The environment is not blamed for what the program set wrongly. */
UNIT_TEST(the_fault_of_the_program)
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
