/* Chooses kernels and objects of forks, by the main program and in bodies. A fork keeps to the
 * rights that its scope holds. */

#include "tests/runtime/random_make.h"

#include <string.h>

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

static int fits(const struct make_scope *scope, unsigned place, duite_mode mode, enum prog_law law)
{
    const struct prog_object *object = &scope->object[place];

    if (!(allowed(scope->right[place]) >> mode & 1))
        return 0;
    if (!accumulates(mode))
        return 1;
    return !object->max && (object->type == DUITE_BYTE) == (law == PROG_WEAVE) &&
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
    const unsigned modes = allowed(m->scope->right[place]);
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
    return prog_law_given((enum prog_law)make_below(m, PROG_WEAVE));
}

/* Makes the kernel with these modes and laws, or finds it. */
static int find_kernel(struct maker *m, const duite_kernel *like)
{
    const struct prog *prog = m->prog;

    for (size_t k = 0; k < prog->n_kernels; k++) {
        const duite_kernel *kernel = &prog->kernel[k];

        if (!kernel->variadic && !kernel->replicated &&
            !memcmp(kernel->access, like->access, sizeof like->access) &&
            !memcmp(kernel->law, like->law, sizeof like->law))
            return (int)k;
    }
    duite_kernel *kernel = make_kernel(m);

    if (!kernel)
        return -1;
    memcpy(kernel->access, like->access, sizeof like->access);
    memcpy(kernel->law, like->law, sizeof like->law);
    return (int)prog->n_kernels - 1;
}

int make_fitting(struct maker *m, struct prog_op *draft, duite_mode first, int object)
{
    struct make_scope *scope = m->scope;
    const unsigned n = first ? 1 : make_below(m, 4);
    duite_kernel like = {0};

    for (unsigned tries = 0; scope->n_live && draft->n < n && tries < 12; tries++) {
        const unsigned place = object >= 0 ? (unsigned)object : make_draw_object(m);

        if (is_named(draft, place) || !allowed(scope->right[place]))
            continue;
        if (first && !(allowed(scope->right[place]) >> first & 1))
            continue;
        const duite_mode mode = first ? first : draw_allowed(m, place);

        like.access[draft->n] = mode;
        like.law[draft->n] = draw_law(m, place, mode);
        draft->objects[draft->n++] = place;
    }
    const int kernel = first && draft->n < 1 ? -1 : find_kernel(m, &like);

    draft->kernel = kernel < 0 ? 0 : (unsigned)kernel;
    return kernel >= 0;
}

static int postpones(const duite_kernel *kernel, unsigned n)
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
    const unsigned listed = make_listed(kernel);
    const unsigned more = kernel->variadic ? make_below(m, make_one_in(m, 4) ? 16 : 4) : 0;

    while (m->scope->n_live && draft->n < listed + more) {
        const int object = make_parameter(m, draft);

        if (object < 0)
            break;
        draft->objects[draft->n++] = (unsigned)object;
    }
    return draft->n >= listed && !(m->plain && postpones(kernel, draft->n));
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

/* ---- Bodies that make calls ---- */

/* A fork of the second kernel, which updates: an object without the right to that, or none. */
static void make_wrong_call(struct maker *m)
{
    struct prog_op *op = make_push(m, PROG_WRONG, PROG_MAX_TABLE);

    op->fails = DUITE_E_OBJECT;
    for (unsigned i = 0; i < m->scope->n && !m->scope->made[i]; i++)
        if (!(allowed(m->scope->right[i]) >> DUITE_RW & 1)) {
            op->object = i;
            op->fails = DUITE_E_RIGHT;
        }
}

/* A call on one object, if its right allows it. */
static void make_call(struct maker *m)
{
    struct make_scope *scope = m->scope;
    const unsigned place = make_below(m, scope->n_live), object = scope->live[place];
    const unsigned choice = make_below(m, 13), modes = allowed(scope->right[object]);

    if (choice < 8 && scope->right[object] == DUITE_CWP)
        make_push(m, PROG_CONTRIBUTE, object);
    else if (choice < 4 && modes >> DUITE_R & 1)
        make_push(m, make_one_in(m, 4) ? PROG_COUNT : PROG_GET, object);
    else if (choice < 8 && modes >> DUITE_W & 1)
        make_set(m, PROG_SET, object, make_one_in(m, 4));
    else if (choice < 10 && scope->made[object])
        make_free(m, place);
    else if (choice < 11 && make_has(m, PROG_REFUSALS))
        make_wrong_call(m);
    else if (make_one_in(m, 2))
        make_push(m, PROG_WAIT, 0);
}

/* Room is kept for the forks that overwrite. */
static void make_calls(struct maker *m)
{
    const size_t max = 1 + make_below(m, MOST_ACTIONS - 7);
    const struct make_scope *scope = m->scope;

    while (*m->n_ops < max) {
        const unsigned choice = make_below(m, 10);

        if (choice < 2 && scope->n < PROG_MAX_PARAMS + 9)
            make_new(m);
        else if (choice < 8 && scope->n_live && scope->depth < MAX_DEPTH)
            make_fork(m);
        else if (scope->n_live)
            make_call(m);
        else if (make_one_in(m, 2))
            return;
    }
}

/* A body that holds wp and overwrites nothing leaves zeros, which is rare. */
static void make_overwriting(struct maker *m, unsigned n)
{
    for (unsigned i = 0; i < n && *m->n_ops < MOST_ACTIONS; i++) {
        struct prog_op draft = {.kind = PROG_FORK};

        if (m->scope->right[i] != DUITE_WP || m->scope->written[i] || make_one_in(m, 3))
            continue;
        if (!make_fitting(m, &draft, make_one_in(m, 2) ? DUITE_W : DUITE_WP, (int)i))
            continue;
        if (m->scope->depth < MAX_DEPTH)
            make_body(m, &draft, 1, 0);
        make_push_fork(m, &draft);
    }
}

static void enter(struct make_scope *scope, const struct make_scope *above,
                  const duite_kernel *kernel, const struct prog_op *draft)
{
    for (unsigned i = 0; i < draft->n; i++) {
        scope->object[i] = above->object[draft->objects[i]];
        scope->right[i] = prog_mode(kernel, i);
        scope->law[i] = prog_law(kernel, i);
        if (allowed(scope->right[i]) && scope->n_live < MAX_LIVE)
            scope->live[scope->n_live++] = i;
    }
    scope->n = draft->n;
}

void make_body(struct maker *m, struct prog_op *draft, unsigned depth, int asks)
{
    struct prog *prog = m->prog;
    const duite_kernel *kernel = &prog->kernel[draft->kernel];
    struct maker inner = *m;
    struct make_scope scope = {.depth = m->scope->depth + 1};
    struct prog_op ops[MOST_ACTIONS];
    size_t n = 0;
    const int likely = asks || m->scope->depth > 0 || postpones(kernel, draft->n);

    if (!make_has(m, PROG_NESTS) || kernel->replicated || m->bodies >= MAX_BODIES ||
        (!likely && !make_one_in(m, 3)))
        return;
    if (scope.depth < depth)
        scope.depth = depth;
    enter(&scope, m->scope, kernel, draft);
    inner.bodies++;
    inner.scope = &scope;
    inner.ops = ops;
    inner.n_ops = &n;
    inner.plain = 0;
    if (asks)
        make_push(&inner, PROG_GET, 0);
    make_calls(&inner);
    make_overwriting(&inner, draft->n);
    m->random = inner.random;
    m->bodies = inner.bodies;
    memcpy(&prog->inner[prog->n_inner], ops, n * sizeof *ops);
    draft->body = prog->n_inner;
    draft->n_inner = n;
    prog->n_inner += n;
}
