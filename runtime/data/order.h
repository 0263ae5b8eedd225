#ifndef DUITE_DATA_ORDER_H
#define DUITE_DATA_ORDER_H

#include <duite.h>

#include <stdbool.h>
#include <stdint.h>

/* The order rule: for whom an access waits. It stands here and nowhere else: versions (forks), the
 * edges of plans and the predictor all ask these functions. Pure; any thread.
 *
 * The accesses to an object's copy on one rank are a chain, in fork order. A reader waits for the
 * last writer. A writer waits for the readers since, or for that writer if there are none: those
 * readers waited for it. Contributions by one law wait for nothing. Any other access closes them:
 * a task that combines them, and writes the object, comes first.
 *
 * Modes are immediate: a task with postponed parameters never waits, its children do. */

/* True if an access that writes, or only reads, waits for an earlier one that did. */
static inline bool data_order_waits(bool writes, bool earlier_writes)
{
    return writes || earlier_writes;
}

/* True if an access waits for the value, as a reader; and if it leaves another one, as a writer. */
static inline bool data_order_reads(duite_mode mode)
{
    return mode & DUITE_R;
}
static inline bool data_order_writes(duite_mode mode)
{
    return mode & DUITE_W;
}
_Static_assert((DUITE_R & DUITE_W) == 0 && DUITE_RW == (DUITE_R | DUITE_W) &&
                   (DUITE_CW & DUITE_RW) == 0,
               "bits of an immediate mode");

/* True if the access is one more of the open contributions; else it closes them. `law`: its own, if
 * it contributes. */
static inline bool data_order_joins(duite_mode mode, const duite_law *law, const duite_law *open)
{
    return mode == DUITE_CW && law == open;
}

/* ---- A chain as lists of numbers, for those who make edges ---- */

struct data_order_chain {
    uint32_t writer; /* the last one, plus 1; 0: none */
    uint32_t reader; /* the first in a list of readers since: its place, plus 1; 0: none */
};

struct data_order_reader {
    uint32_t who, next;
};

/* `after` waits for `before`. False: it need not, since `before` used another copy. */
typedef bool data_order_edge(void *context, uint32_t before, uint32_t after);

/* The chain's next access, by `who`. edge: called for each one that it waits for. reader,
 * n_readers: the lists of all chains, with room for one more. */
__attribute__((always_inline)) static inline void
data_order_next(struct data_order_chain *chain, struct data_order_reader *reader,
                uint32_t *n_readers, uint32_t who, bool writes, data_order_edge *edge,
                void *context)
{
    bool waits = false;
    if (data_order_waits(writes, false))
        for (uint32_t i = chain->reader; i; i = reader[i - 1].next)
            waits |= edge(context, reader[i - 1].who, who);
    if (!waits && chain->writer && data_order_waits(writes, true))
        edge(context, chain->writer - 1, who);
    if (writes) {
        *chain = (struct data_order_chain){.writer = who + 1};
        return;
    }
    reader[*n_readers] = (struct data_order_reader){who, chain->reader};
    chain->reader = ++*n_readers;
}

#endif
