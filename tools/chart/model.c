/* The content of a chart, worked out in two parts: first the words; then, when these have their
 * places and the remaining room is known, the drawing. */
#include "tools/chart/model.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "tools/trace/sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Told apart by people with any kind of colour vision: Okabe and Ito, "Color Universal Design"
 * (2008), without their black; other kernels and the runtime are grey. */
static const uint32_t COLOURS[CHART_MAX_KERNELS] = {0x0072B2, 0xE69F00, 0x009E73, 0xCC79A7,
                                                    0x56B4E9, 0xD55E00, 0xF0E442};
enum { OTHER_COLOUR = 0xBBBBBB, RUNTIME_COLOUR = 0x666666 };

/* ---- Times ---- */

struct ranked {
    double seconds;
    uint32_t kernel;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    if (x->seconds != y->seconds)
        return x->seconds < y->seconds ? 1 : -1;
    return (x->kernel > y->kernel) - (x->kernel < y->kernel);
}

/* Names are the program's and go into files with rules of their own about characters. So a special
 * character becomes a question mark, and a long name ends in points. */
static void name_copy(char *to, const char *name)
{
    size_t i;
    for (i = 0; name[i] && i < CHART_NAME - 1; i++)
        to[i] = name[i] >= ' ' && name[i] <= '~' ? name[i] : '?';
    to[i] = 0;
    if (name[i])
        memcpy(to + CHART_NAME - 4, "...", 4);
}

static void slot_add(struct chart_model *model, const char *name, double seconds, uint32_t rgb)
{
    struct chart_slot *slot = &model->slot[model->n_slots++];
    *slot = (struct chart_slot){.seconds = seconds, .rgb = rgb};
    name_copy(slot->name, name);
}

/* The kernels that took longest have a colour each; those that follow share one, unless there is
 * one alone. */
static void slots_choose(struct chart_model *model, const struct ranked *ranked, uint32_t n)
{
    const uint32_t n_own = n <= CHART_MAX_KERNELS ? n : CHART_MAX_KERNELS;
    double others = 0;
    for (uint32_t i = 0; i < n_own; i++) {
        slot_add(model, model->run->kernel_name[ranked[i].kernel], ranked[i].seconds, COLOURS[i]);
        model->slot_of[ranked[i].kernel] = i;
    }
    for (uint32_t i = n_own; i < n; i++) {
        others += ranked[i].seconds;
        model->slot_of[ranked[i].kernel] = model->n_slots;
    }
    if (n > n_own)
        slot_add(model, "other kernels", others, OTHER_COLOUR);
}

static double path_within(const struct chart_model *model)
{
    double seconds = 0;
    for (size_t i = 0; i < model->path.n; i++)
        seconds += fmax(fmin(model->path.step[i].end, model->to) -
                            fmax(model->path.step[i].begin, model->from),
                        0);
    return seconds;
}

/* seconds: by kernel and state. */
static void model_take_times(struct chart_model *model, const double *seconds)
{
    const double *state = seconds + model->run->n_kernels;
    const double span = model->to - model->from, all = span * model->n_workers;
    const bool whole = model->from <= model->first && model->to >= model->last;
    for (uint32_t k = 0; k < model->run->n_kernels; k++)
        model->busy += seconds[k];
    model->idle = state[CHART_IDLE] + state[CHART_AWAITING];
    model->path_seconds = whole ? model->path.seconds : path_within(model);
    struct trace_shares shares = {.work = model->busy / all,
                                  .path = model->path.known ? model->path_seconds / span : 0,
                                  .messages = (state[CHART_MESSAGES] + state[CHART_AWAITING]) / all,
                                  .starved = state[CHART_IDLE] / all};
    shares.runtime = 1 - shares.work - shares.messages - shares.starved;
    model->limit = trace_limit_name(&shares);
}

/* All of the workers' time is one column of one row here. */
static int model_times(struct chart_model *model)
{
    const uint32_t n_kernels = model->run->n_kernels, n = n_kernels + CHART_STATES;
    struct chart_shares all = {0};
    struct ranked *ranked = base_alloc((n + 1) * sizeof *ranked);
    uint32_t n_seen = 0;
    int code = ranked ? DUITE_OK : base_no_memory("the kernels of a chart");
    code = code ? code : chart_shares_make(&all, model->from, model->to, 1, 1, n);
    for (uint32_t i = 0; i < n; i++)
        model->slot_of[i] = i;
    code = code ? code : chart_shares_fill(&all, model->run, model->row_of, model->slot_of);
    if (!code) {
        for (uint32_t k = 0; k < n_kernels; k++)
            if (all.seconds[k] > 0)
                ranked[n_seen++] = (struct ranked){all.seconds[k], k};
        qsort(ranked, n_seen, sizeof *ranked, compare_ranked);
        for (uint32_t i = 0; i < n; i++)
            model->slot_of[i] = CHART_NONE;
        slots_choose(model, ranked, n_seen);
        for (uint32_t s = CHART_OWN; s <= CHART_WRITING; s++)
            model->slot_of[n_kernels + s] = model->n_slots;
        const double *state = all.seconds + n_kernels;
        slot_add(model, "runtime", state[CHART_OWN] + state[CHART_MESSAGES] + state[CHART_WRITING],
                 RUNTIME_COLOUR);
        model_take_times(model, all.seconds);
    }
    base_free(ranked);
    base_free(all.seconds);
    return code;
}

static int model_window(struct chart_model *model, const struct chart_options *options)
{
    double from = options->from, to = options->to;
    struct trace_sums sums;
    int code = trace_sum(model->run, &sums);
    trace_sums_free(&sums);
    if (code)
        return code;
    model->first = sums.first;
    model->last = sums.last;
    if (options->shares) {
        from = sums.first + from * (sums.last - sums.first);
        to = sums.first + to * (sums.last - sums.first);
    }
    model->from = fmax(from, sums.first);
    model->to = fmin(to, sums.last);
    if (model->from < model->to)
        return DUITE_OK;
    if (from < to && sums.first < sums.last)
        return base_error(DUITE_E_ARGUMENT,
                          "the window %g:%g has nothing of the run, which is from %g s to %g s",
                          from, to, sums.first, sums.last);
    return base_error(DUITE_E_ARGUMENT, "the trace has nothing that took time: no chart");
}

int chart_model_make(struct chart_model *model, const struct trace_run *run,
                     const struct chart_options *options, uint32_t n_columns, size_t max_lines)
{
    *model = (struct chart_model){.run = run, .n_workers = trace_first_worker(run, run->n_ranks)};
    const uint32_t n = run->n_kernels + CHART_STATES;
    int code = model_window(model, options);
    if (code)
        return code;
    model->row_of = base_alloc_zero((model->n_workers + 1) * sizeof *model->row_of);
    model->slot_of = base_alloc(n * sizeof *model->slot_of);
    if (!model->row_of || !model->slot_of)
        return base_no_memory("a chart");
    code = chart_path_find(run, &model->path);
    code = code ? code : model_times(model);
    return code ? code
                : chart_traffic_find(run, model->from, model->to, n_columns, max_lines,
                                     &model->traffic);
}

/* ---- Rows ---- */

/* Rows of all ranks if so many workers share one. */
static uint32_t rows_of(const struct trace_run *run, uint32_t together)
{
    uint64_t n = 0;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += (run->rank[r].header->workers + together - 1) / together;
    return (uint32_t)n;
}

static int rows_make(struct chart_model *model, uint32_t max_rows)
{
    const struct trace_run *run = model->run;
    uint32_t together = 1, ranks_together = 1, row = 0, worker = 0;
    while (rows_of(run, together) > max_rows && together < model->n_workers)
        together++;
    while ((run->n_ranks + ranks_together - 1) / ranks_together > max_rows)
        ranks_together++;
    model->workers = base_alloc_zero((model->n_workers + 1) * sizeof *model->workers);
    model->rank_of = base_alloc((model->n_workers + 1) * sizeof *model->rank_of);
    if (!model->workers || !model->rank_of)
        return base_no_memory("the rows of a chart");
    for (uint32_t r = 0; r < run->n_ranks; r++) {
        const uint32_t n = run->rank[r].header->workers;
        for (uint32_t w = 0; w < n; w++, worker++) {
            const uint32_t at = ranks_together > 1 ? r / ranks_together : row + w / together;
            if (!model->workers[at]++)
                model->rank_of[at] = r;
            model->row_of[worker] = at;
        }
        row += (n + together - 1) / together;
    }
    model->n_rows = model->row_of[model->n_workers - 1] + 1;
    model->workers[model->n_rows] = 1; /* the critical path */
    return DUITE_OK;
}

int chart_model_fill(struct chart_model *model, uint32_t n_columns, uint32_t max_rows)
{
    int code = rows_make(model, max_rows);
    code = code ? code
                : chart_shares_make(&model->shares, model->from, model->to, model->n_rows + 1,
                                    n_columns, model->n_slots);
    code =
        code ? code : chart_shares_fill(&model->shares, model->run, model->row_of, model->slot_of);
    for (size_t i = 0; i < model->path.n && !code; i++)
        chart_shares_add(&model->shares, model->n_rows, model->slot_of[model->path.step[i].kernel],
                         model->path.step[i].begin, model->path.step[i].end, 1);
    return code;
}

void chart_model_free(struct chart_model *model)
{
    base_free(model->slot_of);
    base_free(model->row_of);
    base_free(model->workers);
    base_free(model->rank_of);
    base_free(model->shares.seconds);
    base_free(model->path.step);
    base_free(model->traffic.count);
    base_free(model->traffic.messages.message);
}
