#ifndef CLOTH_PHYSICS_VEC_H
#define CLOTH_PHYSICS_VEC_H

#include <stdint.h>

/* Vectors of the state are rows of four doubles, x y z 0, aligned to 32 bytes: one AVX register,
 * two of SSE2 or NEON. The fourth lane of every vector of the state is zero. The compiler lowers
 * the type to what the processor has; lanes are independent, so the bits are the same everywhere.
 * Helpers are always inlined: no vector is passed by value. */
typedef double phys_vec __attribute__((vector_size(32)));

/* Before a function whose loops carry the run: compiled twice, with and without AVX2, and chosen
 * when the program starts. The bits are the same, since fused multiply-adds stay off. GCC only:
 * calls from other files do not find what clang 14 makes of it. Not with sanitizers, which are not
 * yet there when the choice is made. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__AVX2__) &&      \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define PHYS_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define PHYS_CLONES
#endif

#define PHYS_INLINE static inline __attribute__((always_inline, unused))

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

#endif
