/* A program under duite-compare against the same program run as often by hand. It sleeps, so that
 * what the machine does meanwhile changes neither, and all that is added shows. */
#include "bench/predict/predict.h"
#include "bench/program.h"
#include "bench/temporary.h"

#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

enum { RUNS = 6, MOST_ROUNDS = 6 }; /* RUNS: rounds of which duite-compare has intervals */

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const WAYS[] = {"compared", "by_hand"};
    const struct subject_shape own = {"duite", 0, 1};
    struct measure_series *series[2];
    for (int i = 0; i < 2; i++)
        series[i] =
            measure_series(measure, own, "%s seconds=%s", WAYS[i], options->quick ? "0.05" : "1");
    measure_ratio(measure, series[0], series[1], "compare_overhead");
}

/* Waits for its end; its words are thrown away. */
static int run(const char *const *word)
{
    int status = 0;
    const pid_t child = fork();
    if (!child) {
        const int nowhere = open("/dev/null", O_RDWR);
        for (int file = STDIN_FILENO; file <= STDERR_FILENO && nowhere >= 0; file++)
            dup2(nowhere, file);
        execvp(*word, (char *const *)word);
        _exit(127);
    }
    if (child < 0 || waitpid(child, &status, 0) < 0 || status)
        return serve_fail("%s cannot be run", *word);
    return 0;
}

static int by_hand(void *context, struct serve_request *request, double *value)
{
    char seconds[20];
    int code = 0;
    (void)context;
    serve_word(request, "seconds", seconds, sizeof seconds);
    const double start = serve_seconds();
    for (int i = 0; i < RUNS && !code; i++)
        code = run((const char *const[]){"sleep", seconds, NULL});
    *value = serve_seconds() - start;
    return code;
}

static int compared(void *context, struct serve_request *request, double *value)
{
    char seconds[20], rounds[20], program[PATH_MAX], *folder = predict_path("comparison");
    (void)context;
    serve_word(request, "seconds", seconds, sizeof seconds);
    snprintf(rounds, sizeof rounds, "%d", RUNS);
    const size_t n = program_folder(program, sizeof program);
    if (!folder || n + sizeof "/../duite-compare" > sizeof program) {
        free(folder);
        return serve_no_memory();
    }
    snprintf(program + n, sizeof program - n, "/../duite-compare");
    if (!access(folder, F_OK)) /* the last round's */
        temporary_remove(folder);
    const double start = serve_seconds();
    const int code = run((const char *const[]){program, "--rounds", rounds, "--output", folder,
                                               "--", "sleep", seconds, NULL});
    *value = serve_seconds() - start;
    free(folder);
    return code;
}

static const struct serve_run OVERHEAD_RUNS[] = {{"by_hand", by_hand}, {"compared", compared}, {0}};

const struct bench_case predict_overhead = {
    "overhead", "a program under duite-compare against by hand", plan, OVERHEAD_RUNS, MOST_ROUNDS};
