/* Objects that change size beyond what they may, and calls that ask for what they have not. */

#include "tests/negative/refused.h"
#include "tests/support/kernel.h"

#include <stdint.h>

enum { MOST = 10 };

/* Parameters: one that changes its size, one that does not, one that is read. */
struct wish {
    size_t parameter, count;
    int code; /* the body returns this after it asked */
    int speaks;
};

static int asked; /* what duite_resize returned last */

KERNEL(ASK, "ask", .access = {DUITE_RW, DUITE_RW, DUITE_R}, .args_size = sizeof(struct wish))
{
    const struct wish *wish = call->args;

    asked = duite_resize(call, wish->parameter, wish->count);
    return wish->speaks ? duite_fail_text(call, wish->code, "the body's own %s") : wish->code;
}

static duite_object sized, fixed, read_only;

static void begin(void)
{
    static const duite_kernel *const KERNELS[] = {&ASK, &ADD, &SET, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = KERNELS;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 3, MOST, &sized), DUITE_OK);
    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 3, MOST, &read_only), DUITE_OK);
    fixed = misuse_new(rt, 4);
}

static void end(void)
{
    duite_free(rt, sized);
    duite_free(rt, fixed);
    duite_free(rt, read_only);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* The body is refused, its task fails with the code, and its objects are poisoned. */
static void refuses(struct wish wish, int code, const char *sentence)
{
    int32_t values[MOST];
    size_t count = 77;

    asked = DUITE_OK;
    ck_assert_int_eq(DUITE_FORK(rt, &ASK, &wish, sized, fixed, read_only), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), code);
    says(sentence);
    ck_assert_int_eq(asked, DUITE_E_SIZE);
    ck_assert_int_eq(duite_get_count(rt, sized, &count), code);
    ck_assert_uint_eq(count, 77);
    ck_assert_int_eq(duite_get(rt, fixed, values), code);
    says(sentence);
    duite_set(rt, sized, NULL);
    duite_set(rt, fixed, NULL);
    ck_assert_int_eq(duite_get_count(rt, sized, &count), DUITE_OK);
    ck_assert_uint_eq(count, MOST);
}

UNIT_FIXTURE(begin, end)

UNIT_TEST(beyond_the_maximum)
{
    refuses((struct wish){.parameter = 0, .count = MOST + 1}, DUITE_E_SIZE,
            "parameter 0: 11 elements are more than 10 at most");
    refuses((struct wish){.parameter = 0, .count = SIZE_MAX}, DUITE_E_SIZE, "at most");
}

UNIT_TEST(not_changeable)
{
    refuses((struct wish){.parameter = 1, .count = 3}, DUITE_E_SIZE,
            "the object of parameter 1 has a fixed size");
    refuses((struct wish){.parameter = 2, .count = 2}, DUITE_E_SIZE, "parameter 2 is only read");
    refuses((struct wish){.parameter = 3, .count = 2}, DUITE_E_SIZE, "there is no parameter 3");
}

/* The body's sentence goes before. */
UNIT_TEST(code_of_the_body)
{
    refuses((struct wish){.count = MOST + 1, .code = 5}, 5, "code 5: duite_resize: parameter 0");
    refuses((struct wish){.count = MOST + 1, .code = 6, .speaks = 1}, 6,
            "code 6: the body's own %s");
}

UNIT_TEST(no_accumulation)
{
    refused(duite_fork(rt, &ADD, NULL, 1, &sized), DUITE_E_ACCESS);
    says("changes its size and cannot be accumulated");
}

static void makes(duite_type type, size_t count, size_t max, int code, const char *sentence)
{
    duite_object object = sized;

    ck_assert_int_eq(duite_new_sized(rt, type, count, max, &object), code);
    says(sentence);
    ck_assert_uint_eq(object.slot, 0);
    ck_assert_int_eq(duite_wait(rt), code);
}

UNIT_TEST(making)
{
    makes(DUITE_I32, 11, 10, DUITE_E_ARGUMENT, "11 elements are more than 10 at most");
    makes(DUITE_I32, 0, 0, DUITE_E_ARGUMENT, "at least one element");
    makes(DUITE_F64, 1, SIZE_MAX / 2, DUITE_E_ARGUMENT, "are more than");
    makes((duite_type)(DUITE_CF64 + 1), 1, 2, DUITE_E_ARGUMENT, "no element type");
    refused(duite_new_sized(rt, DUITE_I32, 1, 1, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_new_sized(NULL, DUITE_I32, 1, 1, NULL), DUITE_E_ARGUMENT);
}

UNIT_TEST(setting)
{
    const int32_t values[MOST + 1] = {0};

    refused(duite_set_sized(rt, sized, values, MOST + 1), DUITE_E_SIZE);
    says("11 elements, and object ");
    says(" has at most 10");
    refused(duite_set_sized(rt, sized, values, SIZE_MAX), DUITE_E_SIZE);
    refused(duite_set_sized(rt, fixed, values, 3), DUITE_E_SIZE);
    says(" has 4");
    ck_assert_int_eq(duite_set_sized(rt, fixed, values, 4), DUITE_OK);
    ck_assert_int_eq(duite_set_sized(rt, sized, values, 0), DUITE_OK);
    refused(duite_set_sized(rt, DUITE_NO_OBJECT, values, 4), DUITE_E_OBJECT);
}

UNIT_TEST(counting)
{
    size_t count = 0;

    ck_assert_int_eq(duite_get_count(rt, sized, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get_count(rt, DUITE_NO_OBJECT, &count), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_get_count(NULL, sized, &count), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get_count(rt, sized, &count), DUITE_OK);
    ck_assert_uint_eq(count, 3);
}
