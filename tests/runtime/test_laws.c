/* Laws of contributions: the built-in ones at the edges of their types, and laws of a program on
 * numbers and on structures in bytes. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <complex.h>
#include <duite_policy.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { WIDTH = 4, LARGEST = 16 };

static size_t size_of(duite_type type)
{
    switch (type) {
    case DUITE_I16:
    case DUITE_U16:
        return 2;
    case DUITE_I32:
    case DUITE_U32:
    case DUITE_F32:
        return 4;
    case DUITE_I64:
    case DUITE_U64:
    case DUITE_F64:
    case DUITE_CF32:
        return 8;
    case DUITE_CF64:
        return 16;
    default:
        return 1;
    }
}

/* Contributes the argument, as many elements of it as there are. */
static int give(const duite_call *call)
{
    memcpy(call->param[0].data, call->args, duite_count(call, 0) * size_of(call->param[0].type));
    return 0;
}

#define GIVES(law_)                                                                                \
    {                                                                                              \
        .name = "give by " #law_, .body = give, .access = {DUITE_CW},                              \
        .args_size = WIDTH * LARGEST, .law = DUITE_LAWS(&duite_##law_)                             \
    }
static const duite_kernel GIVE_SUM = GIVES(sum), GIVE_PRODUCT = GIVES(product),
                          GIVE_MIN = GIVES(min), GIVE_MAX = GIVES(max), GIVE_AND = GIVES(bits_and),
                          GIVE_OR = GIVES(bits_or), GIVE_XOR = GIVES(bits_xor),
                          GIVE_ALL_TRUE = GIVES(all), GIVE_ANY_TRUE = GIVES(any);

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

KERNEL(FIND_LEAST, "find least", .access = {DUITE_CW}, .args_size = 2 * sizeof(double),
       .law = DUITE_LAWS(&LEAST))
{
    const double *given = call->args;
    struct least *least = duite_out(call, 0, struct least);
    const int begins_neutral = least->place == -1 && least[1].value >= DBL_MAX;

    *least = (struct least){given[0], (int64_t)given[1]};
    return begins_neutral ? 0 : 1;
}

KERNEL(GIVE_ALL, "give all", .access = {DUITE_CW, DUITE_CW, DUITE_CW}, .variadic = DUITE_CW,
       .args_size = sizeof(int64_t), .law = DUITE_LAWS([1] = &duite_max, [2] = &DIGITS),
       .variadic_law = &duite_min)
{
    for (size_t i = 0; i < call->n_params; i++)
        duite_out(call, i, int64_t)[0] = *(const int64_t *)call->args;
    return 0;
}

static duite *rt;

static void begin(void)
{
    static const duite_kernel *const KERNELS[] = {
        &GIVE_SUM, &GIVE_PRODUCT,  &GIVE_MIN,      &GIVE_MAX,   &GIVE_AND, &GIVE_OR,
        &GIVE_XOR, &GIVE_ALL_TRUE, &GIVE_ANY_TRUE, &FIND_LEAST, &GIVE_ALL, NULL};
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
    const size_t bytes = WIDTH * size_of(type);
    duite_object object;

    ck_assert_int_eq(duite_new(rt, type, WIDTH, &object), DUITE_OK);
    duite_set(rt, object, old);
    for (size_t i = 0; i < n; i++) {
        char args[WIDTH * LARGEST] = {0};

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

/* ---- Every integer type ---- */

struct integer_type {
    duite_type type;
    int is_signed;
};

/* An element as a number of 64 bits with the sign of its type; a number's last bytes are an element
 * (little endian). */
static int64_t element_of(const struct integer_type *of, const void *element)
{
    const int shift = 64 - 8 * (int)size_of(of->type);
    uint64_t bits = 0;

    memcpy(&bits, element, size_of(of->type));
    return of->is_signed ? (int64_t)(bits << shift) >> shift : (int64_t)bits;
}

static int64_t law_of(const duite_kernel *kernel, int is_signed, int64_t l, int64_t r)
{
    const uint64_t a = (uint64_t)l, b = (uint64_t)r;
    const int less = is_signed ? r < l : b < a;

    return kernel == &GIVE_SUM        ? (int64_t)(a + b)
           : kernel == &GIVE_PRODUCT  ? (int64_t)(a * b)
           : kernel == &GIVE_MIN      ? (less ? r : l)
           : kernel == &GIVE_MAX      ? (less ? l : r)
           : kernel == &GIVE_AND      ? (l & r)
           : kernel == &GIVE_OR       ? (l | r)
           : kernel == &GIVE_XOR      ? (l ^ r)
           : kernel == &GIVE_ALL_TRUE ? (l && r)
                                      : (l || r);
}

/* All of these are associative, so any order of the contributions leaves the same. */
static void every_law(const struct integer_type *of, const duite_kernel *kernel, uint64_t *random)
{
    const size_t size = size_of(of->type);
    unsigned char given[5][WIDTH * 8], is[WIDTH * 8];

    for (size_t k = 0; k < 5; k++)
        for (size_t i = 0; i < WIDTH * 8; i++) /* zeros and ones among them: ends of the types */
            given[k][i] = (unsigned char)(duite_random(random) % 4 ? duite_random(random)
                                          : k % 2                  ? 0xff
                                                                   : 0);
    for (size_t i = 0; i < WIDTH && *random % 3 == 0; i++)
        memset(given[i] + i * size, i % 2 ? 0xff : 0, size);
    unsigned char packed[4][WIDTH * 8];
    for (size_t k = 0; k < 4; k++)
        memcpy((unsigned char *)packed + k * WIDTH * size, given[k + 1], WIDTH * size);
    combine(kernel, of->type, given[0], 4, packed, is);
    for (size_t i = 0; i < WIDTH; i++) {
        int64_t should = element_of(of, given[0] + i * size);
        for (size_t k = 1; k < 5; k++) {
            should = law_of(kernel, of->is_signed, should, element_of(of, given[k] + i * size));
            should = element_of(of, &should); /* wraps around */
        }
        ck_assert_msg(element_of(of, is + i * size) == should, "%s of type %d", kernel->name,
                      (int)of->type);
    }
}

UNIT_TEST(every_integer)
{
    static const struct integer_type TYPES[] = {{DUITE_I8, 1},  {DUITE_I16, 1}, {DUITE_I32, 1},
                                                {DUITE_I64, 1}, {DUITE_U8, 0},  {DUITE_U16, 0},
                                                {DUITE_U32, 0}, {DUITE_U64, 0}};
    static const duite_kernel *const KERNELS[] = {&GIVE_SUM, &GIVE_PRODUCT,  &GIVE_MIN,
                                                  &GIVE_MAX, &GIVE_AND,      &GIVE_OR,
                                                  &GIVE_XOR, &GIVE_ALL_TRUE, &GIVE_ANY_TRUE};
    uint64_t random = 7;

    for (size_t t = 0; t < sizeof TYPES / sizeof *TYPES; t++)
        for (size_t k = 0; k < sizeof KERNELS / sizeof *KERNELS; k++)
            for (int round = 0; round < 20; round++)
                every_law(&TYPES[t], KERNELS[k], &random);
}

/* (1 + 2i) + (3 - i) = 4 + i and (1 + 2i) (3 - i) = 5 + 5i; then the old value in front. */
UNIT_TEST(complex_numbers)
{
    CHECK(GIVE_SUM, DUITE_CF32, float complex, V(1, I, 0, 0), V(5 + I, 1 + I, 0, 0),
          V(1 + 2 * I, 1, 0, 0), V(3 - I, 0, 0, 0));
    CHECK(GIVE_PRODUCT, DUITE_CF64, double complex, V(1, I, 2, 1), V(5 + 5 * I, -5 + 5 * I, 0, 1),
          V(1 + 2 * I, 1 + 2 * I, 1, 1), V(3 - I, 3 - I, 0, 1));
    CHECK(GIVE_PRODUCT, DUITE_F32, float, V(1, 2, 0, 1), V(6, 40, 0, 1), V(2, 4, 1, 1),
          V(3, 5, 2, 1));
}

/* Order means nothing for complex numbers, bits and truth for integers alone; the fork is refused
 * with the law and the type. */
UNIT_TEST(laws_without_meaning)
{
    static const struct {
        const duite_kernel *kernel;
        duite_type type;
        const char *sentence;
    } CASES[] = {{&GIVE_MIN, DUITE_CF32, "min"},      {&GIVE_MAX, DUITE_CF64, "cf64"},
                 {&GIVE_AND, DUITE_F64, "bits_and"},  {&GIVE_XOR, DUITE_CF32, "bits_xor"},
                 {&GIVE_ALL_TRUE, DUITE_F32, "f32"},  {&GIVE_SUM, DUITE_BYTE, "bytes"},
                 {&GIVE_ANY_TRUE, DUITE_BYTE, "any"}, {&GIVE_PRODUCT, DUITE_BYTE, "product"}};
    const char args[WIDTH * LARGEST] = {0};
    duite_object object;

    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        ck_assert_int_eq(duite_new(rt, CASES[i].type, WIDTH, &object), DUITE_OK);
        ck_assert_int_eq(duite_fork(rt, CASES[i].kernel, args, 1, &object), DUITE_E_LAW);
        ck_assert_msg(strstr(duite_message(), CASES[i].sentence), "%s", duite_message());
        ck_assert_int_eq(duite_wait(rt), DUITE_E_LAW);
        duite_free(rt, object);
    }
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
    static const int64_t GIVEN[][WIDTH * LARGEST / sizeof(int64_t)] = {
        {3, 3, 3, 3}, {5, 5, 5, 5}, {4, 4, 4, 4}, {9, 9, 9, 9}};
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
