#ifndef DUITE_TOOLS_CHART_CHART_H
#define DUITE_TOOLS_CHART_CHART_H

#include <stdbool.h>
#include <stdio.h>

/* The Gantt chart of a traced run: a row a worker, ranks one below the other, kernels in colours.
 * The amount drawn depends on the size alone, not on the number of tasks: each column of pixels has
 * the shares of its time. */

struct trace_run;

enum { CHART_WIDTH = 1280, CHART_MIN_WIDTH = 400, CHART_MIN_HEIGHT = 200, CHART_MAX_SIZE = 4096 };

struct chart_options {
    double from, to;   /* s since the first event, on the clock of rank 0; infinite: all there is */
    bool shares;       /* they are shares of the run, 0 .. 1 */
    int width, height; /* pixels; height 0: as the rows need */
};

/* All of the run, CHART_WIDTH wide. */
struct chart_options chart_options_default(void);

/* FROM:TO in seconds or, both with a % sign, in percent of the run, either of which may be left
 * out; WIDTHxHEIGHT. False: the text is neither; the options are as before then. */
bool chart_window_parse(const char *text, struct chart_options *options);
bool chart_size_parse(const char *text, struct chart_options *options);

/* Write the chart to `file`, which stays open. Errors: memory; DUITE_E_ARGUMENT for a size out of
 * range and for a window without anything of the run; of PNG also for a build without cairo. The
 * caller sees by ferror whether the file took all of it. */
int chart_write_svg(const struct trace_run *run, const struct chart_options *options, FILE *file);
int chart_write_png(const struct trace_run *run, const struct chart_options *options, FILE *file);

/* Writes text as HTML and SVG have it between tags. */
void chart_escape(FILE *file, const char *text);

#endif
