#ifndef DUITE_BALANCE_REFINE_H
#define DUITE_BALANCE_REFINE_H

#include <duite_policy.h>
#include <stdbool.h>

/* New homes for blocks, starting from the present ones. Pure functions of their arguments. */

/* What some homes cost in the time that was measured. */
struct balance_bill {
    double max;  /* seconds a worker of the rank that has most to do */
    double even; /* the mean: `max` if all ranks had equal work */
    double cut;  /* seconds of messages between ranks, a rank */
    double move; /* seconds that the move from the present homes takes */
};

/* False without memory. */
bool balance_bill(const duite_blocks *blocks, const int *present, const int *home,
                  struct balance_bill *bill);

/* Moves single blocks away from the rank that has most to do, as long as that helps, to ranks with
 * less: of those that help about as much as the best, the one that cuts least. A move that takes
 * longer than it saves in `periods` times the measured time is not made. home: the present ones,
 * changed. False without memory. */
bool balance_refine(const duite_blocks *blocks, double periods, int *home);

/* Maps the blocks again, by the program's mapping, with the measured work; names the parts so that
 * as many bytes as possible stay; and refines. home: the present ones, changed. False if that is
 * not possible: memory, or the mapping fails. */
bool balance_anew(const duite_blocks *blocks, double periods, int *home);

#endif
