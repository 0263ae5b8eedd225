#ifndef DUITE_MAP_BLOCKS_H
#define DUITE_MAP_BLOCKS_H

#include "runtime/plan/record.h"

/* Blocks: objects that live together, a leader with all that follow it (their home and their number
 * there are the same), as long as one of them is alive; and what recorded tasks carry from one to
 * another. Made anew from the table when it is asked for, since it seldom is. */
struct map_block {
    int home;
    uint32_t number; /* data_object.block */
    bool fixed;      /* tasks that must not move run for one of its objects */
    size_t objects, bytes;
};

#define MAP_NO_BLOCK UINT32_MAX

struct map_blocks {
    size_t n;
    struct map_block *block; /* in the order of their first slots, the same on every rank */
    uint32_t *of;            /* by slot: its block, or MAP_NO_BLOCK: the slot is free */
};

/* All objects have homes. Errors: memory; map_blocks_free is due all the same. */
int map_blocks_find(const struct data_table *table, struct map_blocks *blocks);
void map_blocks_free(struct map_blocks *blocks);

/* The bytes that tasks running for one block read from objects of another: undirected, in
 * compressed rows. Zeroed to begin with. */
struct map_traffic {
    struct map_edge {
        uint32_t from, to;
        double bytes;
    } * edge;
    size_t n, capacity;
    size_t *start; /* blocks->n + 1 */
    uint32_t *neighbour;
    double *bytes;
};

/* Adds what a record's forks carry in so many rounds. Errors: memory. */
int map_traffic_add(struct map_traffic *traffic, const struct map_blocks *blocks,
                    const struct plan_record *record, double rounds);
/* Adds that a task which runs for one block reads so many bytes of another. False without memory.
 */
bool map_traffic_read(struct map_traffic *traffic, uint32_t own, uint32_t other, double bytes);
/* Nothing more is added: makes the rows of it, each neighbour once. Errors: memory. */
int map_traffic_end(struct map_traffic *traffic, const struct map_blocks *blocks);
void map_traffic_free(struct map_traffic *traffic);

#endif
