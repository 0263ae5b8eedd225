#ifndef CLOTH_OUTPUT_COLOURS_H
#define CLOTH_OUTPUT_COLOURS_H

#include "cloth/element/strain.h"

#include <stdint.h>

/* Data beside the positions that viewers colour cloth by: DIR/colours.bin, in a folder of frames
 * (output.h). It has the block of each vertex, the rank of each block, and the shapes and moduli
 * that give strain and stress. A record is written again when its content changes: it holds from
 * its frame until the next record of its kind. Little-endian whatever the machine:
 *   header  16 bytes "DUITE COLOURS 1\n"
 *   record  u32 kind, u32 frame, u64 bytes that follow; then of kind
 *     0     i32 a vertex: its block, -1 of one that no block has
 *     1     i32 a block: the rank that keeps it
 *     2     u32 triangles, edges, materials; of each triangle u32 its three vertices and its
 *           material, float the gradient g_1u g_1v g_2u g_2v (1/m) and the area (m^2; 0: none) of
 *           its shape at rest; of each edge that no triangle has u32 two vertices, float its length
 *           at rest (m); of each material float the moduli C11 C12 C22 C33 (N/m; C33 of the shear
 *           angle), u32 whether stress follows from them
 * An incomplete last record was never finished. Local functions. */

/* Bytes of the file of a run whose places do not change: with shapes of these counts. Pure. */
uint64_t output_colours_bytes(uint32_t n_vertices, uint32_t n_blocks,
                              const struct element_strains *rest);

/* --- Writing, on rank 0 --- */

struct output_colours;

/* Begins the file in a folder of frames, which is there. Replaces the one of an earlier run,
 * nothing else, or goes on with its records before frame *n_frames; NULL: none stays. Errors as of
 * output_open. */
int output_colours_open(struct output_colours **colours, const char *folder, uint32_t n_vertices,
                        const uint64_t *n_frames, struct cloth_error *error);
/* Shapes at rest from this frame on. Error: CLOTH_E_IO, also of output_colours_places. */
int output_colours_rest(struct output_colours *colours, uint64_t frame,
                        const struct element_strains *rest, struct cloth_error *error);
/* Blocks of vertices (n_vertices) and ranks of blocks; written if they changed. */
int output_colours_places(struct output_colours *colours, uint64_t frame, const int32_t *block,
                          uint32_t n_blocks, const int32_t *rank, struct cloth_error *error);
/* Closes; *colours becomes NULL. */
int output_colours_close(struct output_colours **colours, struct cloth_error *error);

/* --- Reading --- */

struct output_colours_read;

/* Reads the colours of a mesh with n_vertices. *colours: to be closed in any case. Errors:
 * CLOTH_E_INPUT, there is no such file, or it is of another mesh; CLOTH_E_MEMORY. */
int output_colours_load(struct output_colours_read **colours, const char *folder,
                        uint32_t n_vertices, struct cloth_error *error);
/* In a frame: n_vertices blocks, or ranks; -1 of vertices that no block has. Error: CLOTH_E_INPUT.
 */
int output_colours_blocks(const struct output_colours_read *colours, uint64_t frame, int32_t *block,
                          struct cloth_error *error);
int output_colours_ranks(const struct output_colours_read *colours, uint64_t frame, int32_t *rank,
                         struct cloth_error *error);
/* The first frame from which on the shapes of a frame count; UINT64_MAX: there are none. */
uint64_t output_colours_rest_since(const struct output_colours_read *colours, uint64_t frame);
/* These shapes; element_strains_free follows in any case. */
int output_colours_rest_at(const struct output_colours_read *colours, uint64_t frame,
                           struct element_strains *rest, struct cloth_error *error);
void output_colours_unload(struct output_colours_read *colours);

#endif
