/* The owner rule, by modes and a number of objects. */
#include "runtime/task/owner.h"
#include "tests/support/unit.h"

/* The parameter that a task with n objects runs for, of a kernel with these first modes. */
#define OWNER(variadic, n, ...)                                                                    \
    task_owner((const uint8_t[DUITE_MAX_ACCESS]){__VA_ARGS__}, variadic, n)

UNIT_TEST(the_first_written)
{
    ck_assert_uint_eq(OWNER(DUITE_NONE, 1, DUITE_W), 0);
    ck_assert_uint_eq(OWNER(DUITE_NONE, 3, DUITE_R, DUITE_CW, DUITE_RW), 2);
    ck_assert_uint_eq(OWNER(DUITE_NONE, 3, DUITE_R, DUITE_W, DUITE_RW), 1);
    ck_assert_uint_eq(OWNER(DUITE_NONE, 3, DUITE_RP, DUITE_CWP, DUITE_WP), 2);
}

UNIT_TEST(else_the_first_read)
{
    ck_assert_uint_eq(OWNER(DUITE_NONE, 2, DUITE_R, DUITE_R), 0);
    ck_assert_uint_eq(OWNER(DUITE_NONE, 3, DUITE_CW, DUITE_RP, DUITE_R), 1);
    ck_assert_uint_eq(OWNER(DUITE_CW, 9, DUITE_CW, DUITE_R), 1);
}

UNIT_TEST(nobody)
{
    ck_assert_uint_eq(OWNER(DUITE_NONE, 0, DUITE_NONE), TASK_NOBODY);
    ck_assert_uint_eq(OWNER(DUITE_NONE, 2, DUITE_CW, DUITE_CWP), TASK_NOBODY);
    ck_assert_uint_eq(OWNER(DUITE_CW, 1000, DUITE_NONE), TASK_NOBODY);
}

/* The first further parameter decides, if there is any. */
UNIT_TEST(further_parameters)
{
    ck_assert_uint_eq(OWNER(DUITE_RW, 1, DUITE_R), 0);
    ck_assert_uint_eq(OWNER(DUITE_RW, 2, DUITE_R), 1);
    ck_assert_uint_eq(OWNER(DUITE_RW, 3, DUITE_CW), 1);
    ck_assert_uint_eq(OWNER(DUITE_R, 1u << 20, DUITE_CW, DUITE_CW), 2);
    uint8_t full[DUITE_MAX_ACCESS];
    for (int i = 0; i < DUITE_MAX_ACCESS; i++)
        full[i] = DUITE_CW;
    ck_assert_uint_eq(task_owner(full, DUITE_W, DUITE_MAX_ACCESS), TASK_NOBODY);
    ck_assert_uint_eq(task_owner(full, DUITE_W, DUITE_MAX_ACCESS + 2), DUITE_MAX_ACCESS);
}

UNIT_TEST(ranks)
{
    ck_assert_int_eq(task_owner_rank(TASK_ANYWHERE, false, 3), 3);
    ck_assert_int_eq(task_owner_rank(TASK_ANYWHERE, false, -1), 0);
    ck_assert_int_eq(task_owner_rank(2, false, 3), 2);
    ck_assert_int_eq(task_owner_rank(TASK_ANYWHERE, true, 3), TASK_EVERYWHERE);
    ck_assert(task_owner_decides(TASK_ANYWHERE, false));
    ck_assert(!task_owner_decides(0, false) && !task_owner_decides(TASK_ANYWHERE, true));
}
