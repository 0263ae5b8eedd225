#ifndef DUITE_TOOLS_CHART_CANVAS_H
#define DUITE_TOOLS_CHART_CANVAS_H

#include "tools/chart/chart.h"

#include <stdint.h>

/* Charts are drawn on a canvas: pixels from the upper left corner, colours 0xRRGGBB. Failures are
 * reported at the end of the picture. */

enum chart_anchor { CHART_START, CHART_MIDDLE, CHART_END };

struct chart_canvas {
    void *context;
    void (*rectangle)(void *context, int x, int y, int width, int height, uint32_t rgb);
    /* n columns of one pixel from x on, so many pixels high above `base`. */
    void (*columns)(void *context, int x, int base, int n, const int *height, uint32_t rgb);
    void (*line)(void *context, const double from[2], const double to[2], double width,
                 uint32_t rgb);
    /* x: of the anchor; y: of the base line; size: pixels of the font; UTF-8. */
    void (*text)(void *context, double x, double y, enum chart_anchor anchor, int size,
                 const char *text);
};

/* A chart that is laid out, and not drawn yet. */
struct chart;

/* `chart` is to be freed; NULL after an error. Errors as of chart_write_svg. */
int chart_new(struct chart **chart, const struct trace_run *run,
              const struct chart_options *options);
int chart_width(const struct chart *chart);
int chart_height(const struct chart *chart);
/* A summary of the chart in words. */
const char *chart_title(const struct chart *chart);
/* Errors: memory. */
int chart_draw(const struct chart *chart, const struct chart_canvas *canvas);
/* NULL is fine. */
void chart_free(struct chart *chart);

#endif
