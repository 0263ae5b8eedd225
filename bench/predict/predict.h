#ifndef BENCH_PREDICT_PREDICT_H
#define BENCH_PREDICT_PREDICT_H

#include "bench/bench.h"
#include "bench/ranks/sheet.h"
#include "tools/predict/predict.h"

/* Shared by the cases of the bench "compare". Each case is a file. */

/* A file of this name in the folder of the run's traces, which lives as long as the bench. NULL
 * without memory; the caller frees it. */
char *predict_path(const char *name);

/* The trace of a million tasks, or of fewer: where it is, and how it is made. 0, or what serve_fail
 * returns. */
#define PREDICT_MANY "predict-many.trace"
int predict_make_many(uint32_t tasks);

/* A run of the sheet. Mappings are those of duite_mapping_find, and "lopsided". */
struct predict_config {
    unsigned ranks, threads;
    const char *scheduler, *mapping, *balance;
};

/* Its series. trace: "no"; "wall": there is one, and the time is that which the run tells; "run":
 * the time is that of the trace; "slow": the same, and the second rank has half of a core's time;
 * "kept": as "run", and the trace of each round is kept. */
struct measure_series *predict_series(struct measure *measure, const struct bench_options *options,
                                      const struct predict_config *config, const char *trace);
extern const struct serve_run predict_sheet_runs[];

/* The trace that was kept in this round; NULL: it cannot be read. And the seconds that are
 * predicted from it; NAN: they are not. */
struct trace_run *predict_read_sheet(size_t round);
double predict_makespan(const struct trace_run *run, const struct predict_config *config,
                        bool slow);

/* quota.c: whether this machine lets a process have half of a core's time, and whether this one has
 * from now on: 0, or what serve_fail returns. The end removes what is left of it. */
bool predict_quota_is_there(void);
int predict_quota(bool begins);
void predict_quota_end(void);

extern const struct bench_case predict_trace, predict_many, predict_errors, predict_order,
    predict_overhead;

#endif
