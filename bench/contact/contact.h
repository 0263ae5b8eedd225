#ifndef BENCH_CONTACT_CONTACT_H
#define BENCH_CONTACT_CONTACT_H

#include "bench/bench.h"

/* The bench "contact": what finding and certifying contacts costs. bench.c has the plans; a file a
 * case has what our process runs for it. */

/* certify pairs=: seconds a pair of contact_certify. uncut pairs=: the share of them that passes.
 * Pairs are drawn: half of each kind, mixed; corners in a cube of 10 mm; they move by up to 2 mm
 * along each axis together and by up to 2 mm each. The thickness is 1 mm. */
extern const struct serve_run contact_certify_runs[];

/* sphere triangles=, box triangles=: seconds a triangle of contact_solid_pass. Triangles of about
 * 5 mm lie 1 to 3 mm from the shape and go up to 0.2 mm along each axis. */
extern const struct serve_run contact_solid_runs[];

/* detect shape=waves|draped|six_layers threads= quick= rounds=: seconds a vertex of the best of so
 * many steps. */
extern const struct serve_run contact_detect_runs[];

#endif
