/* The minimum effective task granularity (Slaughter et al., Task Bench, SC 2020): how short tasks
 * may be for a runtime to use half of the machine. A task's granularity is the time of all cores
 * for it, overhead included; efficiency is the work that cores do in a second, as a part of the
 * most that any member does on this subject at any grain. */
#include "tools/chart/chart.h"
#include "tools/compare/compare.h"
#include "tools/compare/graph.h"
#include "tools/compare/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double HALF = 0.5;

struct point {
    double granularity; /* s of a core */
    double efficiency;
};

/* The curve of a member (all values but the grain) on a subject, from the shortest tasks on. */
struct curve {
    const struct compare_config *member; /* at the first grain */
    struct point point[COMPARE_MOST];
    size_t n;
};

/* ---- Lists ---- */

static void fill(struct compare_list *list, const char *const *items)
{
    for (; *items; items++)
        list->item[list->n++] = *items;
}

void compare_metg_lists(struct compare *compare)
{
    static const char *const subjects[] = {"stencil", "nearest", "fft", "spread",
                                           "tree",    "random",  NULL};
    static const char *const grains[] = {"0.0078125", "0.015625", "0.03125", "0.0625",
                                         "0.125",     "0.25",     "0.5",     "1",
                                         "2",         "4",        "8",       NULL};
    static const char *const ours[] = {"steal", "forks:steal", NULL};
    static const char *const others[] = {"libgomp:tasks", "libomp:tasks", "starpu:lws", "mpi:isend",
                                         NULL};
    struct compare_list *schedulers = &compare->list[SCHEDULER];
    char wrong[COMPARE_PROGRAM + 200];
    if (!compare->list[SUBJECT].n)
        fill(&compare->list[SUBJECT], subjects);
    if (!compare->list[GRAIN].n)
        fill(&compare->list[GRAIN], grains);
    if (schedulers->n)
        return;
    fill(schedulers, ours);
    for (const char *const *name = others; *name; name++)
        if (compare_twin_wrong(*name, wrong, sizeof wrong))
            printf("without %s: %s\n", *name, wrong);
        else
            schedulers->item[schedulers->n++] = *name;
}

/* ---- Curves ---- */

static double cores_of(const struct compare_config *config)
{
    return strtod(config->value[RANKS], NULL) * strtod(config->value[THREADS], NULL);
}

/* Seconds of a core for a task, less its overhead, if cost is what it says it is. */
static double cost_of(const struct compare *compare, const struct compare_config *config)
{
    return strtod(compare->cost, NULL) * strtod(config->value[GRAIN], NULL);
}

/* The number of tasks of a kind; all members and grains have as many. 0 without memory. */
static size_t tasks_of(const struct compare *compare, const char *subject)
{
    struct compare_graph graph = {0};
    compare_graph_make(&graph, subject, (size_t)strtod(compare->tasks, NULL), 1, 8, 1);
    const size_t n = graph.n;
    compare_graph_free(&graph);
    return n;
}

static bool same_curve(const struct compare *compare, const struct compare_config *a,
                       const struct compare_config *b)
{
    for (int d = 0; d < compare->dimensions; d++)
        if (d != GRAIN && a->value[d] != b->value[d])
            return false;
    return true;
}

/* The product is the cost but for a factor. */
static int by_cost(const void *a, const void *b)
{
    const struct point *x = a, *y = b;
    const double less = x->granularity * x->efficiency, more = y->granularity * y->efficiency;
    return less < more ? -1 : less > more;
}

/* Efficiencies as a part of `most`, which is work of a core in a second. */
static void make_curve(const struct compare *compare, size_t tasks, double most,
                       struct curve *curve)
{
    curve->n = 0;
    for (size_t i = 0; i < compare->n; i++) {
        const struct compare_config *config = &compare->config[i];
        if (!config->n || !same_curve(compare, config, curve->member))
            continue;
        const double granularity = config->median * cores_of(config) / (double)tasks;
        curve->point[curve->n++] =
            (struct point){granularity, cost_of(compare, config) / granularity / most};
    }
    qsort(curve->point, curve->n, sizeof *curve->point, by_cost);
}

/* The curves of a subject, of which there is room for all configurations; their number. */
static size_t make_curves(const struct compare *compare, const char *subject, struct curve *curve)
{
    const size_t tasks = tasks_of(compare, subject);
    double most = 0;
    size_t n = 0;
    for (size_t i = 0; i < compare->n && tasks; i++) {
        const struct compare_config *config = &compare->config[i];
        if (config->value[SUBJECT] != subject)
            continue;
        if (config->n)
            most = fmax(most, cost_of(compare, config) * (double)tasks /
                                  (config->median * cores_of(config)));
        if (config->value[GRAIN] == compare->list[GRAIN].item[0])
            curve[n++].member = config;
    }
    for (size_t i = 0; i < n; i++)
        make_curve(compare, tasks, most, &curve[i]);
    return n;
}

/* "1.7": the granularity with an efficiency of a half, in microseconds, on a line of logarithms
 * between two runs; "> 80", "< 0.1": it is beyond all of them; "": there are none. */
static const char *find_half(const struct curve *curve, char *text, size_t size)
{
    const struct point *point = curve->point;
    size_t i = curve->n;
    while (i > 0 && point[i - 1].efficiency >= HALF)
        i--;
    if (!curve->n)
        return "";
    if (!i || i == curve->n) {
        const double end = point[i ? i - 1 : 0].granularity;
        snprintf(text, size, "%s %.3g", i ? ">" : "<", 1e6 * end);
        return text;
    }
    const double share =
        (HALF - point[i - 1].efficiency) / (point[i].efficiency - point[i - 1].efficiency);
    const double ratio = point[i].granularity / point[i - 1].granularity;
    snprintf(text, size, "%.3g", 1e6 * point[i - 1].granularity * pow(ratio, share));
    return text;
}

/* ---- Files ---- */

/* A member's name: the scheduler, and other lists of more than one value. To be freed; NULL without
 * memory. */
static char *name_of(const struct compare *compare, const struct compare_config *member)
{
    char *name = NULL;
    size_t size;
    FILE *memory = open_memstream(&name, &size);
    if (!memory)
        return NULL;
    fputs(member->value[SCHEDULER], memory);
    for (int d = GRAIN + 1; d < compare->dimensions; d++)
        if (d != SCHEDULER && compare->list[d].n > 1)
            fprintf(memory, " %s %s", compare->name[d], member->value[d]);
    fclose(memory);
    return name;
}

static void print_points(const struct compare *compare, const struct curve *curve, FILE *out)
{
    for (size_t k = 0; k < curve->n; k++) {
        for (int d = 0; d < compare->dimensions; d++)
            if (d != GRAIN)
                fprintf(out, "%s,", curve->member->value[d]);
        fprintf(out, "%.4g,%.4f\n", 1e6 * curve->point[k].granularity, curve->point[k].efficiency);
    }
}

/* 1 without memory. */
static int plot(const struct compare *compare, size_t subject, const struct curve *curve, size_t n,
                FILE *out)
{
    char title[100];
    struct plot_line *line = calloc(n, sizeof *line);
    struct plot_point *point = calloc(n * COMPARE_MOST, sizeof *point);
    const struct plot plot = {
        title, "microseconds of a core a task", "efficiency", true, false, line, n};
    int failed = !line || !point;
    snprintf(title, sizeof title, "%s: efficiency over the granularity of tasks",
             compare->list[SUBJECT].item[subject]);
    for (size_t i = 0; i < n && !failed; i++) {
        struct plot_point *to = point + i * COMPARE_MOST;
        line[i] = (struct plot_line){name_of(compare, curve[i].member), to, curve[i].n};
        failed = !line[i].name;
        for (size_t k = 0; k < curve[i].n; k++) {
            const double y = curve[i].point[k].efficiency;
            to[k] = (struct plot_point){1e6 * curve[i].point[k].granularity, y, y, y};
        }
    }
    if (!failed)
        plot_lines(&plot, out);
    for (size_t i = 0; i < n && line; i++)
        free((char *)line[i].name);
    free(line);
    free(point);
    return failed;
}

/* Columns as wide as most names. */
static void print_head(const struct compare *compare, const struct curve *curve, size_t n,
                       FILE *out)
{
    fprintf(out, "| %-14s |", "METG(50 %), us");
    for (size_t i = 0; i < n; i++) {
        char *name = name_of(compare, curve[i].member);
        fprintf(out, " %14s |", name ? name : "");
        free(name);
    }
    fputs("\n|----------------|", out);
    for (size_t i = 0; i < n; i++)
        fputs("---------------:|", out);
    fputc('\n', out);
}

static void print_row(const struct compare *compare, size_t subject, const struct curve *curve,
                      size_t n, FILE *out)
{
    char text[40];
    fprintf(out, "| %-14s |", compare->list[SUBJECT].item[subject]);
    for (size_t i = 0; i < n; i++)
        fprintf(out, " %14s |", find_half(&curve[i], text, sizeof text));
    fputc('\n', out);
}

static int print_all(const struct compare *compare, struct curve *curve, FILE *table, FILE *plots,
                     FILE *csv)
{
    int failed = 0;
    for (int d = 0; d < compare->dimensions; d++)
        if (d != GRAIN)
            fprintf(csv, "%s,", compare->name[d]);
    fputs("granularity_us,efficiency\n", csv);
    for (size_t s = 0; s < compare->list[SUBJECT].n && !failed; s++) {
        const size_t n = make_curves(compare, compare->list[SUBJECT].item[s], curve);
        for (size_t i = 0; i < n; i++)
            print_points(compare, &curve[i], csv);
        if (!s)
            print_head(compare, curve, n, table);
        print_row(compare, s, curve, n, table);
        failed = plot(compare, s, curve, n, plots);
    }
    return failed;
}

static void print_section(const char *table, const char *plots, FILE *page)
{
    fputs("<h2>How short tasks may be</h2>\n<p>The granularity of tasks (microseconds of a core, "
          "overhead included) with which all cores do half of the most work that any member does; "
          "between two grains, on a line of logarithms.</p>\n<pre>\n",
          page);
    chart_escape(page, table);
    fprintf(page, "</pre>\n%s", plots);
    printf("\n%s", table);
}

int compare_metg(const struct compare *compare, FILE *page)
{
    struct curve *curve = calloc(compare->n, sizeof *curve);
    char *text[2] = {NULL, NULL}; /* the table, the plots */
    size_t size;
    FILE *table = open_memstream(&text[0], &size), *plots = open_memstream(&text[1], &size);
    FILE *csv = curve && table && plots ? compare_open(compare, "metg.csv") : NULL;
    int failed = !csv || print_all(compare, curve, table, plots, csv);
    failed = (csv && compare_close(compare, "metg.csv", csv)) || failed;
    if (table)
        fclose(table);
    if (plots)
        fclose(plots);
    if (!failed)
        print_section(text[0], text[1], page);
    free(text[0]);
    free(text[1]);
    free(curve);
    return failed;
}
