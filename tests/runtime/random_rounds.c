/* Repetition in random programs: rounds of the same forks, but for what their bodies are told, that
 * end or change anywhere. A program of one rank then has them replayed without asking for it. */

#include "tests/runtime/random_make.h"

/* Most forks of a round; of all its rounds in a row. */
enum { MOST_ROUND = 20, MOST_TURNS = 60, MOST_FORKS = MOST_REPEATED - MOST_ROUND };

static int is_plain(const duite_kernel *kernel)
{
    int writes = 0, plain = kernel->variadic == DUITE_NONE && !kernel->replicated;

    for (unsigned i = 0; i < DUITE_MAX_ACCESS && kernel->access[i] != DUITE_NONE; i++) {
        plain &= kernel->access[i] <= DUITE_RW;
        writes |= kernel->access[i] != DUITE_R;
    }
    return plain && writes;
}

/* A fork that a round may have; now and then any. */
static int draw_step(struct maker *m, struct prog_op *draft)
{
    for (int attempt = 0; attempt < 40; attempt++) {
        *draft = (struct prog_op){.kind = PROG_FORK};
        if (make_draft(m, draft) &&
            (is_plain(&m->prog->kernel[draft->kernel]) || make_one_in(m, 400))) {
            make_body(m, draft, MAX_DEPTH - 1, 0);
            return 1;
        }
    }
    return 0;
}

static void push_step(struct maker *m, const struct prog_op *draft)
{
    struct prog_op *op = make_push_fork(m, draft);

    op->rank = -1;
    op->cost = make_one_in(m, 500) ? op->cost : -1; /* said by no option */
    op->fails = op->fails && make_one_in(m, 8) ? op->fails : 0;
    op->exceeds = 0;
    op->pause = op->pause && make_one_in(m, 8) ? op->pause : 0;
}

/* A task that begins at once and waits in its body for what it was lent. */
static void push_asker(struct maker *m)
{
    struct prog_op draft = {.kind = PROG_FORK};

    if (!make_fitting(m, &draft, make_one_in(m, 2) ? DUITE_RP : DUITE_RWP, -1))
        return;
    make_body(m, &draft, 1, 1);
    make_push_fork(m, &draft);
}

/* Something else in between. */
static void push_other(struct maker *m)
{
    const unsigned choice = make_below(m, 6);
    struct prog_op draft;

    if (choice == 0)
        make_push(m, PROG_GET, make_draw_object(m));
    else if (choice == 1)
        make_push(m, PROG_WAIT, 0);
    else if (choice == 2)
        make_set(m, PROG_SET, make_draw_object(m), make_one_in(m, 2));
    else if (draw_step(m, &draft))
        push_step(m, &draft);
    if (choice < 2)
        m->refused = 0;
}

void make_rounds(struct maker *m)
{
    struct prog_op round[MOST_ROUND], other;
    const size_t first = m->prog->n_ops;
    const unsigned n = 1 + make_below(m, make_one_in(m, 2) ? 4 : MOST_ROUND);
    const unsigned steady = make_one_in(m, 3) ? 0 : 20 + make_below(m, 400);

    for (unsigned i = 0; i < n; i++)
        if (!draw_step(m, &round[i]))
            return;
    for (unsigned turns = 1 + make_below(m, 3); turns > 0; turns--) {
        unsigned forks = 64 + make_below(m, n * MOST_TURNS), at = 0;

        while (forks-- > 0 && m->prog->n_ops - first < MOST_FORKS) {
            push_step(m, &round[at]);
            at = (at + 1) % n;
            if (make_one_in(m, steady))
                push_other(m);
            if (make_one_in(m, 8 * steady))
                at = make_below(m, n);
            if (make_one_in(m, 8 * steady) && draw_step(m, &other))
                round[make_below(m, n)] = other;
        }
        if (make_has(m, PROG_NESTS) && make_one_in(m, 2))
            push_asker(m);
        else
            push_other(m);
    }
}
