/* The options of a start: their defaults and checks. The environment is read with the defaults, so
 * the program's own settings override it. A wrong value there leaves a default that is refused
 * unless the program replaces it. */
#include "runtime/api/instance.h"

#include "runtime/balance/balance.h"
#include "runtime/base/error.h"
#include "runtime/base/policy.h"
#include "runtime/sched/sched.h"

#include <config.h>
#include <duite_policy.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Values that no program means: the environment's number makes no sense. */
static const unsigned NO_THREADS = UINT_MAX;
static const uint64_t NO_SEED = UINT64_MAX;

/* Returns the number in the environment, or -1 if the text is none. */
static double environment_seconds(const char *text, double otherwise)
{
    char *end;
    if (!text)
        return otherwise;
    double seconds = strtod(text, &end);
    return end == text || *end ? -1 : seconds;
}

/* Returns the whole number in the environment, or `wrong` if the text is none up to `max`. */
static uint64_t environment_number(const char *text, uint64_t otherwise, uint64_t max,
                                   uint64_t wrong)
{
    char *end;
    if (!text)
        return otherwise;
    if (*text < '0' || *text > '9')
        return wrong;
    errno = 0;
    const uint64_t number = strtoull(text, &end, 10);
    return *end || errno || number > max ? wrong : number;
}

static unsigned environment_threads(void)
{
    return (unsigned)environment_number(getenv("DUITE_THREADS"), 0, DUITE_MAX_THREADS, NO_THREADS);
}

static uint64_t environment_seed(void)
{
    return environment_number(getenv("DUITE_SEED"), 1, NO_SEED - 1, NO_SEED);
}

static int environment_memo(void)
{
    const char *text = getenv("DUITE_MEMO");
    if (!text || !strcmp(text, "1"))
        return 1;
    return !strcmp(text, "0") ? 0 : !strcmp(text, "always") ? 2 : -1;
}

static duite_options options_defaults(void)
{
    const char *scheduler = getenv("DUITE_SCHEDULER"), *mapping = getenv("DUITE_MAPPING"),
               *balance = getenv("DUITE_BALANCE");
    const char *check = getenv("DUITE_CHECK");
    return (duite_options){
        .size = sizeof(duite_options),
        .comm = MPI_COMM_WORLD,
        .check = !check                       ? 0
                 : !strcmp(check, "accesses") ? 1
                                              : -1,
        .memo = environment_memo(),
        .threads = environment_threads(),
        .scheduler = duite_scheduler_find(scheduler ? scheduler : duite_scheduler_names()[0]),
        .mapping = duite_mapping_find(mapping ? mapping : duite_mapping_names()[0]),
        .balance = duite_balancer_find(balance ? balance : duite_balancer_names()[0]),
        .seed = environment_seed(),
        .trace = getenv("DUITE_TRACE"),
        .report = getenv("DUITE_REPORT"),
        .stuck_seconds = environment_seconds(getenv("DUITE_STUCK_SECONDS"), 60),
        .lost_seconds = environment_seconds(getenv("DUITE_LOST_SECONDS"), 8),
        .spin_seconds = 100e-6,
        .trace_end = UINT64_MAX,
        .bind = 1};
}

/* ---- Sizes ---- */

/* Options as the first version had them: shorter ones have never been. */
static const size_t LEAST_OPTIONS = offsetof(duite_options, report) + sizeof(char *);

/* calls: the call that takes the options. */
static int options_check_size(const char *calls, size_t size)
{
    if (size < LEAST_OPTIONS)
        return base_error(DUITE_E_ARGUMENT,
                          "%s: options of %zu bytes (size) have never been; begin with "
                          "duite_options_default(), and change what is to differ",
                          calls, size);
    if (size > sizeof(duite_options))
        return base_error(
            DUITE_E_ARGUMENT,
            "%s: the program's duite.h has options of %zu bytes, and this library, "
            "version %d, knows %zu: a library at least as new as the header is needed",
            calls, size, duite_version(), sizeof(duite_options));
    return DUITE_OK;
}

int duite_version(void)
{
    return DUITE_VERSION;
}

int duite_options_set(duite_options *options, size_t size)
{
    duite_options whole = options_defaults();
    const int code = options_check_size("duite_options_set", size);
    if (!options)
        return base_error(DUITE_E_ARGUMENT, "duite_options_set: nowhere to put the options");
    whole.size = size;
    memset(options, 0, size);
    if (!code)
        memcpy(options, &whole, size);
    return code;
}

int duite_options_comm(duite_options *options, MPI_Fint comm)
{
    if (!options)
        return base_error(DUITE_E_ARGUMENT, "duite_options_comm: no options");
    options->comm = MPI_Comm_f2c(comm);
    return DUITE_OK;
}

int api_take_options(const duite_options *given, duite_options *whole)
{
    if (!given)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: no options; begin with duite_options_default()");
    const int code = options_check_size("duite_start", given->size);
    if (code)
        return code;
    if (given->size < sizeof *whole)
        *whole = options_defaults();
    memcpy(whole, given, given->size);
    if (whole->comm == (MPI_Comm)0) /* this handle ends the process in some MPIs */
        return base_error(
            DUITE_E_ARGUMENT,
            "duite_start: no communicator (comm); begin with duite_options_default(), "
            "and change what is to differ");
    if (whole->comm == MPI_COMM_NULL)
        return base_error(DUITE_E_ARGUMENT, "duite_start: the communicator is MPI_COMM_NULL");
    return DUITE_OK;
}

/* ---- Checks ---- */

static int options_state_too_large(const duite_scheduler *scheduler, const duite_balancer *balance)
{
    const bool schedules = scheduler->state_size > BASE_MAX_STATE;
    return base_error(DUITE_E_ARGUMENT,
                      "duite_start: the %s %s wants a state of %zu bytes for each worker "
                      "(state_size); at most %zu are granted",
                      schedules ? "scheduler" : "balancer",
                      schedules ? scheduler->name : balance->name,
                      schedules ? scheduler->state_size : balance->state_size, BASE_MAX_STATE);
}

/* The environment names a policy that cannot be found; the search has set the message. */
static int options_no_policy(const char *variable)
{
    char why[1024];
    snprintf(why, sizeof why, "%s", duite_message());
    return base_error(DUITE_E_ARGUMENT, "duite_start: %s=%s in the environment: %s", variable,
                      getenv(variable), why);
}

/* Checks the environment's choices that the program did not replace. */
static int options_check_environment(const duite_options *options)
{
    const char *scheduler = getenv("DUITE_SCHEDULER"), *mapping = getenv("DUITE_MAPPING"),
               *balance = getenv("DUITE_BALANCE");
    if (!options->scheduler && scheduler && !duite_scheduler_find(scheduler))
        return options_no_policy("DUITE_SCHEDULER");
    if (!options->mapping && mapping && !duite_mapping_find(mapping))
        return options_no_policy("DUITE_MAPPING");
    if (!options->balance && balance && !duite_balancer_find(balance))
        return options_no_policy("DUITE_BALANCE");
    if (getenv("DUITE_POLICY_SECONDS"))
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: DUITE_POLICY_SECONDS in the environment is not known any "
                          "more: DUITE_STUCK_SECONDS says when a policy that does not return is "
                          "named");
    if (options->threads == NO_THREADS && environment_threads() == NO_THREADS)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: DUITE_THREADS=%s in the environment: a whole number from 0 "
                          "to %d is expected; 0: the rank's share of the cores",
                          getenv("DUITE_THREADS"), DUITE_MAX_THREADS);
    if (options->seed == NO_SEED && environment_seed() == NO_SEED)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: DUITE_SEED=%s in the environment: a whole number from 0 to "
                          "%" PRIu64 " is expected",
                          getenv("DUITE_SEED"), NO_SEED - 1);
    return DUITE_OK;
}

static int options_check_policies(const duite_options *options)
{
    const duite_scheduler *s = options->scheduler;
    const duite_mapping *m = options->mapping;
    const duite_balancer *b = options->balance;
    if ((s && base_policy_fits(&sched_policies, s, "duite_start")) ||
        (m && base_policy_fits(&map_policies, m, "duite_start")) ||
        (b && base_policy_fits(&balance_policies, b, "duite_start")))
        return DUITE_E_ARGUMENT;
    if (!s || !s->name || !s->place || !s->serve || !s->victim || !s->chain)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: no scheduler, or one without all its functions");
    if (!m || !m->name || !m->map)
        return base_error(DUITE_E_ARGUMENT, "duite_start: no mapping");
    if (!b || !b->name || !b->victim != !b->grant)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: no balancer, or one with only one of victim and grant");
    if (s->state_size > BASE_MAX_STATE || b->state_size > BASE_MAX_STATE)
        return options_state_too_large(s, b);
    return DUITE_OK;
}

static int options_check_seconds(const duite_options *options)
{
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
    return DUITE_OK;
}

int api_check_options_rest(const duite_options *options)
{
    if (!options->kernels)
        return base_error(DUITE_E_ARGUMENT, "duite_start: no list of kernels");
    int code = options_check_environment(options);
    if (!code)
        code = options_check_policies(options);
    if (!code)
        code = options_check_seconds(options);
    if (code)
        return code;
    if (options->threads > DUITE_MAX_THREADS)
        return base_error(DUITE_E_ARGUMENT, "duite_start: %u threads are more than %d",
                          options->threads, DUITE_MAX_THREADS);
    if (options->check < 0)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: DUITE_CHECK has no such mode; there is \"accesses\"");
    if (options->memo < 0)
        return base_error(
            DUITE_E_ARGUMENT,
            "duite_start: DUITE_MEMO=%s in the environment: 0, 1 or always is expected",
            getenv("DUITE_MEMO") ? getenv("DUITE_MEMO") : "");
    if (options->trace && !*options->trace)
        return base_error(
            DUITE_E_ARGUMENT,
            "duite_start: trace (or DUITE_TRACE in the environment) is an empty name");
    if (options->report && !*options->report)
        return base_error(
            DUITE_E_ARGUMENT,
            "duite_start: report (or DUITE_REPORT in the environment) is an empty name");
    if (options->trace && options->trace_first > options->trace_end)
        return base_error(DUITE_E_ARGUMENT, "duite_start: trace_first is after trace_end");
    return DUITE_OK;
}

/* ---- Policies that are not built in ---- */

/* Such a policy may never return, or exit: it is named then. */
int api_mark_policies(duite *rt, const duite_options *options)
{
    const char *policy[BASE_POLICY_KINDS] = {NULL};
    if (!base_policy_is_ours(&sched_policies, options->scheduler))
        policy[BASE_SCHEDULER] = options->scheduler->name;
    if (!base_policy_is_ours(&map_policies, options->mapping))
        policy[BASE_MAPPING] = options->mapping->name;
    if (!base_policy_is_ours(&balance_policies, options->balance))
        policy[BASE_BALANCER] = options->balance->name;
    if (!(policy[BASE_SCHEDULER] || policy[BASE_MAPPING] || policy[BASE_BALANCER]))
        return DUITE_OK;
    const int code = base_marks_start(&rt->marks, policy, rt->share.workers, rt->graph.rank);
    if (!code)
        rt->mapping.mark = base_mark_of(rt->marks, BASE_MAPPING, 0);
    return code;
}
