#ifndef CLOTH_APP_VIEW_FRAMES_H
#define CLOTH_APP_VIEW_FRAMES_H

#include "cloth/app/check/intersections.h"
#include "cloth/view/show.h"

/* Frames of a folder: a picture, a film, a window, and the check for intersections. Local. */

#define VIEW_LAST_FRAME UINT64_MAX

/* Opens a show (view_show_open) of a folder that has a frame, else CLOTH_E_INPUT. */
int view_frames_open(struct view_show **show, struct output_cache *cache,
                     const struct view_wish *wish, struct cloth_error *error);

/* Draws what a show has read into a PNG file, off screen. */
int view_frames_draw(struct view_show *show, const char *png, struct cloth_error *error);

/* Draws a frame, or shows it in a window. Errors: CLOTH_E_INPUT, there is no such frame; of
 * drawing; CLOTH_E_LIBRARY, this build opens no windows. */
int view_frames_picture(struct view_show *show, uint64_t frame, const char *png,
                        struct cloth_error *error);
int view_frames_window(struct view_show *show, uint64_t frame, struct cloth_error *error);

/* Draws frames into a film; says on a terminal how far it is. Errors: as above, and of
 * view_film_open. */
struct view_frames {
    const char *path;
    double fps;
    uint64_t first, last;
};
int view_frames_film(struct view_show *show, const struct view_frames *frames,
                     struct cloth_error *error);

/* Writes a file for other programs, whose ending says of which kind: .usd, .usda or .abc the frames
 * from first to last, .glb or .obj one frame. view_frames_can_export: there is such a kind. Errors:
 * as of pictures, and of cloth/view/export.h. */
bool view_frames_can_export(const char *path);
bool view_frames_exports_many(const char *path);
int view_frames_export(struct output_cache *cache, const char *folder,
                       const struct view_frames *frames, uint64_t frame, struct cloth_error *error);

/* Checks the frames from first to last, as they are written; *found is zero before. Vertices that
 * are in the same place in each frame of the folder count as one: welds. Errors: of
 * output_cache_frame, too. */
int view_frames_check(struct output_cache *cache, const char *folder,
                      const struct view_frames *frames, struct intersections_found *found,
                      struct cloth_error *error);

#endif
