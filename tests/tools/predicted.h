#ifndef TESTS_RUNTIME_PREDICTED_H
#define TESTS_RUNTIME_PREDICTED_H

#include "tests/support/trace_file.h"
#include "tools/predict/predict.h"

/* Shared by tests of predictions. The mapping is block: of two objects the first lives on host 0,
 * the second on host 1. */

#define SLOTS(...) ((const uint32_t[]){__VA_ARGS__})
#define MS         1e-3

/* Hosts on which nothing but bodies takes time, first come, first served. */
struct predict_cluster predicted_machine(uint32_t hosts, uint32_t cores);

/* n objects of so many bytes, recorded from now on. */
struct trace_file predicted_trace(uint32_t n, uint64_t bytes);

/* The file, written and read; the caller frees the run. The file is empty then. */
struct trace_run *predicted_run(struct trace_file *file);

/* Predicted twice; fails the test unless both are the same. */
struct predict_result predicted(struct trace_file *file, const struct predict_cluster *cluster);

#endif
