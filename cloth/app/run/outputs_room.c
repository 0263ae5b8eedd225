/* Everything follows from models and meshes; no file is touched. */
#include "cloth/app/run/outputs_room.h"

#include "cloth/app/run/outputs_fields.h"
#include "cloth/output/output.h"

#include <math.h>
#include <stdio.h>

/* Size of the colours of a run of this model alone, bytes, about. */
static double room_of_colours(const struct model *model, uint64_t n_vertices)
{
    struct element_strains rest = {.n_materials = model->n_materials};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        rest.n_triangles += model->cloths[c].mesh.n_triangles;
        rest.n_edges += model->cloths[c].mesh.n_bare_edges;
    }
    const uint64_t blocks = n_vertices / model->grain + 1;
    return (double)output_colours_bytes((uint32_t)n_vertices, (uint32_t)blocks, &rest);
}

/* Each phase writes its colours. */
static void extent_add(struct outputs_extent *all, const struct phases *phases, uint32_t phase,
                       const struct flow *flow)
{
    const struct model *model = phases->models + phase;
    const double seconds = phases_seconds(phases, phase, all->seconds);
    all->steps += round(seconds / model->h);
    all->seconds += seconds;
    all->bytes += room_of_colours(model, flow_vertices(flow));
    all->may_end = all->may_end || model->rest.speed > 0 || model->sewn > 0;
}

static double room_of_rows(const struct flow *flow)
{
    enum { NUMBER = 21 }; /* characters of a number with 17 digits, and the comma behind it */
    const char *header = flow_header(flow);
    double columns = header ? 1 : 0;
    for (; header && *header; header++)
        columns += *header == ',';
    return NUMBER * columns;
}

int outputs_extent_find(struct outputs_extent *all, const struct simulate_options *options,
                        const struct phases *phases, const struct flow *flow,
                        const struct contact_apart *apart, struct cloth_error *error)
{
    const struct model *model = phases_model(phases);
    struct outputs_setup made;
    double frame = 0;
    *all = (struct outputs_extent){0};
    for (uint32_t i = 0; i < phases->n; i++)
        extent_add(all, phases, i, flow);
    all->frames = options->last_frame < UINT64_MAX ? (double)options->last_frame
                                                   : floor(model->fps * all->seconds);
    all->frames += 1 - (double)options->first_frame;
    const int code = outputs_setup_make(&made, options, phases, apart, error);
    if (!code)
        all->bytes += output_begin_bytes(&made.setup, &frame);
    outputs_setup_free(&made);
    if (model_shows_contact(model))
        frame += 3 * sizeof(float) * (double)flow_vertices(flow);
    all->bytes +=
        all->frames * (frame + outputs_hdf5_bytes(model)) + all->steps * room_of_rows(flow);
    return code;
}

int outputs_check_room(const struct outputs_extent *all, const struct model *model,
                       const struct flow *flow, const char *folder, struct cloth_error *error)
{
    const double MUCH = 10e9, OFTEN = 10;
    const char *place = model->fps_place ? model->fps_place : "fps";
    const double bytes = all->bytes, room = output_room(folder);
    const double frames = all->frames, steps = all->steps;
    char what[200];
    snprintf(what, sizeof what, "time.fps = %g gives %.0f frames of %llu vertices up to %g s",
             model->fps, frames, (unsigned long long)flow_vertices(flow), all->seconds);
    if (bytes > room && !all->may_end)
        return cloth_fail(
            error, CLOTH_E_INPUT,
            "%.300s: %s: frames and probes take %.3g GB, but %.200s has room for %.3g "
            "GB; give fewer frames, an earlier time.end, or another folder",
            place, what, 1e-9 * bytes, folder, 1e-9 * room);
    if (bytes > fmin(MUCH, room))
        fprintf(
            stderr,
            "duite-cloth: warning: %.300s: %s: frames and probes take up to %.3g GB in %.200s\n",
            place, what, 1e-9 * bytes, folder);
    if (frames > OFTEN * fmax(steps, 1))
        fprintf(stderr,
                "duite-cloth: warning: %.300s: %s, but there are %.0f steps: each is shown %.0f "
                "times; time.fps = %g shows each once\n",
                place, what, steps, frames / steps, 1 / model->h);
    return CLOTH_OK;
}
