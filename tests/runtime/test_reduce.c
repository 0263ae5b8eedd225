/* The reduction tree (runtime/data/reduce.h): its shape, written as an expression, is the one of
 * its definition for each number of leaves, however the leaves are dealt to ranks that reduce their
 * own ones first. */
#include "runtime/data/reduce.h"
#include "tests/support/unit.h"

#include <duite_policy.h>

#include <stdio.h>
#include <string.h>

enum { LEAVES = 40, TEXT = 8 * LEAVES, RANKS = 3 };

struct values {
    char text[LEAVES][TEXT]; /* by first leaf */
};

static void combine(void *context, uint32_t left, uint32_t right)
{
    struct values *values = context;
    char both[2 * TEXT + 4];
    snprintf(both, sizeof both, "(%s %s)", values->text[left], values->text[right]);
    ck_assert_uint_lt(strlen(both), TEXT);
    memcpy(values->text[left], both, strlen(both) + 1);
}

/* By the definition: the largest complete subtree that begins at a leaf, then the rest. */
static void expect(char *text, unsigned first, unsigned n)
{
    char left[TEXT], right[TEXT];
    unsigned half = 1;
    while (2 * half < n)
        half *= 2;
    if (n == 1) {
        snprintf(text, TEXT, "%u", first);
        return;
    }
    expect(left, first, half);
    expect(right, first + half, n - half);
    ck_assert_int_lt(snprintf(text, TEXT, "(%s %.*s)", left, TEXT / 2, right), TEXT);
}

static void leaf(struct values *values, unsigned first)
{
    snprintf(values->text[first], TEXT, "%u", first);
}

START_TEST(one_rank)
{
    static struct values values;
    struct data_subtree tree[LEAVES + 1] = {0};
    char expected[TEXT];
    size_t left = 0;
    unsigned n = (unsigned)_i;
    for (unsigned i = 0; i < n; i++) {
        leaf(&values, i);
        tree[left] = (struct data_subtree){.first = i, .where = i};
        left = data_reduce_push(tree, left, combine, &values);
        ck_assert_int_eq((int)left, __builtin_popcount(i + 1));
    }
    data_reduce_fold(tree, left, combine, &values);
    expect(expected, 0, n);
    ck_assert_str_eq(values.text[0], expected);
    if (n == 7)
        ck_assert_str_eq(values.text[0], "(((0 1) (2 3)) ((4 5) 6))");
}
END_TEST

START_TEST(several_ranks)
{
    static struct values values;
    static struct data_subtree part[RANKS][LEAVES], tree[LEAVES];
    size_t n_part[RANKS] = {0}, at[RANKS] = {0}, left = 0;
    uint64_t state = (uint64_t)_i;
    char expected[TEXT];
    unsigned n = (unsigned)_i;
    for (unsigned i = 0; i < n; i++) { /* in runs and alone */
        unsigned rank = n % 2 ? i * RANKS / n : (unsigned)(duite_random(&state) % RANKS);
        leaf(&values, i);
        part[rank][n_part[rank]] = (struct data_subtree){.first = i, .where = i};
        n_part[rank] = data_reduce_push(part[rank], n_part[rank], combine, &values);
    }
    for (;;) { /* the next piece in order */
        int next = -1;
        for (int r = 0; r < RANKS; r++)
            if (at[r] < n_part[r] &&
                (next < 0 || part[r][at[r]].first < part[next][at[next]].first))
                next = r;
        if (next < 0)
            break;
        tree[left] = part[next][at[next]++];
        left = data_reduce_push(tree, left, combine, &values);
    }
    data_reduce_fold(tree, left, combine, &values);
    expect(expected, 0, n);
    ck_assert_str_eq(values.text[0], expected);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("reduce");
    TCase *test = tcase_create("reduce");
    tcase_add_loop_test(test, one_rank, 1, LEAVES + 1);
    tcase_add_loop_test(test, several_ranks, 1, LEAVES + 1);
    suite_add_tcase(suite, test);
    return unit_run(suite);
}
