#ifndef CLOTH_OUTPUT_FILES_POSES_H
#define CLOTH_OUTPUT_FILES_POSES_H

#include "cloth/output/output.h"

/* The shapes of bodies that change them, in a folder of frames: body-K.pc2, K from 0, a PC2 cache
 * of the vertices of body-K.obj, without the motion of the obstacle. Frame k is of the time of
 * frame k of cloth.pc2. It may have a frame more, of a run that was killed. Local functions; errors
 * as of output_open. */
struct output_poses;

/* Begins those of the setup, and removes those of an earlier run, which had n_before bodies. */
int output_poses_open(struct output_poses **poses, const struct output_setup *setup,
                      uint32_t n_before, struct cloth_error *error);

/* From now on the bodies are these, at their time 0 when the time of frames, s, is `begin`. */
void output_poses_go_on(struct output_poses *poses, const struct contact_bodies *bodies,
                        double begin);

/* Appends a frame. */
int output_poses_frame(struct output_poses *poses, double time, struct cloth_error *error);

/* Brings the first n frames to the disk and counts them, before those of the cloth are. */
int output_poses_settle(const struct output_poses *poses, uint32_t n, struct cloth_error *error);

/* Closes; *poses becomes NULL. */
int output_poses_close(struct output_poses **poses, struct cloth_error *error);

#endif
