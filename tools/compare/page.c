/* The results of the runs: the same table on the terminal, in summary.csv and in compare.md, with
 * plots. A table has the dimensions that vary as its first columns. */
#include "tools/compare/compare.h"
#include "tools/compare/program.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

FILE *compare_open(const struct compare *compare, const char *name)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", compare->folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        fprintf(stderr, "duite-compare: %s: %s\n", path, strerror(errno));
    return file;
}

int compare_close(const struct compare *compare, const char *name, FILE *file)
{
    bool whole = !ferror(file);
    if (fclose(file))
        whole = false;
    if (!whole)
        fprintf(stderr, "duite-compare: %s/%s: %s\n", compare->folder, name, strerror(errno));
    return !whole;
}

static bool varies(const struct compare *compare, int dimension)
{
    return dimension != SUBJECT && compare->list[dimension].n > 1;
}

static const char *verdict(const struct compare *compare, const struct compare_config *config)
{
    const struct compare_run *run;
    if (!config->n)
        return compare_failures(compare, config, &run) ? "failed" : "not run";
    if (config->fastest)
        return "fastest";
    if (config->few)
        return "too few rounds";
    return config->noise ? "within the noise" : "slower";
}

/* The configurations of a subject from the fastest on. */
static const struct compare *sorted_of;

static int by_median(const void *a, const void *b)
{
    const struct compare_config *x = &sorted_of->config[*(const size_t *)a],
                                *y = &sorted_of->config[*(const size_t *)b];
    if (!x->n || !y->n)
        return x->n ? -1 : y->n != 0;
    return x->median < y->median ? -1 : x->median > y->median;
}

static size_t sort(const struct compare *compare, const char *subject, size_t *row)
{
    size_t n = 0;
    for (size_t i = 0; i < compare->n; i++)
        if (compare->config[i].value[SUBJECT] == subject)
            row[n++] = i;
    sorted_of = compare;
    qsort(row, n, sizeof *row, by_median);
    return n;
}

/* ---- Tables ---- */

static void print_head(const struct compare *compare, FILE *out)
{
    char time[40];
    fputs("|", out);
    for (int d = 0; d < compare->dimensions; d++)
        if (varies(compare, d))
            fprintf(out, " %-10s |", compare->name[d]);
    snprintf(time, sizeof time, "%s [95 %% of the median]", compare_unit(compare));
    fprintf(out, " %-28s | %-9s | %-9s | %-25s | %-16s |\n|", time, "in bodies", "outside",
            "times the fastest", "");
    for (int d = 0; d < compare->dimensions; d++)
        if (varies(compare, d))
            fputs("------------|", out);
    fputs("------------------------------|----------:|----------:|---------------------------|-----"
          "---"
          "----------|\n",
          out);
}

static void print_row(const struct compare *compare, const struct compare_config *config, FILE *out)
{
    const double scale = compare_scale(compare);
    char time[60] = "", ratio[60] = "", bodies[20] = "", outside[20] = "";
    fputs("|", out);
    for (int d = 0; d < compare->dimensions; d++)
        if (varies(compare, d))
            fprintf(out, " %-10s |", config->value[d]);
    if (config->n)
        snprintf(time, sizeof time, "%.4g [%.4g .. %.4g]", scale * config->median,
                 scale * config->low, scale * config->high);
    if (config->n && isfinite(config->bodies)) {
        snprintf(bodies, sizeof bodies, "%.4g", 1e3 * config->bodies);
        snprintf(outside, sizeof outside, "%.4g", 1e3 * config->outside);
    }
    if (config->n && isfinite(config->ratio)) /* not if the fastest failed in each of its rounds */
        snprintf(ratio, sizeof ratio, "%.3f [%.3f .. %.3f]", config->ratio, config->ratio_low,
                 config->ratio_high);
    fprintf(out, " %-28s | %9s | %9s | %-25s | %-16s |\n", time, bodies, outside, ratio,
            verdict(compare, config));
}

static void print_table(const struct compare *compare, const char *subject, size_t *row, FILE *out)
{
    size_t n = sort(compare, subject, row);
    print_head(compare, out);
    for (size_t i = 0; i < n; i++)
        print_row(compare, &compare->config[row[i]], out);
}

static void print_summary(const struct compare *compare, FILE *out)
{
    compare_describe(out, "# ");
    for (int d = 0; d < compare->dimensions; d++)
        fprintf(out, "%s,", compare->name[d]);
    fprintf(out,
            "runs,%s,low,high,seconds_in_bodies,seconds_outside,ratio,ratio_low,ratio_high,"
            "verdict\n",
            compare->figure ? "figure" : "seconds");
    for (size_t i = 0; i < compare->n; i++) {
        const struct compare_config *c = &compare->config[i];
        for (int d = 0; d < compare->dimensions; d++)
            fprintf(out, "%s,", c->value[d]);
        const double figure[] = {c->median,  c->low,   c->high,      c->bodies,
                                 c->outside, c->ratio, c->ratio_low, c->ratio_high};
        fprintf(out, "%zu,", c->n);
        for (size_t k = 0; k < sizeof figure / sizeof *figure; k++)
            if (c->n && isfinite(figure[k]))
                fprintf(out, "%.9g,", figure[k]);
            else
                fputc(',', out);
        fprintf(out, "%s\n", verdict(compare, c));
    }
}

/* ---- Failures ---- */

void compare_print_member(const struct compare *compare, const struct compare_config *config,
                          FILE *out)
{
    fputs(config->value[SUBJECT], out);
    for (int d = 1; d < compare->dimensions; d++)
        if (varies(compare, d))
            fprintf(out, ", %s %s", compare->name[d], config->value[d]);
}

static void print_failures(const struct compare *compare, FILE *out)
{
    const struct compare_run *run;
    if (compare->failed)
        fprintf(out, "\n**Runs failed.**\n\n");
    for (size_t i = 0; i < compare->n; i++) {
        const size_t n = compare_failures(compare, &compare->config[i], &run);
        if (!n)
            continue;
        fputs("- ", out);
        compare_print_member(compare, &compare->config[i], out);
        fprintf(out, ": %zu of %zu runs; %s%s\n", n, compare->rounds, n > 1 ? "the first: " : "",
                run->why ? run->why : "out of memory");
    }
}

static void print_warnings(const struct compare *compare, FILE *out)
{
    for (const char *line = compare->warnings; *line;) {
        const size_t length = strcspn(line, "\n");
        fprintf(out, "\n**Warning:** %.*s.\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

/* ---- Plots ---- */

static void print_label(const struct compare *compare, const struct compare_config *config,
                        int without, FILE *out)
{
    bool first = true;
    for (int d = compare->dimensions - 1; d > SUBJECT; d--)
        if (varies(compare, d) && d != without) {
            fprintf(out, "%s%s%s%s", first ? "" : " ",
                    d >= COMPARE_DIMENSIONS ? compare->name[d]
                    : d == THREADS          ? "t"
                    : d == RANKS            ? "r"
                    : d == GRAIN            ? "g"
                                            : "",
                    d >= COMPARE_DIMENSIONS ? "=" : "", config->value[d]);
            first = false;
        }
    if (first)
        fputs("time", out);
}

/* Not if all members of the subject failed. */
static bool has_figures(const struct compare *compare, size_t number)
{
    for (size_t i = 0; i < compare->n; i++)
        if (compare->config[i].n &&
            compare->config[i].value[SUBJECT] == compare->list[SUBJECT].item[number])
            return true;
    return false;
}

/* The bars: what is in bodies, what is outside, and the interval of the whole. Both parts of a bar
 * are 0 or more, and it is as high as the median: medians need not add up. */
static void plot_bars(const struct compare *compare, size_t number, const size_t *row, size_t n,
                      FILE *out)
{
    const double scale = compare_scale(compare);
    if (!has_figures(compare, number))
        return;
    fprintf(out, "$bars%zu << EOD\n", number);
    for (size_t i = 0; i < n; i++) {
        const struct compare_config *c = &compare->config[row[i]];
        if (!c->n)
            continue;
        fputc('"', out);
        print_label(compare, c, -1, out);
        const double bodies = isfinite(c->bodies) ? fmin(c->bodies, c->median) : 0;
        fprintf(out, "\" %g %g %g %g %g\n", scale * bodies, scale * (c->median - bodies),
                scale * c->median, scale * c->low, scale * c->high);
    }
    fprintf(
        out,
        "EOD\nset output 'bars%zu.png'\nset title '%s' noenhanced\nset style data histograms\n"
        "set style histogram rowstacked\nset style fill solid 0.8 border -1\nset boxwidth 0.7\n"
        "set xtics rotate by -45 noenhanced\nset ylabel '%s'\nset yrange [0:*]\nset key top left\n"
        "unset logscale\n"
        "plot $bars%zu using 2:xtic(1) %s, '' using 3 %s, '' using "
        "0:4:5:6 with yerrorbars lc 'black' pt 0 title '95 %% of the median'\n",
        number, compare->list[SUBJECT].item[number], compare_unit(compare), number,
        compare->program ? "notitle" : "title 'in bodies'",
        compare->program ? "notitle" : "title 'outside'");
}

/* Lines over a dimension of numbers, one for each of what else varies. */
static void plot_lines(const struct compare *compare, size_t number, int dimension, FILE *out)
{
    const char *subject = compare->list[SUBJECT].item[number];
    const double scale = compare_scale(compare);
    size_t series = 0;
    fprintf(out,
            "reset\nset output '%s%zu.png'\nset title '%s' noenhanced\nset logscale x 2\n"
            "set xlabel '%s'\nset ylabel '%s'\nset yrange [0:*]\nset key outside noenhanced\n"
            "set offsets graph 0.05, graph 0.05, 0, 0\n",
            compare->name[dimension], number, subject, compare->name[dimension],
            compare_unit(compare));
    for (size_t i = 0; i < compare->n; i++) {
        const struct compare_config *c = &compare->config[i];
        if (c->value[SUBJECT] != subject || c->value[dimension] != compare->list[dimension].item[0])
            continue;
        fprintf(out, "$line%zu << EOD\n", series++);
        for (size_t k = 0; k < compare->n; k++) {
            const struct compare_config *o = &compare->config[k];
            bool same = o->n > 0;
            for (int d = 0; d < compare->dimensions; d++)
                same = same && (d == dimension || o->value[d] == c->value[d]);
            if (same)
                fprintf(out, "%s %g %g %g\n", o->value[dimension], scale * o->median,
                        scale * o->low, scale * o->high);
        }
        fputs("EOD\n", out);
    }
    series = 0;
    for (size_t i = 0; i < compare->n; i++) {
        const struct compare_config *c = &compare->config[i];
        if (c->value[SUBJECT] != subject || c->value[dimension] != compare->list[dimension].item[0])
            continue;
        fprintf(out, "%s $line%zu using 1:2:3:4 with yerrorlines lw 2 title '",
                series ? "," : "plot", series);
        print_label(compare, c, dimension, out);
        fputs("'", out);
        series++;
    }
    fputs("\nreset\n", out);
}

static bool is_line(const struct compare *compare, int dimension)
{
    return (dimension == GRAIN || dimension == RANKS || dimension == THREADS) &&
           varies(compare, dimension);
}

bool compare_draw(const struct compare *compare, const char *name)
{
    char command[PATH_MAX + 100];
    if (system("command -v gnuplot > /dev/null 2>&1")) {
        printf("no plots: gnuplot is missing (package gnuplot-nox); %s is what it would draw\n",
               name);
        return false;
    }
    snprintf(command, sizeof command, "cd '%s' && gnuplot %s", compare->folder, name);
    return !system(command);
}

/* Writes plots.gp and has gnuplot draw it. Returns true if there are plots. */
static bool plot(const struct compare *compare, size_t *row)
{
    FILE *out = compare_open(compare, "plots.gp");
    if (!out)
        return false;
    fputs("set terminal pngcairo size 1100,600\n", out);
    for (size_t s = 0; s < compare->list[SUBJECT].n; s++) {
        size_t n = sort(compare, compare->list[SUBJECT].item[s], row);
        plot_bars(compare, s, row, n, out);
        for (int d = 0; d < compare->dimensions; d++)
            if (is_line(compare, d) && has_figures(compare, s))
                plot_lines(compare, s, d, out);
    }
    return !compare_close(compare, "plots.gp", out) && compare_draw(compare, "plots.gp");
}

/* ---- The page ---- */

static void print_rest(const struct compare *compare, FILE *out)
{
    fprintf(out, "%zu rounds in an order from seed %" PRIu64 ". ", compare->rounds, compare->seed);
    for (int d = 1; d < compare->dimensions; d++)
        if (!varies(compare, d) && *compare->list[d].item[0])
            fprintf(out, "%s: %s. ", compare->name[d], compare->list[d].item[0]);
    for (size_t i = 0; i < compare->sets.n; i++)
        fprintf(out, "--set %s. ", compare->sets.item[i]);
    if (compare->figure)
        fprintf(out, "Figures are what `%s` finds in the output; the least is the fastest. ",
                compare->figure);
    else if (compare->program)
        fputs("Times are from a program's start to its end. ", out);
    else
        fputs("Times are of a step of a scene, or of a round of a graph; in bodies and outside of "
              "them, a worker. ",
              out);
    fputs("The ratio to the fastest is taken within rounds; where its interval reaches 1, the "
          "difference is within the noise, and fewer than 6 rounds are too few to tell.\n",
          out);
    if (compare->program) {
        fputs("\n    ", out);
        program_print(compare, out);
        fputc('\n', out);
    }
    if (compare->wrong)
        fputs("\n**Results differ between runs that should agree.**\n", out);
    print_warnings(compare, out);
    print_failures(compare, out);
}

static int print_page(const struct compare *compare, size_t *row, bool plots)
{
    FILE *out = compare_open(compare, "compare.md");
    if (!out)
        return 1;
    fputs("# A comparison\n\n", out);
    print_rest(compare, out);
    for (size_t s = 0; s < compare->list[SUBJECT].n; s++) {
        fprintf(out, "\n## %s\n\n", compare->list[SUBJECT].item[s]);
        print_table(compare, compare->list[SUBJECT].item[s], row, out);
        if (!has_figures(compare, s))
            continue;
        if (plots)
            fprintf(out, "\n![bars](bars%zu.png)\n", s);
        for (int d = 0; d < compare->dimensions && plots; d++)
            if (is_line(compare, d))
                fprintf(out, "\n![%s](%s%zu.png)\n", compare->name[d], compare->name[d], s);
    }
    if (!plots)
        fputs("\nThere are no plots: gnuplot (package gnuplot-nox) was missing or failed.\n", out);
    fputs("\n## Where\n\n", out);
    compare_describe(out, "- ");
    return compare_close(compare, "compare.md", out);
}

int compare_page(const struct compare *compare)
{
    size_t *row = calloc(compare->n, sizeof *row);
    FILE *out = row ? compare_open(compare, "summary.csv") : NULL;
    int failed = !out;
    if (out) {
        print_summary(compare, out);
        failed = compare_close(compare, "summary.csv", out);
    }
    for (size_t s = 0; s < compare->list[SUBJECT].n && row; s++) {
        printf("\n%s\n\n", compare->list[SUBJECT].item[s]);
        print_table(compare, compare->list[SUBJECT].item[s], row, stdout);
    }
    if (row) {
        bool plots = plot(compare, row);
        failed = print_page(compare, row, plots) || failed;
    }
    free(row);
    return failed;
}
