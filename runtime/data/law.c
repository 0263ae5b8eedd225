/* A law is pure: its result depends only on the given bytes, so the tree alone decides the bits of
 * a result. */
#include "runtime/data/law.h"

#include "runtime/base/error.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

const char *data_type_name(duite_type type)
{
    static const char *const names[] = {
        [DUITE_BYTE] = "bytes", [DUITE_I8] = "i8",   [DUITE_I16] = "i16", [DUITE_I32] = "i32",
        [DUITE_I64] = "i64",    [DUITE_U8] = "u8",   [DUITE_U16] = "u16", [DUITE_U32] = "u32",
        [DUITE_U64] = "u64",    [DUITE_F32] = "f32", [DUITE_F64] = "f64", [DUITE_CF32] = "cf32",
        [DUITE_CF64] = "cf64"};
    return names[type];
}

/* ---- The built-in laws ---- */

/* A law's function is a switch of cases. In its expressions l and r are the elements of type T,
 * u(l) and u(r) the same as unsigned 64-bit numbers, whose arithmetic wraps around, and low and
 * high the ends of T. */
#define LAW_CASE(type, T_, LOW, HIGH, result)                                                      \
    case type: {                                                                                   \
        typedef T_ T;                                                                              \
        T *const lefts = left;                                                                     \
        const T *const rights = right;                                                             \
        for (size_t i = 0; i < count; i++) {                                                       \
            const T l = lefts[i], r = rights[i];                                                   \
            lefts[i] = (T)(result);                                                                \
        }                                                                                          \
        break;                                                                                     \
    }
#define LAW_FILL(type, T_, LOW, HIGH, value)                                                       \
    case type: {                                                                                   \
        typedef T_ T;                                                                              \
        const T low = LOW, high = HIGH;                                                            \
        for (size_t i = 0; i < count; i++)                                                         \
            ((T *)left)[i] = (T)(value);                                                           \
        (void)low, (void)high;                                                                     \
        break;                                                                                     \
    }
#define LAW_INTEGERS(CASE, result)                                                                 \
    CASE(DUITE_I8, int8_t, INT8_MIN, INT8_MAX, result)                                             \
    CASE(DUITE_I16, int16_t, INT16_MIN, INT16_MAX, result)                                         \
    CASE(DUITE_I32, int32_t, INT32_MIN, INT32_MAX, result)                                         \
    CASE(DUITE_I64, int64_t, INT64_MIN, INT64_MAX, result)                                         \
    CASE(DUITE_U8, uint8_t, 0, UINT8_MAX, result)                                                  \
    CASE(DUITE_U16, uint16_t, 0, UINT16_MAX, result)                                               \
    CASE(DUITE_U32, uint32_t, 0, UINT32_MAX, result)                                               \
    CASE(DUITE_U64, uint64_t, 0, UINT64_MAX, result)
#define LAW_REALS(CASE, result)                                                                    \
    CASE(DUITE_F32, float, -HUGE_VALF, HUGE_VALF, result)                                          \
    CASE(DUITE_F64, double, -HUGE_VAL, HUGE_VAL, result)
#define LAW_COMPLEX(CASE, result)                                                                  \
    CASE(DUITE_CF32, float complex, 0, 0, result)                                                  \
    CASE(DUITE_CF64, double complex, 0, 0, result)
#define u(x) ((uint64_t)(x))

#define LAW_COMBINES(name, cases)                                                                  \
    static void name(void *left, const void *right, size_t count, duite_type type)                 \
    {                                                                                              \
        switch (type) {                                                                            \
            cases default : break;                                                                 \
        }                                                                                          \
    }
LAW_COMBINES(law_add, LAW_INTEGERS(LAW_CASE, u(l) + u(r)) LAW_REALS(LAW_CASE, l + r)
                          LAW_COMPLEX(LAW_CASE, l + r))
LAW_COMBINES(law_multiply, LAW_INTEGERS(LAW_CASE, u(l) * u(r)) LAW_REALS(LAW_CASE, l *r)
                               LAW_COMPLEX(LAW_CASE, l *r))
/* The left one stays unless the right one is smaller (larger), or not a number. */
LAW_COMBINES(law_lesser,
             LAW_INTEGERS(LAW_CASE, r < l ? r : l) LAW_REALS(LAW_CASE, r < l || r != r ? r : l))
LAW_COMBINES(law_greater,
             LAW_INTEGERS(LAW_CASE, r > l ? r : l) LAW_REALS(LAW_CASE, r > l || r != r ? r : l))
LAW_COMBINES(law_bits_and, LAW_INTEGERS(LAW_CASE, l &r))
LAW_COMBINES(law_bits_or, LAW_INTEGERS(LAW_CASE, l | r))
LAW_COMBINES(law_bits_xor, LAW_INTEGERS(LAW_CASE, l ^ r))
LAW_COMBINES(law_all, LAW_INTEGERS(LAW_CASE, l &&r))
LAW_COMBINES(law_any, LAW_INTEGERS(LAW_CASE, l || r))

#define LAW_FILLS(name, cases)                                                                     \
    static void name(void *left, size_t count, duite_type type)                                    \
    {                                                                                              \
        switch (type) {                                                                            \
            cases default : break;                                                                 \
        }                                                                                          \
    }
LAW_FILLS(law_fill_ones, LAW_INTEGERS(LAW_FILL, 1) LAW_REALS(LAW_FILL, 1) LAW_COMPLEX(LAW_FILL, 1))
LAW_FILLS(law_fill_largest, LAW_INTEGERS(LAW_FILL, high) LAW_REALS(LAW_FILL, high))
LAW_FILLS(law_fill_smallest, LAW_INTEGERS(LAW_FILL, low) LAW_REALS(LAW_FILL, low))
LAW_FILLS(law_fill_bits, LAW_INTEGERS(LAW_FILL, UINT64_MAX))

const duite_law duite_sum = {.name = "sum", .combine = law_add};
const duite_law duite_product = {
    .name = "product", .neutral = law_fill_ones, .combine = law_multiply};
const duite_law duite_min = {.name = "min", .neutral = law_fill_largest, .combine = law_lesser};
const duite_law duite_max = {.name = "max", .neutral = law_fill_smallest, .combine = law_greater};
const duite_law duite_bits_and = {
    .name = "bits_and", .neutral = law_fill_bits, .combine = law_bits_and};
const duite_law duite_bits_or = {.name = "bits_or", .combine = law_bits_or};
const duite_law duite_bits_xor = {.name = "bits_xor", .combine = law_bits_xor};
const duite_law duite_all = {.name = "all", .neutral = law_fill_ones, .combine = law_all};
const duite_law duite_any = {.name = "any", .combine = law_any};

static const duite_law *const built_in[] = {
    &duite_sum,     &duite_product,  &duite_min, &duite_max, &duite_bits_and,
    &duite_bits_or, &duite_bits_xor, &duite_all, &duite_any, NULL};

/* The numbers that a law of type 0 is for. */
enum law_domain { LAW_NUMBERS, LAW_REALS, LAW_INTEGERS };

static enum law_domain law_domain_of(const duite_law *law)
{
    if (law == &duite_min || law == &duite_max)
        return LAW_REALS;
    return law == &duite_bits_and || law == &duite_bits_or || law == &duite_bits_xor ||
                   law == &duite_all || law == &duite_any
               ? LAW_INTEGERS
               : LAW_NUMBERS;
}

const char *data_law_types(const duite_law *law)
{
    static const char *const domains[] = {"numbers", "real numbers", "integers"};
    return law->type ? data_type_name(law->type) : domains[law_domain_of(law)];
}

bool data_law_fits(const duite_law *law, duite_type type)
{
    const bool is_complex = type == DUITE_CF32 || type == DUITE_CF64;
    const bool is_real = type == DUITE_F32 || type == DUITE_F64;
    if (law->type || type == DUITE_BYTE)
        return law->type == type;
    switch (law_domain_of(law)) {
    case LAW_REALS:
        return !is_complex;
    case LAW_INTEGERS:
        return !is_complex && !is_real;
    default:
        return true;
    }
}

const duite_law *duite_law_find(const char *name)
{
    for (const duite_law *const *law = built_in; *law; law++)
        if (name && !strcmp((*law)->name, name))
            return *law;
    base_error(DUITE_E_LAW, "duite_law_find: no built-in law is named %s", name ? name : "NULL");
    return NULL;
}

/* ---- The laws of a program ---- */

static bool law_is_listed(const duite_law *const *laws, const duite_law *law)
{
    while (laws && *laws && *laws != law)
        laws++;
    return laws && *laws;
}

static int law_check_unique(const duite_law *const *laws, const duite_law *law)
{
    for (; *laws; laws++)
        if (*laws != law && (*laws)->name && !strcmp((*laws)->name, law->name))
            return base_error(DUITE_E_LAW, "two laws have the name %s", law->name);
    return DUITE_OK;
}

int data_laws_check(const duite_law *const *laws)
{
    int code = DUITE_OK;
    for (size_t i = 0; laws && laws[i] && !code; i++) {
        const duite_law *law = laws[i];
        if (law_is_listed(built_in, law))
            continue;
        if (!law->name || !law->name[0])
            return base_error(DUITE_E_LAW, "law %zu of the list has no name", i);
        if (!law->combine)
            return base_error(DUITE_E_LAW, "law %s has no function that combines", law->name);
        if ((int)law->type < 0 || law->type > DUITE_CF64)
            return base_error(DUITE_E_LAW, "law %s: %d is no element type", law->name,
                              (int)law->type);
        code = law_check_unique(laws, law);
        if (!code)
            code = law_check_unique(built_in, law);
    }
    return code;
}

int data_law_check_kernel(const duite_kernel *kernel, const duite_law *const *laws)
{
    const size_t n = data_modes_listed(kernel);
    for (size_t i = 0; i <= n; i++) {
        bool variadic = i == n;
        const duite_law *law = variadic ? kernel->variadic_law : data_law_named(kernel, i);
        duite_mode mode = variadic ? kernel->variadic : (duite_mode)kernel->access[i];
        bool known = law_is_listed(built_in, law) || law_is_listed(laws, law);
        if (!law || ((mode == DUITE_CW || mode == DUITE_CWP) && known))
            continue;
        char where[24] = "`variadic`";
        if (!variadic)
            snprintf(where, sizeof where, "parameter %zu", i);
        return base_error(DUITE_E_LAW, "kernel %s, %s: law %s %s", kernel->name, where,
                          law->name ? law->name : "without a name",
                          known ? "for a parameter that is not cw or cwp"
                                : "was not listed at start");
    }
    return DUITE_OK;
}

void data_law_neutral(const duite_law *law, void *values, size_t count, duite_type type)
{
    if (law->neutral)
        law->neutral(values, count, type);
    else
        memset(values, 0, count * data_type_size(type));
}

static uint64_t law_hash(const duite_law *law, uint64_t hash)
{
    if (!law)
        law = &duite_sum;
    hash = XXH64(law->name, strlen(law->name) + 1, hash);
    return XXH64(&law->type, sizeof law->type, hash);
}

uint64_t data_laws_hash(const duite_law *const *laws, uint64_t hash)
{
    for (; laws && *laws; laws++)
        hash = law_hash(*laws, hash);
    return hash;
}

uint64_t data_law_hash_kernel(const duite_kernel *kernel, uint64_t hash)
{
    const size_t n = data_modes_listed(kernel);
    for (size_t i = 0; i < n; i++)
        hash = law_hash(data_law_named(kernel, i), hash);
    return law_hash(kernel->variadic_law, hash);
}
