/* The report as JSON: everything in it comes from the run; nothing is measured. */
#include "cloth/app/report/summary.h"

#include "cloth/app/report/summary_parts.h"
#include "cloth/app/report/summary_time.h"
#include "cloth/base/simd.h"
#include "cloth/output/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

double summary_ratio(double a, double b)
{
    return b > 0 ? a / b : NAN;
}

double summary_hidden_fraction(const struct summary *summary)
{
    const duite_counters *counters = &summary->report->counters;
    return 1 - summary_ratio(counters->exposed, counters->awaited);
}

double summary_iterations_mean(const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    bool implicit = model_is_implicit(summary->model);
    return implicit ? summary_ratio((double)report->cg_iterations_total, (double)report->steps)
                    : NAN;
}

double summary_solves_mean(const struct flow_report *report)
{
    const uint64_t solves =
        report->steps + report->steps_halved + report->steps_retaken + report->contact_solves;
    return summary_ratio((double)solves, (double)report->steps);
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
    output_report_integer(json, "cores", summary->cores);
    output_report_text(json, "cores_from", summary->cores_from);
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
                         summary_ratio(report->wall_seconds, (double)report->steps));
    output_report_number(json, "seconds_per_frame",
                         summary_ratio(report->wall_seconds, (double)report->frames));
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
    output_report_number(json, "cg_iterations_mean", summary_iterations_mean(summary));
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

/* Adds the figures of certified contact. */
static void add_contact(struct output_report *json, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    output_report_integer(json, "contacts", report->contacts);
    output_report_integer(json, "contact_pairs", report->contact_pairs);
    output_report_integer(json, "contact_solves", report->contact_solves);
    output_report_number(json, "contact_solves_mean",
                         model_promise(summary->model).apart ? summary_solves_mean(report) : NAN);
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
    output_report_number(json, "busy_fraction", summary_ratio(counters->busy, total));
    output_report_number(json, "idle_fraction", summary_ratio(counters->idle, total));
    output_report_number(json, "overhead_ns_per_task",
                         summary_ratio(overhead, (double)counters->tasks));
    summary_limit_add(json, summary);
    output_report_number(json, "communication_hidden_fraction", summary_hidden_fraction(summary));
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

/* Adds the phases that began and did not fail. */
static void summary_add_phases(struct output_report *json, const struct phases *phases)
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
    summary_add_phases(json, summary->phases);
    summary_seams_add(json, summary->model, summary->report);
    if (!code)
        code = output_report_write(json, path, error);
    output_report_free(json);
    return code;
}
