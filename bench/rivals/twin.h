#ifndef BENCH_RIVALS_TWIN_H
#define BENCH_RIVALS_TWIN_H

#include "tools/compare/graph.h"

#include <stdint.h>

/* A twin of duite-graph (tools/duite-graph.c): the same tasks on the same graph by another runtime,
 * forked in each round, and the same report. It takes those options of duite-graph that all twins
 * have. */

struct twin {
    const char *what, *report, *scheduler;
    size_t tasks;
    double cost;
    uint32_t bytes;
    uint64_t rounds;
    int threads;
    int rank; /* of MPI's; only rank 0 reports */
    struct compare_graph graph;
    uint64_t **values; /* of task i, so many: */
    size_t *count;
};

struct twin_runtime {
    const char *name;                   /* of the program */
    const char *usual;                  /* its scheduler, if none is asked for */
    const char *(*scheduler)(size_t i); /* the names, then NULL */
    int (*start)(struct twin *twin);    /* 1: failed, as of round */
    int (*round)(struct twin *twin);    /* returns when all of its tasks are over, on this rank */
    void (*meet)(void);                 /* all ranks, before the clock starts and stops; or NULL */
    double (*busy)(void);           /* s in bodies of all workers since the last call; or NULL */
    int (*stop)(struct twin *twin); /* the values are in place, on rank 0; 1: failed */
};

/* The body of task i. */
void twin_body(const struct twin *twin, size_t i);

int twin_main(int argc, char **argv, const struct twin_runtime *runtime);

#endif
