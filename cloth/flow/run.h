#ifndef CLOTH_FLOW_RUN_H
#define CLOTH_FLOW_RUN_H

#include "cloth/model/model.h"
#include "cloth/solve/block.h"
#include "cloth/solve/system.h"

#include <duite.h>
#include <stdbool.h>

/* Runs a model on a duite runtime. The same on every rank. */

/* Energies, J. Those of weights and of constant forces are zero at the origin. Symplectic Euler has
 * v half a step before x; `kinetic` is of v half a step on. */
struct flow_energy {
    double kinetic, elastic, gravity, loads;
    double contact; /* held by certified contacts (contact/row.h) */
};

/* The first reason why a step is begun again with half its length: its solve failed; a position,
 * velocity or edge is out of bounds or no number; an edge is stretched too far; it gained energy;
 * contact cuts too much of it. */
enum flow_cause {
    FLOW_CAUSE_SOLVE,
    FLOW_CAUSE_BOUNDS,
    FLOW_CAUSE_STRETCH,
    FLOW_CAUSE_ENERGY,
    FLOW_CAUSE_CONTACT,
    FLOW_CAUSES
};

/* The result of a run; filled on every rank, alike on all except for times. */
struct flow_report {
    uint64_t vertices, triangles, blocks, grain, partition_hash;
    uint64_t steps;                            /* made, of any length */
    uint64_t newton_steps, newton_unconverged; /* Newton steps; steps of time whose last Newton step
                                                  was not small enough; 0 where there is but one */
    uint64_t steps_halved; /* how often a step was given up and begun again with half the length, */
    uint64_t halved_by[FLOW_CAUSES]; /* and why */
    uint64_t contacts;               /* certified contact: the most at a time; */
    uint64_t contact_pairs;          /* pairs of features that were certified, in every look; */
    uint64_t contact_solves;         /* solves of steps beyond their first; */
    uint64_t contact_pushes;         /* how often a vertex was pushed out of another's way; */
    uint64_t contact_cuts;           /* how often a vertex's way was cut; */
    uint64_t contact_cut_run;        /* most steps in a row, of those made, that cut one vertex; */
    uint64_t contact_queries;        /* how often two sides were looked at, and */
    uint64_t contact_queries_again;  /* of these again in a step, after another solve or a cut; */
    uint64_t contact_graphs;         /* how often the round of the solve was recorded again; */
    uint64_t contacts_now;           /* at the end of the last step accepted */
    uint64_t contact_pinches;        /* contacts that came to be pinched (flow/contact/pinch.c) and
                                      * compressed (contact/row.h); */
    char contact_pinch[240];         /* the first of them; as rank 0 has it */
    double
        contact_cut_momentum; /* kg m/s: changed by pushes and cuts, summed over the steps made */
    uint64_t steps_retaken;   /* how often one by BDF2 gained energy and was made again by implicit
                                 Euler */
    uint64_t frames;          /* with those before the run, and before flow_output.first_frame */
    uint64_t cg_iterations_total, cg_iterations_max; /* iterations: of the steps made */
    double shortest_step;                            /* s */
    double simulated_seconds, wall_seconds;          /* wall: from the first step on */
    double seconds_force, seconds_acceleration, seconds_matrix, seconds_cg, seconds_velocity,
        seconds_position, seconds_collide, seconds_correction,
        seconds_output;   /* in task bodies, over all workers and ranks; NaN: there were none */
    double momentum_lost; /* largest |sum of b - A dv over the vertices not held| of a step, kg m/s,
                           * of the dv that the step used; NaN for an explicit run */
    double
        mass_norm_error;  /* largest error of a step's dv, as conjugate gradients estimate it in the
                           * norm of A, against dv in the mass norm; NaN for an explicit run */
    uint64_t cg_restarts; /* of solves that the true residual refused, in the steps made */
    uint64_t
        factors_shifted; /* blocks times steps whose IC(0) needed a shift, or gave way to SSOR */
    uint64_t correction_rounds; /* of velocity correction that corrected something, in all steps */
    uint64_t corrections_unmet; /* steps that ended with edges over their limit by more than the
                                 * tolerance, since there were no more rounds */
    double correction_excess;   /* largest excess of an edge when a step ended, of its length; NaN:
                                 * velocities are not corrected */
    double energy_corrected;    /* J: kinetic energy that corrections took; NaN but with
                                 * energy_steps */
    double max_stretch;         /* largest length / rest length of any stretch spring at the end */
    double stretch_highest; /* the largest of these at the start and after any step; NaN where steps
                               are not judged by it (model: stretch_growth, stretch_limit) */
    struct flow_energy start, end; /* of all vertices */
    double torque_left;            /* at the end, of the forces of uncorrected triangles, N m */
    double energy_lent;            /* J: by contacts, with energy_steps; else NaN */
    double energy_lowest, energy_highest, /* of their sum, at the start and after each step; */
        energy_lowest_unlent, energy_gained_unlent, /* of it less energy_lent */
        energy_gained; /* the most that it rose above an earlier one; NaN but with energy_steps */
    uint64_t state_hash;
    uint64_t last_frame;        /* the last frame written, as it was numbered */
    bool stopped;               /* a stop was requested before the end */
    double rest_seconds;        /* when the run was found at rest, s; NaN: it was not */
    uint64_t seams, seams_open; /* that are pulled; of these, open at the end by more than the
                                 * model's distance, or 1 mm; */
    double seam_distance;       /* the largest distance of partners at the end, m; */
    double sewn_seconds;        /* since when all have been closed, s; NaN: they are not */
    duite_counters counters;
};

/* The runs before one that continues them. */
struct flow_before {
    bool goes_on;           /* it does; else all of this is zero */
    uint64_t frames, steps; /* of the runs before it, all together; frames keep their clock */
    double time;            /* s: that they took */
};

/* The whole state of a run between two steps, for a run of the same model later, on any ranks of
 * machines of the same kind: opaque bytes. */
struct flow_checkpoint {
    unsigned char *bytes;
    size_t n;
};

/* Other fields of scientific frames, of n vertices in the numbering of the input meshes. */
struct flow_beside {
    const double *velocity;      /* n x 3, m/s */
    const int32_t *block, *rank; /* n: the block, and the rank that has it; -1 of vertices that no
                                  * block has */
};

/* The places of vertices and blocks when a frame is shown. */
struct flow_places {
    const int32_t *block; /* of each vertex; -1 of those that no block has */
    uint32_t n_blocks;
    const int32_t *rank; /* n_blocks: that keeps each */
};

/* The receivers of frames and systems, from the program. Called on rank 0 only, from one task at a
 * time. */
struct flow_output {
    void *context;
    struct flow_before before; /* numbers and times of frames and rows count from it; the same on
                                  all ranks */
    /* On rank 0: room for 6 numbers a vertex, the end of the run, as model_cloth.start has them.
     * NULL: it is not wanted. */
    double (*end)[6];
    /* The first of the run's frames that is handed over, whose number is 0 then, and the one before
     * which they end; 0: there is no end. The same on all ranks. */
    uint64_t first_frame, end_frame;
    /* Frames in their order; NULL: none are wanted. */
    /* position: vertices x 3 in the numbering of the input meshes, cloth after cloth. time in
     * seconds. Returns 0 or a code and fills error. */
    int (*frame)(void *context, uint64_t frame, double time, const double *position,
                 struct cloth_error *error);
    /* The number of frames that are written for certain after one failed, which may be one before
     * that. NULL: all that were handed over before. */
    uint64_t (*written)(void *context);
    /* The places in a frame, before it. The arrays are lent. NULL: they are not wanted. */
    int (*places)(void *context, uint64_t frame, const struct flow_places *places,
                  struct cloth_error *error);
    /* The force of contact on each vertex in the step that ended at a frame, N, after the frame and
     * arranged as its positions. Only with certified contact. NULL: it is not wanted. */
    int (*force)(void *context, uint64_t frame, const double *force, struct cloth_error *error);
    /* After a frame that model.hdf5 takes, its other fields, unless none is wanted. The arrays are
     * lent. */
    int (*beside)(void *context, const struct flow_beside *beside, struct cloth_error *error);
    /* A row of the table of probes, of the state after so many steps, from 0 on: n numbers with the
     * names of flow_header. Returns 0 or a code and fills error. NULL: it is not wanted. */
    int (*row)(void *context, uint64_t step, double time, size_t n, const double *values,
               struct cloth_error *error);
    /* The system of the last step and the state after it, once, of an implicit run that made a
     * step. The arrays are lent. Returns 0 or a code and fills error. NULL: it is not wanted. */
    int (*system)(void *context, const struct solve_system *system, struct cloth_error *error);
    /* The state between two steps, when a checkpoint is due (flow_progress.due), before a stop, and
     * at the end. The bytes are the program's from then on (free); NULL: there was no memory for
     * them. Frames and rows before it were handed over before. NULL: it is not wanted. */
    void (*save)(void *context, struct flow_checkpoint state);
};

/* Calls made during a run; the main thread of rank 0 calls `step` after each step, when the next
 * one is under way. May be NULL. */
struct flow_progress {
    void *context;
    /* The meshes of the model are not read any more: all blocks have their tables. Called once,
     * before the first step. May be NULL. */
    void (*distributed)(void *context);
    /* step: how many of the steps of length h are over, or begun; after each shorter step, too.
     * cg_iterations: of this step. */
    void (*step)(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations);
    /* Nonzero, on any rank, asks the run to finish the steps that have begun, to show the state
     * after them in a frame, and to stop. Asked in each step, on every rank, from tasks
     * of several threads at once. May be NULL. */
    int (*stop)(void *context);
    /* Nonzero asks for a checkpoint: the run makes one within two steps, and asks again after each
     * step. Asked on rank 0 only, from a task. May be NULL. */
    int (*due)(void *context);
};

/* Kernels to list at duite_start, ended by NULL, and the context for duite_options.context. */
const duite_kernel *const *flow_kernels(void);

struct flow; /* a model made ready, or room for one */

/* On rank 0 of the run: cuts the model into blocks and prepares their tables. Needs no runtime.
 * Checks pins inside the mesh, masses, lengths of springs, starts out of bounds, more ranks than
 * blocks, which a scene alone cannot. Errors begin with the place that the model gives. The model
 * must outlive the flow, its meshes until flow_progress.distributed is called. Local. */
int flow_prepare(struct flow **flow, const struct model *model, int ranks,
                 struct cloth_error *error);

/* On the other ranks, which know no model: rank 0 sends it in flow_run. Error: CLOTH_E_MEMORY.
 * Local. */
int flow_join(struct flow **flow, struct cloth_error *error);

/* On rank 0, before flow_run: lets the run go on from a checkpoint of the same model, whose end may
 * be later. The bytes begin at a multiple of 8 and must live until flow_run returns. *at says how
 * far it is. Error: CLOTH_E_INPUT if it is of another model or version: a sentence about "the
 * checkpoint". Local. */
struct flow_resumed {
    uint64_t steps;  /* of the run that it is of: rows of its table of probes */
    uint64_t frames; /* that are to stay; of this run, and those before it */
    double time;     /* s */
    double end;      /* s: of the run that it is of */
};
int flow_resume(struct flow *flow, struct flow_checkpoint from, struct flow_resumed *at,
                struct cloth_error *error);

/* Runs it to the end on a runtime that was started with flow_kernels() and `flow` as its context;
 * `output` is given on all ranks or on none. First the tables of the blocks go to the ranks that
 * keep them: a flow runs once. Collective, the same result on every rank. On failure `report` still
 * says how many steps were done and which frame was written last. Errors:
 *
 * - CLOTH_E_RUN: the run diverged, a matrix is not positive definite, a solve needs more than
 *   max_iterations, or a cloth stretches too far; where steps are halved, in one of h/1024
 * - CLOTH_E_IO: a frame was not written
 * - CLOTH_E_MEMORY: of any rank
 * - CLOTH_E_LIBRARY
 * - CLOTH_E_LOST: MPI may not be called any more; other ranks need not get this one */
int flow_run(struct flow *flow, duite *rt, const struct flow_output *output,
             const struct flow_progress *progress, struct flow_report *report,
             struct cloth_error *error);

/* Adds counters to others (sign 1), or takes them away (-1). Pure. */
void flow_counters_add(duite_counters *to, const duite_counters *of, int sign);

/* Vertices of all cloths together; 0 where a flow only joined and has not run. Local. */
uint64_t flow_vertices(const struct flow *flow);

/* The triangles of a cloth that are lower at rest than contacts reach; n 0 where nothing meets.
 * Local. */
void flow_find_low(const struct model *model, uint32_t cloth, struct mesh_low *low);

/* The start of a run: 3 numbers a vertex, m, in the input's numbering. On rank 0, before the run.
 * Local. */
void flow_start(const struct flow *flow, double *position);

/* The start before seams are welded, by vertex; NULL: none are. Lives until the run. */
const double (*flow_unwelded(const struct flow *flow))[3];

/* The start with velocities, m/s: 6 numbers a vertex, as model_cloth.start has them. held: 1 if a
 * pin holds or moves the vertex, else 0. On rank 0, before the run. Local. */
void flow_starts(const struct flow *flow, double (*start)[6], unsigned char *held);

/* The obstacle, from 1, that the pin of each vertex follows, or 0; in the input's numbering. NULL:
 * no pin follows one. On rank 0 when the flow is prepared. Lives as long as the flow. Local. */
const uint32_t *flow_attached(const struct flow *flow);

/* Names of the columns of the table of probes, with commas between: step, time, then those of its
 * rows' numbers, with units. NULL: the model has no probes. On rank 0 when the flow is prepared.
 * Lives as long as the flow. Local. */
const char *flow_header(const struct flow *flow);

/* Warning i about the model, counted from 0, with its place; NULL: there are no more. Lives as long
 * as the flow. Local. */
const char *flow_warning(const struct flow *flow, size_t i);

void flow_free(struct flow *flow);

#endif
