/* The command line of duite-trace: reads a trace once, and writes each form that is asked for. */
#include "tools/chart/chart.h"
#include "tools/command.h"
#include "tools/predict/predict.h"
#include "tools/trace/export.h"
#include "tools/trace/sums.h"

#include <duite.h>

#include <config.h>

#include <argp.h>
#include <errno.h>
#include <math.h>
#include <string.h>

enum { FAILED = 1, BAD_INPUT = 2 };
const char *argp_program_version = "duite-trace (" PACKAGE_STRING ")";

/* The forms: the rows of export.h, and two of the predictor's graph of tasks. */
static const struct trace_export FORM_DOT = {
    "dot", "write the tasks and what each waited for, for Graphviz", predict_write_dot, NULL};
static const struct trace_export FORM_GRAPH = {
    "graph",
    "write the tasks and what each read as a graph, which duite-graph and duite-compare "
    "schedule without the program",
    predict_write_graph, NULL};
#define FORM_OF(name) &trace_export_##name,
static const struct trace_export *const FORMS[] = {&FORM_DOT, &FORM_GRAPH,
                                                   TRACE_EXPORT_ROWS(FORM_OF)};
enum { N_FORMS = sizeof FORMS / sizeof FORMS[0] };

/* Forms of the chart, which has options of its own. */
static const struct {
    const char *option, *help;
    int (*write)(const struct trace_run *run, const struct chart_options *options, FILE *file);
} CHARTS[] = {{"svg", "draw the Gantt chart of the run as SVG", chart_write_svg},
              {"png", "draw the Gantt chart of the run as PNG", chart_write_png}};
enum { N_CHARTS = sizeof CHARTS / sizeof CHARTS[0], N_OUTS = N_FORMS + N_CHARTS };
enum { CHECK = 256, PARTIAL, WINDOW, SIZE, FORM };

struct command {
    const char *file;
    const char *out[N_OUTS]; /* by form, then by chart */
    struct chart_options chart;
    bool partial, check, charted; /* charted: an option of charts was given */
};

/* FORM + i: the form of row i, then charts; then the others, and zeros. */
static struct argp_option options[N_OUTS + 5];

static void options_fill(void)
{
    struct argp_option *next = options;
    for (int i = 0; i < N_FORMS; i++)
        *next++ = (struct argp_option){
            FORMS[i]->option, FORM + i, FORMS[i]->write_folder ? "FOLDER" : "OUT", 0,
            FORMS[i]->help,   1};
    for (int i = 0; i < N_CHARTS; i++)
        *next++ =
            (struct argp_option){CHARTS[i].option, FORM + N_FORMS + i, "OUT", 0, CHARTS[i].help, 1};
    *next++ = (struct argp_option){
        "window", WINDOW, "FROM:TO", 0, "seconds that the chart shows, or percent of the run (all)",
        1};
    *next++ = (struct argp_option){
        "size", SIZE, "WxH", 0, "pixels of the chart (1280 wide, as high as its rows)", 1};
    *next++ = (struct argp_option){
        "check", CHECK, NULL, 0, "whether the events add up to what the workers counted", 2};
    *next = (struct argp_option){
        "partial", PARTIAL, NULL, 0, "take what there is of a run that did not come to its end", 2};
}

static error_t form_option_read(int key, char *value, struct argp_state *state)
{
    struct command *command = state->input;
    if (key >= FORM && key < FORM + N_OUTS) {
        command->out[key - FORM] = value;
        return 0;
    }
    switch (key) {
    case CHECK:
        command->check = true;
        return 0;
    case WINDOW:
        command->charted = true;
        if (!chart_window_parse(value, &command->chart))
            argp_error(
                state,
                "--window takes FROM:TO in seconds, such as 0.1:0.2, or in percent of the run, "
                "such as 50%%:51%%, not `%s'",
                value);
        return 0;
    case SIZE:
        command->charted = true;
        if (!chart_size_parse(value, &command->chart))
            argp_error(state, "--size takes WIDTHxHEIGHT, such as 1280x720, not `%s'", value);
        return 0;
    case ARGP_KEY_END:
        if (command->charted && !command->out[N_FORMS] && !command->out[N_FORMS + 1])
            argp_error(state, "--window and --size are of charts: --svg OUT or --png OUT");
        return 0;
    case PARTIAL:
        command->partial = true;
        return 0;
    default:
        return predict_trace_argument(key, value, state, &command->file);
    }
}

static const struct argp ARGP = {
    .options = options,
    .parser = form_option_read,
    .args_doc = "TRACE",
    .doc = "Says what a trace has (duite-cloth --trace), or turns it into forms that viewers open. "
           "OUT may be - for standard output. The files TRACE.1, TRACE.2, ... of the other ranks "
           "are expected beside TRACE.\v"
           "Exit codes: 0 done, 1 a file could not be written or --check found a difference, 2 the "
           "trace or the command line is wrong."};

static int write_failed(const char *out)
{
    fprintf(stderr, "duite-trace: %s cannot be written: %s\n", out, strerror(errno));
    return FAILED;
}

static int form_failed(void)
{
    fprintf(stderr, "duite-trace: %s\n", duite_message());
    return FAILED;
}

static int write_form(const struct trace_run *run, const struct command *command, size_t form)
{
    const char *out = command->out[form];
    if (form < N_FORMS && FORMS[form]->write_folder)
        return FORMS[form]->write_folder(run, out) ? form_failed() : 0;
    bool standard = !strcmp(out, "-");
    FILE *file = standard ? stdout : fopen(out, "w");
    if (!file)
        return write_failed(out);
    int code = form < N_FORMS ? FORMS[form]->write(run, file)
                              : CHARTS[form - N_FORMS].write(run, &command->chart, file);
    errno = 0;
    bool fine = !ferror(file) && !fflush(file);
    if (!standard)
        fine = !fclose(file) && fine;
    if (code)
        return form_failed();
    return fine ? 0 : write_failed(out);
}

static int table_write(const struct trace_run *run)
{
    struct predict_bounds bounds;
    const double path = predict_bounds(run, &bounds) ? (double)NAN : bounds.path;
    predict_bounds_free(&bounds);
    return trace_print(run, path, stdout);
}

static int forms_write(const struct command *command, const struct trace_run *run)
{
    bool asked = command->check;
    int code = 0;
    if (run->lost)
        fprintf(stderr, "duite-trace: warning: %s: %llu events or words were lost\n", command->file,
                (unsigned long long)run->lost);
    for (size_t i = 0; i < N_OUTS && !code; i++) {
        asked |= command->out[i] != NULL;
        if (command->out[i])
            code = write_form(run, command, i);
    }
    if (command->check && !code && !trace_sums_agree(run, stderr))
        code = FAILED;
    if (!asked && table_write(run))
        code = FAILED;
    if (fflush(stdout) && !code)
        code = write_failed("standard output");
    return code;
}

int main(int argc, char **argv)
{
    struct command command = {.chart = chart_options_default()};
    argp_err_exit_status = BAD_INPUT;
    options_fill();
    if (argp_parse(&ARGP, argc, argv, 0, NULL, &command))
        return BAD_INPUT;
    struct trace_run *run;
    if (trace_read(&run, command.file, command.partial)) {
        fprintf(stderr, "duite-trace: %s\n", duite_message());
        return BAD_INPUT;
    }
    int code = forms_write(&command, run);
    trace_run_free(run);
    return code;
}
