/* Decisions use only the grid and the verdict, which are equal on all ranks. */
#include "cloth/flow/run/grid.h"

#include <math.h>

/* A pile whose full steps fail for good then solves a step in 32 halves in vain. */
enum { MOST_PATIENCE = 16 };

void flow_grid_begin(struct flow_grid *grid, uint64_t n_steps)
{
    *grid = (struct flow_grid){
        .end = n_steps * FLOW_TICKS, .length = FLOW_TICKS, .least_done = FLOW_TICKS, .patience = 1};
}

bool flow_grid_halve(struct flow_grid *grid, bool learns)
{
    if (grid->length == 1)
        return false;
    if (grid->grown && learns) {
        grid->patience = grid->patience < MOST_PATIENCE ? 2 * grid->patience : MOST_PATIENCE;
        grid->later = grid->now + (uint64_t)grid->patience * grid->length;
    }
    grid->grown = false;
    grid->length /= 2;
    grid->refused++;
    return true;
}

void flow_grid_accept(struct flow_grid *grid, bool calm)
{
    grid->now += grid->length;
    if (grid->length < grid->least_done)
        grid->least_done = grid->length;
    if (grid->grown && grid->patience > 1)
        grid->patience /= 2;
    const uint32_t twice = 2 * grid->length;
    grid->grown = calm && twice <= FLOW_TICKS && grid->now % twice == 0 && grid->now >= grid->later;
    if (grid->grown)
        grid->length = twice;
}

bool flow_verdict_refuses(const struct flow_verdict *verdict)
{
    const double growth = verdict->after - verdict->before;
    if (verdict->failed || !isfinite(verdict->after))
        return true;
    return (verdict->max > 0 && verdict->after > verdict->max && growth > 0) ||
           (verdict->growth > 0 && growth > verdict->growth);
}

bool flow_verdict_calm(const struct flow_verdict *verdict)
{
    const double growth = verdict->after - verdict->before;
    return !(verdict->growth > 0 && growth > verdict->growth / 2) &&
           !(verdict->max > 0 && growth > 0 && verdict->after + 2 * growth > verdict->max);
}
