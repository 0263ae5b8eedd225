/* The program's words: the main thread of rank 0 alone writes them. All ranks
 * make the same calls, so that one record is enough. An entry may lie in two sections. */
#include "runtime/trace/internal.h"

#include "runtime/base/memory.h"
#include "runtime/data/object.h"
#include "runtime/task/internal.h"

#include <string.h>

static void word_put(struct trace *trace, uint32_t word)
{
    if (trace->n_words + 1 >= TRACE_WORDS) /* one is left for a filler */
        trace_flush_words(trace);
    trace->word[trace->n_words++] = word;
}

static void word_put_long(struct trace *trace, uint64_t value)
{
    word_put(trace, (uint32_t)value);
    word_put(trace, (uint32_t)(value >> 32));
}

static void word_put_double(struct trace *trace, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    word_put_long(trace, bits);
}

static void word_put_float(struct trace *trace, double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    word_put(trace, bits);
}

enum { MAX_ENTRY = 1 << 24 }; /* of anything in an entry */

/* Objects, homes and graphs are always kept; all others only while steps are recorded. */
static bool call_is_always_kept(enum trace_call call)
{
    return call <= TRACE_OFF || call == TRACE_GRAPH;
}

/* False: this rank does not keep it now; or it is too large for an entry, and lost. */
static bool entry_begin(struct trace *trace, enum trace_call call, size_t n)
{
    if (!trace || !trace->word || !(call_is_always_kept(call) || trace_is_on(trace)))
        return false;
    trace->words_lost += n >= MAX_ENTRY;
    if (n < MAX_ENTRY)
        word_put(trace, (uint32_t)call | (uint32_t)n << 8);
    return n < MAX_ENTRY;
}

/* ---- Objects and homes ---- */

void trace_object(struct trace *trace, const struct data_table *table, duite_object name)
{
    if (!entry_begin(trace, TRACE_OBJECT, 0))
        return;
    const struct data_object *object = &table->object[name.slot];
    word_put(trace, name.slot);
    word_put_long(trace, object->room);
}

void trace_freed(struct trace *trace, duite_object name)
{
    if (!entry_begin(trace, TRACE_FREE, 0))
        return;
    word_put(trace, name.slot);
}

void trace_hint(struct trace *trace, duite_object name, double weight, size_t n,
                const duite_object *neighbours, const double *edge_weights)
{
    if (!entry_begin(trace, TRACE_HINT, n))
        return;
    word_put(trace, name.slot);
    word_put_double(trace, weight);
    for (size_t i = 0; i < n; i++) {
        word_put(trace, neighbours[i].slot);
        word_put_double(trace, edge_weights ? edge_weights[i] : 1);
    }
}

void trace_colocate(struct trace *trace, duite_object name, duite_object leader)
{
    if (!entry_begin(trace, TRACE_COLOCATE, 0))
        return;
    word_put(trace, name.slot);
    word_put(trace, leader.slot);
}

void trace_settles(struct trace *trace, const struct data_table *table)
{
    if (!trace || !trace->word)
        return;
    const bool fine = BASE_GROW(trace->slot, trace->slots_capacity, table->n_unsettled + 1);
    trace->n_slots = fine ? table->n_unsettled : 0;
    trace->words_lost += table->n_unsettled - trace->n_slots;
    for (size_t i = 0; i < trace->n_slots; i++)
        trace->slot[i] = table->unsettled[i].slot;
}

void trace_settled(struct trace *trace, const struct data_table *table)
{
    if (trace)
        trace_moved(trace, table, trace->slot, trace->n_slots);
}

void trace_moved(struct trace *trace, const struct data_table *table, const uint32_t *slots,
                 size_t n)
{
    enum { MANY = MAX_ENTRY / 2 };
    for (size_t at = 0; at < n; at += MANY) {
        size_t many = n - at < MANY ? n - at : MANY;
        if (!entry_begin(trace, TRACE_HOMES, many))
            return;
        for (size_t i = at; i < at + many; i++) {
            word_put(trace, slots[i]);
            word_put(trace, (uint32_t)table->object[slots[i]].home);
        }
    }
}

/* ---- Tasks ---- */

void trace_switch(struct trace *trace, bool on, uint64_t step, uint64_t forks)
{
    atomic_store_explicit(&trace->on, on, memory_order_relaxed);
    if (!entry_begin(trace, on ? TRACE_ON : TRACE_OFF, 0))
        return;
    word_put_long(trace, forks);
    word_put_long(trace, step);
    word_put_long(trace, base_ticks());
}

void trace_fork(struct trace *trace, const duite_kernel *kernel, const struct task_options *options,
                size_t n, const duite_object *objects)
{
    bool plain = options->at == TASK_ANYWHERE && !options->priority && !(options->cost > 0);
    if (!entry_begin(trace, plain ? TRACE_FORK : TRACE_FORKED, n))
        return;
    word_put(trace, task_kernel_find(trace->graph, kernel)->index);
    if (!plain) {
        word_put(trace, (uint32_t)options->at);
        word_put(trace, (uint32_t)options->priority);
        word_put_float(trace, options->cost);
    }
    for (size_t i = 0; i < n; i++)
        word_put(trace, objects[i].slot);
}

void trace_set(struct trace *trace, duite_object name)
{
    if (!entry_begin(trace, TRACE_SET, 0))
        return;
    word_put(trace, name.slot);
}

static void word_put_span(struct trace *trace, uint64_t from)
{
    word_put_long(trace, from);
    word_put_long(trace, base_ticks());
}

void trace_get(struct trace *trace, duite_object name, int rank, uint64_t from)
{
    if (!entry_begin(trace, TRACE_GET, 0))
        return;
    word_put(trace, name.slot);
    word_put(trace, (uint32_t)rank);
    word_put_span(trace, from);
}

void trace_get_begin(struct trace *trace, duite_object name, uint32_t get)
{
    if (!entry_begin(trace, TRACE_GET_BEGIN, 0))
        return;
    word_put(trace, get);
    word_put(trace, name.slot);
}

void trace_get_end(struct trace *trace, uint32_t get, uint64_t from)
{
    if (!entry_begin(trace, TRACE_GET_END, 0))
        return;
    word_put(trace, get);
    word_put_span(trace, from);
}

void trace_wait(struct trace *trace, uint64_t from)
{
    if (entry_begin(trace, TRACE_WAIT, 0))
        word_put_span(trace, from);
}

/* ---- Recorded graphs ---- */

void trace_graph(struct trace *trace, uint32_t name, const struct plan_record *record)
{
    if (!entry_begin(trace, TRACE_GRAPH, record->n_objects))
        return;
    word_put(trace, name);
    for (size_t i = 0; i < record->n_objects; i++)
        word_put(trace, record->object[i].recorded.slot);
    word_put(trace, (uint32_t)record->n_forks);
    for (size_t i = 0; i < record->n_forks; i++) {
        const struct plan_recorded_fork *fork = &record->fork[i];
        word_put(trace, fork->kernel);
        word_put(trace, fork->n);
        word_put(trace, (uint32_t)fork->options.at);
        word_put(trace, (uint32_t)fork->options.priority);
        word_put_float(trace, fork->options.cost);
        for (uint32_t k = 0; k < fork->n; k++)
            word_put(trace, record->access[fork->first + k].object);
    }
}

void trace_replay(struct trace *trace, uint32_t name, const struct plan_record *record,
                  const duite_object *flag, uint64_t rounds)
{
    if (!entry_begin(trace, TRACE_REPLAY, record->n_objects))
        return;
    word_put(trace, name);
    word_put(trace, flag ? flag->slot : 0);
    word_put_long(trace, rounds);
    word_put_long(trace, record->graph->root.forks);
    for (size_t i = 0; i < record->n_objects; i++)
        word_put(trace, record->object[i].bound.slot);
}
