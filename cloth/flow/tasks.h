#ifndef CLOTH_FLOW_TASKS_H
#define CLOTH_FLOW_TASKS_H

#include "cloth/flow/kernels.h"
#include "cloth/flow/run.h"
#include "cloth/flow/setup/source.h"
#include "cloth/flow/state/kernel.h"
#include "cloth/flow/state/tables.h"
#include "cloth/flow/step/energy.h"
#include "cloth/flow/step/grid.h"
#include "cloth/solve/coarse.h"
#include "cloth/solve/local.h"

#include <stdbool.h>
#include <stddef.h>
#include <xxhash.h>

/* What the bodies of tasks share (struct flow, the runtime's context) and what the main program
 * keeps of a run (struct flow_state). Bodies see objects, arguments and the constant part of the
 * flow; what else they touch is said here. */

/* Parts of a step whose seconds the report gives. */
enum flow_part {
    FLOW_NO_PART = -1,
    FLOW_FORCE,
    FLOW_ACCELERATION,
    FLOW_MATRIX,
    FLOW_CG,
    FLOW_VELOCITY,
    FLOW_POSITION,
    FLOW_COLLIDE,
    FLOW_OUTPUT,
    FLOW_PARTS
};

/* Seconds in bodies on one worker; each on its own cache lines, written by that worker only. */
struct flow_clock {
    _Alignas(64) double seconds[FLOW_PARTS];
    double from; /* of the body that runs: when its part of the step began */
};

/* Codes of bodies that fail. */
enum {
    FLOW_DIVERGED = 1,
    FLOW_INDEFINITE,
    FLOW_NOT_WRITTEN,
    FLOW_NO_MEMORY,
    FLOW_NOT_CONVERGED,
    FLOW_STRETCHED,
    FLOW_NO_FILTER
};

/* Rows of a block's rim that blocks on one other rank read. */
struct flow_far_rim {
    uint32_t n;
    const uint32_t *row; /* n: places in the rim, ascending */
};

/* Vertices that no face or edge uses: n of them, ascending, with their places. */
struct flow_rest {
    uint32_t n, *vertex;
    double (*position)[3];
};

/* On rank 0 as flow_prepare left it; elsewhere what rank 0 told. */
struct flow {
    const struct model *model; /* rank 0: the program's; else &told */
    struct model told;         /* without names, materials, cloths */
    uint32_t n_vertices, n_triangles;
    uint64_t n_steps, partition_hash;
    double inertia, release;   /* kg m^2, J: flow_source_inertia, flow_source_release */
    struct flow_tables tables; /* shapes */
    void *shared;              /* obstacles, key frames, slots and copies that the above point to */

    /* Rank 0 only. */
    char warning[9][512]; /* of all vertices, pinned ones, loaded ones, the solver, h, air, moduli,
                             extents, shear; empty: none */
    struct flow_source source; /* until the tables are dealt */
    uint32_t *vertex;          /* by place; from then on */
    struct flow_rest rest;
    struct flow_watched watched;
    char *header; /* of the table of probes; NULL: none */

    struct flow_filter filter; /* the program's; rows NULL: none */

    /* Of the run that is on. */
    const struct flow_progress *progress; /* tasks ask it whether to stop; NULL: nobody is asked */
    unsigned n_clocks;
    struct flow_clock *clock; /* a worker */
    struct phys_pair *sums;   /* a worker, most_entries: room for a matrix while it is assembled in
                               * half storage; else NULL */
    size_t n_sums;            /* of a worker */
    phys_vec *copies; /* a worker, two for each of most_copies: what elements see of neighbours
                       * while a task works on them; NULL: there are no elements */
    size_t n_copies;  /* of a worker */
    phys_vec *forces; /* a worker, most_rows: those that an explicit step needs for itself alone;
                       * NULL: the run is implicit */
    size_t n_forces;  /* of a worker */
    uint32_t *at; /* of each copy of all blocks: its place in what a pass reads of the neighbour */
    struct flow_far_rim *far_rim; /* of halo.c */
    uint32_t *far_row;
    enum model_preconditioner preconditioner;
    uint32_t patches;             /* of a block; patch k of block b is number patches * b + k */
    struct solve_pattern pattern; /* of the coarse factor, if there is one: of patches */
    uint32_t *first_beside;       /* then: pattern.n + 1, of each patch's neighbours among all */
    uint32_t *beside;             /* of all patches, patch after patch, ascending in each */
    struct cloth_error trouble;   /* of this rank: why it cannot begin, why a frame was not written;
                                   * changed by the main thread when no task runs, and by `frame` */
    /* On rank 0: written by the tasks `frame`, one at a time, and by the main thread when no task
     * runs. */
    const struct flow_output *output;
    double *room;    /* n_vertices x 3: positions of a frame; NULL: there is no output */
    double *row;     /* of the table of probes; NULL: it is not written */
    double *seen;    /* watched x FLOW_SEEN */
    uint64_t frames; /* written */
    uint64_t hash;
};

/* Arguments of every kernel; those that a kernel does not name are zero. */
struct flow_args {
    uint32_t block;
    uint32_t last; /* not zero: what goes wrong in this step is an error of its body; else it is
                    * only counted, and the step is made anew with half the length */
    uint64_t frame;
    uint32_t stage;  /* of a step by RK4 */
    double h, begin; /* s: length of the step; FLOW_TICKS: when it begins */
    double time;     /* s: of a frame; else at the end of the step */
    double now;      /* s: of what varies, where forces and energies are */
    double before;   /* s: of a row of probes: length of the step before */
    double part;     /* of dv */
    double guess;    /* a solve begins with dv times this; 0: from nothing */
};

/* Indices into the status of a step, F64, zero before the step and summed by its tasks. */
enum {
    FLOW_LOST = 0, /* three: sum of b - A dv over free rows */
    FLOW_STOP = 3,
    FLOW_ITERATIONS,
    FLOW_RESTARTS, /* of solves, when the true residual refused their dv */
    FLOW_ERROR,    /* square of the error of dv by the terms of the solve (cloth/solve/cg.h) and its
                    * drift, */
    FLOW_SIZE,     /* dv.D dv and */
    FLOW_RESIDUAL, /* r.D^-1 r, D the masses */
    FLOW_SHIFTED,  /* factors of blocks that were made with a shift or are of SSOR */
    FLOW_FAILED,
    FLOW_BEYOND,  /* blocks: whose solve failed; that have a row beyond all bounds */
    FLOW_TOUCHED, /* vertices that contact moved */
    FLOW_SLOPE,   /* of a Newton step: dv.b before it, */
    FLOW_CHANGE,  /* dv.M dv, */
    FLOW_WHOLE,   /* (v - base_v).M (v - base_v) after it */
    FLOW_STATUS
};
/* Indices into the peaks of a state that is watched, F64, each the largest of any block: square of
 * the speed, l / L of the springs that count for it, and minus that. */
enum { FLOW_PEAK_SPEED, FLOW_PEAK_LONGEST, FLOW_PEAK_SHORTEST, FLOW_PEAKS };
/* Numbers of a watched vertex: position, velocity, reaction; sums of a free piece. */
enum { FLOW_SEEN = 9, FLOW_PIECE_SUMS = 8 };
/* Energies, J, and after them the torque that uncorrected triangles leave, N m (kernels_energy.c).
 */
enum {
    FLOW_ENERGY_MOTION,
    FLOW_ENERGY_ELASTIC,
    FLOW_ENERGY_GRAVITY,
    FLOW_ENERGY_LOADS,
    FLOW_ENERGIES,
    FLOW_TORQUE = FLOW_ENERGIES,
    FLOW_SUMS = FLOW_TORQUE + 3
};
/* Indices into what rank 0 tells, I64 x 2. */
enum { FLOW_TELL_FRAMES, FLOW_TELL_HASH, FLOW_TELL };

/* What all ranks are told before anything else. */
struct flow_head {
    uint64_t n_steps, partition_hash;
    double inertia, release;
    uint64_t shared_bytes;                                         /* of what they are told next */
    uint32_t n_vertices, n_triangles, n_blocks, n_slots, n_copies; /* of all blocks */
    uint32_t most_rows, most_slots, most_rim, most_entries;        /* of any block */
    uint32_t most_copies, n_pieces;
    uint64_t n_elements; /* of all blocks */
    struct model model;  /* pointers mean nothing elsewhere */
};

/* What passes read of their neighbours' rims of s (halo.c). */
struct flow_far {
    duite_object *read[2]; /* a neighbour of each block, block after block: of even passes, odd */
    struct {
        duite_object object[2];
    } * rim;         /* n far rims, block after block; three numbers a row */
    uint32_t *first; /* a block, and one more: its first one */
    uint32_t n;
    size_t n_rows;
    int *home;        /* a block */
    uint32_t *number; /* room for the rows of any rim */
};

/* A step that is under way. */
struct flow_attempt {
    uint64_t begin;  /* tick */
    uint32_t length; /* ticks */
    unsigned parity; /* which status and stretch are its */
    bool forked;     /* whole: its status can be asked for */
};

/* The Newton steps of one step of time. */
struct flow_newton {
    uint64_t steps;
    bool converged;
    double status[FLOW_STATUS]; /* in place of what the solve of a linear step notes */
};

/* A run as the main program sees it; the same on every rank. */
struct flow_state {
    struct flow *flow;
    duite *rt;
    const struct flow_output *output;
    struct flow_report *report;
    struct cloth_error *error;
    struct flow_objects *block;
    struct flow_far far;
    duite_graph solve; /* a round of conjugate gradients */
    struct flow_run_objects run;
    unsigned pass; /* of a round that is recorded: 0 or 1; else 0 */
    struct flow_newton newton;
    uint32_t length; /* ticks of the last step accepted, and of the one before it; 0: none yet */
    uint32_t length_before;
    uint32_t
        guessed; /* ticks of the step that left dv, if the next solve may begin with it; else 0 */
    uint32_t smooth; /* ticks of the step before, if contact had no part in it; else 0, and then the
                      * next step is by implicit Euler where the others are by BDF2 */
    struct flow_head head;
    duite_object *refs;    /* room for the objects of any task */
    double *rows;          /* room for the rows of any block, or a number for each neighbour */
    unsigned char *bytes;  /* rank 0: a part of the state, to be hashed, */
    XXH64_state_t *hash;   /* and what was hashed so far */
    duite_counters before; /* what was counted before the first step */
    struct flow_grid grid;
    struct flow_attempt attempt;
    bool settled_forces; /* f is that of x and v (velocity Verlet) */
    double longest;      /* largest stretch at grid.now, if steps are judged by it */
    struct flow_guard guard;
    char reason[600]; /* why no step is short enough */
    uint64_t next_frame;
    double shown;  /* tick of the last frame */
    bool begun;    /* all ranks have their memory, objects are made */
    bool stopping; /* a stop was agreed: no more steps begin */
    bool resting;  /* it rests: ends after the next frame */
    double moved;  /* s: when it was last seen too fast for that */
};

/* Whether frames are wanted. */
static inline bool flow_shows(const struct flow_state *state)
{
    return state->output && state->output->frame;
}

/* Whether rows of probes are wanted. */
static inline bool flow_tells(const struct flow_state *state)
{
    return state->flow->model->n_probes && state->output && state->output->row;
}

/* Fills flow->warning; on rank 0, where the source is made. Errors: CLOTH_E_MEMORY. Local. */
int flow_warn(struct flow *flow, struct cloth_error *error);

/* Functions of the main program. Collective. They return 0 or what duite returned, which flow_run
 * turns into a sentence. */
/* All of the below: the run is ready for its first task. To be ended as flow_run does. */
int flow_run_begin(struct flow_state *state);
/* Tells all ranks how much there is to be told. */
int flow_share_head(struct flow_state *state);
/* Tells them the shapes of all blocks; fills flow->tables. */
int flow_share(struct flow_state *state);
/* Brings the tables, made one by one on rank 0, to the ranks that keep their blocks. Objects are
 * made. Rank 0 has freed its source then. */
int flow_deal(struct flow_state *state);

/* A position or velocity as it is hashed: little-endian doubles x y z. */
enum { FLOW_VERTEX_BYTES = 24 };
/* Vertices whose positions or velocities are hashed at once. */
uint32_t flow_hash_part(const struct flow *flow);

/* All memory that a run needs besides its objects, and whether all ranks have it: if one has not,
 * all return FLOW_NO_MEMORY and none has begun. To be freed in either case. */
int flow_memory_take(struct flow_state *state);
int flow_memory_agree(struct flow_state *state); /* the same for what was taken since */
void flow_memory_free(struct flow_state *state);

/* What a run's preconditioner is made of. An explicit run has none. */
static inline bool flow_is_preconditioned(const struct flow *flow)
{
    return flow->preconditioner != MODEL_PLAIN;
}
static inline bool flow_is_coarse(const struct flow *flow)
{
    return flow->preconditioner == MODEL_COARSE || flow->preconditioner == MODEL_IC0_COARSE;
}
static inline enum solve_local flow_local(const struct flow *flow)
{
    return flow->preconditioner == MODEL_IC0 || flow->preconditioner == MODEL_IC0_COARSE
               ? SOLVE_IC0
               : SOLVE_JACOBI;
}

/* Decides on the preconditioner of a run: the model's, but no coarse part of more than
 * SOLVE_MOST_BLOCKS blocks; and on patches. Local. */
void flow_preconditioner_choose(struct flow *flow, uint32_t n_blocks);
/* That once more on all ranks, and the pattern of the coarse factor, if there is one. */
int flow_preconditioner_prepare(struct flow_state *state);
/* Local. */
void flow_preconditioner_free(struct flow *flow);
/* Forks what the coarse space is, if there is one: once a run, or with contact in the solve in each
 * step. */
int flow_coarse_initialise(struct flow_state *state);

/* Forks `kernel` on one block: first its table, then the objects given, then the neighbours'
 * objects at `offset` in struct flow_objects (and at `offset2`); FLOW_NO_RIM: none. */
enum { FLOW_NO_RIM = -1 };
#define FLOW_RIM(name) (long)offsetof(struct flow_objects, name)
int flow_fork(struct flow_state *state, const duite_kernel *kernel, const struct flow_args *args,
              size_t n, const duite_object *objects, long offset, long offset2);

/* The objects of a block, by name: FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v)). */
#define FLOW_AT(name)     (long)offsetof(struct flow_objects, name)
#define FLOW_OBJECTS(...) ((const long[]){__VA_ARGS__, FLOW_NO_RIM})

/* What follows the objects of a block: nothing, the status of the step, or before it the scalars of
 * a solve. */
enum flow_behind { FLOW_NOTHING, FLOW_THEN_STATUS, FLOW_THEN_SCALARS_AND_STATUS };

/* Forks one kernel on every block, like flow_fork. args: of all of them but for the block; objects:
 * offsets of a block's own, FLOW_OBJECTS. */
int flow_fork_all(struct flow_state *state, const duite_kernel *kernel, struct flow_args args,
                  const long *objects, enum flow_behind behind, long rim, long rim2);

/* Forks the start of all blocks; what copies x and v to what is kept, or to two others in its
 * place; what makes it the state again. */
int flow_initialise(struct flow_state *state);
int flow_keep(struct flow_state *state);
int flow_keep_as(struct flow_state *state, const struct flow_as *as);
int flow_restore(struct flow_state *state);
/* Forks what notes in the status of the step whether a rank is asked to stop. */
int flow_status_fork(struct flow_state *state);
/* Whether its explicit steps leave the state before them as what is kept; then, what makes that the
 * state again. */
bool flow_explicit_keeps(const struct model *model);
void flow_explicit_restore(struct flow_state *state);
/* Forks what makes the system of a step of implicit Euler, linearised where it begins: its right
 * side f, its matrix a. */
int flow_assemble(struct flow_state *state);
/* Whether the step under way is by BDF2, and not by implicit Euler as the first one is. */
bool flow_implicit_is_second(const struct flow_state *state);
/* When the status of a step is known: adds what its Newton steps noted. Then, when it is accepted
 * or not: what the next step may build on, and the report. */
void flow_implicit_status(const struct flow_state *state, double status[FLOW_STATUS]);
void flow_implicit_settle(struct flow_state *state, bool accepted,
                          const double status[FLOW_STATUS]);
/* Steps are judged by their stretch. */
static inline bool flow_is_judged(const struct model *model)
{
    return model->stretch_growth > 0 || model->stretch_limit > 0;
}
/* Fork the stages of the step under way (step.c): its begin, which leaves x and v as they are,
 * unless velocities change before the forces; the rest. */
int flow_step_begin(struct flow_state *state);
int flow_step_end(struct flow_state *state);
/* Whether they do: such a step does not begin before the one before it is accepted. */
bool flow_step_is_driven(const struct model *model);
/* Forks a step of length h whole, which nobody judges and whose solve has no guess. */
int flow_step(struct flow_state *state);
/* All steps from the start on, with their frames; ends early if a stop was agreed. */
int flow_steps(struct flow_state *state);
/* Forks what finds the largest stretch of the current positions. */
int flow_stretch_fork(struct flow_state *state);
/* What it found. */
int flow_stretch_get(struct flow_state *state, double *stretch);
/* s: of the steps accepted so far. */
static inline double flow_time(const struct flow_state *state)
{
    return (double)state->grid.now * state->flow->model->h / FLOW_TICKS;
}
/* Arguments of tasks of the step under way. */
struct flow_args flow_attempt_args(const struct flow_state *state);
/* Records a round of the solve; once a run, when its objects are made. */
int flow_cg_record(struct flow_state *state);
/* Forks what a solve for dv begins with, which reads f and a; then its iterations; both, without a
 * guess. */
int flow_cg_start(struct flow_state *state);
int flow_cg_iterate(struct flow_state *state);
int flow_cg(struct flow_state *state);

/* What a solve reads of neighbours: memory, a part of flow_memory_take; which objects these are,
 * when the others are made (a failure is returned by the next get); forks of the tasks that pack
 * the far rims of a block, for even passes or odd ones. */
void flow_halo_take(struct flow_state *state);
void flow_halo_free(struct flow_state *state);
void flow_halo_make(struct flow_state *state); /* flow_run_begin does */
int flow_halo_pack(struct flow_state *state, uint32_t block, int to);

/* Fork what moves the pins of a step: before its forces, and when x has moved. */
int flow_pins_drive(struct flow_state *state);
int flow_pins_place(struct flow_state *state);

/* Fork contact (contact.c): before the forces, velocities that end the step on an obstacle; what
 * the solves of a step are filtered by, from x, v and f; the filter on the right side and in the
 * matrix; after the step, what puts vertices out of obstacles. */
int flow_contact_touch(struct flow_state *state);
int flow_contact_filter(struct flow_state *state, struct flow_args args);
int flow_contact_hold(struct flow_state *state, struct flow_args args);
int flow_contact_project(struct flow_state *state);

/* Forks what is watched of the state at the end of the step under way, or at the start. */
int flow_watch(struct flow_state *state);
/* Forks its row of the table of probes. */
int flow_probes_row(struct flow_state *state);
/* The same if probes are wanted, and finds whether the run rests: when the step is accepted,
 * and for the start. */
int flow_watched(struct flow_state *state);
/* The tick, not rounded, that a frame shows. */
double flow_frame_tick(const struct model *model, uint64_t frame);
/* Forks the frames whose nearest end of a step is known: the last step, accepted, went from tick
 * `from` to grid.now. */
int flow_frames(struct flow_state *state, uint64_t from);
/* Forks a frame of the state at grid.now, where the run ends, unless the last frame shows it. */
int flow_frame_last(struct flow_state *state);

/* Doubles that a block says of its system; forks what hands the system of the last step to the
 * program. */
size_t flow_system_doubles(const struct flow_table *table);
int flow_system(struct flow_state *state);

/* Fills the parts of the report that need the whole state, when no task runs. */
int flow_finish(struct flow_state *state);
/* The number of frames written, from rank 0 to all. */
int flow_last_frame(struct flow_state *state);

/* Seconds since some start. Local. */
double flow_now(void);

#endif
