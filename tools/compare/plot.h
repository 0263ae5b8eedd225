#ifndef DUITE_TOOLS_COMPARE_PLOT_H
#define DUITE_TOOLS_COMPARE_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Plots as SVG elements that stand in a page. Names are any text. */

struct plot_point {
    double x, y, low, high; /* low .. high: the interval of y */
};

struct plot_line {
    const char *name;
    const struct plot_point *point; /* in the order in which they are joined */
    size_t n;
};

struct plot {
    const char *title, *x, *y;
    bool log_x; /* all x are above 0 */
    bool ideal; /* a dashed line from the origin, where y = x */
    const struct plot_line *line;
    size_t n;
};

/* Lines with intervals; y begins at 0. */
void plot_lines(const struct plot *plot, FILE *out);

/* A bar each, one below the other, from 0 to `whole`, of which `first` has another colour; with the
 * interval of the whole. */
struct plot_bar {
    const char *name;
    double first, whole, low, high;
};
void plot_bars(const char *title, const struct plot_bar *bar, size_t n, FILE *out);

/* Histograms one below the other: bin b is of 2^b to 2^(b+1) microseconds, the first one also of
 * less. Areas are one histogram, outlines another one. */
enum { PLOT_BINS = 28 };
struct plot_histogram {
    const char *name;
    double area[PLOT_BINS], outline[PLOT_BINS];
};
void plot_histograms(const char *title, const struct plot_histogram *histogram, size_t n,
                     FILE *out);

#endif
