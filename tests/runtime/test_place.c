/* Places in the reference order (runtime/data/version.h): paths order like their indices, also
 * where one of them does not fit and is cut off. */
#include "runtime/data/version.h"
#include "tests/support/unit.h"

#include <string.h>

enum { FULL = sizeof((struct data_failure *)0)->path };

/* `ones` children that are the first, and below them one of the given index. */
static struct data_failure place(unsigned ones, uint64_t index)
{
    struct data_failure failure = {.number = 7};
    for (unsigned i = 0; i < ones; i++)
        data_path_add(&failure, 1);
    data_path_add(&failure, index);
    return failure;
}

static const uint64_t INDICES[] = {1, 2, 0x7f, 0x80, 0xff, 0x100, 0xffff, 0x10000, UINT64_MAX};
enum { N = sizeof INDICES / sizeof *INDICES };

static bool is_whole(const struct data_failure *failure)
{
    return failure->path_length < FULL;
}

/* At every depth, of siblings of which at least one is whole. */
UNIT_LOOP(order, 0, FULL)
{
    const unsigned ones = (unsigned)_i;
    for (size_t i = 0; i < N; i++)
        for (size_t j = i + 1; j < N; j++) {
            const struct data_failure early = place(ones, INDICES[i]);
            const struct data_failure late = place(ones, INDICES[j]);
            if (!is_whole(&early) && !is_whole(&late))
                continue;
            ck_assert_ptr_eq(data_failure_first(&early, &late), &early);
            ck_assert_ptr_eq(data_failure_first(&late, &early), &early);
        }
}

UNIT_TEST(nothing_follows_what_was_cut_off)
{
    struct data_failure failure = place(FULL - 1, 0x80), before = failure;
    ck_assert_uint_eq(failure.path_length, FULL);
    data_path_add(&failure, 1);
    ck_assert_mem_eq(&failure, &before, sizeof failure);
}

UNIT_TEST(printed)
{
    char text[1024];
    struct data_failure failure = {.number = 7};
    data_path_add(&failure, 1);
    data_path_add(&failure, 0x1234);
    data_path_print(&failure, text, sizeof text);
    ck_assert_str_eq(text, "7.1.4660");
    failure = place(FULL - 1, 0x80);
    data_path_print(&failure, text, sizeof text);
    ck_assert_uint_eq(strlen(text), 1 + 2 * (FULL - 1) + 3);
    ck_assert_str_eq(text + strlen(text) - 5, ".1...");
}
