#ifndef CLOTH_APP_RUN_OUTPUTS_FIELDS_H
#define CLOTH_APP_RUN_OUTPUTS_FIELDS_H

#include "cloth/element/strain.h"
#include "cloth/flow/run.h"
#include "cloth/output/colours.h"
#include "cloth/output/hdf5.h"

/* Files of a run beside positions, on rank 0. Local functions. */

/* Says it on standard error. From any thread. */
void outputs_warn(const char *text);

/* ---- Data that viewers colour the cloth by ----
 *
 * A full disk does not end the run: one warning says so, *colours becomes NULL, and nothing more is
 * written. */

/* Shapes at rest of the cloths of a model, from a frame on. While there are meshes. Errors:
 * CLOTH_E_MEMORY. */
int outputs_colours_rest(struct output_colours **colours, const struct model *model, uint64_t frame,
                         struct cloth_error *error);
/* The places of a frame. Error: CLOTH_E_MEMORY. */
int outputs_colours_places(struct output_colours **colours, uint64_t frame,
                           const struct flow_places *places, struct cloth_error *error);

/* ---- Scientific frames ----
 *
 * Their parts come from tasks one after the other, in any order; the last one sends the frame off.
 * It begins as zero. */

struct outputs_hdf5 {
    struct output_hdf5 *frames; /* NULL: none are wanted */
    struct output_state *state; /* the frame whose parts are coming; NULL: none */
    unsigned parts, have;       /* bits: that a frame has; that came */
    struct element_strains strains;
    struct cloth_error unwritten; /* then, at the end: frames that were not written */
};

/* Begins them in a folder of frames, while there are meshes, or removes those of an earlier run.
 * n_frames: the first *n_frames of the earlier run stay, which this one resumes; NULL: the run is
 * new. Returns a cloth_code. */
int outputs_hdf5_open(struct outputs_hdf5 *to, const struct model *model, const char *folder,
                      const uint64_t *n_frames, struct output_settler *settler,
                      struct cloth_error *error);
/* Goes on with another model of the same cloths, while there are meshes. Returns a cloth_code. */
int outputs_hdf5_go_on(struct outputs_hdf5 *to, const struct model *model,
                       struct cloth_error *error);
/* The files are whole; fills `unwritten`. */
void outputs_hdf5_close(struct outputs_hdf5 *of);

/* Size of a model's scientific frames on the disk, bytes a frame of all; 0: it has none. */
double outputs_hdf5_bytes(const struct model *model);

/* The parts of a frame, by vertex. Frames that are not taken are ignored. */
void outputs_hdf5_position(struct outputs_hdf5 *of, uint64_t frame, double time,
                           const double *position);
void outputs_hdf5_beside(struct outputs_hdf5 *of, const struct flow_beside *beside);
void outputs_hdf5_force(struct outputs_hdf5 *of, const double *force);

#endif
