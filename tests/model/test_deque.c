/* The deque (runtime/queue/queue.c): whatever its owner and thieves do at the same time, each
 * task that was pushed is taken exactly once. Rings of one or two slots: slots are used again and
 * rings outgrown at once. */
#include "tests/model/runtime.h"

static unsigned allocations; /* that still succeed */

#define base_alloc(size) (allocations-- ? explore_alloc(size) : NULL)

#include "runtime/queue/queue.c"
#include "runtime/task/task.h"

enum { TASKS = 12 };

/* A small program: what the owner and up to three thieves do, one letter each: P push, T take the
 * newest, O take the oldest. */
struct play {
    const char *name;
    uint64_t slots;
    int there; /* tasks, before they start */
    const char *script[4];
    unsigned rings; /* there is memory for; 0: as many as they want */
};

static const struct play *play;
static struct {
    struct queue_deque deque;
    struct task *task[TASKS];
    int taken[TASKS], pushed;
} its;

static void got(const struct task *task)
{
    for (int i = 0; task && i < TASKS; i++)
        if (its.task[i] == task)
            explore_check(++its.taken[i] == 1);
}

static void run(void)
{
    bool again;
    for (const char *letter = play->script[explore_self()]; *letter; letter++) {
        if (*letter == 'P')
            its.pushed += deque_push(&its.deque, its.task[its.pushed]);
        else if (*letter == 'T')
            got(deque_take_newest(&its.deque));
        else
            got(queue_deque_take_oldest(&its.deque, &again));
    }
}

static void start(void)
{
    memset(&its, 0, sizeof its);
    allocations = play->rings ? play->rings : TASKS;
    for (int i = 0; i < TASKS; i++)
        its.task[i] = explore_alloc(sizeof *its.task[i]);
    queue_deque_start(&its.deque, play->slots);
    for (int i = 0; i < play->there; i++)
        deque_push(&its.deque, its.task[its.pushed++]);
}

/* Tasks that were not taken are still there, and nothing else. */
static void end(void)
{
    struct task *task;
    while ((task = deque_take_newest(&its.deque)))
        got(task);
    for (int i = 0; i < TASKS; i++)
        explore_check(its.taken[i] == (i < its.pushed));
    queue_deque_stop(&its.deque);
}

static struct explore_case small(const struct play *of)
{
    struct explore_case new = {.name = of->name, .start = start, .end = end};
    for (int i = 0; i < 4 && of->script[i]; i++)
        new.thread[i] = run;
    play = of;
    return new;
}

static const struct play plays[] = {
    {"push and take", 2, 0, {"PT", "O"}, 0},
    {"push two, take two", 2, 0, {"PPTT", "OO"}, 0},
    {"push, take, again", 1, 0, {"PTPT", "OO"}, 0},
    {"the last one", 2, 1, {"T", "O", "O"}, 0},
    {"the last two", 2, 2, {"TT", "OO", "O"}, 0},
    {"the last three", 4, 3, {"TT", "OO", "O"}, 0},
    {"growth", 1, 0, {"PPT", "OO"}, 0},
    {"growth when full", 2, 2, {"PPTT", "OO"}, 0},
    {"growth twice", 1, 0, {"PPPT", "OO"}, 0},
    {"slots used again", 2, 1, {"TPPT", "OO"}, 0},
    {"oldest first", 2, 0, {"PPOPO", "O"}, 0},
    {"no memory to grow", 1, 0, {"PPT", "O"}, 1},
    {"growth, two thieves", 1, 0, {"PPTPT", "OO", "O"}, 0},
    {"two thieves", 2, 0, {"PPTPTT", "OO", "O"}, 0},
};

static const struct play deep[] = {
    {"growth, two busy thieves", 1, 0, {"PPTPPTT", "OO", "O"}, 0},
    {"slots used again, two busy thieves", 2, 1, {"PTTPTPPT", "OO", "O"}, 0},
    {"three thieves", 2, 1, {"PTPT", "O", "O", "O"}, 0},
    {"oldest first, two thieves", 2, 0, {"PPOPOPO", "OO", "O"}, 0},
};

/* One operation of each function weakened, and a play that shows it. */
static const struct {
    struct explore_plant plant;
    struct play play;
} plants[] = {
    {{"deque_take_newest", "&deque->newest", EXPLORE_RELAX},
     {"the claim is seen late", 2, 2, {"TT", "OO"}, 0}},
    {{"deque_take_newest", "&deque->oldest", EXPLORE_RELAX},
     {"the last one is not contended for", 2, 1, {"T", "O"}, 0}},
    {{"queue_deque_take_oldest", "&deque->oldest", EXPLORE_RELAX},
     {"thieves do not look at one another", 2, 1, {"", "O", "O"}, 0}},
    {{"deque_show", "&deque->newest", EXPLORE_RELAX},
     {"a task is announced before it is there", 2, 0, {"P", "O"}, 0}},
    {{"ring_grow", "&deque->ring", EXPLORE_RELAX},
     {"a ring is shown before it is filled", 1, 1, {"P", "O"}, 0}},
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
