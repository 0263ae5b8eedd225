#ifndef CLOTH_APP_RUN_OUTPUTS_H
#define CLOTH_APP_RUN_OUTPUTS_H

#include "cloth/app/check/drape.h"
#include "cloth/app/check/intersections.h"
#include "cloth/app/run/options.h"
#include "cloth/app/run/outputs_fields.h"
#include "cloth/app/run/phases.h"
#include "cloth/flow/run.h"
#include "cloth/live/live.h"

/* The outputs and checks of a run: frames, probes, forces, systems, intersections, the drape test.
 * They are on rank 0 alone, and begin as zero. All functions are local. */
struct outputs {
    const struct simulate_options *options;
    struct output_lock *locks[2];        /* of the folders of frames and of the system */
    struct output_frames *frames;        /* if they are wanted; */
    struct output_settler *settler;      /* brings them to the disk */
    _Atomic uint64_t frames_written;     /* with those of runs before; any thread may read it */
    struct output_probes *probes;        /* if the scene has any */
    struct outputs_hdf5 hdf5;            /* if the scene asks for them */
    struct live_publisher *live;         /* if they are to be seen live */
    struct output_colours *colours;      /* as the frames */
    struct output_forces *forces;        /* of frames; NULL: none */
    struct intersections *intersections; /* if they are looked for */
    struct intersections_found found;    /* then, in all frames so far, of all phases */
    struct drape drape;                  /* if the scene has that test */
    struct drape_found drapes;           /* then, at the end */
    struct keeper *keeper;               /* of checkpoints, if they are wanted; then also: */
    char *settings;                      /* phases_settings */
    const struct phases *phases;
};

/* The folder of frames is this run's, before anything else of it is looked at. */
int outputs_lock(struct outputs *to, const struct simulate_options *options,
                 struct cloth_error *error);
/* Checks and opens the outputs that options and model ask for. resumed: of a run that goes on with
 * an earlier run's files; else NULL. outputs_close and outputs_free follow, also after an error.
 * Returns a cloth_code. */
int outputs_open(struct outputs *to, const struct simulate_options *options,
                 const struct phases *phases, const struct flow *flow,
                 const struct contact_apart *apart, const struct flow_resumed *resumed,
                 struct cloth_error *error);
/* The same when a further phase begins: the frames go on. Returns a cloth_code. */
int outputs_go_on(struct outputs *to, const struct phases *phases,
                  const struct contact_apart *apart, struct cloth_error *error);
/* The files are whole. */
void outputs_close(struct outputs *of, struct cloth_error *error);
void outputs_free(struct outputs *of);

/* Where the flow of a phase sends frames, if they are wanted, and all else that options ask for;
 * the last phase sends its system. On any rank. */
void outputs_receive(struct outputs *of, const struct simulate_options *options, bool frames,
                     bool last, struct flow_output *to);

#endif
