/* Policies of which a function does not return on one rank until that rank's standstill report has
 * named it: then it goes on, and all ranks end with the right values. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"
#include "tests/support/said.h"

#include <duite_policy.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { TASKS = 20, MOST_WAITS = 120000 };

#define SECONDS 0.2

static const char *kind;            /* of the policy that hangs */
static _Atomic(const char *) hangs; /* the function that does on this rank; NULL: none any more */
static _Atomic int entered;         /* that function was called */

static int told(const char *function)
{
    char begin[100], wanted[100];

    snprintf(begin, sizeof begin, "duite: rank %d: worker ", rank);
    snprintf(wanted, sizeof wanted, " is in the %s of %s hanging, which has not returned", function,
             kind);
    return said_lines(begin, wanted);
}

static void may_hang(const char *function)
{
    const char *name = atomic_load(&hangs);

    if (!name || strcmp(name, function) != 0 ||
        !atomic_compare_exchange_strong(&hangs, &name, NULL))
        return;
    atomic_store(&entered, 1);
    for (int i = 0; i < MOST_WAITS && !told(function); i++)
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

/* As map, but it may hang only when a balancer asks it: the objects have their homes by then. */
static int map_later(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    static int asked;

    (void)n_ranks;
    (void)seed;
    if (asked++)
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

static int ask(void *state, unsigned attempt, int granter, double *seconds)
{
    (void)attempt;
    (void)granter;
    may_hang("victim");
    *seconds = 1e-3;
    return *(int *)state ? 0 : 1;
}

static int grant(void *state, const duite_request *asked, const duite_leaf *leaf)
{
    (void)state;
    (void)asked;
    (void)leaf;
    may_hang("grant");
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

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    (void)n_workers;
    (void)seed;
    may_hang("start");
    *(unsigned *)state = worker;
}

static void locate(void *state, const duite_near *near)
{
    (void)state;
    (void)near;
    may_hang("locate");
}

static unsigned victim(void *state, unsigned attempt)
{
    (void)attempt;
    if (*(unsigned *)state) /* not the main thread's */
        may_hang("victim");
    return DUITE_NO_QUEUE;
}

static int chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    may_hang("chain");
    return 1;
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
    may_hang("serve");
    return DUITE_NEWEST;
}

static const duite_mapping MAPPING = {.size = sizeof(duite_mapping),
                                      .name = "hanging",
                                      .summary = "for tests",
                                      .map = map,
                                      .map_tasks = map_tasks};
static const duite_mapping MAPPING_LATER = {
    .size = sizeof(duite_mapping), .name = "hanging", .summary = "for tests", .map = map_later};
static const duite_balancer ASKING = {.size = sizeof(duite_balancer),
                                      .name = "hanging",
                                      .summary = "for tests",
                                      .state_size = sizeof(int),
                                      .start = begin,
                                      .victim = ask,
                                      .grant = grant},
                            SENDING = {.size = sizeof(duite_balancer),
                                       .name = "hanging",
                                       .summary = "for tests",
                                       .state_size = sizeof(int),
                                       .start = begin,
                                       .place = send},
                            MOVING = {.size = sizeof(duite_balancer),
                                      .name = "hanging",
                                      .summary = "for tests",
                                      .migrate = migrate};
static const duite_scheduler SCHEDULER = {.size = sizeof(duite_scheduler),
                                          .name = "hanging",
                                          .summary = "for tests",
                                          .state_size = sizeof(unsigned),
                                          .start = start,
                                          .locate = locate,
                                          .place = place,
                                          .serve = serve,
                                          .victim = victim,
                                          .chain = chain};

/* ---- Programs ---- */

/* Long enough for a balancer to move blocks. */
KERNEL(SLOW, "slow", .access = {DUITE_RW})
{
    (void)call;
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    return 0;
}

static int build(duite *rt, void *context)
{
    duite_object *object = context;

    for (int i = 1; i < TASKS; i++)
        duite_fork(rt, &COPY, NULL, 2, object + i - 1);
    for (int i = 1; i < TASKS; i++)
        duite_fork(rt, &SLOW, NULL, 1, object + i);
    return 0;
}

KERNEL(ENTERED, "entered", .access = {DUITE_W})
{
    *duite_out(call, 0, int32_t) = atomic_load(&entered);
    return 0;
}

/* Leaves on rank 0, where all objects are, and a recorded graph; until rank `where` was hung. The
 * values are right. */
static int works(duite *rt, int where)
{
    duite_object object[TASKS], seen = misuse_new(rt, 1);
    duite_graph graph;
    int32_t zero = 0, value = -1, state = 0;
    int code;

    for (int i = 0; i < TASKS; i++)
        object[i] = misuse_new(rt, 1);
    duite_set(rt, object[0], &zero);
    code = duite_graph_new(rt, build, object, &graph);
    while (!code && !state) {
        for (int i = 0; i < TASKS; i++)
            duite_fork(rt, &ADD, NULL, 1, &object[i]);
        code = duite_replay(rt, graph, 2);
        duite_set(rt, object[0], &zero);
        code = code ? code : duite_replay(rt, graph, 1);
        code = code ? code : duite_get(rt, object[TASKS - 1], &value);
        code = code ? code : duite_fork_at(rt, where, &ENTERED, NULL, 1, &seen);
        code = code ? code : duite_get(rt, seen, &state);
        code = code ? code : duite_wait(rt);
    }
    if (!code)
        code = duite_graph_free(rt, graph);
    for (int i = 0; i < TASKS && !code; i++)
        code = duite_free(rt, object[i]);
    code = code ? code : duite_free(rt, seen);
    return !code && state == 1 && value == TASKS - 1;
}

static void one_hangs(const char *what, const char *function, int where,
                      const duite_options *policies)
{
    static const duite_kernel *const KERNELS[] = {&SET, &COPY, &ADD, &SLOW, &ENTERED, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = NULL;
    char name[100];

    options.kernels = KERNELS;
    options.scheduler = policies->scheduler ? policies->scheduler : options.scheduler;
    options.mapping = policies->mapping ? policies->mapping : duite_mapping_find("block");
    options.balance = policies->balance ? policies->balance : options.balance;
    options.stuck_seconds = SECONDS;
    snprintf(name, sizeof name, "%s of a %s%s hangs on rank %d", function, what,
             policies->mapping && policies->balance ? " that a balancer asks" : "", where);
    kind = what;
    const int starts = !strcmp(function, "start") || !strcmp(function, "locate");
    atomic_store(&entered, 0);
    atomic_store(&hangs, starts && rank == where ? function : NULL);
    said_begin();
    int right = !duite_start(&rt, &options);
    if (!starts)
        atomic_store(&hangs, rank == where ? function : NULL);
    right = right && works(rt, where);
    right = right && !duite_stop(&rt);
    right =
        right && (rank == where ? told(function) == 1 && said_lines("duite: ", "not returned") == 1
                                : !said_lines("duite: ", "not returned"));
    said_end();
    tap_case(right, name);
}

RANKS_CASE(stuck_policies)
{
    misuse_mpi();
    static const char *const SCHEDULES[] = {"place", "serve", "victim", "chain", "start", "locate"};
    for (int where = 0; where < 2; where++)
        one_hangs("mapping", "map", where, &(duite_options){.mapping = &MAPPING});
    for (int i = 0; i < 6; i++)
        one_hangs("scheduler", SCHEDULES[i], i % 2, &(duite_options){.scheduler = &SCHEDULER});
    one_hangs("mapping", "map_tasks", 0, &(duite_options){.mapping = &MAPPING});
    one_hangs(
        "mapping", "map", 0,
        &(duite_options){.mapping = &MAPPING_LATER, .balance = duite_balancer_find("migrate")});
    one_hangs("balancer", "victim", 1, &(duite_options){.balance = &ASKING});
    one_hangs("balancer", "grant", 0, &(duite_options){.balance = &ASKING});
    one_hangs("balancer", "place", 0, &(duite_options){.balance = &SENDING});
    one_hangs("balancer", "migrate", 0, &(duite_options){.balance = &MOVING});
    return tap_done();
}
