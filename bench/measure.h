#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#include "bench/subject.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A case's measurements: series, each a command to a subject, run once a round; and metrics, each
 * computed from the samples of a round. Rounds come in pairs: the first in an order drawn at
 * random, the second in the reverse order (A B B A), so that whatever the machine does meanwhile
 * hits all alike, and a ratio of two is taken within the round. */

enum { MEASURE_NAME = 80, MEASURE_COMMAND = 200, MEASURE_SERIES = 128, MEASURE_METRICS = 80 };

struct measure_series {
    struct subject_shape shape;
    bool fresh; /* a process of its own for each sample, asked once: for memory */
    char command[MEASURE_COMMAND];
    double work; /* what a run of it does, in a unit of the case's own */
    const struct measure_series
        *other;     /* the same in another setting, or again; the smaller sample counts */
    double *sample; /* one a round; NULL if the subject is missing */
};

/* The target of a metric's median. */
struct measure_target {
    const char *metric; /* NULL ends a list */
    double bound;
    bool least; /* at least the bound; else at most */
};

enum measure_verdict { MEASURE_PASS, MEASURE_MISS, MEASURE_UNKNOWN, MEASURE_VERDICTS };

struct measure_metric {
    char name[MEASURE_NAME];
    const char *unit;
    /* The value in a round; NAN if there is none. */
    double (*value)(const struct measure_metric *metric, size_t round);
    const struct measure_series *of, *against; /* against: NULL if it is no ratio */
    size_t n; /* series in a row from `of`, and from `against`; of the worst: metrics before it */
    size_t rounds; /* when it is computed: all of them, with their samples */
    double scale;
    const char *missing;                 /* why it was not measured, or NULL */
    const char *none;                    /* why rounds have no value, or NULL */
    double median, low, high;            /* NAN if not reached or not measured */
    const struct measure_target *target; /* NULL: it is only reported */
};

struct measure {
    const char *name; /* the case's */
    struct measure_series series[MEASURE_SERIES];
    struct measure_metric metric[MEASURE_METRICS];
    size_t n_series, n_metrics;
    unsigned loops; /* busy processes on each core meanwhile, see bench/loops.h */
    bool cold;      /* the first round counts, too: of runs that take long */
    bool full;      /* more were planned than there is room for: an error of the case */
};

/* A new series; shared processes are those of equal shape. The command in printf form. */
struct measure_series *measure_series(struct measure *measure, struct subject_shape shape,
                                      const char *command, ...)
    __attribute__((format(printf, 3, 4)));

/* A metric of a function of the case's own. The name in printf form. */
struct measure_metric *measure_metric(struct measure *measure, const char *unit,
                                      double (*value)(const struct measure_metric *, size_t),
                                      const char *name, ...) __attribute__((format(printf, 4, 5)));

/* Such functions: the sum of the samples of all series; the geometric mean of their ratios. */
double measure_sum(const struct measure_metric *metric, size_t round);
double measure_geometric(const struct measure_metric *metric, size_t round);

/* scale x sample; and the ratio of the samples of two series per unit of work. */
void measure_value(struct measure *measure, const struct measure_series *of, double scale,
                   const char *unit, const char *name, ...) __attribute__((format(printf, 5, 6)));
void measure_ratio(struct measure *measure, const struct measure_series *of,
                   const struct measure_series *against, const char *name, ...)
    __attribute__((format(printf, 4, 5)));

/* Plans the largest median of all ratios that were planned against subjects of this kind; there is
 * one at least. */
void measure_worst(struct measure *measure, const char *kind, const char *name);

/* Gives the metrics planned so far their targets, by name. */
void measure_targets(struct measure *measure, const struct measure_target *targets);

/* The verdict on a metric with a target, once it is measured. */
enum measure_verdict measure_verdict(const struct measure_metric *metric);

/* A random number below n. */
uint64_t measure_random(uint64_t *seed, uint64_t n);

/* Starts the subjects, runs one round that is left out unless `cold` and then `rounds` that count,
 * computes the metrics and tells `settings` of each subject once. 1, after a line on stderr, as
 * soon as anything fails: a wrong answer, a subject that dies, no memory. `name`: of the case. */
int measure_run(struct measure *measure, const char *name, size_t rounds, uint64_t *seed,
                void (*settings)(const char *kind, const char *text));

void measure_free(struct measure *measure);

#endif
