/* The queue of ready tasks (runtime/queue/queue.c, over the real deque): whatever its owner,
 * those who put tasks into its inbox and thieves do at the same time, each task is taken exactly
 * once; of the shared queue likewise, whoever holds its token. */
#include "tests/model/runtime.h"

#include <ctype.h>

static unsigned allocations; /* that still succeed */

#define base_alloc(size) (allocations-- ? explore_alloc(size) : NULL)

#include "runtime/queue/queue.c"
#include "runtime/task/task.h"

enum { THREADS = 3, EACH = 3, TASKS = THREADS * EACH }; /* EACH: tasks that a thread makes */

/* The threads' steps, one letter each. The first owns the queue: P push, T take the newest, O the
 * oldest, H the highest. Others: p put, S steal. Any thread of a shared queue: p put, t take the
 * newest, o the oldest, h the highest. */
struct play {
    const char *name;
    const char *script[THREADS + 1];
    bool no_memory; /* the ring has one slot and stays so */
};

static const struct play *play;
static struct {
    struct queue queue, own[THREADS]; /* own: the thieves' */
    struct task *task[TASKS];
    int taken[TASKS], made[THREADS];
} its;

static struct task *make(unsigned self)
{
    return its.task[self * EACH + (unsigned)its.made[self]++];
}

static bool got(const struct task *task)
{
    for (int i = 0; i < TASKS && task; i++)
        if (its.task[i] == task)
            explore_check(++its.taken[i] == 1);
    return task;
}

static void act(char letter, unsigned self)
{
    struct queue *queue = &its.queue;
    static const char ends[] = {[DUITE_NEWEST] = 't', [DUITE_OLDEST] = 'o', [DUITE_HIGHEST] = 'h'};
    const char *taking = memchr(ends, tolower(letter), sizeof ends);
    duite_end end = taking ? (duite_end)(taking - ends) : DUITE_NEWEST;
    if (letter == 'P')
        queue_push(queue, make(self));
    else if (letter == 'p')
        queue_put(queue, make(self));
    else if (taking && isupper(letter))
        got(queue_take(queue, end));
    else if (taking)
        got(queue_take_shared(queue, end));
    else
        got(queue_steal(queue, &its.own[self]));
}

static void run(void)
{
    unsigned self = (unsigned)explore_self();
    for (const char *letter = play->script[self]; *letter; letter++)
        act(*letter, self);
}

static void start_queue(struct queue *queue)
{
    queue_start(queue, task_rank);
    if (play->no_memory)
        queue_deque_start(&queue->deque, 1);
}

static void start(void)
{
    memset(&its, 0, sizeof its);
    allocations = 2 * (THREADS + 1);
    start_queue(&its.queue);
    for (int i = 0; i < THREADS; i++)
        start_queue(&its.own[i]);
    for (int i = 0; i < TASKS; i++)
        its.task[i] = explore_alloc(sizeof *its.task[i]);
    allocations = play->no_memory ? 0 : 9;
}

/* Tasks that were not taken are still there, and nothing else. */
static void end(void)
{
    while (got(queue_take(&its.queue, DUITE_NEWEST)))
        continue;
    for (int i = 0; i < THREADS; i++)
        while (got(queue_take(&its.own[i], DUITE_OLDEST)))
            continue;
    for (int i = 0; i < TASKS; i++)
        explore_check(its.taken[i] == (i % EACH < its.made[i / EACH]));
}

static struct explore_case small(const struct play *of)
{
    struct explore_case new = {.name = of->name, .start = start, .end = end};
    for (int i = 0; of->script[i]; i++)
        new.thread[i] = run;
    play = of;
    return new;
}

static const struct play plays[] = {
    {"two put, the owner takes", {"TT", "p", "p"}, false},
    {"one puts two, the owner takes", {"TOT", "pp"}, false},
    {"the inbox is stolen", {"T", "pp", "S"}, false},
    {"a busy owner", {"PPT", "p", "S"}, false},
    {"two thieves", {"P", "pS", "S"}, false},
    {"a full ring", {"PPTT", "p"}, true},
    {"a full ring and a thief", {"PPT", "S"}, true},
    {"shared, newest first", {"t", "pp", "t"}, false},
    {"shared, oldest first", {"po", "o", "p"}, false},
    {"by priority", {"PHH", "p"}, false},
    {"by priority and otherwise", {"PPHT", "S"}, false},
    {"by priority, with a thief", {"PPH", "SS"}, false},
    {"shared, by priority", {"ph", "ph"}, false},
    {"shared, by priority and otherwise", {"ph", "po"}, false},
};

static const struct play deep[] = {
    {"a busy owner, more put", {"PTT", "pp", "S"}, false},
    {"a full ring, put and stolen", {"PPT", "p", "S"}, true},
    {"shared by three", {"pt", "pt", "pt"}, false},
};

static const struct {
    struct explore_plant plant;
    struct play play;
} plants[] = {
    {{"queue_put", "&queue->inbox", EXPLORE_RELAX},
     {"those who put do not look at one another", {"", "p", "p"}, false}},
    {{"inbox_take_all", "&queue->inbox", EXPLORE_DROP},
     {"the inbox is not looked at", {"T", "pp"}, false}},
    {{"queue_take_shared", "&queue->token", EXPLORE_DROP},
     {"all hold the token", {"pt", "", "pt"}, false}},
    {{"queue_take_shared", "&queue->token", EXPLORE_RELAX},
     {"the token is taken late", {"pt", "", "pt"}, false}},
    {{"queue_heap_enter", "&heap->busy", EXPLORE_DROP},
     {"all enter the heap", {"PPHH", "S"}, false}},
    {{"queue_heap_leave", "&heap->busy", EXPLORE_RELAX},
     {"the heap is left early", {"PPHH", "S"}, false}},
};

int main(int argc, char **argv)
{
    struct explore_case now;
    explore_begin(argc, argv);
    for (size_t i = 0; i < sizeof plays / sizeof plays[0]; i++)
        explore_passes((now = small(&plays[i]), &now));
    for (size_t i = 0; i < sizeof deep / sizeof deep[0] && explore_deep(); i++)
        explore_passes((now = small(&deep[i]), &now));
    for (size_t i = 0; i < sizeof plants / sizeof plants[0]; i++)
        explore_finds((now = small(&plants[i].play), &now), plants[i].plant);
    return explore_end();
}
