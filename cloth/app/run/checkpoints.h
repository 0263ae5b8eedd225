#ifndef CLOTH_APP_RUN_CHECKPOINTS_H
#define CLOTH_APP_RUN_CHECKPOINTS_H

#include "cloth/app/run/phases.h"
#include "cloth/output/checkpoint.h"

struct outputs;

/* Writes checkpoints while the run goes on, on rank 0 alone: by the thread that brings frames to
 * the disk, in turn. One that fails is said once, and the run goes on. */
struct keeper;

/* Its settings, files and seconds between two are those of the outputs, which outlive it; their
 * frames are open. *keeper: NULL before. Errors: of output_checkpoints_open; CLOTH_E_MEMORY. */
int keeper_open(struct keeper **keeper, const struct outputs *of, struct cloth_error *error);

/* Nonzero once when a checkpoint is due; then 0 until restart_save and the next time. From any
 * thread. */
int keeper_due(struct keeper *keeper);

/* When the settler is closed, and so the taken parts are on the disk; *keeper becomes NULL. */
void keeper_close(struct keeper **keeper);

/* Parts of a checkpoint beside the state of the flow: settings, which tell if the scene is the
 * same; the phase; results of earlier phases; memory of the outputs. All on rank 0; local
 * functions. */

/* The point that a run resumes from. */
struct restart {
    struct output_checkpoint checkpoint; /* to be freed; bytes NULL: it starts anew */
    struct flow_resumed at;              /* when the flow is prepared */
};

/* Reads the newest checkpoint of a folder of frames that is whole, and puts the phases where it was
 * written; a warning says why a newer one is not used. Errors: CLOTH_E_INPUT, there is none, or it
 * is of another scene or version, by the first key that differs; CLOTH_E_IO; CLOTH_E_MEMORY. */
int restart_read(struct restart *restart, const char *folder, struct phases *phases,
                 struct cloth_error *error);

/* When the flow of that phase is prepared: it goes on from the checkpoint. Errors: of flow_resume.
 */
int restart_resume(struct restart *restart, struct flow *flow, struct cloth_error *error);

/* Gives open outputs their memory back. Error: CLOTH_E_INPUT. */
int restart_outputs(const struct restart *restart, struct outputs *to, struct cloth_error *error);

/* Has the keeper of the outputs write a checkpoint, after a wait for one that is being written; has
 * the form of flow_output.save, context = the outputs. From one thread at a time. */
void restart_save(void *context, struct flow_checkpoint state);

#endif
