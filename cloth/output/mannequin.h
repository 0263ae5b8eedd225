#ifndef CLOTH_OUTPUT_MANNEQUIN_H
#define CLOTH_OUTPUT_MANNEQUIN_H

#include "cloth/base/error.h"
#include "cloth/mesh/mesh.h"

#include <stdint.h>

/* A body's vertices in frames: each frame is asked for once, in their order. place: fills x, m,
 * n_points x 3. */
struct output_shapes {
    uint32_t n_points, n_frames;
    void (*place)(const void *context, uint32_t frame, double (*x)[3]);
    const void *context;
};

/* Writes them as a PC2 point cache, as `frames` of a scene's body reads it. An old file of that
 * name is replaced when the new one is whole. Errors: CLOTH_E_INPUT where it cannot be written to,
 * CLOTH_E_IO, CLOTH_E_MEMORY. Local. */
int output_mannequin_pc2(const char *path, const struct output_shapes *shapes,
                         struct cloth_error *error);

#endif
