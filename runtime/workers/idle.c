/* An idle worker spins, then gives way, then sleeps until it is woken. One idle worker of a rank is
 * the poller: it looks for messages, and for requests of the program that are over. It sleeps for
 * short pauses only, so no message waits while a worker idles. A poller that gets busy leaves that
 * to another worker.
 *
 * On a core of its own a worker gives way by sched_yield. On a crowded core, which busy programs
 * use as well, it does not. There sched_yield would give each of the others a slice (15 to 60 ms
 * beside four), and the message would come meanwhile. It spins for a moment, since a neighbour that
 * runs at the same time answers at once, and then sleeps.
 *
 * A worker notices a crowded core by a gap between two idle looks, or after the last one, in which
 * the kernel took the core away. It does not give way for LOST_FACTOR times the gap. So giving way
 * costs at most one part in LOST_FACTOR of the time, and soon after the core is free again the
 * worker waits as before. */
#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

#include <sys/resource.h>
#include <time.h>

enum { LOST_FACTOR = 100 };

/* The longest pause of a poller that sleeps. */
#define LONGEST_PAUSE_SECONDS 1e-3

/* The shortest gap that counts; and the time that a rank in a replay spins on a crowded core. A
 * message comes within it if the neighbour has a core, too. */
#define LOST_SECONDS    2e-4
#define CROWDED_SECONDS 5e-4

/* ---- The poller ---- */

static bool guests_are_here(const struct work_pool *pool)
{
    return comm_guests_are_here(&pool->setup.graph->guests);
}

static void poller_leave(struct worker *worker)
{
    worker->polls = false;
    atomic_exchange_explicit(&worker->pool->poller, 0, memory_order_seq_cst);
}

/* Makes the idle worker the poller if there is none. Returns whether it is the poller. One rank
 * needs one only for requests of the program. */
static bool poller_take(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    const bool needed = pool->setup.comm || guests_are_here(pool);
    if (!needed && worker->polls)
        poller_leave(worker);
    if (needed && !worker->polls && !atomic_load_explicit(&pool->poller, memory_order_relaxed))
        worker->polls = !atomic_exchange_explicit(&pool->poller, 1, memory_order_relaxed);
    return worker->polls;
}

void work_idle_over(struct worker *worker)
{
    work_stir(worker);
    if (!worker->polls)
        return;
    poller_leave(worker);
    queue_wake_one(&worker->pool->queues, DUITE_NO_QUEUE);
}

/* ---- Idle time ---- */

void work_idles(struct worker *worker, uint64_t now)
{
    const struct comm *comm = worker->pool->setup.comm;
    worker->idle_since = worker->looked = now;
    worker->awaited_then = comm ? comm_awaited_ticks(comm) : 0;
}

void work_stir(struct worker *worker)
{
    const struct comm *comm = worker->pool->setup.comm;
    if (worker->idle_since) {
        const uint64_t now = base_ticks(), idle = now - worker->idle_since;
        uint64_t exposed = comm ? comm_awaited_ticks(comm) - worker->awaited_then : 0;
        queue_bump(&worker->counts.idle, idle);
        queue_bump(&worker->counts.exposed, exposed);
        worker->within += idle;
        work_note_idle(worker, idle, exposed);
        work_is_crowded(worker, now); /* the core may have been away until what it idled for came */
    }
    worker->idle_since = 0;
    worker->pause = WORK_FIRST_PAUSE_SECONDS;
}

/* ---- Spinning ---- */

/* True if the kernel took the core away since the last call; a long gap alone may be the work on a
 * long message. False on the first call. */
static bool core_was_taken(struct worker *worker)
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
    if ((double)gap * worker->pool->queues.tick > LOST_SECONDS && core_was_taken(worker))
        worker->crowded_until = now + LOST_FACTOR * gap;
    return now < worker->crowded_until;
}

/* Ticks for which a poller gives way. */
static uint64_t poller_yield_ticks(const struct worker *worker)
{
    const struct work_pool *pool = worker->pool;
    if (!worker->polls)
        return 0;
    if (guests_are_here(pool) || (pool->setup.comm && comm_awaits(pool->setup.comm)))
        return pool->await_ticks;
    return pool->spin_ticks ? 0 : pool->yield_ticks;
}

/* Idles without sleeping for the first moments; false once it is time to sleep. */
static bool idle_spin(struct worker *worker)
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
    const uint64_t ticks = poller_yield_ticks(worker);
    if (crowded) {
        work_pause_core();
        return pool->spin_ticks && ticks && (double)since * pool->queues.tick < CROWDED_SECONDS;
    }
    if (since < ticks)
        sched_yield();
    return since < ticks;
}

/* ---- Sleeping ---- */

/* Sleeps until woken, or for so many seconds if they are > 0. If there is no poller it becomes the
 * poller instead. Returns a task if the last look found one. */
static struct task *idle_sleep(struct worker *worker, double seconds, const struct work_wish *wish)
{
    struct work_pool *pool = worker->pool;
    bool polled = worker->polls;
    atomic_fetch_add(&pool->queues.parked, 1);
    queue_park_announce(&worker->park);
    struct task *task = work_find(worker);
    if (task || atomic_load(&pool->stop) || work_wish_is_true(pool, wish) ||
        (!polled && poller_take(worker)))
        queue_park_cancel(&worker->park);
    else
        queue_park_sleep(&worker->park, seconds);
    worker->looked = base_ticks();
    atomic_fetch_sub(&pool->queues.parked, 1);
    return task;
}

void work_idle(struct worker *worker, const struct work_wish *wish)
{
    struct work_pool *pool = worker->pool;
    bool polls = poller_take(worker);
    if (polls && pool->balance && worker->idle_since)
        work_request(worker, base_ticks() - worker->idle_since);
    if (idle_spin(worker))
        return;
    struct task *task = idle_sleep(worker, polls || wish->unheard ? worker->pause : 0, wish);
    if (worker->pause < LONGEST_PAUSE_SECONDS)
        worker->pause *= 2;
    if (!task)
        return;
    work_busy_again(worker);
    work_run(worker, task);
}
