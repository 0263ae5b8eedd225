#ifndef DUITE_BASE_POLICY_H
#define DUITE_BASE_POLICY_H

#include "runtime/base/memory.h"
#include "runtime/base/monitor.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What schedulers, mappings and balancers have in common: they are found by name, and those that
 * are not built in are watched. */

/* ---- Policies by name ---- */

/* Bytes of private state that a policy may want for each worker. */
#define BASE_MAX_STATE ((size_t)1 << 30)

/* The policies of one kind. The built-in ones stand twice, in the same order: those for programs,
 * NULL, those for tests, NULL. The latter are adversaries: found by name, but in no list of all. */
struct base_policies {
    const char *kind;   /* "scheduler" */
    const char *symbol; /* what a shared library calls its own */
    const char *const *names;
    const void *const *tables;
};

/* The names of a list of rows, each of which is ROW(name). */
#define BASE_POLICY_NAME(name) #name,

/* The built-in policy of that name; or, if there is a / in it, that of the shared library in the
 * file, which stays loaded. NULL, and a message for duite_message, if there is none. Local. */
const void *base_policy_find(const struct base_policies *policies, const char *name);

/* The names of those for tests, ended by NULL. */
const char *const *base_policy_test_names(const struct base_policies *policies);

/* Whether the table is one of the built-in ones, those for tests among them. */
bool base_policy_is_ours(const struct base_policies *policies, const void *table);

/* ---- The watchdog ---- */

/* The watchdog names policies that do not return: a scheduler, mapping or balancer that is not
 * built in may loop or sleep for ever. Every worker has a mark, which says which function of such a
 * policy it is in. The monitor looks at the marks sixteen times in `seconds`. A call that stood
 * through sixteen looks is named on standard error, with policy, function, rank and worker, and
 * again after twice as many, four times as many, and so on. Nothing else happens: the call goes on.
 * To break it off would leave the policy's locks and memory, and the heap, in any state. Time is
 * counted in looks, so that the time in which the process itself was stopped does not count.
 *
 * A policy that calls exit is named, too, and the process then ends with EXIT_FAILURE, whatever it
 * asked for: it must not pass for a program that ended. */

enum base_policy_kind { BASE_SCHEDULER, BASE_MAPPING, BASE_BALANCER, BASE_POLICY_KINDS };

enum base_policy_call {
    BASE_NO_CALL,
    BASE_SCHEDULER_START,
    BASE_SCHEDULER_PLACE,
    BASE_SCHEDULER_SERVE,
    BASE_SCHEDULER_VICTIM,
    BASE_SCHEDULER_CHAIN,
    BASE_SCHEDULER_LOCATE,
    BASE_MAPPING_MAP,
    BASE_MAPPING_MAP_TASKS,
    BASE_BALANCER_START,
    BASE_BALANCER_VICTIM,
    BASE_BALANCER_GRANT,
    BASE_BALANCER_PLACE,
    BASE_BALANCER_MIGRATE,
    BASE_POLICY_CALLS /* at most 256 */
};

/* Of one worker, who alone writes `inside`. */
struct base_mark {
    _Alignas(BASE_LINE) _Atomic uint64_t inside; /* 256 times how many calls so far, and which of
                                                    base_policy_call it is in */
    _Atomic pthread_t thread;
    /* The watchdog's: */
    uint64_t seen;        /* `inside` at the last look */
    uint64_t looks, next; /* how many saw this call; at how many it is reported next */
};

struct base_watchdog;

/* policy: the names of those that are not built in, by kind; NULL: it is built in, or there is
 * none. seconds > 0; n workers, of which the calling thread is all so far; rank: for the message;
 * -1: there are no ranks. base_watchdog_stop is due all the same. Errors: memory, DUITE_E_SYSTEM.
 */
int base_watchdog_start(struct base_watchdog **watchdog, struct base_monitor *monitor,
                        const char *const policy[BASE_POLICY_KINDS], double seconds, unsigned n,
                        int rank);
/* No worker makes a mark any more. By the thread that started it. NULL is fine. */
void base_watchdog_stop(struct base_watchdog *watchdog);

/* The mark that this worker sets around calls of its policy of this kind. NULL: the policy is built
 * in, or the watchdog is NULL. */
struct base_mark *base_watchdog_mark(struct base_watchdog *watchdog, enum base_policy_kind kind,
                                     unsigned worker);

/* The same for the worker that the calling thread is, for those who do not know it: a search. NULL
 * also if the thread is none. */
struct base_mark *base_watchdog_mark_here(enum base_policy_kind kind);

/* The calling thread is this worker from now on. NULL is fine. */
void base_watchdog_here(struct base_watchdog *watchdog, unsigned worker);

/* A call begins; a call is over. Of a NULL mark they do nothing. */
static inline void base_mark_begin(struct base_mark *mark, enum base_policy_call call)
{
    if (__builtin_expect(!mark, 1))
        return;
    const uint64_t before = atomic_load_explicit(&mark->inside, memory_order_relaxed);
    atomic_store_explicit(&mark->inside, before + 256 + (uint64_t)call, memory_order_relaxed);
}

static inline void base_mark_end(struct base_mark *mark)
{
    if (__builtin_expect(!mark, 1))
        return;
    const uint64_t inside = atomic_load_explicit(&mark->inside, memory_order_relaxed);
    atomic_store_explicit(&mark->inside, inside & ~(uint64_t)255, memory_order_relaxed);
}

#endif
