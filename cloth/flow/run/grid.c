/* Decisions use only the grid and the verdict, which are equal on all ranks. */
#include "cloth/flow/run/grid.h"

#include <math.h>

void flow_grid_begin(struct flow_grid *grid, uint64_t n_steps)
{
    *grid = (struct flow_grid){
        .end = n_steps * FLOW_TICKS, .length = FLOW_TICKS, .least_done = FLOW_TICKS};
}

bool flow_grid_halve(struct flow_grid *grid)
{
    if (grid->length == 1)
        return false;
    grid->length /= 2;
    grid->refused++;
    return true;
}

void flow_grid_accept(struct flow_grid *grid, bool calm)
{
    grid->now += grid->length;
    if (grid->length < grid->least_done)
        grid->least_done = grid->length;
    const uint32_t twice = 2 * grid->length;
    if (calm && twice <= FLOW_TICKS && grid->now % twice == 0)
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
