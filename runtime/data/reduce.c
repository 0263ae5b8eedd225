/* The rule of the reduction tree: see the header. Nothing here knows what the values are. */
#include "runtime/data/reduce.h"

bool data_subtree_are_halves(const struct data_subtree *left, const struct data_subtree *right)
{
    uint64_t half = UINT64_C(1) << left->level;
    return left->level == right->level && left->first + half == right->first &&
           left->first % (2 * half) == 0;
}

size_t data_reduce_push(struct data_subtree *row, size_t n, data_combine *combine, void *context)
{
    for (n++; n > 1 && data_subtree_are_halves(&row[n - 2], &row[n - 1]); n--) {
        combine(context, row[n - 2].where, row[n - 1].where);
        row[n - 2].level++;
    }
    return n;
}

void data_reduce_fold(const struct data_subtree *row, size_t n, data_combine *combine,
                      void *context)
{
    for (size_t i = n; i-- > 1;)
        combine(context, row[i - 1].where, row[i].where);
}
