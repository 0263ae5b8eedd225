/* How long a graph takes under a scheduler, counted in virtual time: bodies of two workers meet,
 * and each meeting is one unit. A body that no other one can join runs its unit alone. So no clock
 * is read, and what is counted is what the workers were given, not how fast they were. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <duite_policy.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { LENGTH = 40 }; /* of the chain, and how many tasks may run at any time */

/* Under the lock. */
static struct {
    int units;   /* that passed */
    int free;    /* of the tasks that may run at any time: not begun */
    int chained; /* of the chain: over */
    bool ready;  /* its next one may begin */
    int inside;  /* bodies that wait for their unit to pass */
    bool links;  /* one of these is of the chain */
} now;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t passed = PTHREAD_COND_INITIALIZER;

/* True if the unit is whole: both are here, or nobody else can come. */
static bool is_whole(void)
{
    return now.inside == 2 || (!now.free && !now.ready);
}

KERNEL(UNIT, "unit", .access = {DUITE_RW, DUITE_R}, .args_size = sizeof(int))
{
    const bool link = *(const int *)call->args;

    pthread_mutex_lock(&lock);
    now.inside++;
    now.free -= !link;
    now.ready = now.ready && !link;
    now.links = now.links || link;
    const int mine = now.units;
    if (is_whole()) {
        now.units++;
        now.inside = 0;
        now.chained += now.links;
        now.ready = now.ready || (now.links && now.chained < LENGTH);
        now.links = false;
        pthread_cond_broadcast(&passed);
    }
    while (now.units == mine)
        pthread_cond_wait(&passed, &lock);
    pthread_mutex_unlock(&lock);
    return 0;
}

KERNEL(BEGIN, "begin", .access = {DUITE_W})
{
    (void)call;
    return 0;
}

/* The chain is forked last; all wait for the first task, so that all are there when one is taken.
 */
static int build(duite *rt, void *context)
{
    const duite_object *object = context;
    const duite_object gate = object[LENGTH + 1];

    duite_fork(rt, &BEGIN, NULL, 1, &gate);
    for (int i = 0; i < 2 * LENGTH; i++) {
        const int link = i >= LENGTH;
        const duite_object own = object[link ? LENGTH : i];

        duite_fork_with(rt, &(duite_task_options){.cost = 1}, &UNIT, &link, 2,
                        (duite_object[]){own, gate});
    }
    return 0;
}

static int makespan(const char *scheduler)
{
    static const duite_kernel *const KERNELS[] = {&BEGIN, &UNIT, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_object object[LENGTH + 2];
    duite_graph graph;
    duite *rt;

    misuse_mpi();
    options.kernels = KERNELS;
    options.scheduler = duite_scheduler_find(scheduler);
    options.threads = 2;
    memset(&now, 0, sizeof now);
    now.free = LENGTH;
    now.ready = true;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    for (int i = 0; i < LENGTH + 2; i++)
        object[i] = misuse_new(rt, 1);
    ck_assert_int_eq(duite_graph_new(rt, build, object, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 1), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    duite_graph_free(rt, graph);
    for (int i = 0; i < LENGTH + 2; i++)
        duite_free(rt, object[i]);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    ck_assert_int_eq(now.chained, LENGTH);
    ck_assert_int_eq(now.free, 0);
    return now.units;
}

/* 40 units, and at most one more for what was taken while the first task still released others;
 * who takes what came first has the chain to do when all else is done: 20 + 40, or one less. */
UNIT_TEST(a_chain_that_was_forked_last)
{
    const int knowing = makespan("priority"), in_order = makespan("fifo");

    printf("# priority %d, fifo %d units\n", knowing, in_order);
    ck_assert_int_ge(knowing, LENGTH);
    ck_assert_int_le(knowing, LENGTH + 1);
    ck_assert_int_ge(in_order, 3 * LENGTH / 2 - 1);
    ck_assert_int_le(in_order, 3 * LENGTH / 2);
}
