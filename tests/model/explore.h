#ifndef TESTS_MODEL_EXPLORE_H
#define TESTS_MODEL_EXPLORE_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Runs the real code of a few threads in every order that can make a difference, one execution
 * after another from the start. The threads are coroutines; at each atomic operation and each call
 * that may block, the explorer decides who goes on.
 *
 * Explored: all interleavings, and stores that stay behind. An atomic store that is not
 * sequentially consistent goes to a buffer of its thread first; it may get to memory at any later
 * moment, after later stores to other places too, but not before its own place's earlier stores
 * and, with memory_order_release, not before any earlier store. A fence or a sequentially
 * consistent or releasing read-modify-write waits until the buffer is empty. So a missing fence
 * (announce, then look) and a missing release are found.
 *
 * Not explored: loads never run early, so a missing acquire is not found; a read-modify-write
 * writes at once; weak compare-and-exchange fails for a reason only; mutexes and conditions order
 * as on x86, and conditions do not wake for nothing. Plain data are no business of the explorer
 * (ThreadSanitizer's). */

enum { EXPLORE_THREADS = 6 };

/* One operation of the code, by where it stands, done otherwise: a planted bug. */
enum explore_change {
    EXPLORE_NOTHING,
    EXPLORE_DROP,   /* it does not happen; a load reads 0, a compare-and-exchange fails */
    EXPLORE_RELAX,  /* memory_order_relaxed; an exchange is a store, a compare-and-exchange does not
                      compare */
    EXPLORE_REORDER /* memory_order_relaxed and no more: the operation stays what it is */
};

struct explore_plant {
    const char *function, *what; /* what: the operation's object as it is written, or "fence" */
    enum explore_change change;
};

/* A small program. start runs before the threads, end after them: neither is explored, and they may
 * call the code under test. */
struct explore_case {
    const char *name;
    void (*start)(void);
    void (*thread[EXPLORE_THREADS])(void); /* up to the first NULL */
    void (*end)(void);
    bool served;       /* all is well once the first thread is over; others may sleep for ever */
    bool every;        /* all orders, without reduction */
    unsigned timeouts; /* times that timed waits of the first thread may run out; others' last for
                          ever, but  a thread in one will go on */
    uint64_t max;      /* executions; 0: all there are */
    uint64_t max_deep; /* the same with --deep */
};

/* Prints one line of TAP: that no execution of the case goes wrong, or that with the plant one
 * does. A failure comes with its schedule. */
void explore_passes(const struct explore_case *small);
/* Runs a case without a word; returns what went wrong, or NULL. */
const char *explore_run(const struct explore_case *small);
/* One line of TAP of the test's own. */
void explore_line(bool fine, const char *name, const char *text);
bool explore_deep(void);
void explore_finds(const struct explore_case *small, struct explore_plant plant);
/* The options --deep, --show (the schedules that the plants lead to), and the names of cases to run
 * alone. */
void explore_begin(int argc, char **argv);
/* The plan; returns the exit status. */
int explore_end(void);

/* For the cases: what must be true; the execution ends where it is not. */
#define explore_check(condition) explore_check_that(condition, #condition)
void explore_check_that(bool fine, const char *what);
/* True if the plant is this one: for changes of other kinds, which the test makes itself. */
bool explore_planted(const char *function, const char *what);
/* Memory of this execution, zeroed, aligned to 64 bytes. */
void *explore_alloc(size_t size);
/* Sleeps until *flag, an atomic int, is set once. */
#define explore_await(flag) explore_await_change(EXPLORE_PLACE(flag), 0)

/* ---- For tests/model/atomics.h: the operations ---- */

struct explore_place {
    const char *function, *what;
    void *address;
    unsigned size;
};

#define EXPLORE_PLACE(object)                                                                      \
    ((struct explore_place){__func__, #object, (void *)(object), (unsigned)sizeof *(object)})

uint64_t explore_load(struct explore_place place, memory_order order);
void explore_store(struct explore_place place, uint64_t value, memory_order order);
uint64_t explore_exchange(struct explore_place place, uint64_t value, memory_order order);
uint64_t explore_add(struct explore_place place, uint64_t value, memory_order order);
/* *expected gets what was there. */
bool explore_compare(struct explore_place place, uint64_t *expected, uint64_t value,
                     memory_order order);
void explore_fence(const char *function, memory_order order);
void explore_await_change(struct explore_place place, uint64_t from);

/* A mutex and a condition keep one counter each where the real ones lie. */
int explore_clear(void *object);
int explore_lock(const char *function, pthread_mutex_t *mutex);
int explore_unlock(const char *function, pthread_mutex_t *mutex);
int explore_wait(const char *function, pthread_cond_t *condition, pthread_mutex_t *mutex,
                 bool timed);
int explore_signal(const char *function, pthread_cond_t *condition);
int explore_create(const char *function, pthread_t *thread, void *(*body)(void *), void *argument);
int explore_join(const char *function, pthread_t thread);
pthread_t explore_self(void);

#endif
