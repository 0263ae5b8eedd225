#ifndef DUITE_BASE_GUARD_H
#define DUITE_BASE_GUARD_H

#include "runtime/base/lookout.h"

#include <setjmp.h>
#include <stdatomic.h>
#include <stdint.h>

/* Calls of functions that may never return: those of policies that are not ours. A thread that
 * makes such calls is a caller, and marks where they begin and end. A lookout reads the marks; a
 * call that stands through sixteen looks in a row is left: its thread gets a signal (SIGURG, which
 * is handled for that moment only), and the handler jumps back to where the call was made. So no
 * thread is lost, and nobody waits for ever; what the function held is lost. From then on the guard
 * is over: no such function is called any more, and who asks decides without it. Time is counted in
 * looks, so that the time in which this process itself was stopped is nobody's. A function that
 * calls exit is named, too, and the process then ends with EXIT_FAILURE, whatever it asked for.
 *
 *     if (sigsetjmp(caller->back, 0) || !base_guard_enters(caller, &PLACE, policy->name))
 *         return what_is_always_right;
 *     answer = policy->place(...);
 *     base_guard_leaves(caller);
 */
enum { BASE_GUARD_LOOKS = 16 };

/* A function of policies: "scheduler", "place". A constant. */
struct base_guarded {
    const char *kind, *function;
};

struct base_guard;

struct base_caller {
    sigjmp_buf back; /* where its call was made */
    struct base_guard *guard;
    _Atomic(const struct base_guarded *) inside; /* what it calls; NULL: nothing */
    _Atomic(const char *) policy;                /* whose */
    _Atomic uint64_t calls;                      /* so far */
    /* Of the lookout: */
    _Atomic uint64_t left; /* the call that is to be left */
    uint64_t seen;         /* calls at the last look */
    unsigned stands;       /* looks in a row */
    pthread_t thread;
};

struct base_guard {
    _Atomic int over;
    double seconds;
    int rank;
    unsigned n;
    struct base_caller *caller; /* n of them */
    struct base_lookout lookout;
    bool blocked; /* the signal, in the thread that started the guard */
    bool deaf;    /* a thread that takes no signals was told of */
    char sentence[400];
    struct base_guard *next; /* of all in this process */
    pthread_mutex_t lock;    /* of the next two */
    void (*tell)(void *context, const char *sentence);
    void *context;
};

/* *guard for n callers, of whom the calling thread is the first. seconds > 0; rank: for the
 * sentence, -1: none. Errors: memory, DUITE_E_SYSTEM. */
int base_guard_start(struct base_guard **guard, double seconds, unsigned n, int rank);
/* No other caller calls any more. By the thread that started it. NULL is fine. */
void base_guard_stop(struct base_guard *guard);

/* Caller i; of no guard NULL. */
struct base_caller *base_guard_caller(struct base_guard *guard, unsigned i);
/* It is the calling thread from now on, which no longer blocks the signal. NULL is fine. */
void base_guard_here(struct base_caller *caller);

/* From now on somebody is told when the guard is over, once, by the thread that looks; at once, if
 * it is; NULL: nobody is any more. */
void base_guard_tell(struct base_guard *guard, void (*tell)(void *context, const char *sentence),
                     void *context);

/* DUITE_E_ARGUMENT with the sentence once the guard is over. NULL is fine. */
int base_guard_code(const struct base_guard *guard);

/* The call begins, in the frame of its sigsetjmp; false: the guard is over, it must not. The names
 * live as long as the guard. */
static inline bool base_guard_enters(struct base_caller *caller, const struct base_guarded *what,
                                     const char *policy)
{
    if (atomic_load_explicit(&caller->guard->over, memory_order_relaxed))
        return false;
    const uint64_t calls = atomic_load_explicit(&caller->calls, memory_order_relaxed);
    atomic_store_explicit(&caller->calls, calls + 1, memory_order_relaxed);
    atomic_store_explicit(&caller->policy, policy, memory_order_relaxed);
    atomic_store_explicit(&caller->inside, what, memory_order_release);
    atomic_signal_fence(memory_order_seq_cst); /* against the handler, on this thread */
    return true;
}

/* It is over. */
static inline void base_guard_leaves(struct base_caller *caller)
{
    atomic_signal_fence(memory_order_seq_cst);
    atomic_store_explicit(&caller->inside, NULL, memory_order_relaxed);
}

#endif
