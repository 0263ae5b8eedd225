/* Draws a chart that is laid out, lower layers first. */
#include "tools/chart/layout.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <inttypes.h>
#include <math.h>

enum { WHITE = 0xFFFFFF, GRID = 0xE6E6E6, FRAME = 0x999999, MESSAGE = 0x444444, BLACK = 0 };
static const double PATH_WIDTH = 2, CASING_WIDTH = 4.5, MESSAGE_WIDTH = 0.6;

struct drawing {
    const struct chart *chart;
    const struct chart_canvas *canvas;
    int *level; /* slots x columns: the height of this slot and all before it */
};

static void draw_rectangle(const struct drawing *d, int x, int y, int width, int height,
                           uint32_t rgb)
{
    d->canvas->rectangle(d->canvas->context, x, y, width, height, rgb);
}

static void draw_line(const struct drawing *d, double x0, double y0, double x1, double y1,
                      double width, uint32_t rgb)
{
    d->canvas->line(d->canvas->context, (const double[]){x0, y0}, (const double[]){x1, y1}, width,
                    rgb);
}

static void draw_text(const struct drawing *d, double x, double y, enum chart_anchor anchor,
                      const char *text)
{
    d->canvas->text(d->canvas->context, x, y, anchor, CHART_FONT, text);
}

/* ---- Words ---- */

static void draw_sign(const struct drawing *d, const struct chart_word *word)
{
    const int x = word->x - CHART_FONT - 6, y = word->y - CHART_FONT + 2;
    if (word->sign == SIGN_BOX) {
        draw_rectangle(d, x, y, CHART_FONT, CHART_FONT, FRAME);
        draw_rectangle(d, x + 1, y + 1, CHART_FONT - 2, CHART_FONT - 2, word->rgb);
    }
    if (word->sign == SIGN_PATH)
        draw_line(d, x, y + 6, x + CHART_FONT, y + 6, PATH_WIDTH, BLACK);
    if (word->sign == SIGN_MESSAGE)
        draw_line(d, x, y + 11, x + CHART_FONT, y + 1, MESSAGE_WIDTH, MESSAGE);
}

static void draw_words(const struct drawing *d)
{
    for (int i = 0; i < d->chart->n_words; i++) {
        const struct chart_word *word = &d->chart->word[i];
        draw_sign(d, word);
        d->canvas->text(d->canvas->context, word->x, word->y, CHART_START, word->size, word->text);
    }
}

/* ---- The axis ---- */

/* 1, 2 or 5 times a power of ten. */
static double tick_choose(double least)
{
    const double power = pow(10, floor(log10(least)));
    const double factor = least / power;
    return power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10);
}

static void draw_axis(const struct drawing *d)
{
    enum { APART = 90 }; /* pixels between two numbers, at least */
    const struct chart *chart = d->chart;
    const struct chart_model *model = &chart->model;
    const double unit = model->to >= 1 ? 1 : model->to >= 1e-3 ? 1e-3 : 1e-6;
    const double tick =
        tick_choose((model->to - model->from) / unit * APART / (chart->columns + 1));
    const int digits = tick >= 1 ? 0 : (int)ceil(-log10(tick) - 1e-9);
    char text[64];
    for (double i = ceil(model->from / unit / tick); i * tick * unit <= model->to; i++) {
        const double x = chart_x(chart, i * tick * unit);
        draw_line(d, x, chart->path_top, x, chart->axis_top + 4, 1, GRID);
        snprintf(text, sizeof text, "%.*f", digits, i * tick + 0.0);
        draw_text(d, x, chart->axis_top + 16, CHART_MIDDLE, text);
    }
    snprintf(text, sizeof text, "time since the first event, %s",
             unit >= 1      ? "s"
             : unit >= 1e-3 ? "ms"
                            : "µs");
    draw_text(d, CHART_LEFT + chart->columns / 2.0, chart->axis_top + 32, CHART_MIDDLE, text);
}

/* ---- Rows ---- */

static int level_of(double seconds, double all, int height)
{
    return (int)lround(height * fmin(fmax(seconds / all, 0), 1));
}

static void draw_shares(const struct drawing *d, uint32_t row, int base, int height)
{
    const struct chart_model *model = &d->chart->model;
    const int n = d->chart->columns;
    for (int c = 0; c < n; c++) {
        const double *seconds = chart_shares_of(&model->shares, row, (uint32_t)c);
        double sum = 0;
        for (uint32_t s = 0; s < model->n_slots; s++) {
            sum += fmax(seconds[s], 0);
            d->level[s * (uint32_t)n + (uint32_t)c] =
                level_of(sum, model->shares.column * model->workers[row], height);
        }
    }
    for (uint32_t s = model->n_slots; s-- > 0;) {
        const int *level = d->level + s * (uint32_t)n;
        bool seen = false;
        for (int c = 0; c < n && !seen; c++)
            seen = level[c] > (s ? level[c - n] : 0);
        if (seen)
            d->canvas->columns(d->canvas->context, CHART_LEFT, base, n, level, model->slot[s].rgb);
    }
}

static void draw_row_name(const struct drawing *d, uint32_t row)
{
    const struct chart_model *model = &d->chart->model;
    const int top = chart_row_top(d->chart, row), height = d->chart->row_height;
    char name[32];
    uint32_t first = 0;
    while (model->row_of[first] != row)
        first++;
    const uint32_t worker = first - trace_first_worker(model->run, model->rank_of[row]);
    if (model->n_rows < model->run->n_ranks || height < 10)
        return;
    snprintf(name, sizeof name, "%" PRIu32, worker);
    if (model->workers[row] > 1)
        snprintf(name, sizeof name, "%" PRIu32 "-%" PRIu32, worker,
                 worker + model->workers[row] - 1);
    draw_text(d, CHART_LEFT - 8, top + height / 2.0 + 4, CHART_END, name);
}

/* A rank is named where there is room since the name before it. */
static void draw_ranks(const struct drawing *d)
{
    const struct chart_model *model = &d->chart->model;
    int named = -CHART_FONT;
    for (uint32_t row = 0, next; row < model->n_rows; row = next) {
        char name[32];
        for (next = row + 1; next < model->n_rows && model->rank_of[next] == model->rank_of[row];)
            next++;
        const int top = chart_row_top(d->chart, row);
        const int end = chart_row_top(d->chart, next - 1) + d->chart->row_height;
        draw_rectangle(d, CHART_LEFT - 3, top, 2, end - top, FRAME);
        if (top < named + CHART_FONT)
            continue;
        named = top;
        snprintf(name, sizeof name, "rank %" PRIu32, model->rank_of[row]);
        draw_text(d, CHART_MARGIN, (top + end) / 2.0 + 4, CHART_START, name);
    }
}

static void draw_rows(const struct drawing *d)
{
    const struct chart *chart = d->chart;
    const int height = chart->row_height;
    for (uint32_t row = 0; row < chart->model.n_rows; row++) {
        const int base = chart_row_top(chart, row) + height;
        draw_shares(d, row, base, height > 8 ? height - 2 : height);
        if (height > 8)
            draw_line(d, CHART_LEFT, base - 0.5, CHART_LEFT + chart->columns, base - 0.5, 1, GRID);
        draw_row_name(d, row);
    }
    draw_ranks(d);
}

/* ---- Lines between rows ---- */

static double middle_of(const struct chart *chart, uint32_t worker)
{
    return chart_row_top(chart, chart->model.row_of[worker]) + chart->row_height / 2.0;
}

/* A line between two moments, cut to the part shown. */
static void draw_span(const struct drawing *d, double from, double from_y, double to, double to_y,
                      double width, uint32_t rgb)
{
    const struct chart *chart = d->chart;
    const double begin = fmax(from, chart->model.from), end = fmin(to, chart->model.to);
    const double slope = to > from ? (to_y - from_y) / (to - from) : 0;
    if (!(from <= chart->model.to && to >= chart->model.from))
        return;
    draw_line(d, chart_x(chart, begin), from_y + slope * (begin - from), chart_x(chart, end),
              to > from ? to_y - slope * (to - end) : to_y, width, rgb);
}

static void draw_messages(const struct drawing *d)
{
    const struct trace_messages *messages = &d->chart->model.traffic.messages;
    for (size_t i = 0; i < messages->n; i++) {
        const struct trace_message *message = &messages->message[i];
        draw_span(d, message->sent, middle_of(d->chart, message->from), message->received,
                  middle_of(d->chart, message->to), MESSAGE_WIDTH, MESSAGE);
    }
}

static void draw_path_line(const struct drawing *d, double width, uint32_t rgb)
{
    const struct chart_path *path = &d->chart->model.path;
    for (size_t i = 0; i < path->n; i++) {
        const struct chart_step *step = &path->step[i];
        const double y = middle_of(d->chart, step->worker);
        if (i)
            draw_span(d, step[-1].end, middle_of(d->chart, step[-1].worker), step->begin, y, width,
                      rgb);
        draw_span(d, step->begin, y, step->end, y, width, rgb);
    }
}

static void draw_path(const struct drawing *d)
{
    const struct chart *chart = d->chart;
    const int base = chart->path_top + CHART_STRIP;
    if (!chart->model.path.known)
        return;
    draw_shares(d, chart->model.n_rows, base, CHART_STRIP);
    draw_line(d, CHART_LEFT, base + 0.5, CHART_LEFT + chart->columns, base + 0.5, 1, FRAME);
    draw_text(d, CHART_MARGIN, base - 5, CHART_START, "critical path");
    if (chart->has_path_line) {
        draw_path_line(d, CASING_WIDTH, WHITE);
        draw_path_line(d, PATH_WIDTH, BLACK);
    }
}

static void draw_strip(const struct drawing *d)
{
    const struct chart *chart = d->chart;
    const uint32_t *count = chart->model.traffic.count;
    uint32_t most = 1;
    for (int c = 0; c < chart->columns; c++)
        most = count[c] > most ? count[c] : most;
    for (int c = 0; c < chart->columns; c++)
        d->level[c] = level_of(count[c], most, CHART_STRIP);
    d->canvas->columns(d->canvas->context, CHART_LEFT, chart->strip_top + CHART_STRIP,
                       chart->columns, d->level, MESSAGE);
    draw_text(d, CHART_MARGIN, chart->strip_top + CHART_STRIP - 5, CHART_START, "messages");
}

int chart_draw(const struct chart *chart, const struct chart_canvas *canvas)
{
    struct drawing d = {.chart = chart, .canvas = canvas};
    d.level = base_alloc((size_t)chart->columns * chart->model.n_slots * sizeof *d.level);
    if (!d.level)
        return base_no_memory("a chart");
    draw_rectangle(&d, 0, 0, chart->width, chart->height, WHITE);
    draw_words(&d);
    draw_axis(&d);
    draw_rows(&d);
    draw_messages(&d);
    draw_path(&d);
    if (chart->strip_top)
        draw_strip(&d);
    base_free(d.level);
    return DUITE_OK;
}
