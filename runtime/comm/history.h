#ifndef DUITE_COMM_HISTORY_H
#define DUITE_COMM_HISTORY_H

#include <stdatomic.h>
#include <stdint.h>

/* The main program's last calls, in a ring, with the fingerprint after each. All ranks make the
 * same calls, so the ring names the first call in which two ranks differ. */

enum { COMM_HISTORY_CALLS = 1024 };

/* A call in the history: its kind, for a fork its kernel, and the forks of the main program up to
 * it. */
enum comm_call_kind {
    COMM_FORKED,   /* a kernel */
    COMM_RECORDED, /* a kernel, while a graph is recorded */
    COMM_CALLED    /* a function: enum comm_function */
};

/* The functions: ROW(value, name). The first one stands for all others. */
#define COMM_FUNCTIONS(ROW)                                                                        \
    ROW(OTHER, "a function of duite")                                                              \
    ROW(NEW, "duite_new")                                                                          \
    ROW(NEW_SIZED, "duite_new_sized")                                                              \
    ROW(HINT, "duite_hint")                                                                        \
    ROW(COLOCATE, "duite_colocate")                                                                \
    ROW(ADOPT, "duite_adopt")                                                                      \
    ROW(SET, "duite_set")                                                                          \
    ROW(SET_AT, "duite_set_at")                                                                    \
    ROW(FREE, "duite_free")                                                                        \
    ROW(GRAPH_BIND, "duite_graph_bind")                                                            \
    ROW(GRAPH_FREE, "duite_graph_free")                                                            \
    ROW(REPLAY, "duite_replay")                                                                    \
    ROW(REPLAY_WHILE, "duite_replay_while")                                                        \
    ROW(GET, "duite_get")                                                                          \
    ROW(GET_AT, "duite_get_at")                                                                    \
    ROW(GET_COUNT, "duite_get_count")                                                              \
    ROW(GET_BEGIN, "duite_get_begin")                                                              \
    ROW(GET_END, "duite_get_end")                                                                  \
    ROW(WAIT_FOR, "duite_wait_for")                                                                \
    ROW(TEST, "duite_test")                                                                        \
    ROW(KERNEL_ADD, "duite_kernel_add")                                                            \
    ROW(WAIT, "duite_wait")                                                                        \
    ROW(STOP, "duite_stop")                                                                        \
    ROW(ACQUIRE, "duite_acquire")                                                                  \
    ROW(COUNT_ALL, "duite_count_all")
#define COMM_FUNCTION_VALUE(value, name) COMM_CALLED_##value,
enum comm_function { COMM_FUNCTIONS(COMM_FUNCTION_VALUE) COMM_N_CALLED };

/* 2 bits of kind, 22 of kernel or function, 40 of forks: no program has so many of either. */
static inline uint64_t comm_call_bits(enum comm_call_kind kind, uint32_t which, uint64_t forks)
{
    return ((uint64_t)kind << 22 | which) << 40 | forks;
}
static inline enum comm_call_kind comm_call_kind(uint64_t call)
{
    return (enum comm_call_kind)(call >> 62);
}
static inline uint32_t comm_call_which(uint64_t call)
{
    return (uint32_t)(call >> 40 & 0x3fffff);
}
static inline uint64_t comm_call_forks(uint64_t call)
{
    return call & 0xffffffffff;
}

/* The function of that name, and back. */
enum comm_function comm_function_find(const char *name);
const char *comm_function_name(uint32_t called);

/* Written by the main thread: an entry of the ring, and then `calls`. */
struct comm_history {
    _Atomic uint64_t calls; /* so far; the first one is 1 */
    struct comm_history_entry {
        _Atomic uint64_t fingerprint; /* of all calls up to this one */
        _Atomic uint64_t call;        /* comm_call_bits */
    } entry[COMM_HISTORY_CALLS];      /* by number of the call */
};

/* Stores with release: a reader that sees one of them sees in `calls` that the ring came so far. */
static inline void comm_history_add(struct comm_history *history, uint64_t fingerprint,
                                    uint64_t call)
{
    const uint64_t n = atomic_load_explicit(&history->calls, memory_order_relaxed) + 1;
    struct comm_history_entry *entry = &history->entry[n % COMM_HISTORY_CALLS];
    atomic_store_explicit(&entry->fingerprint, fingerprint, memory_order_release);
    atomic_store_explicit(&entry->call, call, memory_order_release);
    atomic_store_explicit(&history->calls, n, memory_order_release);
}

/* The calls first .. last as they were at some moment; call n lies in [n % COMM_HISTORY_CALLS]. */
struct comm_history_copy {
    uint64_t first, last;
    struct {
        uint64_t fingerprint, call;
    } entry[COMM_HISTORY_CALLS];
};

/* Any thread, while the main thread goes on. */
void comm_history_read(struct comm_history *history, struct comm_history_copy *copy);

#endif
