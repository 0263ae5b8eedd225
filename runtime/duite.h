#ifndef DUITE_H
#define DUITE_H

/* duite: tasks that declare what they read and write, on threads and MPI ranks.
 *
 * A program makes shared objects, lists its kernels (a body and the access modes of its parameters)
 * and forks tasks. The runtime derives the dependences from the accesses in fork order, runs tasks
 * on its workers as they become ready, and moves objects between ranks as the accesses need. The
 * result is that of running the tasks one after the other in fork order, to the last bit, for any
 * number of ranks and threads.
 *
 * Every rank runs the same program and forks the same tasks in the same order; a task runs on one
 * rank.
 *
 * All ranks make "collective" calls in the same order; "local" calls concern this rank only. The
 * main thread forks tasks and makes all changes to objects.
 *
 * Every call returns DUITE_OK or a code; duite_message() then has the error message. A failed fork,
 * new, set, hint, colocate, split, join, free or call on a recorded graph does nothing. The next
 * get, wait or stop does its work, but returns the first such error once more, with its message. So
 * a program may check only these. Calls from a body or another thread (DUITE_E_STATE) are not
 * remembered. On several ranks a call that runs out of memory on one of them, or a failure of MPI,
 * ends the work of all. Then every rank's present or next blocking call returns the code, and only
 * duite_stop is left (duite_abandon if MPI failed or a rank is lost). The library never exits or
 * aborts, except for a body that does not return (duite_body). */

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#include <initializer_list>
extern "C" {
#endif

/* The codes that calls return. Positive codes belong to the bodies of the program and are passed on
 * unchanged. Any call on a runtime may also return DUITE_E_ARGUMENT (no runtime), DUITE_E_STATE
 * (not allowed here), the remembered error, and the code that ended the work of all ranks. */
enum duite_code {
    DUITE_OK = 0,
    DUITE_E_ARGUMENT = -1, /* an argument that makes no sense: NULL, unknown type, too large */
    DUITE_E_MEMORY = -2,   /* out of memory */
    DUITE_E_OBJECT = -3,   /* no such object: never made, or already freed */
    DUITE_E_KERNEL = -4, /* a kernel that was neither listed nor added, or one that is malformed */
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
    DUITE_E_BINDING = -13,  /* an object bound to one of a recorded graph does not fit it */
    DUITE_E_SIZE = -14,  /* an object grows beyond its maximum, or changes a size that is fixed */
    DUITE_E_CHECK = -15, /* checking mode: a body does not keep to what its kernel declares */
    DUITE_E_LOST = -17,  /* a rank is lost: killed, or its host cut off */
    DUITE_E_DEPTH = -18  /* bodies that wait are nested more deeply than the stack has room for */
};

/* The error message of this thread's last failed call; never NULL. Valid until the next failure.
 * Local. Returns: text of the library. */
const char *duite_message(void);

/* The meaning of a code in a few words; for codes of bodies "error of the program". Local. Returns:
 * constant text. */
const char *duite_code_text(int code);

/* The version of the library that runs; DUITE_VERSION is that of this header: 10000 major + 100
 * minor + patch. A program runs with the library of its header and with later ones of the same
 * major version. These may know longer structures: the program says how long its own are, and what
 * lies beyond keeps its default. Local. Returns: the version. */
#define DUITE_VERSION 10000
int duite_version(void);

typedef struct duite duite; /* a running runtime */

/* Names a shared object: a value, freely copied, the same on all ranks. */
typedef struct duite_object {
    uint32_t slot, generation;
} duite_object;

/* Names no object; duite_new leaves it when it fails. */
#ifdef __cplusplus
#define DUITE_NO_OBJECT (duite_object{0, 0})
#else
#define DUITE_NO_OBJECT ((duite_object){0, 0})
#endif

/* Element types of objects. */
typedef enum duite_type {
    DUITE_BYTE = 1, /* bytes without arithmetic: only laws of the program accumulate into them */
    DUITE_I32,      /* signed integers; sums and products of integers wrap around */
    DUITE_I64,
    DUITE_F32, /* float */
    DUITE_F64, /* double */
    DUITE_I8,
    DUITE_I16,
    DUITE_U8, /* unsigned integers */
    DUITE_U16,
    DUITE_U32,
    DUITE_U64,
    DUITE_CF32, /* float complex, double complex */
    DUITE_CF64
} duite_type;

/* How a task uses a parameter. Under the first four modes the body uses it itself. Under the
 * postponed modes it only forks tasks that do: it starts without waiting for the object, and finds
 * no data. The mode is also a right. It limits the children:
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
    DUITE_CW,       /* accumulates: finds the law's neutral element (for sums: zeros); its result is
                       combined with the object (see duite_fork) */
    DUITE_RP,       /* postponed: children read */
    DUITE_WP,       /* children overwrite; zeros if none does */
    DUITE_RWP,      /* children read and write */
    DUITE_CWP /* children accumulate, and the body may (duite_contribute): one contribution, the
                 tree of all these; none if there are none */
} duite_mode;

/* ---- Laws ---- */

/* How contributions (cw) to an object combine. A law is constant, alive from start to stop, and
 * listed at start in the same order on every rank. Names are unique. A law must be pure; it need be
 * neither associative nor commutative, since the tree of contributions is fixed (see duite_fork).
 *
 * A law for bytes may see structures in them: count is always that of the whole object, in bytes
 * then, and values are aligned to 16 bytes (but for duite_adopt). */
typedef struct duite_law {
    const char *name;
    duite_type type; /* of the objects it is for; 0: any but bytes */
    /* Writes count neutral elements, which a body finds under cw; NULL: zeros. */
    void (*neutral)(void *values, size_t count, duite_type type);
    /* left[i] becomes law(left[i], right[i]), for count elements; left is first in fork order. */
    void (*combine)(void *left, const void *right, size_t count, duite_type type);
} duite_law;

/* Built-in laws, for any type but bytes; they need no listing. Min and max, which complex numbers
 * have not, keep the first of equal elements (0 and -0 are equal) in fork order; NaN wins against
 * all numbers, the last of several NaNs. (A body that compares by < drops NaN itself.) The last two
 * lines are for integers: of their bits, and of their truth, which is not 0: all and any leave 1 or
 * 0. */
extern const duite_law duite_sum, duite_product, duite_min, duite_max;
extern const duite_law duite_bits_and, duite_bits_or, duite_bits_xor;
extern const duite_law duite_all, duite_any;

/* The built-in law of a name ("sum", "min", "bits_and"), for programs in other languages. Local.
 * Returns: a constant table. NULL, and a message for duite_message, if there is no such law. */
const duite_law *duite_law_find(const char *name);

/* ---- Kernels ---- */

/* One parameter of a body. */
typedef struct duite_param {
    void *data;   /* 64-byte aligned, but for duite_adopt; const under DUITE_R; dies with the body;
                     NULL if postponed */
    size_t count; /* elements; the maximum for a postponed object that changes its size */
    duite_type type;     /* of the elements */
    size_t max;          /* room in elements under w and rw: see duite_resize */
    duite_object object; /* its name in this body's calls; unknown to other tasks */
} duite_param;

/* The input of a body. */
typedef struct duite_call {
    const void *args; /* the copy of the arguments made at the fork; NULL if the kernel has none */
    void *context;    /* as given at start */
    duite *rt;        /* for the body's calls: see duite_body */
    const duite_param *param; /* n_params of them, in the order of the fork */
    size_t n_params;
    uint64_t round;  /* of the replay that forked the task, from 0; else 0 */
    int rank;        /* where the task runs */
    unsigned worker; /* 0 is the main thread */
    struct duite_call_private *own;
} duite_call;

/* Parameter i of a call as elements of a C type: for reading, and (not under DUITE_R) for writing.
 */
#define duite_in(call, i, type)  ((const type *)(call)->param[i].data)
#define duite_out(call, i, type) ((type *)(call)->param[i].data)
#define duite_count(call, i)     ((call)->param[i].count)

/* A task's body. Returns 0, or a code of the program (not 0, better positive). A code poisons
 * everything that the task writes. Tasks that read it do not run and poison their own results,
 * until a w, which does not read, overwrites it. The next duite_wait, and every duite_get of a
 * poisoned object, returns the code on all ranks. A failed contribution poisons the object;
 * contributing to a poisoned object is possible and does not heal it. The calls of a body: see
 * below.
 *
 * A body must return, since others wait for its results. If a C++ exception or the end of its
 * thread leaves it, or a law or a policy that a task calls, the process ends with a sentence. The
 * runtime does not notice a longjmp out of a body and waits for ever for its return. */
typedef int duite_body(const duite_call *call);

/* Tasks that fork. With call->rt, and on its own thread, a body may call the following. Objects:
 * duite_new, duite_new_sized, duite_free, duite_set, duite_set_sized, duite_get, duite_get_count,
 * duite_split, duite_join. Tasks: duite_fork, duite_fork_with (without a rank), duite_wait,
 * duite_wait_for, duite_resize, duite_contribute, duite_fail, duite_event_new, duite_complete,
 * duite_await_mpi, duite_await_fortran, duite_mpi_begin, duite_mpi_end. Also calls that describe
 * the runtime (duite_rank and the like). All others are DUITE_E_STATE, as is any call from a thread
 * of the program's own. In a body the calls are local: children run on the rank of the task, unless
 * a balancer delegates them, and no other rank knows of them.
 *
 * Objects: a body names those it was given (param[i].object) and those it made. The table at
 * duite_mode lists the modes it may fork its children with. Other modes are DUITE_E_RIGHT, as are
 * objects of the main program that it was not given. A duite_set needs the right to w, a duite_get
 * that to r. A task's own objects die, freed or not, when its last descendant is over.
 *
 * Order: a body comes first, then its children in the order of their forks, each with all of its
 * descendants, then the next task of the one that forked it. The children's result in a parameter
 * is passed on as soon as it is there, without waiting for the rest of them.
 *
 * duite_get and duite_wait_for wait for what the children forked so far leave, duite_wait for all
 * of them with their descendants. The body's later work comes after them in the order. Meanwhile
 * its thread runs other tasks that come earlier, on the same stack: a body must not wait with a
 * lock held. A level of waiting bodies takes some 1.2 kB of it and what the bodies keep there: a
 * stack of 8 MB (ulimit -s) has room for 5,000. Bodies that wait side by side add no levels. If
 * three quarters of the stack are used, a wait returns DUITE_E_DEPTH without waiting. A duite_wait
 * returns the first error, in the reference order, of the descendants since the body's last wait.
 * The next wait of the main program returns it, too. A failed child poisons only its results: its
 * parent fails only if it returns a code.
 *
 * Errors of calls that return at once are remembered for the body's next get or wait; without one,
 * the task fails with the first error. */

/* Gives the failure of a body its message (printf form, at most 200 bytes are kept). In a body;
 * local. Returns: `code`. */
int duite_fail(const duite_call *call, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* duite_fail with a text as it is, for programs in other languages. In a body; local. Returns:
 * `code`. */
int duite_fail_text(const duite_call *call, int code, const char *text);

/* Gives parameter i, w or rw of an object made by duite_new_sized, so many elements; added ones are
 * zero. It begins with its present size (rw) or its maximum (w); readers find the size that the
 * body leaves. More than the maximum, or another parameter, is DUITE_E_SIZE: the task then fails
 * with it even if its body returns 0. In a body; local. Errors: DUITE_E_SIZE. */
int duite_resize(const duite_call *call, size_t i, size_t count);

/* Makes a contribution of the body itself to parameter i, held by cwp. It has as many elements, and
 * of the type, as param[i] says: at first neutral elements of the law (for sums: zeros). The body
 * may change them until it ends. Their final values count as those of a child forked with cw at the
 * time of the call, in the same place of the tree. This child neither runs nor has a number. Each
 * call is another contribution. NULL: no memory, or another mode (DUITE_E_RIGHT): the task then
 * fails with it even if its body returns 0. Checking mode misses writes beyond the elements. In a
 * body; local. Returns: the elements, or NULL. Errors: DUITE_E_RIGHT, DUITE_E_MEMORY. */
void *duite_contribute(const duite_call *call, size_t i);

enum { DUITE_MAX_ACCESS = 64 }; /* max. modes that a kernel lists */

/* A task's body with the access modes of its parameters. A kernel is constant, alive until stop,
 * and listed at start in the same order on every rank, or added (duite_kernel_add). Names are
 * unique. */
typedef struct duite_kernel {
    const char *name;
    duite_body *body;
    uint8_t access[DUITE_MAX_ACCESS]; /* duite_mode of the first parameters, ended by DUITE_NONE */
    duite_mode variadic;              /* mode of any further ones; DUITE_NONE: none allowed */
    size_t args_size; /* bytes of arguments, copied at the fork; no pointers inside */
    int side_effects; /* 1: does more than write its parameters (files): checking mode runs it once
                       */
    int fixed; /* 1: its tasks run only where duite_fork says, and the objects that those of the
                  main program ran for keep their home: for bodies that need that rank's context. A
                  kernel whose body forks such tasks must set it, too */
    const duite_law *const *law;   /* of the parameters with DUITE_CW or CWP, NULL: duite_sum; as
                                      many as there are modes (DUITE_LAWS). NULL: duite_sum for all */
    const duite_law *variadic_law; /* if variadic is DUITE_CW or CWP; NULL: duite_sum */
    int replicated;                /* 1: a task of the main program runs on every rank, see below */
    int events; /* 1: its tasks may end later than their bodies, see duite_event_new */
} duite_kernel;

/* The laws of a kernel by parameter, at file scope: .law = DUITE_LAWS([1] = &duite_max). In a
 * function, and in C++, a static array of DUITE_MAX_ACCESS does the same. */
#ifndef __cplusplus
#define DUITE_LAWS(...) ((const duite_law *const[DUITE_MAX_ACCESS]){__VA_ARGS__})
#endif

/* Adds a kernel after the start: one of a library that was loaded into the running program. From
 * then on it is like those that were listed, and so are laws that it names and the program has not:
 * both stay alive until stop. Waits, like duite_wait, for all tasks forked so far on all ranks; the
 * next wait returns their errors. Ranks that add other kernels, or none, are DUITE_E_DIFFERENT. On
 * any other error there is no such kernel, on all ranks. Collective. Errors: DUITE_E_KERNEL
 * (malformed, or its name is taken), DUITE_E_LAW, DUITE_E_ARGUMENT (NULL), DUITE_E_DIFFERENT,
 * DUITE_E_MEMORY. */
int duite_kernel_add(duite *rt, const duite_kernel *kernel);

/* Replicated kernels: for small results that every rank needs, such as the scalars of an iteration.
 * Their tasks run on all ranks, each on copies of its inputs, so that no rank waits for a message
 * with the result. In a recorded graph they run only where the result is read; as children of a
 * task they run on its rank. The body must leave the same bytes everywhere: it may depend only on
 * its inputs and arguments, not on call->rank, call->context or anything else that differs. Modes
 * are r, w and rw, without side effects (DUITE_E_KERNEL at start); forks name no rank
 * (DUITE_E_ARGUMENT). duite_counters count such a task once for each rank that runs it. */

/* ---- Events ----
 *
 * A task of a kernel with `events` may wait for what happens outside of duite (a file, a device, a
 * request of MPI, a thread of the program) without keeping a worker: its body makes an event (or
 * hands requests of MPI over), starts the work and returns. The task ends when its body is over and
 * all its events are completed; only then others see its results. Until then its parameters' data
 * stay where they are and may be read and written by their modes; `call`, args and the calls of a
 * body end with the body. Such tasks run on the rank that duite_fork says. Checking mode calls
 * their bodies once, with the parameters themselves. A replay (duite_replay) is over when the
 * events of its tasks are completed, too. */

/* Names something that is to happen: a value, freely copied, of this rank. */
typedef struct duite_event {
    uint32_t slot, generation;
} duite_event;

/* Makes an event of the body's task; a body may make several. In a body; local. Errors:
 * DUITE_E_ARGUMENT (nowhere to put the event), DUITE_E_STATE (its kernel has no `events`),
 * DUITE_E_MEMORY. */
int duite_event_new(const duite_call *call, duite_event *event);

/* The event has happened. code: 0, or that of a failure, with which the task fails, as if its body
 * had returned it. Once for each event, from any thread of its rank, also before the body is over.
 * An event that is never completed keeps duite_wait and duite_stop waiting; the report of a
 * standstill names it. The main thread completes none while it waits, as it may in a fork, too
 * (options.window). Local. Errors: DUITE_E_ARGUMENT (no runtime), DUITE_E_OBJECT (completed
 * already, or never made). */
int duite_complete(duite *rt, duite_event event, int code);

/* Hands n requests of MPI over, which the body began: the task ends when they are over. Workers
 * test them between tasks and as they idle. `requests` become MPI_REQUEST_NULL (a program that uses
 * a persistent one again keeps a copy); the data that they send or receive must live as long, as
 * those of parameters do. Unless MPI has MPI_THREAD_MULTIPLE, the body begins them between
 * duite_mpi_begin and duite_mpi_end. A request that fails fails the task with DUITE_E_MPI and MPI's
 * reason, if its communicator returns errors (MPI_ERRORS_RETURN). The report of a standstill names
 * tasks that wait for requests. If the work of all ranks ends early, requests without a partner are
 * left as they are. In a body; local. Errors: DUITE_E_ARGUMENT (a number < 0, NULL, or a request
 * that is MPI_REQUEST_NULL), DUITE_E_STATE (its kernel has no `events`), DUITE_E_MEMORY; the
 * requests then stay the body's. */
int duite_await_mpi(const duite_call *call, int n, MPI_Request *requests);

/* duite_await_mpi with Fortran's handles of the requests, for programs in other languages. In a
 * body; local. Errors: as of duite_await_mpi. */
int duite_await_fortran(const duite_call *call, int n, MPI_Fint *requests);

/* ---- Start and stop ---- */

struct duite_scheduler; /* duite_policy.h */
struct duite_mapping;
struct duite_balancer;

enum { DUITE_MAX_THREADS = 4096 }; /* max. workers of a rank */

/* The options of duite_start. Begin with duite_options_default. */
typedef struct duite_options {
    size_t size;   /* bytes of this structure in the program's header */
    MPI_Comm comm; /* the ranks that take part; duplicated. Default MPI_COMM_WORLD */
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
    uint64_t seed;        /* of all random choices of policies. Default: DUITE_SEED, else 1 */
    double spin_seconds;  /* an idle worker spins so long before it sleeps. Default 100e-6 */
    int bind;             /* bind workers to cores if the rank owns enough. Default 1 */
    size_t window;        /* max. unfinished tasks of this rank when a fork returns, see duite_fork.
                             Default 0: any number */
    double stuck_seconds; /* a standstill of this length is reported on standard error, see below;
                             0: never. Default: DUITE_STUCK_SECONDS in the environment, else 60 */
    double lost_seconds; /* a rank that sends no heartbeat for so long is lost, see below; 0: never.
                            Rank 0's value counts for all. Default: DUITE_LOST_SECONDS in the
                            environment, else 8 */
    const char *trace;   /* a file in which each rank records its run, see duite_trace_step. NULL:
                            none. Default: DUITE_TRACE, else NULL */
    uint64_t trace_first, trace_end; /* steps recorded: from trace_first on, before trace_end.
                                        Default: all, and what comes before them */
    int check; /* 1: checking mode, below. Default 0, or 1 with DUITE_CHECK=accesses in the
                  environment */
    int memo;  /* 1: recognises repeated forks, see duite_fork; 0: does not; 2: even with long
                  bodies, for tests. Default 1, or 0 or 2 with DUITE_MEMO=0 or DUITE_MEMO=always in
                  the environment */
    const char *report; /* a file in which rank 0 leaves flat JSON at duite_stop: settings,
                           counters, seconds. Rank 0's value counts for all. NULL: none. Default:
                           DUITE_REPORT, else NULL */
} duite_options;

/* Delegation: with the balancer `delegate` a rank that has nothing to do asks others for ready
 * tasks, one rank at a time and ever less often. It gets tasks that are expected to take longer
 * than sending their inputs there and their outputs back. It gets one task with postponed
 * parameters and unknown cost: the one that has been ready for longest. Tasks may go if their fork
 * named no rank and their kernel is neither `fixed` nor replicated and has no side effects; in
 * recorded graphs, those of forked rounds. A task with postponed parameters goes once all that its
 * children may read is there. Its children run on the same rank, or go on from there by the same
 * rules, and their results go home when they are over. So bodies run on any idle rank. Data that
 * they find by their context must serve on each rank. It must be there before the first such fork
 * of any rank (set up on all ranks, then a duite_wait). Results and failures are the same; a
 * failure names the rank on which the body ran. `scatter` sends tasks anywhere, for tests. */

/* Migration: with the balancer `migrate` objects get other homes when the bodies of one rank's
 * tasks take longer than those of the others. A leader moves with its followers and with all their
 * tasks, since tasks run where their objects live. Homes change only at the beginning of a replay:
 * of the second one (duite_replay and duite_replay_while, of any graph), and then ever less often
 * while nothing moves. Such a replay waits, like duite_wait, for all tasks forked so far, on all
 * ranks. Recorded graphs stay valid; a rank frees its values of objects that leave. Objects keep
 * their home if a `fixed` task of the main program ran for them; tasks whose fork named a rank
 * always run there. Results are the same. `wander` moves objects, and tasks, anywhere at any
 * replay, for tests. */

/* Checking mode: each body works on private copies of its parameters between guard pages, which are
 * unmapped afterwards. It runs twice if it has no side effects and forks nothing. The task fails
 * with DUITE_E_CHECK if it writes to an r parameter or to its arguments, goes beyond the ends of a
 * parameter, or uses an earlier task's memory. A read too close to the end to fault is found if the
 * body runs twice and its results depend on it. The task also fails if it leaves bytes of a w
 * parameter unwritten, or writes other bytes the second time. The message names the task, the
 * parameter and the byte. Data that duite_acquire returns, but for adopted memory, are a copy, too;
 * the program ends with a sentence, and a task fails, if it uses them after duite_release. Results
 * of correct programs are the same, at many times the cost. Other memory (globals, heap) is not
 * watched. A body that faults is left by a jump: its locks and memory
 * stay held. Meanwhile the runtime handles SIGSEGV and SIGBUS; other faults go on to the previous
 * handler. */

/* A standstill: the main program waits (in a get, a wait, a stop, or a fork, for the window), or is
 * in a function of a policy that is not built in. No task of this rank began or ended for
 * options.stuck_seconds, and no message came. This rank then reports on standard error, in at most
 * 20 lines. The report has the main program's wait, the functions of policies that have not
 * returned, the running bodies, the tasks that wait for them, and for each other rank the tasks
 * that wait for its objects. A long body looks the same; nothing is changed or ended. The report
 * comes again once the standstill lasts twice as long. Tasks that wait without a visible cause are
 * reported, too: a body may have written beyond its objects, and DUITE_CHECK=accesses names such a
 * body. */

/* A lost rank: on several ranks a thread of each sends the next rank a heartbeat sixteen times in
 * options.lost_seconds, however busy its workers and however large its messages are. A rank that
 * died, was cut off, or was stopped for so long, is lost. Time in which the listening rank itself
 * was stopped does not count. Then every blocking call of all reachable ranks returns DUITE_E_LOST
 * once the running bodies are over; duite_message() names the rank and its host. Only duite_abandon
 * is left, and MPI may not be called any more: the program saves its data and ends. Open MPI may
 * end the job first, with a message of its own. */

/* Writes the defaults to options of `size` bytes, as duite_options_default does, for programs in
 * other languages. Local. Errors: DUITE_E_ARGUMENT (options of so many bytes have never been). */
int duite_options_set(duite_options *options, size_t size);

/* Sets the communicator of options by Fortran's handle of it, for programs in other languages.
 * Local. Errors: DUITE_E_ARGUMENT (no options). */
int duite_options_comm(duite_options *options, MPI_Fint comm);

/* The defaults of the fields. Options must begin with these, since zeros are no size, no
 * communicator and no policies (DUITE_E_ARGUMENT). Fields that the program sets afterwards count
 * first, then the variables of the environment, which are read here, then the built-in defaults. A
 * variable that makes no sense (an unknown policy, text instead of a number) is an error of
 * duite_start, which names it, unless the program sets the field. Local. Returns: the options. */
static inline duite_options duite_options_default(void)
{
    duite_options options;
    duite_options_set(&options, sizeof options);
    return options;
}

/* The built-in policies by name, or from a shared library if the name has a / in it
 * (duite_policy.h). The lists of names have the default first and end with NULL; they leave out the
 * adversaries for tests, which are found by name only. No policy changes a result. Local.
 *
 *     scheduler   the next task of a worker
 *     steal       its newest; idle ones take another's oldest; in a replay a
 *                 task goes to the worker that ran the last one on its data
 *     locality    as steal, but idle ones try the nearest workers first
 *     owner       the newest of its blocks (a leader and its followers);
 *                 idle ones take another's oldest
 *     fifo lifo   the oldest or newest of one queue for all
 *     priority    the largest priority of one queue for all; of equals in a
 *                 replay the longest path to the end
 *     static      the oldest of its blocks; nothing is stolen
 *     shuffle     a random one (an adversary)
 *
 *     mapping     an object's home
 *     metis       by a cut of the graph of hints: equal weights, few bytes
 *                 between ranks; as block with weights alone, as cyclic
 *                 without hints
 *     block       contiguous ranges of equal weight, in the order of making
 *     cyclic      object after object to rank after rank
 *     random      a random rank, from the seed
 *     taskgraph   METIS on the tasks of a recorded graph: their costs, and
 *                 what they read of each other
 *     list        where the tasks of a recorded graph end earliest (HEFT)
 *
 *     balancer    moves
 *     none        nothing
 *     delegate    ready tasks to idle ranks (duite_options)
 *     migrate     objects between replays, to ranks with less work
 *     scatter wander  tasks, or objects and tasks, anywhere (adversaries)
 *
 * taskgraph and list begin as metis. They move objects at the first replay of each graph, whose
 * tasks are then known, and once more at the second with measured costs, unless all forks named a
 * cost. Such a replay waits, like duite_wait; duite_home may answer differently afterwards; objects
 * of `fixed` kernels stay.
 *
 * Returns: constant tables and lists, which no call frees. NULL, and a message for duite_message,
 * if there is no such policy. */
const struct duite_scheduler *duite_scheduler_find(const char *name);
const struct duite_mapping *duite_mapping_find(const char *name);
const struct duite_balancer *duite_balancer_find(const char *name);
const char *const *duite_scheduler_names(void);
const char *const *duite_mapping_names(void);
const char *const *duite_balancer_names(void);

/* Starts a runtime. Initialises MPI (thread support SERIALIZED) if the caller has not. On several
 * ranks its workers call MPI at any time until duite_stop: a program that calls MPI meanwhile needs
 * MPI_THREAD_MULTIPLE. A process may have one runtime at a time, more only with MPI_THREAD_MULTIPLE
 * (DUITE_E_STATE, on this rank). Collective over comm. On failure *rt is NULL on all ranks. If
 * another rank failed, the code is DUITE_E_MEMORY if it had no memory, else DUITE_E_DIFFERENT; the
 * message is that of the failed rank, with its number. Errors: DUITE_E_ARGUMENT, DUITE_E_KERNEL,
 * DUITE_E_LAW, DUITE_E_STATE, DUITE_E_MPI, DUITE_E_DIFFERENT, DUITE_E_SYSTEM, DUITE_E_MEMORY. */
int duite_start(duite **rt, const duite_options *options);

/* Waits for all tasks, ends the workers and frees everything; start and stop may repeat. If start
 * initialised MPI, it is finalised when the process ends; a process that ends without a stop leaves
 * it unfinalised, and mpirun ends the job. Returns the error that a wait would, else
 * DUITE_E_NOT_FREED if objects or graphs are left; *rt becomes NULL in any case. In a body or a
 * build function, or between duite_mpi_begin and duite_mpi_end, it does nothing and returns
 * DUITE_E_STATE. Collective. Errors: those of duite_wait, DUITE_E_NOT_FREED, DUITE_E_STATE. */
int duite_stop(duite **rt);

/* Frees the runtime without the other ranks, after DUITE_E_LOST or DUITE_E_MPI (else:
 * DUITE_E_STATE): begins no call of MPI that waits. Memory that MPI may still read or write stays
 * allocated. MPI is not finalised when the process ends, even if duite_start initialised it, so
 * mpirun ends the job. The call sets *rt to NULL. A call of duite_stop instead does the same and
 * returns the code. Local. Errors: DUITE_E_STATE. */
int duite_abandon(duite **rt);

/* For calls of MPI by the program itself (a solver, parallel files). While a runtime exists, even
 * without tasks, they must stand between these two, since workers and heartbeats call MPI at any
 * other time. MPI_THREAD_MULTIPLE needs no begin and end. Begin waits until no thread of this rank
 * is inside MPI. Until the end tasks run on, but messages are neither sent nor received, and all
 * other calls of the main program are refused and remembered (DUITE_E_STATE). So all ranks call
 * duite_wait first. Else a rank in duite_get may need a value that this rank has not sent, and a
 * call of MPI that waits for that rank never returns. Ranks outside take a rank that stays longer
 * than lost_seconds for lost.
 *
 * In a body the two stand around calls of MPI that wait for no rank, such as MPI_Isend
 * (duite_await_mpi). Meanwhile the body may not wait; a body that returns before the end fails with
 * DUITE_E_STATE. Local. Errors: DUITE_E_STATE (begun twice, ended without begin). */
int duite_mpi_begin(duite *rt);
int duite_mpi_end(duite *rt);

/* This rank, the number of ranks, the workers of this rank. Local. Returns: -1 or 0 if `rt` is
 * NULL. */
int duite_rank(const duite *rt);
int duite_ranks(const duite *rt);
unsigned duite_threads(const duite *rt);

/* The number of this rank's cores. It is the least of SLURM_CPUS_PER_TASK, its share of the cores
 * that the ranks of its host may use, and its share of those within a cgroup's quota or
 * SLURM_CPUS_ON_NODE. If from is not NULL, *from becomes the source as text, such as
 * "SLURM_CPUS_PER_TASK=1", valid until duite_stop. Workers are not bound if the rank has fewer
 * cores than it may use. Local. Returns: 0 if `rt` is NULL. */
unsigned duite_cores(const duite *rt, const char **from);

/* 1 if the workers of this host outnumber the cores they may use, or this rank's workers its cores:
 * then they neither spin nor bind. Local. Returns: 1 or 0. */
int duite_oversubscribed(const duite *rt);

/* ---- Shared objects ---- */

/* Makes an object of count elements, at least 1 (DUITE_E_ARGUMENT), all zero. Collective; no
 * communication. Errors: DUITE_E_ARGUMENT (also a type that is none, or more bytes than the library
 * can count), DUITE_E_MEMORY. */
int duite_new(duite *rt, duite_type type, size_t count, duite_object *object);

/* Makes an object whose size changes: 0 to `max` elements (at least 1), count zeros to begin with.
 * Bodies under w and rw find room for `max` and set the count (duite_resize); readers, messages and
 * gets have that many. It cannot be accumulated into (cw: DUITE_E_ACCESS). Collective; no
 * communication. Errors: as of duite_new: DUITE_E_ARGUMENT, DUITE_E_MEMORY. */
int duite_new_sized(duite *rt, duite_type type, size_t count, size_t max, duite_object *object);

/* The runtime is done with memory that it adopted. Called on any thread of the runtime, in
 * duite_free, duite_release or duite_stop also on the main thread; it calls no function of the
 * runtime. */
typedef void duite_done(void *values, void *user);

/* Makes an object of memory of the program's own on one rank, without a copy: its value is what
 * lies there, count elements (of their type's alignment, at most 8 bytes; bodies find them where
 * they are, so duite_param.data has no other alignment). That rank is the object's home and stays
 * it. Others ignore `values`, `done` and `user`. From now on the memory is the runtime's: the
 * program may look at it or change it only between duite_acquire and duite_release of the object,
 * whose data it then is. Tasks under rw and w that run one after the other on `rank` work in place.
 * A turn waits for all earlier tasks on the object, also for those that read an older value. Values
 * that come from elsewhere (duite_set, a task on another rank, after a failure) lie in memory of
 * the runtime's until the program acquires or frees the object. duite_free puts the last value
 * there and gives the memory back: `done`, unless it is NULL, is called once with `values` and
 * `user`. A duite_wait after duite_free returns later than that. duite_stop also gives back the
 * memory of objects that were not freed, whose value may be an older one; duite_abandon does so
 * unless MPI may still read it. The memory may be adopted again once it was given back. Collective;
 * no communication. Errors: DUITE_E_ARGUMENT (nowhere to put the object, no such rank, a type that
 * is none, a count that is negative, 0 or too large), DUITE_E_MEMORY. Memory that is NULL, not
 * aligned, or overlaps memory that is adopted is DUITE_E_ARGUMENT on `rank` alone. All ranks then
 * have the object, poisoned with that code, so that the next duite_wait returns it on all. */
int duite_adopt(duite *rt, int rank, duite_type type, size_t count, void *values, duite_done *done,
                void *user, duite_object *object);

/* Frees an object after the last earlier access; afterwards `object` is invalid. Collective.
 * Errors: DUITE_E_OBJECT; in a body DUITE_E_RIGHT for an object that it did not make. */
int duite_free(duite *rt, duite_object object);

/* Overwrites the object, in fork order, with a copy of `values` (count elements, the same on every
 * rank), or with zeros if `values` is NULL. Collective; returns at once. Errors: DUITE_E_OBJECT,
 * DUITE_E_MEMORY; in a body DUITE_E_RIGHT. */
int duite_set(duite *rt, duite_object object, const void *values);

/* duite_set with count values: as many as the object has, or at most its maximum if its size
 * changes (duite_set sets the maximum); else DUITE_E_SIZE. Collective; returns at once. Errors:
 * DUITE_E_OBJECT, DUITE_E_SIZE, DUITE_E_MEMORY; in a body DUITE_E_RIGHT. */
int duite_set_sized(duite *rt, duite_object object, const void *values, size_t count);

/* duite_set with the values of one rank only; the others ignore `values`. The value stays there,
 * and goes to other ranks as they need it. Collective; returns at once. Errors: DUITE_E_OBJECT,
 * DUITE_E_ARGUMENT (no such rank), DUITE_E_MEMORY. */
int duite_set_at(duite *rt, duite_object object, int rank, const void *values);

/* The number of elements that the tasks forked so far leave in the object. Waits and returns errors
 * like duite_get; a later duite_get need not wait. Collective. Errors: as of duite_get:
 * DUITE_E_OBJECT, DUITE_E_ARGUMENT, DUITE_E_DIFFERENT. */
int duite_get_count(duite *rt, duite_object object, size_t *count);

/* Copies the object, as the tasks forked so far leave it, into `values` (count elements) on every
 * rank. Returns when the bytes are there; other tasks go on. A poisoned object returns the code of
 * its first cause in fork order, and `values` stays unchanged. Returns DUITE_E_DIFFERENT, like
 * duite_wait, if it waits long because the ranks did not make the same calls. Collective. Errors:
 * that of the failed task, DUITE_E_OBJECT, DUITE_E_ARGUMENT (nowhere to put the values),
 * DUITE_E_DIFFERENT; in a body DUITE_E_RIGHT, DUITE_E_DEPTH. */
int duite_get(duite *rt, duite_object object, void *values);

/* duite_get on one rank only; the others ignore `values` and return DUITE_OK at once, even if the
 * object is poisoned, so a program may not branch on the result. Collective. Errors: as of
 * duite_get; DUITE_E_ARGUMENT also if there is no such rank. */
int duite_get_at(duite *rt, duite_object object, int rank, void *values);

/* duite_get in two calls: begin returns at once, end waits until `values`, which stay untouched by
 * the program in between, have the object as the tasks forked before the begin left it. Meanwhile
 * tasks may change the object, and it may be freed. Several gets of an object end in the order in
 * which they began; one that never ends is DUITE_E_NOT_FREED at duite_stop. With options.window the
 * begin may wait like a fork. Collective. Errors: of the end as of duite_get, and DUITE_E_STATE (no
 * such get was begun); of the begin DUITE_E_OBJECT, DUITE_E_ARGUMENT (nowhere to put the values;
 * the get is to be ended all the same), DUITE_E_MEMORY. */
int duite_get_begin(duite *rt, duite_object object, void *values);
int duite_get_end(duite *rt, duite_object object);

/* Waits for the values of n objects as the tasks forked so far leave them, on all ranks, while
 * other tasks go on; no value is moved or copied. Contributions (cw) that come afterwards combine
 * apart, as after a duite_get. Returns on all ranks the same error: that of the first cause in fork
 * order of which one of the objects is poisoned (in a body: of the first poisoned object in the
 * list). A failure of other tasks is left to the next duite_wait. Collective; in a body local.
 * Errors: that of the failed task, DUITE_E_OBJECT, DUITE_E_ARGUMENT (the objects are NULL),
 * DUITE_E_DIFFERENT; in a body DUITE_E_RIGHT, DUITE_E_DEPTH. */
int duite_wait_for(duite *rt, size_t n, const duite_object *objects);

/* *there becomes 1 if duite_wait_for of these objects need not wait for tasks on any rank, else 0;
 * and 1 if the call fails. The same on all ranks, which wait for each other to come to the call but
 * not for tasks: the program may branch on it, though not so that its results depend on time. If
 * they are not there the main thread runs tasks that are ready, for a moment. Poisoned values are
 * there. Collective. Errors: DUITE_E_OBJECT, DUITE_E_ARGUMENT (the objects are NULL, nowhere to put
 * the answer), DUITE_E_DIFFERENT, DUITE_E_MEMORY. */
int duite_test(duite *rt, size_t n, const duite_object *objects, int *there);

/* The main program's own turn on an object, in the order of the forks, without a copy: on the
 * object's home (duite_home) *data points to its value, which the program may read (DUITE_R),
 * overwrite (DUITE_W, whose bytes are unspecified at first) or change (DUITE_RW) until it releases
 * the object; on other ranks *data is NULL. Returns on the home when the value is there; later
 * forks on the object wait for the release. Several objects may be acquired, if none of them waits
 * for another. Meanwhile tasks may be forked, but replays and calls that wait (duite_get,
 * duite_wait, duite_stop and their like) are DUITE_E_STATE. A failure of MPI or a lost rank ends
 * all turns. A poisoned value returns its code on the home
 * alone, with *data NULL; the object is to be released all the same. A value whose size changes has
 * its maximum after DUITE_W. Collective. Errors: that of the failed task, DUITE_E_OBJECT,
 * DUITE_E_ARGUMENT (another mode, nowhere to put the data), DUITE_E_STATE (acquired already, or not
 * acquired), DUITE_E_MEMORY. */
int duite_acquire(duite *rt, duite_object object, duite_mode mode, void **data);
int duite_release(duite *rt, duite_object object);

/* Parts: the object becomes n objects, one after the other, of counts[i] elements, at least 1 each
 * and together all. Tasks may write each of them, without waiting for the others. Meanwhile only
 * the parts may be named. They live where the object does and in its bytes, so nothing is copied,
 * and duite_param.data is aligned as the elements before a part leave it; a value that comes from
 * elsewhere (duite_set, another rank) is copied at the join. duite_join makes the object whole
 * again; its parts are gone. Both stand in fork order like a task that writes the object, and count
 * as forks. Parts may be split again, and are joined first. A part that is poisoned at the join
 * poisons the object. A body may split objects that it made or holds by rwp; what it has not joined
 * when it ends is joined then. Collective; return at once; in a body local. Errors: DUITE_E_OBJECT
 * (also of a join: the object is not split, or a part is), DUITE_E_ARGUMENT (no parts, nowhere to
 * put them, counts that do not add up), DUITE_E_SIZE (the object changes its size), DUITE_E_MEMORY;
 * in a body DUITE_E_RIGHT; DUITE_E_STATE for duite_free of a part. */
int duite_split(duite *rt, duite_object object, size_t n, const size_t *counts,
                duite_object *parts);
int duite_join(duite *rt, duite_object object);

/* Tells mappings about the object: its share of work, and the bytes it exchanges with n existing
 * neighbours (edge_weights NULL: 1 each). An edge may be given from either end; weights given twice
 * add up. A second hint replaces the weight and adds edges. Hints count until the object's home is
 * settled by the next fork, set, get, free, duite_home, duite_graph_new or replay (even of an empty
 * graph); later ones have no effect. Collective. Errors: DUITE_E_OBJECT, DUITE_E_ARGUMENT (a weight
 * that is negative or not finite), DUITE_E_MEMORY. */
int duite_hint(duite *rt, duite_object object, double weight, size_t n,
               const duite_object *neighbours, const double *edge_weights);

/* The object gets the home of `leader` (or of its leader in turn), whatever the mapping; counts
 * like a hint. A ring of leaders is DUITE_E_ARGUMENT. Collective. Errors: DUITE_E_OBJECT,
 * DUITE_E_ARGUMENT. */
int duite_colocate(duite *rt, duite_object object, duite_object leader);

/* Settles the homes of all objects made so far, as a fork does, and returns this one's home; -1 for
 * an invalid object. The answer holds until the next replay if options.balance moves objects, else
 * until the object is freed. Collective. Returns: a rank, or -1. */
int duite_home(duite *rt, duite_object object);

/* 1 if this rank keeps the object, or has a copy of it as the tasks forked so far leave it, or if
 * it is invalid; else 0. If all objects of a fork are 0 here, this rank only counts the fork. The
 * call must still be made, but its `args` are not read and need not be computed. Any pointer but
 * NULL will do; this rank alone would refuse NULL, and the ranks would differ. Exceptions: forks
 * that name this rank, have a replicated kernel, or are in a build function. On rank 0 also tasks
 * that read and write nothing (no objects, or cw alone). Settles homes, and is collective, like
 * duite_home. Returns: 1 or 0. */
int duite_is_local(duite *rt, duite_object object);

/* ---- Tasks ---- */

/* Prefetches what later forks on these n objects look at. For main programs that
 * fork tasks on tens of thousands of objects, a few tasks ahead; no other effect. Skips invalid
 * objects. Main program. Local. */
void duite_prefetch(const duite *rt, size_t n, const duite_object *objects);

/* Forks a task on n objects, in the order of the kernel's modes; a task names an object once.
 * `args` points to the kernel's args_size bytes, and is NULL exactly if these are 0
 * (DUITE_E_ARGUMENT). The task runs where its first w or rw object lives, else its first r object,
 * else on rank 0. Contributions (cw) between two other accesses of an object (by tasks, set, get or
 * free; waits do not count) combine in fork order by a fixed tree. Complete subtrees combine as in
 * a binary counter, the rest folds from the right. Then the result is combined with the object:
 * under a sum old + (A + (B + C)). Contributions of another law are another access. Collective.
 * Returns at once, unless options.window is set and more tasks of this rank than that are
 * unfinished: then the main thread works until they are at most so many. The runtime's own tasks,
 * which combine, send and copy, count. A replay is one task, but each task of a forked round
 * counts. The window bounds the memory of a program that forks far ahead, and changes no result.
 * Such a fork may wait for other ranks, as a get does: they must not wait for this one outside of
 * duite.
 *
 * If a program of one rank forks the same tasks round after round, they are replayed as if
 * recorded: same results, failures and task numbers, in less time. A round may have up to 4,096
 * forks without options. Their kernels have up to 16 parameters under r, w and rw and write
 * something; objects have fixed sizes; arguments may change. Rounds with a kernel that accumulates,
 * postpones, has events, is replicated or variadic are not recognised. Any other call of the main
 * program ends the replay, and it begins again after two equal rounds. Bodies must have run, to be
 * known as short: on one thread with window 0 none runs before the first get or wait, and no round
 * is recognised. Rounds whose arguments come to more than 1 MiB ahead of the bodies are forked.
 * Checking mode and traces switch it off, as does options.memo. Errors: DUITE_E_ARGUMENT,
 * DUITE_E_KERNEL, DUITE_E_ACCESS, DUITE_E_OBJECT, DUITE_E_LAW, DUITE_E_MEMORY; in a body
 * DUITE_E_RIGHT. */
int duite_fork(duite *rt, const duite_kernel *kernel, const void *args, size_t n,
               const duite_object *objects);

/* duite_fork on a rank of the caller's choice: for kernels with side effects, such as files.
 * Collective. Errors: as of duite_fork; DUITE_E_ARGUMENT also if there is no such rank,
 * DUITE_E_STATE in a body. */
int duite_fork_at(duite *rt, int rank, const duite_kernel *kernel, const void *args, size_t n,
                  const duite_object *objects);

/* Options of a task at its fork; fields left out are 0. */
typedef struct duite_task_options {
    const int *at;    /* the rank that runs it, as of duite_fork_at; NULL: as duite_fork chooses */
    int32_t priority; /* the scheduler `priority` takes the ready task with the largest */
    double cost;      /* expected seconds of the body; 0 or less: unknown */
} duite_task_options;

/* duite_fork with options (NULL: none): duite_fork_with(rt, &(duite_task_options){.priority = 3,
 * .cost = 2e-5}, ...). Schedulers see priority and cost (duite_ready), which never change results;
 * replays of a recorded fork have them, too. They may differ between ranks, as measured costs do:
 * the rank that runs the task uses its own. Collective; returns at once. Errors: as of
 * duite_fork_at; DUITE_E_STATE if a body names a rank. */
int duite_fork_with(duite *rt, const duite_task_options *options, const duite_kernel *kernel,
                    const void *args, size_t n, const duite_object *objects);

/* duite_fork with the objects, and a structure of arguments, written out:
 * DUITE_FORK(rt, &AXPY, DUITE_ARGS(struct axpy, .alpha = 2, .first = 7), x, y). In C++ before C++20
 * the arguments have no names: DUITE_ARGS(axpy, 2, 7). */
#ifdef __cplusplus
} /* extern "C" */
/* For the two macros alone, since C++ has no temporary arrays. */
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

/* Waits for all tasks forked so far, on all ranks. Returns the same error on all ranks: that of the
 * first task in the reference order (a task, then its children) that failed itself since the last
 * wait. DUITE_E_DIFFERENT on all ranks: they did not make the same calls since the last wait, and
 * only duite_stop is left. A remembered error goes first; the next wait then returns the task's.
 * Collective. Errors: that of the first failed task, DUITE_E_DIFFERENT, DUITE_E_LOST, DUITE_E_MPI;
 * in a body DUITE_E_DEPTH. */
int duite_wait(duite *rt);

/* ---- Recorded graphs ---- */

/* Names a recorded graph: a value, freely copied. */
typedef struct duite_graph {
    uint32_t slot, generation;
} duite_graph;

#define DUITE_NO_GRAPH ((duite_graph){0, 0})

/* Forks the tasks of one round. duite_graph_new calls it. It is called again when the graph is
 * recorded again: its context must then have the objects for the graph's further use. Returns 0, or
 * a code that duite_graph_new or the replay returns. */
typedef int duite_build(duite *rt, void *context);

/* Records the forks of build(rt, context) without running them. Inside, duite_fork, duite_fork_at,
 * duite_fork_with and duite_set are recorded, duite_home and the local calls answer; all others are
 * DUITE_E_STATE. If build or a call inside fails, it makes no graph, returns the first error, and
 * *graph is DUITE_NO_GRAPH. A graph may be replayed any number of times; duite_graph_free frees it.
 * Collective; no communication. Errors: those of build and of the calls inside, DUITE_E_ARGUMENT,
 * DUITE_E_MEMORY. */
int duite_graph_new(duite *rt, duite_build *build, void *context, duite_graph *graph);

/* Forks the graph's tasks `rounds` times, one round after the other: results, failures and task
 * numbers are those of forking them by hand. The rounds run from a compiled form, in which a task
 * costs no allocation, lock or search, and a round begins before the last one is over where
 * dependences allow. On several ranks a rank sends each other rank at most one message per phase
 * and round. The first phase carries values made without other ranks, the second those made from
 * the first, and so on; contributions are part of these messages. Objects that the rounds only read
 * move before the first one. The tasks forked before and after it that use the same objects wait
 * for the replay as a whole. All rounds are forked instead if the size of an object changes, if a
 * mode is postponed, or if contributions of successive rounds are one sum. The first or last round
 * is forked if its contributions are one sum with those forked before or after the replay. If an
 * object of the graph was freed, build is called again first, and sets bindings and arguments anew.
 * Returns its errors, and DUITE_E_BINDING. `rounds` times tasks is at most 2^48. Collective.
 * Returns at once, unless a balancer may move objects or the tags of MPI are used up (after some
 * 10,000 graphs if MPI has 32,767, the least it may have). Then a replay waits for all tasks, like
 * duite_wait. Errors: those of build, DUITE_E_OBJECT (no such graph), DUITE_E_BINDING,
 * DUITE_E_ARGUMENT (too many rounds), DUITE_E_MPI (too few tags), DUITE_E_MEMORY. */
int duite_replay(duite *rt, duite_graph graph, uint64_t rounds);

/* Replays while the first element of `flag`, an object that the graph uses or any other, is not
 * zero after a round: at least one round, at most `max_rounds`. A poisoned flag ends it. Tasks
 * forked later are numbered as if there had been `max_rounds`. All ranks read the flag: it costs no
 * message if a replicated kernel writes it. Collective; returns at once, or if the rounds are
 * forked (duite_replay), once the last one is. Errors: as of duite_replay; DUITE_E_OBJECT also for
 * the flag, DUITE_E_ARGUMENT for no rounds. */
int duite_replay_while(duite *rt, duite_graph graph, duite_object flag, uint64_t max_rounds);

/* Waits for the last replay of the graph and writes its number of rounds; 0 before the first.
 * Collective. Errors: DUITE_E_OBJECT (no such graph), DUITE_E_ARGUMENT (nowhere to put the number).
 */
int duite_graph_rounds(duite *rt, duite_graph graph, uint64_t *rounds);

/* Changes a graph from its next replay on. duite_graph_args: the arguments of the k-th fork of
 * build (from 0; sets do not count) are a copy of the args_size bytes at args. duite_graph_bind:
 * `object` replaces `recorded` wherever build named it, until another one is bound. It must have
 * the same type and count (DUITE_E_BINDING). Only the replay returns DUITE_E_BINDING for two
 * recorded objects bound to one, so that they may be exchanged. Collective. Errors: DUITE_E_OBJECT,
 * DUITE_E_ARGUMENT (no such fork, or other arguments), DUITE_E_BINDING, DUITE_E_MEMORY. */
int duite_graph_args(duite *rt, duite_graph graph, size_t k, const void *args);
int duite_graph_bind(duite *rt, duite_graph graph, duite_object recorded, duite_object object);

/* Frees a graph; unfinished replays run to their end. Collective. Errors: DUITE_E_OBJECT. */
int duite_graph_free(duite *rt, duite_graph graph);

/* ---- Traces ----
 *
 * With options.trace a run leaves the files trace, trace.1, trace.2 and so on, one per rank: each
 * worker's activity over time, and the main program's calls. Files of these names are replaced.
 * duite-trace converts them for viewers, duite-predict predicts the run's time elsewhere. If the
 * file cannot be made, duite_start fails. If it cannot be written later, or is removed or replaced,
 * the run goes on, the written part stays, and duite_trace_end returns the error. */

/* Begins step `step` of the program, counted from 0. Writes the record so far to the file, and
 * begins or ends recording at options.trace_first or trace_end. If it begins or ends, the call
 * waits, like duite_wait, for all tasks forked so far; the next wait returns their errors. Does
 * nothing without a trace. Collective. Errors: DUITE_E_SYSTEM (the file). */
int duite_trace_step(duite *rt, uint64_t step);

/* Ends the trace, as duite_stop does, too. Waits for all tasks forked so far, as duite_trace_step.
 * Does nothing without a trace, and the second time. Collective. Errors: DUITE_E_SYSTEM (this
 * rank's file is incomplete or gone; the message gives the reason). */
int duite_trace_end(duite *rt);

/* ---- Counters ---- */

/* Sums over all workers and ranks. */
typedef struct duite_counters {
    uint64_t tasks;    /* bodies run, without those that poison stopped */
    uint64_t placed;   /* tasks put in a queue by the scheduler */
    uint64_t stolen;   /* tasks taken from another worker's queue */
    uint64_t chained;  /* tasks run inline: directly after the task that made them ready */
    uint64_t messages; /* sent between ranks */
    uint64_t bytes;    /* sent between ranks, headers included */
    double busy;       /* seconds in bodies, over all workers */
    double idle;       /* seconds without a task, over all workers, up to each one's last task */
    uint64_t graphs_recorded; /* calls of build functions; the same on every rank, counted once */
    uint64_t delegated;       /* tasks that ran on another rank than duite_fork says */
    double awaited; /* seconds in which a rank awaited messages, times its workers, over all ranks:
                       from the get, or the fork of the task that needs the message, until it is
                       there */
    double exposed; /* the part of `awaited` in which those workers had no task */
    uint64_t migrated;   /* objects that got another home; the same on every rank, counted once */
    uint64_t stolen_far; /* those of `stolen` from a worker beyond the nearest (duite_near) */
    uint64_t recognised; /* tasks whose forks were recognised as those of an earlier round */
    uint64_t recognised_rounds; /* whole rounds of these */
} duite_counters;

/* Writes the first `size` bytes of the counters, as duite_count_all does, for programs in other
 * languages. Collective. Errors: as of duite_count_all. */
int duite_count_sized(duite *rt, duite_counters *counters, size_t size);

/* Sums over all workers and ranks since start. After a duite_wait the counts are exact. Collective.
 * Errors: DUITE_E_ARGUMENT (nowhere to put the counters), DUITE_E_MPI. */
static inline int duite_count_all(duite *rt, duite_counters *counters)
{
    return duite_count_sized(rt, counters, sizeof *counters);
}

#ifdef __cplusplus
}
#endif

#endif
