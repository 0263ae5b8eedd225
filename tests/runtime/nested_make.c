/* Makes a tree of tasks. Every task keeps to the rights it holds and names no object after it freed
 * it; nothing else is excluded. */

#include "tests/runtime/nested_program.h"

#include <stdio.h>
#include <string.h>

enum { MAX_DEPTH = 6 };

struct table {
    unsigned n;
    duite_mode right[NEST_MAX_OBJECTS]; /* DUITE_NONE: freed */
    bool made[NEST_MAX_OBJECTS], written[NEST_MAX_OBJECTS];
    bool sized[NEST_MAX_OBJECTS];
    duite_type type[NEST_MAX_OBJECTS];
    size_t max[NEST_MAX_OBJECTS];
};

struct maker {
    struct nest_program *program;
    uint64_t random;
    unsigned fails; /* one task in so many; 0: none */
    bool plain;     /* the next fork postpones nothing: graphs of such tasks have a plan */
    bool waits;     /* the next fork is of a task that begins with a get of what it was lent */
    bool repeated;  /* it writes, too, and contributes nothing: rounds of such are recognised */
};

static unsigned draw(struct maker *maker, unsigned below)
{
    return (unsigned)(duite_random(&maker->random) % below);
}

/* The modes that a right gives, written down from the contract: a bit each. */
static unsigned allowed(duite_mode right)
{
    switch (right) {
    case DUITE_R:
    case DUITE_RP:
        return 1u << DUITE_R | 1u << DUITE_RP;
    case DUITE_WP:
        return 1u << DUITE_W | 1u << DUITE_WP;
    case DUITE_CWP:
        return 1u << DUITE_CW | 1u << DUITE_CWP;
    case DUITE_RWP:
        return 0x1feu;
    default:
        return 0;
    }
}

static duite_mode draw_mode(struct maker *maker, duite_mode right, bool sized, unsigned depth)
{
    const unsigned sums = 1u << DUITE_CW | 1u << DUITE_CWP;
    const unsigned modes = allowed(right) & ~(sized ? sums : 0);

    for (;;) {
        const duite_mode mode = (duite_mode)(1 + draw(maker, 8));

        if (maker->repeated && (mode == DUITE_CW || mode >= DUITE_RP))
            continue;
        /* Contributions are the most likely to go wrong: half of all. */
        if (right == DUITE_RWP && !sized && !maker->repeated && draw(maker, 4) == 0)
            return draw(maker, 2) && depth < MAX_DEPTH && !maker->plain ? DUITE_CWP : DUITE_CW;
        if (modes >> mode & 1 && !(mode >= DUITE_RP && (depth >= MAX_DEPTH || maker->plain)))
            return mode;
    }
}

static void make_task(struct maker *maker, unsigned task, const struct table *given,
                      unsigned depth);

static struct nest_action *add(struct nest_task *task, enum nest_kind kind)
{
    struct nest_action *action = &task->action[task->n_actions++];

    *action = (struct nest_action){.kind = kind};
    return action;
}

/* Forks a task on `forced` under w or wp, or else (forced < 0) on anything. */
static void make_fork(struct maker *maker, unsigned self, struct table *table, int forced,
                      unsigned depth)
{
    struct nest_program *program = maker->program;
    const unsigned child = program->n_tasks++;
    struct nest_action *action = add(&program->task[self], NEST_FORK);
    struct nest_task *task = &program->task[child];
    struct table given = {0};
    const unsigned want =
        forced >= 0 || maker->waits
            ? 1
            : maker->repeated + draw(maker, NEST_MAX_PARAMS + 1 - maker->repeated);

    memset(task, 0, sizeof *task);
    action->task = child;
    action->priority = (int32_t)draw(maker, 5) - 2;
    task->law = draw(maker, 2) ? program->task[self].law : draw(maker, NEST_LAWS);
    for (unsigned tries = 0; given.n < want && tries < 12; tries++) {
        const unsigned object = forced >= 0 ? (unsigned)forced : draw(maker, table->n);
        bool twice = false;

        for (unsigned i = 0; i < given.n; i++)
            twice |= action->object[i] == object;
        if (twice || !allowed(table->right[object]) || (maker->repeated && table->sized[object]) ||
            (table->right[object] == DUITE_CWP && task->law != program->task[self].law))
            continue;
        duite_mode mode = draw_mode(maker, table->right[object], table->sized[object], depth);
        if (forced >= 0)
            mode = depth < MAX_DEPTH && draw(maker, 2) ? DUITE_WP : DUITE_W;
        else if (maker->waits)
            mode = draw(maker, 2) ? DUITE_RP : DUITE_RWP;
        else if (maker->repeated && !given.n)
            mode = draw(maker, 4) ? DUITE_RW : DUITE_W;
        table->written[object] |= mode == DUITE_W || mode == DUITE_WP;
        action->object[given.n] = object;
        task->mode[given.n] = mode;
        given.right[given.n] = mode;
        task->sized[given.n] = given.sized[given.n] = table->sized[object];
        given.type[given.n] = table->type[object];
        given.max[given.n++] = table->max[object];
    }
    task->n = given.n;
    maker->plain = maker->repeated = false;
    make_task(maker, child, &given, depth);
}

static void make_new(struct maker *maker, struct nest_task *task, struct table *table)
{
    static const duite_type TYPES[] = {DUITE_F64, DUITE_F64, DUITE_F32, DUITE_I32, DUITE_I64};
    struct nest_action *action = add(task, NEST_NEW);

    action->type = TYPES[draw(maker, 5)];
    action->max = 1 + draw(maker, NEST_MAX_COUNT);
    action->sized = draw(maker, 4) == 0;
    action->count = action->sized ? draw(maker, (unsigned)action->max + 1) : action->max;
    table->sized[table->n] = action->sized;
    table->made[table->n] = true;
    table->right[table->n] = DUITE_RWP;
    table->type[table->n] = action->type;
    table->max[table->n++] = action->max;
}

static void make_set(struct maker *maker, struct nest_task *task, struct table *table,
                     unsigned object)
{
    struct nest_action *action = add(task, NEST_SET);

    action->object[0] = object;
    action->type = table->type[object];
    action->count = action->max = table->max[object];
    action->seed = draw(maker, 4) ? duite_random(&maker->random) : 0;
    if (table->sized[object] && action->seed)
        action->count = draw(maker, (unsigned)action->max + 1);
    table->written[object] = true;
}

/* One thing on an object, if its right allows that. */
static void make_other(struct maker *maker, struct nest_task *task, struct table *table)
{
    const unsigned object = draw(maker, table->n), what = draw(maker, 6);
    const unsigned modes = allowed(table->right[object]);
    enum nest_kind kind = NEST_WAIT;

    if (what < 4 && table->right[object] == DUITE_CWP)
        kind = NEST_CONTRIBUTE;
    else if (what < 2 && modes >> DUITE_R & 1)
        kind = NEST_GET;
    else if (what < 4 && modes >> DUITE_W & 1)
        kind = NEST_SET;
    else if (what == 4 && table->made[object] && modes)
        kind = NEST_FREE;
    else if (draw(maker, 2))
        return;
    if (kind == NEST_SET) {
        make_set(maker, task, table, object);
        return;
    }
    struct nest_action *action = add(task, kind);
    action->object[0] = object;
    action->type = table->type[object];
    action->count = action->max = table->max[object];
    action->sized = table->sized[object];
    if (kind == NEST_CONTRIBUTE)
        action->seed = duite_random(&maker->random);
    if (kind == NEST_FREE)
        table->right[object] = DUITE_NONE;
}

/* A few forks and sets: a graph, which is replayed, or forks that repeat themselves often enough to
 * be recognised. The tasks of these fork no grandchildren: there are many of them. */
static void make_replay(struct maker *maker, struct table *table)
{
    struct nest_task *task = &maker->program->task[0];
    struct nest_action *replay = add(task, NEST_REPLAY);
    const unsigned first = task->n_actions, n = 1 + draw(maker, 3);
    const bool forked = draw(maker, 2), plain = draw(maker, 3) > 0;

    replay->forked = forked;
    replay->max = forked ? 70 + draw(maker, 80) : 1 + draw(maker, 3);
    for (unsigned tries = 0; tries < n; tries++) {
        const unsigned object = draw(maker, table->n);

        maker->plain = plain || forked;
        maker->repeated = forked;
        if (forked || draw(maker, 4))
            make_fork(maker, 0, table, -1, forked ? MAX_DEPTH - 1 : 1);
        else if (table->right[object])
            make_set(maker, task, table, object);
    }
    maker->plain = maker->repeated = false;
    replay->count = task->n_actions - first;
    if (!replay->count)
        task->n_actions--;
    maker->waits = forked && draw(maker, 2);
    if (maker->waits)
        make_fork(maker, 0, table, -1, 1);
    maker->waits = false;
}

static void make_get(struct nest_task *task, const struct table *table, unsigned object)
{
    struct nest_action *action = add(task, NEST_GET);

    action->object[0] = object;
    action->type = table->type[object];
    action->count = action->max = table->max[object];
    action->sized = table->sized[object];
}

/* Actions are kept free for what must be written, and for the main program's gets. */
static void make_actions(struct maker *maker, unsigned self, struct table *table, unsigned depth)
{
    struct nest_program *program = maker->program;
    struct nest_task *task = &program->task[self];
    const unsigned max = (self ? 1 : 5) + draw(maker, NEST_MAX_ACTIONS - NEST_MAX_PARAMS - 6);

    for (unsigned i = 0; !self && i < 3; i++)
        make_new(maker, task, table);
    while (task->n_actions < max) {
        const unsigned what = draw(maker, 10);

        if (what < 2 && table->n < NEST_MAX_OBJECTS && (self || table->n < 4))
            make_new(maker, task, table);
        else if (!self && what < 4 && table->n && program->n_tasks < NEST_MAX_TASKS - 90)
            make_replay(maker, table);
        else if (what < 8 && table->n && depth < MAX_DEPTH &&
                 program->n_tasks < NEST_MAX_TASKS - 60)
            make_fork(maker, self, table, -1, depth + 1);
        else if (table->n)
            make_other(maker, task, table);
        else if (draw(maker, 2))
            return;
    }
}

static void make_task(struct maker *maker, unsigned self, const struct table *given, unsigned depth)
{
    struct nest_program *program = maker->program;
    struct nest_task *task = &program->task[self];
    struct table table = *given;

    task->seed = duite_random(&maker->random);
    if (self && maker->fails && draw(maker, maker->fails) == 0)
        task->fails = 1 + (int)self;
    if (maker->waits && table.n)
        make_get(task, &table, 0);
    maker->waits = false;
    make_actions(maker, self, &table, depth);
    for (unsigned i = 0; i < task->n; i++)
        if (task->mode[i] == DUITE_WP && !table.written[i] && draw(maker, 3))
            make_fork(maker, self, &table, (int)i, depth + 1);
    for (unsigned i = 0; !self && i < table.n; i++)
        if (table.right[i] && task->n_actions < NEST_MAX_ACTIONS)
            make_get(task, &table, i);
}

void nest_make(struct nest_program *program, uint64_t seed)
{
    const struct table nothing = {0};
    struct maker maker = {.program = program, .random = seed};

    memset(program, 0, sizeof *program);
    program->seed = seed;
    program->n_tasks = 1;
    if (draw(&maker, 2))
        maker.fails = 8 + draw(&maker, 20);
    make_task(&maker, 0, &nothing, 0);
}

unsigned nest_kernel(const struct nest_task *task)
{
    static const unsigned first[] = {0, 1, 9, 73};
    unsigned place = 0;

    for (unsigned i = 0; i < task->n; i++)
        place = place * 8 + (unsigned)task->mode[i] - 1;
    return task->law * NEST_SIGNATURES + first[task->n] + place;
}

static void print_task(const struct nest_program *program, unsigned self, int indent)
{
    static const char *const modes[] = {"", "r", "w", "rw", "cw", "rp", "wp", "rwp", "cwp"};
    static const char *const kinds[] = {"new",  "free", "set",  "contribute",
                                        "fork", "get",  "wait", "replay"};
    const struct nest_task *task = &program->task[self];

    for (unsigned a = 0; a < task->n_actions; a++) {
        const struct nest_action *action = &task->action[a];
        const struct nest_task *child = &program->task[action->task];

        printf("# %*s%s", indent, "", kinds[action->kind]);
        if (action->kind == NEST_FORK)
            printf(" task %u%s, law %u:", action->task, child->fails ? " (fails)" : "", child->law);
        for (unsigned i = 0; action->kind == NEST_FORK && i < child->n; i++)
            printf(" %u %s", action->object[i], modes[child->mode[i]]);
        if (action->kind == NEST_NEW)
            printf(" type %d count %zu of %zu%s", (int)action->type, action->count, action->max,
                   action->sized ? ", sized" : "");
        else if (action->kind == NEST_REPLAY)
            printf(" the next %zu, %zu times%s", action->count, action->max,
                   action->forked ? ", by forks" : "");
        else if (action->kind != NEST_FORK && action->kind != NEST_WAIT)
            printf(" %u", action->object[0]);
        printf("\n");
        if (action->kind == NEST_FORK)
            print_task(program, action->task, indent + 4);
    }
}

void nest_print(const struct nest_program *program)
{
    print_task(program, 0, 0);
}
