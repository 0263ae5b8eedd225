#ifndef BENCH_GARMENTS_GARMENTS_H
#define BENCH_GARMENTS_GARMENTS_H

#include "bench/bench.h"

/* The parts of the bench "garments" that have a file of their own. */

/* "hanging threads=N quick=0|1 corrected=0|1": seconds of a step of hanging.yaml. */
extern const struct serve_run garments_correction_runs[];
extern const struct bench_case garments_correction;

/* "avatar": seconds that a skinned figure of 30,200 triangles in glTF and its clip of 100 frames
 * take until they are an obstacle. */
extern const struct serve_run garments_avatar_runs[];
extern const struct bench_case garments_avatar;

/* scene name=dressing|jeans|layers|walk contact=certified|repulsion threads= scheduler= quick=
 * what=: wall: seconds of all phases, without meshing; frame: of each 1/25 s of the last phase;
 * intersections: the most in a frame; the key of a count in the report. */
extern const struct serve_run garments_scene_runs[];
extern const struct bench_case garments_jeans, garments_walk, garments_intersections;

/* Makes the T-shirt as it is worn, unless it was made before, in the folder of the states. 1 after
 * a sentence on stderr. */
int garments_worn_make(const struct bench_options *options,
                       void (*say)(const char *key, const char *text));
/* look of=self|body times= ms= threads= scheduler= quick=: seconds a vertex of what a step does to
 * find contacts and to certify it: of cloth with itself, or with the body. */
extern const struct serve_run garments_worn_runs[];
extern const struct bench_case garments_worn;

#endif
