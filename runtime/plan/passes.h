#ifndef DUITE_PLAN_PASSES_H
#define DUITE_PLAN_PASSES_H

/* The compiler of recorded graphs: its passes, in order, and what each takes and leaves.
 *
 *   record   record.c   calls of a build function   -> plan_record: forks, objects, arguments
 *            source.c   plan_record                 -> plan_source: the same as plain data
 *   lower    lower.c    plan_source                 -> plan_round: nodes and what they use
 *   assign   assign.c   plan_round, homes           -> plan_assignment: who runs and who needs what
 *   messages messages.c plan_assignment             -> plan_messages: phases, and what each carries
 *            relay.c    plan_messages               -> the way of sums that go from rank to rank
 *   part     part.c     plan_messages of a rank     -> plan_round: the nodes of that rank
 *   edges    edges.c    plan_round                  -> its edges, within a round and to the next
 *   emit     emit.c     plan_round                  -> plan: flat arrays (plan.h)
 *   run      run.c      plan                        -> replays, as replay_call.c asks for them
 *
 * On one rank there is nothing to assign or to send: edges follow lowering.
 *
 * Everything in this header is plain data: no pass of it needs a task graph, a table of objects or
 * a worker, calls a body or touches a value. So whoever has a round in some form can have it
 * compiled: the plan from a record, the mappings (tasks.c), and the predictor from the words of a
 * trace.
 *
 * How the predictor uses it: it fills a plan_source with the forks of a recorded graph. Modes are
 * those of the kernels in the trace, laws are NULL, since a trace has none, and the owner is that
 * of task_owner. After plan_lower either plan_tasks_find makes the rows that mappings see, or
 * plan_assign places the nodes on hosts and plan_messages_find (PLAN_NO_RANK) finds phases and
 * pieces. Who makes a plan_source owns it and keeps it as long as its round. */

#include "runtime/base/rank_set.h"
#include "runtime/data/reduce.h"

#include <duite.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PLAN_NONE UINT32_MAX
enum {
    PLAN_BY_OWNER = -1, /* in place of the rank that a fork runs on: the home of its owner says */
    PLAN_MANY = -1,     /* in place of the rank that runs a node: a set of ranks */
    PLAN_ALL = -1,      /* in place of the rank whose messages are asked for */
    PLAN_NO_RANK = -2   /* the same: phases and pieces alone, no messages */
};

/* ---- A round as plain data: what lowering takes ---- */

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
    int rank;              /* that it is to run on, or PLAN_BY_OWNER */
    bool sets, replicated; /* replicated: no cw among its accesses */
    double cost;           /* seconds; 0: not said */
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
    PLAN_COPY,    /* of several ranks, as are the following ones */
    PLAN_PARTIAL, /* combines some contributions of one sum */
    PLAN_SEND,
    PLAN_RECEIVE
};

/* What a node does to a place. */
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
    uint32_t fork;             /* that it stands for, or that it comes before */
    uint32_t owner;            /* the object that it runs for, or PLAN_NONE */
    uint32_t n_uses, n_merges; /* merges: SUM, PARTIAL */
    uint32_t channel;          /* SEND, RECEIVE */
    size_t first_use, first_merge;
    const duite_law *law;    /* of the merges */
    uint32_t within, cyclic; /* predecessors in its round; in the round before */
    uint32_t n_next, n_next_cyclic;
};

/* Bytes that nodes use: place i < n_objects is object i, the others are buffers. */
struct plan_round_place {
    uint32_t object;      /* that a buffer is for, or itself */
    const duite_law *law; /* buffer: of the contribution in it, or NULL */
};

struct plan_round_edge {
    uint32_t from, to;
    bool cyclic; /* from a round to the next one */
};

/* A message a round, to or from another rank; its node's uses are what it carries, in order. */
struct plan_round_channel {
    int peer;
    uint32_t phase;
    bool sends;
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
    struct plan_round_channel *channel; /* of several ranks */
    size_t n_channels;
};

/* Takes a source; leaves the nodes of a round for all ranks, without edges:
 * - each fork is one TASK or SET, in order, and what the runtime adds comes before the fork that
 *   needs it: a SUM before the first access that ends contributions (contributions still open at
 *   the end of the round end there); last the FLAG, if there is one;
 * - the uses of a TASK are its accesses in order; a cw uses a buffer of its own, which one SUM
 *   reads: its uses are the object and the buffers in the order of forks;
 * - the merges of a SUM make the reduction tree of data/reduce.h; all pieces come to lie in its
 *   parameter 1.
 * False without memory; plan_round_free is due all the same. *round is zero before. */
bool plan_lower(struct plan_round *round, const struct plan_source *source);
void plan_round_free(struct plan_round *round);

/* For passes that make a round: memory for so many at most. False without. */
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

/* The reduction of data/reduce.h as merges of the last node; `where` is the parameter with the
 * subtree's value. */
size_t plan_reduce_push(struct plan_round *round, struct plan_round_node *node,
                        struct data_subtree *row, size_t n);
void plan_reduce_fold(struct plan_round *round, struct plan_round_node *node,
                      const struct data_subtree *row, size_t n);

/* ---- Assign: who runs what ---- */

/* The value of an object between two writes. */
struct plan_version {
    uint32_t object;
    uint32_t maker; /* node, plus 1; 0: it enters the round */
};

/* Sets of ranks, named by numbers: 0 is empty, 1 + r has rank r alone, and larger ones are of one
 * node or one version. Only the last kind takes a row of words for each, so a round on thousands of
 * ranks needs few rows: most nodes run on one rank. */
struct plan_rank_sets {
    int n_ranks;
    size_t words; /* of a row */
    uint64_t *word;
    size_t n_rows, words_capacity;
    uint32_t *few; /* n_ranks + 1: the row of an empty set or one of one rank; PLAN_NONE: not yet */
    bool failed;   /* no memory */
};

struct plan_assignment {
    const struct plan_round *round;
    void *memory; /* of the arrays by node, use and object, and of versions */
    int n_ranks;
    size_t words; /* of a set of ranks */
    int *home;    /* by object */
    /* By node: the rank that runs it, or PLAN_MANY; and all that do, a set of `sets`. */
    int *at;
    uint32_t *set;
    /* By use: the version that it reads, and the one that it makes, or PLAN_NONE. */
    uint32_t *reads, *makes;
    /* Version i < n_objects is the one of object i that enters the round. */
    struct plan_version *version;
    uint32_t *need; /* by version: the ranks that read it, a set of `sets` */
    size_t n_versions;
    uint32_t *last; /* by object: the version that leaves the round */
    struct plan_rank_sets sets;
};

/* Takes a lowered round and the home of each object; leaves:
 * - a task of the program runs on the rank that its fork named, else on the home of its owner; a
 *   sum of a large object on the object's home;
 * - all other nodes (of replicated kernels, sets, sums of small objects) run on every rank that
 *   reads what they make, in this round or at the beginning of the next, and nowhere else; one that
 *   nobody reads runs on its owner's home if it is a task or leaves the round, else nowhere;
 * - each rank that runs a node needs each version that the node reads;
 * - so only what is made on one rank ever travels within a round.
 * Every rank computes the same. False without memory; plan_assignment_free is due all the same. */
bool plan_assign(struct plan_assignment *assignment, const struct plan_round *round,
                 const int *home, int n_ranks);
void plan_assignment_free(struct plan_assignment *assignment);

/* The words of a set. They move when another set grows. */
static inline const uint64_t *plan_ranks(const struct plan_rank_sets *sets, uint32_t set)
{
    const uint32_t few = (uint32_t)sets->n_ranks + 1;
    return sets->word + (set < few ? sets->few[set] : set - few) * sets->words;
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
    const uint32_t set = a->set[node], few = (uint32_t)a->n_ranks + 1;
    return set < few ? set == (uint32_t)rank + 1 : base_ranks_has(plan_ranks(&a->sets, set), rank);
}
/* Nobody runs the node: what it makes is overwritten unread. */
static inline bool plan_is_dead(const struct plan_assignment *assignment, size_t node)
{
    return !assignment->set[node];
}
/* The node that makes the version; of one that enters the round, the one that made it in the round
 * before. PLAN_NONE: the graph does not write the object. */
static inline uint32_t plan_maker(const struct plan_assignment *a, uint32_t version)
{
    const struct plan_version *found = &a->version[version];
    if (!found->maker)
        found = &a->version[a->last[found->object]];
    return found->maker - 1;
}
/* Whether a rank has the version without a message within the round. */
static inline bool plan_is_there(const struct plan_assignment *a, uint32_t version, int rank)
{
    const uint32_t maker = plan_maker(a, version);
    return maker == PLAN_NONE || plan_runs(a, maker, rank);
}

/* ---- Messages: what moves, and when ---- */

/* A moment in the round: its beginning, 0; when the pieces of the sum at node n are made; after
 * some rounds of its way from rank to rank; when node n is over. */
typedef uint64_t plan_moment;
static inline plan_moment plan_moment_sum(size_t n, uint32_t rounds)
{
    return 64 * (plan_moment)n + 1 + rounds;
}
static inline plan_moment plan_moment_over(size_t n)
{
    return 64 * (plan_moment)n + 64;
}

/* Some leaves of a sum in a row, combined: a complete subtree, or all leaves. */
struct plan_leaves {
    struct data_subtree tree; /* where: for whoever has a use for it */
    uint32_t n;               /* leaves, from tree.first on */
};

/* Contributions of one rank to one sum. */
struct plan_piece {
    uint32_t node; /* the sum */
    struct plan_leaves leaves;
    int rank;       /* that has all of them */
    uint32_t phase; /* that it moves in, if it goes directly */
};

/* What a rank sends another one in a round of a sum's way from rank to rank. */
struct plan_hop {
    uint32_t node, round; /* of the sum */
    int from, to;
    const struct plan_leaves *leaves; /* n > 0, in order */
    size_t n;
};
typedef void plan_relay_visit(void *context, const struct plan_hop *hop);

/* A message a round: all that goes from one rank to another in one phase. */
struct plan_message {
    int from, to;
    uint32_t phase;
    plan_moment ready;  /* all that it carries is made */
    size_t first, last; /* items, plus 1; 0: none */
    uint32_t next;      /* another between the two ranks, plus 1 */
};

/* One thing in one message: a version, a piece, or what a sum's relay passes on. */
struct plan_item {
    uint32_t message, object;
    uint32_t version, piece;   /* ids, or PLAN_NONE */
    struct plan_leaves leaves; /* if both are none: of the sum whose moment `made` is */
    plan_moment made;
    size_t next; /* of the same message, plus 1 */
};

struct plan_messages {
    const struct plan_assignment *assignment;
    int rank;                 /* whose messages these are, or PLAN_ALL */
    uint32_t *phase;          /* by node: rank crossings on the longest path to it, at most */
    uint8_t *rounds;          /* by node: of a sum that goes from rank to rank; 0: directly */
    uint32_t *leaf;           /* by buffer, less n_objects: the node that fills it */
    struct plan_piece *piece; /* of all sums and ranks, in order */
    size_t n_pieces;
    size_t *first_piece; /* by node, n_nodes + 1: of a sum */
    struct plan_message *message;
    size_t n_messages, messages_capacity;
    struct plan_item *item;
    size_t n_items, items_capacity;
};

/* Takes an assignment; leaves:
 * - the phase of a node is at least that of all that comes before it on its rank, for whatever
 *   reason, and above that of each message that it waits for; the phase of a message is that of the
 *   nodes that make what it carries. So a message waits for messages of lower phases only, never in
 *   a ring;
 * - the pieces of a sum cover its leaves in order, each once, and each of them is a complete
 *   subtree, or all leaves. A sum that one rank contributes to and reads alone has a piece a leaf,
 *   one that nobody runs has none;
 * - a version that one rank makes is an item for each other rank that needs it; so is a piece for
 *   each other rank that runs its sum. Where these are more than four ranks, and for a version more
 *   than half of all, they go from rank to rank in rounds, in as many phases (relay.c);
 * - items are in order of `made`, the same from the sender's and the receiver's side.
 * Messages and items are those from and to `rank`, or all, or none (PLAN_NO_RANK). False without
 * memory; plan_messages_free is due all the same. */
bool plan_messages_find(struct plan_messages *messages, const struct plan_assignment *assignment,
                        int rank);
void plan_messages_free(struct plan_messages *messages);

/* Of sums that go from rank to rank; of plan_messages_find. The first finds messages->rounds, when
 * leaves are known; the second walks through the hops of one, round by round, when pieces are. Both
 * are false without memory. */
bool plan_relay_find(struct plan_messages *messages);
bool plan_relay_walk(const struct plan_messages *messages, size_t node, plan_relay_visit *visit,
                     void *context);
/* Rounds in which a value goes from the rank that has it, and on from rank to rank, to a set of
 * ranks; 0: directly. The ring (NULL: it is not wanted; room for all ranks) begins with that rank:
 * in round s the first 2^s of the ring send to the 2^s after them. The second asks for a version.
 */
uint32_t plan_relay_ring(const uint64_t *set, int n_ranks, int from, int *ring, size_t *n);
uint32_t plan_relay_version(const struct plan_assignment *assignment, uint32_t version, int *ring,
                            size_t *n);
/* Lists of leaves, in order and without a leaf in two of them. What a list has that another one has
 * not; both in one, of which what lies in something larger is left out. `out` has room for all.
 * Return how many. */
size_t plan_leaves_missing(const struct plan_leaves *has, size_t n_has,
                           const struct plan_leaves *from, size_t n_from, struct plan_leaves *out);
size_t plan_leaves_join(const struct plan_leaves *a, size_t n_a, const struct plan_leaves *b,
                        size_t n_b, struct plan_leaves *out);
bool plan_leaves_are_halves(const struct plan_leaves *left, const struct plan_leaves *right);

/* ---- Part: the nodes of one rank ---- */

/* Takes the messages of a rank (not PLAN_ALL); leaves its nodes, without edges:
 * - those of the round that the rank runs, in order; a RECEIVE for each message to it comes first,
 * a SEND for each from it as soon as the last thing that it carries is made; the uses of both are
 *   its items in order, so that both sides agree on the layout;
 * - what the rank writes lies in the objects' own places, what it receives in a buffer for each
 *   version or piece, which nobody but the RECEIVE, a PARTIAL and a sum writes;
 * - a COPY comes before a node that writes on from a received version, and keeps aside what is
 *   overwritten before its message goes;
 * - a PARTIAL combines this rank's contributions to pieces of more than one leaf; and, of a sum
 * that goes from rank to rank, what came in a round with what is there. False without memory;
 * plan_round_free is due all the same. *part is zero before. */
bool plan_part(struct plan_round *part, const struct plan_messages *messages);

/* ---- Edges ---- */

/* Takes the nodes of a round and what they use; adds its edges, and to each node how many it has:
 * - a node waits for the last writer of each place that it reads, and for the readers since (or the
 *   writer, if there are none) of each place that it writes, over two rounds in a row; edges within
 *   a round lead to later nodes, are in order of `to`, and no two join the same nodes;
 * - conflicts are symmetric, so a node that releases another one's next round waited for it in this
 *   round: a node never hears of the next round before it has begun this one;
 * - with a FLAG, it waits for all roots and all roots of the next round wait for it; without, a
 *   root that conflicts with nothing waits for itself in the round before.
 * False without memory. */
bool plan_edges(struct plan_round *round);

/* ---- What mappings see ---- */

/* The nodes of a round in order, and who reads whose results. Says nothing of ranks. */
struct plan_tasks {
    size_t n;
    bool *program;   /* n: a task of the program; else the runtime's */
    double *cost;    /* n: seconds, as its fork says; 0: not said, or not the program's */
    uint32_t *owner; /* n: the object that it runs for; PLAN_NONE: for none, or where it says, or
                        everywhere */
    size_t *start;   /* n + 1: of its rows */
    uint32_t *from;  /* whose result it reads: before it, or, not before it, of the last round */
    double *bytes;   /* of it */
};

/* Takes a lowered round. False without memory; plan_tasks_free is due all the same. */
bool plan_tasks_find(struct plan_tasks *tasks, const struct plan_round *round);
void plan_tasks_free(struct plan_tasks *tasks);

/* ---- What schedulers see ---- */

/* Takes a lowered round with its edges. Returns, by fork, the seconds on the longest path from it
 * to the end of the round, see duite_ready.path. A fork that did not say its cost counts the mean
 * of those that did. The caller frees it by base_free. NULL without memory. */
float *plan_paths_find(const struct plan_round *round);

#endif
