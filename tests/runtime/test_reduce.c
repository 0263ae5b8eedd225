/* The reduction tree (runtime/data/subtrees.h): its shape, written as an expression, is the one of
 * its definition for each number of leaves, however the leaves are dealt to ranks that reduce their
 * own ones first. */
#include "runtime/data/subtrees.h"
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

UNIT_LOOP(one_rank, 1, LEAVES + 1)
{
    static struct values values;
    struct data_subtree tree[LEAVES + 1];
    struct data_subtrees list = {.at = tree};
    char expected[TEXT];
    unsigned n = (unsigned)_i;
    for (unsigned i = 0; i < n; i++) {
        leaf(&values, i);
        data_subtrees_push(&list, (struct data_subtree){.first = i, .where = i}, combine, &values);
        ck_assert_int_eq((int)list.n, __builtin_popcount(i + 1));
    }
    data_subtrees_fold(&list, combine, &values);
    expect(expected, 0, n);
    ck_assert_str_eq(values.text[0], expected);
    if (n == 7)
        ck_assert_str_eq(values.text[0], "(((0 1) (2 3)) ((4 5) 6))");
}

UNIT_LOOP(several_ranks, 1, LEAVES + 1)
{
    static struct values values;
    static struct data_subtree part[RANKS][LEAVES], all[2][LEAVES];
    struct data_subtrees of[RANKS], tree = {.at = all[0]}, joined = {.at = all[1]};
    uint64_t state = (uint64_t)_i;
    char expected[TEXT];
    unsigned n = (unsigned)_i;
    for (unsigned rank = 0; rank < RANKS; rank++)
        of[rank] = (struct data_subtrees){.at = part[rank]};
    for (unsigned i = 0; i < n; i++) { /* in runs and alone */
        unsigned rank = n % 2 ? i * RANKS / n : (unsigned)(duite_random(&state) % RANKS);
        leaf(&values, i);
        data_subtrees_push(&of[rank], (struct data_subtree){.first = i, .where = i}, combine,
                           &values);
    }
    for (unsigned rank = 0; rank < RANKS; rank++) {
        const struct data_subtrees before = tree;
        data_subtrees_join(&joined, &before, &of[rank], combine, &values);
        tree = joined;
        joined = before;
    }
    data_subtrees_fold(&tree, combine, &values);
    expect(expected, 0, n);
    ck_assert_str_eq(values.text[0], expected);
}

/* ---- Lists that ranks pass on ---- */

enum { MEMBERS = 7, ROUNDS = 3 };

/* A rank's list, each entry with its own copy of the value, as ranks have it. */
struct member {
    struct values values;
    struct data_subtree at[LEAVES];
    struct data_subtrees list;
};

static void member_take(struct member *to, struct member *from)
{
    static struct values came;
    struct data_subtree next_at[2 * LEAVES], missing_at[LEAVES];
    struct data_subtrees next = {.at = next_at}, missing = {.at = missing_at};
    data_subtrees_missing(&missing, &to->list, &from->list);
    came = to->values;
    for (size_t i = 0; i < missing.n; i++)
        memcpy(came.text[missing.at[i].first], from->values.text[missing.at[i].first], TEXT);
    data_subtrees_join(&next, &to->list, &missing, combine, &came);
    to->values = came;
    to->list.n = next.n;
    memcpy(to->at, next.at, next.n * sizeof *next.at);
    to->list.at = to->at;
}

/* Each rank takes the list of the one 2^round places behind: each has everything in the end, some
 * of it several times and in larger subtrees on the way. */
UNIT_LOOP(passed_on, 1, LEAVES + 1)
{
    static struct member member[MEMBERS], before[MEMBERS];
    const unsigned n = (unsigned)_i;
    uint64_t state = 1000 + (uint64_t)_i;
    char expected[TEXT];
    for (unsigned rank = 0; rank < MEMBERS; rank++)
        member[rank].list = (struct data_subtrees){.at = member[rank].at};
    for (unsigned i = 0; i < n; i++) {
        struct member *of = &member[duite_random(&state) % MEMBERS];
        leaf(&of->values, i);
        data_subtrees_push(&of->list, (struct data_subtree){.first = i, .where = i}, combine,
                           &of->values);
    }
    for (unsigned round = 0; round < ROUNDS; round++) {
        memcpy(before, member, sizeof member);
        for (unsigned rank = 0; rank < MEMBERS; rank++) {
            struct member *from = &before[(rank + (1u << round)) % MEMBERS];
            from->list.at = from->at;
            member_take(&member[rank], from);
        }
    }
    expect(expected, 0, n);
    for (unsigned rank = 0; rank < MEMBERS; rank++) {
        ck_assert_int_eq((int)member[rank].list.n, __builtin_popcount(n));
        data_subtrees_fold(&member[rank].list, combine, &member[rank].values);
        ck_assert_str_eq(member[rank].values.text[0], expected);
    }
}

/* The list of leaves in a row is what comes of putting them in one by one; a whole tree ends with
 * the last leaf. */
UNIT_LOOP(in_a_row, 1, LEAVES + 1)
{
    struct data_subtree at[DATA_SUBTREES_IN_ROW];
    struct data_subtrees list = {.at = at};
    data_subtrees_row(&list, 3, (uint64_t)_i);
    uint64_t next = 3;
    for (size_t i = 0; i < list.n; i++) {
        ck_assert_uint_eq(at[i].first, next);
        ck_assert_uint_eq(next % (UINT64_C(1) << at[i].level), 0);
        next = data_subtree_end(&at[i], UINT64_MAX);
    }
    ck_assert_uint_eq(next, 3 + (uint64_t)_i);
    const struct data_subtree whole = data_subtree_whole((uint64_t)_i);
    ck_assert_uint_eq(whole.first, 0);
    ck_assert_uint_eq(data_subtree_end(&whole, (uint64_t)_i), (uint64_t)_i);
    ck_assert(_i < 2 || (UINT64_C(1) << (whole.level - 1)) < (uint64_t)_i);
}
