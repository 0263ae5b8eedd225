#ifndef CLOTH_VIEW_COLOURS_H
#define CLOTH_VIEW_COLOURS_H

#include "cloth/view/legend.h"
#include "cloth/view/values.h"

/* How the cloth of a folder's frames is coloured now. Local; one thread. */

struct view_colours;

/* Opens colours, first by `first`, whose scale is kept for that quantity. The caller owns cache and
 * folder, which outlive it. *colours: to be closed in any case. Errors: those of view_values_at, of
 * the first frame that has it. */
int view_colours_open(struct view_colours **colours, struct output_cache *cache, const char *folder,
                      const struct view_colouring *first, struct cloth_error *error);
/* Colours by another quantity from now on. Its default scale goes from 0 to a round number above 19
 * of 20 vertices' numbers above 0, in all frames, or in a hundred spread evenly over a long run: so
 * pictures and frames go together. Errors as before; they leave the colours as they were. */
int view_colours_pick(struct view_colours *colours, enum view_colour by, struct cloth_error *error);
enum view_colour view_colours_by(const struct view_colours *colours);
/* Finds those of a frame. position: n_vertices x 3, m. Errors as before. */
int view_colours_frame(struct view_colours *colours, uint64_t frame, const double *position,
                       struct cloth_error *error);
/* Hands them to a scene. */
void view_colours_paint(const struct view_colours *colours, struct view_scene *scene);
const struct view_legend *view_colours_legend(const struct view_colours *colours);
/* Prints the meaning of the colours, and the numbers of the frame, on standard output. */
void view_colours_say(const struct view_colours *colours);
void view_colours_close(struct view_colours *colours);

#endif
