#ifndef CLOTH_OUTPUT_HDF5_H
#define CLOTH_OUTPUT_HDF5_H

#include "cloth/output/settle.h"

#include <stdbool.h>
#include <stdint.h>

/* Scientific frames: in a folder of frames (output.h)
 *   hdf5/frame-NNNNNN.vtkhdf   one frame, HDF5 in the VTKHDF layout: an unstructured grid of
 *                              triangles, and of edges that have none
 *   cloth.vtkhdf.series        JSON: {"file-series-version": "1.0", "files": [{"name", "time"}]}
 *   cloth.xmf                  XDMF: the same frames, for programs that do not read VTKHDF
 *
 * The settler writes them, on rank 0: a frame is copied, and the caller goes on. At most
 * OUTPUT_HDF5_FLIGHT of them are in memory; then the caller waits. A frame gets its name when it is
 * whole and on the disk; then both indexes name it. Local functions, called from one thread at a
 * time. */
struct output_hdf5;

enum { OUTPUT_HDF5_FLIGHT = 2 };

/* Points (P) and cells (C) have fields. */
enum output_field {
    OUTPUT_VELOCITY, /* P x 3, m/s */
    OUTPUT_BLOCK,    /* P: -1 of points that no block has */
    OUTPUT_RANK,     /* P: that keeps the block; -1 as before */
    OUTPUT_FORCE,    /* P x 3, N: of contact */
    OUTPUT_STRAIN,   /* C */
    OUTPUT_STRESS,   /* C x 3, N/m: along warp, along weft, of shear */
    OUTPUT_FIELDS
};

/* A frame. Fields that are not wanted are NULL. */
struct output_state {
    uint64_t frame;
    double time;      /* s */
    double *position; /* P x 3, m */
    double *field[OUTPUT_FIELDS];
    int32_t *number[OUTPUT_FIELDS]; /* of OUTPUT_BLOCK and OUTPUT_RANK, in the place of the other */
};

struct output_hdf5_setup {
    const char *folder;                      /* of frames; it is there, and outlives this */
    uint32_t n_points, n_triangles, n_edges; /* cells are the triangles, then the edges */
    const uint32_t (*triangle)[3];           /* read by output_hdf5_open only */
    const uint32_t (*edge)[2];               /* as that */
    bool wants[OUTPUT_FIELDS];
    bool is_double;           /* numbers on the disk; else float */
    uint32_t every;           /* > 0: of all frames each k-th, from the first on */
    const uint64_t *n_frames; /* of an earlier run's, how many of all stay, and go on; NULL: none */
    uint32_t level;           /* of gzip, 0 to 9; 0: none */
    struct output_settler *settler; /* writes them; NULL: the caller does */
    /* Fills the fields of cells from the positions. Called by the settler. */
    void (*derive)(void *context, struct output_state *state);
    void *context;
    void (*warn)(const char *text); /* says a sentence at once; from the settler */
};

/* Why this build, or its HDF5, cannot do that; NULL: it can. */
const char *output_hdf5_lacks(uint32_t level);

/* Bytes that a frame takes on the disk, at most about. */
double output_hdf5_bytes(const struct output_hdf5_setup *setup);

/* Begins. Removes frames and indexes of an earlier run, or those beyond the ones that stay. Errors:
 * CLOTH_E_INPUT if a file of such a name is not of a run, files cannot be written, frames to stay
 * are missing, or the build has no HDF5; CLOTH_E_MEMORY. */
int output_hdf5_open(struct output_hdf5 **frames, const struct output_hdf5_setup *setup,
                     struct cloth_error *error);

/* True if frame k of the run is to be written. */
bool output_hdf5_takes(const struct output_hdf5 *frames, uint64_t frame);

/* Room for the parts of a frame that is taken: begins it, after a wait if too many are in flight.
 * The caller fills position and the wanted fields of points. */
struct output_state *output_hdf5_begin(struct output_hdf5 *frames, uint64_t frame, double time);

/* The frame that was begun is whole and goes to the settler. */
void output_hdf5_end(struct output_hdf5 *frames);

/* Waits until no frame is in flight. */
void output_hdf5_wait(struct output_hdf5 *frames);

/* Closes, when the settler is closed; a frame that was begun and has not ended is left out.
 * *frames becomes NULL. CLOTH_E_IO: some frames were not written; it names their number, the first
 * and the reason. */
int output_hdf5_close(struct output_hdf5 **frames, struct cloth_error *error);

/* Removes the frames of an earlier run from a folder whose run has none. n_frames: the first
 * *n_frames of a resumed run stay; NULL: the run is new. Errors: of output_hdf5_open. */
int output_hdf5_forget(const char *folder, const uint64_t *n_frames, struct cloth_error *error);

#endif
