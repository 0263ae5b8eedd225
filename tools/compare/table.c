/* Members in words, and the table of them, whose first columns are the dimensions that vary. */
#include "tools/chart/chart.h"
#include "tools/compare/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void compare_print_member(const struct compare *compare, const struct compare_config *config,
                          FILE *out)
{
    fputs(config->value[SUBJECT], out);
    for (int d = 1; d < compare->dimensions; d++)
        if (compare_varies(compare, d))
            fprintf(out, ", %s %s", compare->name[d], config->value[d]);
}

void compare_print_label(const struct compare *compare, const struct compare_config *config,
                         unsigned without, FILE *out)
{
    static const char *const before[COMPARE_DIMENSIONS] = {
        [THREADS] = "t", [RANKS] = "r", [GRAIN] = "g"};
    bool first = true;
    for (int d = compare->dimensions - 1; d > SUBJECT; d--) {
        if (!compare_varies(compare, d) || without >> d & 1)
            continue;
        fprintf(out, "%s%s%s%s", first ? "" : " ",
                d >= COMPARE_DIMENSIONS ? compare->name[d]
                : before[d]             ? before[d]
                                        : "",
                d >= COMPARE_DIMENSIONS ? "=" : "", config->value[d]);
        first = false;
    }
    if (first)
        fputs("all", out);
}

/* ---- Order ---- */

static const struct compare *sorted_of;

static int by_median(const void *a, const void *b)
{
    const struct compare_config *x = &sorted_of->config[*(const size_t *)a],
                                *y = &sorted_of->config[*(const size_t *)b];
    if (!x->n || !y->n)
        return x->n ? -1 : y->n != 0;
    return x->median < y->median ? -1 : x->median > y->median;
}

size_t compare_sort(const struct compare *compare, const char *subject, size_t *row)
{
    size_t n = 0;
    for (size_t i = 0; i < compare->n; i++)
        if (compare->config[i].value[SUBJECT] == subject)
            row[n++] = i;
    sorted_of = compare;
    qsort(row, n, sizeof *row, by_median);
    return n;
}

/* ---- The table ---- */

enum { CELL = 60, NUMBER = 10 /* the width of a column of numbers */ };

struct table {
    FILE *out;
    bool html;
    const char *tag; /* th or td */
};

/* width: of a column of Markdown; < 0: its text begins on the left. */
static void put_cell(const struct table *table, int width, const char *text)
{
    if (!table->html) {
        fprintf(table->out, " %*s |", width, text);
        return;
    }
    fprintf(table->out, "<%s%s>", table->tag, width > 0 ? " class=\"number\"" : "");
    chart_escape(table->out, text);
    fprintf(table->out, "</%s>", table->tag);
}

static void put_interval(const struct table *table, const char *format, double scale,
                         const double number[3])
{
    char text[3][CELL] = {""}, whole[4 * CELL] = "";
    for (int i = 0; i < 3; i++)
        snprintf(text[i], CELL, format, scale * number[i]);
    if (isfinite(number[0]))
        snprintf(whole, sizeof whole, "%s [%s .. %s]", text[0], text[1], text[2]);
    put_cell(table, -34, whole);
}

static void put_number(const struct table *table, double number)
{
    char text[CELL] = "";
    if (isfinite(number))
        snprintf(text, sizeof text, "%.4g", number);
    put_cell(table, NUMBER, text);
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

static bool has_speedups(const struct compare *compare)
{
    return compare_varies(compare, RANKS) || compare_varies(compare, THREADS);
}

/* A program that leaves no report does not say. */
static bool has_bodies(const struct compare *compare)
{
    for (size_t i = 0; i < compare->n; i++)
        if (compare->config[i].n && isfinite(compare->config[i].bodies))
            return true;
    return false;
}

enum { LEAST_WIDTH = 10 };

/* The width of a dimension's column: of its name or its longest value. */
static int width_of(const struct compare *compare, int dimension)
{
    size_t most = strlen(compare->name[dimension]);
    for (size_t i = 0; i < compare->n; i++) {
        const size_t length = strlen(compare->config[i].value[dimension]);
        most = length > most ? length : most;
    }
    return most > LEAST_WIDTH ? (int)most : LEAST_WIDTH;
}

static void begin_row(const struct table *table)
{
    fputs(table->html ? "<tr>" : "|", table->out);
}

static void end_row(const struct table *table)
{
    fputs(table->html ? "</tr>\n" : "\n", table->out);
}

static void print_head(const struct compare *compare, struct table *table)
{
    char time[CELL];
    table->tag = "th";
    begin_row(table);
    for (int d = 0; d < compare->dimensions; d++)
        if (compare_varies(compare, d))
            put_cell(table, -width_of(compare, d), compare->name[d]);
    snprintf(time, sizeof time, "%s [95 %% of the median]", compare_unit(compare));
    put_cell(table, -34, time);
    if (has_bodies(compare)) {
        put_cell(table, -NUMBER, "in bodies");
        put_cell(table, -NUMBER, "outside");
    }
    put_cell(table, -34, "times the fastest");
    if (has_speedups(compare)) {
        put_cell(table, -NUMBER, "speed-up");
        put_cell(table, -NUMBER, "efficiency");
    }
    put_cell(table, -16, "");
    end_row(table);
}

static void print_rule(const struct compare *compare, FILE *out)
{
    fputs("|", out);
    for (int d = 0; d < compare->dimensions; d++)
        if (compare_varies(compare, d)) {
            for (int i = width_of(compare, d) + 2; i; i--)
                fputc('-', out);
            fputc('|', out);
        }
    fputs("------------------------------------|", out);
    fputs(has_bodies(compare) ? "-----------:|-----------:|" : "", out);
    fputs("------------------------------------|", out);
    fputs(has_speedups(compare) ? "-----------:|-----------:|------------------|\n"
                                : "------------------|\n",
          out);
}

static void print_row(const struct compare *compare, const struct compare_config *config,
                      const struct table *table)
{
    begin_row(table);
    for (int d = 0; d < compare->dimensions; d++)
        if (compare_varies(compare, d))
            put_cell(table, -width_of(compare, d), config->value[d]);
    put_interval(table, "%.4g", compare_scale(compare),
                 (const double[]){config->median, config->low, config->high});
    if (has_bodies(compare)) {
        put_number(table, 1e3 * config->bodies);
        put_number(table, 1e3 * config->outside);
    }
    /* none if the fastest failed in each of its rounds */
    put_interval(
        table, "%.3f", 1,
        (const double[]){config->n ? config->ratio : NAN, config->ratio_low, config->ratio_high});
    if (has_speedups(compare)) {
        put_number(table, config->speedup);
        put_number(table, config->efficiency);
    }
    put_cell(table, -16, verdict(compare, config));
    end_row(table);
}

void compare_print_table(const struct compare *compare, const size_t *row, size_t n, bool html,
                         FILE *out)
{
    struct table table = {out, html, NULL};
    if (html)
        fputs("<table>\n", out);
    print_head(compare, &table);
    if (!html)
        print_rule(compare, out);
    table.tag = "td";
    for (size_t i = 0; i < n; i++)
        print_row(compare, &compare->config[row[i]], &table);
    if (html)
        fputs("</table>\n", out);
}
