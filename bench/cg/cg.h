#ifndef BENCH_CG_CG_H
#define BENCH_CG_CG_H

#include "bench/bench.h"
#include "bench/cg/state.h"
#include "cloth/flow/state/state.h"

/* Shared by the cases of the bench "cg". Each case is a file: its plan; what our process runs for
 * all of them is in ours.c, making the states in make.c. */

/* ---- States ---- */

/* The names of all states of "cg"; of those of them that stand for what simulations meet; of what
 * "scale" cuts into small blocks: those of "cg", and cloth in contact. Then those of one motion:
 * "landed", cloth in contact with the floor; "folded", with itself; "large", whose coarse space has
 * many patches; "million", of 1,000,000 vertices. Each list is ended by NULL. */
const char *const *states_all(void);
const char *const *states_met(void);
const char *const *states_small(void);
const char *const *states_of(const char *motion);
/* Why a state cannot be made here, or NULL. */
const char *states_missing(const char *name);

enum { STATES_MOTIONS = 11 }; /* as many motions as there are, in states.c */

/* The parts of a state, all owned by the caller that is given it. */
struct states_plan {
    struct model model;  /* of the step that is the state's system; starts where its mesh is */
    struct model motion; /* what runs before it, */
    bool moves;          /* if anything does */
    const char *moved;   /* states of the same motion have the same one */
    uint32_t count;      /* iterations whose answer the state keeps */
    bool solved_here;    /* it is made without answers: plain loops would take too long, or know
                          * nothing of the step's contacts; who first needs the solution finds it
                          * (cg_find_solution) */
};
/* 0, or what serve_fail returns. */
int states_plan_make(struct states_plan *plan, const char *name, bool quick);
void states_plan_free(struct states_plan *plan);

/* Makes the folder of the states and sets STATE_FOLDER for all processes. Small states have their
 * own. 1 after a sentence on stderr. */
int cg_make_folder(const struct bench_options *options);

/* Waves the start of the model's cloth, sets it moving and shakes it a little, by a seed. */
int states_wave(struct model *model);
/* Lets the model's cloth start at x with v, n x 3 each. */
int states_start(struct model *model, const double *x, const double *v);

/* The vertices of a state block after block, then those that no block has; the hash of a system. */
int cg_order(struct state *state, uint32_t grain);
uint64_t cg_hash(const struct solve_system *system);

/* The system of the first step of the plan's model, which is made whole, whatever energy it gains
 * and however far it stretches: a step that is halved would leave the system of a shorter one. It
 * knows nothing of contacts. 0, or what serve_fail returns: the step fails, or its length is not
 * the model's. */
int cg_make_system(struct states_plan *plan, struct serve_request *request,
                   struct solve_system *system);

/* The run "make": makes a state (state=) that is not there, in full or quick; how many vertices. */
int cg_make_state(void *context, struct serve_request *request, double *value);
extern const struct serve_run cg_make_runs[];

/* ---- Ours ---- */

/* Iterations to an error, of a state and a solver (the session's settings): found once. */
struct cg_needed {
    char settings[200];
    double error;
    uint32_t iterations;
};
enum { CG_NEEDED = 64 };

enum { CG_ANY_GUESS = 32 }; /* for cg_search, where nothing is known of a large state */

/* A solver whose error after so many iterations is found by a solve: 0, or what serve_fail returns.
 */
struct cg_solver {
    void *context;
    int (*error_after)(void *context, uint32_t count, double *error);
};
/* The least number of iterations after which the error is small enough; of more than a hundred, to
 * a hundredth. guess: about how many that may be; 0: counts are doubled, then halved, so versions
 * of a solver are compared by the same ones. The error falls from 1. 0, or what serve_fail returns.
 */
int cg_search(const struct cg_solver *solver, double wanted, uint32_t guess, uint32_t *needed);

struct cg_session {
    struct state state;
    struct states_plan plan;
    duite *rt;
    struct flow *flow;
    struct flow_state run;
    struct flow_report report;
    char settings[200];   /* that it is ready for; empty: for none */
    double *solution;     /* of the state, of these settings; NULL: the state has it */
    enum model_stop stop; /* the scene's, which is the default one */
    double tolerance;
    uint32_t most;
    struct cg_needed needed[CG_NEEDED]; /* those before are forgotten when it is full */
    size_t n_needed;
};

/* Makes a model ready: rank 0 cuts it, the others join. Starts a runtime for its tasks as the
 * request wants it (threads=, scheduler=). 0, or what serve_fail returns. */
int cg_make_flow(const struct model *model, struct flow **flow);
int cg_start_runtime(struct serve_request *request, struct flow *flow, duite **rt);
/* Ends all that, and what flow_run_begin made if it was called; they are NULL then. 1 if the
 * runtime did not stop well, else `code`. */
int cg_stop(struct flow_state *run, bool begun, duite **rt, struct flow **flow, int code);

/* Runs a model from its start to its end on a runtime of its own. output, progress, report: as of
 * flow_run, or NULL. 0, or what serve_fail returns. */
int cg_run(const struct model *model, struct serve_request *request,
           const struct flow_output *output, const struct flow_progress *progress,
           struct flow_report *report);

/* Makes the session ready for a state and settings, with the system that is to be solved. The same.
 */
int cg_ready(struct cg_session *session, struct serve_request *request);

/* When solves end from now on, by whichever model a rank goes by. (solution.c, as what follows.) */
void cg_stop_by(struct cg_session *session, enum model_stop stop, double tolerance, uint32_t most);
/* Room for dv of all vertices, of the caller; NULL and serve_fail without memory. The outcome of
 * the last solve, in the numbering of the input: rank 0 knows the order of the blocks, others cut
 * them as it does. 0, or what serve_fail returns. Collective. */
double *cg_new_answer(const struct cg_session *session);
int cg_answer(struct cg_session *session, double *dv);
/* The solution of a state that was made without: less than 1e-9 of the right side is left. Rank 0
 * puts it into the state's file. With contacts, which the system there lacks, it is solved for to
 * 1e-10 and kept for these settings only. The same; collective. */
int cg_find_solution(struct cg_session *session);

extern const struct serve_run cg_runs[];
int cg_solve_state(void *session, struct serve_request *request, double *value); /* run "solve" */
/* How many springs of contact the system of a state has; self=1: of cloth with cloth (run "touch").
 */
int cg_touch(void *session, struct serve_request *request, double *value);
/* Frames of a sheet that falls (bench/cg/frames.c). */
int cg_frames(void *session, struct serve_request *request, double *value);

/* Ends the runtime that runs have left for the next one; its state is kept. The same as below. */
int cg_pause(struct cg_session *session);
/* Ends what runs have left for the next one. 1 if the runtime did not stop well. Collective. */
int cg_end(struct cg_session *session);

/* Shapes of ours: so many ranks (0: without mpirun) of so many threads. */
struct subject_shape cg_ours(unsigned ranks, unsigned threads);
/* A series of ours: RUN state=STATE and more. */
struct measure_series *cg_series(struct measure *measure, const struct bench_options *options,
                                 struct subject_shape shape, const char *run, const char *state,
                                 const char *more);
/* The same of PETSc, on one rank and on as many as there are threads: the faster one counts. Tiny
 * solves on one rank only: messages between ranks that lack cores take forever. */
struct measure_series *cg_petsc(struct measure *measure, const struct bench_options *options,
                                const char *run, const char *state, const char *more);

/* Solves to an error of 1 % in the mass norm, with words of a request more, of all states of a list
 * that can be made here; how many. Returns the first of the series. */
const struct measure_series *cg_solves(struct measure *measure, const struct bench_options *options,
                                       const char *const *name, const char *words, size_t *n);
/* The largest ratio of a metric's series. */
double cg_worst(const struct measure_metric *metric, size_t round);

extern const struct bench_case cg_spring_150, cg_spring_400, cg_half_150, cg_solve, cg_jacobi,
    cg_error, cg_step, cg_realtime;

#endif
