/* Everything printed here comes from the report of the run; nothing is measured. */
#include "cloth/summary.h"

#include "cloth/base/simd.h"
#include "cloth/output/output.h"
#include "cloth/summary_seams.h"
#include "cloth/summary_time.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* NaN where there is nothing to divide by: printed as null. */
static double ratio(double a, double b)
{
    return b > 0 ? a / b : NAN;
}

/* The share of the time in which messages were awaited that workers had tasks in. */
static double hidden_fraction(const struct summary *summary)
{
    const duite_counters *counters = &summary->report->counters;
    return 1 - ratio(counters->exposed, counters->awaited);
}

static double iterations_mean(const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    bool implicit = model_is_implicit(summary->model);
    return implicit ? ratio((double)report->cg_iterations_total, (double)report->steps) : NAN;
}

/* Solves a step; those of steps that were given up count, too. */
static double solves_mean(const struct flow_report *report)
{
    const uint64_t solves =
        report->steps + report->steps_halved + report->steps_retaken + report->contact_solves;
    return ratio((double)solves, (double)report->steps);
}

static void print_solves(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    fprintf(file, "  CG iterations    %.2f a step on average, %" PRIu64 " at most\n",
            iterations_mean(summary), report->cg_iterations_max);
    fprintf(file, "  error of dv      %.3e of it at most in a step, in the mass norm (estimate)\n",
            report->mass_norm_error);
    if (report->cg_restarts)
        fprintf(file,
                "  CG restarts      %" PRIu64
                ", where the true residual was larger than its recurrence said\n",
                report->cg_restarts);
    if (report->factors_shifted)
        fprintf(file,
                "  IC(0)            made with a shift %" PRIu64 " times, of blocks times steps\n",
                report->factors_shifted);
    fprintf(file, "  momentum lost    %.3e kg m/s at most in a step\n", report->momentum_lost);
}

static void print_correction(FILE *file, const struct flow_report *r)
{
    fprintf(file, "  correction       %" PRIu64 " rounds, which left an excess of %.4g at most\n",
            r->correction_rounds, r->correction_excess);
}

/* With every cause that there was. */
static void print_halved(FILE *file, const struct summary *summary)
{
    static const char *const causes[FLOW_CAUSES] = {
        [FLOW_CAUSE_SOLVE] = "for a solve that failed",
        [FLOW_CAUSE_BOUNDS] = "for what left all bounds",
        [FLOW_CAUSE_STRETCH] = "for stretch (time.stretch_growth, time.stretch_limit)",
        [FLOW_CAUSE_ENERGY] = "for energy gained (time.energy_growth)",
        [FLOW_CAUSE_CONTACT] = "for ways that contact cut (contact)"};
    const struct flow_report *report = summary->report;
    fprintf(file, "  shorter steps    down to h / %.0f; halved %" PRIu64 " times",
            summary->model->h / report->shortest_step, report->steps_halved);
    const char *before = ": ";
    for (int i = 0; i < FLOW_CAUSES; i++) {
        if (!report->halved_by[i])
            continue;
        fprintf(file, "%s%" PRIu64 " %s", before, report->halved_by[i], causes[i]);
        before = ", ";
    }
    fputc('\n', file);
}

static void print_intersections(FILE *file, const struct intersections_found *found)
{
    fprintf(file, "  intersections    ");
    if (found->bad)
        fprintf(file,
                "in %" PRIu64 " of %" PRIu64 " frames, from frame %" PRIu64 " on; at most %" PRIu64
                " of cloth, %" PRIu64 " with obstacles\n",
                found->bad, found->frames, found->first, found->pairs, found->with_shapes);
    else
        fprintf(file, "none in %" PRIu64 " frames\n", found->frames);
}

static void print_contact(FILE *file, const struct model *model, const struct flow_report *report)
{
    fprintf(file, "  contacts         %" PRIu64 " at most", report->contacts);
    if (model_certifies(model))
        fprintf(file, "; %.2f solves a step, %" PRIu64 " pairs certified", solves_mean(report),
                report->contact_pairs);
    fputc('\n', file);
    if (report->contact_cuts && report->contact_cut_run)
        fprintf(file,
                "  ways cut         %" PRIu64 ", of one vertex in %" PRIu64
                " steps in a row at most\n",
                report->contact_cuts, report->contact_cut_run);
    else if (report->contact_cuts)
        fprintf(file, "  ways cut         %" PRIu64 ", all in steps that were given up\n",
                report->contact_cuts);
    if (report->contact_pinches)
        fprintf(file, "  pinched          %" PRIu64 " pairs, in steps that were halved; first %s\n",
                report->contact_pinches, report->contact_pinch);
}

static void print_phases(FILE *file, const struct phases *phases)
{
    for (uint32_t i = 0; i < phases->n && phases->named; i++) {
        const struct phase_done *done = phases->done + i;
        if (done->ended)
            fprintf(file, "  phase %-10.40s %" PRIu64 " steps, %g s simulated in %.3f s, %s\n",
                    done->name, done->steps, done->simulated_seconds, done->wall_seconds,
                    strcmp(done->ended, "rest") == 0 ? "to rest" : done->ended);
    }
}

static void print_what_ran(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    const struct model *model = summary->model;
    fprintf(file, "%s\n", model->name);
    fprintf(file, "  vertices         %" PRIu64 ", triangles %" PRIu64 "\n", report->vertices,
            report->triangles);
    fprintf(file,
            "  blocks           %" PRIu64 " of about %" PRIu64 " vertices, partition %016" PRIx64
            "\n",
            report->blocks, report->grain, report->partition_hash);
    fprintf(file,
            "  ran on           %d ranks x %u threads, scheduler %s, mapping %s, balance %s\n",
            summary->ranks, summary->threads, summary->options->scheduler_name,
            summary->options->mapping_name, summary->options->balance_name);
    fprintf(file, "  instructions     %s\n", cloth_simd_name());
    fprintf(file, "  steps            %" PRIu64 " of %g s, %g s simulated\n", report->steps,
            model->h, report->simulated_seconds);
}

static void print_events(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    const struct model *model = summary->model;
    print_phases(file, summary->phases);
    summary_seams_print(file, model, report);
    if (model->n_obstacles || model_seeks(model))
        fprintf(file, "  contact          %s%s\n", model_contact_name(model),
                model->contact.assumed ? ", by default" : "");
    if (!isnan(report->rest_seconds))
        fprintf(file, "  at rest          after %g s\n", report->rest_seconds);
    if (report->steps_halved)
        print_halved(file, summary);
    if (report->steps_retaken)
        fprintf(file,
                "  gained energy    %" PRIu64 " steps by bdf2, made again by implicit_euler\n",
                report->steps_retaken);
    if (report->contacts)
        print_contact(file, model, report);
    if (!isnan(report->correction_excess))
        print_correction(file, report);
}

static void print_effort(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    const struct model *model = summary->model;
    fprintf(file, "  wall time        %.3f s, %.6f s a step\n", report->wall_seconds,
            ratio(report->wall_seconds, (double)report->steps));
    summary_time_print(file, report);
    if (model_is_implicit(model))
        print_solves(file, summary);
    if (summary->ranks > 1)
        fprintf(file,
                "  messages         %" PRIu64
                ", %.3f MB; %.0f %% of the wait for them hidden behind "
                "tasks\n",
                report->counters.messages, 1e-6 * (double)report->counters.bytes,
                100 * hidden_fraction(summary));
}

static void print_results(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    fprintf(file, "  largest stretch  %.6f times the length at rest at the end",
            report->max_stretch);
    if (!isnan(report->stretch_highest))
        fprintf(file, ", %.6f at most", report->stretch_highest);
    fputc('\n', file);
    fprintf(file, "  state hash       %016" PRIx64 "\n", report->state_hash);
    if (summary->options->output)
        fprintf(file, "  frames           %" PRIu64 " in %s\n", report->frames,
                summary->options->output);
    else
        fprintf(file, "  frames           not written (--output DIR)\n");
    if (summary->drape)
        fprintf(file, "  drape            coefficient %.2f %%, shadow %.6f m2\n",
                summary->drape->coefficient, summary->drape->shadow);
    if (summary->intersections)
        print_intersections(file, summary->intersections);
}

void summary_print(FILE *file, const struct summary *summary)
{
    print_what_ran(file, summary);
    print_events(file, summary);
    print_effort(file, summary);
    print_results(file, summary);
    summary_limit_print(file, summary);
}

static void add_hash(struct output_report *json, const char *key, uint64_t hash)
{
    char text[17];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    output_report_text(json, key, text);
}

static void add_setting(struct output_report *json, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    output_report_text(json, "scene", summary->model->name);
    output_report_integer(json, "vertices", report->vertices);
    output_report_integer(json, "triangles", report->triangles);
    output_report_integer(json, "blocks", report->blocks);
    output_report_integer(json, "grain", report->grain);
    add_hash(json, "partition_hash", report->partition_hash);
    output_report_integer(json, "ranks", (uint64_t)summary->ranks);
    output_report_integer(json, "threads", summary->threads);
    output_report_text(json, "scheduler", summary->options->scheduler_name);
    output_report_text(json, "mapping", summary->options->mapping_name);
    output_report_text(json, "balance", summary->options->balance_name);
    output_report_text(json, "simd", cloth_simd_name());
    output_report_text(json, "contact_mode", model_contact_name(summary->model));
}

/* material_NAME_KEY */
static int add_modulus(struct output_report *json, const char *name, const char *key, double value,
                       struct cloth_error *error)
{
    char *text = NULL;
    if (asprintf(&text, "material_%s_%s", name, key) < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the report");
    output_report_number(json, text, value);
    free(text);
    return CLOTH_OK;
}

static int add_materials(struct output_report *json, const struct summary *summary,
                         struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < summary->model->n_materials; i++) {
        const char *name = summary->model->materials[i].name;
        const struct mesh_elastic *elastic = summary->elastic + i;
        code = code ? code : add_modulus(json, name, "E_warp", elastic->warp, error);
        code = code ? code : add_modulus(json, name, "E_weft", elastic->weft, error);
        code = code ? code : add_modulus(json, name, "G", elastic->shear, error);
        code = code ? code : add_modulus(json, name, "nu12", elastic->poisson, error);
    }
    return code;
}

static void add_times(struct output_report *json, const struct flow_report *report)
{
    output_report_integer(json, "steps", report->steps);
    output_report_number(json, "simulated_seconds", report->simulated_seconds);
    output_report_number(json, "rest_seconds", report->rest_seconds);
    output_report_number(json, "wall_seconds", report->wall_seconds);
    output_report_number(json, "seconds_per_step",
                         ratio(report->wall_seconds, (double)report->steps));
    output_report_number(json, "seconds_per_frame",
                         ratio(report->wall_seconds, (double)report->frames));
    output_report_number(json, "seconds_force", report->seconds_force);
    output_report_number(json, "seconds_acceleration", report->seconds_acceleration);
    output_report_number(json, "seconds_matrix", report->seconds_matrix);
    output_report_number(json, "seconds_cg", report->seconds_cg);
    output_report_number(json, "seconds_velocity", report->seconds_velocity);
    output_report_number(json, "seconds_position", report->seconds_position);
    output_report_number(json, "seconds_collide", report->seconds_collide);
    output_report_number(json, "seconds_velocity_correction", report->seconds_correction);
    output_report_number(json, "seconds_output", report->seconds_output);
}

static void add_solver(struct output_report *json, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    output_report_number(json, "cg_iterations_mean", iterations_mean(summary));
    if (model_is_implicit(summary->model))
        output_report_integer(json, "cg_iterations_max", report->cg_iterations_max);
    else
        output_report_null(json, "cg_iterations_max");
    output_report_number(json, "mass_norm_error", report->mass_norm_error);
    output_report_number(json, "momentum_lost", report->momentum_lost);
    output_report_integer(json, "cg_restarts", report->cg_restarts);
    output_report_integer(json, "factors_shifted", report->factors_shifted);
    output_report_integer(json, "velocity_correction_rounds", report->correction_rounds);
    output_report_integer(json, "velocity_correction_unmet", report->corrections_unmet);
    output_report_number(json, "velocity_correction_excess", report->correction_excess);
    output_report_integer(json, "newton_steps", report->newton_steps);
    output_report_integer(json, "newton_unconverged", report->newton_unconverged);
}

static void add_energies(struct output_report *json, const struct flow_report *report)
{
    const struct flow_energy *start = &report->start, *end = &report->end;
    output_report_number(json, "energy_start",
                         start->kinetic + start->elastic + start->gravity + start->loads +
                             start->contact);
    output_report_number(json, "energy_end",
                         end->kinetic + end->elastic + end->gravity + end->loads + end->contact);
    output_report_number(json, "energy_lowest", report->energy_lowest);
    output_report_number(json, "energy_highest", report->energy_highest);
    output_report_number(json, "energy_gained", report->energy_gained);
    output_report_number(json, "energy_gained_unlent", report->energy_gained_unlent);
    output_report_number(json, "energy_lent", report->energy_lent);
    output_report_number(json, "energy_corrected", report->energy_corrected);
    output_report_number(json, "energy_kinetic", end->kinetic);
    output_report_number(json, "energy_elastic", end->elastic);
    output_report_number(json, "energy_gravity", end->gravity);
    output_report_number(json, "energy_loads", end->loads);
    output_report_number(json, "energy_contact", end->contact);
    output_report_number(json, "torque_left", report->torque_left);
}

static void add_halved(struct output_report *json, const struct flow_report *report)
{
    const uint64_t *by = report->halved_by;
    output_report_integer(json, "steps_halved", report->steps_halved);
    output_report_integer(json, "steps_halved_solve", by[FLOW_CAUSE_SOLVE]);
    output_report_integer(json, "steps_halved_bounds", by[FLOW_CAUSE_BOUNDS]);
    output_report_integer(json, "steps_halved_stretch", by[FLOW_CAUSE_STRETCH]);
    output_report_integer(json, "steps_halved_energy", by[FLOW_CAUSE_ENERGY]);
    output_report_integer(json, "steps_halved_contact", by[FLOW_CAUSE_CONTACT]);
}

/* Of certified contact. */
static void add_contact(struct output_report *json, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    output_report_integer(json, "contacts", report->contacts);
    output_report_integer(json, "contact_pairs", report->contact_pairs);
    output_report_integer(json, "contact_solves", report->contact_solves);
    output_report_number(json, "contact_solves_mean",
                         model_certifies(summary->model) ? solves_mean(report) : NAN);
    output_report_integer(json, "contact_cuts", report->contact_cuts);
    output_report_number(json, "contact_cut_momentum", report->contact_cut_momentum);
    output_report_integer(json, "contact_cut_run", report->contact_cut_run);
    output_report_integer(json, "contact_queries", report->contact_queries);
    output_report_integer(json, "contact_queries_again", report->contact_queries_again);
    output_report_integer(json, "contact_graphs", report->contact_graphs);
    output_report_integer(json, "contact_pinches", report->contact_pinches);
    if (report->contact_pinch[0])
        output_report_text(json, "contact_pinch", report->contact_pinch);
    else
        output_report_null(json, "contact_pinch");
}

static void add_runtime(struct output_report *json, const struct summary *summary)
{
    const duite_counters *counters = &summary->report->counters;
    double total = summary->report->wall_seconds * (double)summary->workers;
    double overhead = 1e9 * (total - counters->busy - counters->idle);
    output_report_integer(json, "tasks", counters->tasks);
    output_report_integer(json, "tasks_placed", counters->placed);
    output_report_integer(json, "tasks_stolen", counters->stolen);
    output_report_integer(json, "tasks_chained", counters->chained);
    output_report_integer(json, "graphs_recorded", counters->graphs_recorded);
    output_report_integer(json, "messages", counters->messages);
    output_report_integer(json, "bytes_moved", counters->bytes);
    output_report_integer(json, "delegated_tasks", counters->delegated);
    output_report_integer(json, "migrated_objects", counters->migrated);
    output_report_number(json, "busy_fraction", ratio(counters->busy, total));
    output_report_number(json, "idle_fraction", ratio(counters->idle, total));
    output_report_number(json, "overhead_ns_per_task", ratio(overhead, (double)counters->tasks));
    summary_limit_add(json, summary);
    output_report_number(json, "communication_hidden_fraction", hidden_fraction(summary));
    output_report_number(json, "critical_path_seconds", summary->critical_path);
    output_report_number(json, "lower_bound_seconds", summary->lower_bound);
    add_halved(json, summary->report);
    add_contact(json, summary);
    output_report_integer(json, "steps_retaken", summary->report->steps_retaken);
    output_report_integer(json, "peak_memory_bytes", summary->memory_bytes);
}

static void add_untangled(struct output_report *json, const struct untangle_result *result)
{
    output_report_integer(json, "untangle_rounds", result->rounds);
    output_report_integer(json, "untangle_vertices", result->moved);
    output_report_number(json, "untangle_largest", result->largest);
}

static void add_intersections(struct output_report *json, const struct intersections_found *found)
{
    const double none = NAN;
    output_report_number(json, "intersections", found ? (double)found->pairs : none);
    output_report_number(json, "intersections_shapes", found ? (double)found->with_shapes : none);
    output_report_number(json, "intersections_frame",
                         found && found->bad ? (double)found->first : none);
}

static void add_drape(struct output_report *json, const struct drape_found *found)
{
    output_report_number(json, "drape_coefficient_percent", found ? found->coefficient : NAN);
    output_report_number(json, "drape_shadow_m2", found ? found->shadow : NAN);
}

/* Those that began and did not fail. */
static void add_phases(struct output_report *json, const struct phases *phases)
{
    if (!phases->named)
        return;
    output_report_list(json, "phases");
    for (uint32_t i = 0; i < phases->n && phases->done[i].ended; i++) {
        const struct phase_done *done = phases->done + i;
        output_report_item(json);
        output_report_text(json, "name", done->name);
        output_report_integer(json, "steps", done->steps);
        output_report_number(json, "cg_iterations_mean", done->cg_iterations_mean);
        output_report_number(json, "simulated_seconds", done->simulated_seconds);
        output_report_number(json, "wall_seconds", done->wall_seconds);
        output_report_text(json, "ended", done->ended);
    }
    output_report_list_end(json);
}

int summary_write(const struct summary *summary, const char *path, struct cloth_error *error)
{
    struct output_report *json = NULL;
    int code = output_report_new(&json, error);
    if (code)
        return code;
    add_setting(json, summary);
    add_times(json, summary->report);
    add_solver(json, summary);
    add_energies(json, summary->report);
    add_runtime(json, summary);
    code = add_materials(json, summary, error);
    output_report_number(json, "max_stretch", summary->report->max_stretch);
    output_report_number(json, "stretch_highest", summary->report->stretch_highest);
    add_untangled(json, summary->untangled);
    add_intersections(json, summary->intersections);
    add_drape(json, summary->drape);
    add_hash(json, "state_hash", summary->report->state_hash);
    add_phases(json, summary->phases);
    summary_seams_add(json, summary->model, summary->report);
    if (!code)
        code = output_report_write(json, path, error);
    output_report_free(json);
    return code;
}
