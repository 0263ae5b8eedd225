/* One scene, one hash: runs it over ranks x threads x schedulers x mappings, and over seeds of
 * `shuffle`, each time with the next balancer, in one job of MPI, and compares every state_hash
 * with the one that DUITE_EXPECTED of the environment says or, where it says none, with that of one
 * rank and one thread.
 *
 *   mpirun -n N same_hash SCENE all|half|pairs|some|few SEEDS [KEY=VALUE]...
 *
 * all: every product of 1 .. N ranks, 1, 2 and 4 threads, schedulers and mappings; half: of each
 * the first, third, ... mapping, or the others, by turns; pairs: so that any two of number of
 * ranks, threads, scheduler, mapping and balancer meet at least once; some: a dozen; few: the first
 * and the last three of these. */
#include "cloth/flow/run.h"
#include "cloth/scene/scene.h"
#include "runtime/balance/balance.h"
#include "runtime/sched/sched.h"
#include "tests/support/policies.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct config {
    int ranks;
    unsigned threads;
    const char *scheduler, *mapping;
    uint64_t seed;
    const char *balance; /* NULL: each time the next one */
};

struct checks {
    const struct model *model;
    int world_rank, world_size;
    uint64_t expected;
    int n, failed;
};

static duite_options options_of(const struct config *config, struct flow *flow, MPI_Comm comm)
{
    duite_options options = duite_options_default();
    options.comm = comm;
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = config->threads;
    options.scheduler = duite_scheduler_find(config->scheduler);
    options.mapping = duite_mapping_find(config->mapping);
    options.seed = config->seed;
    options.bind = 0; /* the ranks that wait for this run would be in the way */
    return options;
}

/* Returns the hash, or 0 with the sentence in *error. */
static uint64_t run(const struct model *model, const struct config *config, const char *balance,
                    MPI_Comm comm, struct cloth_error *error)
{
    struct flow *flow;
    struct flow_report report = {0};
    duite *rt;
    int rank;
    MPI_Comm_rank(comm, &rank);
    int failed =
        (rank ? flow_join(&flow, error) : flow_prepare(&flow, model, config->ranks, error)) != 0;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, comm);
    if (failed)
        return 0;
    duite_options options = options_of(config, flow, comm);
    options.balance = duite_balancer_find(balance);
    int code = duite_start(&rt, &options);
    if (!code) {
        flow_run(flow, rt, NULL, NULL, &report, error);
        code = duite_stop(&rt);
    }
    if (code)
        cloth_fail(error, CLOTH_E_LIBRARY, "%s", duite_message());
    flow_free(flow);
    return error->code ? 0 : report.state_hash;
}

static size_t count(const char *const *names)
{
    size_t n = 0;
    while (names[n])
        n++;
    return n;
}

static size_t count_schedulers(void)
{
    return policies_count(duite_scheduler_names(), sched_test_names());
}

static const char *scheduler_at(size_t i)
{
    return policies_at(duite_scheduler_names(), sched_test_names(), i);
}

static size_t count_balancers(void)
{
    return policies_count(duite_balancer_names(), balance_test_names());
}

static const char *balancer_at(size_t i)
{
    return policies_at(duite_balancer_names(), balance_test_names(), i);
}

static const char *next_balance(int check)
{
    return balancer_at((size_t)check % count_balancers());
}

static void check(struct checks *checks, const struct config *config)
{
    MPI_Comm comm;
    const bool in = checks->world_rank < config->ranks;
    struct cloth_error error = {0};
    uint64_t hash = 0;
    const char *next = next_balance(checks->n++);
    const char *balance = config->balance ? config->balance : next;
    MPI_Comm_split(MPI_COMM_WORLD, in ? 0 : MPI_UNDEFINED, checks->world_rank, &comm);
    if (in) {
        hash = run(checks->model, config, balance, comm, &error);
        MPI_Comm_free(&comm);
    }
    /* Ranks that are not needed wait without getting in the way. */
    MPI_Request all;
    int done = 0;
    MPI_Ibarrier(MPI_COMM_WORLD, &all);
    while (!done) {
        MPI_Test(&all, &done, MPI_STATUS_IGNORE);
        if (!done)
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    if (checks->world_rank)
        return;
    if (!checks->expected)
        checks->expected = hash;
    const bool same = hash && hash == checks->expected;
    checks->failed += !same;
    printf("%s %d - %d ranks, %u threads, %s, %s, %s, seed %" PRIu64 ": %016" PRIx64 " %s\n",
           same ? "ok" : "not ok", checks->n, config->ranks, config->threads, config->scheduler,
           config->mapping, balance, config->seed, hash, error.text);
    fflush(stdout);
}

static void check_all(struct checks *checks, bool half)
{
    struct config config = {.seed = 1};
    int turn = 0;
    for (config.ranks = 1; config.ranks <= checks->world_size; config.ranks++)
        for (config.threads = 1; config.threads <= 4; config.threads *= 2)
            for (size_t s = 0; s < count_schedulers(); s++, turn++)
                for (const char *const *m = duite_mapping_names(); *m; m++) {
                    config.scheduler = scheduler_at(s);
                    config.mapping = *m;
                    if (!half || (m - duite_mapping_names() + turn) % 2 == 0)
                        check(checks, &config);
                }
}

static void check_some(struct checks *checks, bool few)
{
    static const struct config some[] = {
        {1, 1, "steal", "metis", 1, NULL},        {1, 2, "fifo", "metis", 1, NULL},
        {1, 4, "shuffle", "cyclic", 2, NULL},     {2, 1, "steal", "cyclic", 1, NULL},
        {2, 1, "shuffle", "metis", 3, NULL},      {2, 2, "fifo", "metis", 1, NULL},
        {2, 2, "locality", "taskgraph", 4, NULL}, {3, 1, "priority", "list", 1, NULL},
        {3, 2, "shuffle", "metis", 5, NULL},      {4, 1, "steal", "metis", 1, NULL},
        {4, 1, "fifo", "cyclic", 1, NULL},        {4, 2, "shuffle", "cyclic", 6, NULL},
    };
    const size_t n = sizeof some / sizeof *some;
    for (size_t i = 0; i < n; i++)
        if ((!few || i == 0 || i + 3 >= n) && some[i].ranks <= checks->world_size)
            check(checks, &some[i]);
}

/* ---- Pairs ---- */

enum { RANKS, THREADS, SCHEDULER, MAPPING, BALANCE, FACTORS, MAX_VALUES = 16 };

struct pairs {
    size_t values[FACTORS];
    bool met[FACTORS][MAX_VALUES][FACTORS][MAX_VALUES];
};

/* How many pairs of what is chosen and this value of factor f are not met yet. */
static size_t new_pairs(const struct pairs *pairs, const bool chosen[FACTORS],
                        const size_t pick[FACTORS], size_t f, size_t value)
{
    size_t n = 0;
    for (size_t g = 0; g < FACTORS; g++)
        n += chosen[g] && !pairs->met[f][value][g][pick[g]];
    return n;
}

/* Completes a choice: each factor gets the value that meets most of the others for the first time,
 * `turn` on from where the last one stood where several do. */
static void complete(const struct pairs *pairs, bool chosen[FACTORS], size_t turn,
                     size_t pick[FACTORS])
{
    for (size_t f = 0; f < FACTORS; f++) {
        size_t max = 0;
        if (chosen[f])
            continue;
        pick[f] = turn % pairs->values[f];
        for (size_t i = 0; i < pairs->values[f]; i++) {
            const size_t value = (turn + i) % pairs->values[f];
            const size_t n = new_pairs(pairs, chosen, pick, f, value);
            if (n <= max)
                continue;
            max = n;
            pick[f] = value;
        }
        chosen[f] = true;
    }
}

static void check_pair(struct checks *checks, struct pairs *pairs, size_t turn,
                       bool chosen[FACTORS], size_t pick[FACTORS])
{
    complete(pairs, chosen, turn, pick);
    for (size_t f = 0; f < FACTORS; f++)
        for (size_t g = 0; g < FACTORS; g++)
            pairs->met[f][pick[f]][g][pick[g]] = true;
    check(checks, &(struct config){.ranks = 1 + (int)pick[RANKS],
                                   .threads = 1U << pick[THREADS],
                                   .scheduler = scheduler_at(pick[SCHEDULER]),
                                   .mapping = duite_mapping_names()[pick[MAPPING]],
                                   .seed = 1 + turn,
                                   .balance = balancer_at(pick[BALANCE])});
}

/* The pairs of two factors that are not met. Returns the next turn. */
static size_t check_two(struct checks *checks, struct pairs *pairs, size_t f, size_t g, size_t turn)
{
    for (size_t i = 0; i < pairs->values[f]; i++)
        for (size_t j = 0; j < pairs->values[g]; j++) {
            bool chosen[FACTORS] = {false};
            size_t pick[FACTORS] = {0};
            if (pairs->met[f][i][g][j])
                continue;
            chosen[f] = chosen[g] = true;
            pick[f] = i;
            pick[g] = j;
            check_pair(checks, pairs, turn++, chosen, pick);
        }
    return turn;
}

static void check_pairs(struct checks *checks)
{
    struct pairs pairs = {.values = {(size_t)checks->world_size, 3, count_schedulers(),
                                     count(duite_mapping_names()), count_balancers()}};
    size_t turn = 0;
    check(checks, &(struct config){1, 1, "steal", "metis", 1, "none"}); /* what is expected */
    turn =
        check_two(checks, &pairs, SCHEDULER, MAPPING, turn); /* most values: the rest rides along */
    for (size_t f = 0; f < FACTORS; f++)
        for (size_t g = f + 1; g < FACTORS; g++)
            turn = check_two(checks, &pairs, f, g, turn);
}

static void check_seeds(struct checks *checks, uint64_t seeds)
{
    for (uint64_t seed = 1; seed <= seeds; seed++)
        check(checks, &(struct config){.ranks = 1 + (int)(seed % (uint64_t)checks->world_size),
                                       .threads = 1U << seed % 3,
                                       .scheduler = "shuffle",
                                       .mapping = seed % 2 ? "metis" : "cyclic",
                                       .seed = seed});
}

/* Reads the scene with the sets that follow on the command line. */
static int read_scene(struct model *model, int argc, char **argv, struct cloth_error *error)
{
    struct scene_set sets[16] = {{0}};
    size_t n = 0;
    if (argc < 4 || argc > 4 + 16)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "same_hash SCENE all|half|pairs|some|few SEEDS [KEY=VALUE]...");
    for (int i = 4; i < argc; i++)
        sets[n++].text = argv[i];
    return scene_read(model, argv[1], n, sets, error);
}

int main(int argc, char **argv)
{
    int level;
    struct model model = {0};
    struct cloth_error error = {0};
    struct checks checks = {.model = &model};
    const char *expected = getenv("DUITE_EXPECTED");
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &checks.world_rank);
    MPI_Comm_size(MPI_COMM_WORLD, &checks.world_size);
    if (expected)
        checks.expected = strtoull(expected, NULL, 16);
    if (read_scene(&model, argc, argv, &error)) {
        printf("Bail out! %s\n", error.text);
        checks.failed = 1;
    } else {
        if (!strcmp(argv[2], "all") || !strcmp(argv[2], "half"))
            check_all(&checks, !strcmp(argv[2], "half"));
        else if (!strcmp(argv[2], "pairs"))
            check_pairs(&checks);
        else
            check_some(&checks, !strcmp(argv[2], "few"));
        check_seeds(&checks, strtoull(argv[3], NULL, 10));
        if (!checks.world_rank)
            printf("1..%d\n", checks.n);
    }
    model_free(&model);
    MPI_Finalize();
    return checks.failed != 0;
}
