#ifndef DUITE_DATA_FAILURE_H
#define DUITE_DATA_FAILURE_H

#include <stdint.h>

/* Why a value is poisoned: the task that failed. Plain bytes: it travels between ranks in place of
 * the value. */
struct data_failure {
    int32_t code;    /* of the body, or of the runtime (memory) */
    int32_t rank;    /* where the task ran */
    uint64_t number; /* of the task in fork order: the failure with the smallest is reported */
    uint32_t kernel; /* index in the list given at start */
    char text[204];  /* the body's own sentence, or "" */
};

/* The one that comes first in fork order; either may be NULL. */
static inline const struct data_failure *data_first(const struct data_failure *a,
                                                    const struct data_failure *b)
{
    if (!a || !b)
        return a ? a : b;
    return b->number < a->number ? b : a;
}

#endif
