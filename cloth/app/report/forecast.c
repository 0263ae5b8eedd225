/* Steps, frames and bytes on the disk follow from the scene; seconds and memory are those of the
 * first steps, scaled by factors that runs were compared with. */
#include "cloth/app/report/forecast.h"

#include "cloth/output/output.h"

#include <inttypes.h>
#include <math.h>

/* Likely, least and most of a run, of its first steps: by whether cloth may touch something later,
 * and does already. Eight scenes, run to their ends, lie between them: sheet, sphere, and flag,
 * tablecloth, curtain, twist, skirt and cape of the gallery. Their memory was 0.83 to 1.06 of the
 * forecast. Time is that of the machine as loaded as now. */
enum { LIKELY, LEAST, MOST, NUMBERS };
enum { ALONE, TOUCHES, WILL_TOUCH, KINDS };
static const struct {
    double seconds[NUMBERS], memory[NUMBERS];
} PACE[KINDS] = {[ALONE] = {{1, 0.5, 2.5}, {1, 1, 1.5}},
                 [TOUCHES] = {{1, 0.3, 4}, {1, 1, 2}},
                 [WILL_TOUCH] = {{2, 0.7, 8}, {1.1, 1, 2}}};

static double mean_edge(const struct model *model)
{
    double area = 0, triangles = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        area += model_area(model->cloths + c);
        triangles += model->cloths[c].mesh.n_triangles;
    }
    return triangles > 0 ? sqrt(2 * area / triangles) : 0;
}

void forecast_begin(struct forecast *forecast, const struct phases *phases)
{
    forecast->edge = mean_edge(phases_model(phases));
}

void forecast_end(struct forecast *forecast, const struct summary *trial)
{
    const struct flow_report *report = trial->report;
    const double step = summary_ratio(report->wall_seconds, (double)report->steps);
    const int kind = !model_seeks(trial->model) ? ALONE : report->contacts ? TOUCHES : WILL_TOUCH;
    for (int i = 0; i < NUMBERS; i++) {
        forecast->seconds[i] = PACE[kind].seconds[i] * forecast->extent.steps * step;
        forecast->memory[i] = PACE[kind].memory[i] * (double)trial->memory_bytes;
    }
    if (forecast->extent.may_end)
        forecast->seconds[LEAST] = 0;
}

/* ---- The table ---- */

/* A duration in its largest unit. */
static const char *forecast_name_time(double seconds, char text[32])
{
    static const struct {
        double seconds;
        const char *name;
    } unit[] = {{86400, "days"}, {3600, "h"}, {60, "min"}, {1, "s"}};
    size_t i = 0;
    while (unit[i].seconds > 1 && seconds < 2 * unit[i].seconds)
        i++;
    snprintf(text, 32, "%.2g %s", seconds / unit[i].seconds, unit[i].name);
    return text;
}

static void forecast_print_time(FILE *file, const struct forecast *forecast,
                                const struct summary *trial)
{
    const struct flow_report *report = trial->report;
    char likely[32], least[32], most[32];
    fprintf(file, "  measured         the first %" PRIu64 " steps, %g s simulated, in %.3g s: %s\n",
            report->steps, report->simulated_seconds, report->wall_seconds,
            !model_seeks(trial->model) ? "cloth touches nothing by certified contact"
            : report->contacts         ? "cloth touches already"
                                       : "nothing touches yet");
    fprintf(file, "  time             about %s on %" PRIu64 " workers, %s to %s%s\n",
            forecast_name_time(forecast->seconds[LIKELY], likely), trial->workers,
            forecast_name_time(forecast->seconds[LEAST], least),
            forecast_name_time(forecast->seconds[MOST], most),
            forecast->extent.may_end ? "; less where it ends early" : "");
}

/* ---- Advice: each line begins alike ---- */

static void forecast_advise_contact(FILE *file, const struct forecast *forecast,
                                    const struct model *model)
{
    double thickness = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        thickness = fmax(thickness, model_sides(model, c, c).thickness);
    if (model_seeks(model) && forecast->edge > 0 && thickness > 0.5 * forecast->edge)
        fprintf(
            file,
            "  slow             a thickness of contact, %g m, is above half a cell, %.3g m: each "
            "triangle meets many; a smaller one is faster\n",
            thickness, forecast->edge);
}

static void forecast_advise_solve(FILE *file, const struct summary *trial)
{
    const double MANY = 100, OFTEN = 0.1; /* iterations a step; of steps */
    const struct flow_report *report = trial->report;
    const double iterations = summary_iterations_mean(trial);
    if (iterations > MANY)
        fprintf(file,
                "  slow             %.0f CG iterations a step: a shorter time.h, softer stretch or "
                "fewer vertices\n",
                iterations);
    if ((double)report->steps_halved > OFTEN * (double)report->steps)
        fprintf(file,
                "  slow             %" PRIu64 " of the first steps were halved: a shorter time.h\n",
                report->steps_halved);
    if (model_promise(trial->model).apart && summary_solves_mean(report) > 2)
        fprintf(file,
                "  slow             %.1f solves a step for contact: a shorter time.h, or a larger "
                "contact.thickness\n",
                summary_solves_mean(report));
    if (trial->workers > 1 && report->blocks < 2 * trial->workers)
        fprintf(file,
                "  slow             %" PRIu64 " blocks for %" PRIu64 " workers: --grain %" PRIu64
                " gives all of them work\n",
                report->blocks, trial->workers, report->vertices / (4 * trial->workers) + 1);
}

void forecast_print(FILE *file, const struct forecast *forecast, const struct summary *trial)
{
    const struct flow_report *report = trial->report;
    const struct outputs_extent *all = &forecast->extent;
    fprintf(file, "%s, not run\n", trial->model->name);
    fprintf(file, "  vertices         %" PRIu64 ", triangles %" PRIu64 ", in %" PRIu64 " blocks\n",
            report->vertices, report->triangles, report->blocks);
    fprintf(file, "  steps            %.0f, %g s simulated%s\n", all->steps, all->seconds,
            all->may_end ? ", at most" : "");
    forecast_print_time(file, forecast, trial);
    fprintf(file, "  memory           about %.3g MB a rank, up to %.3g MB\n",
            1e-6 * forecast->memory[LIKELY], 1e-6 * forecast->memory[MOST]);
    fprintf(file, "  disk             %.4g MB by --output, for %.0f frames%s\n", 1e-6 * all->bytes,
            all->frames, all->may_end ? ", at most" : "");
    forecast_advise_contact(file, forecast, trial->model);
    forecast_advise_solve(file, trial);
    summary_limit_print(file, trial);
}

int forecast_write(const struct forecast *forecast, const char *path, struct cloth_error *error)
{
    static const char *const KEY[2][NUMBERS] = {
        {"check_seconds", "check_seconds_least", "check_seconds_most"},
        {"check_memory_bytes", "check_memory_bytes_least", "check_memory_bytes_most"}};
    struct output_report *json = NULL;
    int code = output_report_new(&json, error);
    if (code)
        return code;
    output_report_number(json, "check_steps", forecast->extent.steps);
    output_report_number(json, "check_frames", forecast->extent.frames);
    output_report_number(json, "check_disk_bytes", forecast->extent.bytes);
    for (int i = 0; i < NUMBERS; i++) {
        output_report_number(json, KEY[0][i], forecast->seconds[i]);
        output_report_number(json, KEY[1][i], forecast->memory[i]);
    }
    code = output_report_write(json, path, error);
    output_report_free(json);
    return code;
}
