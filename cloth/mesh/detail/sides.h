#ifndef CLOTH_MESH_DETAIL_SIDES_H
#define CLOTH_MESH_DETAIL_SIDES_H

#include "cloth/mesh/mesh.h"

/* order[0 .. n-1] becomes the permutation that sorts the n pairs by (first, second); equal pairs
 * keep their order. pair: n x 2, each number below n_keys; n <= UINT32_MAX. Time and memory linear
 * in n + n_keys. Errors: CLOTH_E_MEMORY. Local. */
int mesh_sort_pairs(uint32_t *order, size_t n, const uint32_t *pair, uint32_t n_keys,
                    struct cloth_error *error);

/* The sides of all triangles, then the lone edges, brought next to each other where they join the
 * same vertices. Side 3 t + s is that of triangle t between its corners s and s + 1 (mod 3), with
 * corner s + 2 opposite; lone edge e is side 3 n_triangles + e. Local. */
struct mesh_sides {
    uint32_t n;
    uint32_t *pair;  /* n x 2, the smaller vertex first */
    uint32_t *order; /* n: sides by (pair, side) */
};

/* Errors: CLOTH_E_INPUT beyond 2^32 - 1 sides, CLOTH_E_MEMORY. */
int mesh_sides_sort(struct mesh_sides *sides, const struct mesh *mesh, struct cloth_error *error);
void mesh_sides_free(struct mesh_sides *sides);

/* The end (exclusive) of the run of equal pairs that starts at `first` in the order. */
uint32_t mesh_sides_run(const struct mesh_sides *sides, uint32_t first);

/* True if some edge has more than two triangles; then side is the first (in triangle order) that is
 * a third use. */
bool mesh_sides_third(const struct mesh_sides *sides, uint32_t n_triangles, uint32_t *side);

#endif
