#ifndef CLOTH_VIEW_EXPORT_H
#define CLOTH_VIEW_EXPORT_H

#include "cloth/base/error.h"
#include "cloth/output/output.h"

#include <stdbool.h>
#include <stdint.h>

/* Files that other programs read, made of the frames of a folder: metres, y upwards. They hold the
 * cloth and the obstacles but for planes, which have no end. A file is written whole or not at all.
 * Local functions. Errors: of output_cache_frame; CLOTH_E_IO, CLOTH_E_MEMORY. */

/* A layer of USD as text: the meshes `cloth`, or `cloth_0`, `cloth_1` and so on, with the input's
 * polygons and uv, and `obstacles`. The points of what moves are time samples at the frames' times
 * `first` to `last`; a time code is one frame of the scene's rate. Numbers read back as the floats
 * of cloth.pc2. */
int view_export_usd(struct output_cache *cache, uint64_t first, uint64_t last, const char *path,
                    struct cloth_error *error);

/* Binary glTF 2.0 of a frame: the meshes `cloth`, of triangles with uv, and `obstacles`. */
int view_export_gltf(struct output_cache *cache, uint64_t frame, const char *path,
                     struct cloth_error *error);

/* What both need: the obstacles, and room for a frame. */
struct view_export {
    struct output_cache *cache;
    struct view_obstacles *obstacles;
    double *position; /* n_vertices x 3, m */
};
int view_export_open(struct view_export *from, struct output_cache *cache,
                     struct cloth_error *error);
/* Reads a frame, and moves the obstacles to where they are then. */
int view_export_at(struct view_export *from, uint64_t frame, struct cloth_error *error);
void view_export_close(struct view_export *from);

#endif
