/* Between duite_start and duite_stop MPI belongs to the runtime; before and after, the ranks agree
 * here about errors, so that all of them leave by the same way and one of them prints. */
#include "cloth/simulate.h"

#include "cloth/base/memory.h"
#include "cloth/output/output.h"
#include "cloth/outputs.h"
#include "cloth/progress.h"
#include "cloth/room.h"
#include "cloth/start.h"
#include "cloth/summary.h"

#include <math.h>
#include <mpi.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <xxhash.h>

struct run {
    const struct simulate_options *options;
    int rank, ranks;
    unsigned threads;
    struct model model;
    struct flow *flow;
    struct contact_apart apart; /* rank 0: of the model, with what the flow attached */
    struct outputs outputs;     /* rank 0 */
    bool wants_frames;          /* the same on all ranks */
    struct progress progress;
    struct flow_report report;
    struct untangle_result untangled; /* rank 0 */
    struct mesh_elastic *elastic;     /* rank 0: of each material */
    struct cloth_error untraced;      /* why the trace is not whole */
    bool intersects;                  /* some were found; the same on all ranks */
    bool stopped_before;              /* asked to stop before it began */
};

static atomic_int stop_requested; /* read by all threads, written by the signal's handler */

static void request_stop(int signal)
{
    (void)signal;
    atomic_store_explicit(&stop_requested, 1, memory_order_relaxed);
}

static int stop_wanted(void *context)
{
    (void)context;
    return atomic_load_explicit(&stop_requested, memory_order_relaxed);
}

void simulate_catch_signals(void)
{
    struct sigaction action = {.sa_handler = request_stop, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, NULL);
    action.sa_handler = SIG_IGN; /* the write fails with EFBIG, and that is said */
    sigaction(SIGXFSZ, &action, NULL);
}

/* The code of the lowest rank that failed, on all ranks; that rank prints its sentence. Collective.
 */
static int agree(const struct run *run, const struct cloth_error *error)
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

/* Found before the run, so that what is written after it, or as it runs, is not lost. */
static int check_file(const struct run *run, const char *option, const char *path,
                      struct cloth_error *error)
{
    struct cloth_error inner = {0};
    struct stat file, read;
    for (uint32_t i = 0; i < run->model.n_files && stat(path, &file) == 0; i++)
        if (stat(run->model.files[i], &read) == 0 && file.st_dev == read.st_dev &&
            file.st_ino == read.st_ino)
            return cloth_fail(error, CLOTH_E_INPUT, "%s %s: this is %s, which would be lost",
                              option, path, i ? "a file that the scene reads" : "the scene itself");
    const int code = output_report_check(path, run->options->output, &inner);
    return code ? cloth_fail(error, code, "%s %s: %s", option, path, inner.text) : code;
}

/* Rank 0 alone reads the scene, so it is compared what the ranks were asked to read. Collective;
 * the same on all ranks. */
static int check_same(const struct run *run, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    uint64_t asked = XXH64(options->scene, strlen(options->scene), 0), first;
    for (size_t i = 0; i < options->n_sets; i++)
        asked = XXH64(options->sets[i].text, strlen(options->sets[i].text), asked);
    first = asked;
    MPI_Bcast(&first, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    int other = asked == first ? run->ranks : run->rank;
    MPI_Allreduce(MPI_IN_PLACE, &other, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (other == run->ranks)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "ranks 0 and %d were started with different scenes, or different values for "
                      "them (--set and the like): give all ranks the same",
                      other);
}

/* While there are meshes. */
static int find_elastic(struct run *run, struct cloth_error *error)
{
    run->elastic = calloc(run->model.n_materials, sizeof *run->elastic);
    if (!run->elastic)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the moduli of materials");
    for (uint32_t i = 0; i < run->model.n_materials; i++)
        run->elastic[i] = model_elastic(&run->model, i);
    return CLOTH_OK;
}

/* Rank 0 reads the scene and cuts it into blocks, unless it is asked to stop; the others are sent
 * their blocks by the run. */
static int read_and_cut(struct run *run, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    int code = scene_read(&run->model, options->scene, options->n_sets, options->sets, error);
    if (!code && !stop_wanted(NULL))
        code = flow_prepare(&run->flow, &run->model, run->ranks, error);
    if (!code && run->flow)
        code = start_untangle(&run->model, &run->flow, run->ranks, !options->quiet, &run->untangled,
                              error);
    run->apart = run->model.contact.apart;
    if (!code && run->flow)
        run->apart.attached = flow_attached(run->flow);
    if (!code && run->flow)
        run->apart.n_vertices = (uint32_t)flow_vertices(run->flow);
    if (!code)
        code = find_elastic(run, error);
    if (!code && options->report)
        code = check_file(run, "--report", options->report, error);
    if (!code && options->trace)
        code = check_file(run, "--trace (or DUITE_TRACE)", options->trace, error);
    return code;
}

/* Whether any rank was asked to stop before the run begins. Collective; the same on all ranks. */
static bool check_stop(struct run *run)
{
    int wanted = stop_wanted(NULL);
    MPI_Allreduce(MPI_IN_PLACE, &wanted, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    run->stopped_before = wanted;
    if (wanted && run->rank == 0)
        fprintf(stderr, "duite-cloth: stopped as asked by SIGUSR1 before the first step; nothing "
                        "was written\n");
    return wanted;
}

/* Only rank 0 knows whether the scene asks for frames. Collective. */
static void agree_on_frames(struct run *run)
{
    const struct simulate_options *options = run->options;
    int wanted = options->output || options->check_intersections || run->outputs.drape;
    MPI_Bcast(&wanted, 1, MPI_INT, 0, MPI_COMM_WORLD);
    run->wants_frames = wanted;
}

/* All that can be wrong with the input, then the folder of frames. */
static int prepare(struct run *run)
{
    const struct simulate_options *options = run->options;
    struct cloth_error error = {0};
    if (check_same(run, &error))
        return agree(run, &error);
    if (run->rank == 0)
        read_and_cut(run, &error);
    else
        flow_join(&run->flow, &error);
    const int code = agree(run, &error);
    if (code || check_stop(run))
        return code;
    const char *warning;
    for (uint32_t i = 0; run->rank == 0 && i < run->model.n_warnings; i++)
        fprintf(stderr, "duite-cloth: warning: %s\n", run->model.warnings[i]);
    for (size_t i = 0; run->rank == 0 && (warning = flow_warning(run->flow, i)); i++)
        fprintf(stderr, "duite-cloth: warning: %s\n", warning);
    if (run->rank == 0 && run->model.n_probes && !options->output)
        fprintf(stderr, "duite-cloth: warning: the scene has probes, whose table is written into "
                        "the folder of --output; there is none\n");
    if (run->rank == 0 && options->output)
        room_check(&run->model, run->flow, options->output, &error);
    if (!error.code && run->rank == 0 && model_certifies(&run->model))
        start_check(&run->model, run->flow, &run->apart, options->scene, &error);
    if (!error.code && run->rank == 0)
        outputs_open(&run->outputs, options, &run->model, run->flow, &run->apart, &error);
    agree_on_frames(run);
    return agree(run, &error);
}

/* The blocks have all they need of the meshes. */
static void forget_meshes(void *context)
{
    struct run *run = context;
    for (uint32_t i = 0; i < run->model.n_cloths; i++)
        mesh_free(&run->model.cloths[i].mesh);
}

static void show_step(void *context, uint64_t step, uint64_t steps, uint64_t cg_iterations)
{
    struct run *run = context;
    if (!run->options->quiet)
        progress_step(&run->progress, step, steps, cg_iterations, run->report.contacts_now);
}

static int runtime_fails(struct cloth_error *error, int code)
{
    bool lost = code == DUITE_E_LOST || code == DUITE_E_MPI;
    int ours = lost ? CLOTH_E_LOST : CLOTH_E_LIBRARY;
    return code ? cloth_fail(error, ours, "%s", duite_message()) : CLOTH_OK;
}

/* Nobody is there to agree with on who prints. */
static int say_lost(const struct run *run, const struct cloth_error *error)
{
    fprintf(stderr, "duite-cloth: rank %d ends: %s\n", run->rank, error->text);
    return CLOTH_E_LOST;
}

/* Puts the scene before an error. */
static void name_scene(const char *scene, struct cloth_error *error)
{
    struct cloth_error named = {0};
    cloth_fail(&named, error->code, "%.200s: %.800s", scene, error->text);
    *error = named;
}

static void run_flow(struct run *run, duite *rt, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    const struct flow_output output = {.context = &run->outputs,
                                       .frame = run->wants_frames ? outputs_frame : NULL,
                                       .force = options->output ? outputs_force : NULL,
                                       .row = options->output ? outputs_row : NULL,
                                       .system = options->save_system ? outputs_system : NULL};
    const struct flow_progress progress = {run, forget_meshes, show_step, stop_wanted};
    run->threads = duite_threads(rt);
    progress_begin(&run->progress);
    flow_run(run->flow, rt, run->wants_frames || options->save_system ? &output : NULL, &progress,
             &run->report, error);
    progress_end(&run->progress);
    if (error->code == CLOTH_E_INPUT) /* a start that only the first look finds to touch */
        name_scene(options->scene, error);
}

static int execute(struct run *run)
{
    struct cloth_error error = {0};
    duite *rt = NULL;
    duite_options options = duite_options_default();
    options.kernels = flow_kernels();
    options.context = run->flow;
    options.threads = run->options->threads;
    options.scheduler = run->options->scheduler;
    options.mapping = run->options->mapping;
    options.balance = run->options->balance;
    options.seed = run->options->seed;
    options.trace = run->options->trace;
    options.trace_first = run->options->trace_first;
    options.trace_end = run->options->trace_end;
    if (!runtime_fails(&error, duite_start(&rt, &options))) {
        run_flow(run, rt, &error);
        if (!error.code && duite_trace_end(rt))
            cloth_fail(&run->untraced, CLOTH_E_IO, "%s", duite_message());
        int code = duite_stop(&rt);
        if (!error.code)
            runtime_fails(&error, code);
    }
    outputs_close(&run->outputs, &error);
    return error.code == CLOTH_E_LOST ? say_lost(run, &error) : agree(run, &error);
}

static void say_stopped(const struct run *run)
{
    const struct flow_report *report = &run->report;
    fprintf(stderr, "duite-cloth: stopped as asked by SIGUSR1 after step %llu, at %g of %g s",
            (unsigned long long)report->steps, report->simulated_seconds, run->model.end);
    if (run->options->output)
        fprintf(stderr, "; the last frame is %llu", (unsigned long long)report->last_frame);
    fputc('\n', stderr);
}

static void warn_of_motion(const struct run *run)
{
    const struct model_rest *rest = &run->model.rest;
    if (rest->speed > 0 && !run->report.stopped && isnan(run->report.rest_seconds))
        fprintf(stderr,
                "duite-cloth: warning: the cloth is not at rest at time.end, %g s: some vertex "
                "was faster than %g m/s in the last %g s, or something was still to move or "
                "vary\n",
                run->model.end, rest->speed, rest->hold);
}

/* Collective. */
static void count_intersections(struct run *run)
{
    int intersects = 0;
    if (run->outputs.intersections) {
        run->outputs.found = intersections_found(run->outputs.intersections);
        intersects = run->outputs.found.bad > 0;
    }
    MPI_Bcast(&intersects, 1, MPI_INT, 0, MPI_COMM_WORLD);
    run->intersects = intersects;
}

static int conclude(struct run *run)
{
    struct cloth_error error = {0};
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
    uint64_t workers = run->threads, peak = 1024 * (uint64_t)usage.ru_maxrss; /* Linux counts KiB */
    MPI_Allreduce(MPI_IN_PLACE, &workers, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &peak, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    double path = NAN, bound = NAN;
    count_intersections(run);
    struct outputs *outputs = &run->outputs;
    if (outputs->drape)
        drape_find(outputs->drape, &outputs->drapes, &error);
    if (run->rank == 0 && run->options->trace)
        duite_trace_bounds(run->options->trace, &path, &bound); /* else it has none */
    if (run->rank == 0) {
        const struct summary summary = {.options = run->options,
                                        .model = &run->model,
                                        .report = &run->report,
                                        .untangled = &run->untangled,
                                        .elastic = run->elastic,
                                        .intersections =
                                            outputs->intersections ? &outputs->found : NULL,
                                        .drape = outputs->drape ? &outputs->drapes : NULL,
                                        .ranks = run->ranks,
                                        .threads = run->threads,
                                        .workers = workers,
                                        .memory_bytes = peak,
                                        .critical_path = path,
                                        .lower_bound = bound};
        if (run->report.stopped)
            say_stopped(run);
        intersections_say(&outputs->found, "duite-cloth");
        warn_of_motion(run);
        if (run->options->report)
            summary_write(&summary, run->options->report, &error);
        if (!run->options->quiet)
            summary_print(stdout, &summary);
    }
    const int code = agree(run, &error);
    return code ? code : agree(run, &run->untraced);
}

/* The exit code of a run that began. done: if nothing failed. */
static int code_of(int failure, int done)
{
    if (failure == CLOTH_E_LOST)
        return SIMULATE_LOST;
    if (failure == CLOTH_E_INPUT)
        return SIMULATE_BAD_INPUT;
    return failure ? SIMULATE_FAILED : done;
}

int simulate(const struct simulate_options *options)
{
    struct run run = {.options = options};
    int code = SIMULATE_BAD_INPUT;
    MPI_Comm_rank(MPI_COMM_WORLD, &run.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &run.ranks);
    int failure = prepare(&run);
    if (failure == CLOTH_E_MEMORY || failure == CLOTH_E_LIBRARY || failure == CLOTH_E_IO)
        code = SIMULATE_FAILED;
    if (!failure && run.stopped_before)
        code = SIMULATE_OK;
    else if (!failure) {
        failure = execute(&run);
        if (!failure)
            failure = conclude(&run);
        const int done = run.intersects ? SIMULATE_INTERSECTS : SIMULATE_OK;
        code = code_of(failure, done);
    }
    struct cloth_error ignored = {0};
    outputs_close(&run.outputs, &ignored);
    outputs_free(&run.outputs);
    flow_free(run.flow);
    free(run.elastic);
    model_free(&run.model);
    return code;
}
