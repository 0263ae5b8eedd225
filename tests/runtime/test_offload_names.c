/* Names of tasks on other ranks: what comes back is looked up, and refused and counted if it
 * names nothing. */
#include "runtime/offload/message.h"
#include "tests/support/unit.h"

enum { N = 100 };

/* Names point at these; they are not looked into. */
static struct offload_pending *task_at(int i)
{
    static char place[N + 1];
    return (struct offload_pending *)(void *)&place[i];
}

START_TEST(each_finds_its_own)
{
    struct offload_names names = {0};
    uint64_t name[N];
    for (int i = 0; i < N; i++) {
        name[i] = offload_name_give(&names, task_at(i));
        ck_assert_uint_ne(name[i], 0);
    }
    for (int i = N; i-- > 0;)
        ck_assert_ptr_eq(offload_name_take(&names, name[i]), task_at(i));
    offload_names_free(&names);
}
END_TEST

/* A name that came back once names nothing, also when another task has its slot. */
START_TEST(a_stale_name_is_refused)
{
    struct offload_names names = {0};
    const uint64_t first = offload_name_give(&names, task_at(0));
    ck_assert_ptr_eq(offload_name_take(&names, first), task_at(0));
    ck_assert_ptr_null(offload_name_take(&names, first));
    const uint64_t second = offload_name_give(&names, task_at(1));
    ck_assert_uint_eq((uint32_t)second, (uint32_t)first);
    ck_assert_uint_ne(second, first);
    ck_assert_ptr_null(offload_name_take(&names, first));
    ck_assert_ptr_eq(offload_name_take(&names, second), task_at(1));
    ck_assert_uint_eq(names.refused, 2);
    offload_names_free(&names);
}
END_TEST

START_TEST(what_was_never_given_is_refused)
{
    struct offload_names names = {0};
    ck_assert_ptr_null(offload_name_take(&names, 0));
    const uint64_t name = offload_name_give(&names, task_at(0));
    ck_assert_ptr_null(offload_name_take(&names, 0));
    ck_assert_ptr_null(offload_name_take(&names, name + 1));
    ck_assert_ptr_null(offload_name_take(&names, (uintptr_t)&names));
    ck_assert_uint_eq(names.refused, 4);
    ck_assert_ptr_eq(offload_name_take(&names, name), task_at(0));
    ck_assert_uint_eq(names.refused, 4);
    offload_names_free(&names);
}
END_TEST

START_TEST(generations_go_round_without_0)
{
    struct offload_names names = {0};
    offload_name_take(&names, offload_name_give(&names, task_at(0)));
    names.slot[0].generation = UINT32_MAX;
    const uint64_t last = offload_name_give(&names, task_at(0));
    ck_assert_ptr_eq(offload_name_take(&names, last), task_at(0));
    ck_assert_uint_ne(offload_name_give(&names, task_at(1)), 0);
    ck_assert_ptr_null(offload_name_take(&names, last));
    offload_names_free(&names);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("names of offloaded tasks");
    TCase *test = tcase_create("names");
    tcase_add_test(test, each_finds_its_own);
    tcase_add_test(test, a_stale_name_is_refused);
    tcase_add_test(test, what_was_never_given_is_refused);
    tcase_add_test(test, generations_go_round_without_0);
    suite_add_tcase(suite, test);
    return unit_run(suite);
}
