#ifndef CLOTH_PHYSICS_TINY_H
#define CLOTH_PHYSICS_TINY_H

#include <stdint.h>

/* Numbers too small for a full mantissa (subnormal: below 2.2e-308) cost processors a hundred times
 * the work of others. A solve is full of them far from any motion, since values fade by a factor
 * from row to row. Between phys_tiny_off and phys_tiny_back the calling thread takes them for zero
 * and makes none, in scalars and vectors of any width alike. Put a call between the two: compilers
 * move arithmetic across the switch. Processors without the switch change nothing. */
typedef uint64_t phys_tiny;

#if defined(__x86_64__)

static inline phys_tiny phys_tiny_off(void)
{
    const uint32_t flush_to_zero = 0x8000, denormals_are_zero = 0x40;
    const uint32_t before = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(before | flush_to_zero | denormals_are_zero);
    return before;
}

static inline void phys_tiny_back(phys_tiny before)
{
    __builtin_ia32_ldmxcsr((uint32_t)before);
}

#elif defined(__aarch64__)

static inline phys_tiny phys_tiny_off(void)
{
    const uint64_t flush_to_zero = (uint64_t)1 << 24;
    uint64_t before;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before));
    __asm__ volatile("msr fpcr, %0" : : "r"(before | flush_to_zero) : "memory");
    return before;
}

static inline void phys_tiny_back(phys_tiny before)
{
    __asm__ volatile("msr fpcr, %0" : : "r"(before) : "memory");
}

#else

static inline phys_tiny phys_tiny_off(void)
{
    return 0;
}

static inline void phys_tiny_back(phys_tiny before)
{
    (void)before;
}

#endif

#endif
