/* A phase leaves only its final state to the next one; in everything else it is a run of its own.
 */
#include "cloth/app/run/phases.h"

#include "cloth/base/memory.h"

#include <inttypes.h>
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int phases_read(struct phases *phases, const char *path, size_t n_sets,
                const struct scene_set *sets, struct cloth_error *error)
{
    int code = scene_read_phases(&phases->models, &phases->n, path, n_sets, sets, error);
    if (code)
        return code;
    const struct model *first = phases->models;
    phases->named = first->n_phases > 0;
    phases->n_vertices = model_first(first, first->n_cloths);
    for (uint32_t i = 1; i < phases->n && !code; i++)
        code = phases_check(first, phases->models + i, i, error);
    phases->done = code ? NULL : cloth_alloc(phases->n, sizeof *phases->done, error);
    if (phases->done && phases->n > 1)
        phases->end = cloth_alloc(phases->n_vertices, sizeof *phases->end, error);
    return error->code;
}

int phases_share(struct phases *phases, struct cloth_error *error)
{
    uint32_t of[3] = {phases->n, phases->named, phases->now};
    MPI_Bcast(of, 3, MPI_UINT32_T, 0, MPI_COMM_WORLD);
    MPI_Bcast(&phases->total, sizeof phases->total, MPI_BYTE, 0, MPI_COMM_WORLD);
    phases->n = of[0];
    phases->named = of[1];
    phases->now = of[2];
    if (of[0] && !phases->models)
        phases->models = cloth_alloc(of[0], sizeof *phases->models, error);
    if (of[0] && !phases->done)
        phases->done = cloth_alloc(of[0], sizeof *phases->done, error);
    return error->code;
}

/* ---- The end ---- */

int phases_end_with(struct phases *phases, uint64_t first, uint64_t last, struct cloth_error *error)
{
    const double ROUNDED = 1e-9; /* of the time: more than rounding comes to */
    const double fps = phases->models->fps;
    double seconds = 0;
    for (uint32_t i = 0; i < phases->n; i++)
        seconds += phases->models[i].end;
    const double most = floor(fps * seconds * (1 + ROUNDED));
    const uint64_t named = last == UINT64_MAX ? first : last;
    if ((double)named > most)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--frames: there is no frame %" PRIu64
                          ", as the scene ends at %g s, with "
                          "frame %.0f (time.fps is %g): frames up to it are expected, or a later "
                          "--end",
                          named, seconds, most, fps);
    phases->first_frame = first;
    phases->until = last == UINT64_MAX ? (double)INFINITY : (double)last / fps;
    return CLOTH_OK;
}

/* The step whose end is nearest to the last frame is the last one, as frames show steps. */
double phases_seconds(const struct phases *phases, uint32_t phase, double begin)
{
    const double ROUNDED = 1e-6; /* of a step: as flow/observe/frames.c has it */
    const struct model *model = phases->models + phase;
    const double steps = floor((phases->until - begin) / model->h + 0.5 + ROUNDED);
    return fmax(0, fmin(model->end, steps * model->h));
}

void phases_begin(struct phases *phases)
{
    struct model *model = phases_model(phases);
    phases->done[phases->now].end = model->end;
    model->end = phases_seconds(phases, phases->now, phases->total.simulated_seconds);
}

bool phases_are_over(const struct phases *phases)
{
    const double now = phases->total.simulated_seconds;
    int over = phases_is_last(phases) || !(phases_seconds(phases, phases->now + 1, now) > 0);
    MPI_Bcast(&over, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return over;
}

struct flow_before phases_before(const struct phases *phases)
{
    const struct flow_report *total = &phases->total;
    return (struct flow_before){.goes_on = phases->now > 0,
                                .frames = total->frames,
                                .steps = total->steps,
                                .time = total->simulated_seconds};
}

size_t phases_numbers(const struct phases *phases)
{
    return 6 * (size_t)phases->n_vertices;
}

int phases_start_at(struct model *model, double (*from)[6], struct cloth_error *error)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const uint32_t n = model->cloths[c].mesh.n_vertices;
        double(*start)[6] = cloth_alloc(n, sizeof *start, error);
        if (!start)
            return CLOTH_E_MEMORY;
        memcpy(start, from + first, n * sizeof *start);
        model_start_at(model->cloths + c, *start);
        first += n;
    }
    return CLOTH_OK;
}

int phases_start(struct phases *phases, const double *numbers, struct cloth_error *error)
{
    const size_t n = phases_numbers(phases);
    phases->keeps_start = true;
    if (!phases->start)
        phases->start = cloth_alloc(n, sizeof *numbers, error);
    if (!phases->start)
        return CLOTH_E_MEMORY;
    memcpy(phases->start, numbers, n * sizeof *numbers);
    return phases_start_at(phases_model(phases), phases->start, error);
}

int phases_next(struct phases *phases, struct cloth_error *error)
{
    phases->now++;
    return phases->keeps_start ? phases_start(phases, *phases->end, error)
                               : phases_start_at(phases_model(phases), phases->end, error);
}

/* ---- The report of all phases ---- */

/* The sum of the numbers; NaN if neither is one. */
static double sum(double a, double b)
{
    return isnan(a) ? b : isnan(b) ? a : a + b;
}

static void add_counts(struct flow_report *to, const struct flow_report *of)
{
    to->steps += of->steps;
    to->newton_steps += of->newton_steps;
    to->newton_unconverged += of->newton_unconverged;
    to->steps_halved += of->steps_halved;
    for (int i = 0; i < FLOW_CAUSES; i++)
        to->halved_by[i] += of->halved_by[i];
    to->contact_pairs += of->contact_pairs;
    to->contact_solves += of->contact_solves;
    to->contact_pushes += of->contact_pushes;
    to->contact_cuts += of->contact_cuts;
    to->contact_queries += of->contact_queries;
    to->contact_queries_again += of->contact_queries_again;
    to->contact_graphs += of->contact_graphs;
    to->contact_pinches += of->contact_pinches;
    to->steps_retaken += of->steps_retaken;
    to->cg_iterations_total += of->cg_iterations_total;
    to->cg_restarts += of->cg_restarts;
    to->factors_shifted += of->factors_shifted;
    to->correction_rounds += of->correction_rounds;
    to->corrections_unmet += of->corrections_unmet;
    to->contact_cut_momentum += of->contact_cut_momentum;
}

static void add_seconds(struct flow_report *to, const struct flow_report *of)
{
    to->simulated_seconds += of->simulated_seconds;
    to->wall_seconds += of->wall_seconds;
    to->seconds_force = sum(to->seconds_force, of->seconds_force);
    to->seconds_acceleration = sum(to->seconds_acceleration, of->seconds_acceleration);
    to->seconds_matrix = sum(to->seconds_matrix, of->seconds_matrix);
    to->seconds_cg = sum(to->seconds_cg, of->seconds_cg);
    to->seconds_velocity = sum(to->seconds_velocity, of->seconds_velocity);
    to->seconds_position = sum(to->seconds_position, of->seconds_position);
    to->seconds_collide = sum(to->seconds_collide, of->seconds_collide);
    to->seconds_correction = sum(to->seconds_correction, of->seconds_correction);
    to->seconds_output = sum(to->seconds_output, of->seconds_output);
}

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static void take_peaks(struct flow_report *to, const struct flow_report *of)
{
    to->contacts = larger(to->contacts, of->contacts);
    to->contact_cut_run = larger(to->contact_cut_run, of->contact_cut_run);
    to->cg_iterations_max = larger(to->cg_iterations_max, of->cg_iterations_max);
    to->momentum_lost = fmax(to->momentum_lost, of->momentum_lost);
    to->mass_norm_error = fmax(to->mass_norm_error, of->mass_norm_error);
    to->correction_excess = fmax(to->correction_excess, of->correction_excess);
    to->shortest_step = fmin(to->shortest_step, of->shortest_step);
    to->stretch_highest = fmax(to->stretch_highest, of->stretch_highest);
}

/* sewn: it ended where it did since all seams were closed. */
static const char *ended(const struct flow_report *report, bool sewn)
{
    if (report->stopped)
        return "stopped";
    if (sewn)
        return "sewn";
    return isnan(report->rest_seconds) ? "end" : "rest";
}

void phases_add(struct phases *phases, const struct flow_report *report)
{
    const struct flow_report before = phases->total;
    struct flow_report *total = &phases->total;
    struct phase_done *done = phases->done + phases->now;
    done->steps = report->steps;
    done->cg_iterations_mean = model_is_implicit(phases_model(phases))
                                   ? (double)report->cg_iterations_total / (double)report->steps
                                   : NAN;
    done->simulated_seconds = report->simulated_seconds;
    done->wall_seconds = report->wall_seconds;
    snprintf(done->ended, sizeof done->ended, "%s", ended(report, phases_model(phases)->sewn > 0));
    *total = *report;
    if (!phases->now)
        return;
    add_counts(total, &before);
    add_seconds(total, &before);
    flow_counters_add(&total->counters, &before.counters, 1);
    take_peaks(total, &before);
    if (before.contact_pinch[0])
        memcpy(total->contact_pinch, before.contact_pinch, sizeof total->contact_pinch);
    total->rest_seconds += before.simulated_seconds;
    total->sewn_seconds += before.simulated_seconds;
    if (report->seams)
        return;
    total->seams = before.seams;
    total->seams_open = before.seams_open;
    total->seam_distance = before.seam_distance;
    total->sewn_seconds = before.sewn_seconds;
}

void phases_name(const struct phases *phases, struct cloth_error *error)
{
    const char *name = phases_label(phases, phases->now);
    struct cloth_error named = {0};
    if (!name || !error->code)
        return;
    cloth_fail(&named, error->code, "phase '%.60s': %.900s", name, error->text);
    *error = named;
}

void phases_free(struct phases *phases)
{
    for (uint32_t i = 0; i < phases->n && phases->models; i++)
        model_free(phases->models + i);
    free(phases->models);
    free(phases->done);
    free(phases->end);
    free(phases->start);
    *phases = (struct phases){0};
}
