/* The order in which leaves combine comes from their places in fork order and from nothing else. */
#include "runtime/data/sum.h"

#include "runtime/base/memory.h"
#include "runtime/base/pool.h"
#include "runtime/base/rank_set.h"
#include "runtime/base/stack.h"

#include <stdlib.h>

struct data_sum *data_sum_new(int n_ranks, const duite_law *law, duite_type type, size_t count)
{
    size_t words = base_ranks_words(n_ranks);
    struct data_sum *sum = base_alloc_zero(sizeof *sum + words * sizeof *sum->contributors);
    if (!sum)
        return NULL;
    sum->law = law;
    sum->type = type;
    sum->count = count;
    atomic_init(&sum->pending, 1);
    atomic_init(&sum->arrived, NULL);
    atomic_init(&sum->lost, NULL);
    return sum;
}

/* Combines two neighbours into the left one; what is absent is skipped. */
static void combine(const struct data_sum *sum, struct data_piece *left, struct data_piece *right)
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

struct data_piece *data_piece_new(void)
{
    struct data_piece *piece = base_pool_take(sizeof *piece);
    if (piece)
        *piece = (struct data_piece){0};
    return piece;
}

static void piece_free(struct data_piece *piece)
{
    base_pool_give(piece, sizeof *piece);
}

static void free_pieces(struct data_piece *piece)
{
    while (piece) {
        struct data_piece *next = piece->next;
        data_packet_free(piece->packet);
        piece_free(piece);
        piece = next;
    }
}

void data_sum_free(struct data_sum *sum)
{
    free_pieces(sum->pieces);
    free_pieces(atomic_load_explicit(&sum->arrived, memory_order_acquire));
    base_free(sum);
}

void data_sum_sender(struct data_sum *sum, int rank)
{
    sum->senders += !base_ranks_has(sum->contributors, rank);
    base_ranks_add(sum->contributors, rank);
}

struct data_piece *data_sum_leaf(struct data_sum *sum, uint64_t first)
{
    struct data_piece *leaf = data_piece_new();
    if (!leaf)
        return NULL;
    leaf->first = first;
    leaf->next = sum->pieces;
    sum->pieces = leaf;
    atomic_fetch_add_explicit(&sum->pending, 1, memory_order_relaxed);
    return leaf;
}

bool data_sum_open(const struct data_sum *sum, struct data_piece *leaf)
{
    size_t bytes = sum->count * data_type_size(sum->type);
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
    return sum->closer;
}

static int by_first(const void *a, const void *b)
{
    const struct data_piece *l = *(struct data_piece *const *)a;
    const struct data_piece *r = *(struct data_piece *const *)b;
    return (l->first > r->first) - (l->first < r->first);
}

/* The two halves of one complete subtree? */
static bool siblings(const struct data_piece *l, const struct data_piece *r)
{
    uint64_t half = UINT64_C(1) << l->level;
    return l->level == r->level && l->first + half == r->first && l->first % (2 * half) == 0;
}

/* All pieces, local and arrived, in one array by `first`; NULL without memory. */
static struct data_piece **collect(struct data_sum *sum, size_t *n)
{
    struct data_piece *lists[2] = {sum->pieces,
                                   atomic_load_explicit(&sum->arrived, memory_order_acquire)};
    size_t total = 0;
    for (int i = 0; i < 2; i++)
        for (const struct data_piece *p = lists[i]; p; p = p->next)
            total++;
    struct data_piece **all = base_alloc(total * sizeof(struct data_piece *));
    *n = 0;
    for (int i = 0; all && i < 2; i++)
        for (struct data_piece *p = lists[i]; p; p = p->next)
            all[(*n)++] = p;
    if (all)
        qsort(all, *n, sizeof all[0], by_first);
    return all;
}

const struct data_failure *data_sum_reduce(struct data_sum *sum, struct data_piece ***out,
                                           size_t *n, int *code)
{
    size_t total;
    struct data_piece **all = collect(sum, &total);
    *out = all;
    *n = 0;
    *code = all ? DUITE_OK : DUITE_E_MEMORY;
    if (!all)
        return NULL;
    const struct data_failure *failure = atomic_load_explicit(&sum->lost, memory_order_relaxed);
    for (size_t i = 0; i < total; i++)
        failure = data_first(failure, all[i]->failure);
    if (failure)
        return failure;
    size_t top = 0;
    for (size_t i = 0; i < total; i++) {
        all[top++] = all[i];
        for (; top > 1 && siblings(all[top - 2], all[top - 1]); top--) {
            combine(sum, all[top - 2], all[top - 1]);
            all[top - 2]->level++;
        }
    }
    *n = top;
    return NULL;
}

struct data_piece *data_sum_fold(const struct data_sum *sum, struct data_piece **pieces, size_t n)
{
    for (size_t i = n - 1; i > 0; i--)
        combine(sum, pieces[i - 1], pieces[i]);
    return pieces[0]->value ? pieces[0] : NULL;
}

void data_piece_take(struct data_piece *leaf, struct data_piece *piece)
{
    if (!piece)
        return;
    leaf->packet = piece->packet;
    leaf->value = piece->value;
    piece->packet = NULL;
}

void data_sum_finish(const struct data_sum *sum, struct data_piece **pieces, size_t n, void *value)
{
    const struct data_piece *whole = data_sum_fold(sum, pieces, n);
    if (whole)
        sum->law->combine(value, whole->value, sum->count, sum->type);
}
