#ifndef CLOTH_MESH_DETAIL_GRAPH_H
#define CLOTH_MESH_DETAIL_GRAPH_H

#include "cloth/base/memory.h"
#include "cloth/mesh/blocks.h"

/* A graph: the neighbours of node i are neighbour[start[i]] .. neighbour[start[i + 1] - 1],
 * ascending, each once, without i itself. Numbers of 32 bits, as METIS takes them: the graph of a
 * large mesh is not copied for it. Local. */
struct mesh_graph {
    uint32_t n_nodes;
    uint32_t *start; /* n_nodes + 1 */
    uint32_t *neighbour;
};

/* pairs: of vertices below n_vertices; node: of each vertex, below n_nodes or MESH_NO_PLACE. Goes
 * through the pairs twice. Errors: CLOTH_E_INPUT for a pair with a vertex that has no node, and
 * beyond 2^31 pairs; CLOTH_E_MEMORY. */
int mesh_graph_build(struct mesh_graph *graph, uint32_t n_nodes, uint32_t n_vertices,
                     const uint32_t *node, const struct mesh_pairs *pairs,
                     struct cloth_error *error);
void mesh_graph_free(struct mesh_graph *graph);

/* Sorts lists of nodes for locality, part by part: reverse Cuthill-McKee. Within a part, components
 * follow each other by their lowest node. In each component the walk starts at an end: among the
 * nodes farthest from the lowest node, one of lowest degree, then of lowest number. This search is
 * repeated while the nodes get farther away. Neighbours join by rising degree within the part, then
 * by number; at last the whole order is reversed. part: of each node. nodes: n of the same part,
 * all that part has; rewritten in the new order. order: from mesh_order_make, for any number of
 * calls on one graph. Its error: CLOTH_E_MEMORY. */
struct mesh_order {
    const struct mesh_graph *graph;
    const uint32_t *part;
    uint32_t *degree; /* of each node within its part */
    uint32_t *seen; /* the number of the last walk that met a node; the largest once it is placed */
    uint32_t *queue;  /* the walk: nodes as they are met */
    uint32_t *placed; /* the new order */
    uint64_t *sorted; /* of one node's neighbours: degree * 2^32 + node */
    uint32_t walk;
    struct cloth_pool memory; /* of these arrays: to be freed also after an error */
};
int mesh_order_make(struct mesh_order *order, const struct mesh_graph *graph,
                    struct cloth_error *error);
void mesh_order_part(struct mesh_order *order, const uint32_t *part, uint32_t n, uint32_t *nodes);

/* Cuts the nodes into n_parts <= n_nodes parts with METIS' recursive bisection, fixed seed, equal
 * numbers of nodes. part: of each node, n_nodes. A graph without pairs is cut by node number. METIS
 * may leave parts empty. Not to be called by two threads at once (METIS draws from the C library's
 * random numbers, which it seeds). Errors: CLOTH_E_LIBRARY, CLOTH_E_MEMORY. */
int mesh_partition(uint32_t *part, const struct mesh_graph *graph, uint32_t n_parts,
                   struct cloth_error *error);

/* Makes n_parts parts without an empty one where some are empty: splits the others into pieces
 * until there are n_parts pieces. size: of each part; their sum is at least n_parts. pieces: of
 * each part, 0 for empty ones. The largest piece is as small as it can be, which decides all else;
 * of equal choices lower parts are split first. Linear in n_parts but for a logarithm. */
void mesh_pieces(uint32_t n_parts, const uint32_t *size, uint32_t *pieces);

#endif
