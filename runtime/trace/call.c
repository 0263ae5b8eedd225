/* The program's words: the main thread of rank 0 alone writes them. What every rank would say is
 * said once. An entry may lie in two sections. */
#include "runtime/trace/internal.h"

#include "runtime/base/memory.h"
#include "runtime/data/view.h"

#include <string.h>

static void put(struct trace *trace, uint32_t word)
{
    if (trace->n_words + 1 >= TRACE_WORDS) /* one is left for a filler */
        trace_flush_words(trace);
    trace->word[trace->n_words++] = word;
}

static void put_long(struct trace *trace, uint64_t value)
{
    put(trace, (uint32_t)value);
    put(trace, (uint32_t)(value >> 32));
}

static void put_double(struct trace *trace, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_long(trace, bits);
}

static void put_float(struct trace *trace, double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put(trace, bits);
}

enum { MOST = 1 << 24 }; /* of anything in an entry */

/* False: it is too large for an entry, and lost. */
static bool begin(struct trace *trace, enum trace_call call, size_t n)
{
    trace->words_lost += n >= MOST;
    if (n < MOST)
        put(trace, (uint32_t)call | (uint32_t)n << 8);
    return n < MOST;
}

/* Whether entries are kept here: such as are always there, and such as depend on the step. */
static bool keeps(const struct trace *trace)
{
    return trace && trace->word;
}

static bool keeps_now(const struct trace *trace)
{
    return keeps(trace) && trace_is_on(trace);
}

/* ---- Objects and homes ---- */

void trace_object(struct trace *trace, const struct data_table *table, duite_object name)
{
    if (!keeps(trace))
        return;
    const struct data_object *object = &table->object[name.slot];
    begin(trace, object->view ? TRACE_VIEW : TRACE_OBJECT, 0);
    put(trace, name.slot);
    if (object->view)
        put(trace, object->view->parent);
    put_long(trace, object->room);
}

void trace_freed(struct trace *trace, duite_object name)
{
    if (!keeps(trace))
        return;
    begin(trace, TRACE_FREE, 0);
    put(trace, name.slot);
}

void trace_hint(struct trace *trace, duite_object name, double weight, size_t n,
                const duite_object *neighbours, const double *edge_weights)
{
    if (!keeps(trace) || !begin(trace, TRACE_HINT, n))
        return;
    put(trace, name.slot);
    put_double(trace, weight);
    for (size_t i = 0; i < n; i++) {
        put(trace, neighbours[i].slot);
        put_double(trace, edge_weights ? edge_weights[i] : 1);
    }
}

void trace_follow(struct trace *trace, duite_object name, duite_object leader)
{
    if (!keeps(trace))
        return;
    begin(trace, TRACE_FOLLOW, 0);
    put(trace, name.slot);
    put(trace, leader.slot);
}

void trace_settles(struct trace *trace, const struct data_table *table)
{
    if (!keeps(trace))
        return;
    void *moved =
        base_grow(trace->slot, &trace->slots_capacity, table->n_unsettled + 1, sizeof *trace->slot);
    trace->n_slots = moved ? table->n_unsettled : 0;
    if (moved)
        trace->slot = moved;
    else
        trace->words_lost += table->n_unsettled;
    for (size_t i = 0; i < trace->n_slots; i++)
        trace->slot[i] = table->unsettled[i].slot;
}

void trace_settled(struct trace *trace, const struct data_table *table)
{
    if (keeps(trace))
        trace_moved(trace, table, trace->slot, trace->n_slots);
}

void trace_moved(struct trace *trace, const struct data_table *table, const uint32_t *slots,
                 size_t n)
{
    enum { MANY = MOST / 2 };
    for (size_t at = 0; keeps(trace) && at < n; at += MANY) {
        size_t many = n - at < MANY ? n - at : MANY;
        begin(trace, TRACE_HOMES, many);
        for (size_t i = at; i < at + many; i++) {
            put(trace, slots[i]);
            put(trace, (uint32_t)table->object[slots[i]].home);
        }
    }
}

/* ---- Tasks ---- */

void trace_switch(struct trace *trace, bool on, uint64_t step, uint64_t forks)
{
    atomic_store_explicit(&trace->on, on, memory_order_relaxed);
    if (!keeps(trace))
        return;
    begin(trace, on ? TRACE_ON : TRACE_OFF, 0);
    put_long(trace, forks);
    put_long(trace, step);
    put_long(trace, base_ticks());
}

static uint32_t place_of(struct trace *trace, const duite_kernel *kernel)
{
    if (trace->last == kernel)
        return trace->last_index;
    trace->last = kernel;
    for (trace->last_index = 0; trace->kernels[trace->last_index] != kernel; trace->last_index++)
        continue;
    return trace->last_index;
}

void trace_fork(struct trace *trace, const duite_kernel *kernel, const struct task_options *how,
                size_t n, const duite_object *objects)
{
    if (!keeps_now(trace))
        return;
    bool plain = how->at == TASK_ANYWHERE && !how->priority && !(how->cost > 0);
    if (!begin(trace, plain ? TRACE_FORK : TRACE_FORKED, n))
        return;
    put(trace, place_of(trace, kernel));
    if (!plain) {
        put(trace, (uint32_t)how->at);
        put(trace, (uint32_t)how->priority);
        put_float(trace, how->cost);
    }
    for (size_t i = 0; i < n; i++)
        put(trace, objects[i].slot);
}

void trace_set(struct trace *trace, duite_object name)
{
    if (!keeps_now(trace))
        return;
    begin(trace, TRACE_SET, 0);
    put(trace, name.slot);
}

void trace_get(struct trace *trace, duite_object name, int rank, uint64_t from)
{
    if (!keeps_now(trace))
        return;
    begin(trace, TRACE_GET, 0);
    put(trace, name.slot);
    put(trace, (uint32_t)rank);
    put_long(trace, from);
    put_long(trace, base_ticks());
}

void trace_wait(struct trace *trace, uint64_t from)
{
    if (!keeps_now(trace))
        return;
    begin(trace, TRACE_WAIT, 0);
    put_long(trace, from);
    put_long(trace, base_ticks());
}

/* ---- Recorded graphs ---- */

void trace_graph(struct trace *trace, uint32_t name, const struct plan_record *record)
{
    if (!keeps(trace) || !begin(trace, TRACE_GRAPH, record->n_objects))
        return;
    put(trace, name);
    for (size_t i = 0; i < record->n_objects; i++)
        put(trace, record->object[i].recorded.slot);
    put(trace, (uint32_t)record->n_forks);
    for (size_t i = 0; i < record->n_forks; i++) {
        const struct plan_recorded_fork *fork = &record->fork[i];
        put(trace, fork->kernel);
        put(trace, fork->n);
        put(trace, (uint32_t)fork->how.at);
        put(trace, (uint32_t)fork->how.priority);
        put_float(trace, fork->how.cost);
        for (uint32_t k = 0; k < fork->n; k++)
            put(trace, record->access[fork->first + k].object);
    }
}

void trace_replay(struct trace *trace, uint32_t name, const struct plan_record *record,
                  const duite_object *flag, uint64_t rounds)
{
    if (!keeps_now(trace) || !begin(trace, TRACE_REPLAY, record->n_objects))
        return;
    put(trace, name);
    put(trace, flag ? flag->slot : 0);
    put_long(trace, rounds);
    put_long(trace, record->graph->root.forks);
    for (size_t i = 0; i < record->n_objects; i++)
        put(trace, record->object[i].bound.slot);
}
