/* MPI belongs to the runtime between duite_start and duite_stop. Before and after, the ranks agree
 * here about errors, so that all take the same way out and one of them prints. */
#include "cloth/app/simulate_run.h"

#include "cloth/app/report/summary.h"
#include "tools/predict/predict.h"

#include <inttypes.h>
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

int simulate_agree(const struct run *run, const struct cloth_error *error)
{
    int first = error->code ? run->rank : run->ranks, code = error->code;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first == run->ranks)
        return CLOTH_OK;
    MPI_Bcast(&code, 1, MPI_INT, first, MPI_COMM_WORLD);
    if (run->rank != first)
        return code;
    if (first > 0)
        fprintf(stderr, "duite-cloth: rank %d: %s\n", first, error->text);
    else
        fprintf(stderr, "duite-cloth: %s\n", error->text);
    return code;
}

/* The blocks have all they need of the meshes; the summary names low triangles. */
static void forget_meshes(void *context)
{
    struct run *run = context;
    for (uint32_t i = 0; i < run->model->n_cloths; i++) {
        struct model_cloth *cloth = run->model->cloths + i;
        flow_find_low(run->model, i, &cloth->low);
        mesh_free(&cloth->mesh);
    }
}

static void show_step(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations)
{
    struct run *run = context;
    const struct progress_counts counts = {.frames = run->outputs.frames_written,
                                           .cg_iterations = cg_iterations,
                                           .contacts = run->report.contacts_now,
                                           .seams_open = run->report.seams_open,
                                           .seam_distance = run->report.seam_distance};
    if (!run->options->quiet)
        progress_step(&run->progress, step, steps, &counts);
}

static int runtime_fails(struct cloth_error *error, int code)
{
    bool lost = code == DUITE_E_LOST || code == DUITE_E_MPI;
    int ours = lost ? CLOTH_E_LOST : CLOTH_E_LIBRARY;
    return code ? cloth_fail(error, ours, "%s", duite_message()) : CLOTH_OK;
}

/* Each rank prints for itself: the ranks can no longer agree. */
static int say_lost(const struct run *run, const struct cloth_error *error)
{
    fprintf(stderr, "duite-cloth: rank %d ends: %s\n", run->rank, error->text);
    return CLOTH_E_LOST;
}

/* Puts the scene before an error. */
static void simulate_name_scene(const char *scene, struct cloth_error *error)
{
    struct cloth_error named = {0};
    cloth_fail(&named, error->code, "%.200s: %.800s", scene, error->text);
    *error = named;
}

/* Asked on rank 0 alone. */
static int is_due(void *context)
{
    const struct run *run = context;
    return run->outputs.keeper && keeper_due(run->outputs.keeper);
}

static void run_flow(struct run *run, duite *rt, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    const bool last = phases_is_last(&run->phases), goes_on = run->phases.n > 1;
    struct flow_output output = {.before = phases_before(&run->phases),
                                 .first_frame = options->first_frame,
                                 .end_frame = options->last_frame + 1, /* 0: none */
                                 .end = last ? NULL : run->phases.end};
    outputs_receive(&run->outputs, options, run->wants_frames, last, &output);
    const bool wants = run->wants_frames || options->save_system || goes_on;
    const struct flow_progress progress = {run, forget_meshes,
                                           options->check ? simulate_check_step : show_step,
                                           options->check ? simulate_check_ends : simulate_stops,
                                           options->checkpoint > 0 ? is_due : NULL};
    const char *from;
    run->threads = duite_threads(rt);
    run->cores = duite_cores(rt, &from);
    snprintf(run->cores_from, sizeof run->cores_from, "%s", from);
    progress_begin(&run->progress, phases_label(&run->phases, run->phases.now));
    flow_run(run->flow, rt, wants ? &output : NULL, &progress, &run->report, error);
    progress_end(&run->progress);
    if (error->code == CLOTH_E_INPUT) /* a start that only the first look finds to touch */
        simulate_name_scene(options->scene, error);
}

static void say_stopped(const struct run *run)
{
    const struct flow_report *report = &run->phases.total;
    const char *phase = phases_label(&run->phases, run->phases.now);
    double end = 0;
    for (uint32_t i = 0; i < run->phases.n; i++)
        end += run->phases.models[i].end;
    fprintf(stderr, "duite-cloth: stopped as asked by a signal after step %llu, at %g of %g s",
            (unsigned long long)report->steps, report->simulated_seconds, end);
    if (phase)
        fprintf(stderr, ", in phase '%.60s'", phase);
    if (run->options->output)
        fprintf(stderr, "; the last frame is %llu", (unsigned long long)report->last_frame);
    fputc('\n', stderr);
}

/* Warns, on rank 0, of motion left at the end of the phase that ran. */
static void warn_of_motion(const struct run *run)
{
    const struct model_rest *rest = &run->model->rest;
    if (rest->speed > 0 && !run->report.stopped && isnan(run->report.rest_seconds))
        fprintf(stderr,
                "duite-cloth: warning: the cloth is not at rest at time.end, %g s: some vertex "
                "was faster than %g m/s in the last %g s, or something was still to move or "
                "vary\n",
                run->model->end, rest->speed, rest->hold);
}

static void simulate_warn_of_edges(const struct run *run)
{
    const struct flow_report *report = &run->phases.total;
    if (report->corrections_unmet)
        fprintf(
            stderr,
            "duite-cloth: warning: after %llu of %llu steps edges are over the limit of "
            "velocity_correction and its tolerance, by up to %g of their length: rounds are too "
            "few, or pins or the load hold them apart\n",
            (unsigned long long)report->corrections_unmet, (unsigned long long)report->steps,
            report->correction_excess);
}

int simulate_execute(struct run *run)
{
    struct cloth_error error = {0};
    duite *rt = NULL;
    run->untraced = (struct cloth_error){0}; /* the files of the phase before are replaced */
    duite_options options = run->options->runtime;
    options.kernels = flow_kernels();
    options.context = run->flow;
    options.trace = run->options->check ? NULL : options.trace;
    if (!runtime_fails(&error, duite_start(&rt, &options))) {
        run_flow(run, rt, &error);
        if (!error.code && duite_trace_end(rt))
            cloth_fail(&run->untraced, CLOTH_E_IO, "%s", duite_message());
        int code = duite_stop(&rt);
        if (!error.code)
            runtime_fails(&error, code);
    }
    phases_name(&run->phases, &error);
    if (error.code || phases_is_last(&run->phases) || run->report.stopped)
        outputs_close(&run->outputs, &error);
    else if (run->rank == 0)
        warn_of_motion(run);
    if (!error.code)
        phases_add(&run->phases, &run->report);
    return error.code == CLOTH_E_LOST ? say_lost(run, &error) : simulate_agree(run, &error);
}

/* All phases, or those up to a stop. */
static int run_phases(struct run *run)
{
    int code = simulate_execute(run);
    while (!code && !run->report.stopped && !phases_are_over(&run->phases)) {
        code = simulate_next(run);
        if (code || run->stopped_before)
            break;
        code = simulate_execute(run);
    }
    if (!code && !phases_is_last(&run->phases)) { /* between two phases: nothing else closed them */
        struct cloth_error error = {0};
        outputs_close(&run->outputs, &error);
        return simulate_agree(run, &error);
    }
    return code;
}

/* Both stay no numbers if the trace is not whole. */
static void find_bounds(const char *trace, double *path, double *lower)
{
    struct trace_run *traced;
    struct predict_bounds bounds;
    if (trace_read(&traced, trace, false))
        return;
    if (!predict_bounds(traced, &bounds)) {
        *path = bounds.path;
        *lower = bounds.lower;
    }
    predict_bounds_free(&bounds);
    trace_run_free(traced);
}

struct summary simulate_sum_up(const struct run *run, const struct flow_report *report)
{
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
    uint64_t workers = run->threads, peak = 1024 * (uint64_t)usage.ru_maxrss; /* Linux counts KiB */
    MPI_Allreduce(MPI_IN_PLACE, &workers, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &peak, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    return (struct summary){.options = run->options,
                            .model = run->model,
                            .report = report,
                            .phases = &run->phases,
                            .untangled = &run->untangled,
                            .elastic = run->elastic,
                            .ranks = run->ranks,
                            .threads = run->threads,
                            .cores = run->cores,
                            .cores_from = run->cores_from,
                            .workers = workers,
                            .memory_bytes = peak,
                            .critical_path = NAN,
                            .lower_bound = NAN};
}

/* True, on rank 0, if the run ended before the first frame that was asked for. */
static bool made_no_frame(const struct run *run)
{
    const uint64_t first = run->options->first_frame, n = run->phases.total.frames;
    if (!first || n > first)
        return false;
    fprintf(stderr,
            "duite-cloth: warning: the run ended before frame %" PRIu64
            ", where --frames begins: no frame was made\n",
            first);
    return true;
}

/* On rank 0. */
static void report_run(struct run *run, struct summary *summary, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    struct outputs *outputs = &run->outputs;
    summary->intersections = options->check_intersections ? &outputs->found : NULL;
    const bool none = made_no_frame(run);
    summary->drape = outputs->drape.n && !none ? &outputs->drapes : NULL;
    if (options->runtime.trace)
        find_bounds(options->runtime.trace, &summary->critical_path, &summary->lower_bound);
    if (run->report.stopped || run->stopped_before)
        say_stopped(run);
    intersections_say(&outputs->found, "duite-cloth");
    if (!run->stopped_before) /* else it has warned */
        warn_of_motion(run);
    simulate_warn_of_edges(run);
    if (options->report)
        summary_write(summary, options->report, error);
    if (!options->quiet)
        summary_print(stdout, summary);
}

static int simulate_conclude(struct run *run)
{
    struct cloth_error error = {0};
    struct summary summary = simulate_sum_up(run, &run->phases.total);
    int intersects = run->outputs.found.bad > 0;
    MPI_Bcast(&intersects, 1, MPI_INT, 0, MPI_COMM_WORLD);
    run->intersects = intersects;
    if (run->outputs.drape.n)
        drape_find(&run->outputs.drape, &run->outputs.drapes, &error);
    if (run->rank == 0)
        report_run(run, &summary, &error);
    const int code = simulate_agree(run, &error);
    const int unwritten = simulate_agree(run, &run->outputs.hdf5.unwritten);
    const int untraced = simulate_agree(run, &run->untraced);
    return code ? code : unwritten ? unwritten : untraced;
}

/* The exit code of a run that ended with a cloth_code. */
static int code_of(const struct run *run, int code)
{
    const bool stopped = run->report.stopped || run->stopped_before;
    if (code == CLOTH_E_LOST)
        return SIMULATE_LOST;
    if (code == CLOTH_E_INPUT)
        return SIMULATE_BAD_INPUT;
    if (code)
        return SIMULATE_FAILED;
    return stopped ? SIMULATE_STOPPED : run->intersects ? SIMULATE_INTERSECTS : SIMULATE_OK;
}

int simulate(const struct simulate_options *options)
{
    struct simulate_options found = *options;
    struct run run = {.options = &found, .asked = options->scene};
    MPI_Comm_rank(MPI_COMM_WORLD, &run.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &run.ranks);
    char *shipped =
        run.rank == 0 ? shipped_scene(options->scene) : NULL; /* rank 0 alone reads it */
    if (shipped)
        found.scene = shipped;
    int code = simulate_prepare(&run);
    const bool begins = !code && !run.stopped_before;
    if (code == CLOTH_E_RUN) /* a start whose places no check can take */
        code = CLOTH_E_INPUT;
    if (begins && options->check)
        code = simulate_check(&run);
    else if (begins) {
        code = run_phases(&run);
        code = code ? code : simulate_conclude(&run);
    }
    struct cloth_error ignored = {0};
    outputs_close(&run.outputs, &ignored);
    outputs_free(&run.outputs);
    flow_free(run.flow);
    free(run.elastic);
    phases_free(&run.phases);
    output_checkpoint_free(&run.restart.checkpoint);
    free(shipped);
    return code_of(&run, code);
}
