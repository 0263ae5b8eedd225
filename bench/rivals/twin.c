/* The command line, the rounds and the report of a twin. A scheduler that a runtime does not have
 * is refused: some would warn and take another one, whose figures would have the wrong name. */
#include "bench/rivals/twin.h"

#include "tools/compare/body.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void twin_body(const struct twin *twin, size_t i)
{
    const struct compare_graph *graph = &twin->graph;
    uint64_t state = i;
    for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
        state = body_read(twin->values[graph->from[k]], twin->count[graph->from[k]], state);
    body_write(twin->values[i], twin->count[i], (uint64_t)(graph->cost[i] * BODY_TURNS_A_SECOND),
               state);
}

static bool make_values(struct twin *twin)
{
    const struct compare_graph *graph = &twin->graph;
    twin->values = calloc(graph->n, sizeof *twin->values);
    twin->count = calloc(graph->n, sizeof *twin->count);
    for (size_t i = 0; i < graph->n; i++) {
        if (!twin->values || !twin->count)
            return false;
        twin->count[i] = body_values(graph->bytes[i]);
        twin->values[i] = calloc(twin->count[i], sizeof **twin->values);
        if (!twin->values[i])
            return false;
    }
    return true;
}

static uint64_t find_hash(const struct twin *twin)
{
    const struct compare_graph *graph = &twin->graph;
    uint64_t hash = 0;
    bool *read = calloc(graph->n, sizeof *read);
    for (size_t k = 0; read && k < graph->n_reads; k++)
        read[graph->from[k]] = true;
    for (size_t i = 0; read && i < graph->n; i++)
        if (!read[i])
            hash = body_hash(hash, twin->values[i][0]);
    free(read);
    return hash;
}

static int report(const struct twin *twin, const struct twin_runtime *runtime, double seconds,
                  double busy)
{
    FILE *out = twin->report ? fopen(twin->report, "w") : stdout;
    if (!out)
        return 1;
    fprintf(out,
            "{\n  \"graph\": \"%s\",\n  \"program\": \"%s\",\n  \"scheduler\": \"%s\",\n  "
            "\"steps\": %" PRIu64 ",\n  \"seconds_per_step\": %.9g,\n",
            twin->what, runtime->name, twin->scheduler, twin->rounds,
            seconds / (double)twin->rounds);
    if (runtime->busy)
        fprintf(out, "  \"busy_fraction\": %.6g,\n", busy / (seconds * twin->threads));
    fprintf(out, "  \"state_hash\": \"%016" PRIx64 "\"\n}\n", find_hash(twin));
    return twin->report ? fclose(out) != 0 : 0;
}

static double meet(const struct twin_runtime *runtime)
{
    struct timespec now;
    if (runtime->meet)
        runtime->meet();
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int run(struct twin *twin, const struct twin_runtime *runtime)
{
    enum { WARM = 2 };
    int code = runtime->start(twin);
    for (int warm = 0; warm < WARM && !code; warm++)
        code = runtime->round(twin);
    if (runtime->busy)
        runtime->busy(); /* from now on */
    const double begin = meet(runtime);
    for (uint64_t i = 0; i < twin->rounds && !code; i++)
        code = runtime->round(twin);
    const double seconds = meet(runtime) - begin, busy = runtime->busy ? runtime->busy() : 0;
    if (!code)
        code = runtime->stop(twin);
    return code || twin->rank ? code : report(twin, runtime, seconds, busy);
}

/* ---- The command line ---- */

static bool knows(const struct twin_runtime *runtime, const char *scheduler)
{
    for (size_t i = 0; runtime->scheduler(i); i++)
        if (!strcmp(runtime->scheduler(i), scheduler))
            return true;
    return false;
}

/* The names, each after a blank. */
static void list_schedulers(const struct twin_runtime *runtime, FILE *out)
{
    for (size_t i = 0; runtime->scheduler(i); i++)
        fprintf(out, " %s", runtime->scheduler(i));
    fputc('\n', out);
}

static bool take(struct twin *twin, const char *option, const char *value)
{
    if (!strcmp(option, "--report"))
        twin->report = value;
    else if (!strcmp(option, "--scheduler"))
        twin->scheduler = value;
    else if (!strcmp(option, "--threads"))
        twin->threads = atoi(value);
    else if (!strcmp(option, "--tasks"))
        twin->tasks = strtoul(value, NULL, 10);
    else if (!strcmp(option, "--cost"))
        twin->cost = strtod(value, NULL);
    else if (!strcmp(option, "--bytes"))
        twin->bytes = (uint32_t)strtoul(value, NULL, 10);
    else if (!strcmp(option, "--rounds"))
        twin->rounds = strtoull(value, NULL, 10);
    else
        return false;
    return true;
}

static int make_graph(struct twin *twin)
{
    if (compare_graph_is_file(twin->what))
        return compare_graph_read(&twin->graph, twin->what);
    return compare_graph_make(&twin->graph, twin->what, twin->tasks, twin->cost, twin->bytes, 1);
}

int twin_main(int argc, char **argv, const struct twin_runtime *runtime)
{
    struct twin twin = {.scheduler = runtime->usual,
                        .tasks = 1000,
                        .cost = 1e-5,
                        .bytes = 4096,
                        .rounds = 10,
                        .threads = 2};
    if (argc == 2 && !strcmp(argv[1], "--schedulers"))
        return list_schedulers(runtime, stdout), 0;
    bool fine = argc > 1;
    for (int i = 2; i < argc && fine; i += 2)
        fine = i + 1 < argc && take(&twin, argv[i], argv[i + 1]);
    if (!fine || twin.threads < 1 || !twin.rounds) {
        fprintf(stderr,
                "%s KIND|FILE [--scheduler NAME] [--threads N] [--tasks N] [--cost SECONDS] "
                "[--bytes N] [--rounds N] [--report FILE]\n"
                "%s --schedulers: prints the names of its schedulers\n",
                runtime->name, runtime->name);
        return 2;
    }
    if (!knows(runtime, twin.scheduler)) {
        fprintf(stderr, "%s: --scheduler %s: there is no scheduler of this name; known are",
                runtime->name, twin.scheduler);
        list_schedulers(runtime, stderr);
        return 2;
    }
    twin.what = argv[1];
    int failed = make_graph(&twin);
    if (!failed && (failed = !make_values(&twin) || run(&twin, runtime)))
        fprintf(stderr, "%s: it failed\n", runtime->name);
    for (size_t i = 0; i < twin.graph.n && twin.values; i++)
        free(twin.values[i]);
    free(twin.values);
    free(twin.count);
    compare_graph_free(&twin.graph);
    return failed;
}
