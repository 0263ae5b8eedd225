/* The seams of a scene and how far pulled ones are closed. */
#include "cloth/app/report/summary_parts.h"

#include <inttypes.h>
#include <math.h>

static const char *const STATES[MODEL_SEAMS_STATES] = {"open", "pulled", "welded"};

static void print_seam(FILE *file, const struct model_cloth *cloth, uint32_t s)
{
    const struct model_seam *seam = cloth->seams.seam + s;
    fprintf(file,
            "  seam %-11" PRIu32 " edge %" PRIu32 " of %.40s, edge %" PRIu32 " of %.40s%s: %" PRIu32
            " pairs, %.4g m apart (%.4g the other way round), %s\n",
            s, seam->side[0].edge, seam->side[0].panel, seam->side[1].edge, seam->side[1].panel,
            seam->reversed ? ", reversed" : "", seam->n_pairs, seam->distance[seam->reversed],
            seam->distance[!seam->reversed], STATES[seam->sewing.state]);
}

void summary_seams_print(FILE *file, const struct model *model, const struct flow_report *report)
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

static void add_sewing(struct output_report *json, const struct flow_report *report)
{
    if (report->seams)
        output_report_integer(json, "seams_open", report->seams_open);
    else
        output_report_null(json, "seams_open");
    output_report_number(json, "seam_distance", report->seams ? report->seam_distance : NAN);
    output_report_number(json, "sewn_seconds", report->seams ? report->sewn_seconds : NAN);
}

void summary_seams_add(struct output_report *json, const struct model *model,
                       const struct flow_report *report)
{
    bool any = false;
    add_sewing(json, report);
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
            output_report_text(json, "state", STATES[seam->sewing.state]);
            output_report_number(json, "distance", seam->distance[seam->reversed]);
            output_report_number(json, "distance_other", seam->distance[!seam->reversed]);
        }
    if (any)
        output_report_list_end(json);
}
