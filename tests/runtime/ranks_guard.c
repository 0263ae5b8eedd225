/* Policies of which a function never returns on one rank: every rank's next or present blocking
 * call names it, and all stop. */
#include "tests/negative/misuse.h"

#include <duite_policy.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { TASKS = 20 };

static int rank;
static _Atomic(const char *) hung; /* the function that never returns on this rank */
static _Atomic int forever = 1;

static void may_hang(const char *function)
{
    const char *name = atomic_load(&hung);

    if (name && !strcmp(name, function))
        while (atomic_load(&forever))
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

/* ---- Policies that otherwise work ---- */

static int map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)n_ranks;
    (void)seed;
    may_hang("map");
    for (size_t i = 0; i < graph->n; i++)
        home[i] = 0;
    return 0;
}

static int map_tasks(const duite_task_graph *graph, int *home)
{
    (void)graph;
    (void)home;
    may_hang("map_tasks");
    return 0;
}

static int ask(void *state, unsigned attempt, int giver, double *seconds)
{
    (void)attempt;
    (void)giver;
    may_hang("victim");
    *seconds = 1e-3;
    return *(int *)state ? 0 : 1;
}

static int give(void *state, const duite_asked *asked, const duite_leaf *leaf)
{
    (void)state;
    (void)asked;
    (void)leaf;
    may_hang("give");
    return 0;
}

static int send(void *state, const duite_leaf *leaf)
{
    (void)leaf;
    may_hang("place");
    return *(int *)state;
}

static uint64_t migrate(void *state, const duite_blocks *blocks, int *home)
{
    (void)state;
    (void)blocks;
    (void)home;
    may_hang("migrate");
    return 1;
}

static void begin(void *state, int own, int n_ranks, unsigned worker, uint64_t seed)
{
    (void)n_ranks;
    (void)worker;
    (void)seed;
    *(int *)state = own;
}

static unsigned place(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    may_hang("place");
    return DUITE_SHARED_QUEUE;
}

static duite_end serve(void *state)
{
    (void)state;
    return DUITE_NEWEST;
}

static unsigned nobody(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

static int never(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return 0;
}

static const duite_mapping MAPPING = {
    .name = "hanging", .summary = "for tests", .map = map, .map_tasks = map_tasks};
static const duite_balancer ASKING = {.name = "hanging",
                                      .summary = "for tests",
                                      .state_size = sizeof(int),
                                      .start = begin,
                                      .victim = ask,
                                      .give = give},
                            SENDING = {.name = "hanging",
                                       .summary = "for tests",
                                       .state_size = sizeof(int),
                                       .start = begin,
                                       .place = send},
                            MOVING = {
                                .name = "hanging", .summary = "for tests", .migrate = migrate};
static const duite_scheduler SCHEDULER = {.name = "hanging",
                                          .summary = "for tests",
                                          .place = place,
                                          .serve = serve,
                                          .victim = nobody,
                                          .chain = never};

/* ---- Programs ---- */

static int build(duite *rt, void *context)
{
    duite_object *object = context;

    for (int i = 1; i < TASKS; i++)
        duite_fork(rt, &COPY, NULL, 2, object + i - 1);
    return 0;
}

/* Leaves on rank 0, where all objects are, and a recorded graph; until a call fails. */
static int work(duite *rt)
{
    duite_object object[TASKS];
    duite_graph graph;
    int32_t zero = 0, value;
    int code;

    for (int i = 0; i < TASKS; i++)
        object[i] = misuse_new(rt, 1);
    duite_set(rt, object[0], &zero);
    code = duite_graph_new(rt, build, object, &graph);
    while (!code) {
        for (int i = 0; i < TASKS; i++)
            duite_fork(rt, &ADD, NULL, 1, &object[i]);
        code = duite_replay(rt, graph, 2);
        code = code ? code : duite_get(rt, object[TASKS - 1], &value);
        code = code ? code : duite_wait(rt);
    }
    return code;
}

static void one_hangs(const char *kind, const char *function, int where,
                      const duite_options *policies)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = NULL;
    char wanted[100], name[100];

    options.scheduler = policies->scheduler ? policies->scheduler : options.scheduler;
    options.mapping = policies->mapping ? policies->mapping : duite_mapping_find("block");
    options.balance = policies->balance ? policies->balance : options.balance;
    options.policy_seconds = 0.2;
    snprintf(name, sizeof name, "%s of a %s hangs on rank %d", function, kind, where);
    snprintf(wanted, sizeof wanted, "%s hanging: its %s did not return for 0.2 s (rank %d, worker ",
             kind, function, where);
    atomic_store(&hung, NULL);
    int right = !duite_start(&rt, &options);
    atomic_store(&hung, rank == where ? function : NULL);
    right = right && work(rt) == DUITE_E_ARGUMENT && strstr(duite_message(), wanted);
    if (!right)
        fprintf(stderr, "# rank %d: '%s'\n", rank, duite_message());
    right = right && duite_stop(&rt) == DUITE_E_ARGUMENT && !rt;
    tap_case(right, name);
}

int main(void)
{
    misuse_mpi();
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (int where = 0; where < 2; where++) {
        one_hangs("mapping", "map", where, &(duite_options){.mapping = &MAPPING});
        one_hangs("scheduler", "place", where, &(duite_options){.scheduler = &SCHEDULER});
    }
    one_hangs("mapping", "map_tasks", 0, &(duite_options){.mapping = &MAPPING});
    one_hangs("balancer", "victim", 1, &(duite_options){.balance = &ASKING});
    one_hangs("balancer", "give", 0, &(duite_options){.balance = &ASKING});
    one_hangs("balancer", "place", 0, &(duite_options){.balance = &SENDING});
    one_hangs("balancer", "migrate", 0, &(duite_options){.balance = &MOVING});
    return tap_done();
}
