/* Makes programs. Every choice is drawn from the seed, so that every rank makes the same program; a
 * program never uses an object that is not alive, names none twice in a task, and frees what it
 * made, with rare exceptions. */

#include "tests/runtime/random_make.h"

#include <stdlib.h>
#include <string.h>

const char *const prog_features[PROG_N_FEATURES] = {
    "nests", "graphs", "repeats", "sizes", "failures", "refusals", "large", "memory", "adds"};

void *prog_memory(size_t n, size_t size)
{
    void *memory = calloc(n + 1, size);

    if (!memory) {
        fprintf(stderr, "out of memory\n");
        MPI_Abort(MPI_COMM_WORLD, 99);
    }
    return memory;
}

unsigned make_below(struct maker *m, unsigned n)
{
    return (unsigned)((duite_random(&m->random) >> 33) % n);
}

int make_one_in(struct maker *m, unsigned n)
{
    return n && make_below(m, n) == 0;
}

int make_has(const struct maker *m, enum prog_feature feature)
{
    return (int)(m->features >> feature & 1);
}

duite_mode prog_mode(const duite_kernel *kernel, size_t i)
{
    for (size_t k = 0; k < DUITE_MAX_ACCESS && kernel->access[k] != DUITE_NONE; k++)
        if (k == i)
            return (duite_mode)kernel->access[k];
    return kernel->variadic;
}

struct prog_op *make_push(struct maker *m, enum prog_kind kind, unsigned object)
{
    struct prog_op *op = &m->ops[(*m->n_ops)++];

    *op = (struct prog_op){0};
    op->kind = kind;
    op->object = object;
    op->rank = -1;
    op->seed = duite_random(&m->random);
    return op;
}

static size_t draw_count(struct maker *m)
{
    if (m->scope->depth > 0)
        return 1 + make_below(m, 4);
    if (make_one_in(m, m->large))
        return 4000 + make_below(m, 40000);
    if (make_one_in(m, 12))
        return 1 + make_below(m, 5000);
    return make_one_in(m, 4) ? 1 : 1 + make_below(m, 60);
}

void make_new(struct maker *m)
{
    static const duite_type TYPES[] = {DUITE_BYTE, DUITE_I32, DUITE_I64, DUITE_F32,
                                       DUITE_F64,  DUITE_F64, DUITE_U16, DUITE_CF64};
    struct make_scope *scope = m->scope;

    if (scope->n_live == MAX_LIVE || scope->n == PROG_MAX_TABLE)
        return;
    struct prog_op *op = make_push(m, PROG_NEW, scope->n);

    op->type = TYPES[make_below(m, sizeof TYPES / sizeof *TYPES)];
    op->count = draw_count(m);
    if (make_one_in(m, m->sized)) {
        op->max = op->count;
        op->count = make_below(m, (unsigned)op->max + 1);
    }
    if (scope->n_live && make_one_in(m, 3)) { /* one that may be bound in place of another */
        const struct prog_object *like = &scope->object[make_draw_object(m)];

        op->type = like->type;
        op->count = like->count;
        op->max = like->max;
    }
    if (!op->max && !scope->depth && make_has(m, PROG_MEMORY) && make_one_in(m, 2))
        op->rank = (int)make_below(m, (unsigned)m->prog->n_ranks);
    scope->object[scope->n] = (struct prog_object){op->type, op->count, op->max, -1, op->rank + 1};
    scope->right[scope->n] = DUITE_RWP;
    scope->made[scope->n] = 1;
    scope->live[scope->n_live++] = scope->n++;
}

void make_free(struct maker *m, unsigned place)
{
    struct make_scope *scope = m->scope;

    if (scope->part[scope->live[place]])
        return;
    make_push(m, PROG_FREE, scope->live[place]);
    memmove(&scope->live[place], &scope->live[place + 1],
            (--scope->n_live - place) * sizeof *scope->live);
}

unsigned make_draw_object(struct maker *m)
{
    const unsigned n = m->scope->n_live;

    return m->scope->live[make_below(m, make_one_in(m, 2) ? n : (n + 3) / 4)];
}

/* Many contributions to one object, so that trees grow. */
static void make_burst(struct maker *m)
{
    struct prog_op draft = {.kind = PROG_FORK, .kernel = 0};
    const int object = make_parameter(m, &draft);

    if (object < 0)
        return;
    draft.objects[draft.n++] = (unsigned)object;
    for (unsigned i = make_below(m, MOST_BURST); i > 0; i--) {
        make_push_fork(m, &draft);
        if (make_one_in(m, 4))
            make_fork(m);
    }
}

static void make_hint(struct maker *m)
{
    struct prog_op *op = make_push(m, PROG_HINT, make_draw_object(m));

    op->weight = (double)make_below(m, 5);
    for (unsigned i = 0; i < 3; i++) {
        const unsigned other = make_draw_object(m);
        int taken = other == op->object;

        for (unsigned k = 0; k < op->n; k++)
            taken |= op->objects[k] == other;
        if (!taken)
            op->objects[op->n++] = other;
    }
}

/* The leader is older, so that no object follows itself. */
static void make_follow(struct maker *m)
{
    struct make_scope *scope = m->scope;
    const unsigned place = 1 + make_below(m, scope->n_live - 1);
    struct prog_object *object = &scope->object[scope->live[place]];
    const unsigned leader = scope->live[make_below(m, place)];

    if (object->leader >= 0 || object->adopted || scope->live[place] < m->unsettled)
        return;
    object->leader = (int)leader;
    make_push(m, PROG_FOLLOW, scope->live[place])->objects[0] = leader;
}

static void make_get(struct maker *m)
{
    make_push(m, PROG_GET, make_draw_object(m));
    m->refused = 0;
    m->unsettled = m->scope->n;
}

static void make_get_at(struct maker *m)
{
    if (!m->refused)
        make_push(m, PROG_GET_AT, make_draw_object(m))->rank =
            (int)make_below(m, (unsigned)m->prog->n_ranks);
}

static void make_count(struct maker *m)
{
    make_push(m, PROG_COUNT, make_draw_object(m));
    m->refused = 0;
}

/* Some objects, each once. */
static void make_wait_for(struct maker *m, enum prog_kind kind)
{
    struct prog_op *op = make_push(m, kind, 0);
    const unsigned most = make_below(m, MOST_AWAITED + 1);

    for (unsigned i = 0; i < most; i++)
        op->objects[op->n++] = make_draw_object(m); /* some may come twice */
    op->count = kind == PROG_TEST && make_one_in(m, 2);
    if (kind == PROG_WAIT_FOR)
        m->refused = 0;
}

void make_get_begin(struct maker *m)
{
    if (m->n_begun == MOST_BEGUN)
        return;
    m->begun[m->n_begun++] = m->prog->n_ops;
    make_push(m, PROG_GET_BEGIN, make_draw_object(m));
}

/* Ends the oldest get of some object, which may be freed meanwhile. */
static void make_get_end(struct maker *m)
{
    struct prog_op *ops = m->prog->ops;

    if (!m->n_begun)
        return;
    const unsigned object = ops[m->begun[make_below(m, m->n_begun)]].object;
    unsigned i = 0;

    while (ops[m->begun[i]].object != object)
        i++;
    const size_t begin = m->begun[i];

    memmove(&m->begun[i], &m->begun[i + 1], (--m->n_begun - i) * sizeof *m->begun);
    ops[begin].body = m->prog->n_ops;
    make_push(m, PROG_GET_END, object)->body = begin;
    m->refused = 0;
}

void make_set(struct maker *m, enum prog_kind kind, unsigned place, int zeros)
{
    struct prog_op *op = make_push(m, kind, place);
    const struct prog_object *object = &m->scope->object[place];

    op->count = object->max ? make_below(m, (unsigned)object->max + 1) : object->count;
    if (zeros)
        op->seed = 0;
    if (kind == PROG_SET && !m->scope->depth && make_has(m, PROG_MEMORY) && make_one_in(m, 3)) {
        op->count = object->max ? object->max : object->count;
        op->rank = (int)make_below(m, (unsigned)m->prog->n_ranks);
    }
    m->scope->written[place] = 1;
}

static void make_wait(struct maker *m)
{
    make_push(m, PROG_WAIT, 0);
    m->refused = 0;
}

static void make_wrong(struct maker *m)
{
    if (!make_has(m, PROG_REFUSALS))
        return;
    make_push(m, PROG_WRONG, make_draw_object(m))->fails = DUITE_E_ACCESS;
    m->refused = 1;
}

static void make_other(struct maker *m)
{
    const unsigned choice = make_below(m, 24);

    if (choice < 3)
        make_set(m, PROG_SET, make_draw_object(m), choice < 1);
    else if (choice < 4)
        make_count(m);
    else if (choice < 6)
        make_get(m);
    else if (choice < 8)
        make_get_at(m);
    else if (choice < 9)
        make_wait(m);
    else if (choice < 10)
        make_hint(m);
    else if (choice < 11)
        make_push(m, PROG_HOME, make_draw_object(m));
    else if (choice < 12 && m->scope->n_live > 2)
        make_free(m, make_below(m, m->scope->n_live));
    else if (choice < 13)
        make_wrong(m);
    else if (choice < 15)
        make_wait_for(m, PROG_WAIT_FOR);
    else if (choice < 16)
        make_wait_for(m, PROG_TEST);
    else if (choice < 18)
        make_get_begin(m);
    else if (choice < 20)
        make_get_end(m);
    m->unsettled = m->scope->n;
}

static void make_operations(struct maker *m, size_t n)
{
    struct prog *prog = m->prog;
    const struct make_scope *scope = m->scope;
    unsigned rounds = make_has(m, PROG_REPEATS) ? 1 + make_below(m, MOST_ROUNDS) : 0;

    while (prog->n_ops < n) {
        const unsigned choice = make_below(m, 100);
        const size_t before = prog->n_ops;

        if (scope->n_live < 2 || (choice < 8 && scope->n_live < m->most_live))
            make_new(m);
        else if (rounds && make_one_in(m, 12) && rounds--)
            make_rounds(m), n += prog->n_ops - before;
        else if (choice < 12)
            make_follow(m);
        else if (choice < 14)
            make_burst(m);
        else if (choice < 20 && make_has(m, PROG_MEMORY))
            make_turns(m), m->unsettled = scope->n;
        else if (choice < 24 && make_has(m, PROG_MEMORY))
            make_one_in(m, 2) ? make_split(m) : make_join(m), m->unsettled = scope->n;
        else if (choice < 34 && make_has(m, PROG_GRAPHS))
            make_graph_operation(m);
        else if (choice < 78)
            make_fork(m);
        else
            make_other(m);
        if (scope->n == PROG_MAX_TABLE && scope->n_live < 2)
            return;
    }
}

static unsigned bit(enum prog_feature feature, int set)
{
    return set ? 1u << feature : 0;
}

static void draw_character(struct maker *m, unsigned with, unsigned without)
{
    m->features = bit(PROG_NESTS, make_one_in(m, 2)) | bit(PROG_GRAPHS, make_one_in(m, 2)) |
                  bit(PROG_REPEATS, make_one_in(m, 2)) | bit(PROG_FAILURES, make_one_in(m, 4)) |
                  bit(PROG_REFUSALS, make_one_in(m, 8)) | bit(PROG_LARGE, make_one_in(m, 40)) |
                  bit(PROG_MEMORY, make_one_in(m, 2)) | bit(PROG_ADDS, make_one_in(m, 3));
    const int sized = !make_has(m, PROG_GRAPHS) || make_one_in(m, 4); /* such graphs have no plan */

    m->features |= bit(PROG_SIZES, sized);
    m->features = (m->features | with) & ~without;
    if (m->prog->n_ranks > 1)
        m->features &= ~bit(PROG_REPEATS, 1);
    m->most_live = 2 + make_below(m, MAX_LIVE - 1);
    m->large = make_has(m, PROG_LARGE) ? 10 : 0;
    m->failing = make_has(m, PROG_FAILURES) ? 4 + make_below(m, 30) : 0;
    m->pausing = make_one_in(m, 2) ? 1 + make_below(m, 10) : 0;
    m->sized = make_has(m, PROG_SIZES) ? 4 : 0;
    m->adds = make_has(m, PROG_ADDS);
}

/* The program does this before its first task, while homes are open. */
static void make_beginning(struct maker *m)
{
    for (unsigned i = 0; i < m->most_live / 2; i++)
        make_new(m);
    for (unsigned i = make_below(m, 8); m->scope->n_live > 1 && i > 0; i--)
        make_follow(m);
    for (unsigned i = make_below(m, 8); m->scope->n_live > 1 && i > 0; i--)
        make_hint(m);
}

/* Gets what is left, and frees nearly all of it. */
static void make_end(struct maker *m)
{
    struct make_scope *scope = m->scope;

    if (!make_one_in(m, 4))
        for (unsigned i = 0; i < scope->n_live; i++)
            make_push(m, PROG_GET, scope->live[i]);
    const unsigned left = make_one_in(m, 20) ? 1 : 0;

    make_graphs_free(m);
    while (m->n_begun)
        make_get_end(m);
    while (m->n_splits)
        make_join(m);
    while (scope->n_live > left)
        make_free(m, scope->n_live - 1);
}

struct prog *prog_make(uint64_t seed, int n_ranks, unsigned with, unsigned without)
{
    struct prog *prog = prog_memory(1, sizeof *prog);
    struct make_scope scope = {0};
    struct maker m = {.prog = prog, .scope = &scope, .n_ops = &prog->n_ops};

    m.random = seed * 0x9e3779b97f4a7c15u + (uint64_t)n_ranks;
    prog->seed = seed;
    prog->n_ranks = n_ranks;
    prog->ops = prog_memory(MAX_OPS + PROG_MAX_TABLE + PROG_MAX_KERNELS + MOST_BEGUN +
                                2 * MOST_BURST + MOST_RECORDED + MOST_ROUNDS * MOST_REPEATED,
                            sizeof *prog->ops);
    prog->inner = prog_memory(MAX_BODIES * MOST_ACTIONS, sizeof *prog->inner);
    m.ops = prog->ops;
    draw_character(&m, with, without);
    prog->adopts = make_has(&m, PROG_MEMORY);
    make_kernels(&m);
    make_beginning(&m);
    make_operations(&m, make_one_in(&m, 20) ? MAX_OPS - MAX_LIVE : 10 + make_below(&m, 90));
    make_end(&m);
    prog->n_objects = scope.n;
    memcpy(prog->objects, scope.object, sizeof prog->objects);
    return prog;
}

void prog_free(struct prog *prog)
{
    free(prog->ops);
    free(prog->inner);
    free(prog);
}
