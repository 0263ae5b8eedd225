/* The same steps with and without velocity correction: a sheet in which edges would be stretched
 * too far in nearly every step. */
#include "bench/garments/garments.h"

#include "bench/cg/cg.h"
#include "bench/sets.h"
#include "bench/tasks/tasks.h"
#include "cloth/scene/scene.h"

#include <inttypes.h>

static const double AT = 0.05, TOLERANCE = 0.01;

static int read_hanging(struct model *model, bool corrected, bool quick)
{
    struct cloth_error error = {0};
    struct sets sets = {0};
    if (quick) {
        add_set(&sets, "cloths[0].mesh.grid.nx=40");
        add_set(&sets, "cloths[0].mesh.grid.ny=40");
        add_set(&sets, "grain=300");
    }
    if (corrected)
        add_set(&sets, "materials.cotton.velocity_correction={at: %g, tolerance: %g}", AT,
                TOLERANCE);
    return scene_read(model, BENCH_HANGING_SCENE, sets.n, sets.set, &error)
               ? serve_fail("%s", error.text)
               : 0;
}

/* Without it edges are stretched further than they may; with it no edge is, and there was much to
 * do. A run ends where the one before it ended. */
static int check(const struct flow_report *report, bool corrected)
{
    static uint64_t before[2];
    const uint64_t hash = before[corrected];
    const double limit = 1 + AT + TOLERANCE;
    before[corrected] = report->state_hash;
    if (hash && hash != report->state_hash)
        return serve_fail("wrong answer: it ends at %016" PRIx64 ", not at %016" PRIx64,
                          report->state_hash, hash);
    if (!corrected && report->max_stretch < limit)
        return serve_fail("edges are stretched by %g only", report->max_stretch);
    if (corrected && (report->max_stretch > limit + 1e-9 || report->corrections_unmet ||
                      4 * report->correction_rounds < report->steps))
        return serve_fail("wrong answer: edges are stretched by %g after %" PRIu64
                          " rounds in %" PRIu64 " steps",
                          report->max_stretch, report->correction_rounds, report->steps);
    return 0;
}

static int run_model(struct serve_request *request, const struct model *model,
                     struct flow_report *report)
{
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    duite *rt = NULL;
    duite_options options = duite_options_default();
    int code = cg_make_flow(model, &flow);
    if (!code) {
        options.kernels = flow_kernels();
        options.context = flow;
        options.threads = (unsigned)serve_number(request, "threads");
        code = tasks_code(duite_start(&rt, &options));
    }
    if (!code && flow_run(flow, rt, NULL, NULL, report, &error))
        code = serve_fail("%s", error.text);
    if (rt && duite_stop(&rt) && !code)
        code = tasks_code(1);
    flow_free(flow);
    return code;
}

static int run_hanging(void *context, struct serve_request *request, double *value)
{
    struct model model = {0};
    struct flow_report report = {0};
    const bool corrected = serve_number(request, "corrected") != 0;
    (void)context;
    int code = read_hanging(&model, corrected, serve_number(request, "quick") != 0);
    if (!code)
        code = run_model(request, &model, &report);
    if (!code)
        code = check(&report, corrected);
    if (!code)
        *value = report.wall_seconds / (double)report.steps;
    model_free(&model);
    return code;
}

const struct serve_run garments_correction_runs[] = {{"hanging", run_hanging}, {0}};

static void plan(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite", 0, options->threads};
    struct measure_series *series[2];
    for (int corrected = 0; corrected < 2; corrected++)
        series[corrected] =
            measure_series(measure, ours, "hanging threads=%u quick=%d corrected=%d",
                           options->threads, options->quick, corrected);
    measure_value(measure, series[1], 1e3, "ms", "velocity_correction_ms_per_step");
    measure_ratio(measure, series[1], series[0], "velocity_correction_cost");
}

const struct bench_case garments_correction = {
    "correction",
    "a sheet of 34,969 vertices that begins to hang from two patches: a step with velocity "
    "correction, of edges that would be stretched by more than 5 %, against the same without",
    plan, garments_correction_runs, 6};
