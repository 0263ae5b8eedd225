#ifndef DUITE_GRAPH_SPREAD_H
#define DUITE_GRAPH_SPREAD_H

#include "runtime/plan/record.h"

/* A round over all ranks: which ranks run each node, which hold and need each version, and in which
 * phase versions move. Every rank computes the same from the record and the homes. */

#define SPREAD_NONE UINT32_MAX
enum { SPREAD_MANY = -1 }; /* in place of a rank: a set of ranks */

struct spread_version {
    uint32_t object;
    uint32_t maker; /* node, plus 1; 0: it enters the round */
};

struct spread_piece {
    struct plan_subtree tree;
    uint32_t n; /* leaves: from tree.first on */
    int rank;   /* that has all of them */
    uint32_t phase;
};

struct spread {
    struct task_graph *graph;
    const struct plan_record *record;
    const struct plan_round *round; /* the nodes for all ranks */
    int rank, n_ranks;
    size_t words; /* of a set of ranks */
    /* By node. */
    int *at;         /* the rank that runs it, or SPREAD_MANY */
    uint64_t *set;   /* those that do */
    uint32_t *phase; /* rank crossings on the longest path to it, at most */
    uint32_t *many;  /* n_many nodes that run on several ranks */
    size_t n_many;
    /* By use: the version that it reads, and the one that it makes. */
    uint32_t *reads, *makes;
    struct spread_version *version;
    uint64_t *need; /* by version: the ranks that read it */
    size_t n_versions;
    uint32_t *last;   /* by object: the version that leaves the round */
    uint32_t *leaf;   /* by buffer of a contribution: the node that fills it */
    int *home;        /* by object */
    uint32_t *latest; /* by rank; scratch of spread_pieces */
};

static inline bool spread_has(const uint64_t *set, int rank)
{
    return set[rank / 64] >> (rank % 64) & 1;
}
static inline void spread_add(uint64_t *set, int rank)
{
    set[rank / 64] |= UINT64_C(1) << (rank % 64);
}
static inline const uint64_t *spread_set(const struct spread *spread, size_t node)
{
    return spread->set + node * spread->words;
}
static inline const uint64_t *spread_need(const struct spread *spread, uint32_t version)
{
    return spread->need + version * spread->words;
}
static inline bool spread_runs(const struct spread *spread, size_t node, int rank)
{
    return spread->at[node] == rank || spread_has(spread_set(spread, node), rank);
}

/* Nobody runs the node: what it makes is overwritten unread. */
bool spread_is_dead(const struct spread *spread, size_t node);

/* The node that makes the version, of one that enters the round the one that made it in the round
 * before; SPREAD_NONE: the graph does not write the object. */
uint32_t spread_maker(const struct spread *spread, uint32_t version);

/* Whether a rank has the version without a message within the round. */
bool spread_is_there(const struct spread *spread, uint32_t version, int rank);

/* The pieces of a sum in order, each of leaves of one rank; there is room for one a leaf. Returns
 * how many. */
size_t spread_pieces(const struct spread *spread, size_t node, struct spread_piece *piece);

/* Fills *spread from spread->record and ->round; `flag` is the place of one, read by all ranks.
 * False without memory; spread_free is due all the same. */
bool spread_make(struct spread *spread, const duite_object *flag);
void spread_free(struct spread *spread);

/* The nodes of this rank in *draft, without edges. False without memory. */
bool spread_local(const struct spread *spread, struct plan_round *draft);

#endif
