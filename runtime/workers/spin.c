/* How an idle worker waits before it sleeps. On a core of its own it spins, and then gives way. On
 * a core that busy programs use as well it does not give way: sched_yield gives the core away for a
 * slice of each of the others (15 to 60 ms beside four), and the message comes meanwhile. It spins
 * for a moment, since a neighbour that has a core at the same time answers at once, and then
 * sleeps.
 *
 * A worker notices such a core by a gap between two idle looks in which the kernel took the core
 * away. For LOST_FACTOR times as long it does not give way: so waiting this way costs at most one
 * part in LOST_FACTOR of the time, and a worker whose core is free again soon waits as before. */
#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

#include <sys/resource.h>

enum { LOST_FACTOR = 100 };

/* A gap that counts; and how long a rank in the middle of a replay spins on a crowded core: while
 * its neighbour has a core, too, messages come within that. */
#define LOST_SECONDS    2e-4
#define CROWDED_SECONDS 5e-4

/* Whether the kernel took the core away since the last time this was asked: a long look may have
 * moved a long message. A thread that never was counted says no. */
static bool was_switched(struct worker *worker)
{
    struct rusage usage;
    if (getrusage(RUSAGE_THREAD, &usage))
        return false;
    const bool more = worker->switches >= 0 && usage.ru_nivcsw > worker->switches;
    worker->switches = usage.ru_nivcsw;
    return more;
}

bool work_is_crowded(struct worker *worker, uint64_t now)
{
    const uint64_t gap = now - worker->looked;
    worker->looked = now;
    if ((double)gap * worker->pool->tick > LOST_SECONDS && was_switched(worker))
        worker->crowded_until = now + LOST_FACTOR * gap;
    return now < worker->crowded_until;
}

/* Ticks for which a poller gives way. */
static uint64_t give_way_ticks(const struct worker *worker)
{
    const struct work_pool *pool = worker->pool;
    if (!worker->polls)
        return 0;
    if (comm_awaits(pool->setup.comm))
        return pool->await_ticks;
    return pool->spin_ticks ? 0 : pool->yield_ticks;
}

bool work_spins(struct worker *worker)
{
    const struct work_pool *pool = worker->pool;
    const uint64_t now = base_ticks();
    if (!worker->idle_since) {
        work_idles(worker, now);
        work_ran_out(worker);
    }
    const bool crowded = work_is_crowded(worker, now);
    const uint64_t since = now - worker->idle_since;
    if (since < pool->spin_ticks) {
        work_pause_core();
        return true;
    }
    const uint64_t ticks = give_way_ticks(worker);
    if (crowded) {
        work_pause_core();
        return pool->spin_ticks && ticks && (double)since * pool->tick < CROWDED_SECONDS;
    }
    if (since < ticks)
        sched_yield();
    return since < ticks;
}
