#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include "bench/measure.h"
#include "bench/serve.h"

/* A bench is a list of cases; duite-bench.c lists the benches. */

struct bench_options {
    unsigned threads;      /* cores, for us and for every rival */
    const char *scheduler; /* ours */
    bool quick;            /* tiny sizes, to see that everything works */
    const char *states;    /* of cg: the folder of its states; NULL: beside the program */
};

struct bench_case {
    const char *name;
    const char *about; /* one line */
    /* Says what is measured and how it is called; runs nothing. */
    void (*plan)(struct measure *measure, const struct bench_options *options);
    const struct serve_run *runs; /* by our own process, and the sequential twin's */
    uint64_t most_rounds;         /* where a round takes long; 0: as many as are asked for */
};

struct bench {
    const char *name;
    const char *about;
    const struct bench_case *const *cases; /* ended by NULL */
    const struct measure_target *targets;  /* in full size, with so many threads */
    unsigned target_threads;
    /* Serves the runs of these cases: called in the processes that duite-bench starts of itself. */
    int (*serve)(const struct bench *bench);
    /* Before the first case, in the bench's own process: makes what all cases need, and says what
     * it is. 1, said on stderr, if it cannot be made. NULL: nothing is needed. */
    int (*prepare)(const struct bench_options *options,
                   void (*say)(const char *key, const char *text));
    void (*finish)(void); /* at the end, also of a run that failed; NULL: there is nothing to do */
};

extern const struct bench bench_tasks, bench_ranks, bench_cg, bench_physics, bench_contact,
    bench_garments, bench_compare, bench_output, bench_scale;

#endif
