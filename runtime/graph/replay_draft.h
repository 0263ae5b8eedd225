#ifndef DUITE_GRAPH_REPLAY_DRAFT_H
#define DUITE_GRAPH_REPLAY_DRAFT_H

#include "runtime/graph/replay.h"

/* The nodes and edges of one round, on their way from a record to its plan. Nodes, places and
 * readers that may be missing are kept plus one. */

struct graph_draft_node {
    enum graph_kind kind;
    uint32_t fork;
    size_t first_use, n_uses;
    uint32_t within, cyclic; /* predecessors */
    uint32_t n_next, n_next_cyclic;
};

struct graph_draft_place {
    uint32_t object;              /* of the record, that a buffer is for */
    const duite_law *law;         /* object: of what is open; buffer: of the contribution */
    uint32_t first, last, n_open; /* object: buffers of the contributions that are open */
    uint32_t next;                /* buffer: the next of these */
    uint64_t writes, seen; /* so far in a round; view: its object's at the last gather, plus 1 */
    size_t writer, reader; /* node of two rounds; head of a list */
};

struct graph_draft_reader {
    size_t node, next;
};

struct graph_draft_edge {
    uint32_t from, to;
    bool cyclic;
};

struct graph_draft {
    const struct graph_record *record;
    struct graph_draft_node *node;
    struct graph_node_use *use;
    struct graph_draft_place *place;
    size_t n_nodes, n_uses, n_places, n_objects;
    struct graph_draft_reader *reader;
    size_t n_readers;
    size_t *mark; /* by node of two rounds: the last one an edge goes to */
    struct graph_draft_edge *edge;
    size_t n_edges, edges_capacity;
    bool decides, failed;
};

/* Makes the draft of draft->record for places n_objects (the flag, if draft->decides, is place
 * `flag`). False without memory; graph_draft_free is due all the same. */
bool graph_draft_make(struct graph_draft *draft, size_t n_objects, size_t flag);
void graph_draft_free(struct graph_draft *draft);

#endif
