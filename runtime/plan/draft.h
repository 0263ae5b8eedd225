#ifndef DUITE_GRAPH_REPLAY_DRAFT_H
#define DUITE_GRAPH_REPLAY_DRAFT_H

#include "runtime/plan/replay.h"

/* The nodes and edges of one round, on their way from a record to its plan. Nodes, places and
 * readers that may be missing are kept plus one. */

struct plan_draft_node {
    enum task_type kind;
    uint32_t fork;
    size_t first_use, n_uses;
    size_t first_merge, n_merges; /* SUM, PARTIAL */
    const duite_law *law;         /* of these */
    uint32_t channel;             /* SEND, RECEIVE */
    uint32_t within, cyclic;      /* predecessors */
    uint32_t n_next, n_next_cyclic;
};

struct plan_draft_place {
    uint32_t object;              /* of the record, that a buffer is for */
    const duite_law *law;         /* object: of what is open; buffer: of the contribution */
    uint32_t first, last, n_open; /* object: buffers of the contributions that are open */
    uint32_t next;                /* buffer: the next of these */
    uint64_t writes, seen; /* so far in a round; view: its object's at the last gather, plus 1 */
    size_t writer, reader; /* node of two rounds; head of a list */
};

struct plan_draft_reader {
    size_t node, next;
};

struct plan_draft_edge {
    uint32_t from, to;
    bool cyclic;
};

/* A message a round, to or from another rank; its node's uses are what it carries, in order. */
struct plan_draft_channel {
    int peer;
    uint32_t phase;
    bool sends;
};

struct plan_draft {
    const struct plan_record *record;
    struct plan_draft_node *node;
    struct plan_node_use *use;
    struct plan_draft_place *place;
    size_t n_nodes, n_uses, n_places, n_objects;
    struct plan_draft_reader *reader;
    size_t n_readers;
    size_t *mark; /* by node of two rounds: the last one an edge goes to */
    struct plan_draft_edge *edge;
    size_t n_edges, edges_capacity;
    struct plan_merge *merge;
    size_t n_merges;
    struct plan_draft_channel *channel;
    size_t n_channels;
    float *path; /* by fork, or NULL: nobody asks */
    bool decides, failed;
};

/* Memory for so many nodes, uses, places (zero), merges and channels at most. False without. */
bool plan_draft_room(struct plan_draft *draft, size_t nodes, size_t uses, size_t places,
                     size_t merges, size_t channels);
/* Appends a node, a use to the last node, a merge of two of its parameters. */
struct plan_draft_node *plan_draft_node(struct plan_draft *draft, enum task_type kind, size_t fork);
void plan_draft_use(struct plan_draft *draft, struct plan_draft_node *node, size_t place,
                    bool reads, bool writes);
void plan_draft_merge(struct plan_draft *draft, struct plan_draft_node *node, size_t left,
                      size_t right);

/* The pieces of a sum in order: complete subtrees of its leaves. */
struct plan_draft_piece {
    uint64_t first; /* leaf */
    uint32_t level; /* 2^level leaves */
    uint32_t param; /* of the node that merges them; what comes of two is where the left one was */
};
/* Appends a piece, and merges what are siblings then: as data_sum_reduce does. Returns how many
 * there are then. */
size_t plan_draft_push(struct plan_draft *draft, struct plan_draft_node *node,
                       struct plan_draft_piece *piece, size_t n);
/* Folds what is left from the right, into the first one. */
void plan_draft_fold(struct plan_draft *draft, struct plan_draft_node *node,
                     const struct plan_draft_piece *piece, size_t n);

/* The nodes of draft->record for all ranks, without edges; merges of sums only if there is one
 * rank. False without memory. */
bool plan_draft_round(struct plan_draft *draft, size_t n_objects, size_t flag);
/* The edges between them. False without memory. */
bool plan_draft_edges(struct plan_draft *draft);

/* Makes the draft of draft->record for places n_objects (the flag, if draft->decides, is place
 * `flag`). False without memory; plan_draft_free is due all the same. */
bool plan_draft_make(struct plan_draft *draft, size_t n_objects, size_t flag);
void plan_draft_free(struct plan_draft *draft);

#endif
