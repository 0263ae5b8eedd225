/* Bodies that make calls: they fork, make objects, split, set, get and wait, as their rights
 * allow. */

#include "tests/runtime/random_make.h"

#include <string.h>

/* A fork of the second kernel, which updates: an object without the right to that, or none. */
static void make_wrong_call(struct maker *m)
{
    struct prog_op *op = make_push(m, PROG_WRONG, PROG_MAX_TABLE);

    op->fails = DUITE_E_OBJECT;
    for (unsigned i = 0; i < m->scope->n && !m->scope->made[i]; i++)
        if (!(make_allowed(m->scope->right[i]) >> DUITE_RW & 1) && make_one_in(m, 2)) {
            op->object = i;
            op->fails = DUITE_E_RIGHT;
        }
}

/* A call on one object, if its right allows it. */
static void make_call(struct maker *m)
{
    struct make_scope *scope = m->scope;
    const unsigned place = make_below(m, scope->n_live), object = scope->live[place];
    const unsigned choice = make_below(m, 13), modes = make_allowed(scope->right[object]);

    if (choice < 8 && scope->right[object] == DUITE_CWP)
        make_push(m, PROG_CONTRIBUTE, object);
    else if (choice < 4 && modes >> DUITE_R & 1)
        make_push(m,
                  make_one_in(m, 4)   ? PROG_COUNT
                  : make_one_in(m, 4) ? PROG_WAIT_FOR
                                      : PROG_GET,
                  object);
    else if (choice < 8 && modes >> DUITE_W & 1)
        make_set(m, PROG_SET, object, make_one_in(m, 4));
    else if (choice < 10 && scope->made[object])
        make_free(m, place);
    else if (choice < 12 && make_has(m, PROG_REFUSALS))
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

        if (make_has(m, PROG_MEMORY) && scope->n_live && make_one_in(m, 5))
            make_one_in(m, 3) ? make_join(m) : make_split(m);
        else if (choice < 2 && scope->n < PROG_MAX_PARAMS + 9)
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
        if (make_allowed(scope->right[i]) && scope->n_live < MAX_LIVE)
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
    const int likely = asks || m->scope->depth > 0 || make_postpones(kernel, draft->n);

    if (!make_has(m, PROG_NESTS) || kernel->replicated || m->bodies >= MAX_BODIES ||
        (!likely && !make_one_in(m, 3)))
        return;
    if (scope.depth < depth)
        scope.depth = depth;
    enter(&scope, m->scope, kernel, draft);
    inner.bodies++;
    inner.n_splits = 0;
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
