/* A caller's mark is written by its thread alone, and by the handler on it. The handler runs on the
 * thread that it is about, so it sees the mark as the thread left it: it jumps only out of the very
 * call that was found standing, and never out of anything of ours. One thread at a time is taken
 * out of a call, in the whole process. The guards there are stand in a list, for the function that
 * runs when the process exits: a policy that calls exit must not pass for a program that ended. */
#include "runtime/base/guard.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { SIGNAL = SIGURG, MOST_PAUSES = 100, WHERE = 64 };

static pthread_mutex_t taking = PTHREAD_MUTEX_INITIALIZER;
static _Atomic(struct base_caller *) wanted; /* under the lock above */

static bool is_in(const struct base_caller *caller, uint64_t call)
{
    return atomic_load(&caller->inside) && atomic_load(&caller->calls) == call;
}

static void jump_back(int number)
{
    struct base_caller *caller = atomic_load(&wanted);
    (void)number;
    if (!caller || !pthread_equal(caller->thread, pthread_self()) ||
        !is_in(caller, atomic_load(&caller->left)))
        return;
    atomic_store(&caller->inside, NULL);
    siglongjmp(caller->back, 1);
}

/* Takes the thread out of the call; false: it does not take the signal. */
static bool take_out(struct base_caller *caller)
{
    /* Not blocked in the handler, which does not return. */
    struct sigaction ours = {.sa_handler = jump_back, .sa_flags = SA_NODEFER | SA_RESTART}, before;
    const struct timespec pause = {.tv_nsec = 1000000};
    const uint64_t call = caller->seen;
    sigemptyset(&ours.sa_mask);
    pthread_mutex_lock(&taking);
    atomic_store(&caller->left, call);
    atomic_store(&wanted, caller);
    bool sent = !sigaction(SIGNAL, &ours, &before) && !pthread_kill(caller->thread, SIGNAL);
    for (int i = 0; sent && i < MOST_PAUSES && is_in(caller, call); i++)
        nanosleep(&pause, NULL);
    sigaction(SIGNAL, &before, NULL);
    atomic_store(&wanted, NULL);
    pthread_mutex_unlock(&taking);
    return !is_in(caller, call);
}

/* " (rank 1, worker 2)", or nothing where there are no ranks. */
static const char *where(const struct base_guard *guard, const struct base_caller *caller,
                         char text[WHERE])
{
    text[0] = 0;
    if (guard->rank >= 0)
        snprintf(text, WHERE, " (rank %d, worker %u)", guard->rank,
                 (unsigned)(caller - guard->caller));
    return text;
}

/* ---- Exits ---- */

static pthread_mutex_t listing = PTHREAD_MUTEX_INITIALIZER;
static struct base_guard *guards; /* under the lock above */

static const struct base_caller *inside_of(const struct base_guard *guard)
{
    for (unsigned i = 0; i < guard->n; i++)
        if (atomic_load(&guard->caller[i].inside) &&
            pthread_equal(guard->caller[i].thread, pthread_self()))
            return &guard->caller[i];
    return NULL;
}

/* The thread that exits does so in a call. */
static void on_exit_of_policy(void)
{
    const struct base_caller *caller = NULL;
    char text[WHERE];
    pthread_mutex_lock(&listing);
    for (const struct base_guard *guard = guards; guard && !caller; guard = guard->next)
        caller = inside_of(guard);
    pthread_mutex_unlock(&listing);
    if (!caller)
        return;
    const struct base_guarded *what = atomic_load(&caller->inside);
    fprintf(stderr, "duite: %s %.200s: its %s called exit%s; this process ends with status %d\n",
            what->kind, atomic_load(&caller->policy), what->function,
            where(caller->guard, caller, text), EXIT_FAILURE);
    fflush(NULL);
    _exit(EXIT_FAILURE);
}

static void watch_exits(void)
{
    atexit(on_exit_of_policy); /* if it cannot, an exit passes as before */
}

static void enlist(struct base_guard *guard)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, watch_exits);
    pthread_mutex_lock(&listing);
    guard->next = guards;
    guards = guard;
    pthread_mutex_unlock(&listing);
}

static void delist(const struct base_guard *guard)
{
    pthread_mutex_lock(&listing);
    struct base_guard **at = &guards;
    while (*at && *at != guard)
        at = &(*at)->next;
    if (*at)
        *at = guard->next;
    pthread_mutex_unlock(&listing);
}

/* ---- Looks ---- */

static void tell(struct base_guard *guard)
{
    pthread_mutex_lock(&guard->lock);
    atomic_store(&guard->over, 1);
    if (guard->tell)
        guard->tell(guard->context, guard->sentence);
    pthread_mutex_unlock(&guard->lock);
}

static void write_sentence(struct base_guard *guard, const struct base_caller *caller,
                           const struct base_guarded *what)
{
    char text[WHERE];
    snprintf(guard->sentence, sizeof guard->sentence,
             "%s %.200s: its %s did not return for %g s%s; a policy that needs longer is given it "
             "by policy_seconds, or DUITE_POLICY_SECONDS in the environment",
             what->kind, atomic_load(&caller->policy), what->function, guard->seconds,
             where(guard, caller, text));
}

/* Its call stands. */
static void leave(struct base_guard *guard, struct base_caller *caller)
{
    const struct base_guarded *what = atomic_load(&caller->inside);
    caller->stands = 0;
    if (!what)
        return;
    if (!atomic_load(&guard->over)) {
        write_sentence(guard, caller, what);
        tell(guard);
    }
    if (take_out(caller) || guard->deaf)
        return;
    guard->deaf = true;
    fprintf(stderr, "duite: %s; nor can it be left, as it takes no signals\n", guard->sentence);
}

static void look(void *context)
{
    struct base_guard *guard = context;
    for (unsigned i = 0; i < guard->n; i++) {
        struct base_caller *caller = &guard->caller[i];
        const uint64_t calls = atomic_load(&caller->calls);
        const bool same = calls == caller->seen && atomic_load(&caller->inside);
        caller->stands = same ? caller->stands + 1 : 0;
        caller->seen = calls;
        if (caller->stands >= BASE_GUARD_LOOKS)
            leave(guard, caller);
    }
}

/* ---- Start and stop ---- */

int base_guard_start(struct base_guard **out, double seconds, unsigned n, int rank)
{
    struct base_guard *guard = *out = base_alloc_zero(sizeof *guard);
    sigset_t before;
    if (!guard)
        return base_no_memory("the guard of policies");
    pthread_mutex_init(&guard->lock, NULL);
    guard->seconds = seconds;
    guard->rank = rank;
    guard->n = n;
    guard->caller = base_alloc_zero(n * sizeof *guard->caller);
    if (!guard->caller)
        return base_no_memory("the guard of policies");
    for (unsigned i = 0; i < n; i++)
        guard->caller[i].guard = guard;
    pthread_sigmask(SIG_BLOCK, NULL, &before);
    guard->blocked = sigismember(&before, SIGNAL) == 1;
    base_guard_here(&guard->caller[0]);
    enlist(guard);
    return base_lookout_start(&guard->lookout, "the guard of policies", seconds / BASE_GUARD_LOOKS,
                              look, guard);
}

static void mask(int how)
{
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, SIGNAL);
    pthread_sigmask(how, &only, NULL);
}

void base_guard_stop(struct base_guard *guard)
{
    if (!guard)
        return;
    base_lookout_stop(&guard->lookout);
    delist(guard);
    if (guard->blocked)
        mask(SIG_BLOCK);
    pthread_mutex_destroy(&guard->lock);
    base_free(guard->caller);
    base_free(guard);
}

struct base_caller *base_guard_caller(struct base_guard *guard, unsigned i)
{
    return guard ? &guard->caller[i] : NULL;
}

void base_guard_here(struct base_caller *caller)
{
    if (!caller)
        return;
    caller->thread = pthread_self();
    mask(SIG_UNBLOCK);
}

void base_guard_tell(struct base_guard *guard, void (*to)(void *, const char *), void *context)
{
    pthread_mutex_lock(&guard->lock);
    guard->tell = to;
    guard->context = context;
    if (to && atomic_load(&guard->over))
        to(context, guard->sentence);
    pthread_mutex_unlock(&guard->lock);
}

int base_guard_code(const struct base_guard *guard)
{
    if (!guard || !atomic_load(&guard->over))
        return DUITE_OK;
    return base_error(DUITE_E_ARGUMENT, "%s", guard->sentence);
}
