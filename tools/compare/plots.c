/* Plots of a subject: bars of all members; and over each list of numbers a line for each of what
 * else varies. */
#include "tools/compare/compare.h"
#include "tools/compare/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* To be freed; NULL without memory, which leaves a plot out. */
static char *label_of(const struct compare *compare, const struct compare_config *config,
                      unsigned without)
{
    char *label = NULL;
    size_t size;
    FILE *memory = open_memstream(&label, &size);
    if (!memory)
        return NULL;
    compare_print_label(compare, config, without, memory);
    fclose(memory);
    return label;
}

/* Medians need not add up: both parts of a bar are 0 or more, and it is as high as the median. */
static void print_bars(const struct compare *compare, const size_t *row, size_t n, FILE *out)
{
    const double scale = compare_scale(compare);
    char title[100];
    struct plot_bar *bar = calloc(n, sizeof *bar);
    size_t bars = 0;
    bool bodies = false;
    for (size_t i = 0; i < n && bar; i++) {
        const struct compare_config *c = &compare->config[row[i]];
        char *name = c->n ? label_of(compare, c, 0) : NULL;
        if (!name)
            continue;
        bodies = bodies || isfinite(c->bodies);
        const double first = isfinite(c->bodies) ? fmin(c->bodies, c->median) : 0;
        bar[bars++] = (struct plot_bar){name, scale * first, scale * c->median, scale * c->low,
                                        scale * c->high};
    }
    snprintf(title, sizeof title, "%s, with 95 %% of the median%s", compare_unit(compare),
             bodies ? "; dark: in bodies of tasks" : "");
    if (bars)
        plot_bars(title, bar, bars, out);
    for (size_t i = 0; i < bars; i++)
        free((char *)bar[i].name);
    free(bar);
}

/* ---- Lines ---- */

/* A kind of lines: what they show, over what, and which dimensions are one line. */
struct kind {
    const char *title, *x, *y;
    bool log_x, ideal;
    unsigned along; /* bits of dimensions */
    double (*x_of)(const struct compare_config *config, int dimension);
    int dimension;
    double (*y_of)(const struct compare_config *config, double scale);
};

static double value_of(const struct compare_config *config, int dimension)
{
    return strtod(config->value[dimension], NULL);
}
static double cores_of(const struct compare_config *config, int dimension)
{
    (void)dimension;
    return config->cores;
}
static double median_of(const struct compare_config *config, double scale)
{
    return scale * config->median;
}
static double speedup_of(const struct compare_config *config, double scale)
{
    (void)scale;
    return config->speedup;
}
static double efficiency_of(const struct compare_config *config, double scale)
{
    (void)scale;
    return config->efficiency;
}

static int by_x(const void *a, const void *b)
{
    const struct plot_point *p = a, *q = b;
    return p->x < q->x ? -1 : p->x > q->x;
}

static bool is_of_line(const struct compare *compare, const struct kind *kind,
                       const struct compare_config *a, const struct compare_config *b)
{
    for (int d = 0; d < compare->dimensions; d++)
        if (!(kind->along >> d & 1) && a->value[d] != b->value[d])
            return false;
    return true;
}

/* The line with the member row[first], if that is the first one on it. */
static bool fill_line(const struct compare *compare, const struct kind *kind, const size_t *row,
                      size_t n, size_t first, struct plot_point *point, struct plot_line *line)
{
    const double scale = compare_scale(compare);
    const struct compare_config *of = &compare->config[row[first]];
    line->n = 0;
    line->point = point;
    for (size_t i = 0; i < n; i++) {
        const struct compare_config *c = &compare->config[row[i]];
        if (!c->n || !is_of_line(compare, kind, of, c))
            continue;
        if (i < first)
            return false;
        const double y = kind->y_of(c, scale);
        const bool interval = kind->y_of == median_of;
        if (isfinite(y))
            point[line->n++] =
                (struct plot_point){kind->x_of(c, kind->dimension), y,
                                    interval ? scale * c->low : y, interval ? scale * c->high : y};
    }
    qsort(point, line->n, sizeof *point, by_x);
    return line->n > 0;
}

static void print_lines(const struct compare *compare, const struct kind *kind, const size_t *row,
                        size_t n, FILE *out)
{
    struct plot plot = {kind->title, kind->x, kind->y, kind->log_x, kind->ideal, NULL, 0};
    struct plot_line *line = calloc(n, sizeof *line);
    struct plot_point *point = calloc(n, sizeof *point); /* each member is on one line */
    size_t used = 0;
    for (size_t i = 0; i < n && line && point; i++) {
        struct plot_line *next = &line[plot.n];
        if (!compare->config[row[i]].n || !fill_line(compare, kind, row, n, i, point + used, next))
            continue;
        next->name = label_of(compare, &compare->config[row[i]], kind->along);
        used += next->n;
        plot.n += next->name != NULL;
    }
    plot.line = line;
    if (plot.n)
        plot_lines(&plot, out);
    for (size_t i = 0; i < plot.n; i++)
        free((char *)line[i].name);
    free(line);
    free(point);
}

/* Returns true if all values of a list that varies are numbers above 0. */
static bool is_of_numbers(const struct compare *compare, int dimension)
{
    char *end;
    const struct compare_list *list = &compare->list[dimension];
    for (size_t i = 0; i < list->n; i++)
        if (!(strtod(list->item[i], &end) > 0) || *end)
            return false;
    return compare_varies(compare, dimension);
}

void compare_print_plots(const struct compare *compare, const size_t *row, size_t n, FILE *out)
{
    const unsigned varied =
        compare_varies(compare, THREADS) ? 1u << THREADS : 1u << RANKS; /* a line's */
    print_bars(compare, row, n, out);
    for (int d = SUBJECT + 1; d < compare->dimensions; d++) {
        char title[100];
        snprintf(title, sizeof title, "%s over %s", compare_unit(compare), compare->name[d]);
        if (is_of_numbers(compare, d))
            print_lines(compare,
                        &(struct kind){title, compare->name[d], compare_unit(compare), true, false,
                                       1u << d, value_of, d, median_of},
                        row, n, out);
    }
    if (!compare_varies(compare, RANKS) && !compare_varies(compare, THREADS))
        return;
    print_lines(compare,
                &(struct kind){"Speed-up", "cores", "speed-up", false, true, varied, cores_of, 0,
                               speedup_of},
                row, n, out);
    print_lines(compare,
                &(struct kind){"Efficiency", "cores", "efficiency", false, false, varied, cores_of,
                               0, efficiency_of},
                row, n, out);
}
