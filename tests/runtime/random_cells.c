/* The order in which contributions combine is that of a binary counter, kept here as its digits. */

#include "tests/runtime/random_cells.h"

#include <stdlib.h>

const struct prog_failure PROG_NO_FAILURE = {~0u, DUITE_OK};

struct prog_failure prog_first_failure(struct prog_failure a, struct prog_failure b)
{
    return a.number <= b.number ? a : b;
}

size_t prog_cell_bytes(const struct prog_cell *cell)
{
    return cell->count * prog_size(cell->type);
}

void prog_cell_start(struct prog_cell *cell, const struct prog_object *shape)
{
    *cell = (struct prog_cell){.type = shape->type,
                               .count = shape->count,
                               .max = shape->max ? shape->max : shape->count,
                               .poison = PROG_NO_FAILURE,
                               .pending = PROG_NO_FAILURE};
    cell->value = prog_memory(cell->max, prog_size(cell->type));
}

void prog_cell_end(struct prog_cell *cell)
{
    free(prog_cell_fold(cell));
    free(cell->value);
    cell->value = NULL;
}

/* left and right, the one that is there if the other is absent. */
static unsigned char *join(const struct prog_cell *cell, unsigned char *left, unsigned char *right)
{
    if (left && right) {
        prog_combine(cell->law, cell->type, cell->count, left, right);
        free(right);
    }
    return left ? left : right;
}

void prog_cell_contribute(struct prog_cell *cell, enum prog_law law, unsigned char *leaf)
{
    unsigned level = 0;

    if (cell->law != law)
        prog_cell_settle(cell)->law = law;
    for (; cell->n_subtrees && cell->level[cell->n_subtrees - 1] == level; level++)
        leaf = join(cell, cell->subtree[--cell->n_subtrees], leaf);
    cell->level[cell->n_subtrees] = level;
    cell->subtree[cell->n_subtrees++] = leaf;
}

unsigned char *prog_cell_fold(struct prog_cell *cell)
{
    unsigned char *tree = NULL;

    while (cell->n_subtrees)
        tree = join(cell, cell->subtree[--cell->n_subtrees], tree);
    return tree;
}

struct prog_cell *prog_cell_settle(struct prog_cell *cell)
{
    cell->value = join(cell, cell->value, prog_cell_fold(cell));
    cell->poison = prog_first_failure(cell->poison, cell->pending);
    cell->pending = PROG_NO_FAILURE;
    return cell;
}
