/* Versions of an object (runtime/data/version.h, runtime/task/depend.c): a reader sees all that
 * its producer wrote, whether it waits or comes later, and nobody overwrites or frees the bytes
 * before each reader has done with them.
 *
 * The explorer lets stores lag, not loads. So what a producer writes and what a reader does with
 * the bytes are both relaxed stores here: an order of the real operations that is too weak lets
 * them arrive late. A ready task runs at once, on the thread that made it ready. */
#include "tests/model/runtime.h"

static void given(const void *memory);

#define base_pool_give(memory, size) ((void)(size), given(memory))

#include "runtime/data/version.c"
#define task_ready ready
#include "runtime/task/depend.c"

enum { READERS = 2, WRITER = READERS, TASKS = READERS + 1 };

static struct {
    struct task_graph graph;
    struct data_object object;
    struct data_version *version;
    _Atomic int written, done[READERS]; /* by the producer, by each reader */
    int ran[TASKS], freed;
} its;

static void all_done(void)
{
    for (int i = 0; i < READERS; i++)
        explore_check(atomic_load_explicit(&its.done[i], memory_order_relaxed));
}

static void given(const void *memory)
{
    if (memory != its.version)
        return;
    explore_check(++its.freed == 1);
    all_done();
}

static void read_version(int i)
{
    explore_check(++its.ran[i] == 1);
    explore_check(atomic_load_explicit(&its.written, memory_order_relaxed));
    atomic_store_explicit(&its.done[i], 1, memory_order_relaxed);
    ready_release(&its.graph, NULL, its.version);
}

void ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    (void)graph;
    (void)worker;
    if (task->number < WRITER) {
        explore_check(task->access[0].waiter.version == its.version);
        read_version((int)task->number);
        return;
    }
    explore_check(++its.ran[WRITER] == 1);
    all_done(); /* it overwrites the bytes from here on */
}

/* ---- The threads ---- */

static void produce(void)
{
    atomic_store_explicit(&its.written, 1, memory_order_relaxed);
    ready_publish(&its.graph, NULL, its.version);
}

static struct task *new_task(int number)
{
    struct task *task = task_make(&its.graph.root, TASK_BODY, 1, 0);
    task->number = (uint64_t)number;
    return task;
}

static void fork_reader(int i)
{
    struct task *task = new_task(i);
    task->access[0].waiter.mode = DUITE_R;
    ready_take(&its.graph, NULL, task, 1 + data_version_read(its.version, &task->access[0].waiter));
}

static void fork_writer(void)
{
    uint32_t done = 0;
    struct task *task = new_task(WRITER);
    task->access[0].waiter.mode = DUITE_W;
    its.object.current = its.version;
    task_wait(&its.graph.root, task, 0, &its.object, &done);
    ready_take(&its.graph, NULL, task, done + 1);
}

static void fork_readers(void)
{
    for (int i = 0; i < READERS; i++)
        fork_reader(i);
}

static void fork_all(void)
{
    fork_readers();
    fork_writer();
}

static void read_0(void)
{
    read_version(0);
}

static void read_1(void)
{
    read_version(1);
}

/* The object gives the version up: whoever is the last to release it frees it. */
static void forget(void)
{
    task_forget(&its.graph, NULL, &its.object);
}

/* ---- Before and after ---- */

static void start(void)
{
    memset(&its, 0, sizeof its);
    its.object = (struct data_object){.type = DUITE_F64, .max = 1};
    its.object.current = its.version = data_object_version(&its.object);
}

/* The value is there, and both readers hold it. */
static void start_read(void)
{
    start();
    produce();
    for (int i = 0; i < READERS; i++)
        data_version_hold(its.version);
}

static void end_read(void)
{
    for (int i = 0; i < READERS; i++)
        explore_check(its.ran[i] == 1);
    explore_check(!its.freed);
}

static void end_freed(void)
{
    for (int i = 0; i < READERS; i++)
        explore_check(its.ran[i] == 1);
    explore_check(its.freed == 1);
}

static void end_overwritten(void)
{
    end_freed();
    explore_check(its.ran[WRITER] == 1);
}

static const struct explore_case read_only = {.name = "produced and read",
                                              .start = start,
                                              .thread = {produce, fork_readers},
                                              .end = end_read};
static const struct explore_case all_three = {.name = "produced, read and overwritten",
                                              .start = start,
                                              .thread = {produce, fork_all},
                                              .end = end_overwritten};
static const struct explore_case overwritten = {.name = "overwritten after two readers",
                                                .start = start_read,
                                                .thread = {read_0, read_1, fork_writer},
                                                .end = end_overwritten};
static const struct explore_case forgotten = {.name = "freed after two readers",
                                              .start = start_read,
                                              .thread = {read_0, read_1, forget},
                                              .end = end_freed};

int main(int argc, char **argv)
{
    const struct explore_plant produced = {"data_version_produced", "&version->waiters",
                                           EXPLORE_REORDER},
                               release = {"data_version_release", "&version->holds",
                                          EXPLORE_REORDER};
    explore_begin(argc, argv);
    explore_passes(&read_only);
    explore_passes(&all_three);
    explore_passes(&overwritten);
    explore_passes(&forgotten);
    explore_finds(&read_only, produced);
    explore_finds(&all_three, produced);
    explore_finds(&all_three, release);
    explore_finds(&overwritten, release);
    explore_finds(&forgotten, release);
    return explore_end();
}
