/* Copies are found in the finished springs: a block has one of each row that its springs into a
 * neighbour end at, neighbour after neighbour, by rising number in the neighbour's rim. */
#include "cloth/flow/tables/tables.h"

#include <stdlib.h>
#include <string.h>

/* The copies of block b of its neighbour s; `number` has room for any rim. */
static void fill_slot(const struct flow_tables *tables, struct flow_table *b, uint32_t s,
                      uint32_t *copies, uint32_t *copy, uint32_t (*end)[2], uint32_t *number)
{
    const uint32_t n_rim = tables->block[b->slot[s]].n_rim;
    memset(number, 0, n_rim * sizeof *number);
    for (uint32_t i = b->cut[s]; i < b->cut[s + 1]; i++)
        number[b->end[b->n_inner + i][1]] = 1;
    for (uint32_t row = 0; row < n_rim; row++) {
        if (!number[row])
            continue;
        number[row] = b->n_copies;
        copy[b->n_copies++] = row;
    }
    copies[s + 1] = b->n_copies;
    for (uint32_t i = b->cut[s]; i < b->cut[s + 1]; i++) {
        end[i][0] = b->end[b->n_inner + i][0];
        end[i][1] = number[b->end[b->n_inner + i][1]];
    }
}

static void fill(struct flow_tables *t, uint32_t *number)
{
    uint32_t *copies = t->copies, *copy = t->copy, (*end)[2] = t->copy_end;
    for (uint32_t i = 0; i < t->n_blocks; i++) {
        struct flow_table *b = t->block + i;
        copies[0] = 0;
        for (uint32_t s = 0; s < b->n_slots; s++)
            fill_slot(t, b, s, copies, copy, end, number);
        b->copies = copies;
        b->copy = copy;
        b->copy_end = (const uint32_t(*)[2])end;
        copies += b->n_slots + 1;
        copy += b->n_copies;
        end += b->n_cut;
    }
}

int flow_copies_make(struct flow_tables *t, struct cloth_error *error)
{
    size_t slots = 0, cut = 0, rim = 0;
    for (uint32_t i = 0; i < t->n_blocks; i++) {
        slots += t->block[i].n_slots + 1;
        cut += t->block[i].n_cut;
        rim = t->block[i].n_rim > rim ? t->block[i].n_rim : rim;
    }
    uint32_t *number = malloc((rim + 1) * sizeof *number);
    t->copies = malloc((slots + 1) * sizeof *t->copies);
    t->copy = malloc((cut + 1) * sizeof *t->copy);
    t->copy_end = malloc((cut + 1) * sizeof *t->copy_end);
    const bool has = number && t->copies && t->copy && t->copy_end;
    if (has)
        fill(t, number);
    free(number);
    return has ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the copies of %zu springs",
                            cut);
}
