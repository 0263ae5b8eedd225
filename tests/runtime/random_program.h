#ifndef TESTS_RUNTIME_RANDOM_PROGRAM_H
#define TESTS_RUNTIME_RANDOM_PROGRAM_H

/* Random programs against duite.h: made from a seed, interpreted one task after the other from the
 * contract alone, run on the runtime, compared bit for bit. The interpreter shares with the runtime
 * nothing but the arithmetic of the bodies.
 *
 * The main program and each body are lists of operations on a table of objects. That of the main
 * program has its objects as they are made, that of a body its parameters and then its own. */

#include <duite.h>
#include <duite_policy.h>

#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>

enum { PROG_MAX_PARAMS = 32, PROG_MAX_KERNELS = 40, PROG_ARGS_PADDING = 64 };
enum { PROG_MAX_TABLE = 48 }; /* objects of the main program, or of a body */
enum { PROG_MAX_PARTS = 3 };

/* Most features come by chance; all may be forced to be there or not. */
enum prog_feature {
    PROG_NESTS,    /* bodies fork, set, get, wait, make objects; postponed modes */
    PROG_GRAPHS,   /* records and replays graphs */
    PROG_REPEATS,  /* forks the same tasks again and again; on one rank only */
    PROG_SIZES,    /* objects that change their size */
    PROG_FAILURES, /* bodies fail */
    PROG_REFUSALS, /* forks that are refused */
    PROG_LARGE,    /* large objects */
    PROG_MEMORY,   /* adopted memory, turns of the main program, sets of one rank; parts, in bodies,
                      too */
    PROG_ADDS,     /* kernels are added */
    PROG_N_FEATURES
};
extern const char *const prog_features[PROG_N_FEATURES];

enum prog_kind {
    PROG_SKIP, /* left out by shrinking */
    PROG_NEW,
    PROG_FREE,
    PROG_SET,
    PROG_FORK, /* at a rank if rank >= 0 */
    PROG_GET,
    PROG_GET_AT,
    PROG_COUNT, /* get_count */
    PROG_WAIT,
    PROG_WAIT_FOR,   /* n objects; in a body one */
    PROG_TEST,       /* n objects; until they are there if `count` is not 0 */
    PROG_GET_BEGIN,  /* ended by operation `body`, or not at all */
    PROG_GET_END,    /* of the get that operation `body` began */
    PROG_KERNEL,     /* adds kernel number `kernel`, before its first fork */
    PROG_CONTRIBUTE, /* in a body: its own contribution to a parameter under cwp */
    PROG_HINT,
    PROG_FOLLOW,
    PROG_HOME,
    PROG_WRONG,   /* a fork that must be refused; the next get or wait returns its error once more.
                     Without one a body fails with it */
    PROG_ACQUIRE, /* by `mode`; what is written stands there at the release */
    PROG_RELEASE,
    PROG_SPLIT, /* into objects[] */
    PROG_JOIN,  /* of these; what a body has split and not joined is joined when it ends */
    PROG_GRAPH, /* records what follows it: `n` operations of the next two kinds */
    PROG_GRAPH_FORK,
    PROG_GRAPH_SET,
    PROG_GRAPH_AGAIN,  /* what follows it is recorded, should the graph have to be recorded again */
    PROG_REPLAY,       /* `count` rounds */
    PROG_REPLAY_WHILE, /* while `object` holds, at most `count` rounds */
    PROG_ROUNDS,
    PROG_GRAPH_ARGS, /* gives the fork that is operation `count` another seed and failure */
    PROG_GRAPH_BIND, /* objects[0] in place of `object` */
    PROG_GRAPH_FREE
};

/* Two of the laws are the program's own: one for numbers, one for bytes. */
enum prog_law { PROG_SUM, PROG_MIN, PROG_MAX, PROG_MIX, PROG_WEAVE, PROG_N_LAWS };

/* Objects by their place in the table; no place is used twice. */
struct prog_op {
    enum prog_kind kind;
    unsigned object;
    unsigned n, objects[PROG_MAX_PARAMS]; /* fork: parameters; hint: neighbours; follow: the leader;
                                             waits for some and tests */
    unsigned kernel;
    size_t body, n_inner; /* fork: what the body does: n_inner operations of prog->inner */
    unsigned number;      /* forks: no other fork has it */
    int rank;             /* fork, get_at, set; new: that of its adopted memory; -1: none named */
    duite_mode mode;      /* acquire */
    duite_type type;      /* new */
    size_t count; /* new: elements; set: of an object whose size changes; graphs: see there */
    size_t max;   /* new: elements at most, 0: the size is fixed */
    size_t part[PROG_MAX_PARTS]; /* split: the elements of each */
    uint64_t seed;  /* set, acquire, adopted: of the values, 0: zeros; fork: of the body */
    unsigned pause; /* fork: how the body wastes time */
    int fails;      /* fork: the code the body returns */
    unsigned
        exceeds;   /* fork: parameter + 1 that the body gives more elements than it may; 0: none */
    int sometimes; /* fork: it fails, or ends flags, depending on what it reads */
    int ends;      /* fork: now and then zeros the first element of what it writes */
    int32_t priority; /* fork */
    double cost;      /* fork; < 0: neither is said */
    unsigned graph;   /* graphs: by the order in which they are made */
    double weight;    /* hint */
};

/* A body is told this, and asks the program only for its calls. */
struct prog_args {
    uint64_t seed;
    size_t body, n_inner;
    int fails, rank;
    uint8_t sometimes, ends, holds; /* holds: its kernel has events */
    uint8_t adopts;                 /* any object may have adopted memory */
    unsigned pause, number, n, exceeds;
    uint32_t count[PROG_MAX_PARAMS], max[PROG_MAX_PARAMS]; /* most 0: the size is fixed */
    uint8_t type[PROG_MAX_PARAMS], mode[PROG_MAX_PARAMS], law[PROG_MAX_PARAMS];
    char padding[PROG_ARGS_PADDING]; /* kernels copy some of it, so that argument sizes vary */
};

struct prog_object {
    duite_type type;
    size_t count, max; /* most 0: the size is fixed */
    int leader;        /* follows this object for certain; -1: none */
    int adopted;       /* its memory is the program's, on this rank + 1; 0: it is not */
};

struct prog {
    uint64_t seed;
    int n_ranks;
    int adopts; /* some objects have adopted memory */
    size_t n_kernels, n_listed, n_ops, n_inner, n_objects, n_forks, n_graphs;
    char name[PROG_MAX_KERNELS][16];
    duite_kernel kernel[PROG_MAX_KERNELS];
    const duite_law *law[PROG_MAX_KERNELS][DUITE_MAX_ACCESS];
    const duite_kernel *list[PROG_MAX_KERNELS + 1]; /* without those that are added */
    struct prog_op *ops, *inner;                    /* of the main program; of all bodies */
    struct prog_object objects[PROG_MAX_TABLE];
};

/* The right answer of an operation. */
struct prog_expect {
    int code;
    unsigned char *bytes; /* get, get_at, acquire, free of adopted memory: the object; NULL if it is
                             poisoned */
    size_t count;         /* the same, get_count: its elements */
    uint64_t rounds;      /* rounds: how many */
};

struct prog_answers {
    struct prog_expect *op; /* n_ops */
    unsigned char *runs;    /* n_forks: how often the body runs, modulo 256 */
    uint64_t n_runs, n_recorded;
    int stop;
};

/* Bodies share this on one rank. */
struct prog_context {
    int rank, n_ranks;
    unsigned threads;
    struct run *run;   /* random_run.h */
    atomic_uchar *ran; /* n_forks: how often a body ran on this rank */
    atomic_int wrong;  /* the first thing a body found wrong: a line of random_bodies.c, ... */
    atomic_int code;   /* ... or the code of its wrong call, which is that operation's kind */
};

struct prog_setup {
    MPI_Comm comm;
    unsigned threads;
    const char *scheduler, *mapping, *balance;
    uint64_t seed;
    double spin;
    size_t window;
    int memo, check;
    int verbose;
};

/* The first wrong thing that a run found: an empty text if all is as it should be. */
struct prog_report {
    size_t op;
    uint64_t recognised; /* tasks, on this rank */
    char text[600];
};

/* Zeroed memory; without any, the job ends. */
void *prog_memory(size_t n, size_t size);

/* A program for n_ranks ranks, with and without such features (a bit each). The same on every rank.
 */
struct prog *prog_make(uint64_t seed, int n_ranks, unsigned with, unsigned without);
void prog_free(struct prog *prog);
/* An operation of the main program with the bodies of its tasks. */
void prog_print(FILE *file, const struct prog *prog, size_t op);
void prog_print_element(duite_type type, const void *data, size_t i, char *text, size_t size);
/* The mode of parameter i of a kernel. */
duite_mode prog_mode(const duite_kernel *kernel, size_t i);

static inline int prog_is_fork(const struct prog_op *op)
{
    return op->kind == PROG_FORK || op->kind == PROG_GRAPH_FORK;
}
static inline int prog_is_postponed(duite_mode mode)
{
    return mode >= DUITE_RP;
}

/* The body of every kernel: reads, then makes its calls (random_calls.c), then writes. */
int prog_body(const duite_call *call);
/* Its two ends, and what it learns from a call: all goes into a hash. With a NULL context nothing
 * is checked, counted or wasted, and the sizes of parameters are changed by hand. */
uint64_t prog_body_begin(const duite_call *call);
int prog_body_end(const duite_call *call, uint64_t hash);
uint64_t prog_body_told(uint64_t hash, int code, const void *bytes, size_t n);
/* Keeps a wrong thing that a body found; code 0: at that line of random_bodies.c, else it is what
 * a call of that kind returned. */
void prog_body_wrong(struct prog_context *context, int line, int code);

size_t prog_size(duite_type type);
/* The values of a set. */
void prog_values(duite_type type, size_t count, uint64_t seed, void *values);
/* The arguments of a fork of objects of such shapes; the shapes of what a body is given. */
void prog_args_fill(const struct prog *prog, const struct prog_op *op,
                    const struct prog_object *shape, struct prog_args *args);
void prog_shapes(const struct prog_args *args, struct prog_object *shape);

/* Laws: their meaning; what a kernel's parameter i has; what the runtime is told. */
void prog_combine(enum prog_law law, duite_type type, size_t count, void *left, const void *right);
void prog_neutral(enum prog_law law, duite_type type, size_t count, void *values);
enum prog_law prog_law(const duite_kernel *kernel, size_t i);
const duite_law *prog_law_given(enum prog_law law);
extern const duite_law *const prog_own_laws[];

/* The recorded operation `index` of a graph is there and may be replayed. */
int prog_is_recorded(const struct prog *prog, size_t index);
/* The begin and the end of a get are both there: else it never is. */
static inline int prog_is_got(const struct prog *prog, const struct prog_op *op)
{
    const enum prog_kind other = prog->ops[op->body].kind;

    return op->kind == PROG_GET_BEGIN ? other == PROG_GET_END : other == PROG_GET_BEGIN;
}
/* Does a recorded operation name the object? `first` is its graph's operation. */
int prog_records(const struct prog *prog, size_t first, unsigned object);

/* Interprets a program. */
struct prog_answers *prog_interpret(const struct prog *prog);
void prog_answers_free(const struct prog *prog, struct prog_answers *answers);

/* Runs a program and compares. Collective over the communicator; the reports differ between ranks.
 * `where` is kept up to date with the operation that is being run. */
void prog_run(const struct prog *prog, const struct prog_answers *answers,
              const struct prog_setup *setup, struct prog_report *report, volatile size_t *where);

#endif
