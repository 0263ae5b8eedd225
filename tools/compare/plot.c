/* Plots are drawn in pixels from the upper left corner, with room for names on the left of bars and
 * on the right of lines. */
#include "tools/compare/plot.h"

#include "tools/chart/chart.h"

#include <math.h>
#include <string.h>

/* Colours that the colour-blind tell apart, after Okabe and Ito. */
static const char *const COLOURS[] = {"#0072B2", "#E69F00", "#009E73", "#CC79A7",
                                      "#56B4E9", "#D55E00", "#F0E442", "#444444"};
enum { N_COLOURS = sizeof COLOURS / sizeof *COLOURS };
enum { WIDTH = 900, LEFT = 70, TOP = 34, BOTTOM = 44, ROW = 20, LETTER = 8, MOST_NAME = 420 };

static void put_words(FILE *out, double x, double y, const char *anchor, const char *text)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
    chart_escape(out, text);
    fputs("</text>\n", out);
}

static void put_number(FILE *out, double x, double y, const char *anchor, double number)
{
    char text[40];
    snprintf(text, sizeof text, "%.4g", number);
    put_words(out, x, y, anchor, text);
}

static void put_line(FILE *out, double x0, double y0, double x1, double y1, const char *style)
{
    fprintf(out, "<path d=\"M%.1f %.1fL%.1f %.1f\" %s/>\n", x0, y0, x1, y1, style);
}

static void put_box(FILE *out, double x, double y, double width, double height, const char *colour)
{
    fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", x, y,
            width, height, colour);
}

static void begin_plot(FILE *out, const char *title, int width, int height)
{
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
            "height=\"%d\" font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>",
            width, height, width, height);
    chart_escape(out, title);
    fputs("</title>\n<g font-size=\"14\">", out);
    put_words(out, LEFT, 18, "start", title);
    fputs("</g>\n", out);
}

/* ---- Axes ---- */

#define GRID  "stroke=\"#e2e2e2\""
#define FRAME "stroke=\"#888\""

struct axis {
    double from, to;
    double times;      /* of logarithms: from one tick to the next; 0: it is linear */
    double begin, end; /* pixels */
};

static double place_on(const struct axis *axis, double value)
{
    if (!(axis->to > axis->from))
        return (axis->begin + axis->end) / 2;
    const double share = axis->times > 0 ? log(value / axis->from) / log(axis->to / axis->from)
                                         : (value - axis->from) / (axis->to - axis->from);
    return axis->begin + share * (axis->end - axis->begin);
}

/* About five round numbers up to `most`. */
static double step_of(double most)
{
    const double raw = most / 5, power = pow(10, floor(log10(raw)));
    const double times = raw / power;
    return power * (times > 5 ? 10 : times > 2 ? 5 : times > 1 ? 2 : 1);
}

/* From 0 to a round number. */
static struct axis axis_to(double most, double begin, double end)
{
    const double step = step_of(most > 0 ? most : 1);
    return (struct axis){0, step * ceil((most > 0 ? most : 1) / step - 1e-9), 0, begin, end};
}

/* Between whole numbers, if these are no more than some doublings apart; else powers of ten. */
static struct axis axis_of_logs(double least, double most, double begin, double end)
{
    enum { MOST_TIMES = 1024 };
    if (least >= 1 && !(floor(least) < least) && most / least <= MOST_TIMES)
        return (struct axis){least, most, 2, begin, end};
    return (struct axis){pow(10, floor(log10(least))), pow(10, ceil(log10(most))), 10, begin, end};
}

static double next_tick(const struct axis *axis, double tick)
{
    return axis->times > 0 ? axis->times * tick : tick + step_of(axis->to - axis->from);
}

static void put_axis_x(FILE *out, const struct axis *axis, double top, double bottom,
                       const char *name)
{
    for (double tick = axis->from; tick <= axis->to * (1 + 1e-9); tick = next_tick(axis, tick)) {
        const double x = place_on(axis, tick);
        put_line(out, x, top, x, bottom, GRID);
        put_number(out, x, bottom + 16, "middle", tick);
        if (!(axis->to > axis->from))
            break;
    }
    put_line(out, axis->begin, bottom, axis->end, bottom, FRAME);
    put_words(out, (axis->begin + axis->end) / 2, bottom + 34, "middle", name);
}

static void put_axis_y(FILE *out, const struct axis *axis, double left, double right,
                       const char *name)
{
    for (double tick = axis->from; tick <= axis->to * (1 + 1e-9); tick = next_tick(axis, tick)) {
        const double y = place_on(axis, tick);
        put_line(out, left, y, right, y, GRID);
        put_number(out, left - 6, y + 4, "end", tick);
    }
    fprintf(out, "<g transform=\"rotate(-90 14 %.1f)\">", (axis->begin + axis->end) / 2);
    put_words(out, 14, (axis->begin + axis->end) / 2, "middle", name);
    fputs("</g>\n", out);
}

/* ---- Lines ---- */

/* From the axis' end to a line's name. */
enum { BEFORE_NAME = 46 };

static void put_one_line(FILE *out, const struct axis *x, const struct axis *y,
                         const struct plot_line *line, size_t number)
{
    char style[120];
    snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"2\" fill=\"none\"%s",
             COLOURS[number % N_COLOURS],
             number / N_COLOURS % 2 ? " stroke-dasharray=\"5 3\"" : "");
    for (size_t i = 0; i < line->n; i++) {
        const struct plot_point *point = &line->point[i];
        const double at = place_on(x, point->x), height = place_on(y, point->y);
        if (i)
            put_line(out, place_on(x, point[-1].x), place_on(y, point[-1].y), at, height, style);
        put_line(out, at, place_on(y, point->low), at, place_on(y, point->high), style);
        fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", at, height,
                COLOURS[number % N_COLOURS]);
    }
    const double row = TOP + 10 + ROW * (double)number, left = x->end + 16;
    put_line(out, left, row - 4, left + 24, row - 4, style);
    put_words(out, x->end + BEFORE_NAME, row, "start", line->name);
}

void plot_lines(const struct plot *plot, FILE *out)
{
    enum { HEIGHT = 320, LEGEND = 270 };
    const int legend = TOP + ROW * (int)plot->n, height = legend > HEIGHT ? legend : HEIGHT;
    double least_x = INFINITY, most_x = 0, most_y = 0, room = LEGEND;
    for (size_t k = 0; k < plot->n; k++) {
        room = fmax(room, BEFORE_NAME + LETTER * (double)strlen(plot->line[k].name));
        for (size_t i = 0; i < plot->line[k].n; i++) {
            const struct plot_point *point = &plot->line[k].point[i];
            least_x = fmin(least_x, point->x);
            most_x = fmax(most_x, point->x);
            most_y = fmax(most_y, fmax(point->y, point->high));
        }
    }
    if (!(most_x > 0))
        return;
    struct axis x = axis_to(most_x, LEFT, WIDTH - LEGEND);
    if (plot->log_x)
        x = axis_of_logs(least_x, most_x, LEFT + 20, WIDTH - LEGEND - 20);
    const struct axis y = axis_to(plot->ideal ? fmax(most_y, 1) : most_y, HEIGHT - BOTTOM, TOP);
    begin_plot(out, plot->title, WIDTH - LEGEND + (int)room, height);
    put_axis_x(out, &x, TOP, HEIGHT - BOTTOM, plot->x);
    put_axis_y(out, &y, LEFT, WIDTH - LEGEND, plot->y);
    const double ideal = fmin(most_x, y.to);
    if (plot->ideal)
        put_line(out, place_on(&x, 0), place_on(&y, 0), place_on(&x, ideal), place_on(&y, ideal),
                 "stroke=\"#888\" stroke-dasharray=\"3 3\"");
    for (size_t k = 0; k < plot->n; k++)
        put_one_line(out, &x, &y, &plot->line[k], k);
    fputs("</svg>\n", out);
}

/* ---- Bars ---- */

static double room_for(const char *name, double room)
{
    return fmin(fmax(room, LETTER * (double)strlen(name) + 16), MOST_NAME);
}

void plot_bars(const char *title, const struct plot_bar *bar, size_t n, FILE *out)
{
    double most = 0, left = LEFT;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fmax(bar[i].whole, bar[i].high));
        left = room_for(bar[i].name, left);
    }
    const double bottom = TOP + ROW * (double)n + 6;
    const struct axis x = axis_to(most, left, WIDTH - LEFT);
    begin_plot(out, title, WIDTH, (int)bottom + 26);
    put_axis_x(out, &x, TOP, bottom, "");
    for (size_t i = 0; i < n; i++) {
        const double y = TOP + 4 + ROW * (double)i, middle = y + (ROW - 6) / 2.0;
        const double first = place_on(&x, bar[i].first), whole = place_on(&x, bar[i].whole);
        put_words(out, left - 8, y + 11, "end", bar[i].name);
        put_box(out, left, y, first - left, ROW - 6, COLOURS[0]);
        put_box(out, first, y, whole - first, ROW - 6, COLOURS[4]);
        put_line(out, place_on(&x, bar[i].low), middle, place_on(&x, bar[i].high), middle,
                 "stroke=\"#000\"");
        put_number(out, fmax(whole, place_on(&x, bar[i].high)) + 6, y + 11, "start", bar[i].whole);
    }
    fputs("</svg>\n", out);
}

/* ---- Histograms ---- */

static const char *time_of_bin(int bin, char *text, size_t size)
{
    const double us = ldexp(1, bin);
    snprintf(text, size, "%.3g %s",
             us < 1e3   ? us
             : us < 1e6 ? us / 1e3
                        : us / 1e6,
             us < 1e3   ? "µs"
             : us < 1e6 ? "ms"
                        : "s");
    return text;
}

/* From the axis' first bin to its last. */
static void put_histogram(FILE *out, const struct axis *x, double base, double height,
                          const struct plot_histogram *histogram)
{
    const double *area = histogram->area, *outline = histogram->outline;
    double most = 1;
    for (int bin = 0; bin < PLOT_BINS; bin++)
        most = fmax(most, fmax(area[bin], outline[bin]));
    const struct axis y = {0, most, 0, base, base - height};
    for (int bin = (int)x->from; bin < (int)x->to; bin++)
        put_box(out, place_on(x, bin) + 1, place_on(&y, area[bin]),
                place_on(x, bin + 1) - place_on(x, bin) - 2, base - place_on(&y, area[bin]),
                COLOURS[0]);
    fprintf(out, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" d=\"M%.1f %.1f",
            COLOURS[5], x->begin, base);
    for (int bin = (int)x->from; bin < (int)x->to; bin++)
        fprintf(out, "V%.1fH%.1f", place_on(&y, outline[bin]), place_on(x, bin + 1));
    fprintf(out, "V%.1f\"/>\n", base);
    put_words(out, x->begin - 8, base - 8, "end", histogram->name);
    put_line(out, x->begin, base, x->end, base, FRAME);
}

/* The bins that any has, and room for their names on the left. */
static struct axis axis_of_bins(const struct plot_histogram *histogram, size_t n)
{
    int first = PLOT_BINS - 1, last = 0;
    double left = LEFT;
    for (size_t i = 0; i < n; i++) {
        left = room_for(histogram[i].name, left);
        for (int bin = 0; bin < PLOT_BINS; bin++)
            if (histogram[i].area[bin] > 0 || histogram[i].outline[bin] > 0) {
                first = bin < first ? bin : first;
                last = bin > last ? bin : last;
            }
    }
    return (struct axis){first > 0 ? first - 1 : 0, last < PLOT_BINS - 2 ? last + 2 : PLOT_BINS, 0,
                         left, WIDTH - LEFT};
}

void plot_histograms(const char *title, const struct plot_histogram *histogram, size_t n, FILE *out)
{
    enum { HEIGHT = 46 };
    char text[40];
    const struct axis x = axis_of_bins(histogram, n);
    const double bottom = TOP + HEIGHT * (double)n;
    begin_plot(out, title, WIDTH, (int)bottom + 26);
    for (int bin = (int)x.from; bin <= (int)x.to; bin++) {
        put_line(out, place_on(&x, bin), TOP, place_on(&x, bin), bottom, GRID);
        if (x.to - x.from < 15 || bin % 2)
            put_words(out, place_on(&x, bin), bottom + 16, "middle",
                      time_of_bin(bin, text, sizeof text));
    }
    for (size_t i = 0; i < n; i++)
        put_histogram(out, &x, TOP + HEIGHT * (double)(i + 1), HEIGHT - 6, &histogram[i]);
    fputs("</svg>\n", out);
}
