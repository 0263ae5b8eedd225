/* The outputs and checks of a run, from the first frame to the last. Folders are locked before the
 * first write, and stay locked. */
#include "cloth/app/run/outputs.h"

#include "cloth/app/run/checkpoints.h"
#include "cloth/app/run/outputs_setup.h"
#include "cloth/base/memory.h"
#include "cloth/output/output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Another run may write into the same folder. */
static int lock_folder(struct output_lock **lock, const char *folder, struct cloth_error *error)
{
    struct cloth_error note = {0};
    const int code = output_lock_take(lock, folder, &note, error);
    if (note.code && !code)
        fprintf(stderr, "duite-cloth: warning: %s\n", note.text);
    return code;
}

/* Port 0. */
static bool is_any_port(const char *address)
{
    const char *colon = strrchr(address, ':');
    return strtoul(colon ? colon + 1 : address, NULL, 10) == 0;
}

static int open_system(struct outputs *to, const struct model *model, struct cloth_error *error)
{
    if (!model_is_implicit(model))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--save-system: an explicit integrator solves no system");
    if (!model_is_linear(model))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--save-system: a step has one system of its own by implicit_euler with "
                          "newton.steps 1 only");
    if (model_is_filtered(model))
        return cloth_fail(
            error, CLOTH_E_INPUT,
            "--save-system: the files know held vertices only, no pins to lines or planes");
    if (model->end / model->h + 0.5 < 1)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "--save-system: the scene ends before its first step");
    return lock_folder(to->locks + 1, to->options->save_system, error);
}

/* Opens the probes in the folder of frames, which exists. */
static int open_probes(struct outputs *to, const struct flow *flow, const uint64_t *n_rows,
                       struct cloth_error *error)
{
    const char *header = flow_header(flow);
    return header ? output_probes_open(&to->probes, to->options->output, header, n_rows, error)
                  : output_probes_forget(to->options->output, error);
}

/* The shapes of a later phase follow when it begins. */
static int outputs_open_colours(struct outputs *to, const struct phases *phases,
                                const struct flow *flow, const uint64_t *n_frames,
                                struct cloth_error *error)
{
    const int code = output_colours_open(&to->colours, to->options->output,
                                         (uint32_t)flow_vertices(flow), n_frames, error);
    return code || phases->now ? code
                               : outputs_colours_rest(&to->colours, phases_model(phases),
                                                      n_frames ? *n_frames : 0, error);
}

static int open_forces(struct outputs *to, const struct model *model, const struct flow *flow,
                       const uint64_t *n_frames, struct cloth_error *error)
{
    const char *folder = to->options->output;
    return model_shows_contact(model)
               ? output_forces_open(&to->forces, folder, (uint32_t)flow_vertices(flow), n_frames,
                                    to->settler, error)
               : output_forces_forget(folder, error);
}

/* How many of the run's first frames are in the folder. */
static uint64_t outputs_count(const struct outputs *to, uint64_t frames)
{
    const uint64_t first = to->options->first_frame;
    return frames > first ? frames - first : 0;
}

/* Opens the files, of the first phase of this run. resumed: an earlier run's files go on. */
static int open_output(struct outputs *to, const struct phases *phases, const struct flow *flow,
                       struct output_setup *setup, const struct flow_resumed *resumed,
                       struct cloth_error *error)
{
    const struct model *model = phases_model(phases);
    const uint64_t rows = phases_before(phases).steps + (resumed ? resumed->steps : 0) + 1;
    const uint64_t stay = resumed ? outputs_count(to, resumed->frames) : 0;
    const uint64_t *n_frames = resumed ? &stay : NULL;
    setup->n_frames = n_frames;
    int code = output_settler_open(&to->settler, error);
    setup->settler = to->settler;
    code = code ? code : output_open(&to->frames, setup, error);
    code = code ? code : outputs_open_colours(to, phases, flow, n_frames, error);
    code = code ? code
                : outputs_hdf5_open(&to->hdf5, model, to->options->output, n_frames, to->settler,
                                    error);
    code = code ? code : open_forces(to, model, flow, n_frames, error);
    return code ? code : open_probes(to, flow, resumed ? &rows : NULL, error);
}

int outputs_lock(struct outputs *to, const struct simulate_options *options,
                 struct cloth_error *error)
{
    if (!options->output || to->locks[0])
        return CLOTH_OK;
    return lock_folder(to->locks, options->output, error);
}

/* Deletes an earlier run's checkpoints unless this run resumes it. */
static int open_keeper(struct outputs *to, const struct phases *phases, bool resumed,
                       struct cloth_error *error)
{
    const struct simulate_options *options = to->options;
    if (!resumed && output_checkpoints_forget(options->output, error))
        return error->code;
    to->phases = phases;
    if (!(options->checkpoint > 0))
        return CLOTH_OK;
    to->settings = phases_settings(phases, error);
    return to->settings ? keeper_open(&to->keeper, to, error) : error->code;
}

/* Checks, before the first write, that the live view can listen. */
static int open_live(struct outputs *to, struct cloth_error *error)
{
    const char *address = to->options->live;
    char host[65] = "";
    const int code = live_publish_open(&to->live, address, outputs_warn, error);
    gethostname(host, sizeof host - 1);
    if (!code && (!to->options->quiet || is_any_port(address)))
        fprintf(stderr, "duite-cloth: live view: duite-view --connect %s on %s\n",
                live_publish_address(to->live), host);
    return code;
}

/* Files, and the places of obstacles and seams for the frames of all phases up to this one. flow:
 * of the first phase of this run; NULL: its files go on. */
static int show_scene(struct outputs *to, const struct phases *phases, const struct flow *flow,
                      const struct contact_apart *apart, const struct flow_resumed *resumed,
                      struct cloth_error *error)
{
    const double begin = phases->total.simulated_seconds;
    struct outputs_setup made;
    int code = outputs_setup_make(&made, to->options, phases, apart, error);
    if (!code && flow && to->options->output)
        code = open_output(to, phases, flow, &made.setup, resumed, error);
    else if (!code && to->frames)
        code = output_scene(to->frames, &made.setup, error);
    if (!code && !flow && to->frames)
        output_bodies_go_on(to->frames, made.setup.bodies, begin);
    if (!code && to->live)
        code = live_publish_scene(to->live, &made.setup, begin, error);
    outputs_setup_free(&made);
    return code;
}

/* Looks for intersections in the frames of the phase. */
static int open_check(struct outputs *to, const struct phases *phases,
                      const struct contact_apart *apart, struct cloth_error *error)
{
    const struct intersections_setup of = {.program = "duite-cloth",
                                           .apart = apart,
                                           .begin = phases->total.simulated_seconds,
                                           .found = &to->found};
    intersections_close(&to->intersections);
    return to->options->check_intersections
               ? intersections_of(&to->intersections, phases_model(phases), of, error)
               : CLOTH_OK;
}

int outputs_open(struct outputs *to, const struct simulate_options *options,
                 const struct phases *phases, const struct flow *flow,
                 const struct contact_apart *apart, const struct flow_resumed *resumed,
                 struct cloth_error *error)
{
    const struct model *last = phases->models + phases->n - 1;
    to->options = options;
    int code = open_check(to, phases, apart, error);
    if (!code)
        code = drape_of(&to->drape, last, error);
    if (!code && options->live)
        code = open_live(to, error);
    if (!code && options->save_system)
        code = open_system(to, last, error);
    if (!code)
        code = outputs_lock(to, options, error);
    if (!code && (options->output || options->live))
        code = show_scene(to, phases, flow, apart, resumed, error);
    if (!code && options->output)
        code = open_keeper(to, phases, resumed, error);
    return code || !phases->now ? code : outputs_go_on(to, phases, apart, error);
}

int outputs_go_on(struct outputs *to, const struct phases *phases,
                  const struct contact_apart *apart, struct cloth_error *error)
{
    int code = open_check(to, phases, apart, error);
    if (!code)
        code = outputs_colours_rest(&to->colours, phases_model(phases),
                                    outputs_count(to, phases_before(phases).frames), error);
    if (!code)
        code = outputs_hdf5_go_on(&to->hdf5, phases_model(phases), error);
    return code || !(to->frames || to->live) ? code
                                             : show_scene(to, phases, NULL, apart, NULL, error);
}

void outputs_close(struct outputs *of, struct cloth_error *error)
{
    output_settler_close(&of->settler, error);
    keeper_close(&of->keeper);
    output_probes_close(&of->probes, error);
    output_forces_close(&of->forces, error);
    output_colours_close(&of->colours, error);
    output_close(&of->frames, error);
    outputs_hdf5_close(&of->hdf5);
    live_publish_close(&of->live);
}

void outputs_free(struct outputs *of)
{
    intersections_close(&of->intersections);
    drape_free(&of->drape);
    free(of->settings);
    of->settings = NULL;
    output_lock_free(of->locks);
    output_lock_free(of->locks + 1);
}

/* ---- Calls from the flow ---- */

static int outputs_system(void *context, const struct solve_system *system,
                          struct cloth_error *error)
{
    const struct outputs *of = context;
    return output_system(of->options->save_system, system, error);
}

/* Checks the state, then, if frames are written, their floats. */
static int outputs_check_frame(const struct outputs *of, uint64_t frame, double time,
                               const double *position, struct cloth_error *error)
{
    const int code = intersections_frame(of->intersections, frame, time, position, false, error);
    if (code || !of->frames)
        return code;
    return intersections_frame(of->intersections, frame, time, position, true, error);
}

static int outputs_frame(void *context, uint64_t frame, double time, const double *position,
                         struct cloth_error *error)
{
    struct outputs *of = context;
    int code = CLOTH_OK;
    if (of->frames) {
        code = output_frame(of->frames, frame, time, position, error);
        of->frames_written = frame + (code ? 0 : 1);
    }
    if (!code)
        outputs_hdf5_position(&of->hdf5, frame, time, position);
    if (!code && of->live)
        live_publish_frame(of->live, frame, time, position);
    if (!code && of->intersections)
        code = outputs_check_frame(of, frame, time, position, error);
    drape_frame(&of->drape, position);
    return code;
}

/* Waits first: frames before one that failed may still be on their way to the disk. */
static uint64_t outputs_written(void *context)
{
    const struct outputs *of = context;
    struct cloth_error said = {0};
    output_settler_wait(of->settler, &said);
    return of->frames ? output_frames_settled(of->frames) : of->frames_written;
}

static int outputs_places(void *context, uint64_t frame, const struct flow_places *places,
                          struct cloth_error *error)
{
    struct outputs *of = context;
    return outputs_colours_places(&of->colours, frame, places, error);
}

static int outputs_beside(void *context, const struct flow_beside *beside,
                          struct cloth_error *error)
{
    struct outputs *of = context;
    (void)error;
    outputs_hdf5_beside(&of->hdf5, beside);
    return CLOTH_OK;
}

static int outputs_force(void *context, uint64_t frame, const double *force,
                         struct cloth_error *error)
{
    struct outputs *of = context;
    outputs_hdf5_force(&of->hdf5, force);
    return output_forces_frame(of->forces, frame, force, error);
}

static int outputs_row(void *context, uint64_t step, double time, size_t n, const double *values,
                       struct cloth_error *error)
{
    const struct outputs *of = context;
    return output_probes_row(of->probes, step, time, n, values, error);
}

void outputs_receive(struct outputs *of, const struct simulate_options *options, bool frames,
                     bool last, struct flow_output *to)
{
    const bool folder = options->output;
    to->context = of;
    to->frame = frames ? outputs_frame : NULL;
    to->written = outputs_written;
    to->places = folder ? outputs_places : NULL;
    to->beside = folder ? outputs_beside : NULL;
    to->force = folder ? outputs_force : NULL;
    to->row = folder ? outputs_row : NULL;
    to->system = options->save_system && last ? outputs_system : NULL;
    to->save = options->checkpoint > 0 ? restart_save : NULL;
}
