/* Runs a program on duite and compares. Nothing is decided by what the runtime answers, so that
 * every rank goes through the same calls whatever it finds; the first thing found is kept. */

#include "tests/runtime/random_run.h"

#include "runtime/comm/internal.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { UNTOUCHED = 0xa5 };

void prog_found(struct run *run, const char *format, ...)
{
    va_list list;

    if (run->report->text[0])
        return;
    va_start(list, format);
    vsnprintf(run->report->text, sizeof run->report->text, format, list);
    va_end(list);
    run->report->op = run->at;
}

static void expect(struct run *run, const char *call, int code, int expected)
{
    if (code != expected)
        prog_found(run, "%s returned %d (%s), expected %d", call, code,
                   code ? duite_message() : "ok", expected);
}

static void compare(struct run *run, unsigned number, const struct prog_expect *answer)
{
    const struct prog_object *object = &run->prog->objects[number];
    const size_t size = prog_size(object->type);
    char is[80] = "", should[80] = "";
    size_t i = 0, different = 0, first = 0;

    for (; i < answer->count; i++)
        if (memcmp(run->bytes + i * size, answer->bytes + i * size, size) != 0 && different++ == 0)
            first = i;
    for (i *= size; i < run->largest; i++)
        if (run->bytes[i] != UNTOUCHED)
            prog_found(run, "object %u: byte %zu behind its %zu elements was written", number, i,
                       answer->count);
    if (!different)
        return;
    prog_print_element(object->type, run->bytes, first, is, sizeof is);
    prog_print_element(object->type, answer->bytes, first, should, sizeof should);
    prog_found(run, "object %u: %zu of %zu elements differ, first [%zu]: %s, expected %s", number,
               different, answer->count, first, is, should);
}

static void get(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    memset(run->bytes, UNTOUCHED, run->largest);
    const int here = op->kind == PROG_GET || op->rank == run->rank;
    void *values = here ? run->bytes : NULL;
    const int code = op->kind == PROG_GET
                         ? duite_get(run->rt, run->object[op->object], values)
                         : duite_get_at(run->rt, run->object[op->object], op->rank, values);

    expect(run, op->kind == PROG_GET ? "get" : "get_at", code, here ? answer->code : DUITE_OK);
    if (here && answer->bytes && code == answer->code)
        compare(run, op->object, answer);
}

static void get_count(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    const size_t none = (size_t)-3, expected = answer->bytes ? answer->count : none;
    size_t count = none;

    expect(run, "get_count", duite_get_count(run->rt, run->object[op->object], &count),
           answer->code);
    if (count != expected)
        prog_found(run, "object %u has %zu elements, expected %zu", op->object, count, expected);
}

/* Priorities differ between ranks, which is nobody's business. */
static int fork_task(struct run *run, const struct prog_op *op)
{
    const duite_kernel *kernel = &run->prog->kernel[op->kernel];
    duite_task_options how = {.priority = op->priority + run->rank, .cost = op->cost};
    duite_object objects[PROG_MAX_PARAMS];
    struct prog_args args;
    int rank = op->rank, code;

    prog_args_fill(run->prog, op, &args);
    for (unsigned i = 0; i < op->n; i++)
        objects[i] = run->object[op->objects[i]];
    if (rank >= 0)
        how.at = &rank;
    if (op->cost >= 0)
        code = duite_fork_with(run->rt, &how, kernel, &args, op->n, objects);
    else if (rank < 0)
        code = duite_fork(run->rt, kernel, &args, op->n, objects);
    else
        code = duite_fork_at(run->rt, rank, kernel, &args, op->n, objects);
    memset(&args, 0xee, sizeof args); /* the runtime has its copy */
    memset(objects, 0xee, sizeof objects);
    memset(&how, 0xee, sizeof how);
    rank = -1;
    return code;
}

/* A kernel that contributes to one object is given it twice. */
static void wrong_fork(struct run *run, const struct prog_op *op, int expected)
{
    const duite_object objects[] = {run->object[op->object], run->object[op->object]};
    const struct prog_args args = {0};

    expect(run, "fork", duite_fork(run->rt, &run->prog->kernel[0], &args, 2, objects), expected);
}

static void hint(struct run *run, const struct prog_op *op)
{
    duite_object neighbours[PROG_MAX_PARAMS];
    double weights[PROG_MAX_PARAMS];

    for (unsigned i = 0; i < op->n; i++) {
        neighbours[i] = run->object[op->objects[i]];
        weights[i] = i;
    }
    expect(run, "hint",
           duite_hint(run->rt, run->object[op->object], op->weight, op->n, neighbours, weights),
           DUITE_OK);
}

static void ask_home(struct run *run, unsigned number)
{
    const int home = duite_home(run->rt, run->object[number]);

    if (run->moves)
        return;
    if (home < 0 || home >= run->prog->n_ranks)
        prog_found(run, "object %u has home %d", number, home);
    if (run->home[number] >= 0 && run->home[number] != home)
        prog_found(run, "object %u moved from %d to %d", number, run->home[number], home);
    run->home[number] = home;
}

static int set(struct run *run, const struct prog_op *op)
{
    const struct prog_object *object = &run->prog->objects[op->object];
    const void *values = op->seed ? run->bytes : NULL;
    const int whole = op->count == (object->max ? object->max : object->count);

    prog_values(object->type, op->count, op->seed, run->bytes);
    const int code = whole && op->count % 2
                         ? duite_set(run->rt, run->object[op->object], values)
                         : duite_set_sized(run->rt, run->object[op->object], values, op->count);

    memset(run->bytes, 0xee, run->largest); /* the runtime has its copy */
    return code;
}

static void make(struct run *run, const struct prog_op *op)
{
    duite_object *object = &run->object[op->object];

    if (op->max)
        expect(run, "new_sized", duite_new_sized(run->rt, op->type, op->count, op->max, object),
               DUITE_OK);
    else
        expect(run, "new", duite_new(run->rt, op->type, op->count, object), DUITE_OK);
}

/* ---- Graphs ---- */

static int build(duite *rt, void *context)
{
    struct run_graph *graph = context;
    struct run *run = graph->run;
    const struct prog_op *from = &run->prog->ops[graph->again];

    (void)rt; /* it is the run's */
    graph->first = graph->again;
    for (size_t i = 1; i <= from->n; i++) {
        const struct prog_op *op = &from[i];

        if (op->kind == PROG_GRAPH_SET)
            set(run, op);
        else if (op->kind == PROG_GRAPH_FORK)
            fork_task(run, op);
    }
    return 0;
}

static int change_args(struct run *run, struct run_graph *graph, const struct prog_op *op)
{
    struct prog_op target = run->prog->ops[op->count];
    struct prog_args args;
    size_t k = 0;

    if (target.kind != PROG_GRAPH_FORK || op->count <= graph->first ||
        op->count > graph->first + run->prog->ops[graph->first].n)
        return DUITE_OK;
    for (size_t i = graph->first + 1; i < op->count; i++)
        k += run->prog->ops[i].kind == PROG_GRAPH_FORK;
    target.seed = op->seed;
    target.fails = op->fails;
    prog_args_fill(run->prog, &target, &args);
    return duite_graph_args(run->rt, graph->name, k, &args);
}

static void rounds(struct run *run, const struct run_graph *graph, uint64_t expected)
{
    uint64_t n = 0;

    expect(run, "rounds", duite_graph_rounds(run->rt, graph->name, &n), DUITE_OK);
    if (n != expected)
        prog_found(run, "%llu rounds, expected %llu", (unsigned long long)n,
                   (unsigned long long)expected);
}

static void graph_operation(struct run *run, const struct prog_op *op,
                            const struct prog_expect *answer)
{
    struct run_graph *graph = &run->graph[op->graph];
    const duite_object object = run->object[op->object];
    int code = DUITE_OK;

    if (op->kind == PROG_GRAPH) {
        *graph = (struct run_graph){.run = run, .alive = 1, .again = (size_t)(op - run->prog->ops)};
        code = duite_graph_new(run->rt, build, graph, &graph->name);
    }
    if (!graph->alive)
        return;
    if (op->kind == PROG_GRAPH_AGAIN) {
        graph->again = (size_t)(op - run->prog->ops);
    } else if (op->kind == PROG_REPLAY) {
        code = duite_replay(run->rt, graph->name, op->count);
    } else if (op->kind == PROG_REPLAY_WHILE) {
        code = duite_replay_while(run->rt, graph->name, object, op->count);
    } else if (op->kind == PROG_ROUNDS) {
        rounds(run, graph, answer->rounds);
    } else if (op->kind == PROG_GRAPH_ARGS) {
        code = change_args(run, graph, op);
    } else if (op->kind == PROG_GRAPH_BIND) {
        graph->rebound = 1;
        code = duite_graph_bind(run->rt, graph->name, object, run->object[op->objects[0]]);
    } else if (op->kind == PROG_GRAPH_FREE) {
        graph->alive = 0;
        code = duite_graph_free(run->rt, graph->name);
    }
    expect(run, "a call on a graph", code, answer->code);
}

static void operation(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    duite_object *object = &run->object[op->object];

    switch (op->kind) {
    case PROG_NEW:
        make(run, op);
        break;
    case PROG_FREE:
        ask_home(run, op->object);
        expect(run, "free", duite_free(run->rt, *object), DUITE_OK);
        break;
    case PROG_SET:
        expect(run, "set", set(run, op), DUITE_OK);
        break;
    case PROG_FORK:
        expect(run, "fork", fork_task(run, op), DUITE_OK);
        break;
    case PROG_GET:
    case PROG_GET_AT:
        get(run, op, answer);
        break;
    case PROG_COUNT:
        get_count(run, op, answer);
        break;
    case PROG_WAIT:
        expect(run, "wait", duite_wait(run->rt), answer->code);
        break;
    case PROG_HINT:
        hint(run, op);
        break;
    case PROG_FOLLOW:
        expect(run, "follow", duite_colocate(run->rt, *object, run->object[op->objects[0]]),
               DUITE_OK);
        break;
    case PROG_HOME:
        ask_home(run, op->object);
        break;
    case PROG_WRONG:
        wrong_fork(run, op, answer->code);
        break;
    case PROG_SKIP:
    case PROG_GRAPH_FORK:
    case PROG_GRAPH_SET:
        break;
    default:
        graph_operation(run, op, answer);
    }
}

/* Bytes of the pieces of large messages: small ones, but at most so many of the largest object,
 * since MPI looks through all that wait. */
enum { MOST_PIECES = 200 };

static size_t piece_bytes(const struct prog *prog, uint64_t seed)
{
    static const size_t PIECES[] = {40, 100, 300, COMM_PIECE_BYTES};
    size_t bytes = PIECES[seed % (sizeof PIECES / sizeof *PIECES)];

    for (size_t i = 0; i < prog->n_objects; i++) {
        const struct prog_object *object = &prog->objects[i];
        const size_t most = object->max ? object->max : object->count;

        if (most * prog_size(object->type) / MOST_PIECES > bytes)
            bytes = most * prog_size(object->type) / MOST_PIECES;
    }
    return bytes;
}

static void run_operations(struct run *run, const struct prog_setup *setup,
                           struct prog_context *context, volatile size_t *where)
{
    const struct prog *prog = run->prog;
    duite_options options = duite_options_default();

    options.comm = setup->comm;
    options.kernels = prog->list;
    options.laws = prog_own_laws;
    options.context = context;
    options.threads = setup->threads;
    options.scheduler = duite_scheduler_find(setup->scheduler);
    options.mapping = duite_mapping_find(setup->mapping);
    options.balance = duite_balancer_find(setup->balance);
    options.seed = setup->seed;
    options.spin_seconds = setup->spin;
    options.bind = 0;
    options.window = setup->window;
    comm_piece_bytes = piece_bytes(prog, setup->seed);
    run->moves = options.balance->migrate || options.mapping->map_tasks;
    const int code = duite_start(&run->rt, &options);

    expect(run, "start", code, DUITE_OK);
    if (code)
        return;
    for (run->at = 0; run->at < prog->n_ops; run->at++) {
        *where = run->at;
        if (setup->verbose && run->rank == 0)
            prog_print(stdout, prog, run->at);
        operation(run, &prog->ops[run->at], &run->answers->op[run->at]);
    }
    for (unsigned i = 0; i < prog->n_objects; i++)
        if (run->moves)
            run->home[i] = duite_home(run->rt, run->object[i]);
        else if (run->home[i] < 0)
            ask_home(run, i);
    duite_counters counters = {0};

    expect(run, "count_all", duite_count_all(run->rt, &counters), DUITE_OK);
    run->report->recognised = counters.recognised;
    if (counters.graphs_recorded != run->answers->n_recorded)
        prog_found(run, "%llu graphs recorded, expected %llu",
                   (unsigned long long)counters.graphs_recorded,
                   (unsigned long long)run->answers->n_recorded);
    expect(run, "stop", duite_stop(&run->rt), run->answers->stop);
    if (run->rt)
        prog_found(run, "stop left *rt");
    prog_check_places(run, context, setup);
}

void prog_run(const struct prog *prog, const struct prog_answers *answers,
              const struct prog_setup *setup, struct prog_report *report, volatile size_t *where)
{
    struct run run = {.prog = prog, .answers = answers, .report = report, .largest = 1};
    struct prog_context context = {.n_ranks = prog->n_ranks, .threads = setup->threads};

    *report = (struct prog_report){0};
    MPI_Comm_rank(setup->comm, &run.rank);
    context.rank = run.rank;
    for (size_t i = 0; i < prog->n_objects; i++) {
        const struct prog_object *object = &prog->objects[i];
        const size_t max = object->max ? object->max : object->count;

        if (max * prog_size(object->type) > run.largest)
            run.largest = max * prog_size(object->type);
    }
    run.object = calloc(prog->n_objects + 1, sizeof *run.object);
    run.home = malloc((prog->n_objects + 1) * sizeof *run.home);
    run.bytes = malloc(run.largest);
    run.graph = calloc(prog->n_graphs + 1, sizeof *run.graph);
    context.ran = calloc(prog->n_forks + 1, sizeof *context.ran);
    if (run.object && run.home && run.bytes && run.graph && context.ran) {
        memset(run.home, 0xff, (prog->n_objects + 1) * sizeof *run.home);
        run_operations(&run, setup, &context, where);
        if (context.wrong)
            prog_found(&run, "a body was called wrongly: random_bodies.c:%d", context.wrong);
    }
    free(run.object);
    free(run.home);
    free(run.bytes);
    free(run.graph);
    free(context.ran);
}
