/* A standstill: who waits for what when nothing moves. The looks know nothing but counters that
 * others keep anyway. All waiting goes back to bodies that run and messages that are awaited; both
 * are held where they are during a report, and with them the tasks that wait for them.
 *
 * A report reads tasks that run: their workers are kept from going on when the body is over. Each
 * of them stores that it left the task and then loads `watched`; the monitor sets `watched` and
 * then loads what the worker runs. One of the two must see the other. The fence for that is
 * membarrier(2) on the monitor's side alone, which runs one on all threads of the process. So it
 * costs a task no more than a store and a load. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/offload/offload.h"
#include "runtime/task/event.h"
#include "runtime/workers/internal.h"

#include <linux/membarrier.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

/* ---- The reason of the main program's wait; movement ---- */

void work_waits(struct work_pool *pool, const struct work_why *why)
{
    struct work_waits *waits = &pool->standstill.waits;
    if (why && !why->what) {
        atomic_store_explicit(&waits->slot, why->key->slot, memory_order_relaxed);
        atomic_store_explicit(&waits->generation, why->key->generation, memory_order_relaxed);
        atomic_store_explicit(&waits->number, why->key->number, memory_order_relaxed);
    }
    if (why)
        atomic_store_explicit(&waits->what, why->what, memory_order_relaxed);
    atomic_store_explicit(&waits->tasks, pool->setup.graph->tasks, memory_order_relaxed);
    queue_bump(&waits->turn, 1);
    atomic_store_explicit(&waits->call, why ? why->call : NULL, memory_order_release);
}

/* A number that changes with whatever happens on this rank. */
static uint64_t pool_movement(struct work_pool *pool)
{
    const uint64_t odd = 0x9e3779b97f4a7c15u;
    uint64_t sum = atomic_load(&pool->standstill.waits.turn);
    sum = sum * odd + atomic_load(&pool->setup.graph->root.unfinished);
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        const struct worker *worker = &pool->queues.worker[i];
        const struct queue_counts *counts = &worker->counts;
        sum = sum * odd + (uintptr_t)atomic_load(&worker->runs);
        sum = sum * odd + atomic_load(&counts->over);
        sum = sum * odd + atomic_load(&counts->tasks);
        sum = sum * odd + atomic_load(&counts->placed);
        sum = sum * odd + atomic_load(&counts->chained);
    }
    return pool->setup.comm ? sum * odd + comm_movement(pool->setup.comm) : sum;
}

static bool pool_runs_a_body(struct work_pool *pool)
{
    for (unsigned i = 0; i < pool->setup.threads; i++)
        if (atomic_load(&pool->queues.worker[i].runs))
            return true;
    return false;
}

bool work_stands_still(struct work_pool *pool, struct work_stillness *still)
{
    const double seconds = 0.1;
    const uint64_t now = base_ticks(), movement = pool_movement(pool);
    if (!still->since || still->movement != movement || pool_runs_a_body(pool))
        *still = (struct work_stillness){movement, now};
    return (double)(now - still->since) * pool->queues.tick > seconds;
}

/* ---- The report ---- */

enum { MAX_LINES = 20, MAX_BODIES = 8 };

struct report {
    struct work_pool *pool;
    unsigned lines, left_out;
    size_t length;
    char text[MAX_LINES * 256];
};

__attribute__((format(printf, 2, 3))) static void report_line(struct report *report,
                                                              const char *format, ...)
{
    if (report->lines >= MAX_LINES - 1) {
        report->left_out++;
        return;
    }
    va_list list;
    char text[230];
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    report->length +=
        (size_t)snprintf(report->text + report->length, sizeof report->text - report->length,
                         "duite: rank %d: %s\n", report->pool->setup.graph->rank, text);
    report->lines++;
}

/* A task in words. */
struct words {
    char text[120];
};

static struct words report_words(const struct report *report, const struct task *task)
{
    const struct task_graph *graph = report->pool->setup.graph;
    struct words words = {"a task of duite (a get, a sum or a message)"};
    if (task->kernel < graph->n_kernels)
        snprintf(words.text, sizeof words.text, "task %llu (kernel %.60s)",
                 (unsigned long long)task->number, graph->kernels[task->kernel]->name);
    return words;
}

static void words_add_more(struct words *words, unsigned more)
{
    size_t length = strlen(words->text);
    if (more)
        snprintf(words->text + length, sizeof words->text - length, " (and %u more)", more);
}

/* ---- Bodies ---- */

/* Holds the bodies that run: until the lock is let go no worker goes on after its body. False if
 * that is not possible. */
static bool report_hold_workers(struct work_pool *pool)
{
    atomic_store_explicit(&pool->watched, 1, memory_order_seq_cst);
    syscall(SYS_membarrier, MEMBARRIER_CMD_REGISTER_PRIVATE_EXPEDITED, 0, 0);
    return !syscall(SYS_membarrier, MEMBARRIER_CMD_PRIVATE_EXPEDITED, 0, 0);
}

/* Names the program's first waiting task in fork order, and says how many more there are. */
static struct words report_crowd(const struct report *report, const struct data_waiter *waiter)
{
    const struct task *first = task_who_waits(waiter);
    unsigned more = 0;
    while ((waiter = waiter->next)) {
        const struct task *task = task_who_waits(waiter);
        bool of_program = task->kernel != UINT32_MAX;
        if (of_program && (first->kernel == UINT32_MAX || task->number < first->number))
            first = task;
        more++;
    }
    struct words words = report_words(report, first);
    words_add_more(&words, more);
    return words;
}

static void report_waiters(struct report *report, const struct task *task, uint32_t i)
{
    const struct task_access *access = &task->access[i];
    bool writes = access->waiter.mode == DUITE_W || access->waiter.mode == DUITE_RW;
    const struct data_waiter *waiter = writes ? data_version_waiters(access->waiter.version) : NULL;
    if (waiter)
        report_line(report, "%s waits for what %s writes to parameter %u",
                    report_crowd(report, waiter).text, report_words(report, task).text, i);
}

/* Reports the bodies that run; returns how many. */
static unsigned report_bodies(struct report *report, bool held)
{
    struct work_pool *pool = report->pool;
    unsigned n = 0;
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        const struct task *task = atomic_load(&pool->queues.worker[i].runs);
        if (!task)
            continue;
        if (n++ >= MAX_BODIES)
            report->left_out++;
        else
            report_line(report, "worker %u%s runs %s", i, i ? "" : " (the main thread)",
                        held ? report_words(report, task).text : "a task");
    }
    for (unsigned i = 0; i < pool->setup.threads && held; i++) {
        const struct task *task = atomic_load(&pool->queues.worker[i].runs);
        for (uint32_t k = 0; task && task->type == TASK_BODY && k < task->n; k++)
            report_waiters(report, task, k);
    }
    if (!n)
        report_line(report, "no worker runs a task");
    return n;
}

/* Reports the functions of policies that workers were in at the last look already; returns how
 * many. */
static unsigned report_policies(struct report *report)
{
    const struct work_setup *setup = &report->pool->setup;
    struct base_named named;
    unsigned n = 0;
    for (unsigned i = 0; i < setup->threads; i++)
        if (base_mark_name(setup->marks, i, report->pool->standstill.inside[i], &named) &&
            n++ < MAX_BODIES)
            report_line(report,
                        "worker %u%s is in the %s of %s %.60s, which has not returned; the run "
                        "goes on when it does",
                        i, i ? "" : " (the main thread)", named.function, named.kind, named.policy);
    return n;
}

/* ---- Messages ---- */

/* A task that another rank runs; it stays away as long as it is looked at. */
static void report_away(struct report *report, const struct task *task, int rank)
{
    report_line(report, "%s is on rank %d, which has not sent what it leaves",
                report_words(report, task).text, rank);
    for (uint32_t i = 0; i < task->n; i++)
        report_waiters(report, task, i);
}

static void report_awaited(void *context, const struct data_key *key,
                           const struct comm_target *target, uint32_t packets)
{
    struct report *report = context;
    unsigned long long number = key->number;
    if (target->arrived == task_pieces_arrived) {
        report_line(report,
                    "contributions of %u ranks to object %u.%u, version %llu, have not come",
                    packets, key->slot, key->generation, number);
        return;
    }
    if (target->result) {
        report_away(report, target->what, target->from);
        return;
    }
    const struct data_waiter *waiter = data_version_waiters(target->what);
    report_line(report, "%s waits for object %u.%u, version %llu, which has not come from rank %d",
                waiter ? report_crowd(report, waiter).text : "nobody", key->slot, key->generation,
                number, target->from);
}

static void report_sending(void *context, const struct comm_letter *send)
{
    const struct task *task = send->sender;
    if (task->type != TASK_SEND && task->type != TASK_PIECES)
        return; /* report_away names tasks that another rank runs */
    report_line(
        context, "object %u.%u, version %llu, is on its way to rank %d, which has not taken it",
        send->key.slot, send->key.generation, (unsigned long long)send->key.number, send->to);
}

static void report_channel(void *context, const struct comm_channel *channel)
{
    struct report *report = context;
    const struct task_graph *graph = report->pool->setup.graph;
    if (channel->sends) {
        report_line(
            report,
            "a recorded graph's message to rank %d waits until that rank has taken an earlier one",
            channel->peer);
        return;
    }
    unsigned more;
    const struct task *task = plan_channel_waits(channel, &more);
    struct words words = {"a task of duite"};
    if (task)
        snprintf(words.text, sizeof words.text, "kernel %.60s", graph->kernels[task->kernel]->name);
    words_add_more(&words, more);
    report_line(report, "%s of a recorded graph waits for a message that has not come from rank %d",
                words.text, channel->peer);
}

/* ---- Events ---- */

static void report_event(void *context, const struct task *task, duite_event event, int requests)
{
    struct report *report = context;
    if (requests)
        report_line(report, "%s waits for %d requests of MPI that it handed over (duite_await_mpi)",
                    report_words(report, task).text, requests);
    else
        report_line(
            report,
            "%s ends when the program completes event %u.%u (duite_complete; duite_release)",
            report_words(report, task).text, event.slot, event.generation);
}

/* ---- All of it ---- */

/* Reports the call in which the main program waits, if it does. */
static bool report_main(struct report *report, double seconds)
{
    struct work_waits *waits = &report->pool->standstill.waits;
    const char *call = atomic_load(&waits->call);
    const char *what = atomic_load(&waits->what);
    char object[80];
    if (!what)
        snprintf(object, sizeof object, "object %u.%u, version %llu", atomic_load(&waits->slot),
                 atomic_load(&waits->generation), (unsigned long long)atomic_load(&waits->number));
    report_line(
        report,
        "%s waits for %s, and for %.3g s no task of this rank began or ended and no message came",
        call ? call : "the main program",
        !call  ? "a policy's function"
        : what ? what
               : object,
        seconds);
    return call;
}

static uint64_t report_unfinished(const struct work_pool *pool)
{
    uint64_t left = atomic_load(&pool->standstill.waits.tasks);
    for (unsigned i = 0; i < pool->setup.threads; i++)
        left -= atomic_load(&pool->queues.worker[i].counts.over) -
                atomic_load(&pool->queues.worker[i].counts.more);
    return left;
}

static void standstill_report(struct work_pool *pool, double seconds)
{
    struct report report = {.pool = pool};
    const struct comm_looker looker = {.context = &report,
                                       .awaited = report_awaited,
                                       .sending = report_sending,
                                       .channel = report_channel};
    pthread_mutex_lock(&pool->standstill.lock);
    const bool waits = report_main(&report, seconds);
    const unsigned policies = report_policies(&report);
    const unsigned bodies = policies + report_bodies(&report, report_hold_workers(pool));
    const unsigned before = report.lines;
    const bool looked = !pool->setup.comm || comm_look(pool->setup.comm, &looker);
    task_events_look(pool->setup.graph, report_event, &report);
    const uint64_t refused = pool->setup.comm ? comm_refused(pool->setup.comm) : 0;
    if (refused)
        report_line(&report, "%llu results of tasks on other ranks named no delegated task",
                    (unsigned long long)refused);
    const uint64_t left = waits ? report_unfinished(pool) : 0;
    if (waits)
        report_line(&report, "unfinished tasks of this rank: %llu", (unsigned long long)left);
    if (looked && left && !bodies && report.lines == before + 1 && !report.left_out)
        report_line(&report,
                    "they wait for nothing that duite knows of: a body may have written beyond its "
                    "objects and overwritten duite's memory; run again with DUITE_CHECK=accesses "
                    "in the environment, which names such a body");
    atomic_store_explicit(&pool->watched, 0, memory_order_release);
    pthread_mutex_unlock(&pool->standstill.lock);
    if (report.left_out)
        snprintf(report.text + report.length, sizeof report.text - report.length,
                 "duite: rank %d: and %u more lines like these\n", pool->setup.graph->rank,
                 report.left_out);
    base_report(report.text);
}

/* ---- Looks ---- */

static bool standstill_look(void *context)
{
    struct work_pool *pool = context;
    struct work_standstill *standstill = &pool->standstill;
    const struct base_marks *marks = pool->setup.marks;
    const double now = base_seconds();
    const bool waits = atomic_load(&standstill->waits.call);
    const uint64_t main = waits ? 0 : base_mark_inside(marks, 0);
    const uint64_t moved = pool_movement(pool) + main;
    if (moved != standstill->before || !(waits || main % 256 != BASE_NO_CALL)) {
        standstill->before = moved;
        standstill->since = now;
        standstill->reported = false;
    } else if (!standstill->reported && now - standstill->since >= standstill->patience) {
        standstill_report(pool, now - standstill->since);
        standstill->reported = true;
        standstill->patience *= 2;
    }
    for (unsigned i = 0; i < pool->setup.threads; i++)
        standstill->inside[i] = base_mark_inside(marks, i);
    return true;
}

int work_standstill_start(struct work_pool *pool, double seconds)
{
    struct work_standstill *standstill = &pool->standstill;
    pthread_mutex_init(&standstill->lock, NULL);
    if (seconds <= 0)
        return DUITE_OK;
    standstill->inside = base_alloc_zero(pool->setup.threads * sizeof *standstill->inside);
    if (!standstill->inside)
        return base_no_memory("the standstill report");
    standstill->patience = seconds;
    standstill->since = base_seconds();
    standstill->before = pool_movement(pool);
    standstill->look = (struct base_look){
        .look = standstill_look, .context = pool, .seconds = seconds > 8e-3 ? seconds / 8 : 1e-3};
    return base_monitor_add(pool->setup.monitor, &standstill->look);
}

void work_standstill_stop(struct work_pool *pool)
{
    base_monitor_remove(pool->setup.monitor, &pool->standstill.look);
    base_free(pool->standstill.inside);
    pthread_mutex_destroy(&pool->standstill.lock);
}

void work_hold_reports(struct work_pool *pool)
{
    pthread_mutex_lock(&pool->standstill.lock);
}

void work_let_reports_go(struct work_pool *pool)
{
    pthread_mutex_unlock(&pool->standstill.lock);
}

void work_standstill_passes(struct work_pool *pool)
{
    pthread_mutex_lock(&pool->standstill.lock);
    pthread_mutex_unlock(&pool->standstill.lock);
}
