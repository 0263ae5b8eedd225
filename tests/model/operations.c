/* Operations of the code under test as steps of the machine. The machine does at the worst moment
 * what C leaves to an order weaker than needed. */
#include "tests/model/machine.h"

static bool releases(memory_order order)
{
    return order == memory_order_release || order == memory_order_acq_rel ||
           order == memory_order_seq_cst;
}

/* The order in which an operation with that plant is done. */
static memory_order order_with(enum explore_change change, memory_order order)
{
    return change == EXPLORE_RELAX || change == EXPLORE_REORDER ? memory_order_relaxed : order;
}

uint64_t explore_load(struct explore_place place, memory_order order)
{
    (void)order;
    if (machine_change(place.function, place.what) == EXPLORE_DROP)
        return 0;
    return machine_step((struct machine_step){.kind = MACHINE_LOAD, .place = place});
}

static uint64_t modify(enum machine_kind kind, struct explore_place place, uint64_t value,
                       uint64_t expected, memory_order order)
{
    return machine_step((struct machine_step){.kind = kind,
                                              .place = place,
                                              .writes = true,
                                              .drained = releases(order),
                                              .operand = value,
                                              .expected = expected});
}

void explore_store(struct explore_place place, uint64_t value, memory_order order)
{
    enum explore_change change = machine_change(place.function, place.what);
    if (change == EXPLORE_DROP)
        return;
    order = order_with(change, order);
    if (order == memory_order_seq_cst)
        modify(MACHINE_EXCHANGE, place, value, 0, order);
    else
        machine_store(place, value, order == memory_order_release);
}

uint64_t explore_exchange(struct explore_place place, uint64_t value, memory_order order)
{
    enum explore_change change = machine_change(place.function, place.what);
    if (change == EXPLORE_RELAX)
        machine_store(place, value, false);
    if (change == EXPLORE_RELAX || change == EXPLORE_DROP)
        return 0;
    return modify(MACHINE_EXCHANGE, place, value, 0, order_with(change, order));
}

uint64_t explore_add(struct explore_place place, uint64_t value, memory_order order)
{
    enum explore_change change = machine_change(place.function, place.what);
    if (change == EXPLORE_DROP)
        return 0;
    return modify(MACHINE_ADD, place, value, 0, order_with(change, order));
}

bool explore_compare(struct explore_place place, uint64_t *expected, uint64_t value,
                     memory_order order)
{
    enum explore_change change = machine_change(place.function, place.what);
    if (change == EXPLORE_DROP)
        return false;
    if (change == EXPLORE_RELAX) {
        modify(MACHINE_EXCHANGE, place, value, 0, memory_order_relaxed);
        return true;
    }
    uint64_t old = modify(MACHINE_COMPARE, place, value, *expected, order_with(change, order));
    bool same = old == *expected;
    *expected = old;
    return same;
}

void explore_fence(const char *function, memory_order order)
{
    explore_check_that(order == memory_order_seq_cst, "fences are sequentially consistent");
    if (machine_change(function, "fence") || !machine_buffers())
        return;
    machine_step((struct machine_step){
        .kind = MACHINE_FENCE, .drained = true, .place = {.function = function, .what = "fence"}});
}

static void await(struct explore_place place, uint64_t from, bool timed)
{
    explore_check_that(machine_self() >= 0, "nobody waits outside of the threads");
    machine_step((struct machine_step){
        .kind = MACHINE_AWAIT, .place = place, .expected = from, .timed = timed});
}

void explore_await_change(struct explore_place place, uint64_t from)
{
    await(place, from, false);
}

/* ---- Mutexes and conditions: a counter each, which only grows ---- */

static struct explore_place counter(const char *function, const char *what, void *object)
{
    return (struct explore_place){function, what, object, sizeof(uint64_t)};
}

int explore_clear(void *object)
{
    *(uint64_t *)object = 0;
    return 0;
}

/* Odd: locked. A try that fails sleeps until the counter has changed: nobody can take that back, so
 * that no thread's step ever makes another's impossible. */
int explore_lock(const char *function, pthread_mutex_t *mutex)
{
    struct explore_place place = counter(function, "mutex", mutex);
    if (machine_change(function, "lock"))
        return 0;
    for (;;) {
        uint64_t seen = explore_load(place, memory_order_relaxed);
        uint64_t expected = seen;
        if (seen % 2)
            await(place, seen, false);
        else if (explore_compare(place, &expected, seen + 1, memory_order_seq_cst))
            return 0;
    }
}

int explore_unlock(const char *function, pthread_mutex_t *mutex)
{
    if (!machine_change(function, "lock"))
        explore_add(counter(function, "mutex", mutex), 1, memory_order_seq_cst);
    return 0;
}

/* 0, or 1 when the time is up. */
int explore_wait(const char *function, pthread_cond_t *condition, pthread_mutex_t *mutex,
                 bool timed)
{
    struct explore_place place = counter(function, "condition", condition);
    uint64_t seen = explore_load(place, memory_order_relaxed);
    bool up = false;
    explore_unlock(function, mutex);
    if (timed && machine_time_left())
        up = explore_load(place, memory_order_relaxed) == seen;
    else
        await(place, seen, timed);
    explore_lock(function, mutex);
    return up;
}

int explore_signal(const char *function, pthread_cond_t *condition)
{
    explore_add(counter(function, "condition", condition), 1, memory_order_seq_cst);
    return 0;
}

/* ---- Threads ---- */

int explore_create(const char *function, pthread_t *thread, void *(*body)(void *), void *argument)
{
    (void)function;
    *thread = (pthread_t)machine_create(body, argument);
    return 0;
}

int explore_join(const char *function, pthread_t thread)
{
    await(counter(function, "join", machine_gone((int)thread)), 0, false);
    return 0;
}

pthread_t explore_self(void)
{
    return (pthread_t)machine_self();
}
