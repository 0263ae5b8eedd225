#ifndef TESTS_RUNTIME_FORETELL_H
#define TESTS_RUNTIME_FORETELL_H

#include "runtime/predict/predict.h"
#include "tests/support/trace_file.h"

/* What tests of predictions share. The mapping is block: of two objects the first lives on host 0,
 * the second on host 1. */

#define SLOTS(...) ((const uint32_t[]){__VA_ARGS__})
#define MS         1e-3

/* Hosts on which nothing but bodies takes time, first come, first served. */
struct predict_cluster foretell_machine(uint32_t hosts, uint32_t cores);

/* n objects of so many bytes, recorded from now on. */
struct trace_file foretell_begun(uint32_t n, uint64_t bytes);

/* The file, written and read; the caller frees the run. The file is empty then. */
struct trace_run *foretell_written(struct trace_file *file);

/* Foretold twice; fails the test unless both are the same. */
struct predict_result foretell(struct trace_file *file, const struct predict_cluster *cluster);

#endif
