#ifndef CLOTH_APP_SIMULATE_RUN_H
#define CLOTH_APP_SIMULATE_RUN_H

#include "cloth/app/report/forecast.h"
#include "cloth/app/run/checkpoints.h"
#include "cloth/app/run/outputs.h"
#include "cloth/app/run/progress.h"
#include "cloth/app/simulate.h"
#include "cloth/untangle/untangle.h"

/* Shared by simulate.c, simulate_begin.c and simulate_check.c: a run, from reading to reporting. */

struct run {
    const struct simulate_options *options;
    const char *asked; /* the scene as the command line names it */
    int rank, ranks;
    unsigned threads, cores;
    char cores_from[160]; /* what said how many they are */
    struct phases phases;
    struct model *model;        /* of the phase that runs */
    struct flow *flow;          /* as that */
    struct contact_apart apart; /* rank 0: of the model, with the flow's attachments */
    struct outputs outputs;     /* rank 0 */
    struct restart restart;     /* rank 0: the point the run resumes from */
    bool wants_frames;          /* the same on all ranks */
    struct progress progress;
    struct flow_report report;
    struct untangle_result untangled; /* rank 0 */
    struct mesh_elastic *elastic;     /* rank 0: of each material of the phase that runs */
    struct cloth_error untraced;      /* why the trace is not whole */
    struct forecast forecast;         /* rank 0, with --check */
    bool intersects;                  /* some were found; the same on all ranks */
    bool stopped_before;              /* asked to stop before the phase began */
};

/* The code of the lowest rank that failed, on all ranks; that rank prints its sentence. Collective.
 */
int simulate_agree(const struct run *run, const struct cloth_error *error);

/* Nonzero if SIGUSR1 or SIGTERM came; has the form of flow_progress.stop. */
int simulate_stops(void *context);
/* Makes a stop wait for the step from now on, as something may be written. */
void simulate_stop_by_step(void);
/* Says that the run was asked to stop before it began. */
void simulate_say_unbegun(void);

/* Finds every input error that is known before the first phase has run; then takes the folder of
 * frames. If it is asked to stop: stopped_before. Collective; returns a cloth_code, the same on all
 * ranks. */
int simulate_prepare(struct run *run);

/* Goes on to the next phase, unless that is asked to stop: stopped_before. Collective; as above. */
int simulate_next(struct run *run);

/* A summary of a report, with the workers of all ranks and the largest memory of any. Collective.
 */
struct summary simulate_sum_up(const struct run *run, const struct flow_report *report);

/* Runs the phase that is prepared; with --check its first steps alone. Collective; as above. */
int simulate_execute(struct run *run);

/* With --check, after simulate_prepare: says what all of the run takes. Collective; as above. */
int simulate_check(struct run *run);
/* Calls of the runtime in its first steps; they have the form of those of flow_progress. */
void simulate_check_step(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations);
int simulate_check_ends(void *context);

#endif
