/* Views that cannot be, and what cannot be done with them. Each is refused with DUITE_E_VIEW, and
 * nothing has changed then. */

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <stdint.h>
#include <string.h>

static duite *rt;
static duite_object a, b, sized, view;

static void begin(void)
{
    static const duite_kernel *const KERNELS[] = {&SET, &COPY, &ADD, &FAIL, &MANY, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = KERNELS;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    a = misuse_new(rt, 4);
    b = misuse_new(rt, 4);
    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 3, 4, &sized), DUITE_OK);
    ck_assert_int_eq(duite_view(rt, a, 2, (size_t[]){3, 0}, &view), DUITE_OK);
}

static void end(void)
{
    int32_t values[2] = {-1, -1};

    ck_assert_int_eq(duite_get(rt, view, values), DUITE_OK);
    ck_assert(values[0] == 0 && values[1] == 0);
    ck_assert_int_eq(duite_free(rt, view), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, a), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, b), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, sized), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

static void refused(int code, int expected, const char *sentence)
{
    ck_assert_int_eq(code, expected);
    ck_assert_msg(strstr(duite_message(), sentence) != NULL, "\"%s\" does not say \"%s\"",
                  duite_message(), sentence);
    ck_assert_int_eq(duite_wait(rt), expected); /* told once more */
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
}

START_TEST(making)
{
    const size_t index[] = {0, 4};
    duite_object made = a;

    refused(duite_view(rt, a, 2, index, &made), DUITE_E_VIEW,
            "index 1 of the list is 4, and object 1.1 has 4 elements");
    ck_assert_uint_eq(made.slot, 0);
    refused(duite_view(rt, view, 1, index, &made), DUITE_E_VIEW, "is a view (of object 1.1)");
    refused(duite_view(rt, sized, 1, index, &made), DUITE_E_VIEW, "changes its size");
    refused(duite_view(rt, a, 0, index, &made), DUITE_E_ARGUMENT, "at least one element");
    refused(duite_view(rt, a, 1, NULL, &made), DUITE_E_ARGUMENT, "no indices");
    refused(duite_view(rt, a, 1, index, NULL), DUITE_E_ARGUMENT, "nowhere");
    refused(duite_view(rt, DUITE_NO_OBJECT, 1, index, &made), DUITE_E_OBJECT, "names nothing");
    ck_assert_int_eq(duite_view(NULL, a, 1, index, &made), DUITE_E_ARGUMENT);
    ck_assert_uint_eq(made.slot, 0);
}
END_TEST

START_TEST(writing)
{
    const int32_t values[4] = {1, 2, 3, 4};

    refused(duite_fork(rt, &SET, values, 1, &view), DUITE_E_VIEW, "set: object");
    refused(duite_fork(rt, &FAIL, values, 1, &view), DUITE_E_VIEW, "can only be read");
    refused(duite_fork(rt, &ADD, NULL, 1, &view), DUITE_E_VIEW, "add: object");
    refused(DUITE_FORK(rt, &COPY, NULL, a, view), DUITE_E_VIEW, "can only be read");
    refused(duite_set(rt, view, values), DUITE_E_VIEW, "duite_set");
    refused(duite_set_sized(rt, view, values, 2), DUITE_E_VIEW, "duite_set");
    refused(DUITE_FORK(rt, &MANY, NULL, view, a, view), DUITE_E_ACCESS, "twice");
}
END_TEST

START_TEST(placing)
{
    refused(duite_hint(rt, view, 1, 0, NULL, NULL), DUITE_E_VIEW, "duite_hint");
    refused(duite_hint(rt, a, 1, 1, &view, NULL), DUITE_E_VIEW, "duite_hint");
    refused(duite_colocate(rt, view, b), DUITE_E_VIEW, "duite_colocate");
    refused(duite_colocate(rt, b, view), DUITE_E_VIEW, "duite_colocate");
}
END_TEST

START_TEST(freeing)
{
    duite_object other;

    refused(duite_free(rt, a), DUITE_E_VIEW, "has 1 views that are not freed");
    ck_assert_int_eq(duite_view(rt, a, 1, (size_t[]){1}, &other), DUITE_OK);
    refused(duite_free(rt, a), DUITE_E_VIEW, "has 2 views");
    ck_assert_int_eq(duite_free(rt, other), DUITE_OK);
    refused(duite_free(rt, other), DUITE_E_OBJECT, "was freed");
    refused(DUITE_FORK(rt, &COPY, NULL, other, b), DUITE_E_OBJECT, "was freed");
}
END_TEST

static int build(duite *of, void *context)
{
    const int32_t value = 0;

    (void)context;
    DUITE_FORK(of, &SET, &value, b);
    DUITE_FORK(of, &MANY, NULL, view);
    return 0;
}

static int build_wrong(duite *of, void *context)
{
    const int32_t value = 0;
    duite_object made;

    switch (*(const int *)context) {
    case 0:
        return DUITE_FORK(of, &SET, &value, view);
    case 1:
        return duite_set(of, view, &value);
    default:
        return duite_view(of, a, 1, (size_t[]){0}, &made);
    }
}

START_TEST(recording)
{
    static const int CODES[] = {DUITE_E_VIEW, DUITE_E_VIEW, DUITE_E_STATE};
    duite_graph graph;
    duite_object four;

    for (int wrong = 0; wrong < 3; wrong++)
        refused(duite_graph_new(rt, build_wrong, &wrong, &graph), CODES[wrong], "");
    ck_assert_int_eq(duite_view(rt, a, 4, (size_t[]){0, 1, 2, 3}, &four), DUITE_OK);
    ck_assert_int_eq(duite_graph_new(rt, build, NULL, &graph), DUITE_OK);
    refused(duite_graph_bind(rt, graph, b, four), DUITE_E_VIEW, "duite_graph_bind");
    refused(duite_graph_bind(rt, graph, a, b), DUITE_E_BINDING, "not one that");
    refused(duite_graph_bind(rt, graph, view, four), DUITE_E_BINDING, "has 2 elements");
    ck_assert_int_eq(duite_replay(rt, graph, 2), DUITE_OK);
    ck_assert_int_eq(duite_graph_free(rt, graph), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, four), DUITE_OK);
}
END_TEST

/* What stop finds left is told, with views or without. */
START_TEST(not_freed)
{
    duite *other = misuse_start(MPI_COMM_SELF, 1);
    const duite_object of = misuse_new(other, 2);
    duite_object left;

    ck_assert_int_eq(duite_view(other, of, 1, (size_t[]){1}, &left), DUITE_OK);
    ck_assert_int_eq(duite_stop(&other), DUITE_E_NOT_FREED);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("views that cannot be");
    TCase *cases = tcase_create("views that cannot be"), *alone = tcase_create("left");

    tcase_add_checked_fixture(cases, begin, end);
    tcase_add_test(cases, making);
    tcase_add_test(cases, writing);
    tcase_add_test(cases, placing);
    tcase_add_test(cases, freeing);
    tcase_add_test(cases, recording);
    tcase_add_test(alone, not_freed);
    suite_add_tcase(suite, cases);
    suite_add_tcase(suite, alone);
    return unit_run(suite);
}
