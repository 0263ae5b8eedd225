#ifndef TESTS_RUNTIME_REPEATED_H
#define TESTS_RUNTIME_REPEATED_H

#include <duite.h>
#include <stdatomic.h>

/* Shared by the tests of repeated forks: a program of some numbers, whose values are worked out
 * beside it, one task after the other. Its functions assert that calls succeed. */

enum { OBJECTS = 8, ROUNDS = 60, ALWAYS = 2 };

struct repeated_argument {
    uint32_t number;
    int32_t fails;
    char padding[56];
};

struct repeated {
    duite *rt;
    duite_object object[OBJECTS];
    uint32_t value[OBJECTS]; /* as it should be */
    uint32_t forks;
};

/* Kernels: MIX and its TWIN mix their argument and what they read into a number; PUT overwrites
 * one; HOLD changes a number, and LOOK reads one, and nothing comes of it; ASK holds a number by
 * rp, waits for it in its body, and copies it. MIX fails with its argument's code, or if it is told
 * of a round. */
extern const duite_kernel MIX, TWIN, PUT, HOLD, LOOK, ASK;

extern atomic_int repeated_over;    /* bodies of MIX and TWIN, since the start */
extern atomic_int repeated_held;    /* not 0: HOLD waits */
extern atomic_int repeated_held_at; /* the number of the MIX that waits; 0: none */

/* A number after MIX. */
uint32_t repeated_mixed(uint32_t to, uint32_t from, uint32_t number);

/* Two threads, the kernels, and options.memo. */
duite_options repeated_options(int memo);

struct repeated repeated_start(const duite_options *options);
/* Forks MIX or TWIN, which fails unless `fails` is 0. */
void repeated_fork(struct repeated *program, const duite_kernel *kernel, int to, int from,
                   int fails);
/* One MIX for each number. */
void repeated_round(struct repeated *program);
void repeated_expect(struct repeated *program, int i);
/* Waits; tasks that were recognised so far. */
uint64_t repeated_recognised(struct repeated *program);
/* Compares all values. Returns the tasks that were recognised. */
uint64_t repeated_stop(struct repeated *program);

#endif
