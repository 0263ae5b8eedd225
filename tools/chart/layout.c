/* The words of a chart, and the places of all its parts. Fonts differ from viewer to viewer: room
 * for words is guessed from their length. */
#include "tools/chart/layout.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

enum {
    MAX_LINES = 400, /* messages, or tasks of the critical path, as lines: more of them hide rows */
    CAPTION_FONT = 15,
    LINE = 20,    /* of words */
    ROWS = 600,   /* the height of all rows together, unless a row would be ... */
    MIN_ROW = 3,  /* ... lower, or ... */
    MAX_ROW = 26, /* ... higher */
    AXIS = 40
};

/* ---- Words ---- */

__attribute__((format(printf, 5, 6))) static void
word_add(struct chart *chart, int size, enum chart_sign sign, uint32_t rgb, const char *format, ...)
{
    struct chart_word *word = &chart->word[chart->n_words++];
    va_list arguments;
    *word = (struct chart_word){.size = size, .sign = sign, .rgb = rgb};
    va_start(arguments, format);
    vsnprintf(word->text, sizeof word->text, format, arguments);
    va_end(arguments);
}

static const char *seconds_text(char *text, size_t size, double seconds)
{
    if (seconds >= 1)
        snprintf(text, size, "%.4g s", seconds);
    else if (seconds >= 1e-3)
        snprintf(text, size, "%.4g ms", 1e3 * seconds);
    else
        snprintf(text, size, "%.4g µs", 1e6 * seconds);
    return text;
}

static void caption_add(struct chart *chart)
{
    const struct chart_model *model = &chart->model;
    const double span = model->to - model->from;
    char shown[32], all[32];
    const bool whole = model->from <= model->first && model->to >= model->last;
    seconds_text(shown, sizeof shown, span);
    seconds_text(all, sizeof all, model->last - model->first);
    word_add(chart, CAPTION_FONT, SIGN_NONE, 0,
             "%s%s%s on %" PRIu32 " rank%s with %" PRIu32 " worker%s", shown, whole ? "" : " of ",
             whole ? "" : all, model->run->n_ranks, model->run->n_ranks > 1 ? "s" : "",
             model->n_workers, model->n_workers > 1 ? "s" : "");
    word_add(chart, CAPTION_FONT, SIGN_NONE, 0, "busy %.1f %%",
             100 * model->busy / (span * model->n_workers));
    if (model->path.known)
        word_add(chart, CAPTION_FONT, SIGN_NONE, 0, "critical path %s, %.1f %% of the time",
                 seconds_text(shown, sizeof shown, model->path_seconds),
                 100 * model->path_seconds / span);
    else
        word_add(chart, CAPTION_FONT, SIGN_NONE, 0, "critical path unknown");
    word_add(chart, CAPTION_FONT, SIGN_NONE, 0, "limited by: %s", model->limit);
    for (int i = 0; i < chart->n_words; i++) {
        const size_t n = strlen(chart->title);
        snprintf(chart->title + n, sizeof chart->title - n, "%s%s", i ? "; " : "",
                 chart->word[i].text);
    }
}

static uint32_t most_messages(const struct chart *chart)
{
    uint32_t most = 0;
    for (int c = 0; c < chart->columns; c++)
        most = chart->model.traffic.count[c] > most ? chart->model.traffic.count[c] : most;
    return most;
}

static void legend_add(struct chart *chart)
{
    const struct chart_model *model = &chart->model;
    const double all = (model->to - model->from) * model->n_workers;
    double seen = 0;
    char column[32];
    for (uint32_t s = 0; s < model->n_slots; s++) {
        seen += model->slot[s].seconds;
        word_add(chart, CHART_FONT, SIGN_BOX, model->slot[s].rgb, "%s %.1f %%", model->slot[s].name,
                 100 * model->slot[s].seconds / all);
    }
    word_add(chart, CHART_FONT, SIGN_BOX, 0xFFFFFF, "idle or between tasks %.1f %%",
             100 * fmax(all - seen, 0) / all);
    if (chart->has_path_line)
        word_add(chart, CHART_FONT, SIGN_PATH, 0, "critical path");
    if (chart->has_lines)
        word_add(chart, CHART_FONT, SIGN_MESSAGE, 0, "message");
    else if (chart->strip_top)
        word_add(chart, CHART_FONT, SIGN_NONE, 0, "messages: at most %" PRIu32 " in %s",
                 most_messages(chart),
                 seconds_text(column, sizeof column, (model->to - model->from) / chart->columns));
}

/* Lines of words from y on, by the room that they take at most. Returns the base line of the last.
 */
static int words_place(struct chart *chart, int first, int n, int y)
{
    int x = CHART_MARGIN;
    for (int i = first; i < first + n; i++) {
        struct chart_word *word = &chart->word[i];
        const int sign = word->sign ? CHART_FONT + 6 : 0;
        const int room = sign + (int)(0.6 * word->size * (double)strlen(word->text));
        if (x > CHART_MARGIN && x + room > chart->width - CHART_MARGIN) {
            x = CHART_MARGIN;
            y += LINE;
        }
        word->x = x + sign;
        word->y = y;
        x += room + 16;
    }
    return y;
}

/* ---- Rows ---- */

int chart_row_top(const struct chart *chart, uint32_t row)
{
    const struct chart_model *model = &chart->model;
    const uint32_t rank = model->rank_of[row < model->n_rows ? row : model->n_rows - 1];
    return chart->rows_top + (int)row * chart->row_height + (int)rank * chart->rank_gap;
}

double chart_x(const struct chart *chart, double seconds)
{
    const struct chart_model *model = &chart->model;
    return CHART_LEFT + chart->columns * (seconds - model->from) / (model->to - model->from);
}

/* Chooses the gap between ranks (none if there are many) and returns the sum of gaps. */
static int gaps_choose(struct chart *chart)
{
    const uint32_t n = chart->model.run->n_ranks;
    chart->rank_gap = n <= 16 ? 6 : n <= 64 ? 2 : 0;
    return chart->rank_gap * (int)(n - 1);
}

/* y: below the words. */
static int rows_place(struct chart *chart, int y)
{
    struct chart_model *model = &chart->model;
    const int strip = CHART_STRIP + CHART_APART;
    const int gaps = gaps_choose(chart);
    chart->path_top = y;
    chart->rows_top = y + (model->path.known ? strip : 0);
    const int below = (chart->strip_top ? strip : 0) + AXIS;
    const int room = chart->height ? chart->height - chart->rows_top - gaps - below : ROWS;
    if (room < MIN_ROW)
        return base_error(DUITE_E_ARGUMENT,
                          "a chart of %d pixels width takes %d of height here, not %d",
                          chart->width, chart->rows_top + gaps + below + MIN_ROW, chart->height);
    int code = chart_model_fill(model, (uint32_t)chart->columns, (uint32_t)(room / MIN_ROW));
    if (code)
        return code;
    if (model->n_rows < model->run->n_ranks)
        chart->rank_gap = 0;
    chart->row_height = room / (int)model->n_rows;
    if (!chart->height && chart->row_height > MAX_ROW)
        chart->row_height = MAX_ROW;
    y = chart_row_top(chart, model->n_rows) + CHART_APART;
    chart->strip_top = chart->strip_top ? y : 0;
    chart->axis_top = y + (chart->strip_top ? strip : 0);
    chart->height = chart->height ? chart->height : chart->axis_top + AXIS;
    return DUITE_OK;
}

/* ---- All of it ---- */

static int options_check(const struct chart_options *options)
{
    if (options->width >= CHART_MIN_WIDTH && options->width <= CHART_MAX_SIZE &&
        (!options->height ||
         (options->height >= CHART_MIN_HEIGHT && options->height <= CHART_MAX_SIZE)))
        return DUITE_OK;
    return base_error(DUITE_E_ARGUMENT, "a chart has %dx%d to %dx%d pixels, not %dx%d",
                      CHART_MIN_WIDTH, CHART_MIN_HEIGHT, CHART_MAX_SIZE, CHART_MAX_SIZE,
                      options->width, options->height);
}

static size_t path_steps(const struct chart_model *model)
{
    size_t n = 0;
    for (size_t i = 0; i < model->path.n; i++)
        n += model->path.step[i].end > model->from && model->path.step[i].begin < model->to;
    return n;
}

static int chart_lay_out(struct chart *chart, const struct trace_run *run,
                         const struct chart_options *options)
{
    chart->width = options->width;
    chart->height = options->height;
    chart->columns = options->width - CHART_LEFT - CHART_RIGHT;
    int code = chart_model_make(&chart->model, run, options, (uint32_t)chart->columns, MAX_LINES);
    if (code)
        return code;
    chart->has_lines = chart->model.traffic.messages.n > 0;
    chart->has_path_line = chart->model.path.known && path_steps(&chart->model) <= MAX_LINES;
    chart->strip_top = chart->model.traffic.n > MAX_LINES;
    caption_add(chart);
    const int n_caption = chart->n_words;
    legend_add(chart);
    int y = words_place(chart, 0, n_caption, CHART_MARGIN + CAPTION_FONT);
    y = words_place(chart, n_caption, chart->n_words - n_caption, y + LINE + 4);
    return rows_place(chart, y + CHART_APART + 4);
}

int chart_new(struct chart **chart, const struct trace_run *run,
              const struct chart_options *options)
{
    *chart = NULL;
    int code = options_check(options);
    if (code)
        return code;
    *chart = base_alloc_zero(sizeof **chart);
    if (!*chart)
        return base_no_memory("a chart");
    code = chart_lay_out(*chart, run, options);
    if (code) {
        chart_free(*chart);
        *chart = NULL;
    }
    return code;
}

int chart_width(const struct chart *chart)
{
    return chart->width;
}

int chart_height(const struct chart *chart)
{
    return chart->height;
}

const char *chart_title(const struct chart *chart)
{
    return chart->title;
}

void chart_free(struct chart *chart)
{
    if (chart)
        chart_model_free(&chart->model);
    base_free(chart);
}
