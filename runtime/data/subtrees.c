/* Lists of complete subtrees are in the order of their leaves, and no leaf is in two of them. A
 * subtree has the same bits wherever it was made, so it does not matter which of two equal ones
 * stays in a list. */
#include "runtime/data/subtrees.h"

#include <stdbool.h>

/* ---- Subtrees ---- */

static uint64_t subtree_leaves(const struct data_subtree *subtree)
{
    return UINT64_C(1) << subtree->level;
}

/* True if the two are the halves of one complete subtree. */
static bool subtrees_are_halves(const struct data_subtree *left, const struct data_subtree *right)
{
    const uint64_t half = subtree_leaves(left);
    return left->level == right->level && left->first + half == right->first &&
           left->first % (2 * half) == 0;
}

static bool subtree_is_within(const struct data_subtree *some, const struct data_subtree *all)
{
    return some->first >= all->first &&
           some->first + subtree_leaves(some) <= all->first + subtree_leaves(all);
}

/* The order of leaves; of two with the same first leaf the larger one is before. */
static bool subtree_is_before(const struct data_subtree *a, const struct data_subtree *b)
{
    return a->first != b->first ? a->first < b->first : a->level >= b->level;
}

struct data_subtree data_subtree_whole(uint64_t n)
{
    struct data_subtree whole = {0};
    while (subtree_leaves(&whole) < n)
        whole.level++;
    return whole;
}

uint64_t data_subtree_end(const struct data_subtree *subtree, uint64_t all)
{
    const uint64_t end = subtree->first + subtree_leaves(subtree);
    return end < all ? end : all;
}

/* ---- The rule ---- */

void data_subtrees_push(struct data_subtrees *list, struct data_subtree subtree,
                        data_combine *combine, void *context)
{
    struct data_subtree *last = &list->at[list->n++];
    *last = subtree;
    for (; list->n > 1 && subtrees_are_halves(last - 1, last); last--) {
        if (combine)
            combine(context, last[-1].where, last->where);
        last[-1].level++;
        list->n--;
    }
}

void data_subtrees_fold(const struct data_subtrees *list, data_combine *combine, void *context)
{
    for (size_t i = list->n; i-- > 1;)
        combine(context, list->at[i - 1].where, list->at[i].where);
}

/* ---- Lists ---- */

void data_subtrees_row(struct data_subtrees *list, uint64_t first, uint64_t n)
{
    list->n = 0;
    for (uint64_t i = 0; i < n; i++)
        data_subtrees_push(list, (struct data_subtree){.first = first + i}, NULL, NULL);
}

void data_subtrees_missing(struct data_subtrees *list, const struct data_subtrees *has,
                           const struct data_subtrees *from)
{
    size_t k = 0;
    list->n = 0;
    for (size_t i = 0; i < from->n; i++) {
        const struct data_subtree *one = &from->at[i];
        while (k < has->n && has->at[k].first + subtree_leaves(&has->at[k]) <= one->first)
            k++;
        if (k == has->n || !subtree_is_within(one, &has->at[k]))
            list->at[list->n++] = *one;
    }
}

void data_subtrees_join(struct data_subtrees *list, const struct data_subtrees *a,
                        const struct data_subtrees *b, data_combine *combine, void *context)
{
    list->n = 0;
    for (size_t i = 0, k = 0; i < a->n || k < b->n;) {
        const bool first = k == b->n || (i < a->n && subtree_is_before(&a->at[i], &b->at[k]));
        const struct data_subtree *next = first ? &a->at[i++] : &b->at[k++];
        if (!list->n || !subtree_is_within(next, &list->at[list->n - 1]))
            data_subtrees_push(list, *next, combine, context);
    }
}
