/* One writer a number, the worker, so that it needs no atomic addition. */
#include "runtime/workers/spent.h"

#include "runtime/base/memory.h"

#include <stddef.h>

/* Its place in its row, whose number is the highest bit of block + 1. */
static uint64_t place(uint32_t block, unsigned *row)
{
    uint64_t number = (uint64_t)block + 1;
    *row = 63 - (unsigned)__builtin_clzll(number);
    return number - (UINT64_C(1) << *row);
}

static void add(struct work_spent_for *sum, uint64_t ticks)
{
    uint64_t now = atomic_load_explicit(&sum->ticks, memory_order_relaxed);
    atomic_store_explicit(&sum->ticks, now + ticks, memory_order_relaxed);
}

void work_spend(struct work_spent *spent, uint32_t block, uint64_t ticks)
{
    unsigned row;
    uint64_t at = place(block, &row);
    struct work_spent_for *sums = atomic_load_explicit(&spent->row[row], memory_order_relaxed);
    if (!sums) {
        sums = base_alloc_zero(sizeof *sums << row);
        atomic_store_explicit(&spent->row[row], sums, memory_order_release);
    }
    if (sums)
        add(&sums[at], ticks);
}

void work_spend_else(struct work_spent *spent, uint64_t ticks)
{
    add(&spent->otherwise, ticks);
}

static uint64_t take(struct work_spent_for *sum)
{
    uint64_t now = atomic_load_explicit(&sum->ticks, memory_order_relaxed);
    uint64_t added = now - sum->taken;
    sum->taken = now;
    return added;
}

uint64_t work_spent_take(struct work_spent *spent, uint32_t block)
{
    unsigned row;
    uint64_t at = place(block, &row);
    struct work_spent_for *sums = atomic_load_explicit(&spent->row[row], memory_order_acquire);
    return sums ? take(&sums[at]) : 0;
}

uint64_t work_spent_take_else(struct work_spent *spent)
{
    return take(&spent->otherwise);
}

void work_spent_free(struct work_spent *spent)
{
    for (int row = 0; row < WORK_SPENT_ROWS; row++)
        base_free(atomic_load_explicit(&spent->row[row], memory_order_relaxed));
}
