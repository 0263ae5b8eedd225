/* The twin of duite-graph with OpenMP tasks: built once with gcc as libgomp-graph and once with
 * clang as libomp-graph (RIVAL_SETTINGS is the name). One thread makes the tasks of a round, and
 * takes part when it waits for them. */
#include "bench/rivals/twin.h"

static int run_round(struct twin *twin)
{
    const struct compare_graph *graph = &twin->graph;
#pragma omp parallel num_threads(twin->threads)
#pragma omp master
    for (size_t i = 0; i < graph->n; i++) {
#pragma omp task depend(iterator(size_t k = graph->start[i]                                        \
                                 : graph->start[i + 1]),                                           \
                        in                                                                         \
                        : twin->values[graph->from[k]][0]) depend(out                              \
                                                                  : twin->values[i][0])            \
    firstprivate(i)
        twin_body(twin, i);
    }
    return 0;
}

static const char *scheduler(size_t i)
{
    return i ? NULL : "tasks";
}

static int nothing(struct twin *twin)
{
    (void)twin;
    return 0;
}

int main(int argc, char **argv)
{
    static const struct twin_runtime runtime = {.name = RIVAL_SETTINGS,
                                                .usual = "tasks",
                                                .scheduler = scheduler,
                                                .start = nothing,
                                                .round = run_round,
                                                .stop = nothing};
    return twin_main(argc, argv, &runtime);
}
