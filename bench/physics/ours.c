/* A sheet is the reference of the bench "cg", waved and moving. The results of its kernels must
 * have the same bits without wide instructions, and forces inside the cloth must sum to nothing. */
#include "bench/physics/physics.h"

#include "bench/cg/cg.h"
#include "bench/tasks/tasks.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"
#include "cloth/scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- A sheet made ready ---- */

static int end(struct physics_session *s, int code)
{
    code = cg_stop(&s->run, *s->settings, &s->rt, &s->flow, code);
    *s->settings = '\0';
    model_free(&s->model);
    s->model = (struct model){0};
    s->expected = 0;
    return code;
}

int physics_end(struct physics_session *s)
{
    return end(s, 0);
}

/* The scene of the bench "cg", of so many vertices along each side. */
static int read_model(struct model *model, const char *sheet, unsigned side, bool quick)
{
    enum { SETS = 7 };
    static const char UNDAMPED[] =
        "materials.cloth={density: 0.2, stretch: 5000, shear: 2500, diagonals: one}";
    static const char TRIANGLES[] = "materials.cloth={model: triangles, density: 0.2, stretch: "
                                    "5000, shear: 2000, poisson: 0.3, damping: {stiffness: 0.05}}";
    char text[SETS][200];
    struct scene_set set[SETS] = {{0}};
    struct cloth_error error = {0};
    const bool explicit = !strcmp(sheet, "explicit");
    snprintf(text[0], sizeof *text,
             "cloths[0].mesh.grid={width: 1, height: 1, nx: %u, ny: %u, cells: same}", side, side);
    snprintf(text[1], sizeof *text, "time={h: %s, end: %s, fps: 1, halving: off}",
             explicit ? "1e-7" : "0.001", explicit ? "1e-7" : "0.001");
    snprintf(text[2], sizeof *text, "integrator=%s",
             explicit ? "explicit_euler" : "implicit_euler");
    snprintf(text[3], sizeof *text, "grain=%d", quick ? 40 : 1000);
    snprintf(text[4], sizeof *text, "solver.preconditioner=none");
    snprintf(text[5], sizeof *text, "%s",
             explicit                      ? UNDAMPED
             : !strcmp(sheet, "triangles") ? TRIANGLES
                                           : "gravity=[0, -9.81, 0]");
    snprintf(text[6], sizeof *text, "obstacles=[]");
    for (int i = 0; i < SETS; i++)
        set[i].text = text[i];
    if (scene_read(model, BENCH_STATES_SCENE, SETS, set, &error))
        return serve_fail("%s", error.text);
    return states_wave(model);
}

static int begin(struct physics_session *s)
{
    s->report = (struct flow_report){0};
    s->run = (struct flow_state){.flow = s->flow, .rt = s->rt, .report = &s->report};
    int code = flow_run_begin(&s->run);
    if (!code && model_is_implicit(&s->model))
        code = flow_cg_record(&s->run);
    if (!code)
        code = flow_initialise(&s->run);
    if (!code)
        code = duite_wait(s->rt);
    s->run.attempt.length = FLOW_TICKS;
    return tasks_code(code);
}

static int ready(struct physics_session *s, struct serve_request *request, const char *sheet)
{
    char settings[sizeof s->settings], scheduler[40];
    const unsigned side = (unsigned)serve_number(request, "side");
    const unsigned threads = (unsigned)serve_number(request, "threads");
    const bool quick = serve_number(request, "quick") != 0;
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    snprintf(settings, sizeof settings, "%s %u %u %s", sheet, side, threads, scheduler);
    if (!strcmp(settings, s->settings))
        return 0;
    int code = end(s, 0);
    if (!code)
        code = read_model(&s->model, sheet, side, quick);
    if (!code)
        code = cg_make_flow(&s->model, &s->flow);
    if (!code)
        code = cg_start_runtime(request, s->flow, &s->rt);
    if (!code)
        code = begin(s);
    if (!code)
        memcpy(s->settings, settings, sizeof settings);
    return code;
}

/* ---- Answers ---- */

/* An object of every block; its doubles go to the hash. */
static int hash_object(struct physics_session *s, duite_object object, size_t doubles,
                       XXH64_state_t *hash)
{
    double *values = aligned_alloc(64, (doubles + 7) / 8 * 64);
    int code = values ? tasks_code(duite_get(s->rt, object, values)) : serve_no_memory();
    if (!code)
        XXH64_update(hash, values, doubles * sizeof *values);
    free(values);
    return code;
}

/* Hashes the result of a run: the system, or the state. */
static int hash_all(struct physics_session *s, uint64_t *digest)
{
    const bool implicit = model_is_implicit(&s->model);
    XXH64_state_t *hash = XXH64_createState();
    int code = hash ? 0 : serve_no_memory();
    if (hash)
        XXH64_reset(hash, 0);
    for (uint32_t b = 0; b < s->flow->tables.n_blocks && !code; b++) {
        const struct flow_table *t = s->flow->tables.block + b;
        const struct flow_objects *o = s->run.block + b;
        const size_t rows = 4 * (size_t)t->n;
        code = hash_object(s, implicit ? o->f : o->x, rows, hash);
        if (!code && !implicit)
            code = hash_object(s, o->v, rows, hash);
        if (!code && implicit)
            code = hash_object(s, o->a, 4 * flow_diagonal_rows(t) + flow_table_doubles(t), hash);
    }
    *digest = hash ? XXH64_digest(hash) : 0;
    XXH64_freeState(hash);
    return code;
}

/* The sum of the right side is h times that of the loads, since there is no drag: against the sum
 * of the sizes of its rows. */
static int check_momentum(struct physics_session *s)
{
    const double *gravity = s->model.gravity;
    double sum[3] = {0}, mass = 0, size = 0;
    int code = 0;
    for (uint32_t b = 0; b < s->flow->tables.n_blocks && !code; b++) {
        const struct flow_table *t = s->flow->tables.block + b;
        code = tasks_code(duite_get(s->rt, s->run.block[b].f, s->run.rows));
        for (size_t i = 0; i < t->n && !code; i++)
            for (size_t c = 0; c < 3; c++) {
                sum[c] += s->run.rows[4 * i + c];
                size += fabs(s->run.rows[4 * i + c]);
            }
    }
    mass = 0.2; /* kg: 1 m^2 */
    for (int c = 0; c < 3 && !code; c++)
        if (!(fabs(sum[c] - s->model.h * mass * gravity[c]) <= 1e-12 * size))
            code = serve_fail("wrong answer: the forces sum to %g N along axis %d",
                              sum[c] / s->model.h, c);
    return code;
}

/* The state at the start, and what is measured once. */
static int once(struct physics_session *s, int (*run)(struct flow_state *state))
{
    int code = flow_initialise(&s->run);
    if (!code)
        code = run(&s->run);
    if (!code)
        code = duite_wait(s->rt);
    return tasks_code(code);
}

static int check(struct physics_session *s, int (*run)(struct flow_state *state))
{
    const enum cloth_simd wide = cloth_simd;
    uint64_t got;
    int code = 0;
    if (!s->expected) {
        cloth_simd = CLOTH_SIMD_NONE; /* no task runs */
        code = once(s, run);
        cloth_simd = wide;
        if (!code)
            code = hash_all(s, &s->expected);
    }
    if (!code)
        code = once(s, run);
    if (!code)
        code = hash_all(s, &got);
    return !code && got != s->expected
               ? serve_fail("wrong answer: not the bits of kernels without wide instructions")
               : code;
}

/* ---- Runs ---- */

/* Seconds of one of so many, after one that does not count. */
static int time_rounds(struct physics_session *s, int (*run)(struct flow_state *state),
                       uint64_t rounds, double *seconds)
{
    int code = once(s, run);
    const double begin = serve_seconds();
    for (uint64_t i = 0; i < rounds && !code; i++) {
        code = tasks_code(run(&s->run));
        if (!code)
            code = tasks_code(duite_wait(s->rt));
    }
    *seconds = (serve_seconds() - begin) / (double)rounds;
    return code;
}

static int assemble(void *context, struct serve_request *request, double *value)
{
    struct physics_session *s = context;
    const uint64_t rounds = serve_number(request, "rounds");
    char sheet[20];
    serve_word(request, "sheet", sheet, sizeof sheet);
    int code = ready(s, request, sheet);
    if (!code)
        code = time_rounds(s, flow_assemble, rounds, value);
    if (!code)
        code = check(s, flow_assemble);
    return code ? code : check_momentum(s);
}

static int iterate(void *context, struct serve_request *request, double *value)
{
    struct physics_session *s = context;
    const uint64_t count = serve_number(request, "count");
    char sheet[20];
    serve_word(request, "sheet", sheet, sizeof sheet);
    int code = ready(s, request, sheet);
    s->model.stop = MODEL_STOP_COUNT;
    s->model.max_iterations = (uint32_t)count / 10 + 1;
    if (!code)
        code = once(s, flow_assemble);
    if (!code)
        code = time_rounds(s, flow_cg, 1, value); /* the matrix has just been written */
    s->model.max_iterations = (uint32_t)count;
    if (!code)
        code = time_rounds(s, flow_cg, 1, value);
    *value /= (double)count;
    return code;
}

/* Steps without a look at them. */
static int explicit(void *context, struct serve_request *request, double *value)
{
    struct physics_session *s = context;
    const uint64_t steps = serve_number(request, "steps");
    int code = ready(s, request, "explicit");
    if (!code)
        code = once(s, flow_step);
    const double begin = serve_seconds();
    for (uint64_t i = 0; i < steps && !code; i++)
        code = tasks_code(flow_step(&s->run));
    if (!code)
        code = tasks_code(duite_wait(s->rt));
    *value = (serve_seconds() - begin) / (double)steps;
    return code ? code : check(s, flow_step);
}

const struct serve_run physics_runs[] = {
    {"assemble", assemble}, {"iterate", iterate}, {"explicit", explicit}, {0}};
