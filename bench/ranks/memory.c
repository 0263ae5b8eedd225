/* The most memory that the largest rank ever held, from its start to its end, of a run of a large
 * sheet: four ranks against one. */
#include "bench/ranks/ranks.h"

static struct measure_series *add(struct measure *measure, const struct bench_options *options,
                                  unsigned ranks)
{
    struct measure_series *series = measure_series(
        measure, ranks_ours(ranks, 1), "memory side=%u grain=%u threads=1 scheduler=%s",
        options->quick ? 30 : 1000, options->quick ? 50 : 1000, options->scheduler);
    series->fresh = true;
    return series;
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *four = add(measure, options, 4);
    const struct measure_series *one = add(measure, options, 1);
    measure_value(measure, one, 1e-6, "MB", "memory_r1");
    measure_value(measure, four, 1e-6, "MB", "memory_r4");
    measure_ratio(measure, four, one, "memory_r4_vs_r1");
}

static void forget_mesh(void *context)
{
    struct sheet *sheet = context;
    mesh_free(&sheet->cloth.mesh);
}

static int run(struct ranks_session *session, struct serve_request *request)
{
    struct sheet *sheet = &session->sheet;
    struct cloth_error error = {0};
    struct flow_report report;
    const struct flow_progress progress = {.context = sheet, .distributed = forget_mesh};
    duite *rt = NULL;
    const uint32_t side = (uint32_t)serve_number(request, "side");
    sheet_model(sheet, side, (uint32_t)serve_number(request, "grain"));
    if (sheet_own_rank() == 0 && mesh_grid(&sheet->cloth.mesh, 1, 1, side, side, MESH_SAME, &error))
        return serve_fail("%s", error.text);
    int code = sheet_flow(sheet);
    if (code)
        return code;
    code = ranks_start_cloth(session, request, &rt);
    if (!code && flow_run(sheet->flow, rt, NULL, &progress, &report, &error))
        code = serve_fail("%s", error.text);
    if (!code && report.cg_iterations_total != sheet->model.max_iterations)
        code = serve_fail("wrong answer: %g iterations", (double)report.cg_iterations_total);
    return ranks_stop(&rt, code);
}

static int memory(void *context, struct serve_request *request, double *value)
{
    struct ranks_session *session = context;
    const int code = run(session, request);
    *value = (double)serve_most_bytes();
    sheet_free(&session->sheet);
    return code;
}

static const struct serve_run RUNS[] = {{"memory", memory}, {0}};

const struct bench_case ranks_memory = {
    "memory", "peak memory of a sheet of 1,000,000 vertices, 4 ranks against 1", plan, RUNS, 3};
