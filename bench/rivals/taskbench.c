/* Task Bench (Slaughter et al., SC 2020) on duite: its core makes the graphs, runs the bodies and
 * asserts that each input is the one that the graph names; this adapter forks the tasks, or with
 * -replay records those of a period of steps and replays them. A column has two objects, which the
 * steps write in turn. At the end the last step's outputs are checked, so that no task is missing.
 * The inputs of all tasks are a table that is made before the clock starts. */
#include <core_c.h>
#include <duite.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct pattern {
    task_graph_t graph;
    long sets;     /* of dependences, which steps have in turn */
    size_t *start; /* sets x width + 1: the inputs of a column are from[start[i] .. start[i + 1]) */
    long *from;
    duite_object *object; /* 2 x width */
};

struct bench {
    duite *rt;
    int patterns, replayed;
    struct pattern *pattern;
};

struct point {
    int pattern;
    long step, column;
    long period; /* steps from a round of a replay to the next; 0: forked */
};

static void need_that(bool fine, const char *else_what)
{
    if (!fine) {
        fprintf(stderr, "taskbench: %s\n", else_what);
        exit(1);
    }
}

static void need(int code)
{
    need_that(!code, duite_message());
}

static void *take(void *memory, size_t n, size_t size)
{
    memory = realloc(memory, n * size + 1);
    need_that(memory, "out of memory");
    return memory;
}

/* A thread's own, made when it first needs so much. */
static char *scratch(size_t bytes)
{
    static _Thread_local char *memory;
    static _Thread_local size_t room;
    if (room < bytes) {
        memory = take(memory, room = bytes, 1);
        task_graph_prepare_scratch(memory, bytes);
    }
    return memory;
}

static int run_point(const duite_call *call)
{
    const struct bench *bench = call->context;
    const struct point *point = call->args;
    const task_graph_t *graph = &bench->pattern[point->pattern].graph;
    const char *input[call->n_params];
    size_t bytes[call->n_params];
    for (size_t i = 1; i < call->n_params; i++) {
        input[i - 1] = duite_in(call, i, char);
        bytes[i - 1] = duite_count(call, i);
    }
    task_graph_execute_point_scratch(
        *graph, point->step + (long)call->round * point->period, point->column,
        duite_out(call, 0, char), duite_count(call, 0), input, bytes, call->n_params - 1,
        scratch(graph->scratch_bytes_per_task), graph->scratch_bytes_per_task);
    return 0;
}

static const duite_kernel POINT = {.name = "point",
                                   .body = run_point,
                                   .access = {DUITE_W},
                                   .variadic = DUITE_R,
                                   .args_size = sizeof(struct point)};

/* ---- Before the clock starts ---- */

static void list_inputs(struct pattern *pattern, size_t i, interval_list_t inputs)
{
    size_t n = pattern->start[i];
    for (long k = 0; k < interval_list_num_intervals(inputs); k++) {
        const interval_t span = interval_list_interval(inputs, k);
        const size_t more = (size_t)(span.end - span.start + 1);
        pattern->from = take(pattern->from, n + more, sizeof *pattern->from);
        for (size_t j = 0; j < more; j++)
            pattern->from[n++] = span.start + (long)j;
    }
    pattern->start[i + 1] = n;
    interval_list_destroy(inputs);
}

static void tabulate(struct pattern *pattern, task_graph_t graph)
{
    const size_t width = (size_t)graph.max_width;
    *pattern = (struct pattern){.graph = graph, .sets = task_graph_max_dependence_sets(graph)};
    const size_t n = (size_t)pattern->sets * width;
    pattern->start = take(NULL, n + 1, sizeof *pattern->start);
    pattern->start[0] = 0;
    for (size_t i = 0; i < n; i++)
        list_inputs(pattern, i,
                    task_graph_dependencies(graph, (long)(i / width), (long)(i % width)));
}

/* The objects of a column stay on a rank, which has those of columns side by side. */
static void make_objects(duite *rt, struct pattern *pattern)
{
    const size_t width = (size_t)pattern->graph.max_width;
    duite_object *object = pattern->object = take(NULL, 2 * width, sizeof *object);
    for (size_t i = 0; i < 2 * width; i++)
        need(duite_new(rt, DUITE_BYTE, pattern->graph.output_bytes_per_task, &object[i]));
    for (size_t i = 0; i < width; i++) {
        need(duite_colocate(rt, object[width + i], object[i]));
        need(duite_hint(rt, object[i], 1, i > 0, &object[i - (i > 0)], NULL));
    }
}

/* ---- Tasks ---- */

struct steps {
    struct bench *bench;
    int pattern;
    long first, n, period;
};

static int fork_step(const struct steps *steps, long step)
{
    const struct pattern *pattern = &steps->bench->pattern[steps->pattern];
    const task_graph_t graph = pattern->graph;
    const long first = task_graph_offset_at_timestep(graph, step);
    const long end = first + task_graph_width_at_timestep(graph, step);
    const long before = task_graph_offset_at_timestep(graph, step - 1); /* the row that is read */
    const long before_end = before + task_graph_width_at_timestep(graph, step - 1);
    const long set = task_graph_dependence_set_at_timestep(graph, step);
    const duite_object *write = pattern->object + step % 2 * graph.max_width;
    const duite_object *read = pattern->object + (step + 1) % 2 * graph.max_width;
    int code = 0;
    for (long column = first; column < end && !code; column++) {
        const struct point point = {steps->pattern, step, column, steps->period};
        const size_t *start = &pattern->start[set * graph.max_width + column];
        duite_object objects[start[1] - start[0] + 1];
        size_t n = 0;
        objects[n++] = write[column];
        for (size_t k = start[0]; k < start[1]; k++)
            if (pattern->from[k] >= before && pattern->from[k] < before_end)
                objects[n++] = read[pattern->from[k]];
        code = duite_fork(steps->bench->rt, &POINT, &point, n, objects);
    }
    return code;
}

static int fork_steps(duite *rt, void *context)
{
    const struct steps *steps = context;
    int code = 0;
    (void)rt;
    for (long step = steps->first; step < steps->first + steps->n && !code; step++)
        code = fork_step(steps, step);
    return code;
}

/* Steps repeat after an even number of them, with the same sets, where rows are all as wide: in a
 * tree from some step on, in dom never. */
static void run_pattern(struct bench *bench, int which)
{
    const struct pattern *pattern = &bench->pattern[which];
    const task_graph_t graph = pattern->graph;
    const long period = pattern->sets * (1 + pattern->sets % 2), width = graph.max_width;
    struct steps steps = {bench, which, 0, graph.timesteps, 0};
    long first = 0;
    while (first < graph.timesteps && task_graph_width_at_timestep(graph, first - 1) < width)
        first++;
    const long rounds = graph.dependence == DOM ? 0 : (graph.timesteps - first) / period;
    if (bench->replayed && rounds > 0) {
        duite_graph recorded;
        steps.n = first;
        need(fork_steps(bench->rt, &steps));
        steps = (struct steps){bench, which, first, period, period};
        need(duite_graph_new(bench->rt, fork_steps, &steps, &recorded));
        need(duite_replay(bench->rt, recorded, (uint64_t)rounds));
        need(duite_graph_free(bench->rt, recorded));
        first += rounds * period;
        steps = (struct steps){bench, which, first, graph.timesteps - first, 0};
    }
    need(fork_steps(bench->rt, &steps));
}

/* An output is pairs of its step and column. */
static void finish(duite *rt, const struct pattern *pattern)
{
    const task_graph_t graph = pattern->graph;
    const long step = graph.timesteps - 1, first = task_graph_offset_at_timestep(graph, step);
    long *output = take(NULL, graph.output_bytes_per_task, 1);
    for (long i = first; i < first + task_graph_width_at_timestep(graph, step); i++) {
        need(duite_get(rt, pattern->object[step % 2 * graph.max_width + i], output));
        need_that(output[0] == step && output[1] == i, "a last output is of another task");
    }
    for (long i = 0; i < 2 * graph.max_width; i++)
        need(duite_free(rt, pattern->object[i]));
    free(output);
}

static void start(struct bench *bench, task_graph_list_t graphs)
{
    static const duite_kernel *const kernels[] = {&POINT, NULL};
    duite_options options = duite_options_default();
    options.kernels = kernels;
    options.context = bench;
    need(duite_start(&bench->rt, &options));
    bench->patterns = (int)task_graph_list_num_task_graphs(graphs);
    bench->pattern = take(NULL, (size_t)bench->patterns, sizeof *bench->pattern);
    for (int i = 0; i < bench->patterns; i++) {
        tabulate(&bench->pattern[i], task_graph_list_task_graph(graphs, i));
        make_objects(bench->rt, &bench->pattern[i]);
    }
}

int main(int argc, char **argv)
{
    const app_t app = app_create(argc, argv);
    struct bench bench = {0};
    for (int i = 1; i < argc; i++)
        bench.replayed |= !strcmp(argv[i], "-replay");
    start(&bench, app_task_graphs(app));
    if (!duite_rank(bench.rt))
        app_display(app);
    need(duite_wait(bench.rt));
    const double begin = MPI_Wtime();
    for (int i = 0; i < bench.patterns; i++)
        run_pattern(&bench, i);
    need(duite_wait(bench.rt));
    const double seconds = MPI_Wtime() - begin;
    for (int i = 0; i < bench.patterns; i++)
        finish(bench.rt, &bench.pattern[i]);
    if (!duite_rank(bench.rt))
        app_report_timing(app, seconds);
    need(duite_stop(&bench.rt));
    return 0;
}
