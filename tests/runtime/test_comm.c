/* Parts of the communication that need no other rank: the reason why it broke, the tags of plans,
 * and results of tasks on other ranks. */
#include "runtime/comm/internal.h"
#include "tests/support/unit.h"

#include <stdlib.h>

UNIT_TEST(the_first_reason_counts)
{
    struct comm comm = {.silent = true};
    comm_break(&comm, DUITE_E_MEMORY, "no memory");
    comm_break(&comm, DUITE_E_LOST, "rank 1 is lost");
    ck_assert_int_eq(comm_error(&comm), DUITE_E_MEMORY);
    ck_assert_str_eq(duite_message(), "no memory");
    ck_assert(comm_is_lost(&comm));
}

enum { N_TAGS = 3 };

static int take_tags(struct comm_tags *tags)
{
    int first = 0;
    ck_assert_int_eq(comm_tags_take(tags, N_TAGS, &first), DUITE_OK);
    return first;
}

/* A plan that the program dropped may still run on another rank. */
UNIT_TEST(dropped_tags_wait_until_the_ranks_meet)
{
    static struct comm comm;
    struct comm_tags *tags = &comm.channels.tags;
    tags->next = COMM_CHANNELS;
    tags->last = COMM_CHANNELS + 5 * N_TAGS;
    const int held = take_tags(tags), dropped = take_tags(tags);
    comm_channels_met(&comm);
    comm_tags_drop(tags, dropped); /* above the next one */
    ck_assert_uint_eq(comm_tags_held(tags), 1);
    const int other = take_tags(tags);
    ck_assert_int_eq(other, dropped + N_TAGS);
    comm_tags_drop(tags, held); /* below it */
    ck_assert_int_eq(take_tags(tags), other + N_TAGS);
    comm_channels_met(&comm);
    ck_assert_int_eq(take_tags(tags), held);
    ck_assert_int_eq(take_tags(tags), dropped);
    ck_assert_int_eq(take_tags(tags), other + 2 * N_TAGS);
    free(tags->range);
}

/* A result that names no task, or one that has its result already, is refused and counted. */
UNIT_TEST(a_result_is_taken_once)
{
    struct comm_arrivals arrivals;
    struct comm_target target, task = {.what = &arrivals, .result = true};
    struct data_packet *early, *result = data_packet_new(0, true);
    comm_arrivals_start(&arrivals);
    result->kind = DATA_RESULT;
    result->key.number = 7;
    ck_assert_int_eq(comm_arrivals_take(&arrivals, result, &target), COMM_REFUSED);
    ck_assert(comm_arrivals_expect(&arrivals, result->key, task, 1, &early) && !early);
    ck_assert_uint_eq(arrivals.gauge.awaited, 0);
    ck_assert_int_eq(comm_arrivals_take(&arrivals, result, &target), COMM_WANTED);
    ck_assert_ptr_eq(target.what, &arrivals);
    ck_assert_int_eq(comm_arrivals_take(&arrivals, result, &target), COMM_REFUSED);
    ck_assert(comm_arrivals_expect(&arrivals, result->key, task, 1, &early));
    ck_assert(comm_arrivals_close(&arrivals, &target) && !comm_arrivals_close(&arrivals, &target));
    ck_assert(!comm_arrivals_expect(&arrivals, result->key, task, 1, &early));
    ck_assert_int_eq(comm_arrivals_take(&arrivals, result, &target), COMM_REFUSED);
    ck_assert_uint_eq(arrivals.refused, 2);
    data_packet_free(result);
    comm_arrivals_stop(&arrivals);
}
