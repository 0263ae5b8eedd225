/* The rate of the processor's counter (base_ticks) is measured once in a process, against the
 * system clock. */
#include "runtime/base/clock.h"

#include <pthread.h>

static double tick_seconds;

static void tick_measure(void)
{
    const double least = 5e-4;
    double start = base_seconds(), now = start;
    uint64_t first = base_ticks();
    while (now - start < least)
        now = base_seconds();
    tick_seconds = (now - start) / (double)(base_ticks() - first);
}

double base_tick_seconds(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, tick_measure);
    return tick_seconds;
}
