/* The command line of duite-bench. Started by itself, as a subject, it serves instead. */
#include "bench/bench.h"
#include "bench/loops.h"
#include "bench/report.h"

#include <config.h>

#include <argp.h>
#include <duite.h>
#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

static const struct bench *const BENCHES[] = {&bench_tasks,   &bench_ranks,   &bench_cg,
                                              &bench_physics, &bench_contact, &bench_garments,
                                              &bench_compare, &bench_output,  &bench_scale};
enum { N_BENCHES = sizeof BENCHES / sizeof *BENCHES, MOST_ONLY = 32 };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
#define BENCH_DEBUG 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BENCH_DEBUG 1
#endif
#endif
#ifndef BENCH_DEBUG
#define BENCH_DEBUG 0
#endif

enum { JSON = 256, LIST, ONLY, QUICK, REPEATS, SCHEDULER, SEED, STATES, THREADS };

static const struct argp_option OPTIONS[] = {
    {"json", JSON, "FILE", 0, "write the figures and the host as flat JSON, too", 1},
    {"list", LIST, NULL, 0, "print cases and their metrics, and run nothing", 1},
    {"only", ONLY, "CASE", 0,
     "run this case alone, or all whose names begin with CASE_; may be given several times", 2},
    {"quick", QUICK, NULL, 0, "tiny sizes, to see that everything works; figures mean nothing", 2},
    {"repeats", REPEATS, "N", 0, "rounds that count (default: 16; quick: 2)", 3},
    {"seed", SEED, "N", 0, "of the order of the runs (default: 1)", 3},
    {"states", STATES, "DIR", 0,
     "of cg: the folder that keeps its states from run to run (default: states beside this "
     "program)",
     3},
    {"threads", THREADS, "N", 0, "cores for each subject (default: 2)", 3},
    {"scheduler", SCHEDULER, "NAME", 0, "which scheduler runs our tasks (default: steal)", 3},
    {0}};

struct command {
    const struct bench *bench;
    struct bench_options options;
    const char *only[MOST_ONLY];
    size_t n_only;
    const char *json;
    uint64_t repeats, seed;
    bool list;
};

static int whole_number(struct argp_state *state, const char *option, const char *text,
                        uint64_t least, uint64_t most, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    if (*text >= '0' && *text <= '9' && !*end && !errno && *value >= least && *value <= most)
        return 0;
    argp_error(state, "--%s %s: a whole number from %" PRIu64 " to %" PRIu64 " is expected", option,
               text, least, most);
    return EINVAL;
}

static int choose_bench(struct command *command, struct argp_state *state, const char *name)
{
    char known[200] = "";
    if (command->bench)
        argp_error(state, "one bench at a time: %s or %s", command->bench->name, name);
    for (int i = 0; i < N_BENCHES; i++) {
        if (!strcmp(BENCHES[i]->name, name))
            command->bench = BENCHES[i];
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", BENCHES[i]->name);
    }
    if (!command->bench)
        argp_error(state, "there is no bench %s; known are %s", name, known);
    return 0;
}

/* `name` is the case's, or its name up to a `_`. */
static bool is_named(const char *name, const struct bench_case *one)
{
    const size_t length = strlen(name);
    return !strncmp(name, one->name, length) && (!one->name[length] || one->name[length] == '_');
}

static bool any_is_named(const char *name, const struct bench *bench)
{
    const struct bench_case *const *cases = bench->cases;
    while (*cases && !is_named(name, *cases))
        cases++;
    return *cases;
}

static int check(struct command *command, struct argp_state *state)
{
    if (!command->bench)
        argp_error(state, "which bench? The names are in --help");
    for (size_t i = 0; i < command->n_only; i++)
        if (!any_is_named(command->only[i], command->bench))
            argp_error(state, "--only %s: %s has no such case; --list names them", command->only[i],
                       command->bench->name);
    if (!duite_scheduler_find(command->options.scheduler))
        argp_error(state, "--scheduler %s: %s", command->options.scheduler, duite_message());
    if (BENCH_DEBUG && !command->options.quick && !command->list)
        argp_error(state, "this is a build without optimisation or with a sanitizer: only --quick");
    return 0;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    struct command *command = state->input;
    uint64_t number;
    switch (key) {
    case JSON:
        command->json = text;
        return 0;
    case LIST:
        command->list = true;
        return 0;
    case ONLY:
        if (command->n_only == MOST_ONLY)
            argp_error(state, "--only: at most %d", MOST_ONLY);
        command->only[command->n_only++] = text;
        return 0;
    case QUICK:
        command->options.quick = true;
        return 0;
    case REPEATS:
        return whole_number(state, "repeats", text, 1, 10000, &command->repeats);
    case SCHEDULER:
        command->options.scheduler = text;
        return 0;
    case SEED:
        return whole_number(state, "seed", text, 0, UINT64_MAX, &command->seed);
    case STATES:
        command->options.states = text;
        return 0;
    case THREADS:
        number = 0;
        whole_number(state, "threads", text, 2, 64, &number);
        command->options.threads = (unsigned)number;
        return 0;
    case ARGP_KEY_ARG:
        return choose_bench(command, state, text);
    case ARGP_KEY_END:
        return check(command, state);
    }
    return ARGP_ERR_UNKNOWN;
}

/* ---- Running ---- */

static bool chosen(const struct command *command, const struct bench_case *one)
{
    for (size_t i = 0; i < command->n_only; i++)
        if (is_named(command->only[i], one))
            return true;
    return !command->n_only;
}

static void plan(const struct command *command, const struct bench_case *one,
                 struct measure *measure)
{
    measure->name = one->name;
    one->plan(measure, &command->options);
    if (!command->options.quick && command->options.threads == command->bench->target_threads)
        measure_targets(measure, command->bench->targets);
}

static void list_metric(const struct measure_metric *metric)
{
    printf("    %s (%s)", metric->name, metric->unit);
    if (metric->target)
        printf(", target %s %g", metric->target->least ? ">=" : "<=", metric->target->bound);
    putchar('\n');
}

static void list(const struct command *command, struct measure *measure)
{
    for (const struct bench_case *const *one = command->bench->cases; *one; one++) {
        if (!chosen(command, *one))
            continue;
        printf("%s: %s\n", (*one)->name, (*one)->about);
        plan(command, *one, measure);
        for (size_t i = 0; i < measure->n_metrics; i++)
            list_metric(&measure->metric[i]);
        measure_free(measure);
    }
}

/* Each kind of subject is described once. */
static struct report report;
static char described[200];

static void settings(const char *kind, const char *text)
{
    char word[40], key[60];
    snprintf(word, sizeof word, " %s ", kind);
    if (strstr(described, word))
        return;
    strncat(described, word, sizeof described - strlen(described) - 1);
    snprintf(key, sizeof key, "subject_%s", kind);
    report_text(&report, key, text);
}

static void describe(const struct command *command)
{
    report_text(&report, "bench", command->bench->name);
    report_number(&report, "quick", command->options.quick);
    report_number(&report, "threads", command->options.threads);
    report_text(&report, "scheduler", command->options.scheduler);
    report_number(&report, "repeats", (double)command->repeats);
    report_number(&report, "seed", (double)command->seed);
    report_host(&report);
}

static void report_all(const struct measure *measure, unsigned verdicts[MEASURE_VERDICTS])
{
    for (size_t i = 0; i < measure->n_metrics; i++) {
        report_metric(&report, &measure->metric[i]);
        if (measure->metric[i].target)
            verdicts[measure_verdict(&measure->metric[i])]++;
    }
}

static void conclude(const unsigned verdicts[MEASURE_VERDICTS])
{
    if (!verdicts[MEASURE_PASS] && !verdicts[MEASURE_MISS] && !verdicts[MEASURE_UNKNOWN])
        return;
    report_number(&report, "targets_passed", verdicts[MEASURE_PASS]);
    report_number(&report, "targets_missed", verdicts[MEASURE_MISS]);
    report_number(&report, "targets_not_measured", verdicts[MEASURE_UNKNOWN]);
}

static size_t rounds(const struct command *command, const struct bench_case *one)
{
    const uint64_t most = one->most_rounds;
    return most && most < command->repeats ? most : command->repeats;
}

static void say(const char *key, const char *text)
{
    report_text(&report, key, text);
}

static int prepare(const struct command *command)
{
    const struct bench *bench = command->bench;
    return bench->prepare ? bench->prepare(&command->options, say) : 0;
}

static int run(const struct command *command, struct measure *measure)
{
    int failed = report_start(&report, command->json != NULL);
    uint64_t seed = command->seed;
    unsigned verdicts[MEASURE_VERDICTS] = {0};
    if (!failed)
        describe(command);
    failed = failed || prepare(command);
    for (const struct bench_case *const *one = command->bench->cases; *one && !failed; one++) {
        if (!chosen(command, *one))
            continue;
        plan(command, *one, measure);
        failed = loops_start(measure->loops) ||
                 measure_run(measure, (*one)->name, rounds(command, *one), &seed, settings);
        loops_end();
        if (!failed)
            report_all(measure, verdicts);
        measure_free(measure);
    }
    if (command->bench->finish)
        command->bench->finish();
    if (!failed) {
        report_others(&report);
        conclude(verdicts);
    }
    return report_finish(&report, failed ? NULL : command->json) || failed;
}

static const struct bench *served(void)
{
    const char *name = getenv("DUITE_BENCH_NAME");
    for (int i = 0; i < N_BENCHES; i++)
        if (name && !strcmp(BENCHES[i]->name, name))
            return BENCHES[i];
    return BENCHES[0];
}

static char *names(int key, const char *text, void *input)
{
    (void)input;
    char *help = NULL;
    size_t size;
    FILE *file = key == ARGP_KEY_HELP_POST_DOC ? open_memstream(&help, &size) : NULL;
    if (!file)
        return (char *)(uintptr_t)text;
    for (int i = 0; i < N_BENCHES; i++)
        fprintf(file, "  %-10s %s\n", BENCHES[i]->name, BENCHES[i]->about);
    fputs("\nOurs and the rivals take turns, A B B A; a line is the median of all rounds, in "
          "brackets the first and third quartile, then its target if it has one. A wrong answer "
          "ends the run with status 1; a missed target does not. What is measured and how: "
          "docs/measuring.md.",
          file);
    fclose(file);
    return help;
}

const char *argp_program_version = "duite-bench (" PACKAGE_STRING ")";

int main(int argc, char **argv)
{
    if (serve_wanted())
        return served()->serve(served());
    static struct measure measure;
    struct command command = {.options = {.threads = 2, .scheduler = "steal"}, .seed = 1};
    const struct argp argp = {
        OPTIONS, parse, "BENCH", "Measures duite against its rivals.\vBenches:", NULL, names, NULL};
    signal(SIGPIPE, SIG_IGN);
    argp_err_exit_status = 2;
    if (argp_parse(&argp, argc, argv, 0, NULL, &command))
        return 2;
    if (!command.repeats)
        command.repeats = command.options.quick ? 2 : 16;
    setenv("DUITE_BENCH_NAME", command.bench->name, 1);
    if (command.list)
        return list(&command, &measure), 0;
    return run(&command, &measure);
}
