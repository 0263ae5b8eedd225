#ifndef CLOTH_GARMENT_DETAIL_MEET_H
#define CLOTH_GARMENT_DETAIL_MEET_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* A closed loop of places that is divided into edges: edge e goes from place start[e] to place
 * start[e + 1], the last one to the first place. */
struct meet_loop {
    uint32_t n_edges;
    const uint32_t *start;    /* n_edges + 1 */
    const double (*place)[2]; /* start[n_edges] */
};

/* Whether two parts of the loop that are not neighbours come nearer than `near` to each other, or
 * two neighbours fold back on each other; edge[0] <= edge[1] are where. *found says which; it is
 * the first one in the order of the edges. Error: CLOTH_E_MEMORY. Local. */
int meet_find(const struct meet_loop *loop, double near, bool *found, uint32_t edge[2],
              struct cloth_error *error);

#endif
