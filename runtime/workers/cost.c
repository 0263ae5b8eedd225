/* Each number has one writer, the worker that measures: no addition need be atomic. */
#include "runtime/workers/cost.h"

#include "runtime/base/memory.h"

#include <string.h>

enum { MEMORY_SHIFT = 3 }; /* of means: the last 2^3 bodies count most */

/* ---- Ticks spent for blocks ---- */

/* The block's place in its row; *row: the highest bit of its number, which is 1 for no block. */
static uint64_t spent_place(uint32_t block, unsigned *row)
{
    uint64_t number = (uint64_t)(block + 1) + 1;
    *row = 63 - (unsigned)__builtin_clzll(number);
    return number - (UINT64_C(1) << *row);
}

void work_spend(struct work_spent *spent, uint32_t block, uint64_t ticks)
{
    unsigned row;
    uint64_t at = spent_place(block, &row);
    struct work_spent_for *sums = atomic_load_explicit(&spent->row[row], memory_order_relaxed);
    if (!sums) {
        sums = base_alloc_zero(sizeof *sums << row);
        atomic_store_explicit(&spent->row[row], sums, memory_order_release);
    }
    if (sums)
        queue_bump(&sums[at].ticks, ticks);
}

uint64_t work_spent_take(struct work_spent *spent, uint32_t block)
{
    unsigned row;
    uint64_t at = spent_place(block, &row);
    struct work_spent_for *sums = atomic_load_explicit(&spent->row[row], memory_order_acquire);
    if (!sums)
        return 0;
    uint64_t now = atomic_load_explicit(&sums[at].ticks, memory_order_relaxed);
    uint64_t added = now - sums[at].taken;
    sums[at].taken = now;
    return added;
}

void work_spent_free(struct work_spent *spent)
{
    for (int row = 0; row < WORK_SPENT_ROWS; row++)
        base_free(atomic_load_explicit(&spent->row[row], memory_order_relaxed));
}

/* ---- All of it ---- */

bool work_cost_start(struct work_cost *cost, unsigned workers, uint32_t kernels, bool by_block)
{
    const size_t row = (kernels / 8 + 2) * 8; /* a cache line apart */
    *cost = (struct work_cost){.workers = workers,
                               .row = row,
                               .mean = base_alloc_zero(workers * row * sizeof *cost->mean),
                               .spent = by_block ? base_alloc_zero(workers * sizeof *cost->spent)
                                                 : NULL};
    return cost->mean && (cost->spent || !by_block);
}

bool work_cost_grow(struct work_cost *cost, uint32_t kernels)
{
    const size_t row = (kernels / 8 + 2) * 8;
    if (kernels <= cost->row)
        return true;
    _Atomic uint64_t *mean = base_alloc_zero(cost->workers * row * sizeof *mean);
    if (!mean)
        return false;
    for (unsigned i = 0; i < cost->workers; i++)
        memcpy(&mean[i * row], &cost->mean[i * cost->row], cost->row * sizeof *mean);
    base_free(cost->mean);
    cost->mean = mean;
    cost->row = row;
    return true;
}

void work_cost_stop(struct work_cost *cost)
{
    for (unsigned i = 0; i < cost->workers && cost->spent; i++)
        work_spent_free(&cost->spent[i]);
    base_free(cost->spent);
    base_free(cost->mean);
}

void work_cost_learn(struct work_cost *cost, unsigned worker, const struct task *task,
                     uint64_t ticks)
{
    _Atomic uint64_t *mean = &cost->mean[worker * cost->row + task->kernel];
    uint32_t block;
    if (cost->spent)
        work_spend(&cost->spent[worker], task_follows(task, &block) ? block : DUITE_NO_BLOCK,
                   ticks);
    uint64_t before = atomic_load_explicit(mean, memory_order_relaxed);
    uint64_t now = before ? before - (before >> MEMORY_SHIFT) + (ticks >> MEMORY_SHIFT) : ticks;
    atomic_store_explicit(mean, now ? now : 1, memory_order_relaxed);
}

double work_cost_mean(const struct work_cost *cost, uint32_t kernel)
{
    double sum = 0;
    unsigned known = 0;
    for (unsigned i = 0; i < cost->workers; i++) {
        uint64_t ticks =
            atomic_load_explicit(&cost->mean[i * cost->row + kernel], memory_order_relaxed);
        sum += (double)ticks;
        known += ticks > 0;
    }
    return known ? sum / known : 0;
}

uint64_t work_cost_take(struct work_cost *cost, uint32_t block)
{
    uint64_t ticks = 0;
    for (unsigned i = 0; i < cost->workers; i++)
        ticks += work_spent_take(&cost->spent[i], block);
    return ticks;
}
