#ifndef DUITE_BALANCE_REFINE_H
#define DUITE_BALANCE_REFINE_H

#include <duite_policy.h>
#include <stdbool.h>

/* New homes for blocks, starting from the present ones. Pure functions of their arguments. */

/* The cost of some homes in the measured time. */
struct balance_bill {
    double max;  /* seconds a worker of the rank that has most to do */
    double even; /* the mean: `max` if all ranks had equal work */
    double cut;  /* seconds of messages between ranks, a rank */
    double move; /* seconds that the move from the present homes takes */
};

/* False without memory. */
bool balance_bill(const duite_blocks *blocks, const int *present, const int *home,
                  struct balance_bill *bill);

/* Moves single blocks away from the rank with most to do, as long as that helps. Takes, of the
 * moves that help at least half as much as the best, the one with the least cut. No move takes
 * longer than it saves in `periods` times the measured time. home: the present ones, changed. False
 * without memory. */
bool balance_refine(const duite_blocks *blocks, double periods, int *home);

/* Maps the blocks again by the program's mapping, with the measured work; names the parts so that
 * many bytes stay; and refines. home: the present ones, changed. False without memory, or if the
 * mapping fails. */
bool balance_anew(const duite_blocks *blocks, double periods, int *home);

#endif
