/* The thread that brings frames to the disk: who waits for frames waits for those of now, not for
 * those that come meanwhile; a failure is everyone's, and nothing is settled after it. */
#include "cloth/output/settle.h"
#include "tests/support/unit.h"

#include <stdatomic.h>
#include <stdbool.h>

enum { MANY = 30000000, TROUBLE = 3 };

/* A disk that is one frame behind as long as somebody waits. */
struct slow {
    struct output_settler *settler;
    struct output_member member;
    atomic_bool stop;
    uint32_t settled;
};

static int settle_slowly(void *context, uint32_t n, struct cloth_error *error)
{
    struct slow *slow = context;
    slow->settled = n;
    if (atomic_load(&slow->stop) || n == MANY)
        return CLOTH_OK;
    return output_member_wrote(&slow->member, n + 1, error);
}

UNIT_TEST(frames_that_come_later_are_not_waited_for)
{
    struct slow slow = {.member = {.settle = settle_slowly, .context = &slow}};
    UNIT_FINE(output_settler_open(&slow.settler, &error));
    output_member_add(&slow.member, slow.settler, 0);
    UNIT_FINE(output_member_wrote(&slow.member, 1, &error));
    UNIT_FINE(output_settler_wait(slow.settler, &error));
    atomic_store(&slow.stop, true);
    UNIT_FINE(output_settler_close(&slow.settler, &error));
    ck_assert_uint_ge(slow.settled, 1);
    ck_assert_uint_lt(slow.settled, MANY);
}

/* Counts its frames; has no room for more than four. */
static int settle_four(void *context, uint32_t n, struct cloth_error *error)
{
    if (n > 4)
        return cloth_fail(error, TROUBLE, "no room");
    *(uint32_t *)context = n;
    return CLOTH_OK;
}

UNIT_TEST(a_failure_is_told_and_the_last)
{
    uint32_t counted[OUTPUT_MEMBERS] = {0};
    struct output_member member[OUTPUT_MEMBERS];
    struct output_settler *settler;
    struct cloth_error error = {0};
    ck_assert_int_eq(output_settler_open(&settler, &error), 0);
    for (int i = 0; i < OUTPUT_MEMBERS; i++) {
        member[i] = (struct output_member){.settle = settle_four, .context = &counted[i]};
        output_member_add(&member[i], settler, 0);
    }
    for (uint32_t n = 1; n <= 4; n++)
        for (int i = 0; i < OUTPUT_MEMBERS; i++)
            ck_assert_int_eq(output_member_wrote(&member[i], n, &error), 0);
    ck_assert_int_eq(output_settler_wait(settler, &error), 0);
    output_member_wrote(&member[0], 5, &error);
    ck_assert_int_eq(output_settler_wait(settler, &error), TROUBLE);
    ck_assert_int_eq(output_member_wrote(&member[1], 5, &error), TROUBLE);
    ck_assert_int_eq(output_settler_close(&settler, &error), TROUBLE);
    ck_assert_str_eq(error.text, "no room");
    ck_assert_uint_eq(counted[0], 4);
    ck_assert_uint_eq(counted[1], 4);
}
