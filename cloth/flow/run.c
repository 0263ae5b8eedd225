/* A flow is read-only for tasks but for what tasks.h names; a run leaves it as it found it, so that
 * it can be run again. Every decision of the main program follows from values that all ranks get
 * alike. */
#include "cloth/flow/run.h"

#include "cloth/flow/tasks/tasks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double flow_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

const duite_kernel *const *flow_kernels(void)
{
    static const duite_kernel *const all[] = {&flow_ready,      &flow_initial,
                                              &flow_force,      &flow_explicit,
                                              &flow_implicit,   &flow_matrix,
                                              &flow_begin,      &flow_pack,
                                              &flow_start,      &flow_pass,
                                              &flow_scalars,    &flow_velocity_dv,
                                              &flow_velocity_a, &flow_position,
                                              &flow_collide,    &flow_status,
                                              &flow_frame,      &flow_stretch,
                                              &flow_most,       &flow_seconds,
                                              &flow_tell,       NULL};
    return all;
}

/* ---- Preparing ---- */

static int cut(struct flow *flow, const struct flow_particles *particles,
               const struct flow_springs *springs, struct cloth_error *error)
{
    uint32_t(*pairs)[2] = malloc((springs->n + 1) * sizeof *pairs);
    if (!pairs)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for %zu springs", springs->n);
    for (size_t i = 0; i < springs->n; i++) {
        pairs[i][0] = springs->spring[i].a;
        pairs[i][1] = springs->spring[i].b;
    }
    const int code = mesh_blocks_cut(&flow->blocks, particles->n, particles->used, springs->n,
                                     pairs[0], flow->model->grain, error);
    free(pairs);
    return code;
}

static void describe_odd(char *text, size_t size, const char *what, const struct flow_odd *odd,
                         const char *effect)
{
    if (odd->n)
        snprintf(text, size,
                 "%.200s%s%s that no face or edge uses: %u, the first is vertex %u of cloth "
                 "'%.60s'; %s",
                 odd->place ? odd->place : "", odd->place ? ": " : "", what, odd->n, odd->vertex,
                 odd->cloth->name, effect);
}

static void warn(struct flow *flow, const struct flow_particles *particles)
{
    const size_t size = sizeof flow->warning[0];
    describe_odd(flow->warning[0], size, "vertices", &particles->unused,
                 "they are kept and stay where they are");
    describe_odd(flow->warning[1], size, "pinned vertices", &particles->pinned,
                 "they stay where they are without a pin");
    describe_odd(flow->warning[2], size, "loads on vertices", &particles->loaded,
                 "they move nothing");
}

static int build(struct flow *flow, const struct flow_particles *particles,
                 const struct flow_springs *springs, int ranks, struct cloth_error *error)
{
    int code = cut(flow, particles, springs, error);
    if (!code && (uint32_t)ranks > flow->blocks.n_blocks)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "%d ranks are more than there are blocks (%u): %u vertices at a grain of "
                          "%u; start fewer ranks or give a smaller grain",
                          ranks, flow->blocks.n_blocks, flow->blocks.n_places, flow->model->grain);
    if (!code)
        code = flow_tables_make(&flow->tables, particles, springs, &flow->blocks, flow->model->h,
                                error);
    flow->n_vertices = particles->n;
    warn(flow, particles);
    flow->start = aligned_alloc(sizeof *flow->start, particles->n * sizeof *flow->start);
    if (!code && !flow->start)
        code = cloth_fail(error, CLOTH_E_MEMORY, "out of memory for %u vertices", particles->n);
    if (!code)
        memcpy(flow->start, particles->position, particles->n * sizeof *flow->start);
    return code;
}

int flow_prepare(struct flow **flow, const struct model *model, int ranks,
                 struct cloth_error *error)
{
    struct flow_particles particles = {0};
    struct flow_springs springs = {0};
    int code = CLOTH_OK;
    *flow = calloc(1, sizeof **flow);
    if (!*flow)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory");
    (*flow)->model = model;
    (*flow)->n_steps = (uint64_t)(model->end / model->h + 0.5);
    for (uint32_t c = 0; c < model->n_cloths; c++)
        (*flow)->n_triangles += model->cloths[c].mesh.n_triangles;
    if ((*flow)->n_steps >= UINT32_MAX)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "end / h makes %g steps; at most 4294967294 are possible",
                          model->end / model->h);
    if (!code)
        code = flow_particles_make(&particles, model, error);
    if (!code)
        code = flow_springs_make(&springs, model, error);
    if (!code)
        code = build(*flow, &particles, &springs, ranks, error);
    flow_particles_free(&particles);
    flow_springs_free(&springs);
    if (code) {
        flow_free(*flow);
        *flow = NULL;
    }
    return code;
}

void flow_free(struct flow *flow)
{
    if (!flow)
        return;
    mesh_blocks_free(&flow->blocks);
    flow_tables_free(&flow->tables);
    free(flow->start);
    free(flow);
}

uint64_t flow_vertices(const struct flow *flow)
{
    return flow->n_vertices;
}

const char *flow_warning(const struct flow *flow, size_t i)
{
    for (size_t k = 0; k < sizeof flow->warning / sizeof *flow->warning; k++)
        if (flow->warning[k][0] && i-- == 0)
            return flow->warning[k];
    return NULL;
}

/* ---- Running ---- */

static int run_begin(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow->trouble = (struct cloth_error){0};
    flow->output = state->output;
    flow->frames = 0;
    flow->hash = 0;
    atomic_store(&flow->stop, 0);
    const int code = flow_memory_take(state);
    if (code)
        return code;
    for (size_t v = 0; flow->room && v < flow->n_vertices; v++)
        for (size_t c = 0; c < 3; c++)
            flow->room[3 * v + c] = flow->start[v][c];
    state->begun = true;
    flow_objects_make(state);
    if (flow->model->integrator == MODEL_EXPLICIT_EULER)
        return DUITE_OK;
    flow_far_make(state);
    return flow_cg_record(state);
}

/* All steps, or until a stop that was asked for has had its frame. */
static int run_steps(struct flow_state *state)
{
    const uint64_t n = state->flow->n_steps;
    int code = flow_initialise(state);
    if (!code)
        code = flow_frames(state, 0);
    uint64_t step = 0;
    for (; step < n && !code; step++) {
        const uint64_t frame = state->next_frame;
        code = flow_step(state, step);
        if (!code)
            code = flow_frames(state, step + 1);
        if (state->stopping && state->next_frame > frame && step + 1 < n) {
            state->report->stopped = true;
            step++;
            break;
        }
    }
    if (!code && step > 0)
        code = flow_step_status(state, step - 1);
    return code;
}

static int code_of_cloth(int code)
{
    if (code == FLOW_NOT_WRITTEN)
        return CLOTH_E_IO;
    if (code == FLOW_NO_MEMORY || code == DUITE_E_MEMORY)
        return CLOTH_E_MEMORY;
    if (code == DUITE_E_LOST || code == DUITE_E_MPI)
        return CLOTH_E_LOST;
    return code > 0 ? CLOTH_E_RUN : CLOTH_E_LIBRARY;
}

/* The sentence that a body gave its failure, without what the runtime says of the task before it.
 */
static const char *own_sentence(const char *message, int code)
{
    char before[32];
    snprintf(before, sizeof before, " with code %d: ", code);
    const char *found = strstr(message, before);
    return found ? found + strlen(before) : message;
}

/* Why the run failed. What rank 0 could not write it knows in full, the others as far as it
 * travels with a failure. */
static const char *reason(const struct flow_state *state, int code)
{
    if (code == FLOW_NOT_WRITTEN && state->flow->trouble.code)
        return state->flow->trouble.text;
    return code > 0 ? own_sentence(duite_message(), code) : duite_message();
}

/* Turns a failure into a sentence with the frame that was written last. Waits until nothing runs.
 */
static int explain(struct flow_state *state, int code)
{
    struct cloth_error why = {0};
    cloth_fail(&why, code_of_cloth(code), "%s", reason(state, code));
    if (code < 0) /* the runtime itself failed: no more is asked of it */
        return cloth_fail(state->error, why.code, "%s", why.text);
    duite_wait(state->rt); /* its error is the one in hand */
    if (!state->output)
        return cloth_fail(state->error, why.code, "%s", why.text);
    if (!state->begun || flow_last_frame(state) || !state->report->frames)
        return cloth_fail(state->error, why.code, "%.900s; no frame was written", why.text);
    return cloth_fail(state->error, why.code, "%.900s; the last frame written is %llu", why.text,
                      (unsigned long long)state->report->last_frame);
}

static void describe(const struct flow *flow, struct flow_report *report)
{
    *report = (struct flow_report){.vertices = flow->n_vertices,
                                   .triangles = flow->n_triangles,
                                   .blocks = flow->blocks.n_blocks,
                                   .grain = flow->model->grain,
                                   .partition_hash = flow->blocks.hash};
}

int flow_run(struct flow *flow, duite *rt, const struct flow_output *output,
             const struct flow_progress *progress, struct flow_report *report,
             struct cloth_error *error)
{
    struct flow_state state = {.flow = flow,
                               .rt = rt,
                               .output = output,
                               .progress = progress,
                               .report = report,
                               .error = error};
    describe(flow, report);
    const double start = flow_now();
    int code = run_begin(&state);
    if (!code)
        code = run_steps(&state);
    if (!code)
        code = duite_wait(rt); /* the last frame too is on disk */
    report->wall_seconds = flow_now() - start;
    if (!code)
        code = flow_finish(&state);
    int failed = code ? explain(&state, code) : CLOTH_OK;
    const int unfreed = flow_objects_free(&state);
    if (!failed && unfreed)
        failed = cloth_fail(error, CLOTH_E_LIBRARY, "%s", duite_message());
    duite_wait(rt);
    report->simulated_seconds = (double)report->steps * flow->model->h;
    if (flow->model->integrator == MODEL_EXPLICIT_EULER)
        report->momentum_lost = NAN;
    flow_memory_free(&state);
    flow->output = NULL;
    return failed;
}
