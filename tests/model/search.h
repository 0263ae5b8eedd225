#ifndef TESTS_MODEL_SEARCH_H
#define TESTS_MODEL_SEARCH_H

#include "tests/model/machine.h"

struct search_result {
    uint64_t executions, cut; /* to the end; given up, as they could bring nothing new */
    bool all;                 /* nothing is left to try */
    bool planted;             /* the plant changed something */
    int longest;              /* steps */
    const char *wrong;        /* what the last execution did, or NULL */
};

/* Runs executions of the case until one goes wrong, all are done, or there are `max` (if > 0). */
struct search_result search_all(const struct explore_case *small, struct explore_plant plant,
                                uint64_t max);
/* The steps of the last execution. */
void search_print(void);

#endif
