/* The results of the runs: tables on the terminal, and compare.html, one file that needs no other
 * and no network. */
#include "tools/chart/chart.h"
#include "tools/compare/compare.h"
#include "tools/compare/program.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- Text of a page ---- */

/* Writes HTML with what `print` writes. */
static void put_printed(void (*print)(const struct compare *compare, FILE *out),
                        const struct compare *compare, FILE *out)
{
    char *text = NULL;
    size_t size;
    FILE *memory = open_memstream(&text, &size);
    if (!memory)
        return;
    print(compare, memory);
    fclose(memory);
    chart_escape(out, text);
    free(text);
}

static void print_failures(const struct compare *compare, FILE *out)
{
    const struct compare_run *run;
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
        fprintf(out, "Warning: %.*s.\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

static void print_host(const struct compare *compare, FILE *out)
{
    fputs(compare->where, out);
}

static void print_conditions(const struct compare *compare, FILE *out)
{
    fprintf(out, "%zu rounds in an order from seed %" PRIu64 ". ", compare->rounds, compare->seed);
    for (int d = 1; d < compare->dimensions; d++)
        if (!compare_varies(compare, d) && *compare->list[d].item[0])
            fprintf(out, "%s: %s. ", compare->name[d], compare->list[d].item[0]);
    for (size_t i = 0; i < compare->sets.n; i++)
        fprintf(out, "--set %s. ", compare->sets.item[i]);
    if (compare->figure)
        fprintf(out, "Figures are what --figure %s finds; the least is the fastest. ",
                compare->figure);
    else if (compare->program)
        fputs("Times are from a program's start to its end. ", out);
    else
        fputs("Times are of a step of a scene, or of a round of a graph; in bodies and outside of "
              "them, a worker. ",
              out);
    fputs("The ratio to the fastest is taken within rounds; where its interval reaches 1, the "
          "difference is within the noise, and fewer than 6 rounds are too few to tell.",
          out);
}

/* ---- The page ---- */

static const char HEAD[] =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<title>A comparison</title>\n<style>\n"
    "body { font-family: sans-serif; max-width: 1300px; margin: 1em auto; padding: 0 1em; }\n"
    "table { border-collapse: collapse; margin: 1em 0; }\n"
    "th, td { padding: 2px 10px; border-bottom: 1px solid #ddd; text-align: left; }\n"
    "td { white-space: nowrap; }\n"
    "td.number { text-align: right; }\n"
    "pre { background: #f4f4f4; padding: 0.6em; white-space: pre-wrap; }\n"
    "pre.warning, p.warning { background: #fff0d8; }\n"
    "svg { display: block; max-width: 100%; height: auto; margin: 1em 0; }\n"
    "</style>\n</head>\n<body>\n<h1>A comparison</h1>\n";

static void print_block(const char *begin, const char *end,
                        void (*print)(const struct compare *compare, FILE *out),
                        const struct compare *compare, FILE *out)
{
    fputs(begin, out);
    put_printed(print, compare, out);
    fputs(end, out);
}

static void print_top(const struct compare *compare, FILE *out)
{
    fputs(HEAD, out);
    print_block("<p>", "</p>\n", print_conditions, compare, out);
    if (compare->program)
        print_block("<pre>", "</pre>\n", program_print, compare, out);
    if (compare->wrong)
        fputs("<p class=\"warning\">Results differ between runs that should agree.</p>\n", out);
    if (*compare->warnings)
        print_block("<pre class=\"warning\">\n", "</pre>\n", print_warnings, compare, out);
    if (compare->failed)
        print_block("<p class=\"warning\">Runs failed.</p>\n<pre>\n", "</pre>\n", print_failures,
                    compare, out);
}

FILE *compare_open(const struct compare *compare, const char *name)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", compare->folder, name);
    FILE *out = fopen(path, "w");
    if (!out)
        fprintf(stderr, "duite-compare: %s: %s\n", path, strerror(errno));
    return out;
}

int compare_close(const struct compare *compare, const char *name, FILE *file)
{
    const bool whole = !ferror(file);
    if (!fclose(file) && whole)
        return 0;
    fprintf(stderr, "duite-compare: %s/%s: %s\n", compare->folder, name, strerror(errno));
    return 1;
}

static int print_page(const struct compare *compare, size_t *row)
{
    FILE *out = compare_open(compare, "compare.html");
    if (!out)
        return 1;
    print_top(compare, out);
    const int failed = compare->metg && compare_metg(compare, out);
    for (size_t s = 0; s < compare->list[SUBJECT].n; s++) {
        const char *subject = compare->list[SUBJECT].item[s];
        const size_t n = compare_sort(compare, subject, row);
        fputs("<h2>", out);
        chart_escape(out, subject);
        fputs("</h2>\n", out);
        compare_print_table(compare, row, n, true, out);
        compare_print_plots(compare, row, n, out);
        compare_print_traces(compare, s, row, n, out);
    }
    print_block("<h2>Where</h2>\n<pre>\n", "</pre>\n</body>\n</html>\n", print_host, compare, out);
    return compare_close(compare, "compare.html", out) || failed;
}

int compare_page(const struct compare *compare)
{
    size_t *row = calloc(compare->n, sizeof *row);
    for (size_t s = 0; s < compare->list[SUBJECT].n && row; s++) {
        const size_t n = compare_sort(compare, compare->list[SUBJECT].item[s], row);
        printf("\n%s\n\n", compare->list[SUBJECT].item[s]);
        compare_print_table(compare, row, n, false, stdout);
        fflush(stdout);
        compare_trace(compare, s, row, n);
    }
    const int failed = row ? print_page(compare, row) : 1;
    free(row);
    return failed;
}
