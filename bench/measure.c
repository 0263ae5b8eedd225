/* Rounds and their sums. Cases share nothing. */
#include "bench/measure.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct measure_series *measure_series(struct measure *measure, struct subject_shape shape,
                                      const char *command, ...)
{
    if (measure->n_series == MEASURE_SERIES) {
        measure->full = true;
        return &measure->series[0];
    }
    struct measure_series *series = &measure->series[measure->n_series++];
    va_list list;
    va_start(list, command);
    vsnprintf(series->command, sizeof series->command, command, list);
    va_end(list);
    series->shape = shape;
    series->work = 1;
    return series;
}

__attribute__((format(printf, 4, 0))) static struct measure_metric *
add(struct measure *measure, const char *unit,
    double (*value)(const struct measure_metric *, size_t), const char *name, va_list list)
{
    if (measure->n_metrics == MEASURE_METRICS) {
        measure->full = true;
        return &measure->metric[0];
    }
    struct measure_metric *metric = &measure->metric[measure->n_metrics++];
    vsnprintf(metric->name, sizeof metric->name, name, list);
    metric->unit = unit;
    metric->value = value;
    metric->n = 1;
    metric->scale = 1;
    return metric;
}

struct measure_metric *measure_metric(struct measure *measure, const char *unit,
                                      double (*value)(const struct measure_metric *, size_t),
                                      const char *name, ...)
{
    va_list list;
    va_start(list, name);
    struct measure_metric *metric = add(measure, unit, value, name, list);
    va_end(list);
    return metric;
}

static double sample(const struct measure_series *series, size_t round)
{
    double least = series->sample[round];
    for (series = series->other; series; series = series->other)
        least = fmin(least, series->sample[round]);
    return least;
}

static double scaled(const struct measure_metric *metric, size_t round)
{
    return metric->scale * sample(metric->of, round);
}

static double ratio(const struct measure_metric *metric, size_t round)
{
    const struct measure_series *of = metric->of, *against = metric->against;
    return sample(of, round) / of->work / (sample(against, round) / against->work);
}

void measure_value(struct measure *measure, const struct measure_series *of, double scale,
                   const char *unit, const char *name, ...)
{
    va_list list;
    va_start(list, name);
    struct measure_metric *metric = add(measure, unit, scaled, name, list);
    va_end(list);
    metric->of = of;
    metric->scale = scale;
}

void measure_ratio(struct measure *measure, const struct measure_series *of,
                   const struct measure_series *against, const char *name, ...)
{
    va_list list;
    va_start(list, name);
    struct measure_metric *metric = add(measure, "x", ratio, name, list);
    va_end(list);
    metric->of = of;
    metric->against = against;
}

static bool is_ratio(const struct measure_metric *metric, const char *kind)
{
    return metric->value == ratio && !strcmp(metric->against->shape.kind, kind);
}

/* The largest median of the ratios before it, which are known by now. */
static double worst(const struct measure_metric *metric, size_t round)
{
    const struct measure_metric *largest = NULL;
    for (const struct measure_metric *one = metric - metric->n; one < metric; one++)
        if (is_ratio(one, metric->against->shape.kind) &&
            (!largest || one->median > largest->median))
            largest = one;
    return largest->value(largest, round);
}

void measure_worst(struct measure *measure, const char *kind, const char *name)
{
    const size_t n = measure->n_metrics;
    struct measure_metric *metric = measure_metric(measure, "x", worst, "%s", name);
    metric->n = n;
    for (size_t i = 0; i < n; i++)
        if (is_ratio(&measure->metric[i], kind)) {
            metric->of = measure->metric[i].of;
            metric->against = measure->metric[i].against;
        }
}

void measure_targets(struct measure *measure, const struct measure_target *targets)
{
    for (size_t i = 0; i < measure->n_metrics; i++)
        for (const struct measure_target *target = targets; target->metric; target++)
            if (!strcmp(target->metric, measure->metric[i].name))
                measure->metric[i].target = target;
}

enum measure_verdict measure_verdict(const struct measure_metric *metric)
{
    const struct measure_target *target = metric->target;
    if (!isfinite(metric->median))
        return MEASURE_UNKNOWN;
    return (target->least ? metric->median >= target->bound : metric->median <= target->bound)
               ? MEASURE_PASS
               : MEASURE_MISS;
}

/* Steele, Lea & Flood, Fast splittable pseudorandom number generators (2014). */
uint64_t measure_random(uint64_t *seed, uint64_t n)
{
    uint64_t z = *seed += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return (z ^ (z >> 31)) % n;
}

/* ---- Rounds ---- */

struct team {
    struct subject *subject[MEASURE_SERIES]; /* of series i, the one that started it; or NULL */
    size_t owner[MEASURE_SERIES];            /* which series started the subject of series i */
    size_t order[MEASURE_SERIES];            /* in which the series run */
};

/* The order of a round: a new one, or the last one from its end. */
static void set_order(struct team *team, size_t n, bool reverse, uint64_t *seed)
{
    size_t *order = team->order;
    for (size_t i = 0; i < n && !reverse; i++) {
        size_t j = measure_random(seed, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
    for (size_t i = 0; i < n / 2 && reverse; i++) {
        size_t other = order[n - 1 - i];
        order[n - 1 - i] = order[i];
        order[i] = other;
    }
}

static int start_all(struct measure *measure, struct team *team,
                     void (*settings)(const char *kind, const char *text))
{
    for (size_t i = 0; i < measure->n_series; i++) {
        const struct measure_series *series = &measure->series[i];
        team->owner[i] = i;
        if (series->fresh || !series->sample)
            continue;
        for (size_t j = 0; j < i && team->owner[i] == i; j++)
            if (team->subject[j] && subject_same(measure->series[j].shape, series->shape))
                team->owner[i] = j;
        if (team->owner[i] < i)
            continue;
        team->subject[i] = subject_start(series->shape);
        if (!team->subject[i])
            return 1;
        settings(series->shape.kind, subject_settings(team->subject[i]));
    }
    return 0;
}

static int ask(struct measure_series *series, struct subject *subject, const char *name,
               double *value)
{
    char why[400];
    struct subject *fresh = NULL;
    if (series->fresh)
        subject = fresh = subject_start(series->shape);
    int code = !subject || subject_ask(subject, series->command, value, why, sizeof why);
    if (code && subject)
        fprintf(stderr, "duite-bench: %s, %s (%s): %s\n", name, series->shape.kind, series->command,
                why);
    return subject_stop(fresh) || code;
}

/* One run of every series; `round` is negative if the samples are left out. */
static int run_round(struct measure *measure, const char *name, const struct team *team, long round)
{
    int code = 0;
    for (size_t i = 0; i < measure->n_series && !code; i++) {
        struct measure_series *series = &measure->series[team->order[i]];
        double value = 0;
        if (!series->sample || (series->fresh && round < 0))
            continue;
        code = ask(series, team->subject[team->owner[team->order[i]]], name, &value);
        if (round >= 0)
            series->sample[round] = value;
    }
    return code;
}

/* ---- Metrics ---- */

double measure_sum(const struct measure_metric *metric, size_t round)
{
    double sum = 0;
    for (size_t i = 0; i < metric->n; i++)
        sum += metric->of[i].sample[round];
    return sum;
}

double measure_geometric(const struct measure_metric *metric, size_t round)
{
    double sum = 0;
    for (size_t i = 0; i < metric->n; i++)
        sum += log(metric->of[i].sample[round] / metric->against[i].sample[round]);
    return exp(sum / (double)metric->n);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The quantile q of n sorted values, linear between two. */
static double quantile(const double *value, size_t n, double q)
{
    double place = q * (double)(n - 1);
    size_t i = (size_t)place;
    return i + 1 < n ? value[i] + (place - (double)i) * (value[i + 1] - value[i]) : value[n - 1];
}

static void conclude(struct measure_metric *metric, size_t rounds, double *value)
{
    size_t n = 0;
    metric->median = metric->low = metric->high = NAN;
    metric->rounds = rounds;
    metric->missing = subject_missing(metric->of->shape.kind);
    if (!metric->missing && metric->against)
        metric->missing = subject_missing(metric->against->shape.kind);
    for (size_t i = 0; i < rounds && !metric->missing; i++) {
        double one = metric->value(metric, i);
        if (isfinite(one))
            value[n++] = one;
    }
    if (!n || 2 * n < rounds)
        return;
    qsort(value, n, sizeof *value, by_size);
    metric->median = quantile(value, n, 0.5);
    metric->low = quantile(value, n, 0.25);
    metric->high = quantile(value, n, 0.75);
}

static int make_room(struct measure *measure, size_t rounds)
{
    for (size_t i = 0; i < measure->n_series; i++) {
        struct measure_series *series = &measure->series[i];
        if (subject_missing(series->shape.kind))
            continue;
        series->sample = calloc(rounds, sizeof *series->sample);
        if (!series->sample)
            return 1;
    }
    return 0;
}

int measure_run(struct measure *measure, const char *name, size_t rounds, uint64_t *seed,
                void (*settings)(const char *kind, const char *text))
{
    struct team team = {0};
    double *value = calloc(rounds, sizeof *value);
    int code = !value || make_room(measure, rounds) || measure->full;
    if (code)
        fprintf(stderr, "duite-bench: %s: %s\n", name,
                measure->full ? "more is planned than there is room for" : "out of memory");
    if (!code)
        code = start_all(measure, &team, settings);
    for (long round = measure->cold ? 0 : -1; round < (long)rounds && !code; round++) {
        set_order(&team, measure->n_series, round > 0 && round % 2, seed);
        code = run_round(measure, name, &team, round);
    }
    for (size_t i = 0; i < measure->n_series; i++)
        code |= subject_stop(team.subject[i]);
    for (size_t i = 0; i < measure->n_metrics && !code; i++)
        conclude(&measure->metric[i], rounds, value);
    free(value);
    return code;
}

void measure_free(struct measure *measure)
{
    for (size_t i = 0; i < measure->n_series; i++)
        free(measure->series[i].sample);
    *measure = (struct measure){0};
}
