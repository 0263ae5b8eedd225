/* Makes programs. Every choice is drawn from the seed, so that every rank makes the same program; a
 * program never uses an object that is not alive, names none twice in a task, and frees what it
 * made, with rare exceptions. */

#include "tests/runtime/random_make.h"

#include <stdlib.h>
#include <string.h>

unsigned make_below(struct maker *m, unsigned n)
{
    return (unsigned)((duite_random(&m->random) >> 33) % n);
}

int make_one_in(struct maker *m, unsigned n)
{
    return n && make_below(m, n) == 0;
}

duite_mode prog_mode(const duite_kernel *kernel, size_t i)
{
    for (size_t k = 0; k < DUITE_MAX_ACCESS && kernel->access[k] != DUITE_NONE; k++)
        if (k == i)
            return kernel->access[k];
    return kernel->variadic;
}

static unsigned n_listed(const duite_kernel *kernel)
{
    unsigned n = 0;

    while (n < DUITE_MAX_ACCESS && kernel->access[n] != DUITE_NONE)
        n++;
    return n;
}

static duite_mode draw_mode(struct maker *m)
{
    static const duite_mode MODES[] = {DUITE_R,  DUITE_R,  DUITE_R, DUITE_W,
                                       DUITE_RW, DUITE_CW, DUITE_CW};

    return MODES[make_below(m, sizeof MODES / sizeof *MODES)];
}

/* The law of a parameter with cw; a sum is what no law says. */
static const duite_law *draw_law(struct maker *m, duite_mode mode)
{
    const unsigned law = make_below(m, PROG_N_LAWS + 4);

    return mode != DUITE_CW || law >= PROG_N_LAWS ? NULL : prog_law_given((enum prog_law)law);
}

static int may_replicate(const duite_kernel *kernel)
{
    int may = kernel->variadic != DUITE_CW;

    for (unsigned i = 0; i < n_listed(kernel); i++)
        may &= kernel->access[i] != DUITE_CW;
    return may;
}

/* The first two kernels accumulate and update one object: what finds most. */
static void make_kernels(struct maker *m)
{
    struct prog *prog = m->prog;

    prog->n_kernels = 2 + make_below(m, PROG_MAX_KERNELS - 1);
    for (size_t k = 0; k < prog->n_kernels; k++) {
        duite_kernel *kernel = &prog->kernel[k];
        const unsigned n = k < 2 ? 1 : make_below(m, 7);

        snprintf(prog->name[k], sizeof prog->name[k], "kernel %zu", k);
        kernel->name = prog->name[k];
        kernel->body = prog_body;
        for (unsigned i = 0; i < n; i++) {
            kernel->access[i] = k == 0 ? DUITE_CW : k == 1 ? DUITE_RW : draw_mode(m);
            kernel->law[i] = draw_law(m, kernel->access[i]);
        }
        if (k >= 2 && make_one_in(m, 3))
            kernel->variadic = draw_mode(m);
        kernel->variadic_law = draw_law(m, kernel->variadic);
        kernel->args_size = sizeof(struct prog_args) - make_below(m, PROG_ARGS_PADDING);
        kernel->replicated = may_replicate(kernel) && make_one_in(m, 3);
        prog->list[k] = kernel;
    }
}

struct prog_op *make_push(struct maker *m, enum prog_kind kind, unsigned object)
{
    struct prog_op *op = &m->prog->ops[m->prog->n_ops++];

    op->kind = kind;
    op->object = object;
    op->rank = -1;
    op->seed = duite_random(&m->random);
    return op;
}

static size_t draw_count(struct maker *m)
{
    if (make_one_in(m, m->large))
        return 4000 + make_below(m, 40000);
    if (make_one_in(m, 12))
        return 1 + make_below(m, 5000);
    return make_one_in(m, 4) ? 1 : 1 + make_below(m, 60);
}

static void make_new(struct maker *m)
{
    static const duite_type TYPES[] = {DUITE_BYTE, DUITE_I32, DUITE_I64,
                                       DUITE_F32,  DUITE_F64, DUITE_F64};
    struct prog *prog = m->prog;

    if (m->n_live == MAX_LIVE || prog->n_objects == MAX_MADE)
        return;
    struct prog_op *op = make_push(m, PROG_NEW, (unsigned)prog->n_objects);

    op->type = TYPES[make_below(m, sizeof TYPES / sizeof *TYPES)];
    op->count = draw_count(m);
    if (make_one_in(m, m->sized)) {
        op->max = op->count;
        op->count = make_below(m, (unsigned)op->max + 1);
    }
    if (m->n_live && make_one_in(m, 3)) { /* one that may be bound in place of another */
        const struct prog_object *like = &prog->objects[make_draw_object(m)];

        op->type = like->type;
        op->count = like->count;
        op->max = like->max;
    }
    prog->objects[prog->n_objects] = (struct prog_object){op->type, op->count, op->max, -1};
    m->live[m->n_live++] = (unsigned)prog->n_objects++;
}

static void free_place(struct maker *m, unsigned place)
{
    make_push(m, PROG_FREE, m->live[place]);
    memmove(&m->live[place], &m->live[place + 1], (--m->n_live - place) * sizeof *m->live);
}

unsigned make_draw_object(struct maker *m)
{
    return m
        ->live[make_one_in(m, 2) ? make_below(m, m->n_live) : make_below(m, (m->n_live + 3) / 4)];
}

/* An object that the operation does not name yet; -1 if none was found. */
static int draw_other(struct maker *m, const struct prog_op *op, int may_bytes, int may_numbers)
{
    for (int attempt = 0; attempt < 30; attempt++) {
        const unsigned object = make_draw_object(m);
        int taken = m->prog->objects[object].type == DUITE_BYTE ? !may_bytes : !may_numbers;

        taken |= m->prog->objects[object].max && !(may_bytes && may_numbers);

        for (unsigned i = 0; i < op->n; i++)
            taken |= op->objects[i] == object;
        if (!taken)
            return (int)object;
    }
    return -1;
}

/* An object that fits the next parameter. */
static int draw_parameter(struct maker *m, const struct prog_op *op)
{
    const duite_kernel *kernel = &m->prog->kernel[op->kernel];
    const int any = prog_mode(kernel, op->n) != DUITE_CW;
    const int weave = prog_law(kernel, op->n) == PROG_WEAVE;

    return draw_other(m, op, any || weave, any || !weave);
}

struct prog_op *make_push_fork(struct maker *m, const struct prog_op *draft)
{
    struct prog *prog = m->prog;
    struct prog_op *op = make_push(m, draft->kind, 0);

    op->kernel = draft->kernel;
    op->n = draft->n;
    memcpy(op->objects, draft->objects, sizeof op->objects);
    op->number = (unsigned)prog->n_forks++;
    op->rank = make_one_in(m, 8) ? (int)make_below(m, (unsigned)prog->n_ranks) : -1;
    if (prog->kernel[op->kernel].replicated)
        op->rank = -1;
    op->fails = make_one_in(m, m->failing) ? 1 + (int)make_below(m, 1000) : 0;
    op->exceeds = op->n && make_one_in(m, 6 * m->failing) ? 1 + make_below(m, op->n) : 0;
    op->pause = make_one_in(m, m->pausing) ? 1 + make_below(m, make_one_in(m, 4) ? 20000 : 500) : 0;
    op->priority = make_one_in(m, 20) ? INT32_MIN : (int32_t)make_below(m, 7) - 3;
    op->cost = make_below(m, 3) - 1.0;
    m->unsettled = (unsigned)prog->n_objects;
    return op;
}

int make_draft(struct maker *m, struct prog_op *draft)
{
    const struct prog *prog = m->prog;
    const unsigned kernel = make_below(m, make_one_in(m, 3) ? 2 : (unsigned)prog->n_kernels);
    const unsigned listed = n_listed(&prog->kernel[kernel]);
    const unsigned more =
        prog->kernel[kernel].variadic ? make_below(m, make_one_in(m, 4) ? 16 : 4) : 0;

    draft->kernel = kernel;
    while (draft->n < listed + more) {
        const int object = draw_parameter(m, draft);

        if (object < 0)
            break;
        draft->objects[draft->n++] = (unsigned)object;
    }
    return draft->n >= listed;
}

static void make_fork(struct maker *m)
{
    struct prog_op draft = {.kind = PROG_FORK};

    if (make_draft(m, &draft))
        make_push_fork(m, &draft);
}

/* Many contributions to one object, so that trees grow. */
static void make_burst(struct maker *m)
{
    struct prog_op draft = {.kind = PROG_FORK, .kernel = 0};
    const int object = draw_parameter(m, &draft);

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
        const int other = draw_other(m, op, 1, 1);

        if (other >= 0 && (unsigned)other != op->object)
            op->objects[op->n++] = (unsigned)other;
    }
}

/* The leader is older, so that nobody follows itself. */
static void make_follow(struct maker *m)
{
    const unsigned place = 1 + make_below(m, m->n_live - 1);
    struct prog_object *object = &m->prog->objects[m->live[place]];
    const unsigned leader = m->live[make_below(m, place)];

    if (object->leader >= 0 || m->live[place] < m->unsettled)
        return;
    object->leader = (int)leader;
    make_push(m, PROG_FOLLOW, m->live[place])->objects[0] = leader;
}

static void make_get(struct maker *m)
{
    make_push(m, PROG_GET, make_draw_object(m));
    m->refused = 0;
    m->unsettled = (unsigned)m->prog->n_objects;
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

void make_set(struct maker *m, enum prog_kind kind, int zeros)
{
    struct prog_op *op = make_push(m, kind, make_draw_object(m));
    const struct prog_object *object = &m->prog->objects[op->object];

    op->count = object->max ? make_below(m, (unsigned)object->max + 1) : object->count;
    if (zeros)
        op->seed = 0;
}

static void make_wait(struct maker *m)
{
    make_push(m, PROG_WAIT, 0);
    m->refused = 0;
}

static void make_wrong(struct maker *m)
{
    if (m->wrong)
        make_push(m, PROG_WRONG, make_draw_object(m));
    m->refused |= m->wrong;
}

static void make_other(struct maker *m)
{
    const unsigned choice = make_below(m, 16);

    if (choice < 3)
        make_set(m, PROG_SET, choice < 1);
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
    else if (choice < 12 && m->n_live > 2)
        free_place(m, make_below(m, m->n_live));
    else if (choice < 13)
        make_wrong(m);
    m->unsettled = (unsigned)m->prog->n_objects;
}

static void make_operations(struct maker *m, size_t n)
{
    struct prog *prog = m->prog;
    unsigned rounds = m->repeats ? 1 + make_below(m, MOST_ROUNDS) : 0;

    while (prog->n_ops < n) {
        const unsigned choice = make_below(m, 100);
        const size_t before = prog->n_ops;

        if (m->n_live < 2 || (choice < 8 && m->n_live < m->most_live))
            make_new(m);
        else if (rounds && make_one_in(m, 12) && rounds--)
            make_rounds(m), n += prog->n_ops - before;
        else if (choice < 12)
            make_follow(m);
        else if (choice < 14)
            make_burst(m);
        else if (choice < 34 && m->graphs)
            make_graph_operation(m);
        else if (choice < 78)
            make_fork(m);
        else
            make_other(m);
        if (prog->n_objects == MAX_MADE && m->n_live < 2)
            return;
    }
}

static void draw_character(struct maker *m)
{
    m->most_live = 2 + make_below(m, MAX_LIVE - 1);
    m->large = make_one_in(m, 40) ? 10 : 0;
    m->failing = make_one_in(m, 4) ? 4 + make_below(m, 30) : 0;
    m->pausing = make_one_in(m, 2) ? 1 + make_below(m, 10) : 0;
    m->wrong = make_one_in(m, 8);
    m->graphs = make_one_in(m, 2);
    m->sized = m->graphs && !make_one_in(m, 4) ? 0 : 4; /* such graphs have no plan */
    m->repeats = m->prog->n_ranks == 1 && make_one_in(m, 2);
}

struct prog *prog_make(uint64_t seed, int n_ranks)
{
    struct prog *prog = calloc(1, sizeof *prog);
    struct maker m = {.prog = prog, .random = seed * 0x9e3779b97f4a7c15u + (uint64_t)n_ranks};

    if (!prog)
        return NULL;
    prog->seed = seed;
    prog->n_ranks = n_ranks;
    prog->ops =
        calloc(MAX_OPS + MAX_MADE + 2 * MOST_BURST + MOST_RECORDED + MOST_ROUNDS * MOST_REPEATED,
               sizeof *prog->ops);
    prog->objects = calloc(MAX_MADE, sizeof *prog->objects);
    if (!prog->ops || !prog->objects) {
        prog_free(prog);
        return NULL;
    }
    draw_character(&m);
    make_kernels(&m);
    for (unsigned i = 0; i < m.most_live / 2; i++)
        make_new(&m);
    for (unsigned i = make_below(&m, 8); m.n_live > 1 && i > 0; i--)
        make_follow(&m);
    for (unsigned i = make_below(&m, 8); m.n_live > 1 && i > 0; i--)
        make_hint(&m);
    make_operations(&m, make_one_in(&m, 20) ? MAX_OPS - MAX_LIVE : 10 + make_below(&m, 90));
    if (!make_one_in(&m, 4))
        for (unsigned i = 0; i < m.n_live; i++) /* what the program leaves */
            make_push(&m, PROG_GET, m.live[i]);
    const unsigned left = make_one_in(&m, 20) ? 1 : 0;

    make_graphs_free(&m);
    while (m.n_live > left)
        free_place(&m, m.n_live - 1);
    return prog;
}

void prog_free(struct prog *prog)
{
    if (!prog)
        return;
    free(prog->ops);
    free(prog->objects);
    free(prog);
}
