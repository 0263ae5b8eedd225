/* Runs random trees of tasks on duite and compares with the interpreter:
 *
 *     nested_programs [--seed SEED] [--programs N] [--threads T] [--scheduler NAME] [--balance
 * NAME] [--print]
 *
 * alone or under mpirun; all ranks run each program together. One TAP line. */

#include "runtime/balance/balance.h"
#include "runtime/sched/sched.h"
#include "tests/runtime/nested_program.h"
#include "tests/support/policies.h"

#include <getopt.h>
#include <mpi.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct settings {
    uint64_t seed;
    unsigned long programs;
    unsigned threads;
    const char *scheduler, *balance;
    bool print;
};

static struct nest_program program;
static struct nest_answers answers;
static _Atomic int ran[NEST_MAX_TASKS];
static duite_kernel kernels[NEST_KERNELS];
static const duite_kernel *list[NEST_KERNELS + 1];
static char names[NEST_KERNELS][8];
static char running[120];
static _Atomic int n_found;
static unsigned long recognised; /* tasks, of all programs */

/* Tells a difference; from any thread. */
__attribute__((format(printf, 1, 2))) static void found(const char *format, ...)
{
    char text[400];
    va_list list_of;

    va_start(list_of, format);
    vsnprintf(text, sizeof text, format, list_of);
    va_end(list_of);
    if (atomic_fetch_add(&n_found, 1) < 5)
        printf("# WRONG: %s: %s\n", running, text);
}

static const duite_law NEST_LAW = {.name = "nest", .combine = nest_law};
static const duite_law *const LAWS[NEST_LAWS] = {NULL, &duite_min, &duite_max, &NEST_LAW};

/* ---- Running ---- */

static int call_one(duite *rt, const struct nest_action *action, duite_object *object,
                    duite_object *made, unsigned char *value, size_t *count)
{
    duite_object objects[NEST_MAX_PARAMS];
    int code;

    for (unsigned i = 0; i < NEST_MAX_PARAMS; i++)
        objects[i] = object[action->object[i]];
    switch (action->kind) {
    case NEST_NEW:
        return action->sized ? duite_new_sized(rt, action->type, action->count, action->max, made)
                             : duite_new(rt, action->type, action->count, made);
    case NEST_FREE:
        return duite_free(rt, objects[0]);
    case NEST_SET:
        nest_values(action->type, action->count, action->seed, value);
        return action->seed ? duite_set_sized(rt, objects[0], value, action->count)
                            : duite_set(rt, objects[0], NULL);
    case NEST_FORK:
        return duite_fork_with(rt, &(duite_task_options){.priority = action->priority},
                               &kernels[nest_kernel(&program.task[action->task])], &action->task,
                               program.task[action->task].n, objects);
    case NEST_GET:
        *count = action->max;
        if (action->sized && (code = duite_get_count(rt, objects[0], count)))
            return code;
        return duite_get(rt, objects[0], value);
    default:
        return duite_wait(rt);
    }
}

/* What is recorded, and who names it. */
struct built {
    const struct nest_action *action; /* count of them follow it */
    duite_object *object;
};

static int build(duite *rt, void *context)
{
    const struct built *built = context;
    unsigned char value[NEST_MAX_COUNT * 8];
    size_t count;
    int code = 0;

    for (size_t i = 1; i <= built->action->count && !code; i++)
        code = call_one(rt, &built->action[i], built->object, NULL, value, &count);
    return code;
}

/* Forks without options, which alone are recognised. */
static int fork_rounds(duite *rt, const struct nest_action *action, const duite_object *object)
{
    int code = 0;

    for (size_t i = 0; i < action->max * action->count && !code; i++) {
        const struct nest_action *fork = &action[1 + i % action->count];
        const struct nest_task *task = &program.task[fork->task];
        duite_object objects[NEST_MAX_PARAMS];

        for (unsigned k = 0; k < task->n; k++)
            objects[k] = object[fork->object[k]];
        code = duite_fork(rt, &kernels[nest_kernel(task)], &fork->task, task->n, objects);
    }
    return code;
}

static int replay(duite *rt, const struct nest_action *action, duite_object *object)
{
    duite_graph graph;
    if (action->forked)
        return fork_rounds(rt, action, object);
    int code = duite_graph_new(rt, build, &(struct built){action, object}, &graph);

    if (code)
        return code;
    code = duite_replay(rt, graph, action->max);
    return code ? code : duite_graph_free(rt, graph);
}

/* What the task itself contributes. */
static void contribute(const duite_call *call, unsigned self, const struct nest_action *action)
{
    const duite_param *param = &call->param[action->object[0]];
    unsigned char *values = duite_contribute(call, action->object[0]);

    if (!values) {
        found("task %u: no contribution: %s", self, duite_message());
        return;
    }
    for (size_t b = 0; program.task[self].law % 3 == 0 && b < param->count; b++)
        if (values[b])
            found("task %u: a contribution of its own does not begin with zeros", self);
    nest_values(param->type, param->count, action->seed, values);
}

/* Does what a task does, or the main program (self 0, call NULL), whose answers are compared. */
static uint64_t act(duite *rt, const duite_call *call, unsigned self, duite_object *object,
                    uint64_t digest)
{
    const struct nest_task *task = &program.task[self];
    unsigned n = task->n;

    for (unsigned a = 0; a < task->n_actions; a++) {
        const struct nest_action *action = &task->action[a];
        const struct nest_answer *answer = &answers.of[a];
        const bool asks = action->kind == NEST_GET || action->kind == NEST_WAIT;
        _Alignas(8) unsigned char value[NEST_MAX_COUNT * 8] = {0};
        size_t count = 0;
        if (action->kind == NEST_CONTRIBUTE) {
            contribute(call, self, action);
            continue;
        }
        const int code = action->kind == NEST_REPLAY
                             ? replay(rt, action, object)
                             : call_one(rt, action, object, &object[n], value, &count);

        if (action->kind == NEST_REPLAY)
            a += (unsigned)action->count;

        n += action->kind == NEST_NEW;
        if (!asks && code)
            found("task %u, action %u: code %d: %s", self, a, code, duite_message());
        if (!asks)
            continue;
        digest = nest_mix(digest, &code, sizeof code);
        if (action->kind == NEST_GET && !code)
            digest = nest_mix(digest, value, count * nest_size(action->type));
        if (!self && code != answer->code)
            found("action %u: code %d, expected %d: %s", a, code, answer->code, duite_message());
        else if (!self && count * nest_size(action->type) != answer->bytes && !code && count)
            found("action %u: %zu elements", a, count);
        else if (!self && memcmp(value, answer->value, sizeof value) != 0)
            found("action %u: another value", a);
    }
    return digest;
}

static int body(const duite_call *call)
{
    const unsigned self = *(const unsigned *)call->args;
    const struct nest_task *task = &program.task[self];
    duite_object object[NEST_MAX_OBJECTS];

    atomic_fetch_add(&ran[self], 1);
    for (unsigned i = 0; i < task->n; i++) {
        const duite_mode mode = task->mode[i];
        const unsigned char *data = call->param[i].data;

        object[i] = call->param[i].object;
        if ((mode >= DUITE_RP) != !data)
            found("task %u, parameter %u: data or none", self, i);
        for (size_t b = 0; mode == DUITE_CW && task->law % 3 == 0 && b < call->param[i].count; b++)
            if (data[b])
                found("task %u, parameter %u: a contribution does not begin with zeros", self, i);
    }
    const uint64_t digest = act(call->rt, call, self, object, nest_read(task, call->param));

    for (unsigned i = 0; i < task->n; i++)
        if (task->sized[i] && (task->mode[i] == DUITE_W || task->mode[i] == DUITE_RW))
            duite_resize(call, i, nest_count(task, call->param, i, digest));
    nest_write(task, call->param, digest);
    return task->fails;
}

static void make_kernels(void)
{
    for (unsigned k = 0; k < NEST_KERNELS; k++) {
        const unsigned s = k % NEST_SIGNATURES;
        struct nest_task task = {.n = s < 1 ? 0 : s < 9 ? 1 : s < 73 ? 2 : 3};
        unsigned place = s - (s < 1 ? 0 : s < 9 ? 1 : s < 73 ? 9 : 73);

        for (unsigned i = task.n; i-- > 0; place /= 8)
            task.mode[i] = (duite_mode)(place % 8 + 1);
        snprintf(names[k], sizeof names[k], "k%u", k);
        kernels[k] = (duite_kernel){.name = names[k], .body = body, .args_size = sizeof(unsigned)};
        memcpy(kernels[k].access, task.mode, sizeof task.mode);
        for (unsigned i = 0; i < task.n; i++)
            if (task.mode[i] == DUITE_CW || task.mode[i] == DUITE_CWP)
                kernels[k].law[i] = LAWS[k / NEST_SIGNATURES];
        list[k] = &kernels[k];
    }
}

/* Every task ran once, on one rank, or not at all where poison says so; in checking mode those that
 * do not fork run twice. */
static void check_runs(bool checking)
{
    int here[NEST_MAX_TASKS], sum[NEST_MAX_TASKS];

    for (unsigned i = 0; i < NEST_MAX_TASKS; i++)
        here[i] = atomic_exchange(&ran[i], 0);
    MPI_Allreduce(here, sum, NEST_MAX_TASKS, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    for (unsigned i = 1; i < program.n_tasks; i++)
        if (sum[i] != answers.runs[i] && !(checking && sum[i] == 2 * answers.runs[i]))
            found("task %u ran %d times, expected %d", i, sum[i], answers.runs[i]);
}

static void run(const struct settings *settings)
{
    static const double spins[] = {0, 1e-6, 1e-4};
    static const size_t windows[] = {0, 0, 1, 3};
    uint64_t random = ~program.seed;
    duite_object object[NEST_MAX_OBJECTS];
    duite_options options = duite_options_default();
    duite_counters counters;
    duite *rt;

    options.kernels = list;
    options.laws = (const duite_law *const[]){&NEST_LAW, NULL};
    options.seed = duite_random(&random);
    options.mapping = duite_mapping_find("cyclic");
    options.spin_seconds = spins[duite_random(&random) % 3];
    options.threads = 1 + (unsigned)(duite_random(&random) % 4);
    size_t n = policies_count(duite_scheduler_names(), sched_test_names());
    const char *scheduler =
        policies_at(duite_scheduler_names(), sched_test_names(), duite_random(&random) % n);
    options.window = windows[duite_random(&random) % 4];
    if (settings->threads)
        options.threads = settings->threads;
    if (settings->scheduler)
        scheduler = settings->scheduler;
    options.scheduler = duite_scheduler_find(scheduler);
    n = policies_count(duite_balancer_names(), balance_test_names());
    const char *balance =
        settings->balance
            ? settings->balance
            : policies_at(duite_balancer_names(), balance_test_names(), duite_random(&random) % n);
    options.balance = duite_balancer_find(balance);
    snprintf(running, sizeof running, "--seed %llu --threads %u --scheduler %s --balance %s",
             (unsigned long long)program.seed, options.threads, scheduler, balance);
    if (duite_start(&rt, &options)) {
        found("start: %s", duite_message());
        return;
    }
    act(rt, NULL, 0, object, 0);
    if (duite_count_all(rt, &counters) == DUITE_OK)
        recognised += counters.recognised;
    const int code = duite_stop(&rt);
    if (code && code != DUITE_E_NOT_FREED && code < 0)
        found("stop: %s", duite_message());
    check_runs(options.check);
}

/* ---- The program ---- */

static void last_words(int signal_number)
{
    (void)signal_number;
    if (write(STDOUT_FILENO, "# hangs: ", 9) > 0 &&
        write(STDOUT_FILENO, running, strlen(running)) > 0 && write(STDOUT_FILENO, "\n", 1) > 0)
        _exit(99);
    _exit(98);
}

static bool read_options(int argc, char **argv, struct settings *settings)
{
    static const struct option options[] = {{"seed", 1, NULL, 's'},    {"programs", 1, NULL, 'p'},
                                            {"threads", 1, NULL, 't'}, {"scheduler", 1, NULL, 'q'},
                                            {"balance", 1, NULL, 'a'}, {"print", 0, NULL, 'v'},
                                            {NULL, 0, NULL, 0}};

    for (int c; (c = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        if (c == 's')
            settings->seed = strtoull(optarg, NULL, 10);
        else if (c == 'p')
            settings->programs = strtoul(optarg, NULL, 10);
        else if (c == 't')
            settings->threads = (unsigned)atoi(optarg);
        else if (c == 'q')
            settings->scheduler = optarg;
        else if (c == 'a')
            settings->balance = optarg;
        else if (c == 'v')
            settings->print = true;
        else
            return false;
    }
    return optind == argc && (!settings->scheduler || duite_scheduler_find(settings->scheduler)) &&
           (!settings->balance || duite_balancer_find(settings->balance));
}

/* Whether some rank found the program wrong. */
static bool try_one(const struct settings *settings, uint64_t seed)
{
    int rank, wrong, any = 0;

    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    atomic_store(&n_found, 0);
    alarm(60);
    nest_make(&program, seed);
    if (settings->print && rank == 0)
        nest_print(&program);
    if (!nest_interpret(&program, &answers))
        found("out of memory");
    else
        run(settings);
    wrong = atomic_load(&n_found) > 0;
    MPI_Allreduce(&wrong, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    alarm(0);
    return any;
}

int main(int argc, char **argv)
{
    struct settings settings = {.seed = 1, .programs = 1};
    unsigned long wrong = 0;
    int rank, given;

    signal(SIGALRM, last_words);
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (!read_options(argc, argv, &settings)) {
        fprintf(stderr,
                "%s: [--seed SEED] [--programs N] [--threads T] [--scheduler NAME] [--print]\n",
                argv[0]);
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
    make_kernels();
    for (unsigned long i = 0; i < settings.programs && wrong < 20; i++)
        wrong += try_one(&settings, settings.seed + i);
    if (rank == 0)
        printf("%sok 1 - %lu random trees of tasks, %lu wrong\n1..1\n# %lu tasks recognised\n",
               wrong ? "not " : "", settings.programs, wrong, recognised);
    MPI_Finalize();
    return wrong != 0;
}
