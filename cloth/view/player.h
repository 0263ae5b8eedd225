#ifndef CLOTH_VIEW_PLAYER_H
#define CLOTH_VIEW_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

/* The frame of a run that is seen at a time of day. Pure functions; now: s, any clock that goes on.
 */

struct view_player {
    uint64_t n_frames;     /* > 0 */
    double rate;           /* frames a second; > 0 */
    uint64_t frame, start; /* seen; where playing began, */
    double since;          /* s: and when */
    bool playing;
};

/* Stands at a frame of n_frames that are played at `rate` frames a second. */
void view_player_start(struct view_player *player, uint64_t n_frames, uint64_t frame, double rate);
/* The frame that is seen now. Playing ends at the last one. */
uint64_t view_player_at(struct view_player *player, double now);
/* Plays on, from the start where the last frame was seen; or stops. */
void view_player_toggle(struct view_player *player, double now);
/* Stops `by` frames farther, within those that there are. */
void view_player_step(struct view_player *player, double now, int64_t by);
/* Goes to a part of the run, 0 .. 1, and plays on from there if it played. */
void view_player_seek(struct view_player *player, double now, double part);
/* Plays `factor` times as fast; the rate stays within 0.1 and 1000 frames a second. */
void view_player_faster(struct view_player *player, double now, double factor);

#endif
