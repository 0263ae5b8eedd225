#ifndef DUITE_DATA_FAILURE_H
#define DUITE_DATA_FAILURE_H

#include <stdint.h>
#include <string.h>

/* Why a value is poisoned: the task that failed. Plain bytes: it travels between ranks in place of
 * the value.
 *
 * Its place in the reference order is `number` and, for a task forked by a task, `path`: its index
 * among the children of each ancestor, outermost first, in a code that orders like the numbers
 * (data_path_add). Of paths that are longer the end is cut off: among tasks that differ there only
 * any one may be taken for the first. */
struct data_failure {
    int32_t code;         /* of the body, or of the runtime (memory) */
    int32_t rank;         /* where the task ran */
    uint64_t number;      /* of the main program's task in fork order */
    uint32_t kernel;      /* index in the list given at start */
    uint32_t path_length; /* bytes */
    uint8_t path[104];    /* "" for a task of the main program; zeros behind its end */
    char text[204];       /* the body's own sentence, or "" */
    uint8_t unused[4];
};

/* Appends an index > 0 to the path, if it still fits. */
void data_path_add(struct data_failure *failure, uint64_t index);

/* Writes the task's place as "number.index.index"; `size` bytes at most, cut off with "...". */
void data_path_print(const struct data_failure *failure, char *text, size_t size);

/* The one that comes first in the reference order; either may be NULL. */
static inline const struct data_failure *data_first(const struct data_failure *a,
                                                    const struct data_failure *b)
{
    if (!a || !b)
        return a ? a : b;
    if (a->number != b->number)
        return b->number < a->number ? b : a;
    return memcmp(b->path, a->path, sizeof a->path) < 0 ? b : a;
}

#endif
