#ifndef CLOTH_FLOW_STATE_STATE_H
#define CLOTH_FLOW_STATE_STATE_H

#include "cloth/flow/observe/energy.h"
#include "cloth/flow/run/grid.h"
#include "cloth/flow/state/flow.h"
#include "cloth/flow/state/kernels.h"

#include <xxhash.h>

/* A run as its main program sees it: arguments of tasks, their sums, and the state itself. */

/* Arguments of a kernel that needs its block alone. */
struct flow_block_args {
    uint32_t block;
};

/* Those of a kernel that has a part in a step. Other arguments are a structure of their own beside
 * the kernel. If they are these and more, they begin with
 *
 *     union {
 *         uint32_t block;
 *         struct flow_step_args step;
 *     };
 */
struct flow_step_args {
    uint32_t block;
    uint32_t last;   /* not zero: a failure in this step is an error of its body; else it is only
                        counted, and the step is made again with half the length */
    double h, begin; /* s: length of the step; FLOW_TICKS: when it begins */
    double time;     /* s: at the end of the step */
    double now;      /* s: of what varies, where forces and energies are */
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
    FLOW_BEYOND,    /* blocks: whose solve failed; that have a row beyond all bounds */
    FLOW_TOUCHED,   /* vertices that contact moved */
    FLOW_CORRECTED, /* rounds of a velocity correction; their steps that need more; the largest
                     * excess that they leave; the kinetic energy that they took, J */
    FLOW_CORRECTION_UNMET,
    FLOW_CORRECTION_EXCESS,
    FLOW_CORRECTION_ENERGY,
    FLOW_SLOPE,   /* of a Newton step: dv.b before it, */
    FLOW_CHANGE,  /* dv.M dv, */
    FLOW_WHOLE,   /* (v - base_v).M (v - base_v) after it */
    FLOW_PINCHES, /* pinched contacts that follow the law from this step on */
    FLOW_DUE,     /* a checkpoint is due */
    FLOW_STATUS
};
/* Indices into the peaks of a watched state, F64. Each is the largest of any block: square of the
 * speed; l / L of the springs that count for it; minus that. */
enum { FLOW_PEAK_SPEED, FLOW_PEAK_LONGEST, FLOW_PEAK_SHORTEST, FLOW_PEAKS };
/* Numbers of a watched vertex: position, velocity, reaction, force of contact; sums of a free
 * piece. */
enum { FLOW_PROBE_VALUES = 12, FLOW_PIECE_SUMS = 5 };
/* Energies, J, and after them the torque that uncorrected triangles leave, N m (observe/energy.c).
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
/* Counts that a task of two sides adds, of their meeting: failing pairs; certified pairs; items of
 * its list, with or without room; items that the first side keeps; the second. */
enum {
    FLOW_COUNT_FAILS,
    FLOW_COUNT_FAILING, /* points of both sides that pairs fail at */
    FLOW_COUNT_PASSES,
    FLOW_COUNT_ALL,
    FLOW_COUNT_FIRST,
    FLOW_COUNT_SECOND,
    FLOW_COUNTS
};
/* Numbers of a box: low and high corner; how many points moved since the look before. */
enum { FLOW_ROOT = 7, FLOW_ROOT_MOVED = 6 };
/* Counts of cuts: rows; rows that lose more than half; blocks whose rank is asked to stop; the
 * change of the momentum of rows, three numbers, kg m/s. */
enum {
    FLOW_CUT_ROWS,
    FLOW_CUT_HALVED,
    FLOW_CUT_STOP,
    FLOW_CUT_MOMENTUM,
    FLOW_CUT_COUNTS = FLOW_CUT_MOMENTUM + 3
};
/* Energy that contacts hold, and the part of it that they were lent in the step. */
enum { FLOW_HELD_ALL, FLOW_HELD_LENT, FLOW_HELD };
/* Indices into the broadcast of rank 0, I64 x 2. */
enum { FLOW_BROADCAST_FRAMES, FLOW_BROADCAST_HASH, FLOW_BROADCAST };

/* A position or velocity as it is hashed: little-endian doubles x y z. */
enum { FLOW_VERTEX_BYTES = 24 };

/* Rank 0 broadcasts this before anything else. */
struct flow_head {
    struct flow_numbers numbers;
    uint64_t shared_bytes;  /* of the next broadcast */
    uint64_t resumed_bytes; /* the main program's part of a checkpoint; 0: none */
    uint64_t n_elements;    /* of all blocks, */
    uint32_t n_blocks, n_neighbours, n_ghosts;                            /* as these */
    uint32_t max_rows, max_neighbours, max_halo, max_entries, max_ghosts; /* of any block */
    uint32_t n_pieces, n_ties, n_anchors;
    struct model model; /* pointers mean nothing elsewhere */
};

/* The halos of s that passes read of their neighbours (halo.c). */
struct flow_packed {
    duite_object *read[2]; /* a neighbour of each block, block after block: of even passes, odd */
    struct {
        duite_object object[2];
    } * halo;        /* n packed halos, block after block; three numbers a row */
    uint32_t *first; /* a block, and one more: its first one */
    uint32_t n;
    size_t n_rows;
    int *home;        /* a block */
    uint32_t *number; /* room for the rows of any halo */
};

/* The groups of the coarse part (cloth/flow/solver/levels.h), level after level: n, 0 if there is
 * no level. */
struct flow_groups {
    uint32_t n;
    struct flow_group {
        duite_object factor, coupling; /* of what it covers; as a node of the level above */
        duite_object part, motion;     /* its result of a pass; its part of s */
    } * all;
    unsigned char *mark; /* n: room */
};

/* The room and links of ties in the blocks. Arrays are NULL if the run has no ties. */
struct flow_tied_blocks {
    struct flow_tie_room *room; /* a block */
    uint32_t *first;            /* a block, and one more: which of `other` are its */
    uint32_t *other;            /* blocks that it shares ties with, ascending in a block, */
    uint32_t *place;            /* and where each shows the first row for it (flow_ties) */
};

/* The records of the blocks' ties. */
struct flow_tie_records {
    struct flow_tie_record *of; /* a block */
    uint32_t *first;            /* a block, and one more: which links are its */
    struct flow_tie_link *link; /* at most max_links */
    uint32_t max_links;
};

/* The ties that steps have now. */
struct flow_tied {
    uint64_t from, to; /* ticks: steps that begin there have these; to 0: none was chosen yet */
    struct flow_tied_blocks now,
        next; /* next: the state before; while ties are chosen, the coming one */
    struct flow_tie_records said; /* for flow_ties_adopt */
    uint64_t *scratch;            /* to make the records of joints */
    uint32_t (*links)[2];         /* values for the field `tie_links` of a block */
    uint32_t *parent;             /* a piece: room to unite them */
    uint64_t *group;              /* a piece: values for the field `groups` */
};

/* Two sides whose features may come near each other (cloth/flow/contact/contact.h). */
struct flow_meeting {
    uint32_t side[2];  /* ascending, or the same */
    uint32_t room;     /* its list has room for so many items */
    duite_object near; /* its list */
    enum flow_looks { FLOW_LOOKS_NOT, FLOW_LOOKS_AGAIN, FLOW_LOOKS } looks; /* in this round */
};
/* All of them, by their sides. */
struct flow_meetings {
    uint32_t n, room;
    struct flow_meeting *all;
    duite_object *counts; /* of FLOW_MEETING_GROUP meetings each: FLOW_COUNTS numbers a meeting, */
    double *counted;      /* what they are in this round, and */
    double *count;        /* when each was looked at last */
};
enum { FLOW_MEETING_GROUP = 64 };
static inline uint32_t flow_meeting_groups(const struct flow_meetings *meetings)
{
    return (meetings->n + FLOW_MEETING_GROUP - 1) / FLOW_MEETING_GROUP;
}

/* The lists of a block's contacts, of the fields `contacts` and the two behind it: each has room
 * for so many, and at most n of them are there. */
struct flow_kept_contacts {
    struct flow_kept_list {
        uint32_t room, n;
    } list[3];
};

/* The step that bodies have points and boxes of (cloth/flow/contact/body.h). */
struct flow_bodies_now {
    bool made; /* there is one */
    uint64_t begin;
    uint32_t length; /* ticks, as of an attempt */
};

/* The maps of bodies as they are (cloth/flow/contact/image.h). */
struct flow_maps_now {
    bool drawn;  /* they are, */
    double from; /* at the end of a step that began then, s */
};

/* Certified contact as the main program sees it. */
struct flow_contact_state {
    struct flow_meetings meetings;
    struct flow_kept_contacts *kept; /* a block */
    bool kept_begin; /* kept_contacts are those where the step began; else `contacts` are */
    struct contact_solid *solid; /* an obstacle that is no body: where it is over the step */
    struct flow_bodies_now bodies;
    double *root; /* a block, then an obstacle that is a body: the box around its skin over the
                   * step, low and high, m */
    /* a block: contacts that the last look found; at most so many of them fail */
    uint32_t *found, *failing;
    unsigned char *mark; /* a side: room */
    unsigned char *said; /* the records of all blocks' ties */
    duite_object *refs;  /* room for the lists of meetings of any task */
    uint64_t near;       /* how many contacts there are at the end of the step */
    uint64_t cut;        /* how often a way was cut in the step */
    uint64_t pushed;     /* contacts of the step that springs push apart */
    uint64_t cut_run;    /* most steps in a row that a row was cut in, of those cut in the step */
    uint32_t attempt, accepted; /* the step under way, of all that were begun, from 1 on; the last
                                 * one that was accepted; 0: none */
    double cut_momentum;        /* kg m/s: changed by cuts in the step */
    bool failed;  /* no cut ends the step: it is to be made again with half the length */
    bool stopped; /* the step is given up for a stop, as if it had not begun; its begin had */
    uint32_t guessed, smooth;    /* these (struct flow_lasting) */
    double iterations, restarts; /* of the solves of this step but the last */
};

/* A step that is under way. */
struct flow_attempt {
    uint64_t begin;  /* tick */
    uint32_t length; /* ticks */
    bool forked;     /* whole: its status can be asked for */
};

/* The Newton steps of one step of time. */
struct flow_newton {
    uint64_t steps;
    bool converged;
    double status[FLOW_STATUS]; /* in place of the notes of a linear step's solve */
};

/* The state of the main program between two steps, from which the next ones go on: checkpoints have
 * it. length: ticks of the last step accepted, length_before: of the one before it; 0: none yet.
 * guessed: ticks of the step that left dv if the next solve may begin with it; else 0. smooth:
 * ticks of the step before if contact had no part in it; else 0, and the next step of BDF2 is by
 * implicit Euler. settled_forces: f is that of x and v (velocity Verlet). longest: largest stretch
 * at grid.now, if steps are judged by it. shown: tick of the last frame. certain: next_frame and
 * shown without the frames that only the end of the run called for. resting: it rests, and ends
 * after the next frame. sewn: likewise for a run that waits for seams, when all are closed. over:
 * it ended so. moved: s, when it was last seen too fast to rest. */
struct flow_frames_so_far {
    uint64_t next;
    double shown;
};
#define FLOW_LASTING(X)                                                                            \
    X(struct flow_grid, grid)                                                                      \
    X(struct flow_guard, guard)                                                                    \
    X(struct flow_frames_so_far, certain)                                                          \
    X(uint64_t, next_frame)                                                                        \
    X(double, shown)                                                                               \
    X(double, longest)                                                                             \
    X(double, moved)                                                                               \
    X(uint32_t, length)                                                                            \
    X(uint32_t, length_before)                                                                     \
    X(uint32_t, guessed)                                                                           \
    X(uint32_t, smooth)                                                                            \
    X(bool, settled_forces)                                                                        \
    X(bool, resting)                                                                               \
    X(bool, sewn)                                                                                  \
    X(bool, over)
struct flow_lasting {
    FLOW_LASTING(FLOW_MEMBER)
};

/* A run as the main program sees it; the same on every rank. */
struct flow_state {
    struct flow *flow;
    duite *rt;
    const struct flow_output *output;
    struct flow_report *report;
    struct cloth_error *error;
    struct flow_objects *block;
    struct flow_packed packed;
    struct flow_groups groups;
    struct flow_tied tied;
    struct flow_contact_state contact;
    struct flow_maps_now maps;
    duite_graph solve;   /* a round of conjugate gradients */
    duite_graph correct; /* two rounds of velocity correction */
    struct flow_run_objects run;
    unsigned pass; /* of a round that is recorded: 0 or 1; else 0 */
    struct flow_newton newton;
    struct flow_head head;
    duite_object *refs;    /* room for the objects of FLOW_FORKS_AHEAD tasks, */
    size_t max_refs;       /* of so many each */
    double *rows;          /* room for the rows of any block, or a number for each neighbour */
    unsigned char *bytes;  /* rank 0: a part of the state, to be hashed, */
    XXH64_state_t *hash;   /* and its hash so far */
    duite_counters before; /* the counters before the first step */
    int code;              /* the first failure: from then on nothing is forked, set or got */
    union {                /* by name, or all of it */
        struct flow_lasting lasting;
        struct {
            FLOW_LASTING(FLOW_MEMBER)
        };
    };
    struct flow_attempt attempt;
    char reason[600];     /* why no step is short enough */
    bool begun;           /* all ranks have their memory, objects are made */
    bool stopping;        /* a stop was agreed: no more steps begin */
    bool complete;        /* a checkpoint that it goes on from has all steps */
    bool saving;          /* a checkpoint is due: no step begins before it */
    double saved_wall;    /* s: of the runs that it goes on from */
    double from;          /* s: when the first step began */
    double *seam_squares; /* the field seam_peaks, of the last step */
};

static inline struct flow_before flow_before(const struct flow_state *state)
{
    return state->output ? state->output->before : (struct flow_before){0};
}

/* The run's number of the first frame that is handed over. */
static inline uint64_t flow_first_frame(const struct flow_state *state)
{
    return state->output ? state->output->first_frame : 0;
}

static inline bool flow_shows(const struct flow_state *state)
{
    return state->output && state->output->frame;
}

static inline bool flow_writes_probes(const struct flow_state *state)
{
    return state->flow->model->n_probes && state->output && state->output->row;
}

/* True if frames have the force of contact. True if frames or probes report it. */
static inline bool flow_shows_contact(const struct flow_state *state)
{
    return model_shows_contact(state->flow->model) && flow_shows(state) && state->output->force;
}
static inline bool flow_feels_contact(const struct flow_state *state)
{
    return flow_shows_contact(state) || (state->flow->feels_contact && flow_writes_probes(state));
}

/* True if a frame has other fields than these. */
static inline bool flow_shows_beside(const struct flow_state *state, uint64_t frame)
{
    const struct model_hdf5 *hdf5 = &state->flow->model->hdf5;
    return flow_shows(state) && state->output->beside && model_hdf5_takes(hdf5, frame) &&
           (hdf5->velocity || hdf5->block || hdf5->rank);
}

/* True if the places of blocks are asked for. */
static inline bool flow_shows_places(const struct flow_state *state)
{
    return flow_shows(state) && (state->output->places || flow_shows_beside(state, 0));
}

/* s: of the steps accepted so far. */
static inline double flow_time(const struct flow_state *state)
{
    return (double)state->grid.now * state->flow->model->h / FLOW_TICKS;
}

/* ---- Failures ----
 *
 * Functions of the main program that fork return the first failure of the run, which stays: after
 * one, forks, sets and gets do nothing. So callers look at it only before they use a number that
 * was got, and where they stop. */

/* Notes what the runtime, or contact, returned. Returns the first failure. */
static inline int flow_noted(struct flow_state *state, int code)
{
    state->code = state->code ? state->code : code;
    return state->code;
}
/* Set an object of a field, of the run or of block 0, whose turn it is; value NULL: to zeros. Get
 * it. */
int flow_set(struct flow_state *state, enum flow_field_id field, const void *value);
int flow_get(struct flow_state *state, enum flow_field_id field, void *value);

/* ---- state.c: forks. Collective ---- */

/* Fork the start of all blocks; the copy of x and v to kept_x and kept_v, or to two others; the way
 * back. */
int flow_initialise(struct flow_state *state);
int flow_keep(struct flow_state *state);
int flow_keep_as(struct flow_state *state, const struct flow_as *as);
int flow_restore(struct flow_state *state);

/* ---- ties (adopted.c, chosen.c). Collective unless local; they return what the runtime does ----
 */

/* Takes memory for the choice, a part of flow_memory_take. Local. */
void flow_ties_take(struct flow_state *state);
/* Takes the records of all blocks, state->tied.said, the same on every rank: finds rooms, the
 * blocks that share ties, and the places of the rows that each shows. Makes objects again if their
 * room changes, and sets the fields `tie_links`. Records the round of the solve again if rooms or
 * these blocks changed. Room stays while about half of it is used, the last of it while any block
 * has ties. Then every block that has ties or had some makes its table (flow_ties_make), before
 * anything reads TIED. */
int flow_ties_adopt(struct flow_state *state);
/* Copies the arrays. Local. */
void flow_ties_copy(const struct flow_tied_blocks *from, uint32_t n_blocks,
                    const struct flow_tied_blocks *to);
/* Sets tied.now from a checkpoint, before the first step. */
int flow_ties_again(struct flow_state *state, const struct flow_tied_blocks *tied);
/* The most pairs (block, other block) that share ties, in a run with so many timed joints; seeks:
 * contacts are ties, too. Pure. */
size_t flow_tied_others(uint32_t n_blocks, uint32_t n_joints, bool seeks);
/* Unites the free pieces of cloth that the joints of the step join, for the momentum that a solve
 * left of them. No piece is free if the records have contacts. */
int flow_ties_group(struct flow_state *state);
/* Gives the blocks the joints of the step under way. */
int flow_ties_choose(struct flow_state *state);
/* Forks the tasks that show x and v of ties' corners to the other blocks: kernels with
 * TIED(tie_halo) that are forked next read them. */
int flow_ties_show(struct flow_state *state);
/* True if a tie came or went since the step before, or at most FLOW_TICKS ago. True if a step that
 * begins at a tick has the ties of now. True if a tie will come or go before the run ends. Local.
 */
bool flow_ties_changed(const struct flow_state *state);
bool flow_ties_stay(const struct flow_state *state, uint64_t tick);
bool flow_ties_will_change(const struct flow_state *state);

#endif
