/* Cells in their three spellings: corners and starts, shapes, and the list that XDMF has of cells
 * of several shapes. */
#include "cloth/output/hdf5/hdf5.h"

#include <stdlib.h>

const struct output_field_form output_fields[OUTPUT_FIELDS] = {
    [OUTPUT_VELOCITY] = {"velocity", 3, false, false},
    [OUTPUT_BLOCK] = {"block", 1, false, true},
    [OUTPUT_RANK] = {"rank", 1, false, true},
    [OUTPUT_FORCE] = {"contact_force", 3, false, false},
    [OUTPUT_STRAIN] = {"strain", 1, true, false},
    [OUTPUT_STRESS] = {"stress", 3, true, false}};

/* Numbers of shapes: VTK's, XDMF's. */
enum { VTK_EDGE = 3, VTK_TRIANGLE = 5, XDMF_POLYLINE = 2, XDMF_TRIANGLE = 4 };

static int hdf5_grid_take(struct output_grid *grid, struct cloth_error *error)
{
    const size_t cells = output_grid_cells(grid);
    grid->n_corners = 3 * (size_t)grid->n_triangles + 2 * (size_t)grid->n_edges;
    grid->corners = cloth_alloc(grid->n_corners, sizeof *grid->corners, error);
    grid->start = cloth_alloc(cells + 1, sizeof *grid->start, error);
    grid->kind = cloth_alloc(cells, sizeof *grid->kind, error);
    if (grid->n_triangles && grid->n_edges) {
        grid->n_mixed = 4 * (size_t)grid->n_triangles + 4 * (size_t)grid->n_edges;
        grid->mixed = cloth_alloc(grid->n_mixed, sizeof *grid->mixed, error);
    }
    return error->code;
}

int output_grid_make(struct output_grid *grid, const struct output_hdf5_setup *setup,
                     struct cloth_error *error)
{
    *grid = (struct output_grid){
        .n_points = setup->n_points, .n_triangles = setup->n_triangles, .n_edges = setup->n_edges};
    if (hdf5_grid_take(grid, error))
        return error->code;
    int64_t *corner = grid->corners, *mixed = grid->mixed;
    for (uint32_t c = 0; c < output_grid_cells(grid); c++) {
        const bool edge = c >= grid->n_triangles;
        const uint32_t *of = edge ? setup->edge[c - grid->n_triangles] : setup->triangle[c];
        const int n = edge ? 2 : 3;
        grid->kind[c] = edge ? VTK_EDGE : VTK_TRIANGLE;
        if (mixed) {
            *mixed++ = edge ? XDMF_POLYLINE : XDMF_TRIANGLE;
            if (edge)
                *mixed++ = n;
        }
        for (int i = 0; i < n; i++) {
            *corner++ = of[i];
            if (mixed)
                *mixed++ = of[i];
        }
        grid->start[c + 1] = grid->start[c] + n;
    }
    return CLOTH_OK;
}

void output_grid_free(struct output_grid *grid)
{
    free(grid->corners);
    free(grid->start);
    free(grid->kind);
    free(grid->mixed);
    *grid = (struct output_grid){0};
}
