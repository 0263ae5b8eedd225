/* Every worker's row has all others, nearest first; among equally near ones they begin with the
 * next number, so that workers which go by the row alone do not all try the same one first. */
#include "runtime/workers/near.h"

#include "runtime/base/memory.h"
#include "runtime/workers/cores.h"

/* Insertion keeps equals in the order in which they come. */
static void fill_row(struct work_near *near, unsigned worker)
{
    unsigned others = near->n - 1;
    unsigned *row = near->by_nearness + 2 * (size_t)worker * others, *distance = row + others;
    for (unsigned step = 1; step <= others; step++) {
        unsigned other = (worker + step) % near->n, at = step - 1;
        unsigned far = near->distance[worker * near->n + other];
        for (; at && distance[at - 1] > far; at--) {
            row[at] = row[at - 1];
            distance[at] = distance[at - 1];
        }
        row[at] = other;
        distance[at] = far;
    }
    near->of[worker] = (duite_near){.n = others, .worker = row, .distance = distance};
}

bool work_near_start(struct work_near *near, unsigned n, const int *cores)
{
    near->n = n;
    near->distance = base_alloc_zero((size_t)n * n * sizeof *near->distance);
    near->by_nearness = base_alloc_zero(2 * (size_t)n * n * sizeof *near->by_nearness);
    near->of = base_alloc_zero(n * sizeof *near->of);
    if (!near->distance || !near->by_nearness || !near->of)
        return false;
    for (unsigned i = 0; i < n && cores; i++)
        for (unsigned j = 0; j < n; j++)
            near->distance[i * n + j] = work_cores_distance(cores[i], cores[j]);
    for (unsigned i = 0; i < n; i++)
        fill_row(near, i);
    return true;
}

void work_near_stop(struct work_near *near)
{
    base_free(near->distance);
    base_free(near->by_nearness);
    base_free(near->of);
}
