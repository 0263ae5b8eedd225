#ifndef TESTS_RUNTIME_RANDOM_INTERPRET_H
#define TESTS_RUNTIME_RANDOM_INTERPRET_H

#include "tests/runtime/random_cells.h"

/* The interpreter, shared by random_interpret.c, random_answers.c and random_replay.c only. */

/* The main program, or a task that runs. */
struct prog_frame {
    struct prog_frame *above;     /* NULL: the main program */
    const struct prog_op *ops;    /* what it does; those of a body that wait for the end of its */
    size_t first_pending, n_done; /* segment: from first_pending on, before n_done */
    struct prog_cell *cells;      /* its own, by place */
    struct prog_cell *object[PROG_MAX_TABLE]; /* of its table: its own or those above it */
    struct prog_object shape[PROG_MAX_TABLE];
    enum prog_law law[PROG_MAX_PARAMS];
    unsigned writes[PROG_MAX_PARAMS]; /* of what it was given, before it */
    struct prog_failure failed;       /* of its descendants since its last wait */
    int refused;                      /* the first refused call since the last get or wait */
    unsigned n_split;                 /* what a body has split and not joined, oldest first */
    const struct prog_op *split[PROG_MAX_TABLE];
};

/* A graph: its recorded operations, with the seeds and failures of now, and the object that stands
 * for each one. */
struct prog_graph {
    int alive, whole;
    size_t first, again; /* operations: what it recorded, and what it would record now */
    size_t n;
    struct prog_op *op;
    unsigned *bound; /* n_objects */
    uint64_t rounds; /* of the last replay */
};

struct prog_machine {
    const struct prog *prog;
    struct prog_answers *answers;
    struct prog_frame *main;
    struct prog_graph *graphs;
    uint64_t round; /* of the replay that runs, or 0 */
    unsigned place; /* in the reference order, of the next failure */
};

/* The task that a frame forks, and a set, with all that comes of it. */
void prog_interpret_fork(struct prog_machine *m, struct prog_frame *above, const struct prog_op *op,
                         uint64_t round);
void prog_interpret_set(struct prog_cell *cell, const struct prog_op *op);
int prog_interpret_refuse(struct prog_frame *frame, int code);
/* The parts take the value, or the poison; and give it back. */
void prog_interpret_split(struct prog_frame *frame, const struct prog_op *op);
void prog_interpret_join(struct prog_frame *frame, const struct prog_op *op);

/* The first call refused since the last get or wait, which tells it. */
int prog_interpret_told(struct prog_frame *frame);
int prog_interpret_wait(struct prog_frame *frame);
void prog_interpret_object(struct prog_frame *frame, const struct prog_op *op);

static inline int prog_is_failure(struct prog_failure failure)
{
    return failure.number != PROG_NO_FAILURE.number;
}

/* An operation of the main program on a graph. A graph that was left out is left alone. */
void prog_interpret_graph(struct prog_machine *m, const struct prog_op *op,
                          struct prog_expect *expect);
void prog_graph_end(struct prog_graph *graph);

#endif
