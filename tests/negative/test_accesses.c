/* Forks whose objects do not fit their kernel, and objects that are not there. */

#include "tests/negative/refused.h"

#include <stdint.h>

UNIT_FIXTURE(refused_begin, refused_end)

UNIT_TEST(number_of_objects)
{
    refused(duite_fork(rt, &COPY, NULL, 1, &a), DUITE_E_ACCESS);
    refused(DUITE_FORK(rt, &COPY, NULL, a, b, a), DUITE_E_ACCESS);
    refused(duite_fork(rt, &MANY, NULL, 0, NULL), DUITE_E_ACCESS);
    refused(duite_fork(rt, &EMPTY, NULL, 1, &a), DUITE_E_ACCESS);
    ck_assert_int_eq(duite_fork(rt, &MANY, NULL, 1, &a), DUITE_OK);
}

UNIT_TEST(one_object_twice)
{
    refused(DUITE_FORK(rt, &COPY, NULL, a, a), DUITE_E_ACCESS);
    refused(DUITE_FORK(rt, &MANY, NULL, a, b, a), DUITE_E_ACCESS);
}

/* Any number of further parameters is any number. */
UNIT_TEST(many_objects)
{
    enum { MANY_OBJECTS = 200 };
    duite_object objects[MANY_OBJECTS];

    for (int i = 0; i < MANY_OBJECTS; i++)
        objects[i] = misuse_new(rt, 1);
    ck_assert_int_eq(duite_fork(rt, &MANY, NULL, MANY_OBJECTS, objects), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    const duite_object last = objects[MANY_OBJECTS - 1];

    objects[MANY_OBJECTS - 1] = objects[7];
    refused(duite_fork(rt, &MANY, NULL, MANY_OBJECTS, objects), DUITE_E_ACCESS);
    objects[MANY_OBJECTS - 1] = last;
    for (int i = 0; i < MANY_OBJECTS; i++)
        ck_assert_int_eq(duite_free(rt, objects[i]), DUITE_OK);
}

UNIT_TEST(kernel_not_listed)
{
    const duite_kernel copy_of_add = ADD;

    refused(duite_fork(rt, &UNLISTED, NULL, 1, &a), DUITE_E_KERNEL);
    refused(duite_fork(rt, &copy_of_add, NULL, 1, &a), DUITE_E_KERNEL);
}

static void all_refuse(duite_object gone)
{
    int32_t value[4] = {0};

    refused(duite_fork(rt, &ADD, NULL, 1, &gone), DUITE_E_OBJECT);
    refused(DUITE_FORK(rt, &COPY, NULL, a, gone), DUITE_E_OBJECT);
    refused(duite_set(rt, gone, value), DUITE_E_OBJECT);
    refused(duite_free(rt, gone), DUITE_E_OBJECT);
    refused(duite_hint(rt, gone, 1, 0, NULL, NULL), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_get(rt, gone, value), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_get_at(rt, gone, 0, value), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_home(rt, gone), -1);
}

UNIT_TEST(no_such_object)
{
    all_refuse(DUITE_NO_OBJECT);
    all_refuse((duite_object){1000000, 1});
    all_refuse((duite_object){0xffffffffu, 0xffffffffu});
    all_refuse((duite_object){a.slot, a.generation + 1});
}

/* A freed name stays dead when its place is taken by others. */
UNIT_TEST(use_after_free)
{
    duite_object gone = misuse_new(rt, 4), next[8];

    ck_assert_int_eq(duite_fork(rt, &ADD, NULL, 1, &gone), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, gone), DUITE_OK);
    all_refuse(gone);
    for (int i = 0; i < 8; i++)
        next[i] = misuse_new(rt, 4);
    all_refuse(gone);
    for (int i = 0; i < 8; i++) {
        int32_t value[4] = {1, 1, 1, 1};

        ck_assert_int_eq(duite_get(rt, next[i], value), DUITE_OK);
        ck_assert_int_eq(value[0], 0);
        ck_assert_int_eq(duite_free(rt, next[i]), DUITE_OK);
    }
}

/* Nor does it come to life by forks that were recognised as repeated. */
UNIT_TEST(repeated_forks_after_free)
{
    enum { FORKS = 1000 };
    duite_options options = misuse_options(MPI_COMM_WORLD);

    refused_end(); /* what began without recognition */
    options.threads = 1;
    options.memo = 2;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    a = misuse_new(rt, 4);
    b = misuse_new(rt, 4);
    c = misuse_new(rt, 4);
    for (int i = 0; i < FORKS; i++)
        ck_assert_int_eq(DUITE_FORK(rt, &COPY, NULL, a, b), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, b), DUITE_OK);
    const duite_object next = misuse_new(rt, 1);
    for (int i = 0; i < FORKS; i++)
        ck_assert_int_eq(DUITE_FORK(rt, &COPY, NULL, a, b), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_OBJECT);
    b = next;
}

/* A refused access has left no trace. */
UNIT_TEST(refused_forks_do_nothing)
{
    int32_t value[4];

    for (int i = 0; i < 3; i++) {
        DUITE_FORK(rt, &ADD, NULL, a);
        DUITE_FORK(rt, &ADD, NULL, a, b);
        DUITE_FORK(rt, &UNLISTED, NULL, a);
    }
    ck_assert_int_eq(duite_wait(rt), DUITE_E_ACCESS);
    ck_assert_int_eq(duite_get(rt, a, value), DUITE_OK);
    ck_assert_int_eq(value[0], 3);
    ck_assert_int_eq(duite_get(rt, b, value), DUITE_OK);
    ck_assert_int_eq(value[0], 0);
}
