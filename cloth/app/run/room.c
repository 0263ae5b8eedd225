/* An estimate: halved steps add rows of probes, blocks that move to other ranks add to the colours,
 * and a run that comes to rest ends early. */
#include "cloth/app/run/room.h"

#include "cloth/app/run/outputs_colours.h"
#include "cloth/app/run/outputs_hdf5.h"
#include "cloth/flow/run.h"
#include "cloth/output/output.h"

#include <math.h>
#include <stdio.h>

/* The most that a run of several phases takes. */
struct extent {
    double frames, steps, seconds;
    double colours; /* bytes: colours, which each phase writes */
    bool may_rest;  /* and so take less */
};

static struct extent extent_of(uint32_t n, const struct model *phases, const struct flow *flow)
{
    struct extent all = {.frames = 1};
    for (uint32_t i = 0; i < n; i++) {
        all.steps += phases[i].end / phases[i].h;
        all.seconds += phases[i].end;
        all.colours += outputs_colours_bytes(phases + i, flow_vertices(flow));
        all.may_rest = all.may_rest || phases[i].rest.speed > 0;
    }
    all.frames += floor(phases->fps * all.seconds);
    return all;
}

/* Size of frames, their colours and rows of probes on the disk, bytes. */
static double output_bytes(const struct extent *all, const struct model *model,
                           const struct flow *flow)
{
    enum { NUMBER = 26, INDEX = 24 }; /* characters of a number with 17 digits; of a frame's line */
    const char *header = flow_header(flow);
    double columns = header ? 1 : 0;
    for (; header && *header; header++)
        columns += *header == ',';
    const double vectors = model_shows_contact(model) ? 2 : 1;
    return all->frames * (vectors * 3 * sizeof(float) * (double)flow_vertices(flow) + INDEX +
                          outputs_hdf5_bytes(model)) +
           all->steps * columns * NUMBER + all->colours;
}

int room_check(uint32_t n, const struct model *phases, const struct flow *flow, const char *folder,
               struct cloth_error *error)
{
    const double MUCH = 10e9, OFTEN = 10;
    const struct model *model = phases; /* all have its frames a second, and its columns */
    const struct extent all = extent_of(n, phases, flow);
    const char *place = model->fps_place ? model->fps_place : "fps";
    const double bytes = output_bytes(&all, model, flow), room = output_room(folder);
    const double frames = all.frames, steps = all.steps;
    char what[200];
    snprintf(what, sizeof what, "time.fps = %g gives %.0f frames of %llu vertices up to %g s",
             model->fps, frames, (unsigned long long)flow_vertices(flow), all.seconds);
    if (bytes > room && !all.may_rest)
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
    if (frames > OFTEN * steps)
        fprintf(stderr,
                "duite-cloth: warning: %.300s: %s, but there are %.0f steps: each is shown %.0f "
                "times; time.fps = %g shows each once\n",
                place, what, steps, frames / steps, 1 / model->h);
    return CLOTH_OK;
}
