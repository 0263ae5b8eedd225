#ifndef CLOTH_OUTPUT_FILES_OBSTACLES_H
#define CLOTH_OUTPUT_FILES_OBSTACLES_H

#include "cloth/contact/shape.h"
#include "cloth/output/files/json.h"
#include "cloth/output/output.h"

/* Obstacles in scene.json: a list of {KIND: {its parameters}}, of bodies {"obj": FILE}, with
 * "pc2": FILE where its shape changes, and of what moves also "about" and "keys": [{"time",
 * "translate", "rotate"}]. */

/* The name of the file of a body, by number from 1, with a suffix. */
enum { OUTPUT_BODY_NAME = 40 };
void output_body_name(char name[OUTPUT_BODY_NAME], uint32_t number, const char *suffix);
/* That of its shapes. */
void output_pose_name(char name[OUTPUT_BODY_NAME], uint32_t number);

/* Writes the list. keys: of all motions; posed: by body, whether its shape changes; NULL: none's.
 */
void output_obstacles(FILE *file, size_t n, const struct contact_shape *obstacles,
                      const struct phys_key *keys, const bool *posed);

/* Reads it but for the bodies; what it allocates belongs to the cache, also after a failure. */
void output_obstacles_read(struct output_cache *cache, struct output_json *json);

/* What does not meet (output.h); cloths and pairs once each. Reading: as obstacles are; the arrays
 * belong to the cache. n_obstacles: of the list, which is there already. */
void output_apart(FILE *file, const struct contact_apart *apart);
void output_apart_read(struct output_cache *cache, struct output_json *json);
/* The same of what pins attach. */
void output_attached(FILE *file, size_t n_obstacles, const struct contact_apart *apart);
void output_attached_read(struct output_cache *cache, struct output_json *json);
/* The same of what pulled seams join. */
void output_sewn(FILE *file, const struct contact_apart *apart);
void output_sewn_read(struct output_cache *cache, struct output_json *json);

/* How many bodies the scene.json of a folder names; 0 where there is none that can be read. */
uint32_t output_bodies_before(const char *folder);

#endif
