#ifndef CLOTH_LIVE_SCENE_H
#define CLOTH_LIVE_SCENE_H

#include "cloth/live/message.h"
#include "cloth/output/output.h"

/* The scene of a run as a message, and back: for a viewer it is a folder of frames in memory.
 * Local. */

/* Makes the message; *bytes: to be freed. The setup's meshes are read, its folder and inputs are
 * not. Error: CLOTH_E_MEMORY. */
int live_scene_write(const struct output_setup *setup, uint64_t run, uint64_t scene,
                     unsigned char **bytes, size_t *n, struct cloth_error *error);

/* Opens a cache that has one frame, in memory (output_cache.held), from a scene that was read; it
 * is all zero until live_frame_show. Without an error it is to be closed. Errors: CLOTH_E_INPUT,
 * corners, bodies or the text are none that a run sends; CLOTH_E_MEMORY. */
int live_scene_open(const struct live_message *scene, struct output_cache *cache,
                    struct cloth_error *error);

/* Puts a frame that was read into the cache. Errors: CLOTH_E_INPUT, it is of another mesh. */
int live_frame_show(const struct live_message *frame, struct output_cache *cache,
                    struct cloth_error *error);

#endif
