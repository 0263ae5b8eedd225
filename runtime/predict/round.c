/* One round of a recorded graph, by the rules of graph/tasks.c, from the words of a trace: nodes
 * with the places that they use (objects, and the values of contributors), then two rounds with the
 * last writer of each place, of which the second one's rows are kept. */
#include "runtime/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/map/tasks.h"

#include <stdlib.h>

struct use {
    uint32_t place;
    bool reads, writes;
};

struct round {
    const struct predict_program *p;
    const struct predict_recorded *recorded;
    uint32_t *block; /* by node */
    double *cost;
    bool *own;   /* by node: the runtime's */
    size_t *end; /* by node: of its uses */
    size_t n, block_capacity, cost_capacity, own_capacity, end_capacity;
    struct use *use;
    size_t n_uses, uses_capacity;
    uint32_t *open, *next; /* by object: its open contributions; by contribution: the next one */
    size_t next_capacity;
    uint32_t *object; /* by contribution: of what */
    size_t object_capacity;
    uint32_t n_places; /* objects, then contributions */
    bool *stale;       /* by object: its views are to be gathered */
    const uint32_t *place;
    bool failed;
};

static bool room(struct round *r, void *array, size_t *capacity, size_t n, size_t size)
{
    void **old = array;
    void *moved = r->failed ? NULL : base_grow(*old, capacity, n + 1, size);
    r->failed |= !moved;
    if (moved)
        *old = moved;
    return moved != NULL;
}

static void use(struct round *r, uint32_t place, bool reads, bool writes)
{
    if (room(r, &r->use, &r->uses_capacity, r->n_uses, sizeof *r->use))
        r->use[r->n_uses++] = (struct use){place, reads, writes};
}

/* Its uses were put before. */
static void end_node(struct round *r, uint32_t block, double cost, bool own)
{
    if (!room(r, &r->block, &r->block_capacity, r->n, sizeof *r->block) ||
        !room(r, &r->cost, &r->cost_capacity, r->n, sizeof *r->cost) ||
        !room(r, &r->own, &r->own_capacity, r->n, sizeof *r->own) ||
        !room(r, &r->end, &r->end_capacity, r->n, sizeof *r->end))
        return;
    r->block[r->n] = block;
    r->cost[r->n] = cost;
    r->own[r->n] = own;
    r->end[r->n++] = r->n_uses;
}

static void contribute(struct round *r, uint32_t object)
{
    size_t at = r->n_places - r->recorded->n_objects;
    if (!room(r, &r->next, &r->next_capacity, at, sizeof *r->next) ||
        !room(r, &r->object, &r->object_capacity, at, sizeof *r->object))
        return;
    r->next[at] = r->open[object];
    r->object[at] = object;
    r->open[object] = r->n_places;
    use(r, r->n_places++, false, true);
}

static void close_sum(struct round *r, uint32_t object)
{
    if (r->open[object] == PREDICT_NONE)
        return;
    use(r, object, true, true);
    for (uint32_t place = r->open[object]; place != PREDICT_NONE && !r->failed;
         place = r->next[place - r->recorded->n_objects])
        use(r, place, true, false);
    r->open[object] = PREDICT_NONE;
    r->stale[object] = true;
    end_node(r, r->place[object], 0, true);
}

/* A view's object is among the recorded ones if the graph writes it. */
static void gather(struct round *r, uint32_t view)
{
    const struct predict_graph *graph = r->p->graph;
    const struct predict_recorded *recorded = r->recorded;
    uint32_t parent = graph->object[recorded->bound[view]].parent;
    if (parent == PREDICT_NONE)
        return;
    for (uint32_t i = 0; i < recorded->n_objects; i++) {
        if (recorded->bound[i] != parent)
            continue;
        close_sum(r, i);
        if (!r->stale[i])
            return;
        use(r, i, true, false);
        use(r, view, false, true);
        end_node(r, r->place[i], 0, true);
        r->stale[i] = false;
    }
}

static void put_fork(struct round *r, const struct predict_fork *fork)
{
    static const struct trace_kernel sets = {.mode = {DUITE_W}, .fixed = 1};
    const struct predict_graph *graph = r->p->graph;
    const bool set = fork->kernel == PREDICT_NONE;
    const struct trace_kernel *kernel = set ? &sets : &graph->run->kernel[fork->kernel];
    for (size_t k = 0; k < fork->n && !r->failed; k++) {
        if (trace_mode(kernel, k) == DUITE_CW)
            continue;
        close_sum(r, fork->object[k]);
        gather(r, fork->object[k]);
    }
    for (size_t k = 0; k < fork->n && !r->failed; k++) {
        const duite_mode mode = trace_mode(kernel, k);
        const uint32_t object = fork->object[k];
        if (mode == DUITE_CW)
            contribute(r, object);
        else
            use(r, object, mode != DUITE_W, mode != DUITE_R);
        r->stale[object] |= mode == DUITE_W || mode == DUITE_RW;
    }
    uint32_t own = set ? fork->object[0] : predict_owner(graph, fork, fork->object);
    bool free = own == PREDICT_NONE || kernel->replicated || (!set && fork->at >= 0);
    end_node(r, free ? DUITE_NO_BLOCK : r->place[own], set ? 0 : (double)fork->cost, set);
}

static double bytes_of(const struct round *r, uint32_t place)
{
    const size_t n = r->recorded->n_objects;
    uint32_t object = place < n ? place : r->object[place - n];
    return (double)r->p->graph->object[r->recorded->bound[object]].bytes;
}

static bool fill_rows(const struct round *r, struct plan_tasks *tasks)
{
    size_t at = 0;
    size_t *writer = base_alloc_zero((r->n_places + 1) * sizeof *writer); /* plus 1 */
    for (size_t step = 0; writer && step < 2 * r->n; step++) {
        const size_t node = step % r->n, first = node ? r->end[node - 1] : 0;
        for (size_t u = first; u < r->end[node] && step >= r->n; u++) {
            const struct use *one = &r->use[u];
            if (!one->reads || !writer[one->place])
                continue;
            tasks->from[at] = (uint32_t)((writer[one->place] - 1) % r->n);
            tasks->bytes[at++] = bytes_of(r, one->place);
        }
        for (size_t u = first; u < r->end[node]; u++)
            if (r->use[u].writes)
                writer[r->use[u].place] = step + 1;
        tasks->start[node + 1] = at;
    }
    base_free(writer);
    return writer != NULL;
}

static bool hand_over(const struct round *r, struct map_tasks *tasks)
{
    struct plan_tasks *all = &tasks->tasks;
    const size_t n = all->n = r->n;
    *tasks = (struct map_tasks){.tasks = {.n = n}};
    all->program = base_alloc_zero((n + 1) * sizeof *all->program);
    all->cost = base_alloc((n + 1) * sizeof *all->cost);
    all->start = base_alloc_zero((n + 1) * sizeof *all->start);
    all->from = base_alloc((r->n_uses + 1) * sizeof *all->from);
    all->bytes = base_alloc((r->n_uses + 1) * sizeof *all->bytes);
    tasks->block = base_alloc((n + 1) * sizeof *tasks->block);
    if (!all->program || !all->cost || !all->start || !all->from || !all->bytes || !tasks->block)
        return false;
    for (size_t i = 0; i < n; i++) {
        all->program[i] = !r->own[i];
        all->cost[i] = r->cost[i];
        tasks->block[i] = r->block[i];
    }
    return fill_rows(r, all);
}

bool predict_round(const struct predict_program *p, const struct predict_recorded *recorded,
                   const uint32_t *place, struct map_tasks *tasks)
{
    const size_t n = recorded->n_objects;
    struct round r = {.p = p, .recorded = recorded, .place = place, .n_places = (uint32_t)n};
    r.open = base_alloc((n + 1) * sizeof *r.open);
    r.stale = base_alloc_zero((n + 1) * sizeof *r.stale);
    r.failed = !r.open || !r.stale;
    for (size_t i = 0; i < n && r.open; i++)
        r.open[i] = PREDICT_NONE;
    for (size_t i = 0; i < recorded->n_forks && !r.failed; i++)
        put_fork(&r, &recorded->fork[i]);
    for (uint32_t i = 0; i < n && !r.failed; i++)
        close_sum(&r, i);
    bool fine = !r.failed && hand_over(&r, tasks);
    free(r.block);
    free(r.cost);
    free(r.own);
    free(r.end);
    free(r.use);
    free(r.next);
    free(r.object);
    base_free(r.open);
    base_free(r.stale);
    return fine;
}
