#ifndef CLOTH_VIEW_COLOURS_H
#define CLOTH_VIEW_COLOURS_H

#include "cloth/view/legend.h"
#include "cloth/view/values.h"

/* How the cloth of a folder's frames is coloured now. Local; one thread. */

struct view_colours;

/* Coloured as is asked for; the scale that it names is kept for that one. cache and folder stay the
 * caller's, and outlive it. *colours: to be closed in any case. Errors: those of view_values_at, of
 * the first frame that has it. */
int view_colours_open(struct view_colours **colours, struct output_cache *cache, const char *folder,
                      const struct view_colouring *first, struct cloth_error *error);
/* Colours by something else from now on. Without a scale of its own it has one from 0 up to a round
 * number that 19 of 20 vertices above 0 are within, in all frames, or in a hundred spread evenly
 * over a long run: so pictures and frames go together. Errors, which leave the colours as they
 * were: as before. */
int view_colours_pick(struct view_colours *colours, enum view_colour by, struct cloth_error *error);
enum view_colour view_colours_by(const struct view_colours *colours);
/* Finds those of a frame. position: n_vertices x 3, m. Errors as before. */
int view_colours_frame(struct view_colours *colours, uint64_t frame, const double *position,
                       struct cloth_error *error);
/* Hands them to a scene. */
void view_colours_paint(const struct view_colours *colours, struct view_scene *scene);
const struct view_legend *view_colours_legend(const struct view_colours *colours);
/* On standard output: what they mean, and what the frame has. */
void view_colours_say(const struct view_colours *colours);
void view_colours_close(struct view_colours *colours);

#endif
