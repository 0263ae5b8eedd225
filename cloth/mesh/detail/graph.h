#ifndef CLOTH_MESH_DETAIL_GRAPH_H
#define CLOTH_MESH_DETAIL_GRAPH_H

#include "cloth/mesh/blocks.h"

#include <stddef.h>
#include <stdint.h>

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
 * all that part has; rewritten in the new order. order: from mesh_order_new, for any number of
 * calls on one graph. */
struct mesh_order;
struct mesh_order *mesh_order_new(const struct mesh_graph *graph, struct cloth_error *error);
void mesh_order_part(struct mesh_order *order, const uint32_t *part, uint32_t n, uint32_t *nodes);
void mesh_order_free(struct mesh_order *order);

/* Cuts the nodes into n_parts <= n_nodes parts with METIS' recursive bisection, fixed seed, equal
 * numbers of nodes. part: of each node, n_nodes. A graph without pairs is cut by node number. METIS
 * may leave parts empty. Not to be called by two threads at once (METIS draws from the C library's
 * random numbers, which it seeds). Errors: CLOTH_E_LIBRARY, CLOTH_E_MEMORY. */
int mesh_partition(uint32_t *part, const struct mesh_graph *graph, uint32_t n_parts,
                   struct cloth_error *error);

#endif
