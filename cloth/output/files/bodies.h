#ifndef CLOTH_OUTPUT_FILES_BODIES_H
#define CLOTH_OUTPUT_FILES_BODIES_H

#include "cloth/output/output.h"

/* The meshes of bodies in a folder of frames: body-K.obj, K from 0; bodies are numbered from 1.
 * Local functions; errors as of output_open. */

/* Writes each beside where it belongs, with the ending ".part". */
int output_bodies_write(const char *folder, const struct contact_bodies *bodies,
                        struct cloth_error *error);
/* Removes what it wrote, after a failure too. */
void output_bodies_drop(const char *folder, uint32_t n);

/* They replace those of an earlier run, which had n_before: the others of it are removed. */
int output_bodies_replace(const char *folder, uint32_t n, uint32_t n_before,
                          struct cloth_error *error);

#endif
