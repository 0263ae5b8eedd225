/* While it plays, the frame follows from the time alone, so that one that is slow to draw is left
 * out and the run keeps its speed. */
#include "cloth/view/player.h"

#include <math.h>

void view_player_start(struct view_player *player, uint64_t n_frames, uint64_t frame, double rate)
{
    *player = (struct view_player){.n_frames = n_frames, .rate = rate, .frame = frame};
}

uint64_t view_player_at(struct view_player *player, double now)
{
    const uint64_t last = player->n_frames - 1;
    if (!player->playing)
        return player->frame;
    const double gone = floor(fmax(now - player->since, 0) * player->rate);
    const uint64_t left = last - player->start;
    player->playing = gone < (double)left;
    player->frame = player->playing ? player->start + (uint64_t)gone : last;
    return player->frame;
}

static void play_from(struct view_player *player, double now, uint64_t frame)
{
    player->frame = player->start = frame;
    player->since = now;
}

void view_player_toggle(struct view_player *player, double now)
{
    const uint64_t frame = view_player_at(player, now);
    player->playing = !player->playing;
    play_from(player, now, player->playing && frame == player->n_frames - 1 ? 0 : frame);
}

void view_player_step(struct view_player *player, double now, int64_t by)
{
    const uint64_t frame = view_player_at(player, now), last = player->n_frames - 1;
    player->playing = false;
    if (by < 0)
        player->frame = frame > (uint64_t)-by ? frame - (uint64_t)-by : 0;
    else
        player->frame = last - frame > (uint64_t)by ? frame + (uint64_t)by : last;
}

void view_player_seek(struct view_player *player, double now, double part)
{
    const double last = (double)(player->n_frames - 1);
    play_from(player, now, (uint64_t)(fmin(fmax(part, 0), 1) * last + 0.5));
}

void view_player_faster(struct view_player *player, double now, double factor)
{
    play_from(player, now, view_player_at(player, now));
    player->rate = fmin(fmax(player->rate * factor, 0.1), 1000);
}
