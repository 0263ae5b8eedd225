#ifndef CLOTH_APP_RUN_RESTART_H
#define CLOTH_APP_RUN_RESTART_H

#include "cloth/app/run/outputs.h"
#include "cloth/output/checkpoint.h"
#include "cloth/untangle/untangle.h"

/* Parts of a checkpoint beside the state of the flow: settings, which tell if the scene is the
 * same; the phase; results of earlier phases; memory of the outputs. All on rank 0; local
 * functions. */

/* The point that a run resumes from. */
struct restart {
    struct output_checkpoint checkpoint; /* bytes NULL: it starts anew */
    struct flow_resumed at;              /* when the flow is prepared */
    struct untangle_result untangled;    /* of the run before */
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

/* Hands a checkpoint to the keeper of the outputs; has the form of flow_output.save, context = the
 * outputs. */
void restart_save(void *context, struct flow_checkpoint state);

void restart_free(struct restart *restart);

#endif
