/* Laws of contributions: the built-in ones at the edges of their types, and laws of a program on
 * numbers and on structures in bytes. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { WIDTH = 4 };

/* Contributes the argument, as many elements of it as there are. */
static int give(const duite_call *call)
{
    const size_t size =
        call->param[0].type == DUITE_I32 || call->param[0].type == DUITE_F32 ? 4 : 8;

    memcpy(call->param[0].data, call->args, duite_count(call, 0) * size);
    return 0;
}

#define GIVES(law_)                                                                                \
    {                                                                                              \
        .name = "give by " #law_, .body = give, .access = {DUITE_CW},                              \
        .args_size = WIDTH * sizeof(double), .law = {                                              \
            &duite_##law_                                                                          \
        }                                                                                          \
    }
static const duite_kernel GIVE_SUM = GIVES(sum), GIVE_MIN = GIVES(min), GIVE_MAX = GIVES(max);

/* The place of the smallest value, the first of equal ones: a structure in bytes. */
struct least {
    double value;
    int64_t place;
};

static void least_neutral(void *values, size_t count, duite_type type)
{
    for (size_t i = 0; type == DUITE_BYTE && i < count / sizeof(struct least); i++)
        ((struct least *)values)[i] = (struct least){DBL_MAX, -1};
}

static void least_combine(void *left, const void *right, size_t count, duite_type type)
{
    struct least *l = left;
    const struct least *r = right;

    for (size_t i = 0; type == DUITE_BYTE && i < count / sizeof *l; i++)
        if (r[i].value < l[i].value)
            l[i] = r[i];
}

static const duite_law LEAST = {
    .name = "least", .type = DUITE_BYTE, .neutral = least_neutral, .combine = least_combine};

/* 10 l + r: the order of what is combined can be read in the digits. */
static void digits_combine(void *left, const void *right, size_t count, duite_type type)
{
    for (size_t i = 0; type == DUITE_I64 && i < count; i++)
        ((int64_t *)left)[i] = ((int64_t *)left)[i] * 10 + ((const int64_t *)right)[i];
}

static const duite_law DIGITS = {.name = "digits", .type = DUITE_I64, .combine = digits_combine};

static int find_least(const duite_call *call)
{
    const double *given = call->args;
    struct least *least = duite_out(call, 0, struct least);
    const int begins_neutral = least->place == -1 && least[1].value >= DBL_MAX;

    *least = (struct least){given[0], (int64_t)given[1]};
    return begins_neutral ? 0 : 1;
}

static int give_all(const duite_call *call)
{
    for (size_t i = 0; i < call->n_params; i++)
        duite_out(call, i, int64_t)[0] = *(const int64_t *)call->args;
    return 0;
}

static const duite_kernel FIND_LEAST = {.name = "find least",
                                        .body = find_least,
                                        .access = {DUITE_CW},
                                        .args_size = 2 * sizeof(double),
                                        .law = {&LEAST}};
static const duite_kernel GIVE_ALL = {.name = "give all",
                                      .body = give_all,
                                      .access = {DUITE_CW, DUITE_CW, DUITE_CW},
                                      .variadic = DUITE_CW,
                                      .args_size = sizeof(int64_t),
                                      .law = {[1] = &duite_max, [2] = &DIGITS},
                                      .variadic_law = &duite_min};

static duite *rt;

static void begin(void)
{
    static const duite_kernel *const KERNELS[] = {&GIVE_SUM,   &GIVE_MIN, &GIVE_MAX,
                                                  &FIND_LEAST, &GIVE_ALL, NULL};
    static const duite_law *const LAWS[] = {&LEAST, &duite_min, &DIGITS, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = KERNELS;
    options.laws = LAWS;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
}

static void end(void)
{
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* Contributes n times WIDTH elements to an object that holds `old`; leaves the result in `values`.
 */
static void combine(const duite_kernel *kernel, duite_type type, const void *old, size_t n,
                    const void *given, void *values)
{
    const size_t bytes = WIDTH * (type == DUITE_I32 || type == DUITE_F32 ? 4 : 8);
    duite_object object;

    ck_assert_int_eq(duite_new(rt, type, WIDTH, &object), DUITE_OK);
    duite_set(rt, object, old);
    for (size_t i = 0; i < n; i++) {
        char args[WIDTH * sizeof(double)] = {0};

        memcpy(args, (const char *)given + i * bytes, bytes);
        ck_assert_int_eq(duite_fork(rt, kernel, args, 1, &object), DUITE_OK);
    }
    ck_assert_int_eq(duite_get(rt, object, values), DUITE_OK);
    duite_free(rt, object);
}

#define CHECK(kernel, type, T, old, expected, ...)                                                 \
    do {                                                                                           \
        const T before[WIDTH] = old, given[][WIDTH] = {__VA_ARGS__}, should[WIDTH] = expected;     \
        T is[WIDTH];                                                                               \
        combine(&kernel, type, before, sizeof given / sizeof given[0], given, is);                 \
        ck_assert_mem_eq(is, should, sizeof is);                                                   \
    } while (0)
#define V(...)                                                                                     \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }

UNIT_FIXTURE(begin, end)

UNIT_TEST(integers)
{
    CHECK(GIVE_MIN, DUITE_I32, int32_t, V(5, 5, -7, INT32_MAX), V(1, 5, -7, INT32_MAX - 1),
          V(3, 6, -6, INT32_MAX), V(1, 7, 0, INT32_MAX - 1), V(2, 8, 9, INT32_MAX));
    CHECK(GIVE_MAX, DUITE_I32, int32_t, V(5, 5, -7, INT32_MIN), V(5, 8, -6, INT32_MIN + 1),
          V(3, 6, -6, INT32_MIN), V(1, 7, -9, INT32_MIN + 1), V(2, 8, -8, INT32_MIN));
    CHECK(GIVE_MIN, DUITE_I64, int64_t, V(5, 5, -7, INT64_MAX), V(1, 5, -7, INT64_MAX - 1),
          V(3, 6, -6, INT64_MAX), V(1, 7, 0, INT64_MAX - 1));
    CHECK(GIVE_MAX, DUITE_I64, int64_t, V(5, 5, -7, INT64_MIN), V(5, 7, -6, INT64_MIN + 1),
          V(3, 6, -6, INT64_MIN), V(1, 7, -9, INT64_MIN + 1));
    CHECK(GIVE_SUM, DUITE_I32, int32_t, V(5, 0, 0, INT32_MAX), V(8, -1, 0, INT32_MIN),
          V(1, -2, 0, 0), V(2, 1, 0, 1));
    CHECK(GIVE_SUM, DUITE_I64, int64_t, V(5, 0, 0, INT64_MAX), V(8, -1, 0, INT64_MIN),
          V(1, -2, 0, 0), V(2, 1, 0, 1));
}

/* Equal ones keep the first, so that 0 and -0 have one answer; the old value is before them all. */
UNIT_TEST(zeros)
{
    CHECK(GIVE_MIN, DUITE_F64, double, V(-0.0, 0.0, 1, 1), V(-0.0, 0.0, -0.0, 0.0),
          V(0.0, -0.0, -0.0, 0.0), V(0.0, -0.0, 0.0, -0.0));
    CHECK(GIVE_MAX, DUITE_F64, double, V(-0.0, 0.0, -1, -1), V(-0.0, 0.0, -0.0, 0.0),
          V(0.0, -0.0, -0.0, 0.0), V(0.0, -0.0, 0.0, -0.0));
    CHECK(GIVE_MIN, DUITE_F32, float, V(-0.0f, 0.0f, 1, 1), V(-0.0f, 0.0f, -0.0f, 0.0f),
          V(0.0f, -0.0f, -0.0f, 0.0f), V(0.0f, -0.0f, 0.0f, -0.0f));
    CHECK(GIVE_MAX, DUITE_F32, float, V(-0.0f, 0.0f, -1, -1), V(-0.0f, 0.0f, -0.0f, 0.0f),
          V(0.0f, -0.0f, -0.0f, 0.0f), V(0.0f, -0.0f, 0.0f, -0.0f));
}

/* A NaN with a payload, so that it can be told from others. */
static double nan_of(uint64_t payload)
{
    const uint64_t bits = 0x7ff8000000000000u | payload;
    double value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static float nanf_of(uint32_t payload)
{
    const uint32_t bits = 0x7fc00000u | payload;
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Not a number wins wherever it stands; of several the last does. */
UNIT_TEST(not_numbers)
{
    const double a = nan_of(1), b = nan_of(2);
    const float c = nanf_of(1), d = nanf_of(2);

    CHECK(GIVE_MIN, DUITE_F64, double, V(a, 0, 1, a), V(a, b, a, b), V(-1, b, 1, 3), V(-2, 3, a, 3),
          V(-3, 3, -9, b));
    CHECK(GIVE_MAX, DUITE_F64, double, V(a, 0, 1, a), V(a, b, a, b), V(1, b, 1, 3), V(2, 3, a, 3),
          V(3, 3, 9, b));
    CHECK(GIVE_MIN, DUITE_F32, float, V(c, 0, 1, c), V(c, d, c, d), V(-1, d, 1, 3), V(-2, 3, c, 3),
          V(-3, 3, -9, d));
    CHECK(GIVE_MAX, DUITE_F32, float, V(c, 0, 1, c), V(c, d, c, d), V(1, d, 1, 3), V(2, 3, c, 3),
          V(3, 3, 9, d));
    CHECK(GIVE_MIN, DUITE_F64, double, V(INFINITY, INFINITY, -INFINITY, 0),
          V(INFINITY, DBL_MAX, -INFINITY, -INFINITY), V(INFINITY, DBL_MAX, 0, -INFINITY));
    CHECK(GIVE_MAX, DUITE_F32, float, V(-INFINITY, -INFINITY, INFINITY, 0),
          V(-INFINITY, -FLT_MAX, INFINITY, INFINITY), V(-INFINITY, -FLT_MAX, 0, INFINITY));
}

UNIT_TEST(structures_in_bytes)
{
    static const double GIVEN[][2] = {{5, 0}, {2, 1}, {3, 2}, {2, 3}, {4, 4}};
    const struct least old[2] = {{2.5, 99}, {7, 77}};
    struct least is[2];
    duite_object object;

    ck_assert_int_eq(duite_new(rt, DUITE_BYTE, sizeof old, &object), DUITE_OK);
    duite_set(rt, object, old);
    for (size_t i = 0; i < sizeof GIVEN / sizeof *GIVEN; i++)
        ck_assert_int_eq(duite_fork(rt, &FIND_LEAST, GIVEN[i], 1, &object), DUITE_OK);
    ck_assert_int_eq(duite_get(rt, object, is), DUITE_OK);
    ck_assert_int_eq(is[0].place, 1);
    ck_assert(is[0].value == 2);
    ck_assert_int_eq(is[1].place, 77);
    duite_free(rt, object);
}

/* Each parameter has its law; without one it is a sum. (1 2)(3 4) 5 under 10 l + r: 12, 34; 10 * 12
 * + 34 = 154; 10 * 154 + 5 = 1545; then the old value 7 in front. */
UNIT_TEST(a_law_each)
{
    static const int64_t EXPECTED[] = {7 + 15, 7, 70 + 1545, 1, 1};
    duite_object object[5];

    for (int i = 0; i < 5; i++) {
        ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &object[i]), DUITE_OK);
        duite_set(rt, object[i], &(int64_t){7});
    }
    for (int64_t i = 1; i <= 5; i++)
        ck_assert_int_eq(duite_fork(rt, &GIVE_ALL, &i, 5, object), DUITE_OK);
    for (int i = 0; i < 5; i++) {
        int64_t value;

        ck_assert_int_eq(duite_get(rt, object[i], &value), DUITE_OK);
        ck_assert_int_eq(value, EXPECTED[i]);
        duite_free(rt, object[i]);
    }
}

/* Contributions of another law come after those before them: max(min(9, 3), 5), not
 * min(max(9, 5), 3). */
UNIT_TEST(another_law_is_another_access)
{
    static const int64_t GIVEN[][WIDTH] = {{3, 3, 3, 3}, {5, 5, 5, 5}, {4, 4, 4, 4}, {9, 9, 9, 9}};
    const duite_kernel *const KERNELS[] = {&GIVE_MIN, &GIVE_MAX, &GIVE_MIN, &GIVE_SUM};
    int64_t value[WIDTH] = {9, 9, 9, 9};
    duite_object object;

    ck_assert_int_eq(duite_new(rt, DUITE_I64, WIDTH, &object), DUITE_OK);
    duite_set(rt, object, value);
    for (int i = 0; i < 4; i++)
        ck_assert_int_eq(duite_fork(rt, KERNELS[i], GIVEN[i], 1, &object), DUITE_OK);
    ck_assert_int_eq(duite_get(rt, object, value), DUITE_OK);
    for (int i = 0; i < WIDTH; i++)
        ck_assert_int_eq(value[i], 13);
    duite_free(rt, object);
}
