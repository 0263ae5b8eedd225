#ifndef CLOTH_MESH_DETAIL_GRAPH_H
#define CLOTH_MESH_DETAIL_GRAPH_H

#include "cloth/mesh/blocks.h"

#include <stddef.h>
#include <stdint.h>

/* Who is joined to whom: the neighbours of node i are neighbour[start[i]] .. neighbour[start[i + 1]
 * - 1], ascending, each once, without i itself. Numbers of 32 bits, as METIS takes them: the graph
 * of a large mesh is not copied for it. Local. */
struct mesh_graph {
    uint32_t n_nodes;
    uint32_t *start; /* n_nodes + 1 */
    uint32_t *neighbour;
};

/* pairs: of vertices below n_vertices; node: of each vertex, below n_nodes or MESH_NO_PLACE. The
 * pairs are gone through twice. Errors: CLOTH_E_INPUT for a pair with a vertex that has no node,
 * and beyond 2^31 pairs; CLOTH_E_MEMORY. */
int mesh_graph_build(struct mesh_graph *graph, uint32_t n_nodes, uint32_t n_vertices,
                     const uint32_t *node, const struct mesh_pairs *pairs,
                     struct cloth_error *error);
void mesh_graph_free(struct mesh_graph *graph);

/* Sorts lists of nodes for locality, part by part: reverse Cuthill-McKee. Within a part, components
 * follow each other by their lowest node; in each the walk starts at an end of it (a node of lowest
 * degree, then of lowest number, among those farthest from the lowest node, repeated while they get
 * farther away), neighbours join by rising degree within the part, then by number, and the whole is
 * turned round. part: of each node. nodes: n of the same part, all that part has; rewritten in the
 * new order. scratch: from mesh_order_new, for any number of calls on one graph. */
struct mesh_order;
struct mesh_order *mesh_order_new(const struct mesh_graph *graph, struct cloth_error *error);
void mesh_order_part(struct mesh_order *order, const uint32_t *part, uint32_t n, uint32_t *nodes);
void mesh_order_free(struct mesh_order *order);

/* Cuts the nodes into n_parts <= n_nodes parts with METIS' recursive bisection, fixed seed, equal
 * numbers of nodes; part: of each node, n_nodes. A graph without pairs is cut by node number. Parts
 * may be left empty by METIS. Not to be called by two threads at once (METIS draws from the C
 * library's random numbers, which it seeds). Errors: CLOTH_E_LIBRARY, CLOTH_E_MEMORY. */
int mesh_partition(uint32_t *part, const struct mesh_graph *graph, uint32_t n_parts,
                   struct cloth_error *error);

#endif
