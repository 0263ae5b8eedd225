#ifndef DUITE_TOOLS_CHART_LAYOUT_H
#define DUITE_TOOLS_CHART_LAYOUT_H

#include "tools/chart/canvas.h"
#include "tools/chart/model.h"

/* The places of things in a chart, in pixels. From the top: the caption, the legend, the critical
 * path, rows, messages, the axis. To the left of the time: names. */

enum {
    CHART_MARGIN = 12,
    CHART_LEFT = 100, /* of column 0 */
    CHART_RIGHT = 24, /* of the last column */
    CHART_FONT = 12,
    CHART_STRIP = 18, /* the height of the critical path and of messages */
    CHART_APART = 8   /* between these and the rows */
};

/* The sign before a word of the legend. */
enum chart_sign { SIGN_NONE, SIGN_BOX, SIGN_PATH, SIGN_MESSAGE };

struct chart_word {
    char text[96];
    int x, y, size; /* y: of the base line */
    enum chart_sign sign;
    uint32_t rgb; /* of SIGN_BOX */
};
enum { CHART_WORDS = CHART_MAX_SLOTS + 8 };

struct chart {
    struct chart_model model;
    struct chart_word word[CHART_WORDS];
    int n_words;
    char title[256];
    int width, height, columns;
    int path_top, rows_top, row_height, rank_gap, strip_top, axis_top; /* strip_top 0: none */
    bool has_lines, has_path_line; /* messages; the critical path through the rows */
};

/* The upper edge of a row; below the last one: n_rows. */
int chart_row_top(const struct chart *chart, uint32_t row);
/* The place of a moment. */
double chart_x(const struct chart *chart, double seconds);

#endif
