#ifndef CLOTH_OUTPUT_FILES_OBSTACLES_H
#define CLOTH_OUTPUT_FILES_OBSTACLES_H

#include "cloth/contact/shape.h"
#include "cloth/output/files/json.h"
#include "cloth/output/output.h"

/* Obstacles in scene.json: a list of {KIND: {its parameters}}, and of what moves also "about" and
 * "keys": [{"time", "translate", "rotate"}]. */

/* Writes the list. keys: of all motions. */
void output_obstacles(FILE *file, size_t n, const struct contact_shape *obstacles,
                      const struct phys_key *keys);

/* Reads it; what it allocates belongs to the cache, also after a failure. */
void output_obstacles_read(struct output_cache *cache, struct output_json *json);

#endif
