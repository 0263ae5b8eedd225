#ifndef DUITE_MAP_BLOCKS_H
#define DUITE_MAP_BLOCKS_H

#include "runtime/map/map.h"
#include "runtime/plan/passes.h"

/* Blocks, and the bytes that recorded tasks read from one for another. A block is a leader with all
 * objects that follow it: they share a home and a number there. It exists as long as one of them is
 * alive. The list of blocks is made from the table on each request, which is seldom. */
struct map_block {
    int home;
    uint32_t number; /* data_object.block */
    bool fixed;      /* tasks that must not move run for one of its objects: the block stays */
    size_t objects, bytes;
};

#define MAP_NO_BLOCK UINT32_MAX

struct map_blocks {
    size_t n;
    struct map_block *block; /* in the order of their first slots, the same on every rank */
    uint32_t *of;            /* by slot: its block, or MAP_NO_BLOCK: the slot is free */
};

/* The bytes that tasks running for one block read from objects of another: undirected, in
 * compressed rows. Zeroed to begin with. */
struct map_traffic {
    struct map_edge {
        uint32_t from, to;
        double bytes;
    } * edge;
    size_t n, capacity;
    void *memory;  /* of the rows */
    size_t *start; /* n_blocks + 1 */
    uint32_t *neighbour;
    double *bytes;
};

/* Adds the bytes that the forks of so many rounds read from other blocks. block: by object, or
 * MAP_NO_BLOCK. Errors: memory. */
int map_traffic_add(struct map_traffic *traffic, const struct plan_source *source,
                    const uint32_t *block, double rounds);
/* Adds that a task which runs for one block reads so many bytes of another. False without memory.
 */
bool map_traffic_read(struct map_traffic *traffic, uint32_t own, uint32_t other, double bytes);
/* Makes the rows, each neighbour once. Called last, after all additions. Errors: memory. */
int map_traffic_end(struct map_traffic *traffic, size_t n_blocks);
void map_traffic_free(struct map_traffic *traffic);

/* Blocks that may move, as a policy sees them, and the homes that it wants. The runtime fills in
 * its measurements, the predictor those of a trace. */
struct map_moves {
    void *memory; /* of the arrays */
    struct map_blocks blocks;
    struct map_traffic traffic;
    double *seconds;      /* n: in bodies; zeros to begin with */
    size_t *bytes;        /* n: of all objects; zeros to begin with */
    unsigned char *fixed; /* n */
    int *home;            /* n: the present homes, then those to be */
    unsigned *workers;    /* a rank; zeros to begin with */
    int n_ranks;
    double byte_seconds,
        message_seconds;              /* per byte, per message to a rank; 0 to begin with, and */
    uint64_t seed;                    /* so are these: */
    const struct map_policy *mapping; /* the program's */
};

/* Finds the blocks. All objects have homes. Errors: memory; map_moves_free is due all the same. */
int map_moves_new(const struct data_table *table, struct map_moves *moves);
void map_moves_free(struct map_moves *moves);

/* True if the policy left a fixed block where it is, and named a rank that exists. */
bool map_moves_is_allowed(const struct map_moves *moves, size_t block);
/* The error of a policy that did neither: "mapping" or "balancer", and its name. */
int map_moves_refused(const char *kind, const char *name);

/* The blocks as a balancer sees them; the caller adds the times and replays since it was last
 * asked. Points into the moves, whose traffic was ended. */
duite_blocks map_moves_shown(const struct map_moves *moves);

/* Shows the mapping the tasks of a round, which writes the homes to be. block: by object, as above.
 * *guessed: some forks gave no cost. Errors: memory; those of the mapping. */
int map_moves_ask(struct map_moves *moves, const struct plan_source *source, const uint32_t *block,
                  bool *guessed);

/* Gives each block that moves a number that no other block ever had at its new home. */
void map_moves_number(struct map_moves *moves, struct data_table *table);

#endif
