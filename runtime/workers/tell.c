/* What is told of a standstill. Bodies that run, and messages that are awaited, are what all other
 * tasks wait for; both are held where they are during the look (work_leaves, comm_look), and with
 * them the tasks that wait for them. */
#include "runtime/offload/away.h"
#include "runtime/workers/internal.h"

#include <linux/membarrier.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { MOST_LINES = 20, MOST_BODIES = 8 };

struct page {
    struct work_pool *pool;
    unsigned lines, left_out;
    size_t length;
    char text[MOST_LINES * 256];
};

__attribute__((format(printf, 2, 3))) static void line(struct page *page, const char *format, ...)
{
    if (page->lines >= MOST_LINES - 1) {
        page->left_out++;
        return;
    }
    va_list list;
    char text[230];
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    page->length += (size_t)snprintf(page->text + page->length, sizeof page->text - page->length,
                                     "duite: rank %d: %s\n", page->pool->setup.graph->rank, text);
    page->lines++;
}

/* A task in words. */
struct words {
    char text[120];
};

static struct words words_of(const struct page *page, const struct task *task)
{
    const struct task_graph *graph = page->pool->setup.graph;
    struct words words = {"a task of duite (a get, a sum or a message)"};
    if (task->kernel < graph->n_kernels)
        snprintf(words.text, sizeof words.text, "task %llu (kernel %.60s)",
                 (unsigned long long)task->number, graph->kernels[task->kernel]->name);
    return words;
}

static void and_more(struct words *words, unsigned more)
{
    size_t length = strlen(words->text);
    if (more)
        snprintf(words->text + length, sizeof words->text - length, " (and %u more)", more);
}

/* ---- Bodies ---- */

/* What a worker runs from now until the lock is let go; false if that cannot be known. */
static bool hold_workers(struct work_pool *pool)
{
    atomic_store_explicit(&pool->watched, 1, memory_order_seq_cst);
    syscall(SYS_membarrier, MEMBARRIER_CMD_REGISTER_PRIVATE_EXPEDITED, 0, 0);
    return !syscall(SYS_membarrier, MEMBARRIER_CMD_PRIVATE_EXPEDITED, 0, 0);
}

/* The first in fork order of the program's tasks among some, and how many more there are. */
static struct words crowd(const struct page *page, const struct data_waiter *waiter)
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
    struct words words = words_of(page, first);
    and_more(&words, more);
    return words;
}

static void tell_waiters(struct page *page, const struct task *task, uint32_t i)
{
    const struct task_access *access = &task->access[i];
    bool writes = access->waiter.mode == DUITE_W || access->waiter.mode == DUITE_RW;
    const struct data_waiter *waiter = writes ? data_version_waiters(access->out) : NULL;
    if (waiter)
        line(page, "%s waits for what %s writes to parameter %u", crowd(page, waiter).text,
             words_of(page, task).text, i);
}

/* Returns how many run. */
static unsigned tell_bodies(struct page *page, bool held)
{
    struct work_pool *pool = page->pool;
    unsigned n = 0;
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        const struct task *task = atomic_load_explicit(&pool->worker[i].runs, memory_order_acquire);
        if (!task)
            continue;
        if (n++ >= MOST_BODIES)
            page->left_out++;
        else
            line(page, "worker %u%s runs %s", i, i ? "" : " (the main thread)",
                 held ? words_of(page, task).text : "a task");
    }
    for (unsigned i = 0; i < pool->setup.threads && held; i++) {
        const struct task *task = atomic_load_explicit(&pool->worker[i].runs, memory_order_acquire);
        for (uint32_t k = 0; task && task->kind == TASK_BODY && k < task->n; k++)
            tell_waiters(page, task, k);
    }
    if (!n)
        line(page, "no worker runs a task");
    return n;
}

/* ---- Messages ---- */

static void tell_awaited(void *context, const struct data_key *key,
                         const struct comm_target *target, uint32_t packets)
{
    struct page *page = context;
    unsigned long long number = key->number;
    if (target->sum) {
        line(page, "contributions of %u ranks to object %u.%u, version %llu, have not come",
             packets, key->slot, key->generation, number);
        return;
    }
    const struct data_waiter *waiter = data_version_waiters(target->version);
    line(page, "%s waits for object %u.%u, version %llu, which has not come from rank %d",
         waiter ? crowd(page, waiter).text : "nobody", key->slot, key->generation, number,
         target->from);
}

static void tell_sending(void *context, const struct task_send *send)
{
    line(context, "object %u.%u, version %llu, is on its way to rank %d, which has not taken it",
         send->key.slot, send->key.generation, (unsigned long long)send->key.number, send->to);
}

static void tell_channel(void *context, const struct plan_channel *channel)
{
    struct page *page = context;
    const struct task_graph *graph = page->pool->setup.graph;
    if (channel->sends) {
        line(page,
             "a recorded graph's message to rank %d waits until that rank has taken an earlier one",
             channel->peer);
        return;
    }
    unsigned more;
    const struct task *task = plan_channel_waits(channel->node, &more);
    struct words words = {"a task of duite"};
    if (task)
        snprintf(words.text, sizeof words.text, "kernel %.60s", graph->kernels[task->kernel]->name);
    and_more(&words, more);
    line(page, "%s of a recorded graph waits for a message that has not come from rank %d",
         words.text, channel->peer);
}

/* A task that another rank runs; it stays away as long as it is looked at. */
static void tell_away(void *context, const struct task *task, int rank)
{
    struct page *page = context;
    line(page, "%s is on rank %d, which has not sent what it leaves", words_of(page, task).text,
         rank);
    for (uint32_t i = 0; i < task->n; i++)
        tell_waiters(page, task, i);
}

/* ---- All of it ---- */

static void tell_main(struct page *page, double seconds)
{
    struct work_waits *waits = &page->pool->watch.waits;
    const char *call = atomic_load_explicit(&waits->call, memory_order_acquire);
    const char *what = atomic_load_explicit(&waits->what, memory_order_relaxed);
    char object[80];
    if (!what)
        snprintf(object, sizeof object, "object %u.%u, version %llu",
                 atomic_load_explicit(&waits->slot, memory_order_relaxed),
                 atomic_load_explicit(&waits->generation, memory_order_relaxed),
                 (unsigned long long)atomic_load_explicit(&waits->number, memory_order_relaxed));
    line(page,
         "%s waits for %s, and for %.3g s no task of this rank began or ended and no message came",
         call ? call : "the main program", what ? what : object, seconds);
}

static uint64_t unfinished(const struct work_pool *pool)
{
    uint64_t left = atomic_load_explicit(&pool->watch.waits.tasks, memory_order_relaxed);
    for (unsigned i = 0; i < pool->setup.threads; i++)
        left -= atomic_load_explicit(&pool->worker[i].counts.over, memory_order_relaxed) -
                atomic_load_explicit(&pool->worker[i].counts.more, memory_order_relaxed);
    return left;
}

void work_tell(struct work_pool *pool, double seconds)
{
    struct page page = {.pool = pool};
    const struct comm_looker looker = {.context = &page,
                                       .awaited = tell_awaited,
                                       .sending = tell_sending,
                                       .channel = tell_channel};
    pthread_mutex_lock(&pool->watch.lock);
    tell_main(&page, seconds);
    const unsigned bodies = tell_bodies(&page, hold_workers(pool)), before = page.lines;
    const bool looked = !pool->setup.comm || comm_look(pool->setup.comm, &looker);
    offload_away_look(pool->setup.graph, tell_away, &page);
    const uint64_t left = unfinished(pool);
    line(&page, "unfinished tasks of this rank: %llu", (unsigned long long)left);
    if (looked && left && !bodies && page.lines == before + 1 && !page.left_out)
        line(&page, "they wait for nothing that duite knows of: a body may have written beyond its "
                    "objects and overwritten duite's memory; run again with DUITE_CHECK=accesses "
                    "in the environment, which names such a body");
    atomic_store_explicit(&pool->watched, 0, memory_order_release);
    pthread_mutex_unlock(&pool->watch.lock);
    if (page.left_out)
        snprintf(page.text + page.length, sizeof page.text - page.length,
                 "duite: rank %d: and %u more lines like these\n", pool->setup.graph->rank,
                 page.left_out);
    fputs(page.text, stderr);
}
