/* starpu-graph: the twin of duite-graph (tools/duite-graph.c): the same tasks on the same graph,
 * submitted to one of StarPU's schedulers in each round, and the same report. One process. Options
 * that only duite-graph knows are not taken. A scheduler that StarPU does not know is refused:
 * StarPU would warn and take another one, whose figures would have the wrong name. */
#include "tools/compare/graph.h"

#include <inttypes.h>
#include <starpu.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TURNS_A_SECOND 1e9

struct work {
    uint64_t turns, number;
    unsigned reads;
};

struct command {
    const char *what, *report, *scheduler;
    size_t tasks;
    double cost;
    uint32_t bytes;
    uint64_t rounds;
    int threads;
    struct compare_graph graph;
    struct work *work;
    uint64_t **values;
    starpu_data_handle_t *handle;
    struct starpu_data_descr *data; /* of the task that is being submitted */
};

static uint64_t *values_of(void *buffer)
{
    return (uint64_t *)STARPU_VECTOR_GET_PTR(buffer);
}

static size_t count_of(void *buffer)
{
    return STARPU_VECTOR_GET_NX(buffer);
}

static void work(void *buffers[], void *argument)
{
    const struct work *work = argument;
    uint64_t state = work->number;
    for (unsigned k = 1; k <= work->reads; k++)
        for (size_t i = 0; i < count_of(buffers[k]); i++)
            state = state * 31 + values_of(buffers[k])[i];
    for (uint64_t i = 0; i < work->turns; i++)
        state = state * 6364136223846793005u + 1442695040888963407u;
    for (size_t i = 0; i < count_of(buffers[0]); i++)
        values_of(buffers[0])[i] = state + i;
}

static struct starpu_codelet codelet = {
    .cpu_funcs = {work}, .nbuffers = STARPU_VARIABLE_NBUFFERS, .name = "work"};

static int submit(const struct command *command, size_t i)
{
    const struct compare_graph *graph = &command->graph;
    struct starpu_data_descr *data = command->data;
    int n = 1;
    data[0] = (struct starpu_data_descr){command->handle[i], STARPU_W};
    for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
        data[n++] = (struct starpu_data_descr){command->handle[graph->from[k]], STARPU_R};
    return starpu_task_insert(&codelet, STARPU_DATA_MODE_ARRAY, data, n, STARPU_CL_ARGS_NFREE,
                              &command->work[i], sizeof command->work[i], 0);
}

static int run_rounds(const struct command *command, uint64_t rounds)
{
    int code = 0;
    for (uint64_t r = 0; r < rounds && !code; r++) {
        for (size_t i = 0; i < command->graph.n && !code; i++)
            code = submit(command, i);
        starpu_task_wait_for_all();
    }
    return code;
}

static bool prepare(struct command *command)
{
    const struct compare_graph *graph = &command->graph;
    command->work = calloc(graph->n, sizeof *command->work);
    command->values = calloc(graph->n, sizeof *command->values);
    command->handle = calloc(graph->n, sizeof(starpu_data_handle_t));
    command->data = calloc(compare_graph_most_reads(graph) + 1, sizeof *command->data);
    for (size_t i = 0; i < graph->n; i++) {
        size_t count = graph->bytes[i] < 8 ? 1 : graph->bytes[i] / 8;
        if (!command->work || !command->values || !command->handle || !command->data ||
            !(command->values[i] = calloc(count, 8)))
            return false;
        command->work[i] = (struct work){(uint64_t)(graph->cost[i] * TURNS_A_SECOND), i,
                                         (unsigned)(graph->start[i + 1] - graph->start[i])};
        starpu_vector_data_register(&command->handle[i], STARPU_MAIN_RAM,
                                    (uintptr_t)command->values[i], (uint32_t)count, 8);
    }
    return true;
}

/* As duite-graph finds it. */
static uint64_t find_hash(const struct command *command)
{
    const struct compare_graph *graph = &command->graph;
    uint64_t hash = 0;
    bool *read = calloc(graph->n, sizeof *read);
    for (size_t k = 0; read && k < graph->n_reads; k++)
        read[graph->from[k]] = true;
    for (size_t i = 0; read && i < graph->n; i++) {
        starpu_data_unregister(command->handle[i]);
        if (!read[i])
            hash = hash * 1099511628211u + command->values[i][0];
    }
    free(read);
    return hash;
}

static double busy(void)
{
    double sum = 0;
    for (unsigned w = 0; w < starpu_worker_get_count(); w++) {
        struct starpu_profiling_worker_info info;
        if (!starpu_profiling_worker_get_info((int)w, &info))
            sum += 1e-6 * starpu_timing_timespec_to_us(&info.executing_time);
    }
    return sum;
}

static int report(const struct command *command, double seconds, double in_bodies, uint64_t hash)
{
    FILE *out = command->report ? fopen(command->report, "w") : stdout;
    if (!out)
        return 1;
    fprintf(out,
            "{\n  \"graph\": \"%s\",\n  \"scheduler\": \"starpu:%s\",\n  \"steps\": %" PRIu64
            ",\n  \"seconds_per_step\": %.9g,\n  \"busy_fraction\": %.6g,\n  \"state_hash\": "
            "\"%016" PRIx64 "\"\n}\n",
            command->what, command->scheduler, command->rounds, seconds / (double)command->rounds,
            in_bodies / (seconds * command->threads), hash);
    return command->report ? fclose(out) != 0 : 0;
}

/* ---- StarPU's schedulers ---- */

static bool knows(const char *scheduler)
{
    struct starpu_sched_policy **policy = starpu_sched_get_predefined_policies();
    while (*policy && strcmp((*policy)->policy_name, scheduler) != 0)
        policy++;
    return *policy;
}

/* The names, each after `before`. */
static void list_schedulers(FILE *out, const char *before)
{
    struct starpu_sched_policy **policy = starpu_sched_get_predefined_policies();
    for (; *policy; policy++)
        fprintf(out, "%s%s", before, (*policy)->policy_name);
    fputc('\n', out);
}

static int run(struct command *command)
{
    struct starpu_conf conf;
    unsetenv("STARPU_SCHED"); /* it would count more than the name here */
    if (starpu_conf_init(&conf))
        return 1;
    conf.ncpus = command->threads;
    conf.ncuda = conf.nopencl = 0;
    conf.sched_policy_name = command->scheduler;
    if (starpu_init(&conf))
        return 1;
    bool ready = prepare(command);
    int code = ready ? run_rounds(command, 2) : 1;
    starpu_profiling_status_set(STARPU_PROFILING_ENABLE);
    busy(); /* from now on */
    double begin = starpu_timing_now();
    if (!code)
        code = run_rounds(command, command->rounds);
    double seconds = 1e-6 * (starpu_timing_now() - begin), in_bodies = busy();
    if (ready && !code)
        code = report(command, seconds, in_bodies, find_hash(command));
    starpu_shutdown();
    return code;
}

static bool take(struct command *command, const char *option, const char *value)
{
    if (!strcmp(option, "--report"))
        command->report = value;
    else if (!strcmp(option, "--scheduler"))
        command->scheduler = value;
    else if (!strcmp(option, "--threads"))
        command->threads = atoi(value);
    else if (!strcmp(option, "--tasks"))
        command->tasks = strtoul(value, NULL, 10);
    else if (!strcmp(option, "--cost"))
        command->cost = strtod(value, NULL);
    else if (!strcmp(option, "--bytes"))
        command->bytes = (uint32_t)strtoul(value, NULL, 10);
    else if (!strcmp(option, "--rounds"))
        command->rounds = strtoull(value, NULL, 10);
    else
        return false;
    return true;
}

int main(int argc, char **argv)
{
    struct command command = {
        .scheduler = "lws", .tasks = 1000, .cost = 1e-5, .bytes = 4096, .rounds = 10, .threads = 2};
    if (argc == 2 && !strcmp(argv[1], "--schedulers"))
        return list_schedulers(stdout, " "), 0;
    bool fine = argc > 1;
    for (int i = 2; i < argc && fine; i += 2)
        fine = i + 1 < argc && take(&command, argv[i], argv[i + 1]);
    if (!fine || command.threads < 1 || !command.rounds) {
        fprintf(stderr,
                "starpu-graph KIND|FILE [--scheduler NAME] [--threads N] [--tasks N] [--cost "
                "SECONDS] [--bytes N] [--rounds N] [--report FILE]\n"
                "starpu-graph --schedulers: prints the names of StarPU's schedulers\n");
        return 2;
    }
    if (!knows(command.scheduler)) {
        fprintf(stderr,
                "starpu-graph: --scheduler %s: StarPU has no scheduler of this name; known "
                "are",
                command.scheduler);
        list_schedulers(stderr, " ");
        return 2;
    }
    command.what = argv[1];
    bool file = strchr(command.what, '.') || strchr(command.what, '/');
    int failed = file ? compare_graph_read(&command.graph, command.what)
                      : compare_graph_make(&command.graph, command.what, command.tasks,
                                           command.cost, command.bytes, 1);
    if (!failed && (failed = run(&command)))
        fprintf(stderr, "starpu-graph: StarPU failed\n");
    compare_graph_free(&command.graph);
    return failed;
}
