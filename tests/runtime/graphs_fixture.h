#ifndef TESTS_RUNTIME_GRAPHS_FIXTURE_H
#define TESTS_RUNTIME_GRAPHS_FIXTURE_H

#include "tests/support/unit.h"

#include <duite.h>

#include <stdint.h>

/* Kernels: DIGIT appends its argument, a digit, to a number; LIMIT copies a number and fails, with
 * its argument, if that is 100 or more; COPY copies. ROUND_DIGIT appends its round; LEND forks
 * that, with its right. */
extern const duite_kernel DIGIT, LIMIT, COPY, ROUND_DIGIT, LEND;

/* A runtime of two workers, three numbers that are 0, and a graph. */
struct graphs_fixture {
    duite *rt;
    duite_graph graph;
    duite_object a, b, c;
    int built, wrong; /* times build was called; what it does wrong */
};

/* Appends 1 to a, 2 to b, 3 to a. Its context is a fixture. */
int graphs_build(duite *rt, void *context);

/* A runtime of so many workers that are not bound. scheduler: NULL is the default. */
duite *graphs_start(const duite_kernel *const *kernels, unsigned threads, const char *scheduler);
duite_graph graphs_record(duite *rt, duite_build *build, void *context);
uint64_t graphs_rounds_of(duite *rt, duite_graph graph);
duite_object graphs_number(duite *rt, int64_t value);
int64_t graphs_value_of(duite *rt, duite_object object);

/* The graph's own fixture, which `build` is given, is one that stays as it is now. */
struct graphs_fixture graphs_begin(duite_build *build);
/* Frees all; stop returns `code`. */
void graphs_end(struct graphs_fixture *f, int code);

#endif
