/* Laws that are malformed, not listed, or do not fit the object. */

#include "tests/negative/refused.h"

static void keep_left(void *left, const void *right, size_t count, duite_type type)
{
    (void)left;
    (void)right;
    (void)count;
    (void)type;
}

static const duite_law DOUBLES = {.name = "doubles", .type = DUITE_F64, .combine = keep_left};
static const duite_law BYTES = {.name = "of bytes", .type = DUITE_BYTE, .combine = keep_left};

static int body(const duite_call *call)
{
    (void)call;
    return 0;
}

static const duite_kernel BY_DOUBLES = {.name = "by doubles",
                                        .body = body,
                                        .access = {DUITE_R, DUITE_CW},
                                        .law = DUITE_LAWS([1] = &DOUBLES)};
static const duite_kernel BY_BYTES = {
    .name = "by bytes", .body = body, .variadic = DUITE_CW, .variadic_law = &BYTES};
static const duite_kernel BY_SUM = {.name = "by sum", .body = body, .access = {DUITE_CW}};

static int start(const duite_kernel *const *kernels, const duite_law *const *laws)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = kernels;
    options.laws = laws;
    return duite_start(&rt, &options);
}

/* A start with this kernel and these laws is refused. */
static void refuses(duite_kernel kernel, const duite_law *const *laws, const char *sentence)
{
    const duite_kernel *const kernels[] = {&kernel, NULL};
    rt = (duite *)&kernel;

    ck_assert_int_eq(start(kernels, laws), DUITE_E_LAW);
    ck_assert_ptr_null(rt);
    says(sentence);
}

UNIT_TEST(not_listed)
{
    const duite_law copy = DOUBLES;

    refuses(BY_DOUBLES, NULL, "kernel by doubles, parameter 1: law doubles was not listed");
    refuses(BY_DOUBLES, (const duite_law *[]){&BYTES, &copy, NULL}, "not listed at start");
    refuses(BY_BYTES, (const duite_law *[]){&DOUBLES, NULL},
            "kernel by bytes, `variadic`: law of bytes was not listed");
}

UNIT_TEST(by_name)
{
    ck_assert_ptr_eq(duite_law_find("sum"), &duite_sum);
    ck_assert_ptr_eq(duite_law_find("any"), &duite_any);
    ck_assert_ptr_null(duite_law_find("mean"));
    says("no built-in law is named mean");
    ck_assert_ptr_null(duite_law_find(NULL));
}

UNIT_TEST(no_cw)
{
    duite_kernel kernel = BY_SUM;

    kernel.access[0] = DUITE_RW;
    kernel.law = DUITE_LAWS(&duite_max);
    refuses(kernel, NULL, "parameter 0: law max for a parameter that is not cw");
    kernel = BY_SUM;
    kernel.access[1] = DUITE_R;
    kernel.law = DUITE_LAWS([1] = &duite_min);
    refuses(kernel, NULL, "parameter 1: law min for a parameter that is not cw");
    kernel = BY_SUM;
    kernel.variadic_law = &duite_sum;
    refuses(kernel, NULL, "`variadic`: law sum for a parameter that is not cw");
}

UNIT_TEST(malformed)
{
    duite_law law = DOUBLES;
    const duite_law *const laws[] = {&BYTES, &law, NULL};

    law.name = NULL;
    refuses(BY_SUM, laws, "law 1 of the list has no name");
    law = DOUBLES;
    law.combine = NULL;
    refuses(BY_SUM, laws, "law doubles has no function");
    law = DOUBLES;
    law.type = (duite_type)17;
    refuses(BY_SUM, laws, "law doubles: 17 is no element type");
    law = DOUBLES;
    law.name = BYTES.name;
    refuses(BY_SUM, laws, "two laws have the name of bytes");
    law.name = "sum";
    refuses(BY_SUM, laws, "two laws have the name sum");
}

static void refused_by(const duite_kernel *kernel, size_t n, const duite_object *objects,
                       const char *sentence)
{
    refused(duite_fork(rt, kernel, NULL, n, objects), DUITE_E_LAW);
    says(sentence);
}

/* An object of each type; those of one that do not fit are named. */
UNIT_TEST(another_type)
{
    static const duite_kernel *const KERNELS[] = {&BY_DOUBLES, &BY_BYTES, &BY_SUM, NULL};
    duite_object object[DUITE_CF64 + 1], read;

    ck_assert_int_eq(start(KERNELS, (const duite_law *[]){&DOUBLES, &BYTES, NULL}), DUITE_OK);
    duite_new(rt, DUITE_I32, 1, &read);
    for (duite_type type = DUITE_BYTE; type <= DUITE_CF64; type++) {
        ck_assert_int_eq(duite_new(rt, type, 1, &object[type]), DUITE_OK);
        const duite_object two[] = {read, object[type]};

        if (type == DUITE_F64)
            ck_assert_int_eq(duite_fork(rt, &BY_DOUBLES, NULL, 2, two), DUITE_OK);
        else
            refused_by(&BY_DOUBLES, 2, two,
                       "kernel by doubles, parameter 1: law doubles is for f64, and object ");
        if (type == DUITE_BYTE)
            ck_assert_int_eq(duite_fork(rt, &BY_BYTES, NULL, 1, &object[type]), DUITE_OK);
        else
            refused_by(&BY_BYTES, 1, &object[type], "law of bytes is for bytes, and object ");
        if (type != DUITE_BYTE)
            ck_assert_int_eq(duite_fork(rt, &BY_SUM, NULL, 1, &object[type]), DUITE_OK);
        else
            refused_by(&BY_SUM, 1, &object[type],
                       "law sum is for numbers, and object 2.1 has bytes");
    }
    for (duite_type type = DUITE_BYTE; type <= DUITE_CF64; type++)
        duite_free(rt, object[type]);
    duite_free(rt, read);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}
