#ifndef TESTS_SUPPORT_RANDOM_H
#define TESTS_SUPPORT_RANDOM_H

#include <stdint.h>

/* Random numbers of a test program, the same in each run and on each machine (Knuth's 64-bit linear
 * congruential generator, its upper 53 bits). A test that sets random_seed has its own. */

static uint64_t random_seed = 1;

static inline double uniform(double low, double high)
{
    random_seed = random_seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_seed >> 11) * 0x1p-53;
}

#endif
