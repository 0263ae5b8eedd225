/* A library's policy is found by its symbol, so that a file cannot be taken for one of another
 * kind. A loaded library is never unloaded: a policy may be in use as long as the process lives. */
#include "runtime/base/policy.h"

#include "runtime/base/error.h"

#include <config.h>
#include <dlfcn.h>
#include <pthread.h>
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
    return policy && !base_policy_fits(policies, policy, file) ? policy : NULL;
}

int base_policy_fits(const struct base_policies *policies, const void *table, const char *what)
{
    size_t size;
    memcpy(&size, table, sizeof size);
    if (size == policies->size)
        return DUITE_OK;
    return base_error(DUITE_E_ARGUMENT,
                      "%s: the table of the %s has %zu bytes (its size), and that of this library "
                      "%zu: .size = sizeof(%s), compiled with the duite_policy.h of version %s, is "
                      "expected",
                      what, policies->kind, size, policies->size, policies->type, PACKAGE_VERSION);
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

/* ---- Marks ---- */

struct base_marks {
    const char *policy[BASE_POLICY_KINDS];
    int rank;
    struct base_mark *mark; /* by worker */
};

static const char *const kinds[] = {
    [BASE_SCHEDULER] = "scheduler", [BASE_MAPPING] = "mapping", [BASE_BALANCER] = "balancer"};

#define MARK_FUNCTION(kind, call, name) [BASE_##kind##_##call] = {BASE_##kind, name},
static const struct {
    enum base_policy_kind kind;
    const char *name;
} functions[BASE_POLICY_CALLS] = {BASE_POLICY_FUNCTIONS(MARK_FUNCTION)};

/* The mark of the function that this thread is in, for the end of the process. */
static _Thread_local const struct base_mark *entered;

void base_mark_enter(struct base_mark *mark, enum base_policy_call call)
{
    const uint64_t before = atomic_load_explicit(&mark->inside, memory_order_relaxed);
    atomic_store_explicit(&mark->inside, before + 256 + (uint64_t)call, memory_order_relaxed);
    entered = mark;
}

void base_mark_leave(struct base_mark *mark)
{
    const uint64_t inside = atomic_load_explicit(&mark->inside, memory_order_relaxed);
    atomic_store_explicit(&mark->inside, inside & ~(uint64_t)255, memory_order_relaxed);
    entered = NULL;
}

bool base_mark_name(const struct base_marks *marks, unsigned worker, uint64_t inside,
                    struct base_named *named)
{
    const enum base_policy_call call = (enum base_policy_call)(inside % 256);
    if (!marks || call == BASE_NO_CALL || base_mark_inside(marks, worker) != inside)
        return false;
    *named = (struct base_named){kinds[functions[call].kind], marks->policy[functions[call].kind],
                                 functions[call].name};
    return true;
}

uint64_t base_mark_inside(const struct base_marks *marks, unsigned worker)
{
    return marks ? atomic_load_explicit(&marks->mark[worker].inside, memory_order_relaxed) : 0;
}

/* The thread that exits may do so in a call. */
static void mark_on_exit(void)
{
    struct base_named named;
    if (!entered)
        return;
    const struct base_marks *marks = entered->of;
    const unsigned worker = (unsigned)(entered - marks->mark);
    if (!base_mark_name(marks, worker, base_mark_inside(marks, worker), &named))
        return;
    fprintf(stderr,
            "duite: %s %.200s: its %s called exit (rank %d, worker %u); this process ends with "
            "status %d\n",
            named.kind, named.policy, named.function, marks->rank, worker, EXIT_FAILURE);
    fflush(NULL);
    _exit(EXIT_FAILURE);
}

static void mark_watch_exits(void)
{
    atexit(mark_on_exit); /* if it cannot, an exit passes as before */
}

int base_marks_start(struct base_marks **out, const char *const policy[BASE_POLICY_KINDS],
                     unsigned n, int rank)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    struct base_marks *marks = *out = base_alloc_zero(sizeof *marks);
    if (!marks || !(marks->mark = base_alloc_zero(n * sizeof *marks->mark)))
        return base_no_memory("the marks of policies");
    marks->rank = rank;
    for (int kind = 0; kind < BASE_POLICY_KINDS; kind++)
        marks->policy[kind] = policy[kind];
    for (unsigned i = 0; i < n; i++)
        marks->mark[i].of = marks;
    pthread_once(&once, mark_watch_exits);
    return DUITE_OK;
}

void base_marks_stop(struct base_marks *marks)
{
    if (marks)
        base_free(marks->mark);
    base_free(marks);
}

struct base_mark *base_mark_of(struct base_marks *marks, enum base_policy_kind kind,
                               unsigned worker)
{
    return marks && marks->policy[kind] ? &marks->mark[worker] : NULL;
}
