/* --check: the first phase runs for a moment, as it would without, and nothing is written. The rest
 * follows from its steps. */
#include "cloth/app/simulate_run.h"

#include "cloth/base/clock.h"

#include <stdio.h>

static const double TRIAL = 2; /* s of the clock */

/* Called on rank 0 when a step is over, by one thread. */
void simulate_check_step(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations)
{
    struct run *run = context;
    struct forecast *forecast = &run->forecast;
    (void)step, (void)steps, (void)cg_iterations;
    if (!(forecast->begun > 0))
        forecast->begun = cloth_seconds();
    else if (cloth_seconds() - forecast->begun > TRIAL)
        forecast->over = true;
}

int simulate_check_ends(void *context)
{
    const struct run *run = context;
    return run->forecast.over || simulate_stops(NULL);
}

int simulate_check(struct run *run)
{
    struct cloth_error error = {0};
    const int code = simulate_execute(run);
    if (code)
        return code;
    const struct summary summary = simulate_sum_up(run, &run->report);
    if (run->rank == 0) {
        forecast_end(&run->forecast, &summary);
        forecast_print(stdout, &run->forecast, &summary);
        if (run->options->report)
            forecast_write(&run->forecast, run->options->report, &error);
    }
    run->report.stopped = false; /* by the clock, as was meant */
    return simulate_agree(run, &error);
}
