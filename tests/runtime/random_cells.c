/* The order in which contributions combine is that of a binary counter, kept here as its digits. */

#include "tests/runtime/random_cells.h"

#include <stdlib.h>
#include <string.h>

const struct prog_failure PROG_NO_FAILURE = {~0u, DUITE_OK};

struct prog_failure prog_first_failure(struct prog_failure a, struct prog_failure b)
{
    return a.number <= b.number ? a : b;
}

size_t prog_cell_bytes(const struct prog_cell *cell)
{
    return cell->count * prog_size(cell->type);
}

static void combine(const struct prog_cell *cell, void *left, const void *right)
{
    prog_combine(cell->law, cell->type, cell->count, left, right);
}

void prog_cell_contribute(struct prog_cell *cell, unsigned char *leaf)
{
    unsigned level = 0;

    while (cell->n_subtrees && cell->level[cell->n_subtrees - 1] == level) {
        unsigned char *left = cell->subtree[--cell->n_subtrees];

        combine(cell, left, leaf);
        free(leaf);
        leaf = left;
        level++;
    }
    cell->level[cell->n_subtrees] = level;
    cell->subtree[cell->n_subtrees++] = leaf;
}

struct prog_cell *prog_cell_settle(struct prog_cell *cell)
{
    if (cell->n_subtrees) {
        unsigned char *tree = cell->subtree[cell->n_subtrees - 1];

        for (unsigned i = cell->n_subtrees - 1; i-- > 0;) {
            combine(cell, cell->subtree[i], tree);
            free(tree);
            tree = cell->subtree[i];
        }
        combine(cell, cell->value, tree);
        free(tree);
        cell->n_subtrees = 0;
    }
    cell->poison = prog_first_failure(cell->poison, cell->pending);
    cell->pending = PROG_NO_FAILURE;
    return cell;
}
