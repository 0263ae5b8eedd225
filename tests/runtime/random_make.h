#ifndef TESTS_RUNTIME_RANDOM_MAKE_H
#define TESTS_RUNTIME_RANDOM_MAKE_H

#include "tests/runtime/random_program.h"

/* Shared by the files that make programs. */

enum { MAX_LIVE = 20, MAX_OPS = 420, MOST_BURST = 24, MOST_RECORDED = 24 };
enum { MAX_SPLITS = 3, MAX_GRAPHS = 4, MOST_REPEATED = 1000, MOST_ROUNDS = 3 };
enum { MOST_BEGUN = 5, MOST_AWAITED = 6 };
enum { MAX_DEPTH = 6, MAX_BODIES = 48, MOST_ACTIONS = 20 };

/* The objects that the main program, or a body, may use. */
struct make_scope {
    unsigned depth;                  /* 0: the main program */
    unsigned n;                      /* places of the table that are taken */
    unsigned n_live, live[MAX_LIVE]; /* places alive, oldest first */
    struct prog_object object[PROG_MAX_TABLE];
    duite_mode right[PROG_MAX_TABLE];
    enum prog_law law[PROG_MAX_TABLE]; /* by which it is held under cwp */
    int made[PROG_MAX_TABLE], written[PROG_MAX_TABLE];
    int part[PROG_MAX_TABLE]; /* it is one of another object, and is not freed */
};

struct maker {
    struct prog *prog;
    uint64_t random;
    struct make_scope *scope;
    struct prog_op *ops; /* of the list that is being made */
    size_t *n_ops;
    unsigned features;        /* a bit each */
    unsigned n_drawn;         /* kernels that do not serve one fork alone */
    unsigned most_live;       /* of the main program */
    unsigned unsettled;       /* objects from this number on may still follow another for certain */
    unsigned large;           /* one object in so many is large; 0: none */
    unsigned failing;         /* one body in so many fails; 0: none */
    unsigned pausing;         /* one body in so many wastes time; 0: none */
    unsigned sized;           /* one object in so many changes its size; 0: none */
    unsigned bodies;          /* that fork, so far */
    int plain;                /* forks postpone nothing */
    int refused;              /* one waits to be told; get_at tells it on one rank only */
    size_t split[MAX_SPLITS]; /* operations: the last one is joined first */
    unsigned n_splits;
    int adds;         /* a new kernel is not listed but added now */
    unsigned n_begun; /* gets that are to be ended, the oldest first: operations */
    size_t begun[MOST_BEGUN];
    size_t graph[MAX_GRAPHS]; /* what each graph recorded last: an operation; SIZE_MAX: freed */
};

unsigned make_below(struct maker *m, unsigned n);
int make_one_in(struct maker *m, unsigned n); /* never if n is 0 */
int make_has(const struct maker *m, enum prog_feature feature);
struct prog_op *make_push(struct maker *m, enum prog_kind kind, unsigned object);
unsigned make_draw_object(struct maker *m);
void make_new(struct maker *m);
/* The object at a place of the list of those alive is gone. */
void make_free(struct maker *m, unsigned place);

/* Kernels that any fork may have; others are made for one fork. */
void make_kernels(struct maker *m);
/* The modes that a right gives: a bit each. */
unsigned make_allowed(duite_mode right);
/* Returns whether one of n parameters is postponed. */
int make_postpones(const duite_kernel *kernel, unsigned n);

/* Chooses kernel and objects of a fork; returns whether there were enough. */
int make_draft(struct maker *m, struct prog_op *draft);
/* The same, with a kernel for what the scope allows; `first` is its first mode (NONE: any) and
 * `object` its first object (< 0: any). */
int make_fitting(struct maker *m, struct prog_op *draft, duite_mode first, int object);
/* An object that fits the next parameter of the draft; -1 if none was found. */
int make_parameter(struct maker *m, const struct prog_op *draft);
/* At times, gives the draft a body that makes calls; `depth` is that of its children at least, and
 * `asks` says that it begins with a get of its first object. */
void make_body(struct maker *m, struct prog_op *draft, unsigned depth, int asks);
/* Appends a fork of the kind of the draft. */
struct prog_op *make_push_fork(struct maker *m, const struct prog_op *draft);
void make_fork(struct maker *m);

/* Sets some object. */
void make_set(struct maker *m, enum prog_kind kind, unsigned object, int zeros);

/* Begins a get of some object that is ended later. */
void make_get_begin(struct maker *m);

/* One or two turns of the main program; splits an object; joins the one that was split last. */
void make_turns(struct maker *m);
void make_split(struct maker *m);
void make_join(struct maker *m);

/* Forks the same tasks again and again, MOST_REPEATED operations at most. */
void make_rounds(struct maker *m);

/* One operation on graphs; frees those that are left. */
void make_graph_operation(struct maker *m);
void make_graphs_free(struct maker *m);

#endif
