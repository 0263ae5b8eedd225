#ifndef DUITE_DATA_SUM_H
#define DUITE_DATA_SUM_H

#include "runtime/data/law.h"
#include "runtime/data/subtrees.h"
#include "runtime/data/version.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Contributions (cw) to an object between two other accesses, the leaves of a reduction tree in
 * fork order (subtrees.h). A piece is the value of a complete subtree. A rank combines what it has
 * into the largest complete subtrees and sends only these.
 */
struct data_piece {
    struct data_piece *next;
    struct data_sum *sum; /* of a leaf of this rank; else NULL */
    struct data_subtree tree;
    struct data_packet *packet; /* owns the bytes of value, unless it is shared with other pieces */
    void *value; /* NULL: its task did not run yet; it is poisoned; or it is absent, and skipped */
    const struct data_failure *failure; /* poison, or NULL */
};

struct data_sum {
    const duite_law *law; /* of all contributions */
    duite_type type;      /* of the object */
    size_t count;
    struct data_piece *pieces;                 /* of this rank; complete once pending is 0 */
    _Atomic(struct data_piece *) arrived;      /* pieces from other ranks */
    _Atomic(const struct data_failure *) lost; /* why some will never arrive; poisons the whole */
    _Atomic uint32_t pending; /* leaves not run, messages not arrived, and 1 while it is open */
    uint32_t senders; /* how many other ranks have leaves; counted on the rank that holds the
                         object's value */
    struct data_waiter
        *reducer; /* the task that combines or sends; set before the open hold is released */
    struct data_sum *next;   /* its owner's */
    size_t bytes;            /* of all this */
    uint64_t contributors[]; /* the ranks that `senders` counts (base/rank_set.h) */
};

/* An open sum without leaves, for so many ranks. NULL without memory. */
struct data_sum *data_sum_new(int n_ranks, const duite_law *law, duite_type type, size_t count);
/* Frees it with all its pieces. */
void data_sum_free(struct data_sum *sum);

/* Notes that a rank contributes; counts each once. */
void data_sum_sender(struct data_sum *sum, int rank);

/* Bytes of a value: of a leaf, a piece or the whole. */
static inline size_t data_sum_bytes(const struct data_sum *sum)
{
    return sum->count * data_type_size(sum->type);
}

/* Adds a leaf, to be run on this rank: its task fills value. NULL without memory. */
struct data_piece *data_sum_leaf(struct data_sum *sum, uint64_t leaf);

/* The leaf's task is about to run: the leaf gets a value, the law's neutral element. False without
 * memory. */
bool data_sum_open(const struct data_sum *sum, struct data_piece *leaf);

/* An empty piece, for data_sum_arrive to take over. NULL without memory. */
struct data_piece *data_piece_new(void);

/* Adds a piece from another rank; from any thread. */
void data_sum_arrive(struct data_sum *sum, struct data_piece *piece);

/* Takes one from `pending`. Returns the reducer if that was the last one. */
struct data_waiter *data_sum_release(struct data_sum *sum);

/* Pieces in the order of their leaves. The array is the holder's, the pieces are the sum's. */
struct data_pieces {
    struct data_piece **piece;
    size_t n, room;
};
void data_pieces_free(struct data_pieces *pieces);

/* Combines the pieces (pending is 0) as far as complete subtrees go, or into the first one
 * (`fold`), in place. Writes them into *pieces, which data_pieces_free ends in any case. Returns
 * the first failure among them, which poisons the whole; DUITE_E_MEMORY in *code without memory. */
const struct data_failure *data_sum_reduce(struct data_sum *sum, bool fold,
                                           struct data_pieces *pieces, int *code);

/* Combines the pieces of a whole sum (pending is 0) into one of them, in place: *whole; NULL: all
 * are absent. Failures and *code as of data_sum_reduce; *whole is NULL then. */
const struct data_failure *data_sum_fold(struct data_sum *sum, struct data_piece **whole,
                                         int *code);

/* `leaf` gets the value of `piece` (NULL: it is absent), which is made of this rank's leaves. */
void data_piece_take(struct data_piece *leaf, struct data_piece *piece);

#pragma GCC visibility pop

#endif
