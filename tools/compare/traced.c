/* The best and the worst member of a subject run once more with a trace. That run's time counts for
 * nothing; its file is named by the member, so that it is never taken for another's. */
#include "tools/chart/chart.h"
#include "tools/compare/compare.h"
#include "tools/compare/plot.h"
#include "tools/compare/program.h"
#include "tools/predict/predict.h"
#include "tools/trace/sums.h"

#include <duite.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { BEST, WORST, TRACED };
static const char *const WORDS[TRACED] = {"The best", "The worst"};

/* Other runtimes leave no trace. row: sorted. Returns how many there are. */
static size_t find_members(const struct compare *compare, const size_t *row, size_t n,
                           const struct compare_config *member[TRACED])
{
    size_t found = 0;
    for (size_t i = 0; i < n; i++) {
        const struct compare_config *config = &compare->config[row[i]];
        if (!config->n || (!compare->program && compare_is_twin(config->value[SCHEDULER])))
            continue;
        member[found ? WORST : BEST] = config;
        found += found < TRACED;
    }
    return found;
}

/* To be freed; NULL without memory. */
static char *path_of(const struct compare *compare, const struct compare_config *config,
                     size_t subject)
{
    char *path = NULL;
    size_t size;
    FILE *memory = open_memstream(&path, &size);
    if (!memory)
        return NULL;
    fprintf(memory, "%s/%zu-", compare->folder, subject + 1);
    const long folder = ftell(memory);
    compare_print_label(compare, config, 0, memory);
    fputs(".trace", memory);
    fclose(memory);
    for (char *at = path ? path + folder : NULL; at && *at; at++)
        if (!strchr(PROGRAM_NAME ".=-", *at))
            *at = '-';
    return path;
}

/* ---- Running ---- */

static bool any_reported(const struct compare *compare, const size_t *row, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t r = 0; r < compare->rounds; r++)
            if (compare->config[row[i]].run[r].reported)
                return true;
    return false;
}

static void trace_member(const struct compare *compare, const struct compare_config *config,
                         size_t subject)
{
    struct compare traced = *compare;
    struct compare_run run;
    char *path = path_of(compare, config, subject);
    if (!path)
        return;
    traced.trace = path;
    compare_start(&traced, config, &run);
    if (!run.fine) {
        printf("no charts of ");
        compare_print_member(compare, config, stdout);
        printf(": its run with a trace failed; %s\n", run.why ? run.why : "out of memory");
        unlink(path);
    }
    free(run.why);
    free(path);
}

void compare_trace(const struct compare *compare, size_t subject, const size_t *row, size_t n)
{
    const struct compare_config *member[TRACED];
    if (compare->metg || !any_reported(compare, row, n)) /* those of earlier runs stay */
        return;
    const size_t found = find_members(compare, row, n, member);
    for (size_t i = 0; i < found; i++)
        trace_member(compare, member[i], subject);
}

/* ---- Showing ---- */

struct traced {
    const struct compare_config *config;
    struct trace_run *run; /* NULL: there is none */
    struct trace_sums sums;
    struct predict_bounds bounds; /* path 0: unknown */
};

static void traced_read(struct traced *traced, const struct compare *compare,
                        const struct compare_config *config, size_t subject)
{
    char *path = path_of(compare, config, subject);
    *traced = (struct traced){.config = config};
    if (path && !access(path, R_OK) && !trace_read(&traced->run, path, true)) {
        if (predict_bounds(traced->run, &traced->bounds))
            traced->bounds.path = traced->bounds.lower = 0;
        if (trace_sum(traced->run, &traced->sums)) {
            trace_run_free(traced->run);
            traced->run = NULL;
        }
    }
    free(path);
}

static void traced_free(struct traced *traced)
{
    predict_bounds_free(&traced->bounds);
    trace_sums_free(&traced->sums);
    if (traced->run)
        trace_run_free(traced->run);
}

static void print_gantt(const struct compare *compare, const struct traced *traced,
                        const char *word, FILE *out)
{
    const struct chart_options options = chart_options_default();
    const struct trace_sums *sums = &traced->sums;
    const double seconds = sums->last - sums->first;
    fprintf(out, "<h3>%s: ", word);
    char *name = NULL;
    size_t size;
    FILE *memory = open_memstream(&name, &size);
    if (memory) {
        compare_print_member(compare, traced->config, memory);
        fclose(memory);
        chart_escape(out, name);
    }
    free(name);
    fprintf(out, "</h3>\n<p>A run with a trace, once: %.4g s.", seconds);
    if (traced->bounds.lower > 0)
        fprintf(out,
                " Lower bound: no schedule of its bodies on %u worker%s takes less than %.4g s, "
                "%.3g %% of that (all bodies: %.4g s of a worker; the longest chain of tasks: %.4g "
                "s).",
                sums->workers, sums->workers > 1 ? "s" : "", traced->bounds.lower,
                1e2 * traced->bounds.lower / seconds, sums->busy, traced->bounds.path);
    fputs("</p>\n", out);
    if (!traced->run->whole || traced->run->lost)
        fputs("<p class=\"warning\">The trace is not whole: it was too long, or events came too "
              "fast.</p>\n",
              out);
    if (chart_write_svg(traced->run, &options, out))
        fprintf(out, "<p class=\"warning\">No chart: %s.</p>\n", duite_message());
}

/* ---- Histograms of bodies ---- */

struct counting {
    const struct trace_run *run;
    const uint32_t *row_of; /* of kernels; UINT32_MAX: it has none */
    struct plot_histogram *histogram;
    bool outline;
};

static void count_body(void *context, const struct trace_seen *seen)
{
    const struct counting *counting = context;
    const struct trace_event *event = seen->event;
    if (event->kind != TRACE_TASK || counting->row_of[event->kernel] == UINT32_MAX)
        return;
    const double own = seen->took - trace_lasts(counting->run, seen->rank, event->within);
    const int bin = own > 2e-6 ? (int)log2(1e6 * own) : 0;
    struct plot_histogram *histogram = &counting->histogram[counting->row_of[event->kernel]];
    double *count = counting->outline ? histogram->outline : histogram->area;
    count[bin < PLOT_BINS ? bin : PLOT_BINS - 1]++;
}

/* The kernels with most seconds of the best. Fills row_of; returns their number. */
static size_t choose_kernels(const struct traced *best, uint32_t *row_of)
{
    enum { MOST_KERNELS = 8 };
    size_t n = 0;
    for (uint32_t k = 0; k < best->run->n_kernels; k++)
        row_of[k] = UINT32_MAX;
    for (; n < MOST_KERNELS; n++) {
        uint32_t most = UINT32_MAX;
        for (uint32_t k = 0; k < best->run->n_kernels; k++)
            if (row_of[k] == UINT32_MAX && best->sums.kernel[k].n &&
                (most == UINT32_MAX ||
                 best->sums.kernel[k].seconds > best->sums.kernel[most].seconds))
                most = k;
        if (most == UINT32_MAX)
            break;
        row_of[most] = (uint32_t)n;
    }
    return n;
}

static void print_histograms(const struct traced *best, const struct traced *worst, FILE *out)
{
    const uint32_t kernels = best->run->n_kernels;
    const bool both = worst && worst->run && worst->run->n_kernels == kernels;
    uint32_t *row_of = calloc(kernels + 1, sizeof *row_of);
    size_t n = row_of ? choose_kernels(best, row_of) : 0;
    struct plot_histogram *histogram = calloc(n + 1, sizeof *histogram);
    for (uint32_t k = 0; k < kernels && histogram && n; k++)
        if (row_of[k] != UINT32_MAX)
            histogram[row_of[k]].name = best->run->kernel_name[k];
    if (histogram && n) {
        struct counting counting = {best->run, row_of, histogram, false};
        trace_each(best->run, count_body, &counting);
        counting.run = both ? worst->run : best->run;
        counting.outline = true;
        trace_each(counting.run, count_body, &counting);
        plot_histograms(both ? "How long bodies took, by kernel: area the best, outline the worst"
                             : "How long bodies took, by kernel",
                        histogram, n, out);
    }
    free(row_of);
    free(histogram);
}

void compare_print_traces(const struct compare *compare, size_t subject, const size_t *row,
                          size_t n, FILE *out)
{
    const struct compare_config *member[TRACED];
    struct traced traced[TRACED] = {0};
    const size_t found = find_members(compare, row, n, member);
    for (size_t i = 0; i < found; i++)
        traced_read(&traced[i], compare, member[i], subject);
    for (size_t i = 0; i < found; i++)
        if (traced[i].run)
            print_gantt(compare, &traced[i], WORDS[i], out);
    if (found && traced[BEST].run)
        print_histograms(&traced[BEST], found > 1 ? &traced[WORST] : NULL, out);
    for (size_t i = 0; i < found; i++)
        traced_free(&traced[i]);
}
