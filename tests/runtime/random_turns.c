/* The maker's turns of the main program on objects; and parts, also in bodies, which are joined
 * last first. */
#include "tests/runtime/random_make.h"

#include <string.h>

static void make_acquire(struct maker *m, unsigned place)
{
    struct prog_op *op = make_push(m, PROG_ACQUIRE, place);
    const struct prog_object *object = &m->scope->object[place];

    op->mode = (duite_mode)(DUITE_R + make_below(m, 3));
    op->count = object->max ? object->max : object->count;
}

/* One or two turns, which do not wait for each other; tasks are forked meanwhile. */
void make_turns(struct maker *m)
{
    const unsigned first = make_draw_object(m), second = make_draw_object(m);
    const int both = first != second && make_one_in(m, 3), adds = m->adds;

    m->adds = 0; /* that would wait */
    make_acquire(m, first);
    if (both)
        make_acquire(m, second);
    for (unsigned i = make_below(m, 4); i > 0; i--)
        if (make_one_in(m, 4))
            make_set(m, PROG_SET, make_draw_object(m), 0);
        else if (make_one_in(m, 4))
            make_get_begin(m);
        else
            make_fork(m);
    make_push(m, PROG_RELEASE, first);
    if (both)
        make_push(m, PROG_RELEASE, second);
    m->adds = adds;
}

/* Takes an object out of the list of those alive. */
static void make_dead(struct make_scope *scope, unsigned object)
{
    unsigned place = 0;

    while (scope->live[place] != object)
        place++;
    memmove(&scope->live[place], &scope->live[place + 1],
            (--scope->n_live - place) * sizeof *scope->live);
}

/* Two or three parts of an object that may be written as one likes; the last one gets what the
 * others leave. */
void make_split(struct maker *m)
{
    struct make_scope *scope = m->scope;
    const unsigned whole = make_draw_object(m);
    const struct prog_object *object = &scope->object[whole];
    const unsigned n = object->count > 2 ? 2 + make_below(m, PROG_MAX_PARTS - 1) : 2;
    size_t left = object->count;

    if (object->max || left < 2 || m->n_splits == MAX_SPLITS || scope->n + n > PROG_MAX_TABLE ||
        scope->n_live + n > MAX_LIVE || scope->right[whole] != DUITE_RWP)
        return;
    m->split[m->n_splits++] = *m->n_ops;
    struct prog_op *op = make_push(m, PROG_SPLIT, whole);

    make_dead(scope, whole);
    for (op->n = 0; op->n < n; op->n++) {
        const unsigned after = n - op->n - 1, part = scope->n++;
        const size_t count = after ? 1 + make_below(m, (unsigned)(left - after)) : left;

        left -= count;
        op->part[op->n] = count;
        op->objects[op->n] = part;
        scope->object[part] = (struct prog_object){object->type, count, 0, -1, 0};
        scope->right[part] = DUITE_RWP;
        scope->made[part] = scope->part[part] = 1;
        scope->live[scope->n_live++] = part;
    }
}

void make_join(struct maker *m)
{
    struct make_scope *scope = m->scope;

    if (!m->n_splits)
        return;
    const struct prog_op *split = &m->ops[m->split[--m->n_splits]];
    struct prog_op *op = make_push(m, PROG_JOIN, split->object);

    op->n = split->n;
    memcpy(op->objects, split->objects, sizeof op->objects);
    for (unsigned i = 0; i < op->n; i++)
        make_dead(scope, op->objects[i]);
    scope->live[scope->n_live++] = op->object;
}
