/* The bench "scale": what limits runs beyond a few hosts. Messages are counted on hosts that this
 * machine plays; times on hosts that it cannot play are predicted. */
#include "bench/scale/scale.h"

#include "bench/cg/cg.h"
#include "bench/program.h"

#include <stdio.h>
#include <stdlib.h>

static const struct bench_case *const CASES[] = {&scale_messages,  &scale_wait,  &scale_runs,
                                                 &scale_predicted, &scale_vast,  &scale_large,
                                                 &scale_million,   &scale_small, NULL};

/* 8 ranks have 3 rounds: 3 messages of a sum and 2 for each of about 5 neighbours. A wait: 2
 * log2 8.
 */
static const struct measure_target TARGETS[] = {{"messages_per_iteration_r8", 13, false},
                                                {"wait_messages_r8", 6, false},
                                                {"prediction_error_r2", 0.15, false},
                                                {"prediction_error_r2_from_r1", 0.15, false},
                                                {"scaling_16x16_tcp", 0.55, true},
                                                {"scaling_16x16_fast", 0.65, true},
                                                {"scaling_64x64_fast", 0.5, true},
                                                {"coarse_path_share", 0.15, false},
                                                {"iterations_large_vs_exact", 1.6, false},
                                                {"iterations_large_vs_one_patch", 1, false},
                                                {"iterations_million_vs_exact", 1.6, false},
                                                {"iterations_million_vs_one_patch", 1, false},
                                                {0}};
enum { TARGET_THREADS = 2 };

int scale_cloth(const char *before, unsigned side, unsigned grain, const char *arguments)
{
    static char command[SCALE_COMMAND];
    char programs[SCALE_PATH];
    program_folder(programs, sizeof programs);
    const int length =
        snprintf(command, sizeof command,
                 "%s '%s/../duite-cloth' '%s/sheet.yaml' --quiet --grain %u "
                 "--set cloths[0].mesh.grid.nx=%u --set cloths[0].mesh.grid.ny=%u %s >&2",
                 before, programs, BENCH_SCENES, grain, side, side, arguments);
    if (length < 0 || (size_t)length >= sizeof command)
        return serve_fail("the folder of duite-bench has too long a name");
    return system(command) ? serve_fail("duite-cloth fails: %.150s", arguments) : 0;
}

static int serve_scale(const struct bench *bench)
{
    static struct cg_session session;
    const struct serve_run *runs[sizeof CASES / sizeof *CASES] = {NULL};
    size_t n = 0;
    for (size_t i = 0; bench->cases[i]; i++)
        if (bench->cases[i]->runs)
            runs[n++] = bench->cases[i]->runs;
    const int status = serve("duite-cloth with its defaults", runs, &session);
    const int code = cg_end(&session);
    return status || code;
}

static int prepare(const struct bench_options *options,
                   void (*say)(const char *key, const char *text))
{
    (void)say;
    return cg_make_folder(options);
}

const struct bench bench_scale = {
    "scale",        "messages on eight hosts, and efficiency predicted on more",
    CASES,          TARGETS,
    TARGET_THREADS, serve_scale,
    prepare,        NULL};
