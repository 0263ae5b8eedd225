#ifndef CLOTH_OUTPUT_HDF5_HDF5_H
#define CLOTH_OUTPUT_HDF5_HDF5_H

#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"
#include "cloth/output/hdf5.h"

#include <stdbool.h>
#include <stddef.h>

/* The parts of scientific frames. Local functions. */

/* ---- What frames have in common ---- */

struct output_field_form {
    const char *name;
    unsigned width;   /* numbers a point or cell */
    bool is_of_cells; /* else of points */
    bool is_whole;    /* its numbers are int32 */
};
extern const struct output_field_form output_fields[OUTPUT_FIELDS];

/* Cells, triangles first. */
struct output_grid {
    uint32_t n_points, n_triangles, n_edges;
    int64_t *corners; /* n_corners: of all cells */
    size_t n_corners;
    int64_t *start;      /* n_cells + 1: where each begins */
    unsigned char *kind; /* n_cells: VTK's number of its shape */
    int64_t *mixed;      /* n_mixed: XDMF's list of cells; NULL: all are of one shape */
    size_t n_mixed;
};
/* In any case output_grid_free follows. Error: CLOTH_E_MEMORY. */
int output_grid_make(struct output_grid *grid, const struct output_hdf5_setup *setup,
                     struct cloth_error *error);
void output_grid_free(struct output_grid *grid);
static inline uint32_t output_grid_cells(const struct output_grid *grid)
{
    return grid->n_triangles + grid->n_edges;
}
static inline size_t output_grid_rows(const struct output_grid *grid, int field)
{
    return output_fields[field].is_of_cells ? output_grid_cells(grid) : grid->n_points;
}

/* ---- A frame's file ---- */

/* Its name in a folder of frames, of a uintmax_t: from OUTPUT_HDF5_FRAME on its number. */
#define OUTPUT_HDF5_FRAME "hdf5/frame-"
#define OUTPUT_HDF5_NAME  OUTPUT_HDF5_FRAME "%06ju.vtkhdf"

/* A frame's file, as a list of bytes: none of HDF5's own writing touches the disk, so that a full
 * one does not leave it with data that it cannot get rid of. Errors: CLOTH_E_LIBRARY,
 * CLOTH_E_MEMORY. */
int output_image(const struct output_hdf5_setup *setup, const struct output_grid *grid,
                 const struct output_state *state, struct cloth_list *bytes,
                 struct cloth_error *error);

/* ---- The two indexes of a folder: texts that are whole at any moment ---- */

enum { OUTPUT_SERIES, OUTPUT_XMF, OUTPUT_INDEXES };
/* The begin of the text, that of each entry, and the end of the text. */
struct output_index_form {
    const char *name, *begin, *entry, *end;
};
extern const struct output_index_form output_index_forms[OUTPUT_INDEXES];
/* The entry of a frame, to be freed. NULL: out of memory. */
char *output_index_entry(int index, const struct output_hdf5_setup *setup,
                         const struct output_grid *grid, const char *frame, double time);

struct output_indexes;
/* The folder outlives them. Removes what an earlier run left, but for the frames below *n_frames,
 * NULL: all; then begins new indexes, or goes on with their entries of those frames. In any case
 * output_indexes_close follows. Errors: output_refuse; CLOTH_E_INPUT: an index is not one of ours,
 * or is not whole, or a frame that it names is gone. */
int output_indexes_open(struct output_indexes **indexes, const char *folder,
                        const uint64_t *n_frames, struct cloth_error *error);
/* Names a frame in both. One that fails leaves the others. Error: CLOTH_E_IO. */
int output_indexes_add(struct output_indexes *indexes, const struct output_hdf5_setup *setup,
                       const struct output_grid *grid, const char *frame, double time,
                       struct cloth_error *error);
/* *indexes becomes NULL. */
int output_indexes_close(struct output_indexes **indexes, struct cloth_error *error);

#endif
