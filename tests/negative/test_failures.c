/* Bodies that fail, on one rank: what is poisoned, what does not run, what get and wait return. */

#include "tests/negative/refused.h"

#include <stdint.h>

static const int32_t SEVEN = 7, EIGHT = 8, EIGHTS[4] = {8, 8, 8, 8};

static int32_t value_of(duite_object object)
{
    int32_t value[4] = {-99};

    ck_assert_int_eq(duite_get(rt, object, value), DUITE_OK);
    return value[0];
}

static int get(duite_object object)
{
    int32_t value[4] = {-99};
    const int code = duite_get(rt, object, value);

    ck_assert(!code || value[0] == -99);
    return code;
}

UNIT_FIXTURE(refused_begin, refused_end)

UNIT_TEST(the_code_and_the_sentence)
{
    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    ck_assert_int_eq(duite_wait(rt), 7);
    says("sentence 7 of a body");
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(get(a), 7);
    says("sentence 7 of a body");
    ck_assert_int_eq(get(a), 7);
    ck_assert_int_eq(duite_get_at(rt, a, 0, (int32_t[4]){0}), 7);
}

UNIT_TEST(first_in_fork_order)
{
    const duite_object objects[] = {a, b, c};

    for (int32_t i = 0; i < 3; i++)
        duite_fork(rt, &FAIL, &(int32_t){20 - i}, 1, &objects[i]);
    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    ck_assert_int_eq(duite_wait(rt), 20);
    ck_assert_int_eq(get(c), 18);
    ck_assert_int_eq(get(b), 19);
    ck_assert_int_eq(get(a), 20);
}

/* A reader of poison does not run: what it would write is poisoned with the same failure, and
 * nothing else. */
UNIT_TEST(poison_travels)
{
    duite_counters counters;

    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    DUITE_FORK(rt, &COPY, NULL, a, b);
    DUITE_FORK(rt, &COPY, NULL, b, c);
    DUITE_FORK(rt, &MANY, NULL, a, b, c);
    ck_assert_int_eq(get(c), 7);
    ck_assert_int_eq(get(b), 7);
    ck_assert_int_eq(duite_wait(rt), 7);
    DUITE_FORK(rt, &COPY, NULL, b, c);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_count_all(rt, &counters), DUITE_OK);
    ck_assert_uint_eq(counters.tasks, 1);
}

UNIT_TEST(writing_cures)
{
    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    DUITE_FORK(rt, &COPY, NULL, a, b);
    DUITE_FORK(rt, &SET, &EIGHT, a);
    DUITE_FORK(rt, &COPY, NULL, a, c);
    ck_assert_int_eq(value_of(c), 9);
    ck_assert_int_eq(get(b), 7);
    ck_assert_int_eq(duite_set(rt, b, EIGHTS), DUITE_OK);
    ck_assert_int_eq(value_of(b), 8);
    ck_assert_int_eq(duite_wait(rt), 7);
}

/* Contributions do not read: they run, but the sum stays poisoned by the old value. */
UNIT_TEST(adding_does_not_cure)
{
    duite_counters counters;

    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    DUITE_FORK(rt, &ADD, NULL, a);
    DUITE_FORK(rt, &ADD, NULL, a);
    ck_assert_int_eq(get(a), 7);
    ck_assert_int_eq(duite_wait(rt), 7);
    ck_assert_int_eq(duite_count_all(rt, &counters), DUITE_OK);
    ck_assert_uint_eq(counters.tasks, 3);
}

/* The runtime's own errors and those of bodies: the refused fork first, the failure with the next
 * wait. */
UNIT_TEST(refused_and_failed)
{
    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    ck_assert_int_eq(DUITE_FORK(rt, &ADD, NULL, a, b), DUITE_E_ACCESS);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_ACCESS);
    ck_assert_int_eq(duite_wait(rt), 7);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
}

UNIT_TEST(stop_tells)
{
    DUITE_FORK(rt, &FAIL, &SEVEN, a);
    duite_free(rt, b);
    duite_free(rt, c);
    ck_assert_int_eq(duite_free(rt, a), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), 7);
    ck_assert_ptr_null(rt);
    refused_begin();
}

UNIT_TEST(each_its_sentence)
{
    DUITE_FORK(rt, &FAIL, &EIGHT, a);
    DUITE_FORK(rt, &FAIL, &SEVEN, b);
    ck_assert_int_eq(get(b), 7);
    says("sentence 7 of a body");
    ck_assert_int_eq(get(a), 8);
    says("sentence 8 of a body");
    ck_assert_int_eq(duite_wait(rt), 8);
}
