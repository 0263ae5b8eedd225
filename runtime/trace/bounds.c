/* The longest chain of bodies. The program is walked once, in the order of its forks: a task begins
 * when the values that it reads are there, and each object keeps the time of its last value. That a
 * writer waits for the readers of the value before is left out: this depends on ranks and memory,
 * and more memory mends it. So no schedule on any number of workers is shorter than the chain. */
#include "runtime/trace/sums.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

/* When a value is there, and which task wrote it: its place among the links, from 1 on; 0: none. */
struct chain_moment {
    double end;
    size_t link;
};

struct chain_object {
    struct chain_moment value, sum; /* its last value; the last contribution to it */
};

/* A task and the one that it began after. Kept only where the tasks of the chain are asked for. */
struct chain_link {
    uint64_t number;
    size_t before;
};

struct chain_graph {
    size_t at; /* of its forks, among the words; 0: there is no such graph */
    uint32_t n_forks, n_calls, n_objects;
};

struct chain {
    const struct trace_run *run;
    struct trace_words words;
    struct trace_bodies *bodies;
    struct chain_object *object; /* by slot */
    size_t objects_capacity;
    struct chain_graph *graph; /* by name */
    size_t graphs_capacity;
    uint64_t forks, tasks;     /* so far; of these, seen here */
    struct chain_moment floor; /* no task begins before: the flag of a replay was read then */
    struct chain_moment longest;
    struct chain_link *link; /* link[0] is of no task */
    size_t n_links, links_capacity;
    bool failed, damaged, linked;
};

/* Every slot and every graph has a word of its own: larger names are damage, not a reason to make
 * room. Entries that were not there before are zero. NULL: damaged, or no memory. */
static void *chain_room(struct chain *c, void *array, size_t *capacity, uint32_t at, size_t size)
{
    const size_t before = *capacity;
    char *moved = array;
    c->damaged |= at >= c->words.n;
    if (c->damaged || c->failed)
        return NULL;
    if (at >= before && !(moved = base_grow(array, capacity, (size_t)at + 1, size)))
        c->failed = true;
    else
        memset(moved + before * size, 0, (*capacity - before) * size);
    return moved;
}

static struct chain_object *chain_object(struct chain *c, uint32_t slot)
{
    void *room = chain_room(c, c->object, &c->objects_capacity, slot, sizeof *c->object);
    if (!room)
        return NULL;
    c->object = room;
    return &c->object[slot];
}

static struct chain_graph *chain_graph(struct chain *c, uint32_t name)
{
    void *room = chain_room(c, c->graph, &c->graphs_capacity, name, sizeof *c->graph);
    if (!room)
        return NULL;
    c->graph = room;
    return &c->graph[name];
}

/* ---- Tasks ---- */

static struct chain_moment chain_later(struct chain_moment a, struct chain_moment b)
{
    return b.end > a.end ? b : a;
}

/* When the value of an object is there. */
static struct chain_moment chain_value(struct chain *c, uint32_t slot)
{
    const struct chain_object *object = chain_object(c, slot);
    return object ? chain_later(object->value, object->sum) : (struct chain_moment){0, 0};
}

static void chain_write(struct chain *c, uint32_t slot, duite_mode mode, struct chain_moment end)
{
    struct chain_object *object = chain_object(c, slot);
    if (object && mode == DUITE_CW)
        object->sum = chain_later(object->sum, end);
    else if (object)
        object->value = object->sum = end;
}

/* The place of a new link; 0 if they are not kept, or without memory. */
static size_t chain_link(struct chain *c, uint64_t number, size_t before)
{
    if (!c->linked || c->failed)
        return 0;
    struct chain_link *moved =
        base_grow(c->link, &c->links_capacity, c->n_links + 2, sizeof *c->link);
    c->failed = !moved;
    if (!moved)
        return 0;
    c->link = moved;
    c->link[++c->n_links] = (struct chain_link){number, before};
    return c->n_links;
}

/* A task uses the objects that `use` names: slots, or, in a replay, places in `bound`. */
static void chain_task(struct chain *c, uint32_t kernel, size_t n, const uint32_t *use,
                       const uint32_t *bound, uint64_t number)
{
    const struct trace_kernel *modes = &c->run->kernel[kernel];
    struct chain_moment end = c->floor;
    double seconds;
    for (size_t i = 0; i < n; i++) {
        const duite_mode mode = trace_mode(modes, i);
        if (mode == DUITE_R || mode == DUITE_RW)
            end = chain_later(end, chain_value(c, bound ? bound[use[i]] : use[i]));
    }
    trace_bodies_find(c->bodies, number, &seconds);
    end = (struct chain_moment){end.end + seconds, chain_link(c, number, end.link)};
    for (size_t i = 0; i < n; i++)
        if (trace_mode(modes, i) != DUITE_R)
            chain_write(c, bound ? bound[use[i]] : use[i], trace_mode(modes, i), end);
    c->longest = chain_later(c->longest, end);
    c->tasks++;
}

/* n words that follow, of which the caller takes no copy. NULL: there are not so many. */
static const uint32_t *chain_row(struct chain *c, size_t n)
{
    if (c->words.short_of || n > trace_words_left(&c->words)) {
        c->damaged = true;
        return NULL;
    }
    const uint32_t *row = c->words.word + c->words.at;
    c->words.at += n;
    return row;
}

static void chain_fork(struct chain *c, size_t n, bool options)
{
    const uint32_t kernel = trace_words_next(&c->words);
    for (int i = 0; i < 3 && options; i++) /* rank, priority, cost */
        trace_words_next(&c->words);
    const uint32_t *slots = chain_row(c, n);
    c->damaged |= kernel >= c->run->n_kernels;
    c->forks++;
    if (!c->damaged)
        chain_task(c, kernel, n, slots, NULL, c->forks);
}

/* ---- Recorded graphs ---- */

/* A fork or set of a recorded graph, as the words have it. False: damaged. */
struct chain_node {
    uint32_t kernel; /* UINT32_MAX: a set */
    size_t n;
    const uint32_t *place;
};
static bool chain_node(struct chain *c, struct chain_node *node)
{
    node->kernel = trace_words_next(&c->words);
    node->n = trace_words_next(&c->words);
    for (int i = 0; i < 3; i++) /* rank, priority, cost */
        trace_words_next(&c->words);
    node->place = chain_row(c, node->n);
    const bool set = node->kernel == UINT32_MAX;
    c->damaged |= set ? node->n != 1 : node->kernel >= c->run->n_kernels;
    return !c->damaged;
}

static void chain_take_graph(struct chain *c, size_t n_objects)
{
    struct chain_graph graph = {.n_objects = (uint32_t)n_objects};
    struct chain_node node;
    const uint32_t name = trace_words_next(&c->words);
    chain_row(c, n_objects);
    graph.n_forks = trace_words_next(&c->words);
    graph.at = c->words.at;
    for (uint32_t i = 0; i < graph.n_forks && !c->damaged && chain_node(c, &node); i++) {
        graph.n_calls += node.kernel != UINT32_MAX;
        for (size_t k = 0; k < node.n; k++)
            c->damaged |= node.place[k] >= n_objects;
    }
    struct chain_graph *place = c->damaged ? NULL : chain_graph(c, name);
    if (place)
        *place = graph;
}

static void chain_round(struct chain *c, const struct chain_graph *graph, const uint32_t *bound)
{
    const struct trace_words after = c->words;
    struct chain_node node;
    c->words.at = graph->at;
    for (uint32_t i = 0; i < graph->n_forks && !c->failed && chain_node(c, &node); i++) {
        if (node.kernel == UINT32_MAX)
            chain_write(c, bound[node.place[0]], DUITE_W, c->floor);
        else
            chain_task(c, node.kernel, node.n, node.place, bound, ++c->forks);
    }
    c->words = after;
}

/* Whether any task of the next round ran. If none did, the round before was the last one: its flag
 * said so, or what poisoned all of the round poisons all that follow. */
static bool chain_goes_on(const struct chain *c, const struct chain_graph *graph)
{
    double seconds;
    bool ran = false;
    for (uint64_t i = 1; i <= graph->n_calls && !ran; i++)
        ran = trace_bodies_find(c->bodies, c->forks + i, &seconds);
    return ran;
}

static void chain_replay(struct chain *c, size_t n_objects)
{
    const struct chain_graph *found = chain_graph(c, trace_words_next(&c->words));
    const struct chain_graph graph = found ? *found : (struct chain_graph){0};
    const uint32_t flag = trace_words_next(&c->words);
    const uint64_t rounds = trace_words_next2(&c->words);
    const uint64_t before = trace_words_next2(&c->words);
    const uint32_t *bound = chain_row(c, n_objects);
    const struct chain_moment floor = c->floor;
    c->damaged |= !graph.at || graph.n_objects != n_objects;
    c->forks = before;
    for (uint64_t i = 0; i < rounds && !c->damaged && !c->failed; i++) {
        if (!chain_goes_on(c, &graph) && (i || graph.n_calls))
            break;
        chain_round(c, &graph, bound);
        if (flag && !c->damaged && !c->failed)
            c->floor = chain_later(c->floor, chain_value(c, flag));
    }
    c->forks = before + rounds * graph.n_calls;
    c->floor = floor;
}

/* ---- The main program ---- */

static void chain_make(struct chain *c)
{
    struct chain_object *object = chain_object(c, trace_words_next(&c->words));
    trace_words_next2(&c->words); /* bytes */
    if (object)
        *object = (struct chain_object){0};
}

static void chain_skip(struct chain *c, size_t n)
{
    chain_row(c, n);
}

static void chain_entry(struct chain *c)
{
    const uint32_t first = trace_words_next(&c->words);
    const size_t n = first >> 8;
    switch (first & 0xff) {
    case TRACE_OBJECT:
        chain_make(c);
        break;
    case TRACE_FREE:
        chain_skip(c, 1);
        break;
    case TRACE_HINT:
        chain_skip(c, 3 + 3 * n);
        break;
    case TRACE_COLOCATE:
        chain_skip(c, 2);
        break;
    case TRACE_HOMES:
        chain_skip(c, 2 * n);
        break;
    case TRACE_ON:
    case TRACE_OFF:
        c->forks = trace_words_next2(&c->words);
        chain_skip(c, 4);
        break;
    case TRACE_FORK:
    case TRACE_FORKED:
        chain_fork(c, n, (first & 0xff) == TRACE_FORKED);
        break;
    case TRACE_SET:
        chain_write(c, trace_words_next(&c->words), DUITE_W, c->floor);
        break;
    case TRACE_GET:
        chain_skip(c, 6);
        break;
    case TRACE_WAIT:
        chain_skip(c, 4);
        break;
    case TRACE_GRAPH:
        chain_take_graph(c, n);
        break;
    case TRACE_REPLAY:
        chain_replay(c, n);
        break;
    default:
        c->damaged = true;
    }
}

static int chain_walk(struct chain *c)
{
    while (trace_words_left(&c->words) && !c->damaged && !c->failed && !c->words.short_of)
        chain_entry(c);
    if (c->failed)
        return base_no_memory("the longest chain of a trace");
    if (c->damaged || c->words.short_of)
        return base_error(DUITE_E_ARGUMENT,
                          "the trace is damaged: word %zu of its program is invalid", c->words.at);
    if (!c->tasks)
        return base_error(DUITE_E_ARGUMENT, "the trace has no tasks of the main program");
    return DUITE_OK;
}

/* The numbers of the tasks that the longest chain has, from its last link back. */
static int chain_numbers(const struct chain *c, struct trace_path *path)
{
    size_t n = 0, at;
    for (at = c->longest.link; at; at = c->link[at].before)
        n++;
    path->number = base_alloc((n + 1) * sizeof *path->number);
    if (!path->number)
        return base_no_memory("the longest chain of a trace");
    path->n = n;
    for (at = c->longest.link; at; at = c->link[at].before)
        path->number[--n] = c->link[at].number;
    return DUITE_OK;
}

static int chain_find(const struct trace_run *run, struct chain *c)
{
    if (run->lost || !run->whole)
        return base_error(DUITE_E_ARGUMENT,
                          "the trace is not whole (%llu events or words are "
                          "missing): it bounds nothing",
                          (unsigned long long)run->lost);
    c->run = run;
    c->words = trace_words_of(run);
    c->bodies = trace_bodies_new(run);
    return c->bodies ? chain_walk(c) : base_no_memory("the longest chain of a trace");
}

static void chain_free(struct chain *c)
{
    trace_bodies_free(c->bodies);
    free(c->object);
    free(c->graph);
    free(c->link);
}

int trace_bounds_find(const struct trace_run *run, struct trace_bounds *bounds)
{
    struct chain c = {0};
    struct trace_sums sums = {0};
    int code = chain_find(run, &c);
    if (!code)
        code = trace_sum(run, &sums);
    *bounds = (struct trace_bounds){.path = c.longest.end, .work = sums.busy};
    trace_sums_free(&sums);
    chain_free(&c);
    return code;
}

int trace_path_find(const struct trace_run *run, struct trace_path *path)
{
    struct chain c = {.linked = true};
    int code = chain_find(run, &c);
    *path = (struct trace_path){.seconds = c.longest.end};
    if (!code)
        code = chain_numbers(&c, path);
    chain_free(&c);
    return code;
}
