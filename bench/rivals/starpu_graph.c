/* starpu-graph: the twin of duite-graph with StarPU, whose schedulers are all there: tasks are
 * inserted in each round, one process. */
#include "bench/rivals/twin.h"

#include <starpu.h>
#include <stdlib.h>

struct task {
    const struct twin *twin;
    size_t number;
};

static struct task *tasks;
static starpu_data_handle_t *handles;
static struct starpu_data_descr *data; /* of the task that is being submitted */

static void body(void *buffers[], void *argument)
{
    const struct task *task = argument;
    (void)buffers; /* on this machine's cores alone: the values themselves */
    twin_body(task->twin, task->number);
}

static struct starpu_codelet codelet = {
    .cpu_funcs = {body}, .nbuffers = STARPU_VARIABLE_NBUFFERS, .name = "work"};

static int submit(const struct compare_graph *graph, size_t i)
{
    int n = 1;
    data[0] = (struct starpu_data_descr){handles[i], STARPU_W};
    for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++)
        data[n++] = (struct starpu_data_descr){handles[graph->from[k]], STARPU_R};
    return starpu_task_insert(&codelet, STARPU_DATA_MODE_ARRAY, data, n, STARPU_CL_ARGS_NFREE,
                              &tasks[i], sizeof tasks[i], 0);
}

static int run_round(struct twin *twin)
{
    int code = 0;
    for (size_t i = 0; i < twin->graph.n && !code; i++)
        code = submit(&twin->graph, i);
    starpu_task_wait_for_all();
    return code;
}

static int start(struct twin *twin)
{
    const size_t n = twin->graph.n;
    struct starpu_conf conf;
    unsetenv("STARPU_SCHED"); /* it would count more than the name here */
    tasks = calloc(n, sizeof *tasks);
    handles = calloc(n, sizeof(starpu_data_handle_t));
    data = calloc(compare_graph_most_reads(&twin->graph) + 1, sizeof *data);
    if (!tasks || !handles || !data || starpu_conf_init(&conf))
        return 1;
    conf.ncpus = twin->threads;
    conf.ncuda = conf.nopencl = 0;
    conf.sched_policy_name = twin->scheduler;
    if (starpu_init(&conf))
        return 1;
    starpu_profiling_status_set(STARPU_PROFILING_ENABLE);
    for (size_t i = 0; i < n; i++) {
        tasks[i] = (struct task){twin, i};
        starpu_vector_data_register(&handles[i], STARPU_MAIN_RAM, (uintptr_t)twin->values[i],
                                    (uint32_t)twin->count[i], sizeof **twin->values);
    }
    return 0;
}

static int stop(struct twin *twin)
{
    for (size_t i = 0; i < twin->graph.n; i++)
        starpu_data_unregister(handles[i]);
    starpu_shutdown();
    free(tasks);
    free(handles);
    free(data);
    return 0;
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

static const char *scheduler(size_t i)
{
    struct starpu_sched_policy *policy = starpu_sched_get_predefined_policies()[i];
    return policy ? policy->policy_name : NULL;
}

int main(int argc, char **argv)
{
    static const struct twin_runtime runtime = {.name = "starpu-graph",
                                                .usual = "lws",
                                                .scheduler = scheduler,
                                                .start = start,
                                                .round = run_round,
                                                .busy = busy,
                                                .stop = stop};
    return twin_main(argc, argv, &runtime);
}
