#ifndef CLOTH_OUTPUT_FILES_SCENE_H
#define CLOTH_OUTPUT_FILES_SCENE_H

#include "cloth/output/output.h"

/* The files of a folder as a run begins it, and those that do not change from frame to frame:
 * scene.json (output.h says what it has), cloth.obj, the meshes of bodies. Local functions. */

/* The files of a body, by its number from 0: the mesh, and the shapes if they change. */
#define OUTPUT_BODY_OBJ "body-%u.obj"
#define OUTPUT_BODY_PC2 "body-%u.pc2"

/* Fills scene.json, or the start as a Wavefront OBJ; what: the struct output_setup. */
int output_fill_scene(FILE *file, const void *what);
int output_fill_obj(FILE *file, const void *what);

#define OUTPUT_INDEX_HEADER "frame,time\n" /* begins frames.csv */

/* Makes the files of a new run in its folder, which is there, in place of those of an earlier run;
 * they have no frames. Errors as of output_open. */
int output_begin(const struct output_setup *setup, uint32_t n_points, struct cloth_error *error);

/* The number of bodies in a folder's scene.json; 0 without one that can be read. */
uint32_t output_bodies_before(const char *folder);

#endif
