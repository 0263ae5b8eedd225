/* The watch over forks (memo.h). The history has all hashes since `begin`, up to its length, with
 * no other call between them. A hash only raises a suspicion: the forks themselves are recorded,
 * and a replay takes a fork only if it is the expected one. So a wrong guess costs only time.
 * Comparisons of hashes are counted: a program that only almost repeats itself is left alone for
 * ever longer times. */
#include "runtime/plan/memo_round.h"

#include "runtime/base/memory.h"
#include "runtime/task/fork.h"

/* Forks that must repeat earlier ones; forks skipped after the first failure, and at most;
 * comparisons granted; bodies per mean. */
enum {
    MEMO_REPEATED = 64,
    MEMO_PENALTY = 256,
    MEMO_LARGEST_PENALTY = 1 << 20,
    MEMO_GRANTED = 16384,
    MEMO_BODIES = 32
};

/* With longer bodies forks do not matter, and calls outside a replay would wait for it. */
#define MEMO_LONG_SECONDS 10e-6

static uint32_t memo_hash_at(const struct plan_memo *memo, uint64_t pos)
{
    return memo->hash[pos % MEMO_HISTORY];
}

/* ---- States ---- */

static void memo_watch(struct plan_memo *memo)
{
    if (memo->record)
        plan_record_free(memo->record, memo->worker);
    memo->record = NULL;
    memo->state = MEMO_WATCH;
    memo->begin = memo->due = memo->since = memo->pos;
    memo->n_anchors = 0;
    memo->spent = 0;
}

/* It did not pay: ignores forks for a time. */
static void memo_punish(struct plan_memo *memo)
{
    memo_watch(memo);
    memo->skip = memo->penalty;
    if (memo->penalty < MEMO_LARGEST_PENALTY)
        memo->penalty *= 2;
}

static void memo_enter(struct plan_memo *memo, enum plan_memo_state state)
{
    memo->state = state;
    memo->since = memo->pos;
    memo->due = 0;
}

static void memo_close(struct plan_memo *memo)
{
    const uint64_t tasks = memo->round * memo->plan->n_calls + memo->at;
    plan_replay_close(memo->plan, memo->worker, memo->first);
    memo->step = NULL;
    memo->tasks += tasks;
    memo->rounds += memo->round;
    if (memo->round < 4 || tasks < MEMO_REPEATED) {
        memo_punish(memo);
        return;
    }
    memo->penalty = MEMO_PENALTY;
    memo_watch(memo);
}

/* Closes an open replay, and begins the history again. */
void plan_memo_break(struct plan_memo *memo)
{
    if (memo->step)
        memo_close(memo);
    else
        memo_watch(memo);
}

/* A round was forked: makes room for the arguments of the next one, or closes the replay. */
__attribute__((noinline)) static void memo_next_round(struct plan_memo *memo)
{
    struct plan *plan = memo->plan;
    memo->at = 0;
    memo->round++;
    if (!plan->stride)
        return;
    if (memo->round == memo->room)
        memo->room = plan_rounds_over(plan) + plan->ring_mask + 1;
    if (memo->round == memo->room)
        memo_close(memo);
    else
        memo->args = plan->args + (memo->round & plan->ring_mask) * plan->stride;
}

/* The expected fork becomes the next run of its node. */
static inline void memo_take(struct plan_memo *memo, const struct plan_memo_step *step,
                             const void *args)
{
    const uint32_t at = memo->at;
    if (step->bytes)
        memcpy(memo->args + step->args, args, step->bytes);
    plan_forked(memo->plan, memo->worker, at);
    memo->step = step->next;
    memo->at = at + 1;
    if (memo->at == memo->plan->n_calls)
        memo_next_round(memo);
}

/* ---- Periods ---- */

/* Returns whether each of the last `wanted` forks equals the one `period` forks before it. */
static bool memo_repeats(struct plan_memo *memo, uint64_t period)
{
    const uint64_t wanted = 2 * period > MEMO_REPEATED ? 2 * period : MEMO_REPEATED;
    if (memo->pos - memo->begin < wanted)
        return false;
    for (uint64_t i = 1; i <= wanted - period; i++) {
        memo->spent++;
        if (memo_hash_at(memo, memo->pos - i) != memo_hash_at(memo, memo->pos - i - period))
            return false;
    }
    return true;
}

/* A round's key, the same for any first fork. */
static uint64_t memo_key(const struct plan_memo *memo, uint64_t period)
{
    uint64_t sum = 0;
    for (uint64_t i = 1; i <= period; i++)
        sum += memo_hash_at(memo, memo->pos - i) * UINT64_C(0x9e3779b97f4a7c15);
    return sum;
}

/* Returns whether recent bodies are so short that a replay pays. */
static bool memo_pays(struct plan_memo *memo)
{
    uint64_t bodies;
    double seconds;
    queue_bodies(memo->graph->pool, &bodies, &seconds);
    if (bodies - memo->bodies >= MEMO_BODIES) {
        memo->mean = (seconds - memo->seconds) / (double)(bodies - memo->bodies);
        memo->bodies = bodies;
        memo->seconds = seconds;
    }
    return memo->always || (memo->bodies && memo->mean < MEMO_LONG_SECONDS);
}

static void memo_later(struct plan_memo *memo)
{
    memo_watch(memo);
    memo->skip = MEMO_PENALTY;
}

static void memo_begin(struct plan_memo *memo, uint64_t period)
{
    memo->period = (size_t)period;
    memo->found = memo_round_find(memo, memo_key(memo, period), memo->period);
    if (!memo_pays(memo)) {
        memo_later(memo);
        return;
    }
    if (memo->found) {
        if (memo_round_is_idle(memo->found))
            memo_enter(memo, MEMO_SEEK);
        else
            memo_later(memo); /* the main program is too far ahead of its last replay */
        return;
    }
    memo_enter(memo, MEMO_RECORD);
    memo->record = plan_record_new(memo->graph);
    if (!memo->record)
        memo_punish(memo);
}

static void memo_anchor(struct plan_memo *memo, uint32_t hash)
{
    const uint64_t here = memo->pos - 1;
    for (uint32_t i = 0; i < memo->n_anchors && hash == memo->anchor; i++) {
        const uint64_t period = here - memo->anchored[i];
        if (period > PLAN_OPEN_MAX || !memo_repeats(memo, period))
            continue;
        memo_begin(memo, period);
        return;
    }
    if (hash != memo->anchor || !memo->n_anchors || memo->pos > memo->due) {
        memo->anchor = hash;
        memo->n_anchors = 0;
        memo->due = memo->pos + 3 * PLAN_OPEN_MAX;
    }
    memmove(memo->anchored + 1, memo->anchored, (MEMO_ANCHORS - 1) * sizeof memo->anchored[0]);
    memo->anchored[0] = here;
    memo->n_anchors += memo->n_anchors < MEMO_ANCHORS;
    if (memo->spent > 2 * (memo->pos - memo->begin) + MEMO_GRANTED)
        memo_punish(memo);
}

/* ---- Record, seek ---- */

static bool memo_record(struct plan_memo *memo, uint32_t hash, const duite_kernel *kernel,
                        const void *args, size_t n, const duite_object *objects)
{
    if (hash != memo_hash_at(memo, memo->pos - 1 - memo->period) ||
        !memo_round_add(memo, kernel, args, n, objects)) {
        memo_punish(memo);
        return false;
    }
    if (memo->record->n_calls < memo->period)
        return false;
    memo->found = memo_round_make(memo, memo_key(memo, memo->period));
    if (memo->found)
        memo_enter(memo, MEMO_SEEK);
    else
        memo_punish(memo);
    return false;
}

/* Returns whether the fork is the round's first, and the last forks were the round's. */
static bool seek_finds(const struct plan_memo *memo, const duite_kernel *kernel, const void *args,
                       size_t n, const duite_object *objects)
{
    const struct plan_memo_round *round = memo->found;
    if (!memo_is_step(round->first, kernel, args, n, objects))
        return false;
    for (size_t i = 0; i < round->n; i++)
        if (round->hash[i] != memo_hash_at(memo, memo->pos - 1 - round->n + i))
            return false;
    return true;
}

static bool memo_seek(struct plan_memo *memo, const duite_kernel *kernel, const void *args,
                      size_t n, const duite_object *objects)
{
    const bool found = seek_finds(memo, kernel, args, n, objects);
    if (found && memo_round_open(memo, memo->found)) {
        memo_take(memo, memo->step, args);
        return true;
    }
    if (found || memo->pos - memo->since > 2 * memo->period)
        memo_punish(memo);
    return false;
}

/* A fork that may end a period or is to be recorded. True: it is made. */
static bool memo_look(struct plan_memo *memo, uint32_t hash, const duite_kernel *kernel,
                      const void *args, size_t n, const duite_object *objects)
{
    switch (memo->state) {
    case MEMO_RECORD:
        return memo_record(memo, hash, kernel, args, n, objects);
    case MEMO_SEEK:
        return memo_seek(memo, kernel, args, n, objects);
    default:
        memo_anchor(memo, hash);
        return false;
    }
}

/* ---- Every fork ---- */

static inline uint32_t memo_hash(const struct plan_memo *memo, const duite_kernel *kernel, size_t n,
                                 const duite_object *objects)
{
    const bool hashed = n <= MEMO_HASHED && (objects || !n);
    return (uint32_t)((hashed ? task_fork_hash_all((uintptr_t)kernel, n, objects)
                              : task_fork_hash(memo->pos)) >>
                      32);
}

/* A fork that is not the expected one. True: it is made. Not inline: the usual way of a replay
 * needs few registers. */
__attribute__((noinline)) static bool memo_other_fork(struct plan_memo *memo,
                                                      const duite_kernel *kernel, const void *args,
                                                      size_t n, const duite_object *objects)
{
    if (memo->step)
        plan_memo_break(memo);
    if (memo->skip) {
        memo->skip--;
        return false;
    }
    const uint32_t hash = memo_hash(memo, kernel, n, objects);
    memo->hash[memo->pos++ % MEMO_HISTORY] = hash;
    if (hash != memo->anchor && memo->pos <= memo->due)
        return false;
    return memo_look(memo, hash, kernel, args, n, objects);
}

bool plan_memo_fork(struct plan_memo *memo, const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects)
{
    const struct plan_memo_step *step = memo->step;
    if (!step || !memo_is_step(step, kernel, args, n, objects))
        return memo_other_fork(memo, kernel, args, n, objects);
    memo_take(memo, step, args);
    return true;
}

/* ---- Start and stop ---- */

void plan_memo_stop(struct plan_memo *memo)
{
    for (size_t i = 0; i < MEMO_PLANS && memo; i++) {
        memo_round_free(&memo->rounds_kept[i], NULL);
        base_free(memo->rounds_kept[i].gate);
    }
    if (memo && memo->record)
        plan_record_free(memo->record, NULL);
    base_free(memo);
}

struct plan_memo *plan_memo_new(struct task_graph *graph, struct worker *worker, bool always)
{
    struct plan_memo *memo = base_alloc_zero(sizeof *memo);
    if (!memo)
        return NULL;
    memo->graph = graph;
    memo->worker = worker;
    memo->always = always;
    memo->penalty = MEMO_PENALTY;
    return memo;
}

void plan_memo_count(const struct plan_memo *memo, duite_counters *counters)
{
    counters->recognised += memo->tasks;
    counters->recognised_rounds += memo->rounds;
}
