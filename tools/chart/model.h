#ifndef DUITE_TOOLS_CHART_MODEL_H
#define DUITE_TOOLS_CHART_MODEL_H

#include "tools/chart/chart.h"
#include "tools/trace/read.h"

#include <stdint.h>

/* The content of a chart, in seconds and counts: shares of time by columns and rows, the critical
 * path, messages. */

/* ---- shares.c ---- */

/* A worker's time goes to slots: kernels, by their place in the trace's list, and behind these the
 * states. The rest is time without any of them. */
enum chart_state {
    CHART_OWN,      /* the runtime's own tasks */
    CHART_MESSAGES, /* MPI, of workers that are not idle */
    CHART_WRITING,  /* of the trace */
    CHART_IDLE,
    CHART_AWAITING, /* idle, and messages were awaited: where in the idle time is not known */
    CHART_STATES
};

#define CHART_NONE UINT32_MAX

/* Seconds by row, column and slot. Time within other tasks, idling and messages counts there alone,
 * so no moment of a worker is shared out twice. */
struct chart_shares {
    double from, column; /* s: where column 0 begins, and how long each is */
    uint32_t n_rows, n_columns, n_slots;
    double *seconds; /* n_rows x n_columns x n_slots */
};

/* Room, all zero, for the time from .. to; to be freed by base_free(shares->seconds), which is NULL
 * after an error. Errors: memory. */
int chart_shares_make(struct chart_shares *shares, double from, double to, uint32_t n_rows,
                      uint32_t n_columns, uint32_t n_slots);
/* Adds the part of begin .. end that is within the columns, times `weight`. */
void chart_shares_add(struct chart_shares *shares, uint32_t row, uint32_t slot, double begin,
                      double end, double weight);
/* Adds all events. row_of: by worker of all ranks; slot_of: by kernel, then by state, CHART_NONE:
 * left out. Errors: memory. */
int chart_shares_fill(struct chart_shares *shares, const struct trace_run *run,
                      const uint32_t *row_of, const uint32_t *slot_of);
static inline const double *chart_shares_of(const struct chart_shares *shares, uint32_t row,
                                            uint32_t column)
{
    return shares->seconds + ((size_t)row * shares->n_columns + column) * shares->n_slots;
}

/* ---- traffic.c ---- */

/* A task of the critical path where it ran, or where it took longest if it ran on several ranks. */
struct chart_step {
    double begin, end; /* s */
    uint32_t worker;   /* of all ranks */
    uint32_t kernel;
};

struct chart_path {
    bool known;              /* the trace is whole and has the program */
    double seconds;          /* of the run's critical path */
    size_t n;                /* steps that ran, in their order */
    struct chart_step *step; /* to be freed by base_free */
};

/* Errors: memory. */
int chart_path_find(const struct trace_run *run, struct chart_path *path);

struct chart_traffic {
    size_t n;                       /* messages sent within from .. to */
    uint32_t *count;                /* of these, by column */
    struct trace_messages messages; /* those on their way then, if n <= max */
};

/* To be freed by base_free(count), base_free(messages.message), after an error, too. Errors:
 * memory. */
int chart_traffic_find(const struct trace_run *run, double from, double to, uint32_t n_columns,
                       size_t max, struct chart_traffic *traffic);

/* ---- model.c ---- */

enum { CHART_MAX_KERNELS = 7, CHART_MAX_SLOTS = CHART_MAX_KERNELS + 2, CHART_NAME = 32 };

/* Each slot has a colour: the kernels with most time, all other kernels, the runtime. */
struct chart_slot {
    char name[CHART_NAME];
    double seconds;
    uint32_t rgb;
};

struct chart_model {
    const struct trace_run *run;
    double from, to;    /* s: the part shown */
    double first, last; /* s: the run */
    uint32_t n_workers, n_slots;
    struct chart_slot slot[CHART_MAX_SLOTS];
    uint32_t *slot_of;   /* by kernel and state */
    double busy, idle;   /* s, of all workers */
    double path_seconds; /* s of the critical path in the part shown */
    const char *limit;
    struct chart_path path;
    uint32_t n_rows;
    uint32_t *row_of;           /* by worker of all ranks */
    uint32_t *workers;          /* by row: how many share it */
    uint32_t *rank_of;          /* by row: the first rank in it */
    struct chart_shares shares; /* n_rows, and one row more: the critical path */
    struct chart_traffic traffic;
};

/* The first part: all but rows and shares. max_lines: see chart_traffic_find. Errors: memory;
 * DUITE_E_ARGUMENT: the window is empty. */
int chart_model_make(struct chart_model *model, const struct trace_run *run,
                     const struct chart_options *options, uint32_t n_columns, size_t max_lines);
/* The second part. Workers of a rank share rows if there are more than `max_rows`, and ranks do if
 * that is not enough; max_rows: 1 at least. Errors: memory. */
int chart_model_fill(struct chart_model *model, uint32_t n_columns, uint32_t max_rows);
/* All zero is fine. */
void chart_model_free(struct chart_model *model);

#endif
