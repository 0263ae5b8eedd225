/* Ends in the middle of its work, without a stop, with the status given: rank 0 at once, or all
 * ranks with --all; or in a function of a policy, --map or --place; or a body ends its thread,
 * --thread. Messages are on their
 * way meanwhile, and workers poll. */
#include "tests/support/kernel.h"
#include "tests/support/ranks.h"

#include <duite.h>
#include <duite_policy.h>

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { TASKS = 20000, CHAINS = 4 };

static int ends_thread;

KERNEL(STEP, "step", .access = {DUITE_RW})
{
    if (++duite_out(call, 0, int64_t)[0] == TASKS / CHAINS / 2 && ends_thread)
        pthread_exit(NULL);
    return 0;
}

static const duite_kernel *const KERNELS[] = {&STEP, NULL};

/* ---- Policies that exit ---- */

static int status, calls;

static int map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)graph;
    (void)n_ranks;
    (void)seed;
    (void)home;
    exit(status);
}

static unsigned place(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    if (__atomic_add_fetch(&calls, 1, __ATOMIC_RELAXED) == TASKS / 4)
        exit(status);
    return DUITE_SHARED_QUEUE;
}

static void choose(duite_options *options, const char *function)
{
    static duite_mapping mapping;
    static duite_scheduler scheduler;
    mapping = *options->mapping;
    scheduler = *duite_scheduler_find("fifo");
    mapping.name = scheduler.name = "leaving";
    mapping.map = map;
    scheduler.place = place;
    if (!strcmp(function, "--map"))
        options->mapping = &mapping;
    if (!strcmp(function, "--place"))
        options->scheduler = &scheduler;
}

RANKS_CASE(exit)
{
    duite *rt;
    duite_object chain[CHAINS];
    duite_options options = duite_options_default();
    if (argc < 2)
        return 99;
    status = atoi(argv[1]);
    if (argc > 2)
        choose(&options, argv[2]);
    ends_thread = argc > 2 && !strcmp(argv[2], "--thread");
    options.kernels = KERNELS;
    options.threads = 2;
    if (duite_start(&rt, &options))
        return 98;
    for (int i = 0; i < CHAINS; i++)
        duite_new(rt, DUITE_I64, 1, &chain[i]);
    for (int i = 0; i < TASKS; i++)
        duite_fork_at(rt, (i / CHAINS) % duite_ranks(rt), &STEP, NULL, 1, &chain[i % CHAINS]);
    if (argc > 2 ? !strcmp(argv[2], "--all") : duite_rank(rt) == 0)
        exit(status);
    duite_wait(rt);
    return 97;
}
