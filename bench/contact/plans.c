/* Cases that run scenes, or a state of one, and their measures. Runs are long: the first of a case
 * counts, too, where it says `cold`. */
#include "bench/contact/contact.h"

#include "cloth/base/order.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Intersections that the cases so far have found; NAN: none of them looked for any. */
static double all_intersections = NAN;

static double note_intersections(const struct measure_metric *metric, size_t round)
{
    const double sum = measure_sum(metric, round);
    all_intersections = isnan(all_intersections) ? sum : all_intersections + sum;
    return sum;
}

static void measure_intersections(struct measure *measure, const char *name,
                                  const struct measure_series *found)
{
    struct measure_metric *metric =
        measure_metric(measure, "pairs", note_intersections, "intersections_%s", name);
    metric->of = found;
}

static struct measure_series *scene(struct measure *measure, const struct bench_options *options,
                                    unsigned ranks, const char *settings, const char *what)
{
    const unsigned threads = ranks ? 1 : options->threads;
    return measure_series(measure, (struct subject_shape){"duite", ranks, threads},
                          "scene %s threads=%u scheduler=%s quick=%d%s what=%s", settings, threads,
                          options->scheduler, options->quick,
                          strstr(settings, "balance=") ? "" : " balance=none", what);
}

/* Counts of a run, which are the same on all machines and from run to run. */
static const struct {
    const char *what, *unit, *name;
} COUNTS[] = {{"solves", "solves", "solves_per_step"},
              {"iterations", "iterations", "iterations_per_step"},
              {"halved", "steps", "steps_halved"},
              {"contacts", "contacts", "contacts"},
              {"cuts", "cuts", "cuts"},
              {"queries", "queries", "queries_per_step"},
              {"pairs", "pairs", "pairs_per_step"},
              {"pinches", "contacts", "pinches"}};
enum { N_COUNTS = sizeof COUNTS / sizeof *COUNTS };

const struct measure_series *contact_plan_scene(struct measure *measure,
                                                const struct bench_options *options,
                                                const char *name, const char *what)
{
    char settings[40];
    snprintf(settings, sizeof settings, "name=%s", name);
    const struct measure_series *time = scene(measure, options, 0, settings, what);
    const struct measure_series *found = scene(measure, options, 0, settings, "intersections");
    measure_intersections(measure, name, found);
    for (int i = 0; i < N_COUNTS; i++)
        measure_value(measure, scene(measure, options, 0, settings, COUNTS[i].what), 1,
                      COUNTS[i].unit, "%s_%s", name, COUNTS[i].name);
    return time;
}

/* ---- Cloth with itself, on and off ---- */

static void plan_self(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *on = scene(measure, options, 0, "name=sheet self=on", "wall");
    const struct measure_series *off = scene(measure, options, 0, "name=sheet self=off", "wall");
    const struct measure_series *found =
        scene(measure, options, 0, "name=sheet self=on", "intersections");
    measure->cold = true;
    measure_value(measure, on, 1, "s", "self_on_seconds");
    measure_ratio(measure, on, off, "self_on_vs_off");
    measure_intersections(measure, "sheet", found);
}

const struct bench_case contact_self = {
    "self",
    "sheet.yaml, all 0.48 s, certified contact of the cloth with itself and the floor against "
    "contact with the floor alone",
    plan_self, contact_scene_runs, 2};

/* ---- Frames ---- */

static void plan_sphere(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *ours = contact_plan_scene(measure, options, "sphere", "frame");
    const struct measure_series *rival =
        measure_series(measure, (struct subject_shape){"blender", 0, options->threads},
                       "blender threads=%u quick=%d", options->threads, options->quick);
    measure->cold = true;
    measure_value(measure, ours, 1, "s", "sphere_seconds_per_frame");
    measure_value(measure, rival, 1, "s", "sphere_blender_seconds_per_frame");
    measure_ratio(measure, ours, rival, "sphere_vs_blender");
}

const struct bench_case contact_frames_sphere = {
    "frames_sphere", "seconds for each 1/25 s of sphere.yaml until 0.6 s, in steps of 8 ms",
    plan_sphere, contact_scene_runs, 2};

static void plan_stack(struct measure *measure, const struct bench_options *options)
{
    measure->cold = true;
    measure_value(measure, contact_plan_scene(measure, options, "stack", "frame"), 1, "s",
                  "stack_seconds_per_frame");
}

const struct bench_case contact_frames_stack = {
    "frames_stack", "seconds for each 1/25 s of stack.yaml until 0.2 s, in steps of 8 ms",
    plan_stack, contact_scene_runs, 2};

/* ---- Scenes that others published ---- */

/* s: what their authors state of the whole scene, of a frame or a step. */
static const struct {
    const char *name, *what;
    double published;
} PEERS[CONTACT_PEERS] = {{"peers_drape", "frame", 2.1},  {"peers_curtain", "frame", 3.9},
                          {"peers_twist", "frame", 6.6},  {"peers_needle", "frame", 9.2},
                          {"peers_stack", "frame", 18.1}, {"peers_ribbon", "frame", 1.7},
                          {"peers_layers", "step", 0.21}};

static void plan_peer(struct measure *measure, const struct bench_options *options)
{
    int i = 0;
    while (strcmp(PEERS[i].name, measure->name))
        i++;
    const struct measure_series *time =
        contact_plan_scene(measure, options, PEERS[i].name, PEERS[i].what);
    measure->cold = true;
    measure_value(measure, time, 1, "s", "%s", PEERS[i].name);
    measure_value(measure, time, 1 / PEERS[i].published, "x", "%s_vs_published", PEERS[i].name);
}

/* A case each, since the large ones take minutes. */
const struct bench_case contact_peers[CONTACT_PEERS] = {
    {"peers_drape", "until 1 s: seconds for each 1/60 s; published 2.1 on an NVIDIA L4", plan_peer,
     contact_scene_runs, 1},
    {"peers_curtain", "until 1 s: seconds for each 1/60 s; published 3.9 on an NVIDIA L4",
     plan_peer, contact_scene_runs, 1},
    {"peers_twist", "until 0.4 s: seconds for each 1/60 s; published 6.6 on an NVIDIA L4",
     plan_peer, contact_scene_runs, 1},
    {"peers_needle", "until 0.5 s: seconds for each 1/60 s; published 9.2 on an NVIDIA L4",
     plan_peer, contact_scene_runs, 1},
    {"peers_stack", "until 0.2 s: seconds for each 1/60 s; published 18.1 on an NVIDIA L4",
     plan_peer, contact_scene_runs, 1},
    {"peers_ribbon", "until 0.5 s: seconds for each 1/60 s; published 1.7 on an NVIDIA L4",
     plan_peer, contact_scene_runs, 1},
    {"peers_layers", "until 0.1 s: seconds a step; published 0.21 on a processor not named",
     plan_peer, contact_scene_runs, 1}};

static void plan_ring(struct measure *measure, const struct bench_options *options)
{
    measure->cold = true;
    measure_value(measure, contact_plan_scene(measure, options, "ring", "wall"), 1, "s",
                  "ring_seconds");
}

const struct bench_case contact_ring = {
    "ring", "peers/ring.yaml: a sheet of 1,681 vertices is drawn through eight capsules in 0.4 s",
    plan_ring, contact_scene_runs, 2};

static void plan_pinch(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *late = contact_plan_scene(measure, options, "pinch", "force");
    const struct measure_series *early = scene(measure, options, 0, "name=pinch", "force_early");
    const struct measure_series *one = contact_plan_scene(measure, options, "pinch_h1", "force");
    const struct measure_series *ten = contact_plan_scene(measure, options, "pinch_h10", "force");
    measure->cold = true;
    measure_value(measure, late, 1, "N", "pinch_force");
    measure_ratio(measure, late, early, "pinch_force_growth");
    measure_ratio(measure, one, ten, "pinch_force_h1_vs_h10");
}

const struct bench_case contact_pinch = {
    "pinch",
    "peers/pinch.yaml: the force of a sheet without room on a box, after ten seconds against one "
    "second, and in steps of 1 ms against 10 ms; the growth counts in steps of 5 ms",
    plan_pinch, contact_scene_runs, 1};

/* ---- Memory ---- */

static void plan_memory(struct measure *measure, const struct bench_options *options)
{
    static const char *const settings[] = {"name=cross", "name=cross_still"};
    const struct measure_series *of[2];
    measure->cold = true;
    for (int i = 0; i < 2; i++) {
        struct measure_series *series = scene(measure, options, 0, settings[i], "memory");
        series->fresh = true;
        of[i] = series;
    }
    measure_value(measure, of[0], 1e-6, "MB", "memory_cross_megabytes");
    measure_ratio(measure, of[0], of[1], "memory_cross_vs_still");
}

const struct bench_case contact_memory = {"memory",
                                          "the most memory of three steps in which a sheet flies "
                                          "at another with 200 m/s, against that of "
                                          "the same sheets at rest",
                                          plan_memory, contact_scene_runs, 1};

/* ---- The contact part of a step, and what contacts cost a solve ---- */

static const struct measure_series *
look(struct measure *measure, const struct bench_options *options, unsigned ranks, unsigned threads)
{
    return measure_series(measure, (struct subject_shape){"duite", ranks, threads},
                          "look ms=%d times=%d threads=%u scheduler=%s quick=%d",
                          options->quick ? 160 : 400, options->quick ? 2 : 10, threads,
                          options->scheduler, options->quick);
}

enum { STATES = 2 };

static void plan_iterations(struct measure *measure, const struct bench_options *options)
{
    static const int after[2][STATES] = {{300, 600}, {120, 160}}; /* ms */
    static const char *const name[STATES] = {"early", "late"};
    const struct measure_series *of[2][STATES];
    for (int with = 0; with < 2; with++)
        for (int i = 0; i < STATES; i++)
            of[with][i] =
                measure_series(measure, (struct subject_shape){"duite", 0, options->threads},
                               "iterations ms=%d contacts=%d threads=%u scheduler=%s quick=%d",
                               after[options->quick][i], with, options->threads, options->scheduler,
                               options->quick);
    struct measure_metric *metric =
        measure_metric(measure, "x", measure_geometric, "iterations_with_contact");
    metric->of = of[1][0];
    metric->against = of[0][0];
    metric->n = STATES;
    for (int i = 0; i < STATES; i++) {
        measure_value(measure, of[1][i], 1, "iterations", "iterations_sphere_%s", name[i]);
        measure_value(measure, of[0][i], 1, "iterations", "iterations_sphere_%s_without", name[i]);
    }
}

static void plan_part(struct measure *measure, const struct bench_options *options)
{
    const unsigned n = options->threads;
    const struct measure_series *one = look(measure, options, 0, 1);
    const struct measure_series *threads = look(measure, options, 0, n);
    const struct measure_series *ranks = look(measure, options, n, 1);
    measure_value(measure, one, 1e3, "ms", "collision_ms");
    measure_ratio(measure, one, threads, "collision_speedup_t%u", n);
    measure_ratio(measure, one, ranks, "collision_speedup_r%u", n);
}

const struct bench_case contact_part = {
    "part",
    "the contact part of a step of sphere.yaml after 0.4 s, without its solves: boxes, "
    "certificates, what is near, the rows of the contacts; on threads and ranks against one",
    plan_part, contact_state_runs, 8};

const struct bench_case contact_iterations = {
    "iterations",
    "the solve of a step of sphere.yaml after 0.3 and 0.6 s with its contacts against the same "
    "state and stop without their rows and forces",
    plan_iterations, contact_state_runs, 1};

/* ---- Balancers ---- */

static double ratio(const struct measure_metric *metric, size_t i, size_t round)
{
    return metric->of[i].sample[round] / metric->against->sample[round];
}

static double median(const struct measure_metric *metric, size_t i)
{
    double value[64];
    size_t n = 0;
    for (; n < metric->rounds && n < sizeof value / sizeof *value; n++)
        value[n] = ratio(metric, i, n);
    qsort(value, n, sizeof *value, cloth_by_double);
    return n ? (value[(n - 1) / 2] + value[n / 2]) / 2 : NAN;
}

/* That of the balancer whose median over all rounds is less. */
static double better(const struct measure_metric *metric, size_t round)
{
    return ratio(metric, median(metric, 1) < median(metric, 0), round);
}

static void plan_twist(struct measure *measure, const struct bench_options *options)
{
    static const char *const name[] = {"delegate", "migrate"};
    const struct measure_series *of[2], *found = NULL;
    char settings[40];
    for (int i = 0; i < 2; i++) {
        snprintf(settings, sizeof settings, "name=twist balance=%s", name[i]);
        of[i] = scene(measure, options, 2, settings, "wall");
    }
    const struct measure_series *none = scene(measure, options, 2, "name=twist", "wall");
    found = scene(measure, options, 2, "name=twist", "intersections");
    measure->cold = true;
    measure_value(measure, none, 1, "s", "twist_none_seconds");
    for (int i = 0; i < 2; i++)
        measure_ratio(measure, of[i], none, "twist_%s_vs_none", name[i]);
    struct measure_metric *best = measure_metric(measure, "x", better, "twist_balance_vs_none");
    best->of = of[0];
    best->against = none;
    measure_intersections(measure, "twist", found);
}

const struct bench_case contact_twist = {
    "twist",
    "twist.yaml until 1.5 s on two ranks of a thread, with the balancers delegate and migrate "
    "against none; twist_balance_vs_none is the better one",
    plan_twist, contact_scene_runs, 4};

/* ---- Nothing to touch ---- */

static void plan_instructions(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *of[2];
    const struct subject_shape shape = {"duite_valgrind", 0, 1};
    for (int contact = 0; contact < 2; contact++)
        of[contact] = measure_series(measure, shape, "instructions contact=%d steps=%d", contact,
                                     options->quick ? 2 : 10);
    measure->cold = true;
    measure_value(measure, of[0], 1e-6, "millions", "instructions_per_step");
    measure_ratio(measure, of[1], of[0], "instructions_nothing_to_touch");
}

const struct bench_case contact_instructions = {
    "instructions",
    "instructions a step, by valgrind: a sheet of 900 vertices without anything to touch, with a "
    "map `contact` against without",
    plan_instructions, contact_instruction_runs, 1};

/* ---- All frames ---- */

static double sum_up(const struct measure_metric *metric, size_t round)
{
    (void)metric, (void)round;
    return all_intersections;
}

static void plan_intersections(struct measure *measure, const struct bench_options *options)
{
    struct measure_metric *metric = measure_metric(measure, "pairs", sum_up, "intersections");
    measure->cold = true;
    metric->none = "no case before it ran scenes";
    metric->of = measure_series(measure, (struct subject_shape){"duite", 0, options->threads},
                                "uncut pairs=64");
}

const struct bench_case contact_intersections = {
    "intersections",
    "pairs of triangles that intersect in the frames of the scenes that the cases before this one "
    "ran, of the state and as files hold them; counted after the clock has stopped",
    plan_intersections, contact_certify_runs, 1};
