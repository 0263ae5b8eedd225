/* duite-graph: schedules a graph of tasks, synthetic or from a file, and says in the words of
 * duite-cloth's report how long a round took. A task goes through the values that it reads, works
 * for its cost, and leaves a number that depends on them: the hash at the end is the same under
 * every schedule. Costs are turns of a loop, which a loaded machine does not shorten. */
#include "tools/compare/body.h"
#include "tools/compare/graph.h"

#include <config.h>

#include <argp.h>
#include <duite.h>
#include <duite_policy.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct command {
    const char *what, *report, *save;
    size_t tasks;
    double cost;
    uint32_t bytes;
    uint64_t rounds, graph_seed;
    unsigned timeout; /* s; 0: there is no limit */
    bool forks;       /* tasks are forked in each round, not replayed */
    duite_options options;
    struct compare_graph graph;
    duite_object *object;
};

/* ---- The task ---- */

struct work {
    uint64_t turns, number;
};

static int work(const duite_call *call)
{
    const struct work *work = call->args;
    uint64_t state = work->number;
    for (size_t i = 1; i < call->n_params; i++)
        state = body_read(duite_in(call, i, uint64_t), duite_count(call, i) / 2, state);
    body_write(duite_out(call, 0, uint64_t), duite_count(call, 0) / 2, work->turns, state);
    return 0;
}

static const duite_kernel WORK = {.name = "work",
                                  .body = work,
                                  .access = {DUITE_W},
                                  .variadic = DUITE_R,
                                  .args_size = sizeof(struct work)};

static int build(duite *rt, void *context)
{
    const struct command *command = context;
    const struct compare_graph *graph = &command->graph;
    duite_object *objects = malloc((compare_graph_most_reads(graph) + 1) * sizeof *objects);
    int code = objects ? 0 : DUITE_E_MEMORY;
    for (size_t i = 0; i < graph->n && !code; i++) {
        objects[0] = command->object[i];
        const struct work args = {(uint64_t)(graph->cost[i] * BODY_TURNS_A_SECOND), i};
        size_t n = 1;
        for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
            objects[n++] = command->object[graph->from[k]];
        code = duite_fork_with(rt, &(duite_task_options){.cost = graph->cost[i]}, &WORK, &args, n,
                               objects);
    }
    free(objects);
    return code;
}

/* ---- The run ---- */

/* Hints: tasks that read one another are neighbours, and weigh as much as they cost. */
static int hint(const struct command *command, duite *rt)
{
    const struct compare_graph *graph = &command->graph;
    const size_t most = compare_graph_most_reads(graph) + 1;
    duite_object *neighbours = malloc(most * sizeof *neighbours);
    double *bytes = malloc(most * sizeof *bytes);
    int code = neighbours && bytes ? 0 : DUITE_E_MEMORY;
    for (size_t i = 0; i < graph->n && !code; i++) {
        size_t n = 0;
        for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++, n++) {
            neighbours[n] = command->object[graph->from[k]];
            bytes[n] = graph->bytes[graph->from[k]];
        }
        code = duite_hint(rt, command->object[i], graph->cost[i], n, neighbours, bytes);
    }
    free(neighbours);
    free(bytes);
    return code;
}

/* Those of one place follow the first of them. */
static int follow(const struct command *command, duite *rt)
{
    const struct compare_graph *graph = &command->graph;
    int code = 0;
    size_t *first = calloc(graph->n, sizeof *first); /* plus 1 */
    if (!first)
        return DUITE_E_MEMORY;
    for (size_t i = 0; i < graph->n && !code; i++) {
        uint32_t place = graph->place[i];
        if (place == COMPARE_NO_PLACE)
            continue;
        if (first[place])
            code = duite_colocate(rt, command->object[i], command->object[first[place] - 1]);
        else
            first[place] = i + 1;
    }
    free(first);
    return code;
}

/* Integers, an even number of them: sixty-four bits at a time. */
static int make_objects(struct command *command, duite *rt)
{
    const struct compare_graph *graph = &command->graph;
    int code = 0;
    for (size_t i = 0; i < graph->n && !code; i++) {
        const size_t count = 2 * body_values(graph->bytes[i]);
        code = duite_new(rt, DUITE_I32, count, &command->object[i]);
    }
    if (!code)
        code = hint(command, rt);
    return code ? code : follow(command, rt);
}

static double per_worker(double sum, unsigned workers, double seconds)
{
    return seconds > 0 ? sum / (workers * seconds) : 0;
}

/* Workers of all ranks are as many a rank. */
static int report(const struct command *command, duite *rt, double seconds, const duite_counters *a,
                  const duite_counters *b, uint64_t hash)
{
    const duite_options *options = &command->options;
    unsigned workers = duite_threads(rt) * (unsigned)duite_ranks(rt);
    if (duite_rank(rt))
        return 0;
    FILE *out = command->report ? fopen(command->report, "w") : stdout;
    if (!out)
        return 1;
    fprintf(out,
            "{\n  \"graph\": \"%s\",\n  \"tasks_a_round\": %zu,\n  \"ranks\": %d,\n  \"threads\": "
            "%u,\n  \"scheduler\": \"%s\",\n  \"mapping\": \"%s\",\n  \"balance\": \"%s\",\n",
            command->what, command->graph.n, duite_ranks(rt), duite_threads(rt),
            options->scheduler->name, options->mapping->name, options->balance->name);
    fprintf(out,
            "  \"steps\": %" PRIu64 ",\n  \"seconds_per_step\": %.9g,\n  \"busy_fraction\": %.6g,\n"
            "  \"tasks\": %" PRIu64 ",\n  \"tasks_stolen\": %" PRIu64 ",\n  \"messages\": %" PRIu64
            ",\n  \"bytes_moved\": %" PRIu64 ",\n  \"migrated_objects\": %" PRIu64
            ",\n  \"state_hash\": \"%016" PRIx64 "\"\n}\n",
            command->rounds, seconds / (double)command->rounds,
            per_worker(b->busy - a->busy, workers, seconds), b->tasks - a->tasks,
            b->stolen - a->stolen, b->messages - a->messages, b->bytes - a->bytes, b->migrated,
            hash);
    return command->report ? fclose(out) != 0 : fflush(out) != 0;
}

/* The hash of what the last task left, and of all that no task reads. */
static int find_hash(const struct command *command, duite *rt, uint64_t *hash)
{
    const struct compare_graph *graph = &command->graph;
    bool *read = calloc(graph->n, sizeof *read);
    int code = read ? 0 : DUITE_E_MEMORY;
    *hash = 0;
    for (size_t k = 0; read && k < graph->n_reads; k++)
        read[graph->from[k]] = true;
    for (size_t i = 0; i < graph->n && !code; i++) {
        uint64_t *values = read[i] ? NULL : malloc(graph->bytes[i] + 16);
        if (read[i])
            continue;
        code = values ? duite_get(rt, command->object[i], values) : DUITE_E_MEMORY;
        if (!code)
            *hash = body_hash(*hash, values[0]);
        free(values);
    }
    free(read);
    return code;
}

static int run_round(struct command *command, duite *rt, duite_graph graph)
{
    return command->forks ? build(rt, command) : duite_replay(rt, graph, 1);
}

static int measure(struct command *command, duite *rt)
{
    duite_counters before, after;
    duite_graph graph = DUITE_NO_GRAPH;
    uint64_t hash = 0;
    int code = make_objects(command, rt);
    if (!code && !command->forks)
        code = duite_graph_new(rt, build, command, &graph);
    for (int warm = 0; warm < 2 && !code; warm++) /* homes, caches */
        code = run_round(command, rt, graph);
    if (!code && !(code = duite_wait(rt)))
        code = duite_count_all(rt, &before);
    double begin = MPI_Wtime();
    for (uint64_t i = 0; i < command->rounds && !code; i++)
        if (!(code = run_round(command, rt, graph)))
            code = duite_wait(rt);
    double seconds = MPI_Wtime() - begin;
    if (!code)
        code = duite_count_all(rt, &after);
    if (!code)
        code = find_hash(command, rt, &hash);
    if (!code && report(command, rt, seconds, &before, &after, hash))
        fprintf(stderr, "duite-graph: %s: the report cannot be written\n", command->report);
    for (size_t i = 0; i < command->graph.n && !code; i++)
        code = duite_free(rt, command->object[i]);
    return code || command->forks ? code : duite_graph_free(rt, graph);
}

static int run(struct command *command)
{
    static const duite_kernel *const KERNELS[] = {&WORK, NULL};
    duite *rt;
    command->object = calloc(command->graph.n, sizeof *command->object);
    command->options.kernels = KERNELS;
    int code = command->object ? duite_start(&rt, &command->options) : DUITE_E_MEMORY;
    if (!code) {
        code = measure(command, rt);
        int stopped = duite_stop(&rt);
        code = code ? code : stopped;
    }
    if (code)
        fprintf(stderr, "duite-graph: %s\n", duite_message());
    free(command->object);
    return code != 0;
}

/* ---- The limit: what a policy that does not return would else run into is for ever ---- */

static char stopped[80];

static void stop_at_limit(int number)
{
    (void)number;
    const ssize_t written = write(STDERR_FILENO, stopped, strlen(stopped));
    _exit(written < 0 ? 2 : 1);
}

static void set_limit(unsigned seconds)
{
    snprintf(stopped, sizeof stopped, "duite-graph: stopped after %u s (--timeout)\n", seconds);
    signal(SIGALRM, stop_at_limit);
    alarm(seconds);
}

/* ---- The command line ---- */

enum {
    SCHEDULER = 256,
    MAPPING,
    BALANCE,
    THREADS,
    TASKS,
    COST,
    BYTES,
    ROUNDS,
    FORKS,
    SEED,
    REPORT,
    SAVE,
    TIMEOUT
};

static const struct argp_option OPTIONS[] = {
    {"tasks", TASKS, "N", 0, "tasks of a synthetic graph, about (default: 1000)", 1},
    {"cost", COST, "SECONDS", 0,
     "what a task of a synthetic graph takes on average (default: 1e-5)", 1},
    {"bytes", BYTES, "N", 0, "what a task of a synthetic graph writes (default: 4096)", 1},
    {"seed", SEED, "N", 0,
     "of a random graph, and of policies (default: 1; of policies DUITE_SEED, else 1)", 1},
    {"save", SAVE, "FILE", 0, "write the graph, and run nothing", 1},
    {"scheduler", SCHEDULER, "NAME", 0,
     "which worker runs which task next (default: DUITE_SCHEDULER, else steal)", 2},
    {"mapping", MAPPING, "NAME", 0,
     "which rank keeps which object (default: DUITE_MAPPING, else metis)", 2},
    {"balance", BALANCE, "NAME", 0,
     "which tasks or objects go to other ranks (default: DUITE_BALANCE, else none)", 2},
    {"threads", THREADS, "N", 0,
     "workers of each rank (default: DUITE_THREADS, else its share of the cores)", 2},
    {"rounds", ROUNDS, "N", 0,
     "rounds of the graph that are measured, after two that are not (default: 10)", 3},
    {"forks", FORKS, NULL, 0, "fork the tasks in each round; else it is recorded and replayed", 3},
    {"timeout", TIMEOUT, "SECONDS", 0, "most that the run may take (default: any time)", 3},
    {"report", REPORT, "FILE", 0,
     "where the figures go (default: DUITE_REPORT, else standard output)", 3},
    {0}};

static double positive(struct argp_state *state, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (*end || !(value > 0 && value < 4e9))
        argp_error(state, "%s: a number above 0 is expected", text);
    return value;
}

static int policy(struct argp_state *state, const void *found)
{
    if (!found)
        argp_error(state, "%s", duite_message());
    return 0;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    char wrong[500];
    struct command *command = state->input;
    duite_options *options = &command->options;
    switch (key) {
    case SCHEDULER:
        if (!strncmp(text, "starpu:", 7))
            argp_error(
                state,
                "--scheduler %s: duite-graph has none of StarPU's schedulers; starpu-graph and "
                "duite-compare run them, and bench/rivals/starpu-graph --schedulers lists them",
                text);
        return policy(state, options->scheduler = duite_scheduler_find(text));
    case MAPPING:
        return policy(state, options->mapping = duite_mapping_find(text));
    case BALANCE:
        return policy(state, options->balance = duite_balancer_find(text));
    case THREADS:
        options->threads = (unsigned)positive(state, text);
        return 0;
    case TASKS:
        command->tasks = (size_t)positive(state, text);
        return 0;
    case COST:
        command->cost = positive(state, text);
        return 0;
    case BYTES:
        command->bytes = (uint32_t)positive(state, text);
        return 0;
    case ROUNDS:
        command->rounds = (uint64_t)positive(state, text);
        return 0;
    case FORKS:
        command->forks = true;
        return 0;
    case TIMEOUT:
        command->timeout = (unsigned)ceil(positive(state, text));
        return 0;
    case SEED:
        command->graph_seed = options->seed = (uint64_t)positive(state, text);
        return 0;
    case REPORT:
        command->report = text;
        return 0;
    case SAVE:
        command->save = text;
        return 0;
    case ARGP_KEY_ARG:
        if (command->what)
            return ARGP_ERR_UNKNOWN;
        if (compare_graph_wrong(text, wrong, sizeof wrong))
            argp_error(state, "%s", wrong);
        command->what = text;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "which graph? A file, or one of " COMPARE_GRAPH_KINDS);
    }
    return ARGP_ERR_UNKNOWN;
}

const char *argp_program_version = "duite-graph (" PACKAGE_STRING ")";

int main(int argc, char **argv)
{
    struct command command = {.tasks = 1000,
                              .cost = 1e-5,
                              .bytes = 4096,
                              .rounds = 10,
                              .graph_seed = 1,
                              .options = duite_options_default()};
    command.report = command.options.report; /* ours has more */
    command.options.report = NULL;
    const struct argp argp = {OPTIONS,
                              parse,
                              "KIND|FILE",
                              "Schedules a graph of tasks: a synthetic one (" COMPARE_GRAPH_KINDS
                              "), or one from a file.",
                              NULL,
                              NULL,
                              NULL};
    argp_err_exit_status = 2;
    if (argp_parse(&argp, argc, argv, 0, NULL, &command))
        return 2;
    if (command.timeout)
        set_limit(command.timeout);
    const bool file = compare_graph_is_file(command.what);
    int failed = file ? compare_graph_read(&command.graph, command.what)
                      : compare_graph_make(&command.graph, command.what, command.tasks,
                                           command.cost, command.bytes, command.graph_seed);
    if (!failed)
        failed = command.save ? compare_graph_write(&command.graph, command.save) : run(&command);
    compare_graph_free(&command.graph);
    return failed ? 1 : 0;
}
