/* The cases with StarPU: its scheduler lws, tasks made from plain structures (not by the slower
 * starpu_task_insert), dependences from the data's access modes. */
#include "bench/problem.h"
#include "bench/serve.h"

#include <starpu.h>
#include <stdio.h>
#include <stdlib.h>

struct state {
    unsigned threads; /* StarPU runs with so many workers; 0: not yet */
    uint64_t *mark;   /* of the independent tasks */
};

static struct state state;

/* ---- Codelets ---- */

static uint64_t *parameter(void *buffer)
{
    return (uint64_t *)STARPU_VARIABLE_GET_PTR(buffer);
}

static void combine(void *buffers[], void *args)
{
    (void)args;
    problem_combine(parameter(buffers[0]), parameter(buffers[1]), parameter(buffers[2]),
                    parameter(buffers[3]));
}

static void nothing(void *buffers[], void *args)
{
    (void)buffers;
    (void)args;
}

static void next(void *buffers[], void *args)
{
    problem_next(parameter(buffers[0]), (uintptr_t)args);
}

static void leave_mark(void *buffers[], void *args)
{
    (void)buffers;
    problem_mark(state.mark, (uintptr_t)args);
}

static struct starpu_codelet combine_codelet = {
    .cpu_funcs = {combine}, .nbuffers = 4, .modes = {STARPU_R, STARPU_R, STARPU_R, STARPU_W}};
static struct starpu_codelet nothing_codelet = {
    .cpu_funcs = {nothing}, .nbuffers = 4, .modes = {STARPU_R, STARPU_R, STARPU_R, STARPU_W}};
static struct starpu_codelet next_codelet = {
    .cpu_funcs = {next}, .nbuffers = 1, .modes = {STARPU_RW}};
static struct starpu_codelet mark_codelet = {.cpu_funcs = {leave_mark}, .nbuffers = 0};

static int ready(struct serve_request *request)
{
    unsigned threads = (unsigned)serve_number(request, "threads");
    struct starpu_conf conf;
    if (state.threads == threads)
        return 0;
    if (state.threads || starpu_conf_init(&conf))
        return serve_fail("StarPU's number of workers cannot change");
    conf.ncpus = (int)threads;
    conf.ncuda = conf.nopencl = 0;
    conf.sched_policy_name = "lws";
    if (starpu_init(&conf))
        return serve_fail("starpu_init failed");
    state.threads = threads;
    return 0;
}

/* A task of a codelet; StarPU frees it. */
static int submit(struct starpu_codelet *codelet, uintptr_t argument,
                  const starpu_data_handle_t *handles)
{
    struct starpu_task *task = starpu_task_create();
    task->cl = codelet;
    task->cl_arg = (void *)argument; /* nothing to copy: its size stays 0 */
    for (int i = 0; i < codelet->nbuffers; i++)
        task->handles[i] = handles[i];
    return starpu_task_submit(task) ? serve_fail("starpu_task_submit failed") : 0;
}

/* ---- Stencil ---- */

static double time_stencil(starpu_data_handle_t *const field[2], size_t points, size_t steps,
                           struct starpu_codelet *codelet, int *code)
{
    double start = serve_seconds();
    for (size_t s = 0; s < steps && !*code; s++) {
        const starpu_data_handle_t *old = field[s % 2], *new = field[1 - s % 2];
        for (size_t i = 0; i < points; i++) {
            const starpu_data_handle_t handles[] = {old[i ? i - 1 : points - 1], old[i],
                                                    old[i + 1 < points ? i + 1 : 0], new[i]};
            *code |= submit(codelet, 0, handles);
        }
    }
    starpu_task_wait_for_all();
    return serve_seconds() - start;
}

static int stencil(void *context, struct serve_request *request, double *value)
{
    size_t points = serve_number(request, "points"), steps = serve_number(request, "steps");
    struct problem_cell *cell[2];
    int code = ready(request);
    (void)context;
    if (code)
        return code;
    starpu_data_handle_t *handle = calloc(2 * points, sizeof *handle);
    if (!handle || problem_fields(cell, points)) {
        free(handle);
        return serve_no_memory();
    }
    for (size_t i = 0; i < 2 * points; i++)
        starpu_variable_data_register(&handle[i], STARPU_MAIN_RAM, (uintptr_t)&cell[0][i].value,
                                      sizeof(uint64_t));
    starpu_data_handle_t *const field[] = {handle, handle + points};
    time_stencil(field, points, steps, &combine_codelet, &code);
    *value = 0;
    for (size_t i = 0; i < points; i++) {
        starpu_data_acquire(field[steps % 2][i], STARPU_R);
        starpu_data_release(field[steps % 2][i]);
    }
    if (!code && problem_stencil_wrong(cell[steps % 2], points, steps))
        code = serve_fail("wrong answer");
    *value = time_stencil(field, points, steps, &nothing_codelet, &code);
    for (size_t i = 0; i < 2 * points; i++)
        starpu_data_unregister(handle[i]);
    free(cell[0]);
    free(handle);
    return code;
}

/* ---- Chain ---- */

static double time_chain(starpu_data_handle_t handle, uint64_t n, int *code)
{
    double start = serve_seconds();
    for (uint64_t i = 0; i < n && !*code; i++)
        *code = submit(&next_codelet, i, &handle);
    starpu_task_wait_for_all();
    return serve_seconds() - start;
}

static int chain(void *context, struct serve_request *request, double *value)
{
    static problem_link *const volatile body = problem_next;
    uint64_t n = serve_number(request, "tasks"), warm = 0, x = 0;
    starpu_data_handle_t handle;
    int code = ready(request);
    (void)context;
    if (code)
        return code;
    starpu_variable_data_register(&handle, STARPU_MAIN_RAM, (uintptr_t)&warm, sizeof warm);
    time_chain(handle, n, &code);
    starpu_data_unregister(handle);
    starpu_variable_data_register(&handle, STARPU_MAIN_RAM, (uintptr_t)&x, sizeof x);
    *value = time_chain(handle, n, &code);
    starpu_data_unregister(handle);
    if (!code && x != problem_chain(n, &body))
        code = serve_fail("wrong answer");
    return code;
}

/* ---- Independent tasks ---- */

static double time_independent(uint64_t n, int *code)
{
    double start = serve_seconds();
    for (uint64_t i = 0; i < n && !*code; i++)
        *code = submit(&mark_codelet, i, NULL);
    starpu_task_wait_for_all();
    return serve_seconds() - start;
}

static int independent(void *context, struct serve_request *request, double *value)
{
    uint64_t n = serve_number(request, "tasks");
    int code = ready(request);
    (void)context;
    if (code)
        return code;
    state.mark = calloc(n, sizeof *state.mark);
    if (!state.mark)
        return serve_no_memory();
    time_independent(n, &code);
    if (!code && problem_marks_wrong(state.mark, n))
        code = serve_fail("wrong answer");
    *value = time_independent(n, &code);
    if (!code && problem_marks_wrong(state.mark, n))
        code = serve_fail("wrong answer");
    free(state.mark);
    return code;
}

int main(void)
{
    static const struct serve_run runs[] = {
        {"stencil", stencil}, {"chain", chain}, {"independent", independent}, {0}};
    const struct serve_run *const all[] = {runs, NULL};
    char settings[200];
    snprintf(settings, sizeof settings,
             "StarPU %d.%d.%d, scheduler lws, a worker a core, "
             "starpu_task_submit by the main thread",
             STARPU_MAJOR_VERSION, STARPU_MINOR_VERSION, STARPU_RELEASE_VERSION);
    int status = serve(settings, all, NULL);
    if (state.threads)
        starpu_shutdown();
    return status;
}
