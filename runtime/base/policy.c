/* A library's policy is found by its symbol, so that a file cannot be taken for one of another
 * kind. What was loaded is never unloaded: a policy may be in use as long as the process lives. */
#include "runtime/base/policy.h"

#include "runtime/base/error.h"
#include "runtime/base/report.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Policies by name ---- */

static const void *policy_load(const struct base_policies *policies, const char *file)
{
    void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    const void *policy = library ? dlsym(library, policies->symbol) : NULL;
    if (!library)
        base_error(DUITE_E_ARGUMENT, "the %s cannot be loaded: %s", policies->kind, dlerror());
    else if (!policy)
        base_error(DUITE_E_ARGUMENT, "the library defines no %s (duite_policy.h)",
                   policies->symbol);
    return policy;
}

struct policy_names {
    char text[256];
};

static struct policy_names policy_join(const char *const *names)
{
    struct policy_names list = {""};
    size_t length = 0;
    for (size_t i = 0; names[i] && length < sizeof list.text; i++)
        length += (size_t)snprintf(list.text + length, sizeof list.text - length, "%s%s",
                                   i ? ", " : "", names[i]);
    return list;
}

static void policy_refuse(const struct base_policies *policies)
{
    const struct policy_names tests = policy_join(base_policy_test_names(policies));
    base_error(DUITE_E_ARGUMENT,
               "there is no %s of this name; known are %s%s%s, and shared libraries by a name with "
               "a / in it",
               policies->kind, policy_join(policies->names).text,
               tests.text[0] ? ", for tests " : "", tests.text);
}

const char *const *base_policy_test_names(const struct base_policies *policies)
{
    const char *const *names = policies->names;
    while (*names)
        names++;
    return names + 1;
}

/* Built in, by name or by table, whichever is not NULL; else NULL. */
static const void *policy_built_in(const struct base_policies *policies, const char *name,
                                   const void *table)
{
    unsigned parts = 0;
    for (size_t i = 0; parts < 2; i++)
        if (!policies->names[i])
            parts++;
        else if (name ? !strcmp(policies->names[i], name) : policies->tables[i] == table)
            return policies->tables[i];
    return NULL;
}

const void *base_policy_find(const struct base_policies *policies, const char *name)
{
    const void *found = name ? policy_built_in(policies, name, NULL) : NULL;
    if (found)
        return found;
    if (name && strchr(name, '/'))
        return policy_load(policies, name);
    policy_refuse(policies);
    return NULL;
}

bool base_policy_is_ours(const struct base_policies *policies, const void *table)
{
    return policy_built_in(policies, NULL, table) != NULL;
}

/* ---- The watchdog ---- */

/* A mark is written by its worker alone, with relaxed stores: the watchdog orders nothing by it. It
 * has the number of the call, so that two looks at a function that is called all the time are not
 * taken for one call that stands. The watchdogs of a process stand in a list, for the function that
 * runs when it exits. */

enum { LOOKS = 16, WHERE = 64 }; /* LOOKS: in `seconds`, until a call is reported */

struct base_watchdog {
    struct base_monitor *monitor;
    struct base_look look;
    const char *policy[BASE_POLICY_KINDS];
    double seconds;
    int rank;
    unsigned n;
    struct base_mark *mark;     /* n of them */
    struct base_watchdog *next; /* of all in this process */
};

static const char *const kinds[] = {
    [BASE_SCHEDULER] = "scheduler", [BASE_MAPPING] = "mapping", [BASE_BALANCER] = "balancer"};

static const struct {
    enum base_policy_kind kind;
    const char *name;
} functions[BASE_POLICY_CALLS] = {
    [BASE_SCHEDULER_START] = {BASE_SCHEDULER, "start"},
    [BASE_SCHEDULER_PLACE] = {BASE_SCHEDULER, "place"},
    [BASE_SCHEDULER_SERVE] = {BASE_SCHEDULER, "serve"},
    [BASE_SCHEDULER_VICTIM] = {BASE_SCHEDULER, "victim"},
    [BASE_SCHEDULER_CHAIN] = {BASE_SCHEDULER, "chain"},
    [BASE_SCHEDULER_LOCATE] = {BASE_SCHEDULER, "locate"},
    [BASE_MAPPING_MAP] = {BASE_MAPPING, "map"},
    [BASE_MAPPING_MAP_TASKS] = {BASE_MAPPING, "map_tasks"},
    [BASE_BALANCER_START] = {BASE_BALANCER, "start"},
    [BASE_BALANCER_VICTIM] = {BASE_BALANCER, "victim"},
    [BASE_BALANCER_GRANT] = {BASE_BALANCER, "grant"},
    [BASE_BALANCER_PLACE] = {BASE_BALANCER, "place"},
    [BASE_BALANCER_MIGRATE] = {BASE_BALANCER, "migrate"},
};

/* " (rank 1, worker 2)", or nothing where there are no ranks. */
static const char *watchdog_where(const struct base_watchdog *watchdog, unsigned worker,
                                  char text[WHERE])
{
    text[0] = 0;
    if (watchdog->rank >= 0)
        snprintf(text, WHERE, " (rank %d, worker %u)", watchdog->rank, worker);
    return text;
}

/* ---- The looks of the watchdog ---- */

static void watchdog_report(const struct base_watchdog *watchdog, unsigned worker)
{
    const struct base_mark *mark = &watchdog->mark[worker];
    const enum base_policy_call call = (enum base_policy_call)(mark->seen % 256);
    char text[WHERE], report[WHERE + 400];
    snprintf(report, sizeof report,
             "duite: %s %.200s: its %s has not returned for %g s%s; the run goes on when it does\n",
             kinds[functions[call].kind], watchdog->policy[functions[call].kind],
             functions[call].name, watchdog->seconds * (double)mark->looks / LOOKS,
             watchdog_where(watchdog, worker, text));
    base_report(report);
}

static void watchdog_look_at(const struct base_watchdog *watchdog, unsigned worker)
{
    struct base_mark *mark = &watchdog->mark[worker];
    const uint64_t inside = atomic_load_explicit(&mark->inside, memory_order_relaxed);
    if (inside != mark->seen || inside % 256 == BASE_NO_CALL) {
        mark->seen = inside;
        mark->looks = 0;
        mark->next = LOOKS;
    } else if (++mark->looks == mark->next) {
        mark->next *= 2;
        watchdog_report(watchdog, worker);
    }
}

static bool watchdog_look(void *context)
{
    const struct base_watchdog *watchdog = context;
    for (unsigned i = 0; i < watchdog->n; i++)
        watchdog_look_at(watchdog, i);
    return true;
}

/* ---- Policies that exit ---- */

static pthread_mutex_t listing = PTHREAD_MUTEX_INITIALIZER;
static struct base_watchdog *watchdogs; /* under the lock above */

/* The call of a policy that the calling thread is in, and which worker that is; or BASE_NO_CALL. */
static enum base_policy_call watchdog_find_call(const struct base_watchdog *watchdog,
                                                unsigned *worker)
{
    for (unsigned i = 0; i < watchdog->n; i++) {
        const struct base_mark *mark = &watchdog->mark[i];
        const uint64_t inside = atomic_load_explicit(&mark->inside, memory_order_relaxed);
        const pthread_t thread = atomic_load_explicit(&mark->thread, memory_order_relaxed);
        *worker = i;
        if (inside % 256 != BASE_NO_CALL && pthread_equal(thread, pthread_self()))
            return (enum base_policy_call)(inside % 256);
    }
    return BASE_NO_CALL;
}

/* The thread that exits may do so in a call. */
static void watchdog_on_exit(void)
{
    enum base_policy_call call = BASE_NO_CALL;
    unsigned worker = 0;
    char text[WHERE];
    pthread_mutex_lock(&listing);
    const struct base_watchdog *watchdog = watchdogs;
    while (watchdog && !(call = watchdog_find_call(watchdog, &worker)))
        watchdog = watchdog->next;
    pthread_mutex_unlock(&listing);
    if (!call)
        return;
    fprintf(stderr, "duite: %s %.200s: its %s called exit%s; this process ends with status %d\n",
            kinds[functions[call].kind], watchdog->policy[functions[call].kind],
            functions[call].name, watchdog_where(watchdog, worker, text), EXIT_FAILURE);
    fflush(NULL);
    _exit(EXIT_FAILURE);
}

struct base_mark *base_watchdog_mark_here(enum base_policy_kind kind)
{
    struct base_mark *mark = NULL;
    pthread_mutex_lock(&listing);
    for (const struct base_watchdog *watchdog = watchdogs; watchdog && !mark;
         watchdog = watchdog->next)
        for (unsigned i = 0; i < watchdog->n && watchdog->policy[kind] && !mark; i++)
            if (pthread_equal(atomic_load_explicit(&watchdog->mark[i].thread, memory_order_relaxed),
                              pthread_self()))
                mark = &watchdog->mark[i];
    pthread_mutex_unlock(&listing);
    return mark;
}

static void watchdog_watch_exits(void)
{
    atexit(watchdog_on_exit); /* if it cannot, an exit passes as before */
}

static void watchdog_enlist(struct base_watchdog *watchdog)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, watchdog_watch_exits);
    pthread_mutex_lock(&listing);
    watchdog->next = watchdogs;
    watchdogs = watchdog;
    pthread_mutex_unlock(&listing);
}

static void watchdog_delist(const struct base_watchdog *watchdog)
{
    pthread_mutex_lock(&listing);
    struct base_watchdog **at = &watchdogs;
    while (*at && *at != watchdog)
        at = &(*at)->next;
    if (*at)
        *at = watchdog->next;
    pthread_mutex_unlock(&listing);
}

/* ---- The watchdog starts and stops ---- */

int base_watchdog_start(struct base_watchdog **out, struct base_monitor *monitor,
                        const char *const policy[BASE_POLICY_KINDS], double seconds, unsigned n,
                        int rank)
{
    struct base_watchdog *watchdog = *out = base_alloc_zero(sizeof *watchdog);
    if (!watchdog)
        return base_no_memory("the watchdog of policies");
    watchdog->monitor = monitor;
    watchdog->seconds = seconds;
    watchdog->rank = rank;
    watchdog->mark = base_alloc_zero(n * sizeof *watchdog->mark);
    if (!watchdog->mark)
        return base_no_memory("the watchdog of policies");
    watchdog->n = n;
    for (int kind = 0; kind < BASE_POLICY_KINDS; kind++)
        watchdog->policy[kind] = policy[kind];
    for (unsigned i = 0; i < n; i++)
        base_watchdog_here(watchdog, i);
    watchdog_enlist(watchdog);
    watchdog->look =
        (struct base_look){.look = watchdog_look, .context = watchdog, .seconds = seconds / LOOKS};
    return base_monitor_add(monitor, &watchdog->look);
}

void base_watchdog_stop(struct base_watchdog *watchdog)
{
    if (!watchdog)
        return;
    base_monitor_remove(watchdog->monitor, &watchdog->look);
    watchdog_delist(watchdog);
    base_free(watchdog->mark);
    base_free(watchdog);
}

struct base_mark *base_watchdog_mark(struct base_watchdog *watchdog, enum base_policy_kind kind,
                                     unsigned worker)
{
    return watchdog && watchdog->policy[kind] ? &watchdog->mark[worker] : NULL;
}

void base_watchdog_here(struct base_watchdog *watchdog, unsigned worker)
{
    if (watchdog)
        atomic_store_explicit(&watchdog->mark[worker].thread, pthread_self(), memory_order_relaxed);
}
