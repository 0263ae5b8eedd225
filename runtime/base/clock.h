#ifndef DUITE_BASE_CLOCK_H
#define DUITE_BASE_CLOCK_H

#include <time.h>

/* Seconds since some fixed moment of this host; never goes back. */
static inline double base_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
