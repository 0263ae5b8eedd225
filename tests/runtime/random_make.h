#ifndef TESTS_RUNTIME_RANDOM_MAKE_H
#define TESTS_RUNTIME_RANDOM_MAKE_H

#include "tests/runtime/random_program.h"

/* What the files that make programs share. */

enum { MAX_LIVE = 20, MAX_MADE = 48, MAX_OPS = 420, MOST_BURST = 24, MOST_RECORDED = 24 };
enum { MAX_GRAPHS = 4, MOST_REPEATED = 1000, MOST_ROUNDS = 3 };

struct maker {
    struct prog *prog;
    uint64_t random;
    unsigned live[MAX_LIVE]; /* objects alive, oldest first */
    unsigned n_live, most_live;
    unsigned unsettled;       /* objects from this number on may still follow another for certain */
    unsigned large;           /* one object in so many is large; 0: none */
    unsigned failing;         /* one body in so many fails; 0: none */
    unsigned pausing;         /* one body in so many wastes time; 0: none */
    int wrong;                /* refused forks as well */
    int refused;              /* one waits to be told; get_at tells it on one rank only */
    unsigned sized;           /* one object in so many changes its size; 0: none */
    int graphs;               /* records and replays graphs */
    int repeats;              /* forks the same tasks again and again */
    size_t graph[MAX_GRAPHS]; /* what each graph recorded last: an operation; SIZE_MAX: freed */
};

unsigned make_below(struct maker *m, unsigned n);
int make_one_in(struct maker *m, unsigned n); /* never if n is 0 */
struct prog_op *make_push(struct maker *m, enum prog_kind kind, unsigned object);
unsigned make_draw_object(struct maker *m);

/* Chooses kernel and objects of a fork; returns whether there were enough. Then appends it, under
 * the kind of the draft. */
int make_draft(struct maker *m, struct prog_op *draft);
struct prog_op *make_push_fork(struct maker *m, const struct prog_op *draft);

/* Sets some object. */
void make_set(struct maker *m, enum prog_kind kind, int zeros);

/* Forks the same tasks again and again, MOST_REPEATED operations at most. */
void make_rounds(struct maker *m);

/* One operation on graphs; frees those that are left. */
void make_graph_operation(struct maker *m);
void make_graphs_free(struct maker *m);

#endif
