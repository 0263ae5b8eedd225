#ifndef CLOTH_OUTPUT_HDF5_GRID_H
#define CLOTH_OUTPUT_HDF5_GRID_H

#include "cloth/output/hdf5/hdf5.h"

/* Makes the grid of a setup; in any case output_grid_free follows. Error: CLOTH_E_MEMORY. Local. */
int output_grid_make(struct output_grid *grid, const struct output_hdf5_setup *setup,
                     struct cloth_error *error);
void output_grid_free(struct output_grid *grid);

#endif
