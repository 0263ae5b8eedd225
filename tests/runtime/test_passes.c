/* Each pass of the compiler of recorded graphs, on rounds made by hand, against its output worked
 * out by hand. */
#include "runtime/base/rank_set.h"
#include "tests/runtime/rounds.h"
#include "tests/support/unit.h"

/* ---- Lower ---- */

static void lowered(const char *objects, const char *forks, uint32_t flag, const char *expected)
{
    struct rounds_made made;
    UNIT_OWNED(plan_round_free) struct plan_round round = {0};
    rounds_make(&made, objects, forks);
    made.source.flag = flag;
    ck_assert(plan_lower(&round, &made.source));
    ck_assert_str_eq(rounds_nodes(&round), expected);
}

UNIT_TEST(lower_forks)
{
    lowered("8 8", "w0; r0 u1; =0; ;", PLAN_NONE, "task(w0) task(r0 u1) set(w0) task()");
    lowered("8 8", "w0; r1;", 1, "task(w0) task(r1) flag(r1)");
    lowered("8", "", PLAN_NONE, "");
}

/* The first other access ends contributions, another law does, and the round. */
UNIT_TEST(lower_sums)
{
    lowered("8 8", "c0; c0; r0;", PLAN_NONE, "task(w2) task(w3) sum(u0 r2 r3 | 1+2) task(r0)");
    lowered("8", "c0; C0;", PLAN_NONE, "task(w1) sum(u0 r1) task(w2) sum(u0 r2)");
    lowered("8 8", "c1; c0; c1;", PLAN_NONE,
            "task(w2) task(w3) task(w4) sum(u0 r3) sum(u1 r2 r4 | 1+2)");
}

/* Six leaves: (1 2)(3 4) and (5 6), folded from the right. */
UNIT_TEST(lower_trees)
{
    lowered("8", "c0; c0; c0; c0; c0; c0;", PLAN_NONE,
            "task(w1) task(w2) task(w3) task(w4) task(w5) task(w6) "
            "sum(u0 r1 r2 r3 r4 r5 r6 | 1+2 3+4 1+3 5+6 1+5)");
    lowered("8", "c0; c0; c0;", PLAN_NONE, "task(w1) task(w2) task(w3) sum(u0 r1 r2 r3 | 1+2 1+3)");
}

/* ---- Edges ---- */

static void edged(const char *objects, const char *forks, uint32_t flag, const char *expected)
{
    struct rounds_made made;
    UNIT_OWNED(plan_round_free) struct plan_round round = {0};
    rounds_make(&made, objects, forks);
    made.source.flag = flag;
    ck_assert(plan_lower(&round, &made.source) && plan_edges(&round));
    ck_assert_str_eq(rounds_edges(&round), expected);
}

UNIT_TEST(edges_within_and_between)
{
    edged("8", "w0; r0; r0;", PLAN_NONE, "0>1 0>2 2~>0 1~>0");
    edged("8 8", "w0; w0; r0;", PLAN_NONE, "0>1 1>2 2~>0");
    edged("8 8", "u0; u1;", PLAN_NONE, "0~>0 1~>1");
    edged("8 8", "r0; r1;", PLAN_NONE, "0~>0 1~>1");
}

/* Two uses of one place by two nodes give one edge; the deciding node joins all roots. */
UNIT_TEST(edges_of_flags)
{
    edged("8 8", "w0 w1; r0 r1;", PLAN_NONE, "0>1 1~>0");
    edged("8 8", "w0; w1;", 0, "0>2 1>2 2~>0 1~>1 2~>1");
}

/* ---- Assign, messages, part ---- */

struct assigned {
    struct rounds_made made;
    struct plan_round round;
    struct plan_assignment assignment;
    struct plan_messages messages;
};

static void assign(struct assigned *s, const char *objects, const char *forks, const int *home,
                   int n_ranks)
{
    rounds_make(&s->made, objects, forks);
    s->round = (struct plan_round){0};
    ck_assert(plan_lower(&s->round, &s->made.source));
    ck_assert(plan_assign(&s->assignment, &s->round, home, n_ranks));
    ck_assert(plan_messages_find(&s->messages, &s->assignment, PLAN_ALL));
}

static void assigned_free(struct assigned *s)
{
    plan_messages_free(&s->messages);
    plan_assignment_free(&s->assignment);
    plan_round_free(&s->round);
}

static void part_is(const struct assigned *s, int rank, const char *expected)
{
    UNIT_OWNED(plan_messages_free) struct plan_messages messages;
    UNIT_OWNED(plan_round_free) struct plan_round part = {0};
    ck_assert(plan_messages_find(&messages, &s->assignment, rank) && plan_part(&part, &messages));
    ck_assert_str_eq(rounds_nodes(&part), expected);
}

/* A halo: each rank reads what the other one wrote in the round before. Version 2 and 3 leave. */
UNIT_TEST(exchange)
{
    UNIT_OWNED(assigned_free) struct assigned s;
    assign(&s, "8 8 8 8", "r0 r1 w2; r0 r1 w3; r2 w0; r3 w1;", (const int[]){0, 1, 0, 1}, 2);
    ck_assert_str_eq(rounds_ranks(&s.assignment), "0 1 0 1");
    ck_assert_str_eq(rounds_needs(&s.assignment), "0:01 1:01 4:0 5:1");
    ck_assert_str_eq(rounds_phases(&s.messages), "1 1 1 1");
    ck_assert_str_eq(rounds_messages(&s.messages), "0>1 in 0: v0; 1>0 in 0: v1");
    part_is(&s, 0, "receive from 1 in 0(w4) send to 1 in 0(r0) task(r0 r4 w2) task(r2 w0)");
    part_is(&s, 1, "receive from 0 in 0(w4) send to 0 in 0(r1) task(r4 r1 w3) task(r3 w1)");
}

/* A replicated task and a set run where they are read; one that nobody reads at home, or, if it is
 * overwritten, nowhere. */
UNIT_TEST(assign_where_read)
{
    UNIT_OWNED(assigned_free) struct assigned s;
    assign(&s, "8 8 8", "R w0; r0 w1; @2 r0; =2; =2;", (const int[]){0, 1, 1}, 3);
    ck_assert_str_eq(rounds_ranks(&s.assignment), "12 1 2 - 1");
    ck_assert_str_eq(rounds_messages(&s.messages), "");
}

/* A small sum is added by all who read it, a large one at the home. */
UNIT_TEST(assign_sums)
{
    struct assigned s;
    assign(&s, "8 8 8", "r1 c0; r2 c0; r0 u1; r0 u2;", (const int[]){0, 0, 1}, 2);
    ck_assert_str_eq(rounds_ranks(&s.assignment), "0 1 01 0 1");
    ck_assert_str_eq(rounds_phases(&s.messages), "0 0 1 1 1");
    ck_assert_str_eq(rounds_messages(&s.messages), "0>1 in 0: p0; 1>0 in 0: p1");
    part_is(&s, 0,
            "receive from 1 in 0(w3) task(r1 w4) send to 1 in 0(r4) sum(u0 u4 u3 | 1+2) "
            "task(r0 u1)");
    assigned_free(&s);
    assign(&s, "4096 8 8", "r1 c0; r2 c0; r0 u1; r0 u2;", (const int[]){0, 0, 1}, 2);
    ck_assert_str_eq(rounds_ranks(&s.assignment), "0 1 0 0 1");
    ck_assert_str_eq(rounds_phases(&s.messages), "0 0 1 1 2");
    ck_assert_str_eq(rounds_messages(&s.messages), "1>0 in 0: p1; 0>1 in 1: v3");
    assigned_free(&s);
}

/* Five ranks have a leaf each, and all add up: in three rounds each sends one message to the rank
 * 1, 2 and 4 places before it. Halves combine on the way; what the other one has is not sent again.
 */
UNIT_TEST(sums_by_rounds)
{
    UNIT_OWNED(assigned_free) struct assigned s;
    assign(&s, "8 8 8 8 8 8",
           "r1 c0; r2 c0; r3 c0; r4 c0; r5 c0; r0 u1; r0 u2; r0 u3; r0 u4; r0 u5;",
           (const int[]){0, 0, 1, 2, 3, 4}, 5);
    ck_assert_str_eq(rounds_phases(&s.messages), "0 0 0 0 0 3 3 3 3 3 3");
    ck_assert_str_eq(rounds_messages(&s.messages),
                     "1>0 in 0: 1+1; 2>1 in 0: 2+1; 3>2 in 0: 3+1; 4>3 in 0: 4+1; 0>4 in 0: 0+1; "
                     "2>0 in 1: 2+2; 3>1 in 1: 3+1 4+1; 4>2 in 1: 0+1 4+1; 0>3 in 1: 0+2; "
                     "1>4 in 1: 1+1 2+1; "
                     "4>0 in 2: 4+1; 0>1 in 2: 0+4; 1>2 in 2: 1+1; 2>3 in 2: 2+2; 3>4 in 2: 3+1");
    part_is(&s, 0,
            "receive from 1 in 0(w6) receive from 2 in 1(w7) receive from 4 in 2(w8) "
            "task(r1 w9) send to 4 in 0(r9) partial(u9 u6 | 0+1) send to 3 in 1(r9) "
            "partial(u9 u7 | 0+1) send to 1 in 2(r9) sum(u0 u9 u8 | 1+2) task(r0 u1)");
}

/* What one of five ranks makes and all read goes on from those that have it; the value of the round
 * before does, too. */
UNIT_TEST(values_by_rounds)
{
    struct assigned s;
    assign(&s, "8 8 8 8 8 8", "w0; r0 u1; r0 u2; r0 u3; r0 u4; r0 u5;",
           (const int[]){2, 0, 1, 2, 3, 4}, 5);
    ck_assert_str_eq(rounds_phases(&s.messages), "0 3 3 0 3 3");
    ck_assert_str_eq(rounds_messages(&s.messages),
                     "2>1 in 0: v6; 2>0 in 1: v6; 1>4 in 1: v6; 2>3 in 2: v6");
    part_is(&s, 1, "receive from 2 in 0(w6) send to 4 in 1(r6) task(r6 u2)");
    assigned_free(&s);
    assign(&s, "8 8 8 8 8 8", "r0 u1; r0 u2; r0 u3; r0 u4; r0 u5; w0;",
           (const int[]){2, 0, 1, 2, 3, 4}, 5);
    ck_assert_str_eq(rounds_messages(&s.messages),
                     "2>1 in 0: v0; 2>0 in 1: v0; 1>4 in 1: v0; 2>3 in 2: v0");
    assigned_free(&s);
}

/* A rank combines what it has alone before it sends. */
/* Values of up to four ranks, or of half of them, go directly. */
UNIT_TEST(values_by_rounds_of_many)
{
    static const struct {
        int n_ranks, readers;
        uint32_t rounds;
    } all[] = {{4, 3, 0}, {5, 3, 0}, {5, 4, 3}, {8, 4, 3}, {16, 7, 0}, {16, 8, 4}, {64, 31, 0}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        uint64_t set[2] = {0};
        int ring[64];
        size_t n = 0;
        for (int rank = 1; rank <= all[i].readers; rank++)
            base_ranks_add(set, rank);
        ck_assert_uint_eq(plan_relay_ring(set, all[i].n_ranks, 0, ring, &n), all[i].rounds);
        ck_assert_uint_eq(n, all[i].rounds ? (size_t)all[i].readers + 1 : 0);
    }
}

UNIT_TEST(part_of_pieces)
{
    UNIT_OWNED(assigned_free) struct assigned s;
    assign(&s, "4096 8 8", "r1 c0; r1 c0; r2 c0; r2 c0; r2 c0; r0 u1;", (const int[]){0, 0, 1}, 2);
    ck_assert_uint_eq(s.messages.n_pieces, 3);
    ck_assert_str_eq(rounds_messages(&s.messages), "1>0 in 0: p1 p2");
    part_is(&s, 1,
            "task(r2 w3) task(r2 w4) task(r2 w5) partial(u3 u4 | 0+1) send to 0 in 0(r3 r5)");
    part_is(&s, 0,
            "receive from 1 in 0(w3 w4) task(r1 w5) task(r1 w6) partial(u5 u6 | 0+1) "
            "sum(u0 u5 u3 u4 | 1+2 1+3) task(r0 u1)");
}

/* What is overwritten before its message can go is copied aside; what is written on from a message
 * is brought home first. */
UNIT_TEST(part_copies)
{
    struct assigned s;
    assign(&s, "8 8 8", "w0; @1 r0 w1; u0; @1 r0 w2; w0;", (const int[]){0, 1, 1}, 2);
    ck_assert_str_eq(rounds_messages(&s.messages), "0>1 in 0: v3 v5");
    part_is(&s, 0, "task(w0) copy(r0 w3) task(u0) send to 1 in 0(r3 r0) task(w0)");
    part_is(&s, 1, "receive from 0 in 0(w3 w4) task(r3 w1) task(r4 w2)");
    assigned_free(&s);
    assign(&s, "8 8", "w0; @1 u0; r0 w1;", (const int[]){0, 0}, 2);
    part_is(&s, 1, "receive from 0 in 0(w2) copy(r2 w0) task(u0) send to 0 in 1(r0)");
    assigned_free(&s);
}

/* What waits for a message goes in a later phase, so that no two messages wait for each other. */
UNIT_TEST(phases)
{
    UNIT_OWNED(assigned_free) struct assigned s;
    assign(&s, "8 8 8", "w0; @1 r0 w1; @2 r1 w2; @0 r2;", (const int[]){0, 1, 2}, 3);
    ck_assert_str_eq(rounds_phases(&s.messages), "0 1 2 3");
    ck_assert_str_eq(rounds_messages(&s.messages), "0>1 in 0: v3; 1>2 in 1: v4; 2>0 in 2: v5");
}
