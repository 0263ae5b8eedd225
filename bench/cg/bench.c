/* The bench "cg": its cases, its targets, and its states, which are made before anything is
 * measured, in a process of ours. */
#include "bench/cg/cg.h"

#include "bench/program.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct bench_case *const CASES[] = {&cg_spring_150, &cg_spring_400, &cg_half_150,
                                                 &cg_solve,      &cg_jacobi,     &cg_error,
                                                 &cg_step,       &cg_realtime,   NULL};

/* For two threads and the full sizes. */
static const struct measure_target TARGETS[] = {{"spring_150_vs_petsc", 0.26, false},
                                                {"spring_400_vs_petsc", 0.155, false},
                                                {"spring_150_vs_twin", 1.05, false},
                                                {"bandwidth_fraction_400", 0.9, true},
                                                {"half_150_vs_petsc", 0.42, false},
                                                {"solve_vs_petsc_cg", 0.067, false},
                                                {"solve_vs_petsc_icc", 0.2, false},
                                                {"iterations_vs_jacobi_geo", 0.18, false},
                                                {"iterations_vs_jacobi_worst", 0.6, false},
                                                {"solve_time_vs_jacobi_geo", 0.45, false},
                                                {"solve_time_vs_jacobi_worst", 1, false},
                                                {"mass_norm_error", 0.01, false},
                                                {"step_speedup_t2", 1.85, true},
                                                {"step_speedup_r2", 1.85, true},
                                                {"realtime_ms_per_frame", 40, false},
                                                {"realtime_ms_per_frame_p95", 60, false},
                                                {0}};
enum { TARGET_THREADS = 2 };

/* ---- States ---- */

static int make(const struct bench_options *options, struct subject **maker, const char *name,
                const char *why_made)
{
    char command[200], why[400];
    double vertices;
    if (!*maker)
        *maker = subject_start((struct subject_shape){"duite", 0, options->threads});
    if (!*maker)
        return 1;
    fprintf(stderr, "duite-bench: making the state %s: %s\n", name, why_made);
    snprintf(command, sizeof command, "make state=%s quick=%d threads=%u scheduler=%s", name,
             options->quick, options->threads, options->scheduler);
    if (!subject_ask(*maker, command, &vertices, why, sizeof why))
        return 0;
    fprintf(stderr, "duite-bench: the state %s: %s\n", name, why);
    return 1;
}

/* Makes the folder and names it to all processes. Small states have their own. */
int cg_make_folder(const struct bench_options *options)
{
    char folder[PATH_MAX];
    size_t used = options->states ? (size_t)snprintf(folder, sizeof folder, "%s", options->states)
                                  : program_folder(folder, sizeof folder);
    if (!options->states && used < sizeof folder)
        used += (size_t)snprintf(folder + used, sizeof folder - used, "/states");
    if (used < sizeof folder && options->quick) {
        mkdir(folder, 0777); /* may be there; the next one tells */
        used += (size_t)snprintf(folder + used, sizeof folder - used, "/quick");
    }
    if (used < sizeof folder && (!mkdir(folder, 0777) || !access(folder, W_OK)))
        return setenv(STATE_FOLDER, folder, 1);
    fprintf(stderr, "duite-bench: the folder of the states, %s, cannot be written to\n", folder);
    return 1;
}

static int prepare(const struct bench_options *options,
                   void (*say)(const char *key, const char *text))
{
    struct subject *maker = NULL;
    int code = cg_make_folder(options);
    for (const char *const *name = states_all(); *name && !code; name++) {
        struct state state = {0};
        char key[60], text[100];
        const char *missing = states_missing(*name);
        snprintf(key, sizeof key, "state_%s", *name);
        if (missing) {
            say(key, missing);
            continue;
        }
        if (state_read(&state, *name))
            code = make(options, &maker, *name, serve_failure()) || state_read(&state, *name);
        snprintf(text, sizeof text, "%016" PRIx64 ", %u vertices, %zu springs", state.hash,
                 state.system.n, state.system.n_pairs);
        if (!code)
            say(key, text);
        state_free(&state);
    }
    return subject_stop(maker) || code;
}

static int serve_cg(const struct bench *bench)
{
    static struct cg_session session;
    const struct serve_run *const runs[] = {cg_runs, cg_make_runs, NULL};
    (void)bench;
    const int status =
        serve("the cloth's tasks, springs in double; duite_options_default() but for threads and "
              "scheduler",
              runs, &session);
    const int code = cg_end(&session);
    return status || code;
}

const struct bench bench_cg = {
    "cg",
    "the solver: an iteration and a solve against PETSc and a plain loop, steps, frames",
    CASES,
    TARGETS,
    TARGET_THREADS,
    serve_cg,
    prepare,
    NULL};
