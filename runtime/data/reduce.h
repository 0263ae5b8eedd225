#ifndef DUITE_DATA_REDUCE_H
#define DUITE_DATA_REDUCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The reduction tree, which decides every bit of a sum. Its leaves are the contributions in fork
 * order. Equal complete subtrees combine, as in a binary counter; once all leaves are in, the
 * remaining subtrees fold from the right. For 7 leaves:
 *
 *     ((0 1) (2 3)) ((4 5) 6)
 *
 * So the shape depends only on the number of leaves. Each rank, and each node of a plan, may reduce
 * its own leaves to complete subtrees of the one tree. The holder of all subtrees finishes it. The
 * rule stands here; sums in flight (sum.h) and plans of recorded rounds (plan/) follow it. */

/* A complete subtree: leaves first .. first + 2^level - 1. */
struct data_subtree {
    uint64_t first;
    uint32_t level;
    uint32_t where; /* its value, by a number of the caller's; the rule ignores it */
};

/* Combines two values into that of `left`. */
typedef void data_combine(void *context, uint32_t left, uint32_t right);

/* True if the two are the halves of one complete subtree. */
static inline bool data_subtree_are_halves(const struct data_subtree *left,
                                           const struct data_subtree *right)
{
    uint64_t half = UINT64_C(1) << left->level;
    return left->level == right->level && left->first + half == right->first &&
           left->first % (2 * half) == 0;
}

/* A subtree, right of the others, was put behind n of them in a row: combines halves as long as
 * there are any. Returns how many subtrees are left; at most 64 if the leaves have no gap. */
static inline size_t data_reduce_push(struct data_subtree *row, size_t n, data_combine *combine,
                                      void *context)
{
    for (n++; n > 1 && data_subtree_are_halves(&row[n - 2], &row[n - 1]); n--) {
        combine(context, row[n - 2].where, row[n - 1].where);
        row[n - 2].level++;
    }
    return n;
}

/* All leaves are in: folds the subtrees that are left, from the right, into the first one. */
static inline void data_reduce_fold(const struct data_subtree *row, size_t n, data_combine *combine,
                                    void *context)
{
    for (size_t i = n; i-- > 1;)
        combine(context, row[i - 1].where, row[i].where);
}

#endif
