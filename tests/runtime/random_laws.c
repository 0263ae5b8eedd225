/* The laws of random programs, element by element: sum, min, max, and two laws of the program's
 * own. Those show every swap and every other shape of the tree: they are neither associative nor
 * commutative, and a leaf begins with a value that is not neutral. */

#include "tests/runtime/random_program.h"

#include <math.h>

/* The laws of a type, by its mix of two values. */
#define LAW_OF(name, type, mix, sum)                                                               \
    static type name(enum prog_law law, type l, type r)                                            \
    {                                                                                              \
        switch (law) {                                                                             \
        case PROG_MIN:                                                                             \
            return l > r ? r : l;                                                                  \
        case PROG_MAX:                                                                             \
            return l < r ? r : l;                                                                  \
        case PROG_MIX:                                                                             \
            return mix;                                                                            \
        default:                                                                                   \
            return sum;                                                                            \
        }                                                                                          \
    }

LAW_OF(i32_of, int32_t, (int32_t)((uint32_t)l * 5u + ((uint32_t)r ^ 0x2au)),
       (int32_t)((uint32_t)l + (uint32_t)r))
LAW_OF(i64_of, int64_t, (int64_t)((uint64_t)l * 5u + ((uint64_t)r ^ 0x2au)),
       (int64_t)((uint64_t)l + (uint64_t)r))
LAW_OF(u16_of, uint16_t, (uint16_t)(l * 5u + (r ^ 0x2au)), (uint16_t)(l + r))
LAW_OF(f32_of, float, l * 0.375f + r * 0.5f, l + r)
LAW_OF(f64_of, double, l * 0.375 + r * 0.5, l + r)

static uint8_t byte_of(size_t i, uint8_t l, uint8_t r)
{
    return (uint8_t)(l * 3 + (r ^ i));
}

#define COMBINE(type, of, by)                                                                      \
    ((type *)left)[i] = of(by, ((type *)left)[i], ((const type *)right)[i])

void prog_combine(enum prog_law law, duite_type type, size_t count, void *left, const void *right)
{
    for (size_t i = 0; i < count; i++)
        switch (type) {
        case DUITE_BYTE:
            COMBINE(uint8_t, byte_of, i);
            break;
        case DUITE_I32:
            COMBINE(int32_t, i32_of, law);
            break;
        case DUITE_I64:
            COMBINE(int64_t, i64_of, law);
            break;
        case DUITE_F32:
            COMBINE(float, f32_of, law);
            break;
        case DUITE_F64:
            COMBINE(double, f64_of, law);
            break;
        case DUITE_U16:
            COMBINE(uint16_t, u16_of, law);
            break;
        case DUITE_CF64: /* sums and mixes alone, both part by part */
            prog_combine(law, DUITE_F64, 2, (double *)left + 2 * i, (const double *)right + 2 * i);
            break;
        default:
            break;
        }
}

#define NEUTRAL(type, most, least)                                                                 \
    ((type *)values)[i] = law == PROG_MIN ? (most) : law == PROG_MAX ? (least) : own

void prog_neutral(enum prog_law law, duite_type type, size_t count, void *values)
{
    const int8_t own = law == PROG_MIX ? 3 : 0;

    for (size_t i = 0; i < count; i++)
        switch (type) {
        case DUITE_BYTE:
            ((uint8_t *)values)[i] = (uint8_t)(41 + i);
            break;
        case DUITE_I32:
            NEUTRAL(int32_t, INT32_MAX, INT32_MIN);
            break;
        case DUITE_I64:
            NEUTRAL(int64_t, INT64_MAX, INT64_MIN);
            break;
        case DUITE_F32:
            NEUTRAL(float, INFINITY, -INFINITY);
            break;
        case DUITE_F64:
            NEUTRAL(double, (double)INFINITY, -(double)INFINITY);
            break;
        case DUITE_U16:
            ((uint16_t *)values)[i] = law == PROG_MIN ? UINT16_MAX : (uint16_t)own;
            break;
        case DUITE_CF64:
            prog_neutral(law, DUITE_F64, 2, (double *)values + 2 * i);
            break;
        default:
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
