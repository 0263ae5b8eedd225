/* The laws of random programs, element by element: what sum, min and max mean, and two laws of the
 * program's own that show every swap and every other shape of the tree, since they are neither
 * associative nor commutative and what a leaf begins with is not neutral at all. */

#include "tests/runtime/random_program.h"

#include <limits.h>
#include <math.h>

static int32_t i32_of(enum prog_law law, int32_t l, int32_t r)
{
    switch (law) {
    case PROG_MIN:
        return l > r ? r : l;
    case PROG_MAX:
        return l < r ? r : l;
    case PROG_MIX:
        return (int32_t)((uint32_t)l * 5u + ((uint32_t)r ^ 0x2au));
    default:
        return (int32_t)((uint32_t)l + (uint32_t)r);
    }
}

static int64_t i64_of(enum prog_law law, int64_t l, int64_t r)
{
    switch (law) {
    case PROG_MIN:
        return l > r ? r : l;
    case PROG_MAX:
        return l < r ? r : l;
    case PROG_MIX:
        return (int64_t)((uint64_t)l * 5u + ((uint64_t)r ^ 0x2au));
    default:
        return (int64_t)((uint64_t)l + (uint64_t)r);
    }
}

static float f32_of(enum prog_law law, float l, float r)
{
    switch (law) {
    case PROG_MIN:
        return l > r ? r : l;
    case PROG_MAX:
        return l < r ? r : l;
    case PROG_MIX:
        return l * 0.375f + r * 0.5f;
    default:
        return l + r;
    }
}

static double f64_of(enum prog_law law, double l, double r)
{
    switch (law) {
    case PROG_MIN:
        return l > r ? r : l;
    case PROG_MAX:
        return l < r ? r : l;
    case PROG_MIX:
        return l * 0.375 + r * 0.5;
    default:
        return l + r;
    }
}

void prog_combine(enum prog_law law, duite_type type, size_t count, void *left, const void *right)
{
    for (size_t i = 0; i < count; i++)
        switch (type) {
        case DUITE_BYTE:
            ((uint8_t *)left)[i] =
                (uint8_t)(((uint8_t *)left)[i] * 3 + (((const uint8_t *)right)[i] ^ i));
            break;
        case DUITE_I32:
            ((int32_t *)left)[i] = i32_of(law, ((int32_t *)left)[i], ((const int32_t *)right)[i]);
            break;
        case DUITE_I64:
            ((int64_t *)left)[i] = i64_of(law, ((int64_t *)left)[i], ((const int64_t *)right)[i]);
            break;
        case DUITE_F32:
            ((float *)left)[i] = f32_of(law, ((float *)left)[i], ((const float *)right)[i]);
            break;
        case DUITE_F64:
            ((double *)left)[i] = f64_of(law, ((double *)left)[i], ((const double *)right)[i]);
            break;
        }
}

void prog_neutral(enum prog_law law, duite_type type, size_t count, void *values)
{
    const int own = law == PROG_MIX ? 3 : 0;

    for (size_t i = 0; i < count; i++)
        switch (type) {
        case DUITE_BYTE:
            ((uint8_t *)values)[i] = (uint8_t)(41 + i);
            break;
        case DUITE_I32:
            ((int32_t *)values)[i] = law == PROG_MIN   ? INT32_MAX
                                     : law == PROG_MAX ? INT32_MIN
                                                       : own;
            break;
        case DUITE_I64:
            ((int64_t *)values)[i] = law == PROG_MIN   ? INT64_MAX
                                     : law == PROG_MAX ? INT64_MIN
                                                       : own;
            break;
        case DUITE_F32:
            ((float *)values)[i] = law == PROG_MIN   ? INFINITY
                                   : law == PROG_MAX ? -INFINITY
                                                     : (float)own;
            break;
        case DUITE_F64:
            ((double *)values)[i] = law == PROG_MIN   ? (double)INFINITY
                                    : law == PROG_MAX ? -(double)INFINITY
                                                      : own;
            break;
        }
}

/* ---- The program's own, as the runtime sees them ---- */

static void mix_neutral(void *values, size_t count, duite_type type)
{
    prog_neutral(PROG_MIX, type, count, values);
}

static void mix_combine(void *left, const void *right, size_t count, duite_type type)
{
    prog_combine(PROG_MIX, type, count, left, right);
}

static void weave_neutral(void *values, size_t count, duite_type type)
{
    prog_neutral(PROG_WEAVE, type, count, values);
}

static void weave_combine(void *left, const void *right, size_t count, duite_type type)
{
    prog_combine(PROG_WEAVE, type, count, left, right);
}

static const duite_law mix = {.name = "mix", .neutral = mix_neutral, .combine = mix_combine};
static const duite_law weave = {
    .name = "weave", .type = DUITE_BYTE, .neutral = weave_neutral, .combine = weave_combine};

const duite_law *const prog_own_laws[] = {&weave, &mix, NULL};

const duite_law *prog_law_given(enum prog_law law)
{
    const duite_law *const laws[] = {&duite_sum, &duite_min, &duite_max, &mix, &weave};

    return laws[law];
}

enum prog_law prog_law(const duite_kernel *kernel, size_t i)
{
    const int listed = i < DUITE_MAX_ACCESS && kernel->access[i] != DUITE_NONE;
    const duite_law *law = listed ? kernel->law[i] : kernel->variadic_law;
    enum prog_law found = PROG_SUM;

    for (int l = 0; l < PROG_N_LAWS; l++)
        if (law == prog_law_given((enum prog_law)l))
            found = (enum prog_law)l;
    return found;
}
