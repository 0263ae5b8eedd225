/* What a runtime is started with: the defaults, and what is refused. */
#include "runtime/instance.h"

#include "runtime/balance/balance.h"
#include "runtime/base/error.h"
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"

#include <stdlib.h>
#include <string.h>

/* A number of the environment, or -1 if it is none. */
static double seconds_of(const char *text, double otherwise)
{
    char *end;
    if (!text)
        return otherwise;
    double seconds = strtod(text, &end);
    return end == text || *end ? -1 : seconds;
}

duite_options duite_options_default(void)
{
    const char *check = getenv("DUITE_CHECK");
    return (duite_options){.comm = MPI_COMM_WORLD,
                           .check = !check                       ? 0
                                    : !strcmp(check, "accesses") ? 1
                                                                 : -1,
                           .scheduler = &sched_steal,
                           .mapping = &map_metis,
                           .balance = &balance_none,
                           .seed = 1,
                           .stuck_seconds = seconds_of(getenv("DUITE_STUCK_SECONDS"), 60),
                           .lost_seconds = seconds_of(getenv("DUITE_LOST_SECONDS"), 8),
                           .policy_seconds = seconds_of(getenv("DUITE_POLICY_SECONDS"), 10),
                           .spin_seconds = 100e-6,
                           .trace_end = UINT64_MAX,
                           .bind = 1};
}

int options_check(const duite_options *options)
{
    if (!options)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: no options; begin with duite_options_default()");
    if (options->comm == MPI_COMM_NULL)
        return base_error(DUITE_E_ARGUMENT, "duite_start: the communicator is MPI_COMM_NULL");
    return DUITE_OK;
}

int options_check_rest(const duite_options *options)
{
    const duite_scheduler *s = options->scheduler;
    if (!options->kernels)
        return base_error(DUITE_E_ARGUMENT, "duite_start: no list of kernels");
    if (!s || !s->name || !s->place || !s->serve || !s->victim || !s->chain)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: no scheduler, or one without all its functions");
    if (!options->mapping || !options->mapping->name || !options->mapping->map)
        return base_error(DUITE_E_ARGUMENT, "duite_start: no mapping");
    const duite_balancer *b = options->balance;
    if (!b || !b->name || !b->victim != !b->give)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: no balancer, or one with only one of victim and give");
    if (options->threads > 4096)
        return base_error(DUITE_E_ARGUMENT, "duite_start: %u threads are more than 4096",
                          options->threads);
    if (options->check < 0)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: DUITE_CHECK has no such mode; there is \"accesses\"");
    if (!(options->spin_seconds >= 0))
        return base_error(DUITE_E_ARGUMENT, "duite_start: spin_seconds is not >= 0");
    if (!(options->stuck_seconds >= 0 && options->stuck_seconds <= 1e9))
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: stuck_seconds (or DUITE_STUCK_SECONDS) is not a number "
                          "from 0 to 1e9");
    if (!(options->lost_seconds >= 0 && options->lost_seconds <= 1e9))
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: lost_seconds (or DUITE_LOST_SECONDS) is not a number "
                          "from 0 to 1e9");
    if (!(options->policy_seconds >= 0 && options->policy_seconds <= 1e9))
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: policy_seconds (or DUITE_POLICY_SECONDS) is not a number "
                          "from 0 to 1e9");
    if (options->trace && options->trace_first > options->trace_end)
        return base_error(DUITE_E_ARGUMENT, "duite_start: trace_first is after trace_end");
    return DUITE_OK;
}
