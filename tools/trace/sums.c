/* Sums are of ticks where they are compared with counters, so that they agree exactly. */
#include "tools/trace/sums.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

struct adding {
    const struct trace_run *run;
    struct trace_sums *sums;
};

static void sums_add_task(struct trace_sums *sums, const struct trace_event *event, double own)
{
    struct trace_kernel_sum *kernel = &sums->kernel[event->kernel];
    sums->tasks++;
    sums->chained += event->flags & TRACE_CHAINED ? 1 : 0;
    sums->busy += own;
    kernel->n++;
    kernel->seconds += own;
    kernel->longest = fmax(kernel->longest, own);
}

static void sums_add(void *context, const struct trace_seen *seen)
{
    const struct adding *adding = context;
    struct trace_sums *sums = adding->sums;
    const struct trace_event *event = seen->event;
    double within = trace_lasts(adding->run, seen->rank, event->within);
    sums->first = fmin(sums->first, seen->begin);
    sums->last = fmax(sums->last, seen->begin + seen->took);
    sums->messages += event->kind == TRACE_SEND;
    sums->bytes += event->kind == TRACE_SEND ? event->number : 0;
    sums->received += event->kind == TRACE_RECEIVE;
    sums->stolen += event->kind == TRACE_STEAL;
    sums->delegated += event->kind == TRACE_DELEGATE;
    if (event->kind == TRACE_TASK)
        sums_add_task(sums, event, seen->took - within);
    if (event->kind == TRACE_OWN)
        sums->own += seen->took - within;
    if (event->kind == TRACE_MESSAGES)
        sums->messaging += seen->took;
    if (event->kind == TRACE_FLUSH)
        sums->flush += seen->took;
    if (event->kind == TRACE_MIGRATE && !seen->rank)
        sums->migrated += event->number;
    if (event->kind == TRACE_IDLE) {
        sums->idle += seen->took;
        sums->exposed += within;
    }
}

int trace_sum(const struct trace_run *run, struct trace_sums *sums)
{
    *sums =
        (struct trace_sums){.first = INFINITY, .workers = trace_first_worker(run, run->n_ranks)};
    sums->kernel = base_alloc_zero((run->n_kernels + 1) * sizeof *sums->kernel);
    if (!sums->kernel)
        return base_no_memory("sums of a trace");
    trace_each(run, sums_add, &(struct adding){run, sums});
    if (!(sums->first < INFINITY))
        sums->first = 0;
    return DUITE_OK;
}

void trace_sums_free(struct trace_sums *sums)
{
    base_free(sums->kernel);
    sums->kernel = NULL;
}

/* ---- Against the counters ---- */

static void counters_add(struct trace_counters *worker, struct trace_counters *first,
                         const struct trace_event *event)
{
    bool task = event->kind == TRACE_TASK;
    worker->tasks += task;
    worker->chained += (task || event->kind == TRACE_OWN) && event->flags & TRACE_CHAINED ? 1 : 0;
    worker->busy += task ? event->took - event->within : 0;
    worker->idle += event->kind == TRACE_IDLE ? event->took : 0;
    worker->stolen += event->kind == TRACE_STEAL;
    worker->delegated += event->kind == TRACE_DELEGATE;
    first->messages += event->kind == TRACE_SEND;
    first->bytes += event->kind == TRACE_SEND ? event->number : 0;
}

static bool counters_same(FILE *file, uint32_t rank, uint32_t worker, const char *what,
                          uint64_t events, uint64_t counted)
{
    if (events != counted)
        fprintf(file,
                "rank %" PRIu32 " worker %" PRIu32 ": events add up to %" PRIu64
                " %s, it counted %" PRIu64 "\n",
                rank, worker, events, what, counted);
    return events == counted;
}

static bool counters_worker_agrees(FILE *file, uint32_t rank, uint32_t worker,
                                   const struct trace_counters *sum,
                                   const struct trace_counters *counted)
{
    bool fine = counters_same(file, rank, worker, "tasks", sum->tasks, counted->tasks);
    fine &= counters_same(file, rank, worker, "stolen tasks", sum->stolen, counted->stolen);
    fine &= counters_same(file, rank, worker, "chained tasks", sum->chained, counted->chained);
    fine &=
        counters_same(file, rank, worker, "delegated tasks", sum->delegated, counted->delegated);
    fine &= counters_same(file, rank, worker, "busy ticks", sum->busy, counted->busy);
    fine &= counters_same(file, rank, worker, "idle ticks", sum->idle, counted->idle);
    fine &= counters_same(file, rank, worker, "messages", sum->messages, counted->messages);
    return fine & counters_same(file, rank, worker, "bytes", sum->bytes, counted->bytes);
}

static bool counters_rank_agrees(const struct trace_run *run, FILE *file, uint32_t r,
                                 struct trace_counters *sum)
{
    const struct trace_rank *rank = &run->rank[r];
    bool fine = true;
    memset(sum, 0, rank->header->workers * sizeof *sum);
    for (size_t p = 0; p < rank->n_pieces; p++)
        for (size_t i = 0; i < rank->piece[p].n; i++)
            counters_add(&sum[rank->piece[p].worker], &sum[0], &rank->piece[p].event[i]);
    for (uint32_t w = 0; w < rank->header->workers; w++) {
        if (!rank->counters[w])
            fprintf(file, "rank %" PRIu32 " worker %" PRIu32 ": no counters\n", r, w);
        fine &= rank->counters[w] && counters_worker_agrees(file, r, w, &sum[w], rank->counters[w]);
    }
    return fine;
}

bool trace_sums_agree(const struct trace_run *run, FILE *file)
{
    const struct trace_header *header = run->rank[0].header;
    bool fine = true;
    if (!run->whole || run->lost || header->first || header->end != UINT64_MAX) {
        fputs("not all of the run was recorded: there is nothing to compare\n", file);
        return false;
    }
    for (uint32_t r = 0; r < run->n_ranks && fine; r++) {
        struct trace_counters *sum = base_alloc(run->rank[r].header->workers * sizeof *sum);
        fine = sum && counters_rank_agrees(run, file, r, sum);
        base_free(sum);
    }
    return fine;
}

/* ---- Bodies ---- */

/* A task of the main program has the seconds of its own body and of all its descendants: to other
 * tasks its subtree is one task. A replicated task has the mean over the ranks that ran it. */
struct body {
    uint64_t number; /* 0: free */
    double seconds;  /* float would lose small bodies among many */
    uint32_t n;      /* bodies, nested ones left out */
};

/* An open hash table. Task numbers come in dense runs, and are looked up in rising order: 64 of
 * them are neighbours in the table, too. The next 64 are elsewhere, since runs that lie a multiple
 * of the table's size apart, as of replays with many rounds at most, would heap up. */
struct trace_bodies {
    struct body *body;
    size_t mask;
};

static struct body *body_at(const struct trace_bodies *bodies, uint64_t number)
{
    const uint64_t scattered = (number >> 6) * UINT64_C(0x9E3779B97F4A7C15);
    size_t at = (size_t)(scattered >> 26 << 6 | (number & 63)) & bodies->mask;
    while (bodies->body[at].number && bodies->body[at].number != number)
        at = (at + 1) & bodies->mask;
    return &bodies->body[at];
}

static void body_add(struct trace_bodies *bodies, const struct trace_event *event, double tick)
{
    if (event->kind != TRACE_TASK)
        return;
    struct body *body = body_at(bodies, event->number);
    body->number = event->number;
    body->seconds += tick * (double)(event->took - event->within);
    body->n += !(event->flags & TRACE_NESTED);
}

struct trace_bodies *trace_bodies_new(const struct trace_run *run)
{
    size_t n = 16, room = 1;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    while (room < 2 * n)
        room *= 2;
    struct trace_bodies *bodies = base_alloc_zero(sizeof *bodies);
    if (!bodies || !(bodies->body = base_alloc_zero(room * sizeof *bodies->body))) {
        base_free(bodies);
        return NULL;
    }
    bodies->mask = room - 1;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++)
            for (size_t i = 0; i < run->rank[r].piece[p].n; i++)
                body_add(bodies, &run->rank[r].piece[p].event[i], run->rank[r].header->tick);
    return bodies;
}

void trace_bodies_free(struct trace_bodies *bodies)
{
    if (bodies)
        base_free(bodies->body);
    base_free(bodies);
}

bool trace_bodies_find(const struct trace_bodies *bodies, uint64_t number, double *seconds)
{
    const struct body *body = body_at(bodies, number);
    *seconds = body->n > 1 ? body->seconds / body->n : body->seconds;
    return body->number != 0;
}

/* ---- For people ---- */

static double sums_ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

/* The shares add up to the workers' time from the first event to the last one. */
static void sums_print_shares(const struct trace_sums *sums, double all, FILE *file)
{
    const double named = sums->busy + sums->own + sums->messaging + sums->flush + sums->idle;
    const struct {
        const char *name, *what;
        double seconds;
    } share[] = {{"busy", "bodies of tasks", sums->busy},
                 {"own", "tasks of the runtime's own", sums->own},
                 {"messages", "MPI: polling, sending and receiving messages", sums->messaging},
                 {"writing", "of the trace", sums->flush},
                 {"idle", "of that with messages awaited", sums->idle},
                 {"rest", "the runtime between tasks, the main program, start and end",
                  fmax(all - named, 0)}};
    fputs("  of the workers' time\n", file);
    for (size_t i = 0; i < sizeof share / sizeof *share; i++) {
        fprintf(file, "    %-11s %5.1f %%  %s", share[i].name,
                100 * sums_ratio(share[i].seconds, all), share[i].what);
        if (!strcmp(share[i].name, "idle"))
            fprintf(file, " %.1f %%", 100 * sums_ratio(sums->exposed, all));
        fputc('\n', file);
    }
}

static void sums_print_kernels(const struct trace_run *run, const struct trace_sums *sums,
                               FILE *file)
{
    fprintf(file, "  %-28s %10s %12s %12s %12s\n", "kernel", "tasks", "seconds", "mean us",
            "longest us");
    for (uint32_t k = 0; k < run->n_kernels; k++) {
        const struct trace_kernel_sum *kernel = &sums->kernel[k];
        if (kernel->n)
            fprintf(file, "  %-28s %10" PRIu64 " %12.6f %12.3f %12.3f\n", run->kernel_name[k],
                    kernel->n, kernel->seconds,
                    1e6 * sums_ratio(kernel->seconds, (double)kernel->n), 1e6 * kernel->longest);
    }
    fprintf(file, "  %-28s %10s %12.6f\n", "(the runtime's own)", "", sums->own);
}

const char *trace_limit_name(const struct trace_shares *shares)
{
    const struct {
        const char *name;
        double share;
    } limit[] = {{"work", shares->work},
                 {"critical path", shares->path},
                 {"messages", shares->messages},
                 {"too few ready tasks", shares->starved},
                 {"runtime and main program", shares->runtime}};
    size_t largest = 0;
    for (size_t i = 1; i < sizeof limit / sizeof *limit; i++)
        if (limit[i].share > limit[largest].share)
            largest = i;
    return limit[largest].name;
}

static void sums_print_limit(const struct trace_sums *sums, double path, double all, FILE *file)
{
    const double span = sums->last - sums->first;
    struct trace_shares shares = {.work = sums_ratio(sums->busy, all),
                                  .messages = sums_ratio(sums->messaging + sums->exposed, all),
                                  .starved = sums_ratio(sums->idle - sums->exposed, all)};
    shares.runtime = 1 - shares.work - shares.messages - shares.starved;
    if (isnan(path)) {
        fputs("  critical path unknown\n", file);
    } else {
        shares.path = sums_ratio(path, span);
        fprintf(file, "  critical path %.6f s, %.1f %% of the time\n", path, 100 * shares.path);
    }
    fprintf(file, "  limited by    %s\n", trace_limit_name(&shares));
}

int trace_print(const struct trace_run *run, double path, FILE *file)
{
    struct trace_sums sums;
    int code = trace_sum(run, &sums);
    if (code)
        return code;
    double span = sums.last - sums.first, all = span * sums.workers;
    fprintf(file, "  ranks         %" PRIu32 ", workers %" PRIu32 "\n", run->n_ranks, sums.workers);
    fprintf(file, "  time          %.6f s\n", span);
    fprintf(file,
            "  tasks         %" PRIu64 ", stolen %" PRIu64 ", chained %" PRIu64
            ", delegated %" PRIu64 "\n",
            sums.tasks, sums.stolen, sums.chained, sums.delegated);
    fprintf(file, "  messages      %" PRIu64 ", %.3f MB\n", sums.messages,
            1e-6 * (double)sums.bytes);
    if (run->n_ranks > 1)
        fprintf(file, "  clocks        agree within %.3g us\n", 1e6 * run->bound);
    if (run->lost)
        fprintf(file, "  LOST          %" PRIu64 " events or words of the program\n", run->lost);
    if (!run->whole)
        fputs("  NOT WHOLE     the run did not come to its end\n", file);
    sums_print_limit(&sums, path, all, file);
    sums_print_shares(&sums, all, file);
    sums_print_kernels(run, &sums, file);
    trace_sums_free(&sums);
    return DUITE_OK;
}
