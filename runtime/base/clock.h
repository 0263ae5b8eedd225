#ifndef DUITE_BASE_CLOCK_H
#define DUITE_BASE_CLOCK_H

#include <stdint.h>
#include <time.h>

/* Seconds since a fixed moment of this host; never goes back. Any thread. */
static inline double base_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A counter of constant rate that is cheaper to read, for times taken with every task: the
 * processor's, if it has one. Differences between cores are far below a microsecond. */
static inline uint64_t base_ticks(void)
{
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#elif defined(__aarch64__)
    uint64_t ticks;
    __asm__ volatile("mrs %0, cntvct_el0" : "=r"(ticks));
    return ticks;
#else
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000 + (uint64_t)now.tv_nsec;
#endif
}

/* Seconds of one tick, within 1e-4 of it. The first call takes a fraction of a millisecond. */
double base_tick_seconds(void);

#endif
