#ifndef CLOTH_PHYSICS_VEC_H
#define CLOTH_PHYSICS_VEC_H

#include "cloth/base/simd.h"

#include <stddef.h>
#include <stdint.h>

/* Vectors of the state are rows of four doubles, x y z 0, aligned to 32 bytes: one AVX register,
 * two of SSE2 or NEON. The fourth lane of every vector of the state is zero. The compiler lowers
 * the type to the processor's vectors; lanes are independent, so the bits are the same everywhere.
 * Helpers are always inlined: no vector is passed by value. */
typedef double phys_vec __attribute__((vector_size(32), aligned(32)));

/* Three numbers as a vector. */
#define PHYS_VEC(x) ((phys_vec){(x)[0], (x)[1], (x)[2], 0})

#define PHYS_INLINE static inline __attribute__((always_inline, unused))

/* Before a loop over lanes, components or corners, so that its values stay in registers: GCC at -O2
 * leaves it a loop. */
#if defined(__clang__)
#define PHYS_UNROLL
#else
#define PHYS_UNROLL _Pragma("GCC unroll 8")
#endif

/* Prefetches an address so many bytes further on, which may be behind the end. */
PHYS_INLINE void phys_fetch(const void *from, size_t bytes, int to_write)
{
    const uintptr_t address = (uintptr_t)from + bytes;
    if (to_write)
        __builtin_prefetch((const void *)address, 1);
    else
        __builtin_prefetch((const void *)address, 0);
}
enum { PHYS_FETCH = 1024 }; /* bytes ahead of a loop: enough for memory to answer */

/* Heads of functions whose loops carry the run, in place of
 *
 *     void name(params)            and      type name(params)
 *
 * They are compiled several times and chosen by the processor (cloth/base/simd.h); once where
 * PHYS_ONCE is defined, as for sanitizers. args: the names of the parameters, in order. The bits
 * are the same, since fused multiply-adds stay off. Functions that they call must be PHYS_INLINE,
 * or are compiled once only. */
#if defined(__x86_64__) && !defined(__AVX512VL__) && !defined(PHYS_ONCE)
#define PHYS_AVX2 __attribute__((target("avx2")))
#if defined(__clang__)
#define PHYS_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq")))
#else /* else GCC 12 keeps addresses in vector registers, for a fifth more time on AMD's Zen 5 */
#define PHYS_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,tune=skylake-avx512")))
#endif
#define PHYS_KERNEL(name, params, args)                                                            \
    PHYS_INLINE void name##_body params;                                                           \
    PHYS_AVX2 static void name##_avx2 params                                                       \
    {                                                                                              \
        name##_body args;                                                                          \
    }                                                                                              \
    PHYS_AVX512 static void name##_avx512 params                                                   \
    {                                                                                              \
        name##_body args;                                                                          \
    }                                                                                              \
    void name params                                                                               \
    {                                                                                              \
        if (cloth_simd == CLOTH_SIMD_AVX512)                                                       \
            name##_avx512 args;                                                                    \
        else if (cloth_simd == CLOTH_SIMD_AVX2)                                                    \
            name##_avx2 args;                                                                      \
        else                                                                                       \
            name##_body args;                                                                      \
    }                                                                                              \
    PHYS_INLINE void name##_body params
#define PHYS_KERNEL_OF(type, name, params, args)                                                   \
    PHYS_INLINE type name##_body params;                                                           \
    PHYS_AVX2 static type name##_avx2 params                                                       \
    {                                                                                              \
        return name##_body args;                                                                   \
    }                                                                                              \
    PHYS_AVX512 static type name##_avx512 params                                                   \
    {                                                                                              \
        return name##_body args;                                                                   \
    }                                                                                              \
    type name params                                                                               \
    {                                                                                              \
        if (cloth_simd == CLOTH_SIMD_AVX512)                                                       \
            return name##_avx512 args;                                                             \
        return cloth_simd == CLOTH_SIMD_AVX2 ? name##_avx2 args : name##_body args;                \
    }                                                                                              \
    PHYS_INLINE type name##_body params
#else
#define PHYS_KERNEL(name, params, args)          void name params
#define PHYS_KERNEL_OF(type, name, params, args) type name params
#endif

/* Sum of all four lanes, (0 + 2) + (1 + 3): the order that two-lane registers add in. */
PHYS_INLINE double phys_lanes(const phys_vec *a)
{
    return ((*a)[0] + (*a)[2]) + ((*a)[1] + (*a)[3]);
}

/* The same sum in each lane, to the same bits. */
PHYS_INLINE void phys_lanes_each(const phys_vec *a, phys_vec *sum)
{
#if defined(__clang__)
    const phys_vec pair = *a + __builtin_shufflevector(*a, *a, 2, 3, 0, 1);
    *sum = pair + __builtin_shufflevector(pair, pair, 1, 0, 3, 2);
#else
    typedef int64_t order __attribute__((vector_size(32)));
    const phys_vec pair = *a + __builtin_shuffle(*a, (order){2, 3, 0, 1});
    *sum = pair + __builtin_shuffle(pair, (order){1, 0, 3, 2});
#endif
}

PHYS_INLINE double phys_dot(const phys_vec *a, const phys_vec *b)
{
    const phys_vec product = *a * *b;
    return phys_lanes(&product);
}

/* y = a x b, which may be a or b. */
PHYS_INLINE void phys_cross(const phys_vec *a, const phys_vec *b, phys_vec *y)
{
    const phys_vec u = *a, v = *b;
    *y = (phys_vec){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0],
                    0};
}

#endif
