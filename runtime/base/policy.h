#ifndef DUITE_BASE_POLICY_H
#define DUITE_BASE_POLICY_H

#include "runtime/base/memory.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Schedulers, mappings and balancers alike are found by name, and watched unless they are built
 * in. */

/* ---- Policies by name ---- */

/* Bytes of private state that a policy may want for each worker. */
#define BASE_MAX_STATE ((size_t)1 << 30)

/* The policies of one kind. The built-in ones stand twice, in the same order: those for programs,
 * NULL, those for tests, NULL. The latter are adversaries: found by name, but in no list of all. */
struct base_policies {
    const char *kind, *type; /* "scheduler", "duite_scheduler" */
    const char *symbol;      /* what a shared library calls its own */
    size_t size;             /* bytes of a table, which begins with this number */
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

/* Refuses a table of another size, as of a policy for another version of duite_policy.h; what: the
 * call or file. Local. Errors: DUITE_E_ARGUMENT. */
int base_policy_fits(const struct base_policies *policies, const void *table, const char *what);

/* True if the table is one of the built-in ones, those for tests among them. */
bool base_policy_is_ours(const struct base_policies *policies, const void *table);

/* ---- Marks ---- */

/* Policies that are not built in may loop or sleep for ever, or end the process. Every worker has a
 * mark, which says which function of such a policy it is in. The standstill report names a function
 * that does not return. To break it off would leave the policy's locks and memory, and the heap, in
 * any state.
 *
 * A policy that calls exit is named, too, and the process then ends with EXIT_FAILURE, whatever it
 * asked for: it must not pass for a program that ended. */

enum base_policy_kind { BASE_SCHEDULER, BASE_MAPPING, BASE_BALANCER, BASE_POLICY_KINDS };

/* The functions: ROW(kind, value, name). At most 255. */
#define BASE_POLICY_FUNCTIONS(ROW)                                                                 \
    ROW(SCHEDULER, START, "start")                                                                 \
    ROW(SCHEDULER, PLACE, "place")                                                                 \
    ROW(SCHEDULER, SERVE, "serve")                                                                 \
    ROW(SCHEDULER, VICTIM, "victim")                                                               \
    ROW(SCHEDULER, CHAIN, "chain")                                                                 \
    ROW(SCHEDULER, LOCATE, "locate")                                                               \
    ROW(MAPPING, MAP, "map")                                                                       \
    ROW(MAPPING, MAP_TASKS, "map_tasks")                                                           \
    ROW(BALANCER, START, "start")                                                                  \
    ROW(BALANCER, VICTIM, "victim")                                                                \
    ROW(BALANCER, GRANT, "grant")                                                                  \
    ROW(BALANCER, PLACE, "place")                                                                  \
    ROW(BALANCER, MIGRATE, "migrate")
#define BASE_POLICY_CALL(kind, call, name) BASE_##kind##_##call,
enum base_policy_call { BASE_NO_CALL, BASE_POLICY_FUNCTIONS(BASE_POLICY_CALL) BASE_POLICY_CALLS };

struct base_marks;

/* A worker's mark. Only that worker writes `inside`, with relaxed stores: readers order nothing by
 * it. */
struct base_mark {
    _Alignas(BASE_LINE) _Atomic uint64_t inside; /* 256 times how many calls so far, and which of
                                                    base_policy_call it is in */
    const struct base_marks *of;
};

/* policy: the names of those that are not built in, by kind; NULL: it is built in, or there is
 * none. n workers of this rank. base_marks_stop is due all the same. Errors: memory. */
int base_marks_start(struct base_marks **marks, const char *const policy[BASE_POLICY_KINDS],
                     unsigned n, int rank);
/* No worker makes a mark any more. NULL is fine. */
void base_marks_stop(struct base_marks *marks);

/* The mark that this worker sets around calls of its policy of this kind. NULL: the policy is built
 * in, or there are no marks. */
struct base_mark *base_mark_of(struct base_marks *marks, enum base_policy_kind kind,
                               unsigned worker);

/* The worker's `inside`: it is in a function unless this is a multiple of 256. 0: no marks. */
uint64_t base_mark_inside(const struct base_marks *marks, unsigned worker);

struct base_named {
    const char *kind, *policy, *function; /* "scheduler", its name, "place" */
};
/* Names the function that the worker is in; false unless it is in one since `inside` was read. */
bool base_mark_name(const struct base_marks *marks, unsigned worker, uint64_t inside,
                    struct base_named *named);

void base_mark_enter(struct base_mark *mark, enum base_policy_call call);
void base_mark_leave(struct base_mark *mark);

/* A call begins; a call is over. They do nothing with a NULL mark. */
static inline void base_mark_begin(struct base_mark *mark, enum base_policy_call call)
{
    if (__builtin_expect(mark != NULL, 0))
        base_mark_enter(mark, call);
}

static inline void base_mark_end(struct base_mark *mark)
{
    if (__builtin_expect(mark != NULL, 0))
        base_mark_leave(mark);
}

#endif
