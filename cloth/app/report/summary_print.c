/* Everything printed here comes from the report of the run; nothing is measured. */
#include "cloth/app/report/summary.h"

#include "cloth/base/simd.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void print_solves(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    fprintf(file, "  CG iterations    %.2f a step on average, %" PRIu64 " at most\n",
            summary_iterations_mean(summary), report->cg_iterations_max);
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

/* Names each cause that occurred. */
static void print_halved(FILE *file, const struct summary *summary)
{
    static const char *const causes[FLOW_CAUSES] = {
        [FLOW_CAUSE_SOLVE] = "for a solve that failed",
        [FLOW_CAUSE_BOUNDS] = "for what left all bounds",
        [FLOW_CAUSE_STRETCH] = "for stretch (time.stretch_growth, time.stretch_limit)",
        [FLOW_CAUSE_ENERGY] = "for energy gained (time.energy_growth)",
        [FLOW_CAUSE_CONTACT] = "for ways that contact cut (contact)"};
    const struct flow_report *report = summary->report;
    fprintf(file, "  shorter steps    down to %g s; halved %" PRIu64 " times",
            report->shortest_step, report->steps_halved);
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
    fprintf(file, "  contacts         %" PRIu64 " at most, %s", report->contacts,
            model->contact.self ? "also of a cloth with itself"
                                : "none of a cloth with itself (contact.self)");
    if (model_promise(model).apart)
        fprintf(file, "; %.2f solves a step, %" PRIu64 " pairs certified",
                summary_solves_mean(report), report->contact_pairs);
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
        fprintf(file, "  pinched          %" PRIu64 " contacts; first %s\n",
                report->contact_pinches, report->contact_pinch);
}

static void print_seam(FILE *file, const struct model_cloth *cloth, uint32_t s)
{
    const struct model_seam *seam = cloth->seams.seam + s;
    fprintf(file,
            "  seam %-11" PRIu32 " edge %" PRIu32 " of %.40s, edge %" PRIu32 " of %.40s%s: %" PRIu32
            " pairs, %.4g m apart (%.4g the other way round), %s\n",
            s, seam->side[0].edge, seam->side[0].panel, seam->side[1].edge, seam->side[1].panel,
            seam->reversed ? ", reversed" : "", seam->n_pairs, seam->distance[seam->reversed],
            seam->distance[!seam->reversed], summary_seam_states[seam->sewing.state]);
}

static void print_seams(FILE *file, const struct model *model, const struct flow_report *report)
{
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        if (cloth->seams.n)
            fprintf(file, "  seams            of %.40s: %" PRIu32 "\n", cloth->name,
                    cloth->seams.n);
        for (uint32_t s = 0; s < cloth->seams.n; s++)
            print_seam(file, cloth, s);
    }
    if (!report->seams)
        return;
    fprintf(file,
            "  sewing           %" PRIu64 " of %" PRIu64 " pulled seams open, by %.4g m at most",
            report->seams_open, report->seams, report->seam_distance);
    if (!isnan(report->sewn_seconds))
        fprintf(file, "; closed after %g s", report->sewn_seconds);
    fputc('\n', file);
}

static void print_phases(FILE *file, const struct phases *phases)
{
    for (uint32_t i = 0; i < phases->n && phases->named; i++) {
        const struct phase_done *done = phases->done + i;
        if (*done->ended)
            fprintf(file, "  phase %-10.40s %" PRIu64 " steps, %g s simulated in %.3f s, %s\n",
                    phases_label(phases, i), done->steps, done->simulated_seconds,
                    done->wall_seconds, strcmp(done->ended, "rest") == 0 ? "to rest" : done->ended);
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
    fprintf(file, "  cores            %u a rank (%s)\n", summary->cores, summary->cores_from);
    fprintf(file, "  instructions     %s\n", cloth_simd_name());
    fprintf(file, "  steps            %" PRIu64 " of %g s%s, %g s simulated\n", report->steps,
            model->h, report->steps_halved ? " at most" : "", report->simulated_seconds);
}

/* Features that are so near at rest do not push each other. */
static void print_low(FILE *file, const struct model *model)
{
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        if (cloth->low.n)
            fprintf(file,
                    "  low triangles    %" PRIu32 " of %.40s, triangle %" PRIu32
                    " (counted from 0) by %.3g m: what is nearer at rest than %.3g m does not "
                    "push\n",
                    cloth->low.n, cloth->name, cloth->low.lowest, cloth->low.height,
                    cloth->low.below);
    }
}

static void print_events(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    const struct model *model = summary->model;
    print_phases(file, summary->phases);
    print_seams(file, model, report);
    if (model->n_obstacles || model_seeks(model))
        fprintf(file, "  contact          %s%s\n", model_contact_name(model),
                model->contact.assumed ? ", by default" : "");
    print_low(file, model);
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
            summary_ratio(report->wall_seconds, (double)report->steps));
    summary_time_print(file, report);
    if (model_is_implicit(model))
        print_solves(file, summary);
    if (summary->ranks > 1)
        fprintf(file,
                "  messages         %" PRIu64
                ", %.3f MB; %.0f %% of the wait for them hidden behind "
                "tasks\n",
                report->counters.messages, 1e-6 * (double)report->counters.bytes,
                100 * summary_hidden_fraction(summary));
}

static void print_results(FILE *file, const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    const uint64_t first = summary->options->first_frame;
    fprintf(file, "  largest stretch  %.6f times the length at rest at the end",
            report->max_stretch);
    if (!isnan(report->stretch_highest))
        fprintf(file, ", %.6f at most", report->stretch_highest);
    fputc('\n', file);
    fprintf(file, "  state hash       %016" PRIx64 "\n", report->state_hash);
    if (summary->options->output)
        fprintf(file, "  frames           %" PRIu64 " in %s\n",
                report->frames > first ? report->frames - first : 0, summary->options->output);
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
