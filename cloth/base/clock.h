#ifndef CLOTH_BASE_CLOCK_H
#define CLOTH_BASE_CLOCK_H

#include <time.h>

/* Seconds of a clock that only runs forward. Local. */
static inline double cloth_seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

#endif
