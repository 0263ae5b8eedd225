/* Tasks only read a flow, except what state/flow.h names. The main program decides only by values
 * that all ranks get alike. */
#include "cloth/flow/run.h"

#include "cloth/base/clock.h"
#include "cloth/base/memory.h"
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const duite_kernel *const *flow_kernels(void)
{
#define TASK(name)      &flow_kernel_##name.task,
#define TASK_LESS(name) &flow_kernel_##name##_less,
    static const duite_kernel *const all[FLOW_KERNELS_LISTED + 1] = {
        FLOW_KERNELS(TASK) FLOW_KERNELS_IF(TASK_LESS) NULL};
    return all;
}

/* ---- Preparing ---- */

/* Keeps where the vertices are that no block has. */
static int keep_unused(struct flow *flow, const struct flow_particles *particles,
                       struct cloth_error *error)
{
    struct flow_unused *unused = &flow->unused;
    const struct model *model = flow->model;
    unused->vertex = cloth_alloc(particles->unused.n, sizeof *unused->vertex, error);
    unused->position = cloth_alloc(particles->unused.n, sizeof *unused->position, error);
    if (!unused->vertex || !unused->position)
        return CLOTH_E_MEMORY;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct mesh *mesh = &model->cloths[c].mesh;
        const uint32_t first = model_first(model, c);
        for (uint32_t v = 0; v < mesh->n_vertices; v++) {
            if (particles->used[first + v])
                continue;
            unused->vertex[unused->n] = first + v;
            memcpy(unused->position[unused->n++], mesh->position + 3 * (size_t)v,
                   sizeof *unused->position);
        }
    }
    return CLOTH_OK;
}

static int build_source(struct flow *flow, int ranks, struct cloth_error *error)
{
    const int code = flow_source_make(&flow->source, flow->model, ranks, error);
    if (code)
        return code;
    flow->n_vertices = flow->source.particles.n;
    flow->partition_hash = flow->source.blocks.hash;
    flow->inertia = flow_source_inertia(&flow->source);
    flow->release = flow_source_release(&flow->source);
    flow->contact_stiffness = flow_source_stiffness(&flow->source);
    flow->vertex_mass = flow_source_mass(&flow->source);
    flow->may_pinch = flow_source_may_pinch(&flow->source);
    flow->feels_contact = model_feels_contact(flow->model);
    flow_preconditioner_choose(flow, flow->source.blocks.n_blocks);
    if (flow_watched_header(&flow->source.watched, flow->model, &flow->header, error) ||
        flow_warn(flow, error))
        return CLOTH_E_MEMORY;
    return keep_unused(flow, &flow->source.particles, error);
}

int flow_join(struct flow **flow, struct cloth_error *error)
{
    *flow = calloc(1, sizeof **flow);
    return *flow ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "out of memory");
}

int flow_prepare(struct flow **flow, const struct model *model, int ranks,
                 struct cloth_error *error)
{
    int code = flow_join(flow, error);
    if (code)
        return code;
    (*flow)->model = model;
    (*flow)->n_steps = (uint64_t)(model->end / model->h + 0.5);
    (*flow)->cloth_first = cloth_alloc(model->n_cloths, sizeof *(*flow)->cloth_first, error);
    if (!(*flow)->cloth_first)
        code = CLOTH_E_MEMORY;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        (*flow)->n_triangles += model->cloths[c].mesh.n_triangles;
        (*flow)->cloth_first[c] = model_first(model, c);
    }
    if (!code && (*flow)->n_steps >= UINT32_MAX)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "end / h makes %g steps; at most 4294967294 are possible",
                          model->end / model->h);
    if (!code)
        code = build_source(*flow, ranks, error);
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
    flow_source_free(&flow->source);
    free(flow->vertex);
    free(flow->cloth_first);
    free(flow->names.name);
    free(flow->unused.vertex);
    free(flow->unused.position);
    free(flow->attached);
    free(flow->saving.items); /* of a save that a failure ended */
    cloth_pool_free(&flow->watched.memory);
    free(flow->header);
    free(flow);
}

void flow_start(const struct flow *flow, double *position)
{
    const struct flow_particles *particles = &flow->source.particles;
    struct flow_cloths at = {0};
    for (uint32_t v = 0; v < particles->n; v++) {
        struct flow_particle particle;
        flow_particle_at(particles, flow->model, &at, v, &particle);
        for (size_t k = 0; k < 3; k++)
            position[3 * (size_t)v + k] = particle.position[k];
    }
}

const double (*flow_unwelded(const struct flow *flow))[3]
{
    return (const double(*)[3])flow->source.particles.unwelded;
}

void flow_starts(const struct flow *flow, double (*start)[6], unsigned char *held)
{
    const struct flow_particles *particles = &flow->source.particles;
    flow_starts_take(particles, flow->model, start);
    for (uint32_t v = 0; v < particles->n; v++)
        held[v] = !particles->free[v] || (particles->slider && particles->slider[v]);
}

uint64_t flow_vertices(const struct flow *flow)
{
    return flow->n_vertices;
}

const uint32_t *flow_attached(const struct flow *flow)
{
    return flow->attached ? flow->attached : flow->source.particles.attached;
}

const char *flow_header(const struct flow *flow)
{
    return flow->header;
}

const char *flow_warning(const struct flow *flow, size_t i)
{
    for (size_t k = 0; k < sizeof flow->warning / sizeof *flow->warning; k++)
        if (flow->warning[k][0] && i-- == 0)
            return flow->warning[k];
    return NULL;
}

/* ---- Running ---- */

static void describe_cloth(const struct flow_state *state)
{
    const struct flow *flow = state->flow;
    *state->report = (struct flow_report){.vertices = flow->n_vertices,
                                          .triangles = flow->n_triangles,
                                          .blocks = state->head.n_blocks,
                                          .grain = flow->model->grain,
                                          .partition_hash = flow->partition_hash};
}

/* Makes objects, then tables, which go to the ranks of their objects. Everything that bodies find
 * by their context is made before waiting for the tables. A rank that is ahead may send tasks here
 * that this rank's main program has not reached. */
static int make_objects(struct flow_state *state)
{
    flow_objects_make(state);
    if (model_is_implicit(state->flow->model))
        flow_halo_make(state);
    flow_levels_make(state);
    if (!flow_distribute(state))
        flow_noted(state, duite_count_all(state->rt, &state->before));
    return state->code;
}

int flow_run_begin(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow->trouble = (struct cloth_error){0};
    flow->output = state->output;
    flow->frames = flow_before(state).frames;
    flow->hash = 0;
    if (flow_share_head(state))
        return state->code;
    describe_cloth(state);
    state->report->rest_seconds = state->report->sewn_seconds = NAN;
    state->report->seams = flow->model->n_pulled;
    state->report->correction_excess = flow->model->correction_rounds ? 0 : NAN;
    state->begun = !flow_memory_take(state) && !flow_share(state) &&
                   !flow_preconditioner_prepare(state) && !make_objects(state);
    for (uint32_t i = 0; flow->room && i < flow->unused.n; i++)
        memcpy(flow->room + 3 * (size_t)flow->unused.vertex[i], flow->unused.position[i],
               sizeof flow->unused.position[i]);
    return state->code;
}

/* Starts a run that does not go on from a checkpoint. */
static void start_anew(struct flow_state *state)
{
    if (!flow_initialise(state))
        flow_noted(state, flow_contact_start(state));
}

/* All steps, or until a stop that was asked for. */
static void run_steps(struct flow_state *state)
{
    const bool implicit = model_is_implicit(state->flow->model),
               goes_on = state->head.resumed_bytes;
    if (goes_on && flow_resume_main(state))
        return;
    if (state->flow->model->sizes)
        flow_resize(state);
    flow_ties_choose(state);
    if (!state->code && implicit && !state->solve.generation)
        flow_cg_record(state);
    if (goes_on)
        flow_resume_blocks(state);
    else
        start_anew(state);
    if (!state->code && !state->complete)
        flow_steps(state);
    if (implicit && state->report->steps && state->output && state->output->system)
        flow_system(state);
}

static int code_of_cloth(int code)
{
    if (code == FLOW_NOT_WRITTEN)
        return CLOTH_E_IO;
    if (code == FLOW_NO_MEMORY || code == DUITE_E_MEMORY)
        return CLOTH_E_MEMORY;
    if (code == DUITE_E_LOST || code == DUITE_E_MPI)
        return CLOTH_E_LOST;
    if (code == FLOW_TANGLED || code == FLOW_UNFIT)
        return CLOTH_E_INPUT;
    return code > 0 ? CLOTH_E_RUN : CLOTH_E_LIBRARY;
}

/* A body's own failure sentence, without the runtime's words about the task before it. */
static const char *own_sentence(const char *message, int code)
{
    char before[32];
    snprintf(before, sizeof before, " with code %d: ", code);
    const char *found = strstr(message, before);
    return found ? found + strlen(before) : message;
}

/* Why the run failed. Rank 0 knows a write error in full; the others know the part that travels
 * with a failure. */
static const char *reason(const struct flow_state *state, int code)
{
    if (code == FLOW_NOT_WRITTEN && state->flow->trouble.code)
        return state->flow->trouble.text;
    if (code == FLOW_STRETCHED || code == FLOW_TANGLED || code == FLOW_PINCHED ||
        code == FLOW_UNSEWN)
        return state->reason;
    return code > 0 ? own_sentence(duite_message(), code) : duite_message();
}

/* Turns a failure into a sentence with the frame that was written last. Waits until nothing runs.
 */
static int explain(struct flow_state *state, int code)
{
    struct cloth_error why = {0};
    cloth_fail(&why, code_of_cloth(code), "%.900s%s", reason(state, code),
               code >= FLOW_DIVERGED && code != FLOW_UNSEWN && code_of_cloth(code) == CLOTH_E_RUN &&
                       state->attempt.length == 1
                   ? "; the step had been halved down to h/1024"
                   : "");
    if (code < 0) /* the runtime itself failed: no more is asked of it */
        return cloth_fail(state->error, why.code, "%s", why.text);
    duite_wait(state->rt); /* its error is the one in hand */
    state->code = DUITE_OK;
    if (!flow_shows(state))
        return cloth_fail(state->error, why.code, "%s", why.text);
    if (!state->begun || flow_last_frame(state) || state->report->frames <= flow_first_frame(state))
        return cloth_fail(state->error, why.code, "%.900s; no frame was written", why.text);
    return cloth_fail(state->error, why.code, "%.900s; the last frame is %llu", why.text,
                      (unsigned long long)state->report->last_frame);
}

int flow_run(struct flow *flow, duite *rt, const struct flow_output *output,
             const struct flow_progress *progress, struct flow_report *report,
             struct cloth_error *error)
{
    struct flow_state state = {
        .flow = flow, .rt = rt, .output = output, .report = report, .error = error};
    *report = (struct flow_report){0};
    flow->progress = progress;
    flow_run_begin(&state);
    state.from = cloth_seconds();
    if (!state.code)
        run_steps(&state);
    if (!state.code)
        flow_noted(&state, duite_wait(rt)); /* the last frame is written, too */
    report->wall_seconds = state.saved_wall + cloth_seconds() - state.from;
    if (!state.code)
        flow_finish(&state);
    if (!state.code && !report->stopped && !state.complete)
        flow_save(&state, true);
    if (!state.code)
        flow_noted(&state, duite_wait(rt));
    int failed = state.code ? explain(&state, state.code) : CLOTH_OK;
    if (flow_objects_free(&state) && !failed)
        failed = cloth_fail(error, CLOTH_E_LIBRARY, "%s", duite_message());
    duite_wait(rt);
    if (flow->model) {
        report->simulated_seconds = (double)state.grid.now * flow->model->h / FLOW_TICKS;
        report->shortest_step = state.grid.least_done * flow->model->h / FLOW_TICKS;
        report->steps_halved = state.grid.refused;
    }
    if (flow->model && !model_is_implicit(flow->model))
        report->momentum_lost = report->mass_norm_error = NAN;
    flow_memory_free(&state);
    flow->output = NULL;
    flow->progress = NULL;
    return failed;
}
