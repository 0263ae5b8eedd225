#ifndef CLOTH_APP_VIEW_START_H
#define CLOTH_APP_VIEW_START_H

#include "cloth/output/output.h"

#include <stdbool.h>

/* A scene before it runs, as a run's folder of one frame. Local. */

/* True if the argument of the viewer is a scene: a file, or the name of a shipped one. *path: then
 * its path, to be freed, or NULL: the argument is it. */
bool view_start_is_scene(const char *argument, char **path);

/* Opens the start of a scene, of its first phase: its cloths where they start, with two more behind
 * them that mark what is pinned and what is sewn. Its warnings go to standard error. The cache is
 * closed by output_cache_close. Errors: those of scene_read, flow_prepare and output_open. */
int view_start_open(struct output_cache *cache, const char *path, struct cloth_error *error);

#endif
