#ifndef CLOTH_OUTPUT_HDF5_HDF5_H
#define CLOTH_OUTPUT_HDF5_HDF5_H

#include "cloth/output/hdf5.h"

#include <stdbool.h>
#include <stddef.h>

/* The parts of scientific frames. Local functions. */

extern const char *const output_field_names[OUTPUT_FIELDS];
static inline bool output_field_is_of_cells(enum output_field field)
{
    return field == OUTPUT_STRAIN || field == OUTPUT_STRESS;
}
static inline bool output_field_is_whole(enum output_field field)
{
    return field == OUTPUT_BLOCK || field == OUTPUT_RANK;
}
static inline unsigned output_field_width(enum output_field field)
{
    return field == OUTPUT_VELOCITY || field == OUTPUT_FORCE || field == OUTPUT_STRESS ? 3 : 1;
}

/* What frames have in common: cells, triangles first. */
struct output_grid {
    uint32_t n_points, n_triangles, n_edges;
    int64_t *corners; /* n_corners: of all cells */
    size_t n_corners;
    int64_t *start;      /* n_cells + 1: where each begins */
    unsigned char *kind; /* n_cells: VTK's number of its shape */
    int64_t *mixed;      /* n_mixed: XDMF's list of cells; NULL: all are of one shape */
    size_t n_mixed;
};
static inline uint32_t output_grid_cells(const struct output_grid *grid)
{
    return grid->n_triangles + grid->n_edges;
}

/* Bytes that grow. */
struct output_bytes {
    unsigned char *data;
    size_t n, room;
};

/* Starts HDF5, on a thread that may call MPI: a library that was built with it does. */
void output_image_start(void);
/* Whether HDF5 can compress. */
bool output_image_gzips(void);
/* A frame's file, as bytes: none of HDF5's own writing touches the disk, so that a full one does
 * not leave it with data that it cannot get rid of. Errors: CLOTH_E_LIBRARY, CLOTH_E_MEMORY. */
int output_image(const struct output_hdf5_setup *setup, const struct output_grid *grid,
                 const struct output_state *state, struct output_bytes *bytes,
                 struct cloth_error *error);

/* An index: a text that is whole at any moment, in a folder that has a folder hdf5. Its form: what
 * begins the text, each entry, and ends it. */
struct output_index_form {
    const char *name, *begin, *entry, *end;
};
struct output_index_file {
    int file; /* -1: none */
    size_t n; /* bytes of the text that it has */
};
struct output_index {
    char *path, *hidden_path,
        *spare_path; /* the last: a second name while two files change theirs */
    struct output_index_file shown, hidden;
    struct output_bytes text; /* all but its end */
    const struct output_index_form *form;
    uint32_t n; /* entries */
};
#define OUTPUT_INDEX_NONE                                                                          \
    (struct output_index)                                                                          \
    {                                                                                              \
        .shown = {.file = -1}, .hidden = {.file = -1 }                                             \
    }
/* What ends the other two names, in the folder hdf5. */
#define OUTPUT_INDEX_HIDDEN ".part"
#define OUTPUT_INDEX_SPARE  ".spare"
/* Whether there is a file that begins as an index of ours does. */
bool output_index_is_ours(const char *path, const char *begin);
/* Begins a new one, or goes on with one that is there, with its entries of frames below *n_frames.
 * The form stays the caller's. Errors: output_refuse; CLOTH_E_INPUT: it is not whole, or a frame
 * that it names is gone. */
int output_index_open(struct output_index *index, const char *folder,
                      const struct output_index_form *form, const uint64_t *n_frames,
                      struct cloth_error *error);
/* Adds an entry, n bytes. A failed one leaves the others. Error: CLOTH_E_IO. */
int output_index_add(struct output_index *index, const char *entry, size_t n,
                     struct cloth_error *error);
int output_index_close(struct output_index *index, struct cloth_error *error);

/* The two indexes of a folder. */
enum { OUTPUT_SERIES, OUTPUT_XMF, OUTPUT_INDEXES };
struct output_indexes {
    struct output_index of[OUTPUT_INDEXES];
};
/* Removes what an earlier run left, but for the frames below *n_frames, NULL: all; then as
 * output_index_open. In any case output_indexes_close follows. CLOTH_E_INPUT: an index is not one
 * of ours. */
int output_indexes_open(struct output_indexes *indexes, const char *folder,
                        const uint64_t *n_frames, struct cloth_error *error);
int output_indexes_add(struct output_indexes *indexes, const struct output_hdf5_setup *setup,
                       const struct output_grid *grid, const char *name, double time,
                       struct cloth_error *error);
int output_indexes_close(struct output_indexes *indexes, struct cloth_error *error);

/* hdf5/frame-NNNNNN.vtkhdf, of a folder: from OUTPUT_HDF5_FRAME on its number. */
enum { OUTPUT_HDF5_NAME = 48 };
#define OUTPUT_HDF5_FRAME "hdf5/frame-"
void output_hdf5_name(char name[OUTPUT_HDF5_NAME], uint64_t frame);

#endif
