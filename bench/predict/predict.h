#ifndef BENCH_PREDICT_PREDICT_H
#define BENCH_PREDICT_PREDICT_H

#include "bench/bench.h"
#include "bench/ranks/sheet.h"

/* Shared by the cases of the bench "compare". Each case is a file. */

/* A file of this name in the folder of the run's traces, which lives as long as the bench. NULL
 * without memory; the caller frees it. */
char *predict_path(const char *name);

/* The trace of a million tasks, or of fewer: where it is, and how it is made. 0, or what serve_fail
 * returns. */
#define PREDICT_MANY "predict-many.trace"
int predict_make_many(uint32_t tasks);

/* The trace that predictions of the sheet start from. */
#define PREDICT_SHEET "predict-sheet.trace"

extern const struct bench_case predict_trace, predict_many, predict_errors;

#endif
