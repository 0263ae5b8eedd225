#ifndef CLOTH_VIEW_EXPORT_H
#define CLOTH_VIEW_EXPORT_H

#include "cloth/base/error.h"
#include "cloth/output/output.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Files that other programs read, made of the frames of a folder: metres, y upwards. They hold the
 * cloth and the obstacles but for planes, which have no end. A file is written whole or not at all.
 * Local functions. Errors: of output_cache_frame; CLOTH_E_IO, CLOTH_E_MEMORY. */

/* A layer of USD as text: the meshes `cloth`, or `cloth_0`, `cloth_1` and so on, with the input's
 * polygons and uv, and `obstacles`. The points of what moves are time samples at the frames' times
 * `first` to `last`; a time code is one frame of the scene's rate. Numbers read back as the floats
 * of cloth.pc2. */
int view_export_usd(struct output_cache *cache, uint64_t first, uint64_t last, const char *path,
                    struct cloth_error *error);

/* The same meshes as a cache of Alembic: polygons that turn clockwise, as its readers want, uv with
 * numbers, boxes; points are floats at the frames' times. The path is no pipe: CLOTH_E_INPUT. */
int view_export_abc(struct output_cache *cache, uint64_t first, uint64_t last, const char *path,
                    struct cloth_error *error);

/* Binary glTF 2.0 of a frame: the meshes `cloth`, of triangles with uv, and `obstacles`. */
int view_export_gltf(struct output_cache *cache, uint64_t frame, const char *path,
                     struct cloth_error *error);

/* The writers share the obstacles, and room for a frame. */
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

/* A cloth among those of all. */
struct view_export_cloth {
    uint32_t n;    /* with those before */
    char name[32]; /* cloth, or cloth_0 and so on */
    uint32_t first, end, first_face, end_face;
};
/* Goes on to the next cloth, from a zeroed one to the first; false: there is no further one. */
bool view_export_next(const struct output_cache *cache, struct view_export_cloth *cloth);
/* True if an obstacle moves or changes its shape in some frame. */
bool view_export_moves(const struct output_cache *cache);

/* Writes a number's four bytes, little-endian. */
void view_export_u32(FILE *file, uint32_t value);

#endif
