/* Which orders are run: one of each class of orders that differ in nothing but the order of steps
 * that have nothing to do with one another, by dynamic partial-order reduction with source sets and
 * sleep sets (Abdulla, Aronis, Jonsson & Sagonas, Optimal dynamic partial order reduction, POPL
 * 2014), the stores in buffers being actors of their own (Zhang, Kusano & Wang, Dynamic partial
 * order reduction for relaxed memory models, PLDI 2015). It is complete because no step of one
 * actor makes another's impossible.
 *
 * trail[0 .. depth) is the execution so far; of the first `fixed` steps the actor is given. The
 * trail outlives an execution: what is left to try hangs on it. */
#include "tests/model/search.h"

#include <stdio.h>
#include <string.h>

enum { WORDS = MACHINE_STEPS / 64 };

struct trail {
    unsigned actor; /* whose turn it is here */
    struct machine_step step;
    uint64_t ready;         /* actors, as bits: those that could have gone */
    uint64_t todo;          /* those that must be tried here */
    uint64_t asleep;        /* those that lead to nothing new: tried before */
    uint64_t before[WORDS]; /* steps, as bits: those that happened before this one */
};

static struct trail trail[MACHINE_STEPS];
static int depth, fixed;
static bool too_long, every;

static bool has(const uint64_t *set, int i)
{
    return set[i / 64] >> (i % 64) & 1;
}

static void put(uint64_t *set, int i)
{
    set[i / 64] |= (uint64_t)1 << (i % 64);
}

static bool meet(const uint64_t *a, const uint64_t *b)
{
    for (int i = 0; i < WORDS; i++)
        if (a[i] & b[i])
            return true;
    return false;
}

static uint64_t bit(unsigned actor)
{
    return (uint64_t)1 << actor;
}

static bool same_place(const struct machine_step *a, const struct machine_step *b)
{
    return a->place.address && a->place.address == b->place.address;
}

/* True if the order of an earlier step and a later one matters, or the first made the second
 * possible. */
static bool depends(int index, const struct machine_step *a, const struct machine_step *b)
{
    bool flushed = a->kind == MACHINE_FLUSH;
    if (a->actor == b->actor || b->origin == index)
        return true;
    if (a->thread != b->thread)
        return same_place(a, b) && (a->writes || b->writes);
    if (b->kind == MACHINE_FLUSH)
        return flushed && b->release && a->number < b->number;
    return flushed && (b->drained || (b->writes && same_place(a, b)));
}

/* True if two steps that are possible now may change places. */
static bool independent(const struct machine_step *a, const struct machine_step *b)
{
    bool writes = a->writes || b->writes || a->kind == MACHINE_COMPARE;
    return a->thread == b->thread || !writes || !same_place(a, b);
}

/* The step at `late` might have come before the one at `early`: makes sure that this is tried, by
 * one of the actors with which such an execution can go on from there. */
static void reverse(int early, int late)
{
    uint64_t between[WORDS] = {0}, firsts = 0;
    for (int i = early + 1; i <= late; i++) {
        if (i < late && has(trail[i].before, early))
            continue;
        if (!meet(between, trail[i].before))
            firsts |= bit(trail[i].step.actor);
        put(between, i);
    }
    struct trail *at = &trail[early];
    firsts &= at->ready;
    if (!(firsts & (at->todo | at->asleep)))
        at->todo |= firsts & -firsts;
}

/* Notes what happened before the last step; with `fresh`, looks for steps it could have overtaken.
 */
static void connect(int last, bool fresh)
{
    struct trail *now = &trail[last];
    memset(now->before, 0, sizeof now->before);
    for (int i = last - 1; i >= 0; i--) {
        if (has(now->before, i) || !depends(i, &trail[i].step, &now->step))
            continue;
        for (int j = 0; j < WORDS; j++)
            now->before[j] |= trail[i].before[j];
        put(now->before, i);
    }
    uint64_t direct[WORDS] = {0};
    for (int i = last - 1; i >= 0 && fresh; i--) {
        if (!has(now->before, i) || has(direct, i))
            continue;
        for (int j = 0; j < WORDS; j++)
            direct[j] |= trail[i].before[j];
        if (trail[i].step.thread != now->step.thread && now->step.origin != i)
            reverse(i, last);
    }
}

static uint64_t ready(void)
{
    uint64_t actors = 0;
    for (unsigned i = 0; i < machine_actors(); i++)
        if (machine_ready(i))
            actors |= bit(i);
    return actors;
}

/* A step that was tried before this one, and is independent of it, need not be tried here. */
static uint64_t still_asleep(void)
{
    uint64_t asleep = 0;
    if (depth == 0 || every)
        return 0;
    const struct trail *before = &trail[depth - 1];
    for (unsigned i = 0; i < machine_actors(); i++) {
        struct machine_step next;
        if (!(before->asleep & bit(i)))
            continue;
        machine_peek(i, &next);
        if (independent(&next, &before->step))
            asleep |= bit(i);
    }
    return asleep;
}

/* Opens the trail at `depth`; false if there is nothing new to do. */
static bool open_trail(int current)
{
    struct trail *now = &trail[depth];
    now->ready = ready();
    now->asleep = still_asleep();
    uint64_t may = now->ready & ~now->asleep;
    if (!may)
        return false;
    bool stay = current >= 0 && may & bit((unsigned)current);
    now->actor = stay ? (unsigned)current : (unsigned)__builtin_ctzll(may);
    now->todo = every ? now->ready : bit(now->actor);
    return true;
}

int search_next(int current, int *index)
{
    too_long = depth == MACHINE_STEPS;
    if (too_long || (depth >= fixed && !open_trail(current)))
        return -1;
    struct trail *now = &trail[depth];
    machine_peek(now->actor, &now->step);
    *index = depth++;
    connect(*index, depth >= fixed);
    return (int)now->actor;
}

void search_result(int index, uint64_t result)
{
    trail[index].step.result = result;
}

/* ---- All executions ---- */

/* Sets the next execution up; false if there is none. */
static bool next_execution(void)
{
    for (int i = depth - 1; i >= 0; i--) {
        trail[i].asleep |= bit(trail[i].actor);
        uint64_t left = trail[i].todo & ~trail[i].asleep & trail[i].ready;
        if (left) {
            trail[i].actor = (unsigned)__builtin_ctzll(left);
            fixed = i + 1;
            depth = 0;
            return true;
        }
    }
    return false;
}

struct search_result search_all(const struct explore_case *small, struct explore_plant plant,
                                uint64_t max)
{
    struct search_result result = {0};
    bool more = true;
    depth = fixed = 0;
    every = small->every;
    while (more && !result.wrong && (!max || result.executions < max)) {
        enum machine_end end = machine_run(small, plant);
        result.executions += end != MACHINE_CUT;
        result.cut += end == MACHINE_CUT;
        result.planted = result.planted || machine_planted();
        if (end == MACHINE_WRONG)
            result.wrong = machine_wrong();
        else if (end == MACHINE_STUCK)
            result.wrong = "threads sleep for ever";
        else if (too_long)
            result.wrong = "it does not end";
        if (depth > result.longest)
            result.longest = depth;
        if (!result.wrong)
            more = next_execution();
    }
    result.all = !more;
    return result;
}

void search_print(void)
{
    static const char *const verbs[] = {
        [MACHINE_BEGIN] = "begins",     [MACHINE_LOAD] = "reads",
        [MACHINE_AWAIT] = "waited at",  [MACHINE_FENCE] = "passes",
        [MACHINE_EXCHANGE] = "sets",    [MACHINE_ADD] = "adds to",
        [MACHINE_COMPARE] = "compares", [MACHINE_FLUSH] = "'s store arrives:"};
    for (int i = 0; i < depth; i++) {
        const struct machine_step *step = &trail[i].step;
        const char *what = step->place.what ? step->place.what : "";
        const char *function = step->place.function ? step->place.function : "";
        printf("# %3d  %*s%c%s %s", i, (int)(2 * step->thread), "", 'A' + (char)step->thread,
               step->kind == MACHINE_FLUSH ? "" : "", verbs[step->kind]);
        printf(" %s", what);
        if (step->kind == MACHINE_EXCHANGE || step->kind == MACHINE_ADD)
            printf(": %lld", (long long)step->operand);
        if (step->kind == MACHINE_COMPARE)
            printf(" with %llx: %s", (unsigned long long)step->expected,
                   step->writes ? "sets it" : "fails");
        if (step->kind == MACHINE_LOAD || step->kind == MACHINE_FLUSH)
            printf(": %llx", (unsigned long long)step->result);
        printf("%s%s\n", *function ? "   in " : "", function);
    }
}
