#ifndef CLOTH_BASE_SIMD_H
#define CLOTH_BASE_SIMD_H

#include "cloth/base/error.h"

/* Vector instructions that the kernels use (cloth/physics/vec.h). The widest that it has are chosen
 * once, before main; results are the same with any. The variable DUITE_SIMD of the environment
 * forces one of those that the processor has: none, avx2 or avx512. */
enum cloth_simd { CLOTH_SIMD_NONE, CLOTH_SIMD_AVX2, CLOTH_SIMD_AVX512 };

/* Never changes after the start. */
extern enum cloth_simd cloth_simd;

/* "avx512", "avx2", or "none" (beyond those of every processor that the build was made for). */
const char *cloth_simd_name(void);

/* CLOTH_E_INPUT if DUITE_SIMD asks for an unknown or missing one. Local. */
int cloth_simd_check(struct cloth_error *error);

#endif
