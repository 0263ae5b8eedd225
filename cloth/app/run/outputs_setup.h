#ifndef CLOTH_APP_RUN_OUTPUTS_SETUP_H
#define CLOTH_APP_RUN_OUTPUTS_SETUP_H

#include "cloth/app/run/options.h"
#include "cloth/app/run/phases.h"
#include "cloth/output/output.h"

/* Data that viewers need beside the frames of a run: cloths, bodies, the places of obstacles and
 * the seams of all phases up to this one. On rank 0. Local. */
struct outputs_setup {
    struct output_setup setup; /* its pointers are into the model, or to: */
    const struct mesh **meshes;
    const char **names;
    bool *posed;
    struct contact_shape *obstacles; /* with their motions over several phases: */
    struct phys_key *keys;
    struct contact_apart all;
    uint32_t *joined; /* as all.joined, if that is its own */
};

/* While the phase that runs has its meshes; it and the options outlive it. Error: CLOTH_E_MEMORY.
 * To be freed in any case. */
int outputs_setup_make(struct outputs_setup *made, const struct simulate_options *options,
                       const struct phases *phases, const struct contact_apart *apart,
                       struct cloth_error *error);
void outputs_setup_free(struct outputs_setup *made);

#endif
