/* Leaves, and pieces of other ranks, come in any order; they combine by their places in the tree of
 * subtrees.h once all are there. */
#include "runtime/data/sum.h"

#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"
#include "runtime/base/stack.h"

#include <stdlib.h>
#include <string.h>

struct data_sum *data_sum_new(int n_ranks, const duite_law *law, duite_type type, size_t count)
{
    const size_t bytes = sizeof(struct data_sum) + base_ranks_words(n_ranks) * sizeof(uint64_t);
    struct data_sum *sum = base_pool_take(bytes);
    if (!sum)
        return NULL;
    memset(sum, 0, bytes);
    sum->bytes = bytes;
    sum->law = law;
    sum->type = type;
    sum->count = count;
    atomic_init(&sum->pending, 1);
    atomic_init(&sum->arrived, NULL);
    atomic_init(&sum->lost, NULL);
    return sum;
}

/* Combines two neighbours into the left one; absent values are skipped. */
static void pieces_combine(const struct data_sum *sum, struct data_piece *left,
                           struct data_piece *right)
{
    if (left->value && right->value) {
        sum->law->combine(left->value, right->value, sum->count, sum->type);
    } else if (right->value) { /* every packet keeps an owner: pieces may share its bytes */
        struct data_packet *packet = left->packet;
        left->packet = right->packet;
        right->packet = packet;
        left->value = right->value;
        right->value = NULL;
    }
}

/* The pieces that a reduction numbers. */
struct reduced {
    const struct data_sum *sum;
    struct data_piece **piece;
};

static void pieces_combine_numbered(void *context, uint32_t left, uint32_t right)
{
    const struct reduced *reduced = context;
    pieces_combine(reduced->sum, reduced->piece[left], reduced->piece[right]);
}

struct data_piece *data_piece_new(void)
{
    struct data_piece *piece = base_pool_take(sizeof *piece);
    if (piece)
        *piece = (struct data_piece){0};
    return piece;
}

static void pieces_free(struct data_piece *piece)
{
    while (piece) {
        struct data_piece *next = piece->next;
        data_packet_free(piece->packet);
        base_pool_give(piece, sizeof *piece);
        piece = next;
    }
}

void data_sum_free(struct data_sum *sum)
{
    pieces_free(sum->pieces);
    pieces_free(atomic_load_explicit(&sum->arrived, memory_order_acquire));
    base_pool_give(sum, sum->bytes);
}

void data_sum_sender(struct data_sum *sum, int rank)
{
    sum->senders += !base_ranks_has(sum->contributors, rank);
    base_ranks_add(sum->contributors, rank);
}

struct data_piece *data_sum_leaf(struct data_sum *sum, uint64_t leaf)
{
    struct data_piece *piece = data_piece_new();
    if (!piece)
        return NULL;
    piece->sum = sum;
    piece->tree.first = leaf;
    piece->next = sum->pieces;
    sum->pieces = piece;
    atomic_fetch_add_explicit(&sum->pending, 1, memory_order_relaxed);
    return piece;
}

bool data_sum_open(const struct data_sum *sum, struct data_piece *leaf)
{
    const size_t bytes = data_sum_bytes(sum);
    leaf->packet = data_packet_new(bytes, !sum->law->neutral);
    if (!leaf->packet)
        return false;
    leaf->value = data_payload(leaf->packet);
    if (sum->law->neutral)
        sum->law->neutral(leaf->value, sum->count, sum->type);
    return true;
}

void data_sum_arrive(struct data_sum *sum, struct data_piece *piece)
{
    BASE_STACK_PUSH(&sum->arrived, piece, memory_order_release);
}

struct data_waiter *data_sum_release(struct data_sum *sum)
{
    if (atomic_fetch_sub_explicit(&sum->pending, 1, memory_order_acq_rel) != 1)
        return NULL;
    return sum->reducer;
}

static int piece_compare_first(const void *a, const void *b)
{
    const struct data_piece *l = *(struct data_piece *const *)a;
    const struct data_piece *r = *(struct data_piece *const *)b;
    return (l->tree.first > r->tree.first) - (l->tree.first < r->tree.first);
}

static size_t pieces_count(const struct data_piece *piece)
{
    size_t n = 0;
    for (; piece; piece = piece->next)
        n++;
    return n;
}

/* All pieces, local and arrived, in one array by their leaves; false without memory. Leaves were
 * put at the front of their list, so filling their part from its end puts them in order. */
static bool pieces_collect(struct data_sum *sum, struct data_pieces *pieces)
{
    struct data_piece *arrived = atomic_load_explicit(&sum->arrived, memory_order_acquire);
    size_t at = pieces_count(sum->pieces);
    pieces->n = at + pieces_count(arrived);
    pieces->room = (pieces->n + 1) * sizeof *pieces->piece;
    pieces->piece = base_pool_take(pieces->room);
    if (!pieces->piece)
        return false;
    struct data_piece **behind = pieces->piece + at;
    for (struct data_piece *p = sum->pieces; p; p = p->next)
        pieces->piece[--at] = p;
    for (struct data_piece *p = arrived; p; p = p->next)
        *behind++ = p;
    if (arrived)
        qsort(pieces->piece, pieces->n, sizeof *pieces->piece, piece_compare_first);
    return true;
}

void data_pieces_free(struct data_pieces *pieces)
{
    base_pool_give(pieces->piece, pieces->room);
}

/* Reduces all pieces; `fold`: also folds the remaining ones into the first. `row` has room for all.
 */
static void pieces_reduce(struct data_sum *sum, bool fold, struct data_pieces *pieces,
                          struct data_subtree *row)
{
    struct data_piece **all = pieces->piece;
    struct reduced reduced = {sum, all};
    struct data_subtrees list = {.at = row};
    for (uint32_t i = 0; i < pieces->n; i++) {
        all[i]->tree.where = i;
        data_subtrees_push(&list, all[i]->tree, pieces_combine_numbered, &reduced);
    }
    if (fold)
        data_subtrees_fold(&list, pieces_combine_numbered, &reduced);
    for (size_t i = 0; i < list.n; i++) { /* from where it stands, or behind that */
        all[i] = all[row[i].where];
        all[i]->tree = row[i];
    }
    pieces->n = list.n;
}

const struct data_failure *data_sum_reduce(struct data_sum *sum, bool fold,
                                           struct data_pieces *pieces, int *code)
{
    const struct data_failure *failure = atomic_load_explicit(&sum->lost, memory_order_relaxed);
    const bool fine = pieces_collect(sum, pieces);
    const size_t bytes = (pieces->n + 1) * sizeof(struct data_subtree);
    struct data_subtree *row = fine ? base_pool_take(bytes) : NULL;
    *code = row ? DUITE_OK : DUITE_E_MEMORY;
    for (size_t i = 0; i < pieces->n && row; i++)
        failure = data_failure_first(failure, pieces->piece[i]->failure);
    if (row && !failure)
        pieces_reduce(sum, fold, pieces, row);
    else
        pieces->n = 0;
    base_pool_give(row, bytes);
    return *code ? NULL : failure;
}

const struct data_failure *data_sum_fold(struct data_sum *sum, struct data_piece **whole, int *code)
{
    struct data_pieces pieces;
    const struct data_failure *failure = data_sum_reduce(sum, true, &pieces, code);
    *whole = pieces.n && pieces.piece[0]->value ? pieces.piece[0] : NULL;
    data_pieces_free(&pieces);
    return failure;
}

void data_piece_take(struct data_piece *leaf, struct data_piece *piece)
{
    if (!piece)
        return;
    leaf->packet = piece->packet;
    leaf->value = piece->value;
    piece->packet = NULL;
}
