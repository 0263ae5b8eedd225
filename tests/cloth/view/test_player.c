/* Which frame is seen when: by the clock alone. */
#include "cloth/view/player.h"
#include "tests/support/unit.h"

static struct view_player player;

static void start(uint64_t n, uint64_t frame)
{
    view_player_start(&player, n, frame, 25);
}

UNIT_TEST(stands_until_it_plays)
{
    start(50, 7);
    ck_assert_uint_eq(view_player_at(&player, 1), 7);
    ck_assert_uint_eq(view_player_at(&player, 100), 7);
    ck_assert(!player.playing);
}

UNIT_TEST(plays_by_the_clock)
{
    start(50, 7);
    view_player_toggle(&player, 10);
    for (int i = 0; i < 42; i++)
        ck_assert_uint_eq(view_player_at(&player, 10 + (i + 0.5) / 25), 7U + (unsigned)i);
    ck_assert_uint_eq(view_player_at(&player, 99), 49);
    ck_assert_msg(!player.playing, "playing ends at the last frame");
}

UNIT_TEST(pauses_and_goes_on)
{
    start(50, 0);
    view_player_toggle(&player, 0);
    view_player_toggle(&player, 0.5);
    ck_assert_uint_eq(view_player_at(&player, 9), 12);
    view_player_toggle(&player, 9);
    ck_assert_uint_eq(view_player_at(&player, 9.5), 24);
}

UNIT_TEST(plays_again_from_the_first_at_the_last)
{
    start(50, 49);
    view_player_toggle(&player, 3);
    ck_assert_uint_eq(view_player_at(&player, 3), 0);
    ck_assert(player.playing);
}

UNIT_TEST(steps_stop_within_the_run)
{
    start(50, 45);
    view_player_toggle(&player, 0);
    view_player_step(&player, 0.05, 1);
    ck_assert_uint_eq(view_player_at(&player, 7), 47);
    ck_assert(!player.playing);
    view_player_step(&player, 7, 10);
    ck_assert_uint_eq(view_player_at(&player, 7), 49);
    view_player_step(&player, 7, -10);
    ck_assert_uint_eq(view_player_at(&player, 7), 39);
    view_player_step(&player, 7, -100);
    ck_assert_uint_eq(view_player_at(&player, 7), 0);
}

UNIT_TEST(seeks_and_plays_on)
{
    start(101, 0);
    view_player_seek(&player, 0, 0.5);
    ck_assert_uint_eq(view_player_at(&player, 5), 50);
    view_player_toggle(&player, 5);
    view_player_seek(&player, 6, 0.1);
    ck_assert_uint_eq(view_player_at(&player, 6), 10);
    ck_assert_uint_eq(view_player_at(&player, 7.01), 35);
    view_player_seek(&player, 8, 2);
    ck_assert_uint_eq(view_player_at(&player, 8), 100);
}

UNIT_TEST(speed_changes_where_it_is)
{
    start(1000, 0);
    view_player_toggle(&player, 0);
    view_player_faster(&player, 2.01, 2);
    ck_assert_uint_eq(view_player_at(&player, 2.02), 50);
    ck_assert_uint_eq(view_player_at(&player, 3.02), 100);
    view_player_faster(&player, 3.02, 1e9);
    ck_assert_double_eq(player.rate, 1000);
    view_player_faster(&player, 3.02, 1e-9);
    ck_assert_double_eq(player.rate, 0.1);
}

UNIT_TEST(a_single_frame_is_all)
{
    start(1, 0);
    view_player_toggle(&player, 0);
    ck_assert_uint_eq(view_player_at(&player, 1), 0);
    view_player_seek(&player, 1, 1);
    ck_assert_uint_eq(view_player_at(&player, 2), 0);
}
