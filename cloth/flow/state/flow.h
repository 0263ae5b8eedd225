#ifndef CLOTH_FLOW_STATE_FLOW_H
#define CLOTH_FLOW_STATE_FLOW_H

#include "cloth/flow/joints/ties.h"
#include "cloth/flow/run.h"
#include "cloth/flow/run/source.h"
#include "cloth/flow/state/fields.h"
#include "cloth/flow/state/tables.h"
#include "cloth/solve/frame.h"
#include "cloth/solve/levels.h"
#include "cloth/solve/local.h"

/* Data that the bodies of tasks share, the runtime's context. Bodies see objects, arguments and the
 * constant part of the flow; everything else that they touch is named here. */

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
    FLOW_CORRECTION,
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
    FLOW_TANGLED,
    FLOW_PINCHED,
    FLOW_UNSEWN,
    FLOW_UNFIT
};

/* Rows of a block's halo that blocks on one other rank read. */
struct flow_packed_halo {
    uint32_t n;
    const uint32_t *row; /* n: places in the halo, ascending */
};

/* Vertices that no face or edge uses: n of them, ascending, with their places. */
struct flow_unused {
    uint32_t n, *vertex;
    double (*position)[3];
};

#define FLOW_APART (-1.0)

/* Warnings of a run, one of each kind. */
enum {
    FLOW_WARN_UNUSED, /* vertices, with their pins and loads */
    FLOW_WARN_PINNED,
    FLOW_WARN_LOADED,
    FLOW_WARN_STEP, /* longer than the integrator takes */
    FLOW_WARN_AIR,
    FLOW_WARN_EXTENT,
    FLOW_WARN_INSIDE,
    FLOW_WARN_WINDING,
    FLOW_WARN_FOLLOW,
    FLOW_WARNINGS
};

/* Levels of groups; nodes of a group: four patches of four blocks. */
enum { FLOW_MAX_LEVELS = 8, FLOW_MAX_NODES = 16 };

/* Numbers that rank 0 finds from its source, and all ranks have. inertia, kg m^2; release, J;
 * contact_stiffness, N/m; vertex_mass, kg; may_pinch: of flow_source_inertia and the like.
 * feels_contact: a probe reports the force of contact. */
#define FLOW_NUMBERS(X)                                                                            \
    X(uint64_t, n_steps)                                                                           \
    X(uint64_t, partition_hash)                                                                    \
    X(double, inertia)                                                                             \
    X(double, release)                                                                             \
    X(double, contact_stiffness)                                                                   \
    X(double, vertex_mass)                                                                         \
    X(uint32_t, n_vertices)                                                                        \
    X(uint32_t, n_triangles)                                                                       \
    X(bool, may_pinch)                                                                             \
    X(bool, feels_contact)
#define FLOW_MEMBER(type, name) type name;
struct flow_numbers {
    FLOW_NUMBERS(FLOW_MEMBER)
};

/* On rank 0 as flow_prepare left it; elsewhere as received from rank 0. */
struct flow {
    const struct model *model; /* rank 0: the program's; else &received */
    struct model received;     /* without names, materials, cloths */
    union {                    /* by name, or all of them */
        struct flow_numbers numbers;
        struct {
            FLOW_NUMBERS(FLOW_MEMBER)
        };
    };
    struct flow_tables tables; /* shapes */
    void *shared;              /* memory that members here point to, the same on all ranks */
    uint32_t n_cloths;
    const struct model_sides *sides; /* n_cloths x (n_cloths + n_obstacles): a cloth and another
                                      * side, cloths before obstacles; friction FLOW_APART: the two
                                      * do not meet */
    uint32_t n_anchors;
    const struct flow_anchor *anchor; /* n_anchors: of motions behind those of the model */
    uint32_t n_ties;
    const struct flow_tie *tie; /* n_ties */

    /* Rank 0 only. */
    char warning[FLOW_WARNINGS][600]; /* empty: there is none */
    struct flow_source source;        /* until the tables are distributed */
    uint32_t *vertex;                 /* by place; from then on */
    uint32_t *cloth_first;   /* n_cloths of the model: the first vertex of each among all */
    struct flow_names names; /* from then on */
    struct flow_unused unused;
    uint32_t *attached; /* from then on: flow_attached */
    struct flow_watched watched;
    char *header; /* of the table of probes; NULL: none */

    struct flow_checkpoint from; /* that the run goes on from; bytes NULL: none */

    /* The run under way. */
    struct cloth_pool taken;           /* all memory of it, of flow_take */
    uint32_t made[FLOW_FIELDS_OF_ALL]; /* in which blocks a field exists: in none from there on */
    const struct flow_progress *progress; /* tasks ask it whether to stop; NULL: they do not ask */
    unsigned n_clocks;
    struct flow_clock *clock; /* a worker */
    struct phys_pair *sums;   /* a worker, max_entries: room for a matrix while it is assembled in
                               * half storage; else NULL */
    size_t n_sums;            /* of a worker */
    phys_vec *ghost_room;     /* a worker, two for each of max_ghosts: the neighbours' rows that
                                 elements see while a task works on them; NULL: there are no elements */
    size_t n_ghosts;          /* of a worker */
    phys_vec *forces; /* a worker, max_rows: those that an explicit step needs for itself alone;
                       * NULL: the run is implicit */
    size_t n_forces;  /* of a worker */
    uint32_t
        *at; /* of each ghost of all blocks: its place in the neighbour's rows that a pass reads */
    struct flow_packed_halo *packed_halo; /* of halo.c */
    uint32_t *packed_row;
    struct model_conditioner conditioner; /* of an explicit run the identity */
    uint32_t patches;          /* of a block; patch k of block b is number patches * b + k */
    uint32_t *patch_first;     /* if there is a coarse part: patches + 1, of each patch's
                                * neighbours among all */
    uint32_t *patch_neighbour; /* of all patches, patch after patch, ascending in each */
    uint32_t n_levels;         /* of groups; 0: patches are few enough for one factor */
    struct solve_level level[FLOW_MAX_LEVELS];  /* of patches, then of groups of the level below */
    uint32_t first_group[FLOW_MAX_LEVELS + 1];  /* of a level, among the groups of all levels; */
    uint32_t first_lifted[FLOW_MAX_LEVELS + 1]; /* its first node among those of all levels */
    struct solve_pattern pattern;               /* of the factor on top: of patches, or of groups */
    struct cloth_error trouble; /* of this rank: why it cannot begin, why a frame was not written;
                                 * changed by the main thread when no task runs, and by `frame` */
    /* On rank 0: written by the tasks `frame`, one at a time, and by the main thread when no task
     * runs. */
    const struct flow_output *output;
    double *room; /* n_vertices x 3: positions of a frame; NULL: there is no output */
    int32_t *block_of, *rank_of; /* n_vertices: of a frame; NULL: they are not asked for */
    int32_t *home; /* a block: its rank; changed by the main thread when no frame is under way */
    double *row;   /* of the table of probes; NULL: it is not written */
    double *probe_values; /* watched x FLOW_PROBE_VALUES */
    uint64_t frames;      /* written */
    uint64_t hash;
    struct cloth_list
        saving; /* bytes of a checkpoint that tasks copied so far; items NULL: no memory */
};

static inline bool flow_is_preconditioned(const struct flow *flow)
{
    return flow->conditioner.local != SOLVE_IDENTITY;
}

/* Takes zeroed memory of n items for the run under way, aligned to a cache line; it is freed at its
 * end. NULL: there is none, and flow->trouble says so. Local. */
static inline void *flow_take(struct flow *flow, size_t n, size_t size)
{
    return cloth_take(&flow->taken, n, size, &flow->trouble);
}

#endif
