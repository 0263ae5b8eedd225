/* Recognised rounds (memo_round.h). A round is compiled as a recorded graph of its own, with two
 * differences. All objects that it writes count as read before, since its last round may end after
 * any fork and leave the others unchanged. Arguments lie in a ring of rounds, since the main
 * program runs ahead. */
#include "runtime/plan/memo_round.h"

#include "runtime/base/memory.h"
#include "runtime/data/object.h"
#include "runtime/task/fork.h"
#include "runtime/task/internal.h"

/* Bytes of a ring; rounds in it, at least and at most. */
enum { RING_BYTES = 1 << 20, RING_LEAST = 4, RING_MOST = 1 << 16 };

struct plan_memo_round *memo_round_find(struct plan_memo *memo, uint64_t key, size_t n)
{
    for (size_t i = 0; i < MEMO_PLANS; i++) {
        struct plan_memo_round *round = &memo->rounds_kept[i];
        if (round->record && round->key == key && round->n == n)
            return round;
    }
    return NULL;
}

bool memo_round_is_idle(const struct plan_memo_round *round)
{
    return plan_is_over(round->record->plan);
}

void memo_round_free(struct plan_memo_round *round, struct worker *worker)
{
    struct plan_gate *gate = round->gate;
    if (round->record)
        plan_record_free(round->record, worker);
    base_free(round->first);
    base_free(round->hash);
    memset(round, 0, sizeof *round);
    round->gate = gate;
}

/* ---- Recording ---- */

/* Writes order the runs of a task, as forks would. A task without writes would wait for itself in a
 * plan, and for nothing without. */
static bool round_writes(const duite_kernel *kernel, size_t n)
{
    bool writes = false;
    for (size_t i = 0; i < n; i++)
        writes |= kernel->access[i] != DUITE_R;
    return writes;
}

bool memo_round_add(struct plan_memo *memo, const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects)
{
    struct task_graph *graph = memo->graph;
    const struct task_fixed *fixed = task_kernel_find(graph, kernel);
    if (!fixed || !fixed->plain || n != fixed->n || (n && !objects) || !round_writes(kernel, n))
        return false;
    for (size_t i = 0; i < n; i++) {
        const struct data_object *object = data_object_here(&graph->table, objects[i]);
        if (!object || object->leaves || object->sized || !object->current)
            return false;
    }
    return !plan_record_fork(memo->record, &(struct task_options){.at = TASK_ANYWHERE}, kernel,
                             args, n, objects);
}

/* ---- Compiling ---- */

static bool round_fill_steps(struct plan_memo_round *round)
{
    const struct plan_record *record = round->record;
    const size_t head = sizeof *round->first, name = sizeof round->first->object[0];
    unsigned char *at = base_alloc(record->n_forks * head + record->n_accesses * name + 1);
    round->first = (void *)at;
    for (size_t i = 0; at && i < record->n_forks; i++) {
        const struct plan_recorded_fork *fork = &record->fork[i];
        struct plan_memo_step *step = (void *)at;
        const duite_kernel *kernel = record->graph->kernels[fork->kernel];
        at += head + fork->n * name;
        *step = (struct plan_memo_step){
            .kernel = kernel, .n = fork->n, .bytes = kernel->args_size, .args = fork->args};
        step->next = i + 1 < record->n_forks ? (void *)at : round->first;
        for (uint32_t k = 0; k < fork->n; k++)
            step->object[k] = record->object[record->access[fork->first + k].object].bound;
    }
    return at != NULL;
}

static bool round_make_ring(struct plan *plan, const struct plan_record *record)
{
    size_t rounds = RING_LEAST;
    if (!record->args_bytes)
        return true;
    while (rounds < RING_MOST && 2 * rounds * record->args_bytes <= RING_BYTES)
        rounds *= 2;
    return plan_ring(plan, rounds, record->args_bytes);
}

/* Forked tasks have no paths, so these tasks get none. */
static void round_forget_paths(struct plan *plan)
{
    for (size_t i = 0; i < plan->n_nodes; i++)
        plan_task(plan, i)->path = 0;
}

static bool round_compile(const struct plan_memo_round *round)
{
    struct plan_record *record = round->record;
    if (plan_new(&record->plan, record, NULL) || record->plan->n_nodes != record->n_calls)
        return false;
    round_forget_paths(record->plan);
    return round_make_ring(record->plan, record);
}

/* The least recently used round that is not in use. */
static struct plan_memo_round *round_place(struct plan_memo *memo)
{
    struct plan_memo_round *place = NULL;
    for (size_t i = 0; i < MEMO_PLANS; i++) {
        struct plan_memo_round *round = &memo->rounds_kept[i];
        if (!round->record)
            return round;
        if (memo_round_is_idle(round) && (!place || round->used < place->used))
            place = round;
    }
    return place;
}

/* Fills the round except its plan. */
static bool round_fill(struct plan_memo_round *round, const struct plan_memo *memo)
{
    struct plan_record *record = round->record;
    plan_record_end(record);
    for (size_t i = 0; i < record->n_objects; i++)
        record->object[i].reads_old = true;
    round->hash = base_alloc(round->n * sizeof *round->hash);
    for (size_t i = 0; round->hash && i < round->n; i++)
        round->hash[i] = memo->hash[(memo->pos - round->n + i) % MEMO_HISTORY];
    if (!round->gate)
        round->gate = base_alloc_zero(sizeof *round->gate);
    return !record->forked && !record->trails && RING_LEAST * record->args_bytes <= RING_BYTES &&
           round->hash && round->gate && round_fill_steps(round);
}

struct plan_memo_round *memo_round_make(struct plan_memo *memo, uint64_t key)
{
    struct plan_memo_round *round = round_place(memo);
    if (!round)
        return NULL;
    memo_round_free(round, memo->worker);
    round->record = memo->record;
    memo->record = NULL;
    round->key = key;
    round->n = round->record->n_calls;
    round->used = ++memo->openings;
    if (round_fill(round, memo) && round_compile(round))
        return round;
    memo_round_free(round, memo->worker);
    return NULL;
}

/* ---- Replays ---- */

bool memo_round_open(struct plan_memo *memo, struct plan_memo_round *round)
{
    if (!plan_record_fits(round->record)) { /* an object was freed; its slot may be another's now */
        memo_round_free(round, memo->worker);
        return false;
    }
    struct plan *plan = round->record->plan;
    memo->first = memo->graph->root.forks + 1;
    if (plan_replay_open(round->record, memo->worker, round->gate))
        return false;
    round->used = ++memo->openings;
    memo->plan = plan;
    memo->args = plan->args;
    memo->at = 0;
    memo->round = 0;
    memo->room = plan->stride ? plan->ring_mask + 1 : 0;
    memo->step = round->first;
    return true;
}
