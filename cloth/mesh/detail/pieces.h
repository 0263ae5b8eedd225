#ifndef CLOTH_MESH_DETAIL_PIECES_H
#define CLOTH_MESH_DETAIL_PIECES_H

#include <stdint.h>

/* Makes n_parts parts without an empty one where some are empty: splits the others into pieces
 * until there are n_parts pieces. size: of each part; their sum is at least n_parts. pieces: of
 * each part, 0 for empty ones. The largest piece is as small as it can be; of equal choices lower
 * parts are split first. Linear in n_parts but for a logarithm. Local. */
void mesh_pieces(uint32_t n_parts, const uint32_t *size, uint32_t *pieces);

#endif
