#ifndef CLOTH_MESH_BLOCKS_H
#define CLOTH_MESH_BLOCKS_H

#include "cloth/base/error.h"

#include <stdint.h>

/* The cut of the vertices into blocks of about `grain`, balanced by vertices. METIS' recursive
 * bisection has a fixed seed. Its blocks with near numbers are near in space, so any rank may own a
 * contiguous range. Inside a block vertices are ordered for locality (reverse Cuthill-McKee of the
 * block's own graph, ties by vertex number). The cut depends on the graph and the grain only, never
 * on ranks or threads.
 *
 * A vertex has a place: places are numbered block after block. Vertices that are not used have
 * none. */
#define MESH_NO_PLACE 0xffffffffu

enum { MESH_MANY_BLOCKS = 16 };

struct mesh_blocks {
    uint32_t n_blocks, n_vertices, n_places;
    uint32_t *start;  /* n_blocks + 1: block b has the places start[b] .. start[b + 1] - 1 */
    uint32_t *vertex; /* n_places: the vertex at a place */
    uint32_t *place;  /* n_vertices: the place of a vertex, or MESH_NO_PLACE */
    uint64_t hash;    /* XXH64 of n_blocks, start and vertex as little-endian 32-bit numbers */
};

/* Pairs of vertices that springs or elements join: `each` calls visit(to, a, b) for every pair, the
 * same pairs in the same order each time (any order, repeats allowed). So they need not be stored.
 */
struct mesh_pairs {
    const void *context;
    void (*each)(const void *context, void (*visit)(void *to, uint32_t a, uint32_t b), void *to);
};

/* Cuts the used vertices into blocks. used: one byte a vertex; grain >= 1. The number of blocks is
 * ceil(used vertices / grain). From MESH_MANY_BLOCKS on it is the nearest multiple of four (the
 * larger of two), as long as there are so many vertices. No block is empty: if METIS leaves some
 * empty, the largest others are split along their inner order. Without any pairs, blocks are runs
 * of vertices by number. Errors: CLOTH_E_INPUT (grain 0, a pair with a vertex that is not used),
 * CLOTH_E_LIBRARY (METIS failed), CLOTH_E_MEMORY. Local, the same result everywhere. Not by two
 * threads at once: METIS seeds and draws from the C library's random numbers. */
int mesh_blocks_cut(struct mesh_blocks *blocks, uint32_t n_vertices, const unsigned char *used,
                    const struct mesh_pairs *pairs, uint32_t grain, struct cloth_error *error);
void mesh_blocks_free(struct mesh_blocks *blocks);

#endif
