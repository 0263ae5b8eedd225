/* A law is pure: its result depends only on the given bytes, so the tree alone decides the bits of
 * a result. */
#include "runtime/data/law.h"

#include "runtime/base/error.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

const char *data_type_name(duite_type type)
{
    static const char *const names[] = {"numbers", "bytes", "i32", "i64", "f32", "f64"};
    return names[type];
}

/* ---- The built-in laws ---- */

/* left[i] becomes `result` of l = left[i] and r = right[i]. */
#define EACH(T, result)                                                                            \
    do {                                                                                           \
        T *lefts = left;                                                                           \
        const T *rights = right;                                                                   \
        for (size_t i = 0; i < count; i++) {                                                       \
            const T l = lefts[i], r = rights[i];                                                   \
            lefts[i] = (result);                                                                   \
        }                                                                                          \
    } while (0)

#define FILL(T, value)                                                                             \
    do {                                                                                           \
        T *elements = values;                                                                      \
        for (size_t i = 0; i < count; i++)                                                         \
            elements[i] = (value);                                                                 \
    } while (0)

static void law_add(void *left, const void *right, size_t count, duite_type type)
{
    if (type == DUITE_I32)
        EACH(uint32_t, l + r);
    else if (type == DUITE_I64)
        EACH(uint64_t, l + r);
    else if (type == DUITE_F32)
        EACH(float, l + r);
    else
        EACH(double, l + r);
}

/* The left one stays unless the right one is smaller (larger), or not a number. */
static void law_lesser(void *left, const void *right, size_t count, duite_type type)
{
    if (type == DUITE_I32)
        EACH(int32_t, r < l ? r : l);
    else if (type == DUITE_I64)
        EACH(int64_t, r < l ? r : l);
    else if (type == DUITE_F32)
        EACH(float, r < l || r != r ? r : l);
    else
        EACH(double, r < l || r != r ? r : l);
}

static void law_greater(void *left, const void *right, size_t count, duite_type type)
{
    if (type == DUITE_I32)
        EACH(int32_t, r > l ? r : l);
    else if (type == DUITE_I64)
        EACH(int64_t, r > l ? r : l);
    else if (type == DUITE_F32)
        EACH(float, r > l || r != r ? r : l);
    else
        EACH(double, r > l || r != r ? r : l);
}

static void law_fill_largest(void *values, size_t count, duite_type type)
{
    if (type == DUITE_I32)
        FILL(int32_t, INT32_MAX);
    else if (type == DUITE_I64)
        FILL(int64_t, INT64_MAX);
    else if (type == DUITE_F32)
        FILL(float, HUGE_VALF);
    else
        FILL(double, HUGE_VAL);
}

static void law_fill_smallest(void *values, size_t count, duite_type type)
{
    if (type == DUITE_I32)
        FILL(int32_t, INT32_MIN);
    else if (type == DUITE_I64)
        FILL(int64_t, INT64_MIN);
    else if (type == DUITE_F32)
        FILL(float, -HUGE_VALF);
    else
        FILL(double, -HUGE_VAL);
}

const duite_law duite_sum = {.name = "sum", .combine = law_add};
const duite_law duite_min = {.name = "min", .neutral = law_fill_largest, .combine = law_lesser};
const duite_law duite_max = {.name = "max", .neutral = law_fill_smallest, .combine = law_greater};

static const duite_law *const built_in[] = {&duite_sum, &duite_min, &duite_max, NULL};

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
        if ((int)law->type < 0 || law->type > DUITE_F64)
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
    for (unsigned i = 0; i <= DUITE_MAX_ACCESS; i++) {
        bool variadic = i == DUITE_MAX_ACCESS;
        const duite_law *law = variadic ? kernel->variadic_law : kernel->law[i];
        duite_mode mode = variadic ? kernel->variadic : kernel->access[i];
        bool known = law_is_listed(built_in, law) || law_is_listed(laws, law);
        if (!law || ((mode == DUITE_CW || mode == DUITE_CWP) && known))
            continue;
        char where[24] = "`variadic`";
        if (!variadic)
            snprintf(where, sizeof where, "parameter %u", i);
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

bool data_law_fits(const duite_law *law, duite_type type)
{
    return law->type ? law->type == type : type != DUITE_BYTE;
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
    for (unsigned i = 0; i < DUITE_MAX_ACCESS; i++)
        hash = law_hash(kernel->law[i], hash);
    return law_hash(kernel->variadic_law, hash);
}
