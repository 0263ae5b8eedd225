#ifndef BENCH_CONTACT_CONTACT_H
#define BENCH_CONTACT_CONTACT_H

#include "bench/bench.h"
#include "cloth/model/model.h"

/* The bench "contact": the cost of finding and certifying contacts, and of runs of scenes. bench.c
 * and plans.c have the plans; the other files have what our process runs for them. */

/* certify pairs=: seconds a pair of contact_pass_all. uncut pairs=: the share of them that passes.
 * Pairs are drawn: half of each kind, mixed; corners in a cube of 10 mm; they move by up to 2 mm
 * along each axis together and by up to 2 mm each. The thickness is 1 mm. */
extern const struct serve_run contact_certify_runs[];

/* sphere triangles=, box triangles=: seconds a triangle of contact_solid_pass. Triangles of about
 * 5 mm lie 1 to 3 mm from the shape and go up to 0.2 mm along each axis. */
extern const struct serve_run contact_solid_runs[];

/* detect shape=waves|draped|six_layers threads= quick= rounds=: seconds a vertex of the best of so
 * many steps. */
extern const struct serve_run contact_detect_runs[];

/* map threads= quick= rounds=: seconds to draw the maps of a ring. look_up threads= quick= rounds=:
 * seconds a vertex to look one up there. The best of so many rounds each. */
extern const struct serve_run contact_map_runs[];

/* Runs work(context) on so many threads, this one among them. 0, or what serve_fail returns. */
int contact_on_threads(unsigned threads, void *(*work)(void *context), void *context);

/* ---- Scenes ---- */

/* Reads a scene of the bench by its name, to the end of the part that the bench runs. self: "on"
 * or "off" with certified contact, or "" for what the file says. quick: a tiny one. The model
 * belongs to the caller, also after a failure. 0, or what serve_fail returns. */
int contact_scene_read(struct model *model, const char *name, const char *self, bool quick);

/* scene name= self= balance= threads= scheduler= quick= what=: a run tells what=wall: seconds of
 * all steps; frame: seconds for each 1 / fps that was simulated; step: for each step that was made;
 * intersections: the most in a frame; contacts: the most at a time; solves, iterations, queries (of
 * two sides), pairs (certified): for each step that was made; halved: steps; cuts: of vertices;
 * pinches: contacts; force, force_early: N, upwards on the obstacle of the last probe, at the end
 * and after a second; moved: tasks and objects that went to other ranks; memory: the most bytes of
 * the process. */
extern const struct serve_run contact_scene_runs[];

/* The sphere's sheet after ms= of its run, kept by threads= and quick=. look times=: seconds of the
 * contact part of a step, without its solves: boxes, certificates, what is near, and the rows of
 * the contacts. iterations contacts=0|1: those of the next step's solve. */
extern const struct serve_run contact_state_runs[];
/* The same of any scene, which `read` reads by the request's word of=. rows: with the rows of the
 * contacts. *n: how many there are. Also kept. 0, or what serve_fail returns. */
typedef int contact_state_reader(struct model *model, struct serve_request *request);
int contact_state_look(struct serve_request *request, contact_state_reader *read, bool rows,
                       double *seconds, uint64_t *n);
/* Ends what the runs above have left. 1 if the runtime did not stop well. Collective. */
int contact_state_end(void);

/* blender threads= quick=: seconds a frame of the sphere's sheet as Blender simulates it. */
extern const struct serve_run contact_blender_runs[];

/* instructions contact=0|1 steps=: of a step of a scene without anything to touch, without and with
 * a map `contact`. */
extern const struct serve_run contact_instruction_runs[];

/* ---- Plans ---- */

/* Plans the intersections and the counts of a scene, and returns what=: wall, frame or step. */
const struct measure_series *contact_plan_scene(struct measure *measure,
                                                const struct bench_options *options,
                                                const char *name, const char *what);

enum { CONTACT_PEERS = 7 }; /* scenes that others published */
extern const struct bench_case contact_self, contact_frames_sphere, contact_frames_stack,
    contact_part, contact_iterations, contact_twist, contact_instructions, contact_intersections,
    contact_maps, contact_peers[CONTACT_PEERS], contact_ring, contact_pinch, contact_memory;

#endif
