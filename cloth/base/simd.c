/* The choice is made when the program is loaded and only read from then on. */
#include "cloth/base/simd.h"

#include <stdlib.h>
#include <string.h>

enum cloth_simd cloth_simd;

static const char *const NAMES[] = {
    [CLOTH_SIMD_NONE] = "none", [CLOTH_SIMD_AVX2] = "avx2", [CLOTH_SIMD_AVX512] = "avx512"};
enum { N_NAMES = sizeof NAMES / sizeof *NAMES };

static enum cloth_simd widest(void)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq"))
        return CLOTH_SIMD_AVX512;
    if (__builtin_cpu_supports("avx2"))
        return CLOTH_SIMD_AVX2;
#endif
    return CLOTH_SIMD_NONE;
}

/* The value that DUITE_SIMD asks for; N_NAMES: an unknown one. */
static int simd_wanted(void)
{
    const char *name = getenv("DUITE_SIMD");
    int i = name && *name ? 0 : (int)widest();
    while (name && *name && i < N_NAMES && strcmp(name, NAMES[i]) != 0)
        i++;
    return i;
}

__attribute__((constructor)) static void choose(void)
{
    const enum cloth_simd max = widest();
    const int asked = simd_wanted();
    cloth_simd = asked <= (int)max ? (enum cloth_simd)asked : max;
}

const char *cloth_simd_name(void)
{
    return NAMES[cloth_simd];
}

int cloth_simd_check(struct cloth_error *error)
{
    const int asked = simd_wanted();
    if (asked == N_NAMES)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "DUITE_SIMD is '%s'; none, avx2 and avx512 are allowed",
                          getenv("DUITE_SIMD"));
    if (asked > (int)widest())
        return cloth_fail(error, CLOTH_E_INPUT,
                          "DUITE_SIMD asks for %s, which this processor lacks; it has %s",
                          NAMES[asked], NAMES[widest()]);
    return CLOTH_OK;
}
