/* Threads as coroutines and memory as they see it. Between two steps exactly one context runs; a
 * thread that is not running has said what its next step is. Memory changes in perform() and
 * flush() only, so one execution depends on nothing but the actors chosen. */
#include "tests/model/machine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <ucontext.h>

#if defined(__SANITIZE_ADDRESS__)
#define WITH_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WITH_ADDRESS_SANITIZER 1
#endif
#endif
#ifdef WITH_ADDRESS_SANITIZER
#include <sanitizer/asan_interface.h>
#else
#define ASAN_UNPOISON_MEMORY_REGION(address, size) ((void)(address), (void)(size))
#endif

enum { STACK = 256 << 10, BUFFER = 64, ARENA = 1 << 20 };

struct store {
    struct explore_place place;
    uint64_t value;
    bool release;
    unsigned number;
    int origin; /* the thread's step it followed */
};

struct thread {
    ucontext_t context;
    void (*body)(void);
    void *(*start)(void *); /* in place of body, with argument */
    void *argument;
    bool over;
    uint64_t gone;    /* 1 once it is over */
    int origin, last; /* steps: of its creator, its own */
    unsigned timeouts;
    struct machine_step next;
    struct store buffer[BUFFER]; /* oldest first */
    unsigned n_stores, stores;   /* in the buffer, ever */
};

static struct {
    struct thread thread[EXPLORE_THREADS];
    unsigned n_threads;
    struct {
        unsigned thread;
        void *address;
    } flusher[MACHINE_ACTORS - EXPLORE_THREADS];
    unsigned n_flushers;
    int current; /* thread, or -1: none, operations are done at once */
    ucontext_t home;
    const struct explore_case *small;
    struct explore_plant plant;
    bool planted;
    char wrong[256];
    size_t used;
} machine = {.current = -1};

static unsigned char stacks[EXPLORE_THREADS][STACK] __attribute__((aligned(64)));
static unsigned char arena[ARENA] __attribute__((aligned(64)));

void *explore_alloc(size_t size)
{
    size_t lines = (size + 63) / 64 * 64;
    if (size > ARENA || lines > ARENA - machine.used) {
        fprintf(stderr, "a case needs more memory than the explorer has\n");
        exit(1);
    }
    void *memory = arena + machine.used;
    machine.used += lines;
    return memset(memory, 0, lines);
}

/* ---- Memory ---- */

static uint64_t memory_get(const struct explore_place *place)
{
    uint64_t value = 0;
    memcpy(&value, place->address, place->size); /* little endian */
    return value;
}

static void memory_set(const struct explore_place *place, uint64_t value)
{
    memcpy(place->address, &value, place->size);
}

/* The thread's oldest (or newest) store to that place in its buffer; -1: none. */
static int buffered(const struct thread *thread, const void *address, bool newest)
{
    int found = -1;
    for (unsigned i = 0; i < thread->n_stores && (newest || found < 0); i++)
        if (thread->buffer[i].place.address == address)
            found = (int)i;
    return found;
}

static uint64_t perform(struct thread *thread, const struct machine_step *step)
{
    const struct explore_place *place = &step->place;
    if (!place->address)
        return 0;
    int own = buffered(thread, place->address, true);
    uint64_t old = own >= 0 ? thread->buffer[own].value : memory_get(place);
    if (step->kind == MACHINE_EXCHANGE || (step->kind == MACHINE_COMPARE && old == step->expected))
        memory_set(place, step->operand);
    else if (step->kind == MACHINE_ADD)
        memory_set(place, old + step->operand);
    return old;
}

static uint64_t flush(struct thread *thread, const void *address)
{
    unsigned i = (unsigned)buffered(thread, address, false);
    struct store store = thread->buffer[i];
    memory_set(&store.place, store.value);
    thread->n_stores--;
    memmove(&thread->buffer[i], &thread->buffer[i + 1],
            (thread->n_stores - i) * sizeof thread->buffer[0]);
    return store.value;
}

/* ---- Actors ---- */

unsigned machine_actors(void)
{
    return EXPLORE_THREADS + machine.n_flushers;
}

static bool thread_ready(const struct thread *thread)
{
    const struct machine_step *next = &thread->next;
    if (thread->over || (next->drained && thread->n_stores))
        return false;
    if (next->kind == MACHINE_AWAIT)
        return memory_get(&next->place) != next->expected;
    return !next->writes || buffered(thread, next->place.address, false) < 0;
}

bool machine_ready(unsigned actor)
{
    if (actor < EXPLORE_THREADS)
        return actor < machine.n_threads && thread_ready(&machine.thread[actor]);
    unsigned i = actor - EXPLORE_THREADS;
    const struct thread *thread = &machine.thread[machine.flusher[i].thread];
    int store = buffered(thread, machine.flusher[i].address, false);
    return store == 0 || (store > 0 && !thread->buffer[store].release);
}

void machine_peek(unsigned actor, struct machine_step *step)
{
    if (actor < EXPLORE_THREADS) {
        const struct thread *thread = &machine.thread[actor];
        *step = thread->next;
        step->origin = thread->last < 0 ? thread->origin : -1;
        step->actor = step->thread = actor;
        if (step->kind == MACHINE_COMPARE && memory_get(&step->place) != step->expected)
            step->writes = false;
        return;
    }
    unsigned i = actor - EXPLORE_THREADS;
    const struct thread *thread = &machine.thread[machine.flusher[i].thread];
    const struct store *store =
        &thread->buffer[buffered(thread, machine.flusher[i].address, false)];
    *step = (struct machine_step){.kind = MACHINE_FLUSH,
                                  .place = store->place,
                                  .actor = actor,
                                  .thread = machine.flusher[i].thread,
                                  .release = store->release,
                                  .writes = true,
                                  .number = store->number,
                                  .origin = store->origin};
}

/* ---- Who runs ---- */

static ucontext_t *context_of(int thread)
{
    return thread < 0 ? &machine.home : &machine.thread[thread].context;
}

static void go_to(int thread)
{
    int from = machine.current;
    if (thread == from)
        return;
    machine.current = thread;
    swapcontext(context_of(from), context_of(thread));
}

/* Steps until the running thread's own was done, or the execution ended. */
static void schedule(void)
{
    for (;;) {
        int index, actor = search_next(machine.current, &index);
        if (actor < 0) {
            go_to(-1);
            return;
        }
        if (actor >= EXPLORE_THREADS) {
            unsigned i = (unsigned)actor - EXPLORE_THREADS;
            search_result(index, flush(&machine.thread[machine.flusher[i].thread],
                                       machine.flusher[i].address));
            continue;
        }
        struct thread *thread = &machine.thread[actor];
        thread->last = index;
        thread->next.result = perform(thread, &thread->next);
        search_result(index, thread->next.result);
        go_to(actor);
        return;
    }
}

uint64_t machine_step(struct machine_step next)
{
    if (machine.current < 0)
        return perform(&(struct thread){0}, &next);
    struct thread *thread = &machine.thread[machine.current];
    thread->next = next;
    schedule();
    return thread->next.result;
}

static void thread_main(void)
{
    struct thread *thread = &machine.thread[machine.current];
    if (thread->start)
        thread->start(thread->argument);
    else
        thread->body();
    explore_exchange(EXPLORE_PLACE(&thread->gone), 1, memory_order_seq_cst);
    thread->over = true;
    schedule();
}

static struct thread *add_thread(void)
{
    if (machine.n_threads == EXPLORE_THREADS) {
        fprintf(stderr, "a case needs more than %d threads\n", EXPLORE_THREADS);
        exit(1);
    }
    unsigned index = machine.n_threads++;
    struct thread *thread = &machine.thread[index];
    thread->over = false;
    thread->gone = 0;
    thread->body = NULL;
    thread->start = NULL;
    thread->n_stores = thread->stores = thread->timeouts = 0;
    thread->last = -1;
    thread->origin = machine.current < 0 ? -1 : machine.thread[machine.current].last;
    thread->next = (struct machine_step){.kind = MACHINE_BEGIN};
    ASAN_UNPOISON_MEMORY_REGION(stacks[index], STACK);
    thread->context.uc_stack.ss_sp = stacks[index];
    thread->context.uc_stack.ss_size = STACK;
    makecontext(&thread->context, thread_main, 0);
    return thread;
}

static void add_flusher(unsigned thread, void *address)
{
    unsigned i = 0;
    while (i < machine.n_flushers &&
           (machine.flusher[i].thread != thread || machine.flusher[i].address != address))
        i++;
    if (i == machine.n_flushers) {
        if (++machine.n_flushers > MACHINE_ACTORS - EXPLORE_THREADS)
            explore_check_that(false, "room for more places that are written to");
        machine.flusher[i].thread = thread;
        machine.flusher[i].address = address;
    }
}

void machine_store(struct explore_place place, uint64_t value, bool release)
{
    if (machine.current < 0) {
        memory_set(&place, value);
        return;
    }
    struct thread *thread = &machine.thread[machine.current];
    explore_check_that(thread->n_stores < BUFFER, "room in the buffer");
    add_flusher((unsigned)machine.current, place.address);
    thread->buffer[thread->n_stores++] = (struct store){.place = place,
                                                        .value = value,
                                                        .release = release,
                                                        .number = thread->stores++,
                                                        .origin = thread->last};
}

bool machine_buffers(void)
{
    return machine.current >= 0 && machine.thread[machine.current].n_stores;
}

bool machine_time_left(void)
{
    return machine.current == 0 && machine.thread[0].timeouts++ < machine.small->timeouts;
}

int machine_create(void *(*start)(void *), void *argument)
{
    struct thread *thread = add_thread();
    thread->start = start;
    thread->argument = argument;
    return (int)(thread - machine.thread);
}

int machine_self(void)
{
    return machine.current;
}

uint64_t *machine_gone(int thread)
{
    return &machine.thread[thread].gone;
}

enum explore_change machine_change(const char *function, const char *what)
{
    const struct explore_plant *plant = &machine.plant;
    if (!plant->change || strcmp(plant->function, function) || strcmp(plant->what, what))
        return EXPLORE_NOTHING;
    machine.planted = true;
    return plant->change;
}

bool explore_planted(const char *function, const char *what)
{
    return machine_change(function, what) != EXPLORE_NOTHING;
}

bool machine_planted(void)
{
    return machine.planted;
}

void explore_check_that(bool fine, const char *what)
{
    if (fine || machine.wrong[0])
        return;
    snprintf(machine.wrong, sizeof machine.wrong, "not true: %s", what);
    go_to(-1);
}

const char *machine_wrong(void)
{
    return machine.wrong;
}

static enum machine_end outcome(void)
{
    bool alive = false, stuck = false;
    if (machine.wrong[0])
        return MACHINE_WRONG;
    for (unsigned i = 0; i < machine_actors(); i++)
        if (machine_ready(i))
            return MACHINE_CUT;
    for (unsigned i = 0; i < machine.n_threads; i++) {
        stuck = stuck || !machine.thread[i].over;
        alive = alive || (!machine.thread[i].over && machine.thread[i].next.timed);
    }
    if (stuck && !(machine.small->served && machine.thread[0].over))
        return alive ? MACHINE_ALIVE : MACHINE_STUCK;
    if (machine.small->end)
        machine.small->end();
    return machine.wrong[0] ? MACHINE_WRONG : MACHINE_OVER;
}

enum machine_end machine_run(const struct explore_case *small, struct explore_plant plant)
{
    static bool before;
    for (int i = 0; i < EXPLORE_THREADS && !before; i++)
        getcontext(&machine.thread[i].context);
    before = true;
    machine.n_threads = machine.n_flushers = 0;
    machine.current = -1;
    machine.small = small;
    machine.plant = plant;
    machine.planted = false;
    machine.wrong[0] = '\0';
    machine.used = 0;
    if (small->start)
        small->start();
    for (int i = 0; i < EXPLORE_THREADS && small->thread[i]; i++)
        add_thread()->body = small->thread[i];
    schedule();
    return outcome();
}
