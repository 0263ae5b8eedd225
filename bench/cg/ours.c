/* One runtime and one flow at a time, made for a state and kept while the same is asked for. A step
 * from the state's positions and velocities makes its system, which is then solved again and again.
 * A bench looks into the cloth's own folders, as a test does. */
#include "bench/cg/cg.h"

#include "bench/tasks/tasks.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "tests/support/rank.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Runtimes ---- */

static void finalise(void)
{
    MPI_Finalize();
}

/* A runtime is kept while another one makes the state of the next request: then both may call MPI.
 * On several ranks none is made meanwhile, and MPI's locks would cost time. */
static void start_mpi(void)
{
    int begun = 1, given;
    if (!rank_said() && !MPI_Initialized(&begun) && !begun &&
        !MPI_Init_thread(NULL, NULL, MPI_THREAD_MULTIPLE, &given))
        atexit(finalise);
}

int cg_start_runtime(struct serve_request *request, struct flow *flow, duite **rt)
{
    char scheduler[40];
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    duite_options options = duite_options_default();
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = (unsigned)serve_number(request, "threads");
    options.scheduler = duite_scheduler_find(scheduler);
    start_mpi();
    return tasks_code(duite_start(rt, &options));
}

int cg_make_flow(const struct model *model, struct flow **flow)
{
    const char *rank = rank_said(); /* MPI may not have begun */
    struct cloth_error error = {0};
    const int code =
        rank && atoi(rank) > 0 ? flow_join(flow, &error) : flow_prepare(flow, model, 1, &error);
    return code ? serve_fail("%s", error.text) : 0;
}

int cg_run(const struct model *model, struct serve_request *request,
           const struct flow_output *output, const struct flow_progress *progress,
           struct flow_report *report)
{
    struct cloth_error error = {0};
    struct flow_report unread;
    struct flow *flow = NULL;
    duite *rt = NULL;
    int code = cg_make_flow(model, &flow);
    if (!code)
        code = cg_start_runtime(request, flow, &rt);
    if (!code && flow_run(flow, rt, output, progress, report ? report : &unread, &error))
        code = serve_fail("%s", error.text);
    if (rt && duite_stop(&rt) && !code)
        code = tasks_code(1);
    flow_free(flow);
    return code;
}

/* ---- A state made ready ---- */

int cg_stop(struct flow_state *run, bool begun, duite **rt, struct flow **flow, int code)
{
    if (*rt && begun) {
        flow_objects_free(run);
        duite_wait(*rt);
        flow_memory_free(run);
    }
    if (*rt && duite_stop(rt) && !code)
        code = tasks_code(1);
    flow_free(*flow);
    *flow = NULL;
    return code;
}

static int end(struct cg_session *s, int code)
{
    code = cg_stop(&s->run, *s->settings, &s->rt, &s->flow, code);
    free(s->solution);
    s->solution = NULL;
    *s->settings = '\0';
    states_plan_free(&s->plan);
    return code;
}

/* The system of the step that begins, with what is near then as its contacts. */
static int touch(struct flow_state *run)
{
    int code = flow_contact_start(run);
    run->attempt = (struct flow_attempt){.begin = run->grid.now, .length = FLOW_TICKS};
    if (!code)
        code = flow_contact_tie(run);
    return code ? code : flow_assemble(run);
}

/* The system: that of a step whose solve is cut short. */
static int begin(struct cg_session *s)
{
    s->report = (struct flow_report){0};
    s->run = (struct flow_state){.flow = s->flow, .rt = s->rt, .report = &s->report};
    int code = flow_run_begin(&s->run);
    if (!code)
        code = flow_ties_choose(&s->run);
    if (!code)
        code = flow_cg_record(&s->run);
    if (!code)
        code = flow_initialise(&s->run);
    if (!code)
        code = model_promise(s->flow->model).apart ? touch(&s->run) : flow_step(&s->run);
    if (!code)
        code = duite_wait(s->rt);
    return tasks_code(code);
}

int cg_pause(struct cg_session *s)
{
    return end(s, 0);
}

int cg_end(struct cg_session *s)
{
    const int code = end(s, 0);
    state_free(&s->state);
    return code;
}

static void stop_after(struct cg_session *s, uint32_t count)
{
    cg_stop_by(s, MODEL_STOP_COUNT, s->tolerance, count);
}

static void stop_by_default(struct cg_session *s)
{
    cg_stop_by(s, s->stop, s->tolerance, s->most);
}

static void settings_of(struct serve_request *request, char *settings, size_t size)
{
    char state[40], scheduler[40], solver[16], format[16], coarse[16], grain[16];
    const unsigned threads = (unsigned)serve_number(request, "threads");
    serve_word(request, "state", state, sizeof state);
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    serve_word(request, "solver", solver, sizeof solver);
    serve_word(request, "format", format, sizeof format);
    serve_word(request, "coarse", coarse, sizeof coarse);
    serve_word(request, "grain", grain, sizeof grain);
    snprintf(settings, size, "%s %u %s %s %s %s %s", state, threads, scheduler, solver, format,
             coarse, grain);
}

/* States may be older than what they are cut by now. */
static int cut_again(struct cg_session *s)
{
    free(s->state.order);
    return cg_order(&s->state, s->plan.model.grain);
}

/* solver=plain or jacobi: that preconditioner; format=half: that format;
 * coarse=exact: one factor of the coarse space with four patches a block, coarse=one: with one
 * patch a block; grain=: vertices a block; without the words the default ones. */
static void choose(const struct serve_request *request, struct model *model)
{
    char solver[16], format[16], coarse[16], grain[16];
    serve_word(request, "solver", solver, sizeof solver);
    serve_word(request, "format", format, sizeof format);
    serve_word(request, "coarse", coarse, sizeof coarse);
    serve_word(request, "grain", grain, sizeof grain);
    if (!strcmp(solver, "plain"))
        model->preconditioner = MODEL_PLAIN;
    if (!strcmp(solver, "jacobi"))
        model->preconditioner = MODEL_JACOBI;
    if (!strcmp(format, "half"))
        model->format = SOLVE_HALF;
    if (*coarse) {
        model->exact_coarse = true;
        model->patches = strcmp(coarse, "one") ? SOLVE_MAX_PATCHES : 1;
    }
    if (*grain)
        model->grain = (uint32_t)atoi(grain);
}

int cg_ready(struct cg_session *s, struct serve_request *request)
{
    char settings[sizeof s->settings];
    const struct model *model = &s->plan.model;
    const uint64_t quick = serve_number(request, "quick");
    int code = state_ready(&s->state, request);
    settings_of(request, settings, sizeof settings);
    if (code || !strcmp(settings, s->settings))
        return code;
    code = end(s, code);
    if (!code)
        code = states_plan_make(&s->plan, s->state.name, quick != 0);
    if (!code)
        code = states_start(&s->plan.model, s->state.system.x, s->state.system.v);
    choose(request, &s->plan.model);
    s->stop = model->stop;
    s->tolerance = model->tolerance;
    s->most = model->max_iterations;
    stop_after(s, 2);
    if (!code)
        code = cg_make_flow(model, &s->flow);
    if (!code)
        code = cg_start_runtime(request, s->flow, &s->rt);
    if (!code)
        code = begin(s);
    if (!code && !s->flow->vertex)
        code = cut_again(s);
    if (!code && s->plan.solved_here)
        code = cg_find_solution(s);
    if (!code)
        snprintf(s->settings, sizeof s->settings, "%s", settings);
    return code;
}

/* One solve; how far it is from the solution. */
static int error_of(struct cg_session *s, double *error)
{
    double *dv = cg_new_answer(s);
    int code = dv ? tasks_code(flow_cg(&s->run)) : 1;
    if (!code)
        code = cg_answer(s, dv);
    if (!code)
        *error = state_distance(&s->state, dv, s->solution ? s->solution : s->state.system.dv);
    free(dv);
    return code;
}

static int step_again(struct cg_session *s)
{
    int code = flow_initialise(&s->run);
    if (!code)
        code = flow_step(&s->run);
    return code ? code : duite_wait(s->rt);
}

/* With a matrix that has just been written, as a step writes its own. */
static int time_solve(struct cg_session *s, double *seconds)
{
    const uint32_t most = s->plan.model.max_iterations;
    stop_after(s, 2);
    int code = tasks_code(step_again(s));
    stop_after(s, most);
    if (code)
        return code;
    const double begin = serve_seconds();
    if (!code)
        code = flow_cg(&s->run);
    if (!code)
        code = duite_wait(s->rt);
    *seconds = serve_seconds() - begin;
    return tasks_code(code);
}

/* ---- Runs ---- */

/* Seconds of count= iterations, from b alone. */
static int cg(void *context, struct serve_request *request, double *value)
{
    struct cg_session *s = context;
    const uint32_t count = (uint32_t)serve_number(request, "count");
    int code = cg_ready(s, request);
    stop_after(s, count / 10 + 1);
    if (!code)
        code = time_solve(s, value);
    stop_after(s, count);
    if (!code)
        code = time_solve(s, value);
    double *dv = code ? NULL : cg_new_answer(s);
    code = dv ? cg_answer(s, dv) : 1;
    if (!code)
        code = state_check(&s->state, count, dv);
    free(dv);
    return code;
}

/* A cg_solver's. */
static int error_after(void *context, uint32_t count, double *error)
{
    struct cg_session *s = context;
    stop_after(s, count);
    return error_of(s, error);
}

/* 0: it was not found yet. */
static uint32_t known(const struct cg_session *s, const char *settings, double wanted)
{
    for (size_t i = 0; i < CG_NEEDED && i < s->n_needed; i++)
        if (!strcmp(s->needed[i].settings, settings) && !(s->needed[i].error < wanted) &&
            !(s->needed[i].error > wanted))
            return s->needed[i].iterations;
    return 0;
}

/* The iterations that the state took with other settings, or any number. */
static uint32_t guess(const struct cg_session *s, double wanted)
{
    uint32_t found = 0;
    const size_t length = strlen(s->state.name);
    for (size_t i = 0; i < CG_NEEDED && i < s->n_needed && !found; i++)
        if (!strncmp(s->needed[i].settings, s->state.name, length) &&
            s->needed[i].settings[length] == ' ')
            found = known(s, s->needed[i].settings, wanted);
    return found ? found : CG_ANY_GUESS;
}

static int find_needed(struct cg_session *s, double wanted, uint32_t *needed)
{
    struct cg_needed *new = s->needed + s->n_needed % CG_NEEDED;
    const struct cg_solver solver = {s, error_after};
    const int code = cg_search(&solver, wanted, s->plan.solved_here ? guess(s, wanted) : 0, needed);
    if (code)
        return code;
    *new = (struct cg_needed){.error = wanted, .iterations = *needed};
    memcpy(new->settings, s->settings, sizeof new->settings);
    s->n_needed++;
    return 0;
}

/* Seconds of a whole solve to an error (error=, millionths, in the mass norm). what=iterations: how
 * many it takes, which is found once. */
int cg_solve_state(void *context, struct serve_request *request, double *value)
{
    struct cg_session *s = context;
    const double wanted = 1e-6 * (double)serve_number(request, "error");
    char what[16], settings[sizeof s->settings];
    double error = 0;
    serve_word(request, "what", what, sizeof what);
    settings_of(request, settings, sizeof settings);
    uint32_t needed = known(s, settings, wanted);
    const bool counts = !strcmp(what, "iterations");
    int code = counts && needed ? 0 : cg_ready(s, request);
    if (!code && !needed)
        code = find_needed(s, wanted, &needed);
    *value = needed;
    if (code || counts)
        return code;
    stop_after(s, needed);
    code = time_solve(s, value);
    if (!code)
        code = error_of(s, &error);
    return !code && error > wanted ? serve_fail("wrong answer: an error of %g", error) : code;
}

/* The error that the default stop leaves. */
static int error(void *context, struct serve_request *request, double *value)
{
    struct cg_session *s = context;
    const int code = cg_ready(s, request);
    stop_by_default(s);
    return code ? code : error_of(s, value);
}

/* Seconds of steps= whole steps from the state on, with the default solver. */
static int step(void *context, struct serve_request *request, double *value)
{
    struct cg_session *s = context;
    const uint64_t steps = serve_number(request, "steps");
    double left = 0;
    int code = cg_ready(s, request);
    stop_by_default(s);
    if (!code)
        code = tasks_code(flow_initialise(&s->run));
    if (!code)
        code = tasks_code(duite_wait(s->rt));
    const double begin = serve_seconds();
    for (uint64_t i = 0; i < steps && !code; i++)
        code = tasks_code(flow_step(&s->run));
    if (!code)
        code = tasks_code(duite_wait(s->rt));
    *value = serve_seconds() - begin;
    if (!code)
        code = tasks_code(flow_initialise(&s->run));
    if (!code)
        code = tasks_code(flow_step(&s->run));
    if (!code)
        code = error_of(s, &left);
    if (!code && !(left < 0.5))
        code = serve_fail("wrong answer: the step's error is %g", left);
    return code;
}

const struct serve_run cg_runs[] = {{"cg", cg},     {"solve", cg_solve_state}, {"error", error},
                                    {"step", step}, {"realtime", cg_frames},   {0}};
