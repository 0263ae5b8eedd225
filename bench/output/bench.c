/* The bench "output": its cases and its targets. */
#include "bench/output/output.h"

#include <config.h>

static const struct measure_series *simulate(struct measure *measure,
                                             const struct bench_options *options, const char *kind,
                                             const char *output)
{
    return measure_series(measure, (struct subject_shape){kind, 0, options->threads},
                          "simulate output=%s threads=%u scheduler=%s quick=%d", output,
                          options->threads, options->scheduler, options->quick);
}

static void plan_frames(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *with = simulate(measure, options, "duite_hdf5", "hdf5");
    const struct measure_series *without = simulate(measure, options, "duite", "none");
    measure_value(measure, without, 1, "s", "no_frames_seconds");
    measure_ratio(measure, with, without, "frames_slowdown");
}

static void plan_checkpoints(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *with = simulate(measure, options, "duite", "checkpoints");
    const struct measure_series *without = simulate(measure, options, "duite", "frames");
    measure_value(measure, without, 1, "s", "no_checkpoints_seconds");
    measure_ratio(measure, with, without, "checkpoint_slowdown");
}

static void plan_usd(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *with = simulate(measure, options, "duite", "usd");
    const struct measure_series *without = simulate(measure, options, "duite", "frames");
    measure_ratio(measure, with, without, "usd_slowdown");
}

static void plan_live(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *live = simulate(measure, options, "duite_live", "live");
    const struct measure_series *stopped = simulate(measure, options, "duite_live", "stopped");
    const struct measure_series *without = simulate(measure, options, "duite", "none");
    measure_value(measure, without, 1, "s", "not_live_seconds");
    measure_ratio(measure, live, without, "live_slowdown");
    measure_ratio(measure, stopped, without, "live_stopped_slowdown");
}

static void plan_write(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape ours = {"duite", 0, options->threads};
    const int times = options->quick ? 2 : 20;
    const struct measure_series *checkpoint =
        measure_series(measure, ours, "write as=checkpoint times=%d", times);
    const struct measure_series *plain =
        measure_series(measure, ours, "write as=plain times=%d", times);
    measure_value(measure, checkpoint, 1e3, "ms", "checkpoint_ms");
    measure_ratio(measure, checkpoint, plain, "checkpoint_vs_write");
}

static void plan_offscreen(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape view = {"view", 0, options->threads};
    const char *size = options->quick ? "width=128 height=72" : "width=1280 height=720";
    const struct measure_series *full = measure_series(measure, view, "draw shadows=1 %s", size);
    const struct measure_series *plain = measure_series(measure, view, "draw shadows=0 %s", size);
    measure_value(measure, full, 1e3, "ms", "offscreen_frame_ms");
    measure_ratio(measure, full, plain, "offscreen_vs_plain");
}

static void plan_film(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *film = measure_series(
        measure, (struct subject_shape){"film", 0, options->threads}, "film frames=%d size=%s",
        options->quick ? 2 : 12, options->quick ? "128x72" : "1280x720");
    measure_value(measure, film, 1, "s", "film_seconds");
}

static const struct bench_case FRAMES = {
    "frames", "duite-cloth on the sheet, 25 frames a second to HDF5 against no output", plan_frames,
    output_runs, 8};
static const struct bench_case LIVE = {
    "live", "the same published by --live, to a viewer that takes all, and to one that is stopped",
    plan_live, NULL, 8};
static const struct bench_case CHECKPOINTS = {
    "checkpoints", "the same with frames, a checkpoint a second against none", plan_checkpoints,
    NULL, 8};
static const struct bench_case USD = {
    "usd", "the same with frames, which duite-view then writes as USD, against frames alone",
    plan_usd, NULL, 8};
static const struct bench_case WRITE = {
    "write", "a checkpoint of the sheet against write and fsync of as many bytes", plan_write, NULL,
    0};
static const struct bench_case OFFSCREEN = {
    "offscreen",
    "a picture of the sheet, 1280 x 720, without a display, with shadows against without",
    plan_offscreen, NULL, 8};
static const struct bench_case FILM = {
    "film", "duite-view --mp4: 12 frames of the sheet, 1280 x 720, drawn and encoded", plan_film,
    NULL, 3};

static const struct bench_case *const CASES[] = {&FRAMES, &LIVE,      &CHECKPOINTS, &USD,
                                                 &WRITE,  &OFFSCREEN, &FILM,        NULL};

/* For two threads and the full sizes. */
static const struct measure_target TARGETS[] = {{"frames_slowdown", 1.03, false},
                                                {"live_slowdown", 1.03, false},
                                                {"live_stopped_slowdown", 1.01, false},
                                                {"checkpoint_vs_write", 1.5, false},
                                                {"checkpoint_slowdown", 1.02, false},
                                                {"usd_slowdown", 1.05, false},
                                                {"offscreen_vs_plain", 2.5, false},
                                                {"offscreen_frame_ms", 150, false},
                                                {"film_seconds", 10, false},
                                                {0}};
enum { TARGET_THREADS = 2 };

static int serve_output(const struct bench *bench)
{
    const struct serve_run *const runs[] = {output_runs, NULL};
    (void)bench;
    return serve("duite-cloth cloth/scenes/sheet.yaml, as a program", runs, NULL);
}

const struct bench bench_output = {
    "output",       "what frames, the live view, checkpoints, pictures and films cost",
    CASES,          TARGETS,
    TARGET_THREADS, serve_output,
    output_prepare, NULL};
