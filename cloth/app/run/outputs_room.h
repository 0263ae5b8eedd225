#ifndef CLOTH_APP_RUN_OUTPUTS_ROOM_H
#define CLOTH_APP_RUN_OUTPUTS_ROOM_H

#include "cloth/app/run/outputs_setup.h"

/* The most that a run of all phases takes, on rank 0: halved steps add to steps and rows of probes,
 * blocks that move to other ranks to the colours. */
struct outputs_extent {
    double frames, steps, seconds; /* seconds: simulated */
    double bytes;                  /* of the files of --output, but for checkpoints */
    bool may_end;                  /* before that: at rest, or sewn */
};

/* While the phase that is next has its meshes and its flow is prepared. Errors: CLOTH_E_MEMORY.
 * Local. */
int outputs_extent_find(struct outputs_extent *all, const struct simulate_options *options,
                        const struct phases *phases, const struct flow *flow,
                        const struct contact_apart *apart, struct cloth_error *error);

/* Checks, before the first write, that the files fit into the file system of --output. Warns if
 * there are unusually many frames. Error: CLOTH_E_INPUT, they do not fit. Local. */
int outputs_check_room(const struct outputs_extent *all, const struct model *model,
                       const struct flow *flow, const char *folder, struct cloth_error *error);

#endif
