#ifndef TESTS_CLOTH_FLOW_CHECKED_RUNS_H
#define TESTS_CLOTH_FLOW_CHECKED_RUNS_H

#include "cloth/flow/state/kernels.h"
#include "tests/cloth/flow/models.h"
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Runs of a small scene, in checking mode unless a case says no: the base, with sets of the case.
 */

enum { MAX_SETS = 6 };

static const char *const base =
    "schema: 1\n"
    "cloths:\n"
    "  - name: sheet\n"
    "    mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}\n"
    "    material: springs\n"
    "    pins: [{vertices: [0]}]\n"
    "    velocity: [0, -1, 0]\n"
    "materials:\n"
    "  springs: {density: 0.2, stretch: 50, shear: 25, bend: 5, damping: {viscous: 0.001, mass: "
    "0.1, stiffness: 0.01}}\n"
    "  undamped: {density: 0.2, stretch: 50, ea: 50}\n"
    "  hinges: {density: 0.2, stretch: 50, shear: 25, bending: {rigidity: 0.001}}\n"
    "  quadratic: {density: 0.2, stretch: 50, shear: 25, bending: {model: quadratic, rigidity: "
    "[0.001, 0.002]}}\n"
    "  triangles: {density: 0.2, model: triangles, stretch: [50, 40], shear: 20, poisson: 0.3,\n"
    "    damping: {stiffness: 0.01}, bending: {rigidity: 0.001}}\n"
    "  uncorrected: {density: 0.2, model: triangles, stretch: 50, shear: 20, forces: uncorrected}\n"
    "obstacles:\n"
    "  - plane: {point: [0, -0.0015, 0], normal: [0, 1, 0]}\n"
    "probes: [{vertices: [0, 7, 35], values: [position, velocity, reaction, total]}]\n"
    "time: {h: 0.001, end: 0.002, fps: 500}\n"
    "solver: {stop: {count: 4}}\n"
    "energies: steps\n"
    "grain: 8\n";

static inline int take_frame(void *context, uint64_t frame, double time, const double *position,
                             struct cloth_error *error)
{
    (void)context, (void)frame, (void)time, (void)position, (void)error;
    return CLOTH_OK;
}

static inline int take_beside(void *context, const struct flow_beside *beside,
                              struct cloth_error *error)
{
    (void)context, (void)beside, (void)error;
    return CLOTH_OK;
}

static inline int take_force(void *context, uint64_t frame, const double *force,
                             struct cloth_error *error)
{
    (void)context, (void)frame, (void)force, (void)error;
    return 0;
}

static inline int take_row(void *context, uint64_t step, double time, size_t n,
                           const double *values, struct cloth_error *error)
{
    (void)context, (void)step, (void)time, (void)n, (void)values, (void)error;
    return CLOTH_OK;
}

static inline int take_system(void *context, const struct solve_system *system,
                              struct cloth_error *error)
{
    (void)context, (void)system, (void)error;
    return CLOTH_OK;
}

/* The settings of a run besides its scene. */
struct how {
    const char *ends; /* part of the error that it is to end with; NULL: with none */
    bool system;
    bool unchecked;        /* not in checking mode */
    unsigned stops, polls; /* it is asked to stop from that poll on; 0: never; polls so far */
    bool saves;            /* it makes checkpoints, */
    struct flow_checkpoint saved; /* of which this is the last one, on rank 0; to be freed */
    struct flow_checkpoint from;  /* it goes on from here, on rank 0; bytes NULL: it starts anew */
    struct flow_report report;    /* of it */
};

static inline void take_checkpoint(void *context, struct flow_checkpoint state)
{
    struct how *how = context;
    ck_assert_ptr_nonnull(state.bytes);
    free(how->saved.bytes);
    how->saved = state;
}

static inline int always(void *context)
{
    (void)context;
    return 1;
}

static inline int stops(void *context)
{
    struct how *how = context;
    return how->stops && ++how->polls >= how->stops;
}

static inline void run_checked(struct how *how, struct flow *flow, struct cloth_error *error)
{
    const struct flow_output output = {.context = how,
                                       .frame = take_frame,
                                       .force = take_force,
                                       .beside = take_beside,
                                       .row = take_row,
                                       .system = how->system ? take_system : NULL,
                                       .save = how->saves ? take_checkpoint : NULL};
    const struct flow_progress progress = {
        .context = how, .stop = stops, .due = how->saves ? always : NULL};
    duite_options options = duite_options_default();
    duite *rt = NULL;
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = 1;
    options.bind = 0;
    options.check = !how->unchecked;
    ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
    flow_run(flow, rt, &output, &progress, &how->report, error);
    ck_assert_msg(!duite_stop(&rt), "%s", duite_message());
}

static bool quick, sampled;
static unsigned asked; /* how many runs the case has asked for */

static inline void sample(void)
{
    sampled = quick;
    asked = 0;
}

static inline void sample_no_more(void)
{
    sampled = false;
}

/* Sampled: all but the first run that a case asks for, and each fifth one after it. */
static inline bool left_out(void)
{
    return sampled && asked++ % 5;
}

/* The base with these sets, of which those that are NULL are none. Returns whether it was run.
 * Collective. */
static inline bool run_how(struct how *how, const char *const sets[MAX_SETS])
{
    if (left_out())
        return false;
    const char *some[MAX_SETS];
    char name[1024] = "";
    size_t n = 0;
    for (size_t i = 0; i < MAX_SETS; i++)
        if (sets[i]) {
            some[n++] = sets[i];
            snprintf(name + strlen(name), sizeof name - strlen(name), " %s", sets[i]);
        }
    int rank, ranks;
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    struct model model = {0};
    record_mpi(&rank, &ranks);
    if (rank) {
        flow_join(&flow, &error);
    } else {
        model = scene_read_right(base, n, some);
        flow_prepare(&flow, &model, ranks, &error);
        if (!error.code && how->from.bytes)
            flow_resume(flow, how->from, &(struct flow_resumed){0}, &error);
    }
    MPI_Bcast(&error, sizeof error, MPI_BYTE, 0, MPI_COMM_WORLD);
    if (!error.code)
        run_checked(how, flow, &error);
    flow_free(flow);
    if (!rank)
        model_free(&model);
    ck_assert_msg(how->ends ? error.code && strstr(error.text, how->ends) : !error.code,
                  "with%s: %s", name, error.text);
    return true;
}

#define SETS(...) ((const char *const[MAX_SETS]){__VA_ARGS__})

static inline void run(const char *const sets[MAX_SETS])
{
    run_how(&(struct how){0}, sets);
}

#endif
