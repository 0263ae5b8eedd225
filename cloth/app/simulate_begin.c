/* The begin of a phase: errors are found before it writes anything. Only rank 0 has models; it
 * tells the others the parts they need. */
#include "cloth/app/simulate_run.h"

#include "cloth/app/run/start.h"
#include "cloth/base/memory.h"
#include "cloth/output/output.h"

#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <xxhash.h>

/* Checks a file before the run, so that later output is not lost. */
static int simulate_begin_check_file(const struct run *run, const char *option, const char *path,
                                     struct cloth_error *error)
{
    struct cloth_error inner = {0};
    struct stat file, read;
    for (uint32_t i = 0; i < run->model->n_files && stat(path, &file) == 0; i++)
        if (stat(run->model->files[i], &read) == 0 && file.st_dev == read.st_dev &&
            file.st_ino == read.st_ino)
            return cloth_fail(error, CLOTH_E_INPUT, "%s %s: this is %s, which would be lost",
                              option, path, i ? "a file that the scene reads" : "the scene itself");
    const int code = output_report_check(path, run->options->output, &inner);
    return code ? cloth_fail(error, code, "%s %s: %s", option, path, inner.text) : code;
}

/* Checks that all ranks were asked to read the same, as only rank 0 reads the scene. Collective;
 * the same on all ranks. */
static int check_same(const struct run *run, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    uint64_t asked = XXH64(run->asked, strlen(run->asked), 0), first;
    for (size_t i = 0; i < options->n_sets; i++)
        asked = XXH64(options->sets[i].text, strlen(options->sets[i].text), asked);
    asked = XXH64(&options->checkpoint, sizeof options->checkpoint, asked + !options->restart);
    asked = XXH64(&options->first_frame, sizeof options->first_frame, asked);
    asked = XXH64(&options->last_frame, sizeof options->last_frame, asked);
    first = asked;
    MPI_Bcast(&first, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    int other = asked == first ? run->ranks : run->rank;
    MPI_Allreduce(MPI_IN_PLACE, &other, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (other == run->ranks)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "ranks 0 and %d were started with different scenes, or different values for "
                      "them (--set, --frames, --checkpoint and the like): give all ranks the same",
                      other);
}

/* While there are meshes. */
static int find_elastic(struct run *run, struct cloth_error *error)
{
    free(run->elastic);
    run->elastic = cloth_alloc(run->model->n_materials, sizeof *run->elastic, error);
    for (uint32_t i = 0; i < run->model->n_materials && run->elastic; i++)
        run->elastic[i] = model_elastic(run->model, i);
    return run->elastic ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* Rank 0 cuts the cloths of the phase into blocks; the others are sent theirs by the run. */
static int simulate_begin_cut(struct run *run, struct cloth_error *error)
{
    struct untangle_result untangled = {0}, *all = &run->untangled;
    phases_begin(&run->phases);
    int code = flow_prepare(&run->flow, run->model, run->ranks, error);
    if (!code)
        code = start_untangle(run->model, &run->flow, run->ranks, !run->options->quiet, &untangled,
                              error);
    untangled.rounds += all->rounds;
    untangled.moved += all->moved;
    untangled.largest = fmax(untangled.largest, all->largest);
    untangled.stretch = fmax(untangled.stretch, all->stretch);
    *all = untangled;
    run->apart = run->model->contact.apart;
    if (!code) {
        run->apart.attached = flow_attached(run->flow);
        run->apart.n_vertices = (uint32_t)flow_vertices(run->flow);
    }
    return code ? code : find_elastic(run, error);
}

/* Rank 0 reads the scene of each phase and cuts the next one, unless it is asked to stop. */
static int read_and_cut(struct run *run, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    int code = phases_read(&run->phases, options->scene, options->n_sets, options->sets, error);
    run->phases.keeps_start = options->checkpoint > 0;
    if (!code)
        code = phases_end_with(&run->phases, options->first_frame, options->last_frame, error);
    if (!code && options->restart)
        code = outputs_lock(&run->outputs, options, error);
    if (!code && options->restart)
        code = restart_read(&run->restart, options->restart, &run->phases, error);
    run->model = phases_model(&run->phases);
    if (!code && !simulate_stops(NULL))
        code = simulate_begin_cut(run, error);
    if (!code && options->restart && run->flow)
        code = restart_resume(&run->restart, run->flow, error);
    if (!code && options->report)
        code = simulate_begin_check_file(run, "--report (or DUITE_REPORT)", options->report, error);
    if (!code && options->runtime.trace)
        code = simulate_begin_check_file(run, "--trace (or DUITE_TRACE)", options->runtime.trace,
                                         error);
    return code;
}

/* True if any rank was asked to stop before the run begins. Collective; the same on all ranks. */
static bool check_stop(struct run *run)
{
    int wanted = simulate_stops(NULL);
    MPI_Allreduce(MPI_IN_PLACE, &wanted, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    run->stopped_before = wanted;
    if (wanted && run->rank == 0 && !*run->phases.done[0].ended)
        simulate_say_unbegun();
    return wanted;
}

/* True if the model of the phase before gave the same warning. */
static bool is_known(const struct run *run, const char *warning)
{
    bool known = false;
    for (uint32_t i = 0; run->phases.now && i < run->model[-1].n_warnings; i++)
        known = known || strcmp(run->model[-1].warnings[i], warning) == 0;
    return known;
}

/* Prints, on rank 0, the warnings of the phase that begins. */
static void simulate_begin_warn(const struct run *run)
{
    const char *warning, *name = phases_label(&run->phases, run->phases.now);
    char phase[100] = "";
    if (name && run->phases.now)
        snprintf(phase, sizeof phase, "phase '%.60s': ", name);
    for (uint32_t i = 0; i < run->model->n_warnings; i++)
        if (!is_known(run, run->model->warnings[i]))
            fprintf(stderr, "duite-cloth: warning: %s%s\n", phase, run->model->warnings[i]);
    for (size_t i = 0; (warning = flow_warning(run->flow, i)); i++)
        fprintf(stderr, "duite-cloth: warning: %s%s\n", phase, warning);
}

/* Only rank 0 knows if the scene asks for frames. Collective. */
static void agree_on_frames(struct run *run)
{
    const struct simulate_options *options = run->options;
    int wanted = !options->check && (options->output || options->live ||
                                     options->check_intersections || run->outputs.drape.n);
    MPI_Bcast(&wanted, 1, MPI_INT, 0, MPI_COMM_WORLD);
    run->wants_frames = wanted;
}

/* The last checks of the first phase, then the folder of frames. On rank 0. */
static void open_outputs(struct run *run, struct cloth_error *error)
{
    const struct simulate_options *options = run->options;
    struct outputs_extent *all = &run->forecast.extent;
    simulate_begin_warn(run);
    const bool writes = options->output || options->check;
    if (run->model->n_probes && !writes)
        fprintf(stderr, "duite-cloth: warning: the scene has probes, whose table is written into "
                        "the folder of --output; there is none\n");
    if (run->model->hdf5.every && !writes)
        fprintf(stderr, "duite-cloth: warning: the scene asks for output.hdf5, whose frames are "
                        "written into the folder of --output; there is none\n");
    if (writes)
        outputs_extent_find(all, options, &run->phases, run->flow, &run->apart, error);
    if (options->output && !error->code)
        outputs_check_room(all, run->model, run->flow, options->output, error);
    if (!error->code)
        start_check(run->model, run->flow, &run->apart, options->scene, error);
    if (options->check)
        forecast_begin(&run->forecast, &run->phases);
    else if (!error->code)
        outputs_open(&run->outputs, options, &run->phases, run->flow, &run->apart,
                     options->restart ? &run->restart.at : NULL, error);
    if (!error->code && options->restart)
        restart_outputs(&run->restart, &run->outputs, error);
}

int simulate_prepare(struct run *run)
{
    struct cloth_error error = {0};
    if (check_same(run, &error))
        return simulate_agree(run, &error);
    if (run->rank == 0)
        read_and_cut(run, &error);
    else
        flow_join(&run->flow, &error);
    phases_share(&run->phases, &error);
    run->model = phases_model(&run->phases);
    const int code = simulate_agree(run, &error);
    simulate_stop_by_step();
    if (code || check_stop(run))
        return code;
    if (run->rank == 0)
        open_outputs(run, &error);
    agree_on_frames(run);
    return simulate_agree(run, &error);
}

/* The same for a later phase: what its start, where the one before ended, has to do with. */
static void begin_phase(struct run *run, struct cloth_error *error)
{
    const char *header = flow_header(run->flow);
    char *columns = strdup(header ? header : "");
    if (!columns)
        cloth_fail(error, CLOTH_E_MEMORY, "no memory for the columns of probes");
    flow_free(run->flow);
    run->flow = NULL;
    if (!error->code)
        simulate_begin_cut(run, error);
    if (!error->code)
        simulate_begin_warn(run);
    if (!error->code && strcmp(columns, flow_header(run->flow) ? flow_header(run->flow) : "") != 0)
        cloth_fail(error, CLOTH_E_INPUT,
                   "%s: its probes have other columns than those of the first phase",
                   run->options->scene);
    free(columns);
    if (!error->code)
        start_check(run->model, run->flow, &run->apart, run->options->scene, error);
    if (!error->code)
        outputs_go_on(&run->outputs, &run->phases, &run->apart, error);
}

int simulate_next(struct run *run)
{
    struct cloth_error error = {0};
    if (check_stop(run))
        return CLOTH_OK;
    if (run->rank > 0) {
        run->phases.now++;
        run->model++;
        flow_free(run->flow);
        flow_join(&run->flow, &error);
    } else if (!phases_next(&run->phases, &error)) {
        run->model++;
        begin_phase(run, &error);
    }
    phases_name(&run->phases, &error);
    return simulate_agree(run, &error);
}
