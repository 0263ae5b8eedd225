#ifndef DUITE_H
#define DUITE_H

/* duite: tasks that declare what they read and write, on threads and MPI ranks.
 *
 * A program makes shared objects, lists its kernels (a body and the access modes of its parameters)
 * and forks tasks. The runtime derives the dependences from the accesses in fork order, runs tasks
 * on its workers as they become ready, and moves objects between ranks as the accesses need. The
 * result is the one of running the tasks one after the other in fork order, to the last bit, for
 * any number of ranks and threads.
 *
 * Every rank runs the same program and forks the same tasks in the same order; a task runs on one
 * rank.
 *
 * Calls marked "collective" are made by all ranks in the same order; "local" calls concern this
 * rank only. Forking and everything that changes objects is done by the main thread.
 *
 * Every call returns DUITE_OK or a code; duite_message() then has the error message. A failed fork,
 * new, set, hint, colocate, free or call on a recorded graph does nothing. The first such error is
 * returned once more, with its message, by the next get, wait or stop, which otherwise does its
 * work: a program may check only these. (Calls from a body or another thread, DUITE_E_STATE, are
 * not remembered.) On several ranks a call that runs out of memory on one of them, or a failure of
 * MPI, ends the work of all. Then every rank's present or next blocking call returns the code, and
 * only duite_stop is left (duite_abandon if MPI failed or a rank is lost). The library never exits
 * or aborts, but for a body that does not return (duite_body). */

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#include <initializer_list>
extern "C" {
#endif

/* Codes. Positive codes belong to the bodies of the program and are passed on as they are. */
enum {
    DUITE_OK = 0,
    DUITE_E_ARGUMENT = -1, /* an argument that makes no sense: NULL, unknown type, too large */
    DUITE_E_MEMORY = -2,   /* out of memory */
    DUITE_E_OBJECT = -3,   /* no such object: never made, or already freed */
    DUITE_E_KERNEL = -4,   /* a kernel that was not listed at start, or one that is malformed */
    DUITE_E_ACCESS =
        -5, /* number of objects or type does not fit the kernel; one object twice in a task */
    DUITE_E_MPI = -6, /* an MPI call failed, or MPI gives less thread support than SERIALIZED */
    DUITE_E_DIFFERENT = -7, /* the ranks run different programs: other kernels, forks or options, or
                               a mapping that gives other homes */
    DUITE_E_STATE = -8, /* a call that is not allowed here: from a task's body, another thread or a
                           build, or between duite_mpi_begin and duite_mpi_end */
    DUITE_E_NOT_FREED = -9, /* stop found objects or graphs that were not freed */
    DUITE_E_SYSTEM = -10,   /* threads, topology: the operating system refused */
    DUITE_E_RIGHT = -11,    /* a task gives a child more than it holds itself (see duite_mode) */
    DUITE_E_LAW = -12,      /* a law that is malformed, not listed, or for another element type */
    DUITE_E_BINDING = -13,  /* what is bound to an object of a recorded graph does not fit it */
    DUITE_E_SIZE = -14,  /* an object grows beyond its maximum, or changes a size that is fixed */
    DUITE_E_CHECK = -15, /* checking mode: a body does not keep to what its kernel declares */
    DUITE_E_LOST = -17,  /* a rank is lost: killed, or its host cut off */
    DUITE_E_DEPTH = -18  /* bodies that wait are nested more deeply than the stack has room for */
};

/* The error message of the last call of this thread that failed; never NULL. Valid until the next
 * failure. Local. */
const char *duite_message(void);

/* What a code means, in a few words; for codes of bodies "error of the program". Local. */
const char *duite_code_text(int code);

typedef struct duite duite; /* a running runtime */

/* Names a shared object: a value, freely copied, the same on all ranks. */
typedef struct duite_object {
    uint32_t slot, generation;
} duite_object;

/* Names none; what duite_new leaves behind when it fails. */
#ifdef __cplusplus
#define DUITE_NO_OBJECT (duite_object{0, 0})
#else
#define DUITE_NO_OBJECT ((duite_object){0, 0})
#endif

/* Element types of objects. */
typedef enum duite_type {
    DUITE_BYTE = 1, /* bytes without arithmetic: accumulated into by a law of the program only */
    DUITE_I32,      /* sums of integers wrap around */
    DUITE_I64,
    DUITE_F32,
    DUITE_F64
} duite_type;

/* How a task uses a parameter. Under the first four modes the body uses it itself. Under the
 * postponed modes it only forks tasks that do: it starts without waiting for the object, and finds
 * no data. The mode is also a right, which says what the children may do:
 *
 *     holding     it may fork children with
 *     r rp        r rp
 *     w rw cw     none
 *     wp          w wp
 *     rwp         any
 *     cwp         cw cwp of the same law
 *
 * The main program, and a task on objects that it made itself, holds rwp. */
typedef enum duite_mode {
    DUITE_NONE = 0, /* ends a list of modes */
    DUITE_R,        /* reads */
    DUITE_W,        /* overwrites the whole object; finds unspecified bytes */
    DUITE_RW,       /* reads and writes */
    DUITE_CW,  /* accumulates: finds the law's neutral element (of sums: zeros), and what it leaves
                  is combined with the object (see duite_fork) */
    DUITE_RP,  /* postponed: children read */
    DUITE_WP,  /* children overwrite; if none does, zeros are left */
    DUITE_RWP, /* children read and write */
    DUITE_CWP  /* children accumulate, and so may the body (duite_contribute): one contribution, the
                  tree of all these; none if there are none */
} duite_mode;

/* ---- Laws ---- */

/* How contributions (cw) to an object combine: constant, alive from start to stop, listed at start
 * in the same order on every rank. Names are unique. A law must be pure; it need be neither
 * associative nor commutative, since the tree of contributions is fixed (see duite_fork).
 *
 * A law for bytes may see structures in them: count is always that of the whole object, in bytes
 * then, and values are aligned to 16 bytes. */
typedef struct duite_law {
    const char *name;
    duite_type type; /* of the objects it is for; 0: any but bytes */
    /* Writes count neutral elements, what a body finds under cw; NULL: zeros. */
    void (*neutral)(void *values, size_t count, duite_type type);
    /* left[i] becomes law(left[i], right[i]), for count elements; left is first in fork order. */
    void (*combine)(void *left, const void *right, size_t count, duite_type type);
} duite_law;

/* Built-in laws, for any type but bytes; they need no listing. Of equal elements (0 and -0 are
 * equal) min and max keep the first in fork order; NaN wins against all numbers, the last of
 * several NaNs. (A body that compares by < drops NaN itself.) */
extern const duite_law duite_sum, duite_min, duite_max;

/* ---- Kernels ---- */

typedef struct duite_param {
    void *data;   /* 64-byte aligned; const under DUITE_R; dies with the body; NULL if postponed */
    size_t count; /* elements; of an object that changes its size, if postponed, its maximum */
    duite_type type;     /* of the elements */
    size_t max;          /* elements there is room for under w and rw: see duite_resize */
    duite_object object; /* its name in this body, for its calls; no other task knows it */
} duite_param;

/* What a body is given. */
typedef struct duite_call {
    const void *args; /* the copy of the arguments made at the fork; NULL if the kernel has none */
    void *context;    /* as given at start */
    duite *rt;        /* for the calls a body may make: see "Tasks that fork" */
    const duite_param *param; /* n_params of them, in the order of the fork */
    size_t n_params;
    uint64_t round;  /* of the replay that forked the task, from 0; of all other tasks 0 */
    int rank;        /* where the task runs */
    unsigned worker; /* 0 is the main thread */
    struct duite_call_private *own;
} duite_call;

/* Parameter i of a call as elements of a C type: for reading, and (not under DUITE_R) for writing.
 */
#define duite_in(call, i, type)  ((const type *)(call)->param[i].data)
#define duite_out(call, i, type) ((type *)(call)->param[i].data)
#define duite_count(call, i)     ((call)->param[i].count)

/* A task's body. Returns 0, or a code of the program (not 0, better positive). After a code
 * everything the task writes is poisoned. Tasks that read it do not run and poison what they write
 * in turn, until a w, which does not read, overwrites it. The next duite_wait, and every duite_get
 * of something poisoned, returns the code on all ranks. A contribution that failed poisons the
 * object; contributing to a poisoned object is possible and does not heal it. What a body may call:
 * see "Tasks that fork".
 *
 * A body returns, since others wait for what it writes. If a C++ exception or the end of its thread
 * leaves it, or a law or a policy that a task calls, the process ends with a sentence. A longjmp
 * that leaves it is not noticed: the runtime waits for ever for the body to return. */
typedef int duite_body(const duite_call *call);

/* Gives the failure of a body its message (printf form, at most 200 bytes are kept). Returns code.
 */
int duite_fail(const duite_call *call, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Gives parameter i, w or rw of an object made by duite_new_sized, so many elements; those added
 * are zero. It begins with the size it was left with (rw), or with its maximum (w); what the body
 * leaves is what readers find. More than the maximum, and another parameter, is DUITE_E_SIZE: then
 * the task fails with that even if its body returns 0. */
int duite_resize(const duite_call *call, size_t i, size_t count);

/* A contribution of the body's own to parameter i, which it holds by cwp: elements as many, and of
 * the type, as param[i] says, the law's neutral elements (of sums: zeros). The body changes them
 * until it ends. What they are then counts as what a child forked at that moment with cw would
 * have left, in the same place of the tree; each call is another such child, but none that runs or
 * has a number. NULL: no memory, or another mode (DUITE_E_RIGHT): then the task fails with that
 * even if its body returns 0. Checking mode does not see writes beyond the elements. */
void *duite_contribute(const duite_call *call, size_t i);

enum { DUITE_MAX_ACCESS = 64 }; /* modes that a kernel lists, at most */

/* A kernel: constant, alive from start to stop, listed at start in the same order on every rank.
 * Names are unique. */
typedef struct duite_kernel {
    const char *name;
    duite_body *body;
    duite_mode access[DUITE_MAX_ACCESS]; /* modes of the first parameters, ended by DUITE_NONE */
    duite_mode variadic; /* mode of any number of further ones; DUITE_NONE: none allowed */
    size_t args_size;    /* bytes of arguments, copied at the fork; no pointers inside */
    int side_effects; /* 1: does more than write its parameters (files): checking mode runs it once
                       */
    int fixed; /* 1: its tasks run where duite_fork says, on no other rank, and an object that one
                  of the main program's ran for keeps its home: for bodies that need what only that
                  rank's context has. If a body forks such tasks, its own kernel says so, too */
    const duite_law
        *law[DUITE_MAX_ACCESS];    /* of the parameters with DUITE_CW or CWP; NULL: duite_sum */
    const duite_law *variadic_law; /* if variadic is DUITE_CW or CWP; NULL: duite_sum */
    int replicated;                /* 1: a task of the main program runs on every rank, see below */
} duite_kernel;

/* Replicated kernels: for small results that every rank needs, such as the scalars of an iteration.
 * Their tasks run on all ranks, each on a copy of what they read, so that nobody waits for a
 * message with the result; in a recorded graph only where the result is read. (In a task they run
 * there, as all its children do.) The body must leave the same bytes everywhere: it depends on what
 * it reads and on its arguments alone, not on call->rank, call->context or anything else that
 * differs. Modes are r, w and rw; no side effects (DUITE_E_KERNEL at start), and no rank is named
 * at the fork (DUITE_E_ARGUMENT). duite_counters count such a task once for each rank that runs it.
 */

/* ---- Start and stop ---- */

struct duite_scheduler; /* duite_policy.h */
struct duite_mapping;
struct duite_balancer;

enum { DUITE_MAX_THREADS = 4096 }; /* workers of a rank, at most */

typedef struct duite_options {
    MPI_Comm comm;                      /* who takes part; duplicated. Default MPI_COMM_WORLD */
    const duite_kernel *const *kernels; /* ended by NULL; the list is copied, the kernels are not */
    const duite_law *const *laws;       /* of the program, ended by NULL; default NULL: none */
    void *context;                      /* given to every body; may differ between ranks */
    unsigned threads; /* workers of this rank, the main thread among them; 0: one on each of its
                         cores (duite_cores), or fewer where OMP_NUM_THREADS or OMP_THREAD_LIMIT
                         say so. Default: DUITE_THREADS, else 0. At most DUITE_MAX_THREADS.
                         May differ between ranks */
    const struct duite_scheduler *scheduler; /* default: DUITE_SCHEDULER, else steal */
    const struct duite_mapping *mapping;     /* default: DUITE_MAPPING, else metis */
    const struct duite_balancer *balance;    /* default: DUITE_BALANCE, else none; see below */
    uint64_t seed;        /* of everything random in policies. Default: DUITE_SEED, else 1 */
    double spin_seconds;  /* how long an idle worker spins before it sleeps. Default 100e-6 */
    int bind;             /* bind workers to cores where the rank owns enough. Default 1 */
    size_t window;        /* max. tasks of this rank that are unfinished when a fork returns, see
                             duite_fork. Default 0: any number */
    double stuck_seconds; /* when nothing moves for so long, standard error tells who waits for
                             what, see below; 0: never. Default 60, or what DUITE_STUCK_SECONDS in
                             the environment says */
    double lost_seconds;  /* a rank that sends no heartbeat for so long is lost, see below; 0:
                             never. What rank 0 says counts for all. Default 8, or what
                             DUITE_LOST_SECONDS in the environment says */
    const char *trace; /* a file in which each rank writes down what happens, see duite_trace_step.
                          NULL: none. Default: DUITE_TRACE, else NULL */
    uint64_t trace_first, trace_end; /* steps that are written down: from trace_first on, before
                                        trace_end. Default: all, and what comes before them */
    int check; /* 1: checking mode, below. Default 0, or 1 with DUITE_CHECK=accesses in the
                  environment */
    int memo;  /* 1: repeated forks are recognised, see duite_fork; 0: they are not; 2: even where
                  bodies are long, for tests. Default 1, or 0 or 2 with DUITE_MEMO=0 or
                  DUITE_MEMO=always in the environment */
} duite_options;

/* The defaults, as the fields say; options begin with these, since zeros are no communicator and no
 * policies (DUITE_E_ARGUMENT). What the program sets afterwards counts first, then the variables of
 * the environment that the fields name, which are read here, then what is built in. A variable that
 * makes no sense (an unknown policy, text in place of a number) is an error of duite_start, which
 * names it, unless the program sets the field. Local. */
duite_options duite_options_default(void);

/* The built-in policies by name, or from a shared library if the name has a / in it
 * (duite_policy.h); NULL, and a message for duite_message, if there is none. Names: of all built-in
 * ones, the default first, ended by NULL, but for the adversaries for tests (the scheduler shuffle,
 * the balancers scatter and wander), which are found by name only. Local. */
const struct duite_scheduler *duite_scheduler_find(const char *name);
const struct duite_mapping *duite_mapping_find(const char *name);
const struct duite_balancer *duite_balancer_find(const char *name);
const char *const *duite_scheduler_names(void);
const char *const *duite_mapping_names(void);
const char *const *duite_balancer_names(void);

/* Delegation: with the balancer `delegate` a rank that has nothing to do asks others for ready
 * tasks, one rank at a time and ever less often. It is given tasks that are thought to take longer
 * than to send their inputs there and their outputs back. Of tasks with postponed parameters whose
 * fork did not say what they cost it is given one, that which has been ready for longest. Tasks
 * that may go are those whose fork named no rank and whose kernel has no side effects and does not
 * say `fixed`; in recorded graphs, those of rounds that are forked. One with postponed parameters
 * goes once what its children may read is there. What such a task forks runs on the same rank, or
 * goes on from there by the same rules, and what the children left goes home when they are over.
 * Bodies so run on whichever rank is idle. What they find by their context must serve on each rank,
 * and be there before the first such fork of any rank (set up on all of them, then a duite_wait).
 * Results and failures are the same; a failure names the rank on which the body ran. `scatter`
 * sends tasks anywhere, for tests. */

/* Migration: with the balancer `migrate` objects get other homes when the bodies of one rank's
 * tasks take longer than those of the others. A leader moves with all that follow it, and with all
 * its tasks, since these run where their objects live. Homes change at the beginning of a replay,
 * and only there: of the second one (duite_replay and duite_replay_while, of any graph), and then
 * ever less often while nothing moves. Such a replay waits, like duite_wait, for all tasks forked
 * so far, on all ranks. Recorded graphs stay as they are; what a rank has of objects that leave is
 * freed. Objects keep their home if a task of the main program ran for them whose kernel says
 * `fixed`; tasks whose fork named a rank run there whatever moves. Results are the same. `wander`
 * moves objects, and tasks, anywhere at any replay, for tests. */

/* Checking mode: each body works on private copies of its parameters, between guard pages that are
 * taken away afterwards, and runs twice if it has no side effects and forks nothing. The task fails
 * with DUITE_E_CHECK if it writes to an r parameter or to its arguments, goes beyond the ends of a
 * parameter, or uses memory that an earlier task was given. A read that ends near enough not to
 * fault is found if what the body leaves depends on it, and the body runs twice. It also fails if
 * it leaves bytes of a w parameter unwritten, or writes other bytes the second time. The message
 * names the task, the parameter and the byte. Results of correct programs are the same, at many
 * times the cost. Other memory (globals, heap) is not watched, and a body that faults is left by a
 * jump: what it held stays held. The signals SIGSEGV and SIGBUS are the runtime's meanwhile; faults
 * that are none of these go on to the handler there was. */

/* A standstill: the main program waits (in a get, a wait, a stop, or a fork, for the window), or is
 * in a function of a policy that is not built in, and for options.stuck_seconds no task of this
 * rank began or ended and no message came. Then this rank writes to standard error, in at most 20
 * lines, what the main program waits for, which functions of policies have not returned, which
 * bodies run, which tasks wait for them, and which wait for objects from which rank. A long body
 * looks the same; nothing is changed or ended. It is reported again once it lasts twice as long.
 * Tasks that wait for nothing which can be found are reported, too: a body may have written beyond
 * its objects, and DUITE_CHECK=accesses names such a body. */

/* A lost rank: on several ranks a thread of each sends the next rank a heartbeat sixteen times in
 * options.lost_seconds, however busy its workers and however large its messages are. A rank that
 * died, was cut off, or was stopped for so long, is lost. The time in which the one that listens
 * was stopped itself does not count. Then every blocking call of all ranks that can still be
 * reached returns DUITE_E_LOST, as soon as the bodies that run are over; duite_message() names the
 * rank and its host. Only duite_abandon is left, and MPI may not be called any more: the program
 * saves what it can and ends. (Open MPI may end the job first, with a message of its own.) */

/* Starts a runtime. Initialises MPI (thread support SERIALIZED) if the caller has not. On several
 * ranks its workers call MPI at any time until duite_stop: a program that calls MPI meanwhile needs
 * MPI_THREAD_MULTIPLE. One runtime at a time in a process, unless it has MPI_THREAD_MULTIPLE
 * (DUITE_E_STATE, on this rank). Collective over comm. On failure *rt is NULL on all ranks. Where
 * another rank failed, the code is DUITE_E_MEMORY if it had no memory, else DUITE_E_DIFFERENT; the
 * message is that of the rank that failed, with its number. */
int duite_start(duite **rt, const duite_options *options);

/* Waits for all tasks, ends the workers and frees everything; start and stop may repeat. MPI, if
 * start initialised it, is finalised when the process ends; a process that ends without a stop
 * leaves it unfinalised, and mpirun ends the job. Returns the error that a wait would, else
 * DUITE_E_NOT_FREED if objects or graphs are left; *rt becomes NULL whatever is returned. Where it
 * may not be called (in a body or a build function, between duite_mpi_begin and duite_mpi_end) it
 * does nothing and returns DUITE_E_STATE. Collective. */
int duite_stop(duite **rt);

/* Frees the runtime without the other ranks, after DUITE_E_LOST or DUITE_E_MPI (else:
 * DUITE_E_STATE): begins no call of MPI that waits. What MPI may still read or write stays
 * allocated, and MPI is not finalised when the process ends, even if duite_start initialised it;
 * so mpirun ends the job. *rt becomes NULL. duite_stop, called in its place, does the same and
 * returns the code. Local. */
int duite_abandon(duite **rt);

/* For calls of MPI by the program itself (a solver, parallel files). As long as the runtime is
 * there, even when no task is left, they stand between these two, since workers and heartbeats call
 * MPI at any other time. Only under MPI_THREAD_MULTIPLE they need no begin and end. Begin waits
 * until nobody of this rank is inside MPI. Until the end tasks run on, but nothing is sent or
 * received, and all other calls of the main program are refused and remembered (DUITE_E_STATE). So
 * all ranks call duite_wait first: else a rank in duite_get may need what this one has not sent,
 * and a call of MPI that waits for that rank never returns. A rank that stays longer than
 * lost_seconds is taken for lost by ranks that are outside meanwhile. Errors: DUITE_E_STATE (begun
 * twice, ended without begin). Local. */
int duite_mpi_begin(duite *rt);
int duite_mpi_end(duite *rt);

/* This rank, the number of ranks, the workers of this rank. Local. */
int duite_rank(const duite *rt);
int duite_ranks(const duite *rt);
unsigned duite_threads(const duite *rt);

/* How many cores are this rank's: the least of its share of the cores that the ranks of its host
 * may use, its share of what a cgroup's quota or SLURM_CPUS_ON_NODE leaves of them, and
 * SLURM_CPUS_PER_TASK. *from, unless from is NULL: what said so, for people, such as
 * "SLURM_CPUS_PER_TASK=1"; it stays until duite_stop. Where a rank is given fewer cores than it may
 * use its workers are not bound. Local. */
unsigned duite_cores(const duite *rt, const char **from);

/* 1 if the workers of this host outnumber the cores they may use, or those of this rank its own:
 * then they neither spin nor bind. Local. */
int duite_oversubscribed(const duite *rt);

/* ---- Shared objects ---- */

/* Makes an object of count elements, at least 1 (DUITE_E_ARGUMENT), all zero. Collective; no
 * communication. */
int duite_new(duite *rt, duite_type type, size_t count, duite_object *object);

/* Makes an object whose size changes: 0 to `max` elements (at least 1), count zeros to begin with.
 * Bodies under w and rw find room for `max` and say how many there are (duite_resize); readers,
 * messages and gets have as many as there are. It cannot be accumulated into (cw: DUITE_E_ACCESS).
 * Collective; no communication. */
int duite_new_sized(duite *rt, duite_type type, size_t count, size_t max, duite_object *object);

/* Frees an object after the last earlier access; `object` names nothing afterwards. Collective. */
int duite_free(duite *rt, duite_object object);

/* Overwrites the object, in fork order, with a copy of `values` (count elements, the same on every
 * rank), or with zeros if `values` is NULL. Collective; returns at once. */
int duite_set(duite *rt, duite_object object, const void *values);

/* The same with so many values: as many as the object has, or at most its maximum if its size
 * changes (duite_set gives it its maximum); else DUITE_E_SIZE. Collective; returns at once. */
int duite_set_sized(duite *rt, duite_object object, const void *values, size_t count);

/* How many elements the object has, as the tasks forked so far leave it. Waits, and returns errors,
 * like duite_get; a duite_get afterwards need not wait. Collective. */
int duite_get_count(duite *rt, duite_object object, size_t *count);

/* Copies the object, as the tasks forked so far leave it, into `values` (count elements) on every
 * rank. Returns when the bytes are there; other tasks go on. Of a poisoned object: the code of the
 * failure that is first in fork order among those it descends from, and `values` stays as it was.
 * If it waits long because the ranks did not make the same calls: DUITE_E_DIFFERENT, as of
 * duite_wait. Collective. */
int duite_get(duite *rt, duite_object object, void *values);

/* The same on one rank only; the others ignore `values` and return DUITE_OK at once, even if the
 * object is poisoned, so a program may not branch on the result. Collective. */
int duite_get_at(duite *rt, duite_object object, int rank, void *values);

/* Tells mappings about the object: its share of work, and the bytes it exchanges with n neighbours,
 * which exist already (edge_weights NULL: 1 each). An edge may be given from either end; given
 * twice it adds up. A second hint replaces the weight and adds edges. Hints count until
 * the next fork, set, get, free, duite_home, duite_graph_new or replay (of an empty graph too)
 * after the object was made settles its home, and change nothing later. Collective. */
int duite_hint(duite *rt, duite_object object, double weight, size_t n,
               const duite_object *neighbours, const double *edge_weights);

/* The object gets the home of `leader` (or of its leader in turn), whatever the mapping; counts
 * like a hint. Following in a ring is DUITE_E_ARGUMENT. Collective. */
int duite_colocate(duite *rt, duite_object object, duite_object leader);

/* Settles the homes of all objects made so far, as a fork does, and returns the rank that
 * keeps this one; -1 for no such object. The answer holds until the next replay if options.balance
 * moves objects, else until the object is freed. Collective. */
int duite_home(duite *rt, duite_object object);

/* 1 if this rank keeps the object or has a copy of it as the tasks forked so far leave it; else 0.
 * If all objects of a fork are 0 here, the fork is only counted here: it must still be called, but
 * its `args` are not read and need not be computed (any pointer will do, but not NULL, which this
 * rank alone would refuse: then the ranks differ). This does not hold for forks that name this rank
 * or have a replicated kernel, for forks in a build function, or on rank 0 for tasks that read and
 * write nothing (no objects, or cw alone). 1 of what is no object. Settles homes, like duite_home.
 * Collective as that is. */
int duite_is_local(duite *rt, duite_object object);

/* ---- Tasks ---- */

/* Forks that follow name these n objects: what forks look at of them comes into the cache
 * meanwhile. For main programs that fork tasks on tens of thousands of objects, a few tasks ahead;
 * it changes nothing else. Names of no object are passed over. Main program. Local. */
void duite_prefetch(const duite *rt, size_t n, const duite_object *objects);

/* Forks a task on n objects, in the order of the kernel's modes; a task names an object once.
 * `args` points to the kernel's args_size bytes; it is NULL if these are 0, and only then
 * (DUITE_E_ARGUMENT). It runs where its first w or rw object lives, else its first r object, else
 * on rank 0. Contributions (cw) between two other accesses of an object (by tasks, set, get or
 * free; waits do not count) combine in fork order by a fixed tree. Complete subtrees combine as in
 * a binary counter, the rest folds from the right. Then the result is combined with the object:
 * under a sum old + (A + (B + C)). Contributions of another law are another access. Collective;
 * returns at once, unless options.window is set and more tasks of this rank than that are
 * unfinished. Then the main thread works, and the fork returns when they are at most so many. Tasks
 * that the runtime adds to combine, send and copy count. A replay is one task, but the tasks of a
 * round that is forked count each. The window bounds the memory of a program that forks far ahead,
 * and changes no result. Such a fork may wait for other ranks, as a get does: they must not wait
 * for this one outside of duite.
 *
 * A program of one rank that forks the same tasks round after round has them replayed, as if it had
 * recorded them: same results, failures and task numbers, in less time. Recognised are up to 4,096
 * forks a round without options, of kernels of up to 16 parameters under r, w and rw that write
 * something, on objects of fixed size; arguments may change. A kernel that
 * accumulates, postpones, is replicated or allows further parameters (variadic) is left out, and so
 * is each round that it is part of. Any other call of the main program ends it, and it begins again
 * after two equal rounds. It needs bodies that have run, to know that they are short: on one thread
 * with window 0 none runs before the first get or wait, and nothing is recognised. Rounds whose
 * arguments come to more than 1 MiB ahead of the bodies are forked. Neither in checking mode
 * nor with a trace. options.memo switches it off. */
int duite_fork(duite *rt, const duite_kernel *kernel, const void *args, size_t n,
               const duite_object *objects);

/* The same on a rank of the caller's choice: for kernels with side effects, such as files. */
int duite_fork_at(duite *rt, int rank, const duite_kernel *kernel, const void *args, size_t n,
                  const duite_object *objects);

/* What a program may say of a task at its fork; fields left out are 0. */
typedef struct duite_task_options {
    const int *at;    /* the rank that runs it, as of duite_fork_at; NULL: as duite_fork chooses */
    int32_t priority; /* of ready tasks the scheduler `priority` takes the one with the largest */
    double cost;      /* seconds that the body is thought to take; 0 or less: not known */
} duite_task_options;

/* duite_fork, with what the program knows of the task (options NULL: nothing): duite_fork_with(rt,
 * &(duite_task_options){.priority = 3, .cost = 2e-5}, ...). Priority and cost are handed to
 * schedulers (duite_ready) and never change results; replays of a recorded fork have them, too.
 * They may differ between ranks, as measured costs do: those of the rank that runs the task count.
 * Errors as of duite_fork_at. Collective; returns at once. */
int duite_fork_with(duite *rt, const duite_task_options *options, const duite_kernel *kernel,
                    const void *args, size_t n, const duite_object *objects);

/* duite_fork with the objects, and a structure of arguments, written out:
 * DUITE_FORK(rt, &AXPY, DUITE_ARGS(struct axpy, .alpha = 2, .first = 7), x, y). In C++ before C++20
 * the arguments have no names: DUITE_ARGS(axpy, 2, 7). */
#ifdef __cplusplus
} /* extern "C" */
/* What the two macros need: C++ has no temporary arrays. For them alone. */
struct duite_cpp {
    template <typename T> static const T *args(const T &written)
    {
        return &written;
    }
    static int fork(duite *rt, const duite_kernel *kernel, const void *args,
                    std::initializer_list<duite_object> objects)
    {
        return duite_fork(rt, kernel, args, objects.size(), objects.begin());
    }
};
#define DUITE_ARGS(type, ...)             duite_cpp::args<type>({__VA_ARGS__})
#define DUITE_FORK(rt, kernel, args, ...) duite_cpp::fork(rt, kernel, args, {__VA_ARGS__})
extern "C" {
#else
#define DUITE_ARGS(type, ...) (&(const type){__VA_ARGS__})
#define DUITE_FORK(rt, kernel, args, ...)                                                          \
    duite_fork(rt, kernel, args, sizeof((duite_object[]){__VA_ARGS__}) / sizeof(duite_object),     \
               (duite_object[]){__VA_ARGS__})
#endif

/* Waits for all tasks forked so far, on all ranks. Returns the error of the task that is first in
 * the reference order (a task, then its children) among those that failed themselves since the last
 * wait, the same on all ranks. If the ranks did not make the same calls since the last wait it
 * returns DUITE_E_DIFFERENT on all of them, and only duite_stop is left. (A remembered error goes
 * first; a task's is then returned by the next wait.) Collective. */
int duite_wait(duite *rt);

/* ---- Tasks that fork ----
 *
 * With call->rt, and on its own thread, a body may call: duite_new, duite_new_sized, duite_free;
 * duite_set, duite_set_sized, duite_get, duite_get_count; duite_fork, duite_fork_with (without a
 * rank), duite_wait, duite_resize, duite_contribute, duite_fail; and what describes the runtime
 * (duite_rank and the like). All others are DUITE_E_STATE, and so is any call from a thread of the
 * program's own. In a body the calls are local: children run on the rank of the task, unless a
 * balancer delegates them, and no other rank knows of them.
 *
 * Objects: a body names those it was given (param[i].object) and those it made. The table at
 * duite_mode says what it may fork its children with. More is DUITE_E_RIGHT, and so is an object of
 * the main program that it was not given. A duite_set needs the right to w, a duite_get that to r.
 * Objects that a task made die, freed or not, when its last descendant is over.
 *
 * Order: a body comes first, then its children in the order of their forks, each with all of its
 * descendants, then the next task of the one that forked it. What the children leave in a parameter
 * is passed on as soon as it is there; nobody waits for the rest of them.
 *
 * duite_get waits for the value that the children forked so far leave, duite_wait for all of these
 * with their descendants; what the body does afterwards comes after them. Meanwhile its thread runs
 * other tasks that come earlier, on the same stack: a body must not wait with a lock held. A wait
 * for which three quarters of the stack are used returns DUITE_E_DEPTH, and did not wait. A
 * duite_wait returns the error that is first in the reference order among the descendants since the
 * body's last wait. The next wait of the main program returns it, too. A failed child poisons what
 * it writes, no more: its parent fails only if it says so.
 *
 * Errors of calls that return at once are remembered for the body's next get or wait; if there is
 * none, the task fails with the first of them. */

/* ---- Recorded graphs ---- */

/* Names a recorded graph: a value, freely copied. */
typedef struct duite_graph {
    uint32_t slot, generation;
} duite_graph;

#define DUITE_NO_GRAPH ((duite_graph){0, 0})

/* Forks the tasks of one round. Called by duite_graph_new, and again when the graph is recorded
 * again; then it must find in its context what the graph is to use from now on. Returns 0, or a
 * code that duite_graph_new or the replay returns. */
typedef int duite_build(duite *rt, void *context);

/* Records what build(rt, context) forks; nothing runs. Inside, duite_fork, duite_fork_at,
 * duite_fork_with and duite_set are kept, duite_home and the local calls answer; everything else is
 * DUITE_E_STATE. Makes nothing, and *graph is DUITE_NO_GRAPH, if build or a call inside fails:
 * returns the first error. A graph may be replayed any number of times; it is freed by
 * duite_graph_free. Collective; no communication. */
int duite_graph_new(duite *rt, duite_build *build, void *context, duite_graph *graph);

/* Forks the graph's tasks `rounds` times, one round after the other: the results, the failures and
 * the numbers of tasks are those of forking them by hand. The rounds run from a compiled form, in
 * which a task costs no allocation, lock or search, and a round begins where dependences allow
 * before the last one is over. On several ranks a rank sends each other rank at most one message a
 * phase and round. The first phase carries what is made without other ranks, the second what is
 * made from that, and so on; contributions are part of these messages. What the rounds only read is
 * moved before the first one. The tasks forked before and after it that use the same objects wait
 * for the replay as a whole. Some rounds are forked instead: all of them if the size of an object
 * changes, if a mode is postponed, or if contributions of one round and the next are one sum; the
 * first or the last one if its contributions are one sum with those forked before or after the
 * replay. If an object that the graph uses was freed, build is called again first, and bindings and
 * arguments are those it makes. Errors of that, and DUITE_E_BINDING. rounds times tasks is at most
 * 2^48. Collective; returns at once, but for two cases: a balancer may move objects, and the tags
 * of MPI may be used up (after some 10,000 graphs where MPI has 32,767, the least it may have).
 * Then a replay waits for all tasks, like duite_wait. */
int duite_replay(duite *rt, duite_graph graph, uint64_t rounds);

/* Replays while the first element of `flag`, an object that the graph uses or any other, is not
 * zero after a round: at least one round, at most `max_rounds`. A flag that is poisoned ends it.
 * Tasks forked later are numbered as if there had been `max_rounds`. All ranks must be able to read
 * the flag: written by a replicated kernel it costs no message. Collective; returns at once, or, if
 * the rounds are forked (duite_replay), when the last one is. */
int duite_replay_while(duite *rt, duite_graph graph, duite_object flag, uint64_t max_rounds);

/* Waits for the last replay of the graph and writes how many rounds it had; 0 before the first.
 * Collective. */
int duite_graph_rounds(duite *rt, duite_graph graph, uint64_t *rounds);

/* Changes a graph from its next replay on. duite_graph_args: the arguments of the k-th fork of
 * build (from 0; sets do not count) are a copy of the args_size bytes at args. duite_graph_bind:
 * `object` is used wherever build named `recorded`, until another one is bound to it. The object
 * has the same type and count, else DUITE_E_BINDING; two recorded objects bound to one are an error
 * (DUITE_E_BINDING) of the replay, so that they may be exchanged. Collective. */
int duite_graph_args(duite *rt, duite_graph graph, size_t k, const void *args);
int duite_graph_bind(duite *rt, duite_graph graph, duite_object recorded, duite_object object);

/* Frees a graph; replays that are on their way come to their end. Collective. */
int duite_graph_free(duite *rt, duite_graph graph);

/* ---- Traces ----
 *
 * With options.trace a run leaves the files trace, trace.1, trace.2 and so on, one a rank: what
 * each worker did when, and what the main program called. Files of these names are replaced.
 * duite-trace turns them into the forms of viewers, duite-predict works out what the run would take
 * elsewhere. If the file cannot be made, duite_start fails; if it cannot be written later on, or is
 * removed or replaced, the run goes on, what was written is kept, and duite_trace_end returns the
 * error. */

/* Step `step` of the program begins, counted from 0. What was written down is brought to the file,
 * and recording begins or ends if options.trace_first or trace_end say so. Only when it begins or
 * ends the call waits, like duite_wait, for all tasks forked so far; it leaves their errors to the
 * next wait. Does nothing without a trace. Collective. */
int duite_trace_step(duite *rt, uint64_t step);

/* The trace ends; duite_stop sees to that, too. Waits for all tasks forked so far, as
 * duite_trace_step. DUITE_E_SYSTEM: this rank's file is not whole, or is there no more, for the
 * reason that the message gives. Does nothing without a trace, and the second time. Collective. */
int duite_trace_end(duite *rt);

/* ---- Counters ---- */

typedef struct duite_counters {
    uint64_t tasks;    /* bodies run; not those that poison kept from running */
    uint64_t placed;   /* tasks put in a queue by the scheduler */
    uint64_t stolen;   /* tasks taken from another worker's queue */
    uint64_t chained;  /* tasks run inline: directly after the one that made them ready */
    uint64_t messages; /* sent between ranks */
    uint64_t bytes;    /* sent between ranks, headers included */
    double busy;       /* seconds in bodies, over all workers */
    double idle;       /* seconds without a task, over all workers, up to each one's last task */
    uint64_t graphs_recorded; /* calls of build functions; the same on every rank, counted once */
    uint64_t delegated;       /* tasks that ran on another rank than duite_fork says */
    double awaited; /* seconds in which a rank awaited messages, times its workers, over all ranks:
                       from the fork of the task that needs one, or the get, until it is there */
    double exposed; /* the part of `awaited` in which those workers had no task */
    uint64_t migrated;   /* objects that got another home; the same on every rank, counted once */
    uint64_t stolen_far; /* those of `stolen` that came from a worker farther away than the nearest
                            one (duite_near) */
    uint64_t recognised; /* tasks whose forks were recognised as those of an earlier round */
    uint64_t recognised_rounds; /* whole rounds of these */
} duite_counters;

/* Sums over all workers and ranks since start. After a duite_wait the counts are exact. Collective.
 */
int duite_count_all(duite *rt, duite_counters *counters);

#ifdef __cplusplus
}
#endif

#endif
