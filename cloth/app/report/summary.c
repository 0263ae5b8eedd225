/* The report as JSON: everything in it comes from the run; nothing is measured. */
#include "cloth/app/report/summary.h"

#include "cloth/base/simd.h"
#include "cloth/output/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

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

static void add_optional(struct output_report *json, const char *key, bool known, uint64_t value)
{
    if (known)
        output_report_integer(json, key, value);
    else
        output_report_null(json, key);
}

static void add_text(struct output_report *json, const char *key, const char *text)
{
    if (text)
        output_report_text(json, key, text);
    else
        output_report_null(json, key);
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
static int summary_add_material(struct output_report *json, const char *name,
                                const struct mesh_elastic *elastic, struct cloth_error *error)
{
    static const char *const keys[] = {"E_warp", "E_weft", "G", "nu12"};
    const double value[] = {elastic->warp, elastic->weft, elastic->shear, elastic->poisson};
    for (int i = 0; i < 4; i++) {
        char *key = NULL;
        if (asprintf(&key, "material_%s_%s", name, keys[i]) < 0)
            return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the report");
        output_report_number(json, key, value[i]);
        free(key);
    }
    return CLOTH_OK;
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
    add_optional(json, "cg_iterations_max", model_is_implicit(summary->model),
                 report->cg_iterations_max);
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
    output_report_integer(json, "contact_pushes", report->contact_pushes);
    output_report_integer(json, "contact_cuts", report->contact_cuts);
    output_report_number(json, "contact_cut_momentum", report->contact_cut_momentum);
    output_report_integer(json, "contact_cut_run", report->contact_cut_run);
    output_report_integer(json, "contact_queries", report->contact_queries);
    output_report_integer(json, "contact_queries_again", report->contact_queries_again);
    output_report_integer(json, "contact_graphs", report->contact_graphs);
    output_report_integer(json, "contact_pinches", report->contact_pinches);
    add_text(json, "contact_pinch", *report->contact_pinch ? report->contact_pinch : NULL);
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
    add_text(json, "limited_by", summary_limit(summary));
    output_report_number(json, "communication_hidden_fraction", summary_hidden_fraction(summary));
    output_report_number(json, "critical_path_seconds", summary->critical_path);
    output_report_number(json, "lower_bound_seconds", summary->lower_bound);
    add_halved(json, summary->report);
    add_contact(json, summary);
    output_report_integer(json, "steps_retaken", summary->report->steps_retaken);
    output_report_integer(json, "peak_memory_bytes", summary->memory_bytes);
}

static void add_checks(struct output_report *json, const struct summary *summary)
{
    const struct untangle_result *untangled = summary->untangled;
    const struct intersections_found *found = summary->intersections;
    const struct drape_found *drape = summary->drape;
    output_report_integer(json, "untangle_rounds", untangled->rounds);
    output_report_integer(json, "untangle_vertices", untangled->moved);
    output_report_number(json, "untangle_largest", untangled->largest);
    output_report_number(json, "untangle_stretch", untangled->stretch);
    add_optional(json, "intersections", found, found ? found->pairs : 0);
    add_optional(json, "intersections_shapes", found, found ? found->with_shapes : 0);
    add_optional(json, "intersections_frame", found && found->bad, found ? found->first : 0);
    output_report_number(json, "drape_coefficient_percent", drape ? drape->coefficient : NAN);
    output_report_number(json, "drape_shadow_m2", drape ? drape->shadow : NAN);
}

const char *const summary_seam_states[MODEL_SEAMS_STATES] = {"open", "pulled", "welded"};

static void add_seams(struct output_report *json, const struct model *model,
                      const struct flow_report *report)
{
    bool any = false;
    add_optional(json, "seams_open", report->seams > 0, report->seams_open);
    output_report_number(json, "seam_distance", report->seams ? report->seam_distance : NAN);
    output_report_number(json, "sewn_seconds", report->seams ? report->sewn_seconds : NAN);
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t s = 0; s < model->cloths[c].seams.n; s++) {
            const struct model_seam *seam = model->cloths[c].seams.seam + s;
            if (!any)
                output_report_list(json, "seams");
            any = true;
            output_report_item(json);
            output_report_text(json, "cloth", model->cloths[c].name);
            output_report_integer(json, "seam", s);
            output_report_text(json, "panel_from", seam->side[0].panel);
            output_report_integer(json, "edge_from", seam->side[0].edge);
            output_report_text(json, "panel_to", seam->side[1].panel);
            output_report_integer(json, "edge_to", seam->side[1].edge);
            output_report_integer(json, "pairs", seam->n_pairs);
            output_report_integer(json, "reversed", seam->reversed);
            output_report_text(json, "state", summary_seam_states[seam->sewing.state]);
            output_report_number(json, "distance", seam->distance[seam->reversed]);
            output_report_number(json, "distance_other", seam->distance[!seam->reversed]);
        }
    if (any)
        output_report_list_end(json);
}

/* Adds the phases that began and did not fail. */
static void add_phases(struct output_report *json, const struct phases *phases)
{
    if (!phases->named)
        return;
    output_report_list(json, "phases");
    for (uint32_t i = 0; i < phases->n && *phases->done[i].ended; i++) {
        const struct phase_done *done = phases->done + i;
        output_report_item(json);
        output_report_text(json, "name", phases_label(phases, i));
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
    const struct model *model = summary->model;
    struct output_report *json = NULL;
    int code = output_report_new(&json, error);
    if (code)
        return code;
    add_setting(json, summary);
    add_times(json, summary->report);
    add_solver(json, summary);
    add_energies(json, summary->report);
    add_runtime(json, summary);
    for (uint32_t i = 0; i < model->n_materials && !code; i++)
        code = summary_add_material(json, model->materials[i].name, summary->elastic + i, error);
    output_report_number(json, "max_stretch", summary->report->max_stretch);
    output_report_number(json, "stretch_highest", summary->report->stretch_highest);
    add_checks(json, summary);
    add_hash(json, "state_hash", summary->report->state_hash);
    add_phases(json, summary->phases);
    add_seams(json, model, summary->report);
    if (!code)
        code = output_report_write(json, path, error);
    output_report_free(json);
    return code;
}
