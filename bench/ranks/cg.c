/* An iteration of conjugate gradients on a sheet: the cloth's own tasks on one system, solved again
 * and again, against the twin. The answer is compared with plain loops: ours to the last bit. */
#include "bench/ranks/ranks.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"

#include <stdio.h>
#include <string.h>

enum { SIDE = 150, GRAIN = 1000, ITERATIONS = 400, QUICK_SIDE = 24, QUICK_GRAIN = 50 };

static struct measure_series *add(struct measure *measure, const struct bench_options *options,
                                  struct subject_shape shape, const char *run, const char *more)
{
    struct measure_series *series = measure_series(
        measure, shape, "%s side=%d grain=%d count=%d threads=%u scheduler=%s%s", run,
        options->quick ? QUICK_SIDE : SIDE, options->quick ? QUICK_GRAIN : GRAIN,
        options->quick ? 20 : ITERATIONS, shape.threads, options->scheduler, more);
    return series;
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned n = options->threads;
    const double us = 1e6 / (options->quick ? 20 : ITERATIONS);
    const struct subject_shape ours = ranks_ours(n, 1), twin = ranks_twin(n);
    const struct measure_series *r2 = add(measure, options, ours, "cg", "");
    const struct measure_series *t2 = add(measure, options, ranks_ours(0, n), "cg", "");
    const struct measure_series *r1 = add(measure, options, ranks_ours(0, 1), "cg", "");
    const struct measure_series *by_hand = add(measure, options, twin, "twin_cg", "");
    const struct measure_series *one = add(measure, options, ranks_twin(1), "twin_cg", "");
    const struct measure_series *hosts = add(measure, options, ranks_ours_on_hosts(n), "cg", "");
    const struct measure_series *twin_hosts =
        add(measure, options, ranks_twin_on_hosts(n), "twin_cg", "");
    measure_value(measure, r2, us, "us", "cg_r%u_us", n);
    measure_value(measure, by_hand, us, "us", "cg_r%u_twin_us", n);
    measure_ratio(measure, r2, by_hand, "cg_r%u_vs_twin", n);
    measure_value(measure, t2, us, "us", "cg_t%u_us", n);
    measure_ratio(measure, r2, t2, "cg_r%u_vs_t%u", n, n);
    measure_value(measure, r1, us, "us", "cg_r1_us");
    measure_ratio(measure, r1, one, "cg_r1_vs_twin");
    measure_value(measure, hosts, us, "us", "cg_hosts%u_us", n);
    measure_value(measure, twin_hosts, us, "us", "cg_hosts%u_twin_us", n);
    measure_ratio(measure, hosts, twin_hosts, "cg_hosts%u_vs_twin", n);
    static const char *const what[] = {"bytes", "messages"};
    for (int i = 0; i < 2; i++) {
        char more[32];
        snprintf(more, sizeof more, " what=%s", what[i]);
        const struct measure_series *count = add(measure, options, ours, "cg_traffic", more);
        const struct measure_series *twins = add(measure, options, twin, "twin_cg_traffic", more);
        measure_value(measure, count, 1, what[i], "cg_%s", what[i]);
        measure_ratio(measure, count, twins, "cg_%s_vs_twin", what[i]);
    }
}

/* ---- Ours ---- */

static int check(struct flow_state *state, const struct sheet *sheet)
{
    const struct flow_tables *tables = sheet_tables(sheet);
    int code = 0;
    for (uint32_t b = 0; b < tables->n_blocks && !code; b++) {
        const struct flow_table *t = tables->block + b;
        code = tasks_code(duite_get(state->rt, state->block[b].dv, state->rows));
        if (!code && memcmp(state->rows, sheet->answer + t->first, t->n * sizeof(phys_vec)) != 0)
            code = serve_fail("wrong answer in block %u", b);
    }
    return code;
}

/* Solves by so many iterations the system that the last step left. */
static int solve(struct flow_state *state, struct sheet *sheet, uint32_t count, double *seconds)
{
    sheet->model.max_iterations = state->flow->received.max_iterations = count;
    int code = duite_wait(state->rt);
    const double start = serve_seconds();
    if (!code)
        code = flow_cg(state);
    if (!code)
        code = duite_wait(state->rt);
    *seconds = serve_seconds() - start;
    return tasks_code(code);
}

/* A step, which makes the system, and a solve to get warm. */
static int begin(struct flow_state *state, struct sheet *sheet, uint32_t count)
{
    double seconds;
    struct flow_block_args args = {0};
    int code = flow_run_begin(state);
    for (; args.block < state->head.n_blocks && !code; args.block++)
        code = DUITE_FORK(state->rt, &sheet_wave_kernel, &args, state->block[args.block].table);
    if (!code)
        code = flow_cg_record(state);
    if (!code)
        code = flow_initialise(state);
    if (!code)
        code = flow_step(state);
    return code ? tasks_code(code) : solve(state, sheet, count / 10 + 1, &seconds);
}

static void end(struct flow_state *state)
{
    flow_objects_free(state);
    duite_wait(state->rt);
    flow_memory_free(state);
}

/* Bytes or messages of all ranks in an iteration: what a longer solve has more. */
static int traffic(struct flow_state *state, struct sheet *sheet, uint32_t count, bool bytes,
                   double *value)
{
    duite_counters before, between, after;
    double seconds;
    int code = tasks_code(duite_count_all(state->rt, &before));
    if (!code)
        code = solve(state, sheet, 2 * count, &seconds);
    if (!code)
        code = tasks_code(duite_count_all(state->rt, &between));
    if (!code)
        code = solve(state, sheet, count, &seconds);
    if (!code)
        code = tasks_code(duite_count_all(state->rt, &after));
    if (code)
        return code;
    const double more = bytes ? (double)(between.bytes - before.bytes)
                              : (double)(between.messages - before.messages);
    const double less =
        bytes ? (double)(after.bytes - between.bytes) : (double)(after.messages - between.messages);
    *value = (more - less) / count;
    return 0;
}

static int run(struct ranks_session *session, struct serve_request *request, double *value)
{
    struct sheet *sheet = &session->sheet;
    const uint32_t side = (uint32_t)serve_number(request, "side");
    const uint32_t grain = (uint32_t)serve_number(request, "grain");
    const uint32_t count = (uint32_t)serve_number(request, "count");
    char what[16];
    duite *rt = NULL;
    serve_word(request, "what", what, sizeof what);
    int code = sheet_ready(sheet, side, grain);
    if (!code)
        code = sheet_solve(sheet, count);
    sheet->model.max_iterations = 2;
    if (!code)
        code = sheet_flow(sheet);
    if (!code)
        code = ranks_start_cloth(session, request, &rt);
    if (code)
        return code;
    struct flow_report report = {0};
    struct flow_state state = {.flow = sheet->flow, .rt = rt, .report = &report};
    code = begin(&state, sheet, count);
    if (!code)
        code = *what ? traffic(&state, sheet, count, !strcmp(what, "bytes"), value)
                     : solve(&state, sheet, count, value);
    if (!code)
        code = check(&state, sheet);
    end(&state);
    return ranks_stop(&rt, code);
}

static int ours(void *context, struct serve_request *request, double *value)
{
    return run(context, request, value);
}

/* ---- The twin ---- */

static int by_hand(void *context, struct serve_request *request, double *value)
{
    struct sheet *sheet = &((struct ranks_session *)context)->sheet;
    struct twin_traffic traffic;
    char what[16];
    serve_word(request, "what", what, sizeof what);
    int code = sheet_ready(sheet, (uint32_t)serve_number(request, "side"),
                           (uint32_t)serve_number(request, "grain"));
    if (!code)
        code = twin_solve(sheet, (uint32_t)serve_number(request, "count"), value, &traffic);
    if (!code && *what)
        *value = !strcmp(what, "bytes") ? traffic.bytes : traffic.messages;
    return code;
}

static const struct serve_run RUNS[] = {
    {"cg", ours}, {"cg_traffic", ours}, {"twin_cg", by_hand}, {"twin_cg_traffic", by_hand}, {0}};

const struct bench_case ranks_cg = {
    "cg", "an iteration of conjugate gradients on a sheet, over ranks and hosts", plan, RUNS, 0};
