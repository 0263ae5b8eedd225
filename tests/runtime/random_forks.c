/* Kernels, and forks by the main program and in bodies. A fork keeps to the rights that its scope
 * holds. */

#include "tests/runtime/random_make.h"

#include <string.h>

/* ---- Kernels ---- */

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

    if (make_has(m, PROG_NESTS) && make_one_in(m, 6))
        return (duite_mode)(DUITE_RP + make_below(m, 4));
    return MODES[make_below(m, sizeof MODES / sizeof *MODES)];
}

/* The law of a parameter with cw or cwp; a sum is what no law says. */
static const duite_law *draw_any_law(struct maker *m, duite_mode mode)
{
    const unsigned law = make_below(m, PROG_N_LAWS + 4);
    const int accumulates = mode == DUITE_CW || mode == DUITE_CWP;

    return !accumulates || law >= PROG_N_LAWS ? NULL : prog_law_given((enum prog_law)law);
}

static int may_replicate(const duite_kernel *kernel)
{
    int may = kernel->variadic <= DUITE_RW;

    for (unsigned i = 0; i < n_listed(kernel); i++)
        may &= kernel->access[i] <= DUITE_RW;
    return may;
}

/* Into the main program, whatever list is being made. */
static void add_kernel(struct maker *m, unsigned kernel)
{
    struct prog_op *op = &m->prog->ops[m->prog->n_ops++];

    *op = (struct prog_op){.kind = PROG_KERNEL, .kernel = kernel, .rank = -1, .cost = -1};
}

static duite_kernel *make_kernel(struct maker *m)
{
    struct prog *prog = m->prog;
    const size_t k = prog->n_kernels;
    duite_kernel *kernel = &prog->kernel[k];

    if (k == PROG_MAX_KERNELS)
        return NULL;
    snprintf(prog->name[k], sizeof prog->name[k], "kernel %zu", k);
    kernel->name = prog->name[k];
    kernel->law = prog->law[k];
    kernel->body = prog_body;
    kernel->args_size = sizeof(struct prog_args) - make_below(m, PROG_ARGS_PADDING);
    prog->n_kernels++;
    if (!m->adds)
        prog->list[prog->n_listed++] = kernel;
    else
        add_kernel(m, (unsigned)k);
    return kernel;
}

/* The first two kernels accumulate and update one object: these find most. */
void make_kernels(struct maker *m)
{
    const int adds = m->adds;

    m->n_drawn = 2 + make_below(m, 7);
    for (size_t k = 0; k < m->n_drawn; k++) {
        m->adds = adds && make_one_in(m, 3);
        duite_kernel *kernel = make_kernel(m);
        const unsigned n = k < 2 ? 1 : make_below(m, 7);

        for (unsigned i = 0; i < n; i++) {
            kernel->access[i] = (uint8_t)(k == 0 ? DUITE_CW : k == 1 ? DUITE_RW : draw_mode(m));
            m->prog->law[k][i] = draw_any_law(m, (duite_mode)kernel->access[i]);
        }
        if (k >= 2 && make_one_in(m, 3))
            kernel->variadic = draw_mode(m);
        kernel->variadic_law = draw_any_law(m, kernel->variadic);
        kernel->replicated = may_replicate(kernel) && make_one_in(m, 3);
        kernel->events = !kernel->replicated && make_one_in(m, 5);
    }
    m->adds = adds;
}

/* ---- Forks ---- */

/* The modes that a right gives, written down from the contract: a bit each. */
unsigned make_allowed(duite_mode right)
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

static int accumulates(duite_mode mode)
{
    return mode == DUITE_CW || mode == DUITE_CWP;
}

static int is_named(const struct prog_op *op, unsigned object)
{
    for (unsigned i = 0; i < op->n; i++)
        if (op->objects[i] == object)
            return 1;
    return 0;
}

/* Laws of bytes and of numbers; min and max mean nothing for complex ones. */
static int is_law_of(duite_type type, enum prog_law law)
{
    if (type == DUITE_CF64)
        return law == PROG_SUM || law == PROG_MIX;
    return (type == DUITE_BYTE) == (law == PROG_WEAVE);
}

static int fits(const struct make_scope *scope, unsigned place, duite_mode mode, enum prog_law law)
{
    const struct prog_object *object = &scope->object[place];

    if (!(make_allowed(scope->right[place]) >> mode & 1))
        return 0;
    if (!accumulates(mode))
        return 1;
    return !object->max && is_law_of(object->type, law) &&
           (scope->right[place] != DUITE_CWP || scope->law[place] == law);
}

int make_parameter(struct maker *m, const struct prog_op *draft)
{
    const duite_kernel *kernel = &m->prog->kernel[draft->kernel];
    const duite_mode mode = prog_mode(kernel, draft->n);
    const enum prog_law law = prog_law(kernel, draft->n);

    for (int attempt = 0; attempt < 30; attempt++) {
        const unsigned object = make_draw_object(m);

        if (!is_named(draft, object) && fits(m->scope, object, mode, law))
            return (int)object;
    }
    return -1;
}

/* Contributions are the most likely to go wrong, and come more often. */
static duite_mode draw_allowed(struct maker *m, unsigned place)
{
    const unsigned modes = make_allowed(m->scope->right[place]);
    const int sized = m->scope->object[place].max != 0;

    for (;;) {
        duite_mode mode = (duite_mode)(DUITE_R + make_below(m, 8));

        if (m->scope->right[place] == DUITE_RWP && make_one_in(m, 4))
            mode = make_one_in(m, 2) ? DUITE_CW : DUITE_CWP;
        if (modes >> mode & 1 && !(sized && accumulates(mode)) &&
            !(m->plain && prog_is_postponed(mode)))
            return mode;
    }
}

static const duite_law *draw_law(struct maker *m, unsigned place, duite_mode mode)
{
    const struct make_scope *scope = m->scope;

    if (!accumulates(mode))
        return NULL;
    if (scope->right[place] == DUITE_CWP)
        return prog_law_given(scope->law[place]);
    if (scope->object[place].type == DUITE_BYTE)
        return prog_law_given(PROG_WEAVE);
    if (scope->object[place].type == DUITE_CF64)
        return prog_law_given(make_one_in(m, 2) ? PROG_SUM : PROG_MIX);
    return prog_law_given((enum prog_law)make_below(m, PROG_WEAVE));
}

/* The modes and laws of a kernel. */
struct modes {
    uint8_t access[DUITE_MAX_ACCESS];
    const duite_law *law[DUITE_MAX_ACCESS];
};

/* Makes the kernel with these, or finds it. */
static int find_kernel(struct maker *m, const struct modes *like)
{
    struct prog *prog = m->prog;

    for (size_t k = 0; k < prog->n_kernels; k++) {
        const duite_kernel *kernel = &prog->kernel[k];

        if (!kernel->variadic && !kernel->replicated &&
            !memcmp(kernel->access, like->access, sizeof like->access) &&
            !memcmp(prog->law[k], like->law, sizeof like->law))
            return (int)k;
    }
    duite_kernel *kernel = make_kernel(m);

    if (!kernel)
        return -1;
    memcpy(kernel->access, like->access, sizeof like->access);
    memcpy(prog->law[prog->n_kernels - 1], like->law, sizeof like->law);
    return (int)prog->n_kernels - 1;
}

int make_fitting(struct maker *m, struct prog_op *draft, duite_mode first, int object)
{
    struct make_scope *scope = m->scope;
    const unsigned n = first ? 1 : make_below(m, 4);
    struct modes like = {0};

    for (unsigned tries = 0; scope->n_live && draft->n < n && tries < 12; tries++) {
        const unsigned place = object >= 0 ? (unsigned)object : make_draw_object(m);

        if (is_named(draft, place) || !make_allowed(scope->right[place]))
            continue;
        if (first && !(make_allowed(scope->right[place]) >> first & 1))
            continue;
        const duite_mode mode = first ? first : draw_allowed(m, place);

        like.access[draft->n] = (uint8_t)mode;
        like.law[draft->n] = draw_law(m, place, mode);
        draft->objects[draft->n++] = place;
    }
    const int kernel = first && draft->n < 1 ? -1 : find_kernel(m, &like);

    draft->kernel = kernel < 0 ? 0 : (unsigned)kernel;
    return kernel >= 0;
}

int make_postpones(const duite_kernel *kernel, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        if (prog_is_postponed(prog_mode(kernel, i)))
            return 1;
    return 0;
}

int make_draft(struct maker *m, struct prog_op *draft)
{
    const struct prog *prog = m->prog;

    if (make_has(m, PROG_NESTS) && make_one_in(m, 2))
        return make_fitting(m, draft, DUITE_NONE, -1);
    draft->kernel = make_below(m, make_one_in(m, 3) ? 2 : m->n_drawn);
    const duite_kernel *kernel = &prog->kernel[draft->kernel];
    const unsigned listed = n_listed(kernel);
    const unsigned more = kernel->variadic ? make_below(m, make_one_in(m, 4) ? 16 : 4) : 0;

    while (m->scope->n_live && draft->n < listed + more) {
        const int object = make_parameter(m, draft);

        if (object < 0)
            break;
        draft->objects[draft->n++] = (unsigned)object;
    }
    return draft->n >= listed && !(m->plain && make_postpones(kernel, draft->n));
}

struct prog_op *make_push_fork(struct maker *m, const struct prog_op *draft)
{
    struct prog *prog = m->prog;
    struct prog_op *op = make_push(m, draft->kind, 0);
    const duite_kernel *kernel = &prog->kernel[draft->kernel];

    op->kernel = draft->kernel;
    op->n = draft->n;
    memcpy(op->objects, draft->objects, sizeof op->objects);
    op->body = draft->body;
    op->n_inner = draft->n_inner;
    op->number = (unsigned)prog->n_forks++;
    if (!kernel->replicated && !m->scope->depth && make_one_in(m, 8))
        op->rank = (int)make_below(m, (unsigned)prog->n_ranks);
    op->fails = make_one_in(m, m->failing) ? 1 + (int)make_below(m, 1000) : 0;
    if (op->n && !op->n_inner && make_one_in(m, 6 * m->failing))
        op->exceeds = 1 + make_below(m, op->n);
    op->pause = make_one_in(m, m->pausing) ? 1 + make_below(m, make_one_in(m, 4) ? 20000 : 500) : 0;
    op->priority = make_one_in(m, 20) ? INT32_MIN : (int32_t)make_below(m, 7) - 3;
    op->cost = make_below(m, 3) - 1.0;
    for (unsigned i = 0; i < op->n; i++)
        m->scope->written[op->objects[i]] |=
            prog_mode(kernel, i) == DUITE_W || prog_mode(kernel, i) == DUITE_WP;
    if (!m->scope->depth)
        m->unsettled = m->scope->n;
    return op;
}

void make_fork(struct maker *m)
{
    struct prog_op draft = {.kind = PROG_FORK};

    if (!make_draft(m, &draft))
        return;
    make_body(m, &draft, 1, 0);
    make_push_fork(m, &draft);
}
