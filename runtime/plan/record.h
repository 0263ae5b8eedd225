#ifndef DUITE_PLAN_RECORD_H
#define DUITE_PLAN_RECORD_H

#include "runtime/base/memory.h"
#include "runtime/plan/passes.h"
#include "runtime/task/fork.h"
#include "runtime/task/task.h"

/* Recorded graphs: what a build function forked, kept for replays.
 *
 * The record is the program's view: forks in order, with the objects and arguments of the next
 * replay. It is compiled to a plan (plan.h), or forked round by round with the same results. Main
 * thread only. */

#define PLAN_SETS UINT32_MAX /* instead of a kernel: a duite_set */

struct plan_record;

struct plan_recorded_fork {
    uint32_t kernel; /* index in the list given at start */
    uint32_t n;
    struct task_options options;
    uint32_t owner; /* the place in `object` that it runs for, or PLAN_NONE */
    uint32_t call;  /* forks before it, sets left out */
    size_t first;   /* of its n objects in `access` */
    size_t args;    /* of its arguments, or of the values it sets, in `args` */
    bool zeros;     /* it sets zeros */
    size_t count;   /* elements it sets */
};

struct plan_recorded_object {
    duite_object recorded, bound; /* as named by build; used instead by the next replay */
    duite_type type;
    size_t count;       /* at most */
    bool sized;         /* its size changes */
    bool read, written; /* other than by a contribution */
    bool sums;          /* contributed to */
    bool reads_old;     /* the first access is not a w */
    bool leads, trails; /* contributions before any other access in a round; after all others */
    bool fixed;         /* tasks of `fixed` kernels run for it */
};

struct plan;

/* Arguments that changed since the last replay; one block of memory. */
struct plan_change {
    struct plan_change *next;
    size_t at, bytes; /* in the plan's copy of the arguments */
    unsigned char args[];
};

struct plan_record {
    struct task_graph *graph;
    struct plan_recorded_fork *fork;
    size_t n_forks, forks_capacity;
    struct plan_access *access; /* of all forks */
    size_t n_accesses, accesses_capacity;
    unsigned char *args;
    size_t args_bytes, args_capacity;
    size_t *call; /* the forks that are not sets, which have numbers */
    size_t n_calls, calls_capacity;
    struct plan_recorded_object *object;
    size_t n_objects, objects_capacity;
    uint32_t *index; /* by slot: place in `object`, plus 1 */
    size_t n_slots;
    duite_object *names; /* for the objects of one fork */
    size_t names_capacity;
    bool whole;    /* build came to its end */
    uint64_t fits; /* table->changes, plus 1, when all bound objects were last found to exist */
    bool rebound;  /* since all bound objects were last found to differ */
    bool forked;   /* has no plan: contributions of two rounds make one sum, the size of an object
                      changes, or a right is postponed */
    bool leads;    /* contributions to some object come before any other access in a round */
    bool trails;   /* some object's contributions stay open after the last round */
    int failed;    /* code of the first call of build that failed */
    char message[512]; /* of it */
    struct plan *plan;
    struct plan_change *changes; /* since the last replay of the plan */
    uint64_t rounds;             /* of the last replay, without those of the plan */
    bool by_plan;                /* the last replay had rounds of the plan */
};

/* The objects of a large record lie far apart in the table: loops over them fetch one ahead. */
enum { PLAN_AHEAD = 12 };
static inline void plan_prefetch(const struct plan_record *record, size_t i)
{
    if (i < record->n_objects)
        base_prefetch(&record->graph->table.object[record->object[i].bound.slot]);
}

enum { PLAN_MAX_TASKS_BITS = 48 }; /* rounds times forks of one replay are below 2^48 */

/* An empty record; NULL without memory. */
struct plan_record *plan_record_new(struct task_graph *graph);
/* Replays may be unfinished. */
void plan_record_free(struct plan_record *record, struct worker *worker);
/* Forgets everything recorded, bindings included: build is called again. */
void plan_record_clear(struct plan_record *record, struct worker *worker);

/* Drops the changes, since the next plan is made from the present arguments. */
void plan_record_forget_changes(struct plan_record *record);

/* The calls of build. Errors as of task_fork and task_set_object; then nothing is recorded. */
int plan_record_fork(struct plan_record *record, const struct task_options *options,
                     const duite_kernel *kernel, const void *args, size_t n,
                     const duite_object *objects);
int plan_record_set(struct plan_record *record, duite_object object, const void *values,
                    const size_t *count);
/* Build is over. */
void plan_record_end(struct plan_record *record);

/* New arguments of the k-th fork of build. Errors: DUITE_E_ARGUMENT, memory. */
int plan_record_args(struct plan_record *record, size_t k, const void *args);
/* Errors: DUITE_E_OBJECT, DUITE_E_BINDING. */
int plan_record_bind(struct plan_record *record, duite_object recorded, duite_object object);

/* The record as plain data, with a flag or NULL. It points into the record's accesses, which must
 * stay meanwhile. False without memory; plan_source_free is due all the same. */
bool plan_record_source(const struct plan_record *record, const duite_object *flag,
                        struct plan_source *source);
void plan_source_free(struct plan_source *source);

/* The place of a flag among the objects; n_objects if it is none of them. */
uint32_t plan_record_flag(const struct plan_record *record, duite_object flag);

/* Returns whether it was recorded and all bound objects exist. */
bool plan_record_fits(struct plan_record *record);
/* DUITE_E_BINDING if two recorded objects are bound to one. */
int plan_record_distinct(struct plan_record *record);

/* ---- Replays: every rank, fork order ---- */

/* The rounds that must be forked before and after those of the plan, since contributions cross
 * between them; all rounds come before if none is left for the plan. */
void plan_replay_split(const struct plan_record *record, const duite_object *flag, uint64_t rounds,
                       uint64_t *before, uint64_t *after);

/* Forks all tasks once, as round `round` of the replay. */
int plan_replay_fork(struct plan_record *record, struct worker *worker, uint64_t round);

/* Replays the plan for so many rounds, or at most so many while the first element of the flag is
 * not zero. COMM_NEEDS_TAGS: nothing was done. */
int plan_replay_plan(struct plan_record *record, struct worker *worker, const duite_object *flag,
                     uint64_t rounds);

/* Returns whether all replays of the plan are over; then, the rounds of the last one. */
bool plan_replay_over(const struct plan_record *record);
uint64_t plan_replay_rounds(const struct plan_record *record);

/* Returns whether the first element is not zero. */
bool plan_flag_holds(duite_type type, const void *values);

#endif
