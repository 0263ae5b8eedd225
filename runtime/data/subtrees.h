#ifndef DUITE_DATA_SUBTREES_H
#define DUITE_DATA_SUBTREES_H

#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* The reduction tree, which decides every bit of a sum. Its leaves are the contributions in fork
 * order. Equal complete subtrees combine, as in a binary counter; once all leaves are in, the
 * remaining subtrees fold from the right. For 7 leaves:
 *
 *     ((0 1) (2 3)) ((4 5) 6)
 *
 * So the shape depends only on the number of leaves. A rank, a node of a plan, or a hop of a relay
 * has a list of complete subtrees of the one tree, in the order of their leaves, no leaf twice. It
 * may combine them as far as that goes; whoever has all leaves finishes the tree. The rule stands
 * here alone: sums in flight (sum.h), plans of recorded rounds (plan/) and predictions of them
 * follow it. */

/* Leaves first .. first + 2^level - 1, or as many of them as there are in all. */
struct data_subtree {
    uint64_t first;
    uint32_t level;
    uint32_t where; /* its value, by a number of the caller's; the rule ignores it */
};

/* A list; `at` has room for all that is put into it. */
struct data_subtrees {
    struct data_subtree *at;
    size_t n;
};

/* Combines two values into that of `left`. Where a list alone is wanted, push
 * and join take NULL. */
typedef void data_combine(void *context, uint32_t left, uint32_t right);

/* Puts a subtree, right of the others, at the end, and combines halves as long as there are any. At
 * most 64 are left if the leaves from 0 on have no gap. */
void data_subtrees_push(struct data_subtrees *list, struct data_subtree subtree,
                        data_combine *combine, void *context);

/* All leaves are in: folds the subtrees, from the right, into the first one. */
void data_subtrees_fold(const struct data_subtrees *list, data_combine *combine, void *context);

/* The list of one who has n leaves in a row, from `first` on. No place has a value. */
enum { DATA_SUBTREES_IN_ROW = 128 };
void data_subtrees_row(struct data_subtrees *list, uint64_t first, uint64_t n);

/* The tree of all n > 0 leaves, folded, as one entry. */
struct data_subtree data_subtree_whole(uint64_t n);

/* The end of a subtree's leaves, if there are `all`. */
uint64_t data_subtree_end(const struct data_subtree *subtree, uint64_t all);

/* The entries of `from` that are not within one of `has`: those that are worth sending. */
void data_subtrees_missing(struct data_subtrees *list, const struct data_subtrees *has,
                           const struct data_subtrees *from);

/* Both lists in one: halves combine; a subtree inside a larger one is dropped. */
void data_subtrees_join(struct data_subtrees *list, const struct data_subtrees *a,
                        const struct data_subtrees *b, data_combine *combine, void *context);

#pragma GCC visibility pop

#endif
