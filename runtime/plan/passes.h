#ifndef DUITE_PLAN_PASSES_H
#define DUITE_PLAN_PASSES_H

/* The compiler of recorded graphs. Its passes in order, with input and output:
 *
 *   record   record.c   calls of a build function   -> plan_record: forks, objects, arguments
 *                       plan_record                 -> plan_source: the same as plain data
 *   lower    lower.c    plan_source                 -> plan_round: nodes and their uses
 *   assign   assign.c   plan_round, homes           -> plan_assignment: ranks by node and version
 *   messages messages.c plan_assignment             -> plan_messages: phases and their messages
 *            pieces.c   plan_messages               -> the pieces of sums
 *            relay.c    plan_messages               -> the rounds of relayed sums
 *   part     part.c     plan_messages of a rank     -> plan_round: the nodes of that rank
 *            part_sums.c                               with those of sums
 *   edges    edges.c    plan_round                  -> its edges, within a round and to the next
 *   emit     emit.c     plan_round                  -> plan: flat arrays (plan.h)
 *   run      run.c      plan                        -> replays, as replay_call.c asks for them
 *
 * On one rank nothing is assigned or sent, so edges follow lowering.
 *
 * Everything in this header is plain data: its passes need no task graph, table of objects or
 * worker, call no body and touch no value. So a round in any form can be compiled: by the plan from
 * a record, by the mappings (tasks.c), and by the predictor from a trace, where laws are NULL. The
 * maker of a plan_source owns it and keeps it as long as its round. */

#include "runtime/base/rank_set.h"
#include "runtime/data/subtrees.h"

#include <duite.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PLAN_NONE UINT32_MAX
enum {
    PLAN_BY_OWNER = -1, /* instead of the rank of a fork: the home of its owner */
    PLAN_MANY = -1,     /* instead of the rank that runs a node: a set of ranks */
    PLAN_ALL = -1       /* instead of the rank of plan_messages_find: all messages */
};

/* ---- A round as plain data: the input of lowering ---- */

/* How a fork, with its descendants, uses an object: r, w, rw or cw. */
struct plan_access {
    uint32_t object; /* below plan_source.n_objects */
    duite_mode mode;
    const duite_law *law; /* cw: compared only; two accesses with NULL have the same law */
};

struct plan_source_fork {
    size_t first; /* of its n accesses */
    uint32_t n;
    uint32_t owner;        /* the object that it runs for, see task_owner; or PLAN_NONE */
    int rank;              /* to run on, or PLAN_BY_OWNER */
    bool sets, replicated; /* replicated: no cw among its accesses */
    double cost;           /* seconds; 0: not given */
};

struct plan_source {
    struct plan_source_fork *fork; /* in order */
    const struct plan_access *access;
    size_t *bytes; /* by object */
    size_t n_forks, n_accesses, n_objects;
    uint32_t flag; /* the object that decides on a further round, or PLAN_NONE */
};

/* ---- Lower: nodes ---- */

enum plan_kind {
    PLAN_TASK,    /* a fork */
    PLAN_SET,     /* a duite_set */
    PLAN_SUM,     /* adds contributions to their object */
    PLAN_FLAG,    /* reads the flag */
    PLAN_COPY,    /* this and the following: only with several ranks */
    PLAN_PARTIAL, /* combines some contributions of one sum */
    PLAN_SEND,
    PLAN_RECEIVE
};

/* How a node uses a place. */
struct plan_node_use {
    uint32_t place;
    bool reads, writes;
};

/* A step of a sum: parameter `left` becomes law(left, right). */
struct plan_merge {
    uint32_t left, right;
};

struct plan_round_node {
    enum plan_kind kind;
    uint32_t fork;             /* that it runs, or that it comes before */
    uint32_t owner;            /* the object that it runs for, or PLAN_NONE */
    uint32_t n_uses, n_merges; /* merges: SUM, PARTIAL */
    uint32_t channel;          /* SEND, RECEIVE: the message's number on this rank */
    size_t first_use, first_merge;
    union {
        const duite_law *law; /* SUM, PARTIAL: of the merges */
        struct {              /* SEND, RECEIVE: the message carries the node's uses in order */
            int peer;
            uint32_t phase;
        };
    };
    uint32_t within, cyclic; /* predecessors in its round; in the previous round */
    uint32_t n_next, n_next_cyclic;
};

/* Bytes that nodes use: place i < n_objects is object i, the others are buffers. */
struct plan_round_place {
    uint32_t object;      /* the object of a buffer, or itself */
    const duite_law *law; /* buffer: of the contribution in it, or NULL */
};

struct plan_round_edge {
    uint32_t from, to;
    bool cyclic; /* from a round to the next one */
};

/* A round in its intermediate form. */
struct plan_round {
    const struct plan_source *source;
    void *memory; /* of the nodes, uses, places and merges */
    struct plan_round_node *node;
    struct plan_node_use *use;
    struct plan_round_place *place;
    size_t n_nodes, n_uses, n_places, n_objects;
    struct plan_merge *merge;
    size_t n_merges;
    struct plan_round_edge *edge;
    size_t n_edges;
    size_t n_channels; /* SENDs and RECEIVEs */
};

/* From a source to the nodes of a round for all ranks, without edges:
 * - Each fork is one TASK or SET, in order. A SUM comes before the first access that ends the
 *   contributions to an object, else at the end of the round. The FLAG, if any, comes last.
 * - The uses of a TASK are its accesses in order; a cw uses a buffer of its own. The uses of a SUM
 *   are the object and the buffers of its contributions in fork order.
 * - The merges of a SUM make the reduction tree of data/subtrees.h and leave the result in its
 *   parameter 1.
 * False without memory; plan_round_free is due all the same. *round is zero before. */
bool plan_lower(struct plan_round *round, const struct plan_source *source);
void plan_round_free(struct plan_round *round);

/* Memory for a round of at most so many. False without. */
bool plan_round_room(struct plan_round *round, size_t nodes, size_t uses, size_t places,
                     size_t merges);
/* Appends a node; a use to the last node; a buffer, and returns its place. */
static inline struct plan_round_node *plan_round_add(struct plan_round *round, enum plan_kind kind,
                                                     size_t fork)
{
    struct plan_round_node *node = &round->node[round->n_nodes++];
    *node = (struct plan_round_node){.kind = kind,
                                     .fork = (uint32_t)fork,
                                     .owner = PLAN_NONE,
                                     .first_use = round->n_uses,
                                     .first_merge = round->n_merges};
    return node;
}
static inline void plan_round_use(struct plan_round *round, struct plan_round_node *node,
                                  size_t place, bool reads, bool writes)
{
    round->use[round->n_uses++] = (struct plan_node_use){(uint32_t)place, reads, writes};
    node->n_uses++;
}
uint32_t plan_round_buffer(struct plan_round *round, uint32_t object, const duite_law *law);

/* The reduction of data/subtrees.h as merges of the round's last node (a data_combine): `where` of
 * a subtree is the parameter with its value. */
void plan_merge(void *round, uint32_t left, uint32_t right);

/* ---- Assign: the ranks that run each node ---- */

/* The value of an object between two writes. */
struct plan_version {
    uint32_t object;
    uint32_t maker; /* node, plus 1; 0: it enters the round */
};

/* Sets of ranks by number: 0 is empty, 1 + r has rank r alone, larger numbers belong to one node or
 * version. Most nodes run on one rank, so a round on thousands of ranks needs few sets of its own.
 */
struct plan_rank_sets {
    int n_ranks;
    size_t words; /* of a set */
    uint64_t *word;
    size_t n, words_capacity;
    bool failed; /* no memory */
};

struct plan_assignment {
    const struct plan_round *round;
    void *memory; /* of the arrays by node, use and object, and of versions */
    int n_ranks;
    size_t words; /* of a set of ranks */
    int *home;    /* by object */
    /* By node: the rank that runs it, or PLAN_MANY; all ranks that do, a set of `sets`. */
    int *at;
    uint32_t *set;
    /* By use: the version that it reads, the version that it makes, or PLAN_NONE. */
    uint32_t *reads, *makes;
    /* Version i < n_objects: the version of object i that enters the round. */
    struct plan_version *version;
    uint32_t *need; /* by version: the ranks that read it, a set of `sets` */
    size_t n_versions;
    uint32_t *last; /* by object: the version that leaves the round */
    struct plan_rank_sets sets;
};

/* From a lowered round and the home of each object:
 * - A task of the program runs on the rank that its fork named, else on the home of its owner. A
 *   sum of a large object runs on the object's home.
 * - All other nodes (replicated kernels, sets, sums of small objects) run exactly on the ranks that
 *   read their result, in this round or at the beginning of the next. A node without readers runs
 *   on its owner's home if it is a task or its result leaves the round, else nowhere.
 * - Each rank that runs a node needs each version that the node reads.
 * - So only versions made on one rank travel within a round.
 * Every rank computes the same. False without memory; plan_assignment_free is due all the same. */
bool plan_assign(struct plan_assignment *assignment, const struct plan_round *round,
                 const int *home, int n_ranks);
void plan_assignment_free(struct plan_assignment *assignment);

/* The words of a set. They move when another set grows. */
static inline const uint64_t *plan_ranks(const struct plan_rank_sets *sets, uint32_t set)
{
    return sets->word + set * sets->words;
}
/* The ranks that run a node; that need a version. */
static inline const uint64_t *plan_runs_set(const struct plan_assignment *a, size_t node)
{
    return plan_ranks(&a->sets, a->set[node]);
}
static inline const uint64_t *plan_needs_set(const struct plan_assignment *a, size_t version)
{
    return plan_ranks(&a->sets, a->need[version]);
}
static inline bool plan_runs(const struct plan_assignment *a, size_t node, int rank)
{
    return base_ranks_has(plan_ranks(&a->sets, a->set[node]), rank);
}
/* No rank runs the node: its result is overwritten unread. */
static inline bool plan_is_dead(const struct plan_assignment *assignment, size_t node)
{
    return !assignment->set[node];
}
/* The node that makes the version; if it enters the round, the node that made it in the previous
 * round. PLAN_NONE: the graph does not write the object. */
static inline uint32_t plan_maker(const struct plan_assignment *a, uint32_t version)
{
    const struct plan_version *found = &a->version[version];
    if (!found->maker)
        found = &a->version[a->last[found->object]];
    return found->maker - 1;
}
/* Returns whether the rank has the version without a message within the round. */
static inline bool plan_is_there(const struct plan_assignment *a, uint32_t version, int rank)
{
    const uint32_t maker = plan_maker(a, version);
    return maker == PLAN_NONE || plan_runs(a, maker, rank);
}

/* ---- Messages: which values move, and when ---- */

/* A moment in the round: 0, its beginning; the pieces of the sum at node n are made, or some rounds
 * of its relay are over; node n is over. */
typedef uint64_t plan_moment;
static inline plan_moment plan_moment_sum(size_t n, uint32_t rounds)
{
    return 64 * (plan_moment)n + 1 + rounds;
}
static inline plan_moment plan_moment_over(size_t n)
{
    return 64 * (plan_moment)n + 64;
}

/* Contributions of one rank to one sum. */
struct plan_piece {
    uint32_t node;            /* the sum */
    struct data_subtree tree; /* complete, or that of all leaves */
    int rank;                 /* has all its leaves */
    uint32_t phase;           /* in which it moves if sent directly */
};

/* Pieces that one rank sends another in a round of a sum's relay. */
struct plan_hop {
    uint32_t node, round; /* of the sum */
    int from, to;
    struct data_subtrees trees; /* at least one */
};
typedef void plan_relay_visit(void *context, const struct plan_hop *hop);

/* A message of each round: all items from one rank to another in one phase. */
struct plan_message {
    int from, to;
    uint32_t phase;
    plan_moment ready;  /* all its items are made */
    size_t first, last; /* items, plus 1; 0: none */
    uint32_t next;      /* the next one between the two ranks, plus 1 */
};

/* One item in one message: a version, a piece, or a subtree of a sum's relay. */
struct plan_item {
    uint32_t message, object;
    uint32_t version, piece;  /* ids, or PLAN_NONE */
    struct data_subtree tree; /* if both are none: of the sum at the moment `made` */
    plan_moment made;
    size_t next; /* of the same message, plus 1 */
};

struct plan_messages {
    const struct plan_assignment *assignment;
    int rank;                 /* of these messages, or PLAN_ALL */
    void *memory;             /* of the arrays by node and buffer, and of pieces */
    uint32_t *phase;          /* by node: upper bound of rank crossings on a path to it */
    uint8_t *rounds;          /* by node: rounds of a relayed sum; 0: sent directly */
    uint32_t *leaf;           /* by buffer, less n_objects: the node that fills it */
    struct plan_piece *piece; /* of all sums and ranks, in order */
    size_t n_pieces;
    size_t *first_piece; /* by node, n_nodes + 1: of a sum */
    struct plan_message *message;
    size_t n_messages, messages_capacity;
    struct plan_item *item;
    size_t n_items, items_capacity;
};

/* From an assignment:
 * - The phase of a node is at least that of every node that it follows on its rank, and above that
 *   of each message that it waits for. The phase of a message is that of the nodes that make its
 *   items. So a message waits only for messages of lower phases, never in a ring.
 * - The pieces of a sum cover its leaves in order, each once. Each piece is a complete subtree, or
 *   all leaves. A sum that one rank contributes to and reads alone has one piece per leaf; a sum
 *   that no rank runs has none.
 * - A version made by one rank is an item for each other rank that needs it, a piece for each other
 *   rank that runs its sum. If these are more than four ranks, and for a version more than half of
 *   all, they are relayed in rounds, one phase each (relay.c).
 * - Items are in order of `made`, the same on the sender's and the receiver's side.
 * Messages and items are those from and to `rank`, or all (PLAN_ALL). False
 * without memory; plan_messages_free is due all the same. */
bool plan_messages_find(struct plan_messages *messages, const struct plan_assignment *assignment,
                        int rank);
void plan_messages_free(struct plan_messages *messages);

/* The node that fills a buffer of a sum, once leaves are known. */
static inline uint32_t plan_message_leaf(const struct plan_messages *m,
                                         const struct plan_node_use *use)
{
    return m->leaf[use->place - m->assignment->round->n_objects];
}

/* Parts of plan_messages_find, false without memory. Pieces of all sums, once phases are known. The
 * rounds of relayed sums, once leaves are known. The hops of one such sum, round by round, once
 * pieces are known. */
bool plan_pieces_find(struct plan_messages *messages);
bool plan_relay_find(struct plan_messages *messages);
bool plan_relay_walk(const struct plan_messages *messages, size_t node, plan_relay_visit *visit,
                     void *context);
/* Rounds of the relay of a value from the rank that has it to a set of ranks; 0: sent directly. The
 * ring (room for all ranks, or NULL) begins with that rank: in round s its first 2^s ranks send to
 * the next 2^s. The second takes a version. */
uint32_t plan_relay_ring(const uint64_t *set, int n_ranks, int from, int *ring, size_t *n);
uint32_t plan_relay_version(const struct plan_assignment *assignment, uint32_t version, int *ring,
                            size_t *n);

/* ---- Part: the nodes of one rank ---- */

/* From the messages of a rank (not PLAN_ALL) to its nodes, without edges:
 * - The nodes of the round that the rank runs, in order. A RECEIVE for each message to it comes
 *   first; a SEND for each message from it comes once its last item is made. The uses of both are
 *   its items in order, so both sides agree on the layout.
 * - The rank's writes go to the objects' own places. Each received version or piece has a buffer,
 *   which only the RECEIVE, a PARTIAL and a sum write.
 * - A COPY brings a received version home before a node modifies it, and keeps aside a value that
 *   is overwritten before its message goes.
 * - A PARTIAL combines this rank's contributions to pieces of more than one leaf, and for a relayed
 *   sum the leaves received in a round with those present.
 * False without memory; plan_round_free is due all the same. *part is zero before. */
bool plan_part(struct plan_round *part, const struct plan_messages *messages);

/* ---- Edges ---- */

/* Adds the edges of a round to its nodes, and counts them by node:
 * - A node waits for the last writer of each place that it reads, and for the readers since (if
 *   none, that writer) of each place that it writes, over two rounds in a row. Edges within a round
 *   lead to later nodes, are in order of `to`, and no two join the same nodes.
 * - Conflicts are symmetric, so a node that releases another one's next round waited for it in this
 *   round: no node is counted down for the next round before it has begun this one.
 * - A FLAG waits for all roots, and all roots of the next round wait for it. Without a FLAG, a root
 *   that conflicts with nothing waits for itself in the previous round.
 * False without memory. */
bool plan_edges(struct plan_round *round);

/* ---- Rows for mappings ---- */

/* The nodes of a round in order, and the results that each reads. Independent of ranks. */
struct plan_tasks {
    void *memory; /* of the arrays */
    size_t n;
    bool *program;   /* n: a task of the program, not of the runtime */
    double *cost;    /* n: seconds as given at the fork; 0: not given, or not the program's */
    uint32_t *owner; /* n: the object that it runs for; PLAN_NONE: none, or it runs on a named rank
                        or everywhere */
    size_t *start;   /* n + 1: of its rows */
    uint32_t *from;  /* start[n]: the node whose result it reads; if not an earlier one, of the last
                        round */
    double *bytes;   /* of it */
};

/* Takes a lowered round. False without memory; plan_tasks_free is due all the same. */
bool plan_tasks_find(struct plan_tasks *tasks, const struct plan_round *round);
void plan_tasks_free(struct plan_tasks *tasks);

/* ---- Paths for schedulers ---- */

/* Takes a lowered round with its edges. Returns, by fork, the seconds on the longest path from it
 * to the end of the round (duite_ready.path). A fork without a cost counts as the mean of those
 * with one. The caller frees it by base_free. NULL without memory. */
float *plan_paths_find(const struct plan_round *round);

#endif
