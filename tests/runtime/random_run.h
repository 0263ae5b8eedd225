#ifndef TESTS_RUNTIME_RANDOM_RUN_H
#define TESTS_RUNTIME_RANDOM_RUN_H

#include "tests/runtime/random_program.h"

/* A run of a random program, shared by random_run.c and random_places.c only. */

struct run_graph {
    struct run *run;
    duite_graph name;
    int alive, rebound;
    size_t first, again; /* as in random_interpret.c */
};

struct run {
    const struct prog *prog;
    const struct prog_answers *answers;
    struct prog_report *report;
    duite *rt;
    int rank;
    size_t at;
    duite_object *object;    /* n_objects */
    int *home;               /* n_objects: when last asked; -1 before, and of what is freed if... */
    int moves;               /* ... homes change: then they are asked for at the end only */
    struct run_graph *graph; /* n_graphs */
    unsigned char *bytes;    /* for the largest object */
    size_t largest;
};

/* Keeps what is wrong at the operation `at`, if it is the first. */
__attribute__((format(printf, 2, 3))) void prog_found(struct run *run, const char *format, ...);

/* Followers live with their leaders, and tasks ran where they should, as often as they should. */
void prog_check_places(struct run *run, const struct prog_context *context,
                       const struct prog_setup *setup);

#endif
