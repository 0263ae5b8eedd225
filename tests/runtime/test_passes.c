/* The passes of the compiler of recorded graphs on random rounds. Values are numbers that tell what
 * they were made of. A reference runs the forks one after the other; the parts that the passes
 * leave for all ranks run against each other, rounds overlapping, in random order. Every task must
 * find what it finds in the reference, whatever the order. */
#include "runtime/base/rank_set.h"
#include "runtime/task/owner.h"
#include "tests/runtime/rounds_run.h"
#include "tests/support/unit.h"

#include <duite_policy.h>

#include <check.h>
#include <stdlib.h>

enum { OBJECTS = 8, FORKS = 14, FEW_RANKS = 5, GARBAGE = 0xbad };

/* ---- Random rounds ---- */

struct rounds_made {
    struct plan_source source;
    struct plan_source_fork fork[ROUNDS_MAX];
    struct plan_access access[ROUNDS_ACCESSES];
    size_t bytes[ROUNDS_MAX];
};

static void made_begin(struct rounds_made *made, size_t objects, uint64_t *random)
{
    *made = (struct rounds_made){.source = {.flag = PLAN_NONE,
                                            .n_objects = objects,
                                            .fork = made->fork,
                                            .access = made->access,
                                            .bytes = made->bytes}};
    for (size_t i = 0; i < objects; i++)
        made->bytes[i] = draw(random, 2) ? 8 : 4096;
}

/* A fork without accesses, which then come one by one; made_own says what it runs for. */
static struct plan_source_fork *made_fork(struct rounds_made *made)
{
    ck_assert_uint_lt(made->source.n_forks, ROUNDS_MAX);
    struct plan_source_fork *fork = made->fork + made->source.n_forks++;
    *fork = (struct plan_source_fork){
        .first = made->source.n_accesses, .owner = PLAN_NONE, .rank = PLAN_BY_OWNER};
    return fork;
}

static void made_access(struct rounds_made *made, uint32_t object, duite_mode mode, int law)
{
    static const duite_law laws[2];
    ck_assert_uint_lt(made->source.n_accesses, ROUNDS_ACCESSES);
    made->fork[made->source.n_forks - 1].n++;
    made->access[made->source.n_accesses++] =
        (struct plan_access){object, mode, mode == DUITE_CW ? laws + law : NULL};
}

static void made_own(struct rounds_made *made)
{
    struct plan_source_fork *fork = &made->fork[made->source.n_forks - 1];
    uint8_t mode[DUITE_MAX_ACCESS] = {DUITE_NONE};
    ck_assert_uint_lt(fork->n, DUITE_MAX_ACCESS);
    for (uint32_t k = 0; k < fork->n; k++)
        mode[k] = (uint8_t)made->access[fork->first + k].mode;
    const uint32_t own = task_owner(mode, DUITE_NONE, fork->n);
    fork->owner = own == TASK_NOBODY ? PLAN_NONE : made->access[fork->first + own].object;
}

static void random_access(struct rounds_made *made, uint64_t *random, uint32_t object)
{
    static const duite_mode modes[] = {DUITE_R, DUITE_R, DUITE_W, DUITE_RW, DUITE_CW, DUITE_CW};
    const struct plan_source_fork *fork = &made->fork[made->source.n_forks - 1];
    duite_mode mode = modes[draw(random, 6)];
    if (mode == DUITE_CW && fork->replicated)
        mode = DUITE_R;
    made_access(made, object, fork->sets ? DUITE_W : mode, draw(random, 8) == 0);
}

static void random_fork(struct rounds_made *made, uint64_t *random, int n_ranks)
{
    uint32_t n = 1 + (uint32_t)draw(random, 3), first = (uint32_t)draw(random, 1000);
    struct plan_source_fork *fork = made_fork(made);
    uint64_t kind = draw(random, 8);
    uint32_t objects = (uint32_t)made->source.n_objects;
    fork->sets = kind == 0;
    fork->replicated = kind == 1 || kind == 2;
    if (kind == 3)
        fork->rank = (int)draw(random, (uint64_t)n_ranks);
    for (uint32_t k = 0; k < (fork->sets ? 1 : n) && k < objects; k++)
        random_access(made, random, (first + k) % objects);
    made_own(made);
}

static void random_round(struct rounds_made *made, uint64_t *random, int n_ranks)
{
    const size_t objects = 2 + draw(random, OBJECTS - 1), forks = 1 + draw(random, FORKS);
    made_begin(made, objects, random);
    for (size_t i = 0; i < forks; i++)
        random_fork(made, random, n_ranks);
    if (draw(random, 3) == 0)
        made->source.flag = (uint32_t)draw(random, objects);
}

/* Sums of many ranks: contributions in random order, then tasks on some ranks that read the sum. A
 * large one is made at one rank, from which its value goes to the others. */
static void wide_sum(struct rounds_made *made, uint64_t *random, uint32_t sum)
{
    const uint64_t leaves = 1 + draw(random, 18), readers = 1 + draw(random, 12);
    const uint32_t objects = (uint32_t)made->source.n_objects;
    for (uint64_t i = 0; i < leaves + readers; i++) {
        const uint32_t other = 2 + (uint32_t)draw(random, objects - 2);
        const bool reads = i >= leaves;
        made_fork(made);
        made_access(made, reads ? sum : other, DUITE_R, 0);
        made_access(made, reads ? other : sum, reads ? DUITE_RW : DUITE_CW, 0);
        made_own(made);
    }
}

static void wide_round(struct rounds_made *made, uint64_t *random)
{
    made_begin(made, 6 + draw(random, 15), random);
    const uint64_t sums = 1 + draw(random, 2);
    for (uint64_t i = 0; i < sums; i++)
        wide_sum(made, random, (uint32_t)draw(random, 2));
}

/* ---- What passes promise of their output alone ---- */

static bool same_edge(const struct plan_round_edge *a, const struct plan_round_edge *b)
{
    return a->from == b->from && a->to == b->to && a->cyclic == b->cyclic;
}

static bool in_conflict(const struct plan_round *round, size_t a, size_t b)
{
    const struct plan_round_node *first = &round->node[a], *second = &round->node[b];
    for (size_t i = first->first_use; i < first->first_use + first->n_uses; i++)
        for (size_t k = second->first_use; k < second->first_use + second->n_uses; k++)
            if (round->use[i].place == round->use[k].place &&
                (round->use[i].writes || round->use[k].writes))
                return true;
    return false;
}

/* Two nodes that use a place, which one of them writes, are in order. No edge passes by a barrier,
 * a node that runs after all before it. after[a * n + b]: b runs after a. */
static void check_order(const struct plan_round *round, const bool *after)
{
    const size_t n = round->n_nodes;
    for (size_t a = 0; a < n; a++)
        for (size_t b = a + 1; b < n; b++)
            ck_assert(after[a * n + b] || !in_conflict(round, a, b));
    for (size_t barrier = 0; barrier < n; barrier++) {
        size_t before = 0;
        for (size_t a = 0; a < barrier; a++)
            before += after[a * n + barrier];
        for (size_t i = 0; i < round->n_edges && before == barrier; i++) {
            const struct plan_round_edge *edge = &round->edge[i];
            ck_assert(edge->cyclic || edge->from >= barrier || edge->to <= barrier ||
                      !after[barrier * n + edge->to]);
        }
    }
}

/* Edges within a round lead to later nodes, in order, each once; one that goes to the next round
 * goes back to a node that `from` waited for, or to itself. */
static void check_edges(const struct plan_round *round)
{
    size_t n = round->n_nodes;
    bool *after = calloc(n * n + 1, sizeof *after); /* [a * n + b]: b runs after a */
    uint32_t last = 0;
    for (size_t i = 0; i < n; i++)
        after[i * n + i] = true;
    for (size_t i = 0; i < round->n_edges; i++) {
        const struct plan_round_edge *edge = &round->edge[i];
        for (size_t k = 0; k < i; k++)
            ck_assert(!same_edge(edge, &round->edge[k]));
        if (edge->cyclic)
            continue;
        ck_assert_uint_lt(edge->from, edge->to);
        ck_assert_uint_ge(edge->to, last);
        last = edge->to;
        for (size_t a = 0; a < n; a++)
            after[a * n + edge->to] |= after[a * n + edge->from];
    }
    check_order(round, after);
    for (size_t i = 0; i < round->n_edges; i++)
        if (round->edge[i].cyclic)
            ck_assert(after[round->edge[i].to * n + round->edge[i].from]);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            if (after[a * n + b] && round->node[a].kind == PLAN_RECEIVE &&
                round->node[b].kind == PLAN_SEND)
                ck_assert_uint_lt(round->node[a].phase, round->node[b].phase);
    free(after);
}

/* The ranks that run a node need what it reads; a node of one rank runs there alone. */
static void check_assignment(const struct plan_assignment *a)
{
    for (size_t n = 0; n < a->round->n_nodes; n++) {
        const struct plan_round_node *node = &a->round->node[n];
        for (int rank = 0; rank < a->n_ranks; rank++) {
            if (a->at[n] != PLAN_MANY)
                ck_assert_int_eq(plan_runs(a, n, rank), a->at[n] == rank);
            for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
                if (a->reads[i] != PLAN_NONE && plan_runs(a, n, rank))
                    ck_assert(base_ranks_has(plan_needs_set(a, a->reads[i]), rank));
        }
        if (node->kind == PLAN_TASK)
            ck_assert(!plan_is_dead(a, n));
    }
}

/* On more ranks, where sets take several words, the first ones run and need the same. The others
 * are all alike, and have nothing but what a flag needs. */
static void check_more_ranks(const struct plan_assignment *a, const int *home)
{
    enum { MORE = 150 };
    UNIT_OWNED(plan_assignment_free) struct plan_assignment more;
    const bool flagged = a->round->source->flag != PLAN_NONE;
    ck_assert(plan_assign(&more, a->round, home, a->n_ranks + MORE));
    for (int rank = 0; rank < more.n_ranks; rank++) {
        const struct plan_assignment *like = rank < a->n_ranks ? a : &more;
        const int as = rank < a->n_ranks ? rank : a->n_ranks;
        const bool some = rank < a->n_ranks || flagged;
        for (size_t n = 0; n < a->round->n_nodes; n++)
            ck_assert_int_eq(plan_runs(&more, n, rank), some && plan_runs(like, n, as));
        for (size_t v = 0; v < a->n_versions; v++)
            ck_assert_int_eq(base_ranks_has(plan_needs_set(&more, v), rank),
                             some && base_ranks_has(plan_needs_set(like, v), as));
    }
}

/* One message at most from a rank to another in a phase, and items in order. */
static void check_messages(const struct plan_messages *m)
{
    size_t items = 0;
    for (size_t i = 0; i < m->n_messages; i++) {
        const struct plan_message *message = &m->message[i];
        ck_assert_int_ne(message->from, message->to);
        for (size_t k = 0; k < i; k++)
            ck_assert(m->message[k].from != message->from || m->message[k].to != message->to ||
                      m->message[k].phase != message->phase);
        for (size_t k = message->first; k; k = m->item[k - 1].next, items++)
            ck_assert_uint_le(m->item[k - 1].made, message->ready);
    }
    ck_assert_uint_eq(items, m->n_items);
    for (size_t i = 1; i < m->n_items; i++)
        ck_assert_uint_ge(m->item[i].made, m->item[i - 1].made);
}

/* Values of up to four ranks, or of half of them, go directly. */
UNIT_TEST(values_of_many_go_from_rank_to_rank)
{
    static const struct {
        int n_ranks, readers;
        uint32_t rounds;
    } all[] = {{4, 3, 0}, {5, 3, 0}, {5, 4, 3}, {8, 4, 3}, {16, 7, 0}, {16, 8, 4}, {64, 31, 0}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        uint64_t set[2] = {0};
        int ring[64];
        size_t n = 0;
        for (int rank = 1; rank <= all[i].readers; rank++)
            base_ranks_add(set, rank);
        ck_assert_uint_eq(plan_relay_ring(set, all[i].n_ranks, 0, ring, &n), all[i].rounds);
        ck_assert_uint_eq(n, all[i].rounds ? (size_t)all[i].readers + 1 : 0);
    }
}

/* ---- One random round ---- */

/* The number of tasks that a round runs on all ranks. */
static size_t tasks_of(const struct plan_assignment *a)
{
    size_t tasks = 0;
    for (size_t n = 0; n < a->round->n_nodes; n++)
        for (int rank = 0; rank < a->n_ranks; rank++)
            tasks += (a->round->node[n].kind == PLAN_TASK || a->round->node[n].kind == PLAN_SET) &&
                     plan_runs(a, n, rank);
    return tasks;
}

static void run_parts(struct run *run, const struct plan_round *round, const int *home)
{
    UNIT_OWNED(plan_assignment_free) struct plan_assignment a;
    struct plan_messages all, own;
    ck_assert(plan_assign(&a, round, home, run->n_ranks));
    ck_assert(plan_messages_find(&all, &a, PLAN_ALL));
    check_assignment(&a);
    if (!(run->random % 32))
        check_more_ranks(&a, home);
    check_messages(&all);
    size_t items = 0, expected = ROUNDS * tasks_of(&a);
    for (int r = 0; r < run->n_ranks; r++) {
        struct rank *rank = &run->rank[r];
        ck_assert(plan_messages_find(&own, &a, r) && plan_part(&rank->part, &own));
        ck_assert(plan_edges(&rank->part));
        check_messages(&own);
        check_edges(&rank->part);
        items += own.n_items;
        for (size_t i = 0; i < PLACES; i++)
            rank->value[i] = GARBAGE;
        for (uint32_t i = 0; i < round->n_objects; i++)
            if (plan_is_there(&a, i, r))
                rank->value[i] = initial(i);
        plan_messages_free(&own);
    }
    ck_assert_uint_eq(items, 2 * all.n_items);
    run_all(run, ROUNDS);
    ck_assert_uint_eq(run->tasks, expected);
    for (int r = 0; r < run->n_ranks; r++) {
        for (uint32_t i = 0; i < round->n_objects; i++)
            if (plan_is_there(&a, i, r))
                ck_assert_uint_eq(run->rank[r].value[i], run->reference->value[i]);
        plan_round_free(&run->rank[r].part);
    }
    plan_messages_free(&all);
}

/* One rank: the round is run as it was lowered. */
static void run_whole(struct run *run, const struct plan_source *source)
{
    struct rank *rank = &run->rank[0];
    run->n_ranks = 1;
    rank->part = (struct plan_round){0};
    ck_assert(plan_lower(&rank->part, source) && plan_edges(&rank->part));
    check_edges(&rank->part);
    for (uint32_t i = 0; i < source->n_objects; i++)
        rank->value[i] = initial(i);
    run_all(run, ROUNDS);
    ck_assert_uint_eq(run->tasks, ROUNDS * source->n_forks);
    plan_round_free(&rank->part);
}

static void queues_begin(struct run *run)
{
    for (int from = 0; from < MAX_RANKS; from++)
        for (int to = 0; to < MAX_RANKS; to++)
            for (size_t phase = 0; phase < PHASES; phase++)
                run->queue[from][to][phase].first = run->queue[from][to][phase].last =
                    run->queue[from][to][phase].messages = 0;
}

static void random_passes(struct run *run, uint64_t seed, bool wide)
{
    struct rounds_made made;
    UNIT_OWNED(plan_round_free) struct plan_round round = {0};
    static struct reference reference;
    uint64_t random = seed;
    int n_ranks = 1 + (int)draw(&random, wide ? MAX_RANKS : FEW_RANKS), home[ROUNDS_MAX];
    if (wide)
        wide_round(&made, &random);
    else
        random_round(&made, &random, n_ranks);
    for (size_t i = 0; i < made.source.n_objects; i++)
        home[i] = (int)draw(&random, (uint64_t)n_ranks);
    reference_run(&reference, &made.source);
    run->reference = &reference;
    run->random = random;
    run->tasks = 0;
    queues_begin(run);
    run_whole(run, &made.source);
    run->tasks = 0;
    run->n_ranks = n_ranks;
    for (int r = 0; r < n_ranks; r++)
        run->rank[r].part = (struct plan_round){0};
    ck_assert(plan_lower(&round, &made.source));
    run_parts(run, &round, home);
}

UNIT_TEST(random_rounds)
{
    struct run *run = calloc(1, sizeof *run);
    ck_assert_ptr_nonnull(run);
    for (int from = 0; from < MAX_RANKS; from++)
        for (int to = 0; to < MAX_RANKS; to++) {
            run->queue[from][to] = calloc(PHASES, sizeof *run->queue[from][to]);
            ck_assert_ptr_nonnull(run->queue[from][to]);
        }
    for (uint64_t seed = 1; seed <= (unit_quick() ? 300 : 3000); seed++)
        random_passes(run, seed, false);
    for (uint64_t seed = 1; seed <= (unit_quick() ? 100 : 1000); seed++)
        random_passes(run, seed, true);
    for (int from = 0; from < MAX_RANKS; from++)
        for (int to = 0; to < MAX_RANKS; to++)
            free(run->queue[from][to]);
    free(run);
}
