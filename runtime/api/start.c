/* Start and stop: the parts start from the bottom up and stop from the top down; a start that
 * failed half-way stops by the same path (instance_end). */
#include "runtime/api/instance.h"

#include "runtime/balance/balance.h"
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/map/map.h"
#include "runtime/offload/offload.h"
#include "runtime/sched/sched.h"
#include "runtime/task/event.h"
#include "runtime/workers/topology.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

/* ---- MPI ---- */

static _Atomic int
    alive; /* runtimes not yet stopped, or cut off from other ranks when they stopped */

/* MPI cannot be initialised twice: if start initialised it, it stays until the process ends, so
 * that start and stop may repeat. A process that ends without a stop does not finalise MPI: workers
 * still call it, and other ranks wait for messages that never come. */
static void mpi_finalise_at_exit(void)
{
    int over = 1;
    if (!atomic_load(&alive) && !MPI_Finalized(&over) && !over)
        MPI_Finalize();
}

static int instance_start_mpi(void)
{
    int running = 0, over = 0, level = 0;
    if (MPI_Initialized(&running) || MPI_Finalized(&over)) /* MPI may not yet tell reasons */
        return base_error(DUITE_E_MPI, "MPI_Initialized failed");
    if (over)
        return base_error(DUITE_E_MPI, "MPI was finalised before duite_start");
    if (!running) {
        if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &level))
            return base_error(DUITE_E_MPI, "MPI_Init_thread failed");
        atexit(mpi_finalise_at_exit);
    }
    if (MPI_Query_thread(&level) || level < MPI_THREAD_SERIALIZED)
        return base_error(DUITE_E_MPI,
                          "MPI gives thread support %d, less than MPI_THREAD_SERIALIZED: "
                          "initialise it by MPI_Init_thread, or leave it to duite_start",
                          level);
    if (level < MPI_THREAD_MULTIPLE && atomic_load(&alive))
        return base_error(DUITE_E_STATE,
                          "duite_start: this process has another runtime, or abandoned one, and "
                          "both would call MPI at the same time: stop it first, or initialise MPI "
                          "with MPI_THREAD_MULTIPLE");
    return DUITE_OK;
}

static int instance_dup(MPI_Comm comm, MPI_Comm *mpi)
{
    int between;
    if (COMM_MPI(MPI_Comm_test_inter, comm, &between))
        return DUITE_E_MPI;
    if (between)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_start: the communicator (comm) is between two groups; "
                          "MPI_Intercomm_merge makes one group of them");
    const int code = COMM_MPI(MPI_Comm_dup, comm, mpi);
    return code ? code : COMM_MPI(MPI_Comm_set_errhandler, *mpi, MPI_ERRORS_RETURN);
}

/* ---- Start ---- */

static int instance_start_graph(duite *rt, const duite_options *options)
{
    int rank, n;
    if (COMM_MPI(MPI_Comm_rank, rt->mpi, &rank) || COMM_MPI(MPI_Comm_size, rt->mpi, &n))
        return DUITE_E_MPI;
    rt->mapping.own = options->mapping;
    rt->balance = options->balance;
    rt->migration.due = 1;
    rt->seed = options->seed;
    rt->window = options->window;
    static const duite_kernel *const none[] = {NULL};
    int code = api_check_options_rest(options);
    const duite_kernel **kernels = api_add_kernels(code ? none : options->kernels);
    int started = !kernels
                      ? base_no_memory("the list of kernels")
                      : task_graph_start(&rt->graph, rank, n, kernels, code ? NULL : options->laws);
    base_free(kernels);
    api_watch_turns(&rt->graph);
    if (!code)
        code = started;
    if (!code && options->check)
        code = check_start(&rt->check);
    if (!code && n > 1)
        code = comm_start(&rt->comm, rt->mpi,
                          &(struct comm_setup){.owner = &work_messages,
                                               .context = &rt->graph,
                                               .history = rt->graph.history,
                                               .table = &rt->graph.table,
                                               .kernels = rt->graph.kernels,
                                               .n_kernels = rt->graph.n_kernels,
                                               .monitor = &rt->monitor,
                                               .report = options->trace ? &work_report : NULL});
    comm_guests_start(&rt->graph.guests, rt->comm, work_guest_over, &rt->graph);
    return code;
}

/* Starts to recognise repeated forks, if that is wanted and possible. */
static int instance_start_memo(duite *rt, const duite_options *options)
{
    if (!options->memo || rt->comm || rt->trace || options->check)
        return DUITE_OK;
    rt->memo = plan_memo_new(&rt->graph, rt->worker, options->memo > 1);
    return rt->memo ? DUITE_OK : base_no_memory("the runtime");
}

/* Collective. If other processes may use the rank's cores, its workers sleep when they are more
 * than its share. They are not bound, as all processes would bind to the first cores. */
static int instance_share(duite *rt, const duite_options *options, const struct work_cores *cores,
                          struct comm_host *host)
{
    int code = comm_host_find(host, rt->mpi, cores->hash);
    work_share_find(&(struct work_surroundings){.cores = cores->n,
                                                .ranks = host->ranks,
                                                .asked = options->threads,
                                                .cgroups = WORK_CGROUPS,
                                                .mounted = WORK_CGROUP_ROOT},
                    &rt->share);
    if (!code)
        code = comm_host_count(host, rt->share.workers);
    rt->oversubscribed =
        host->total > cores->n || (rt->share.limited && rt->share.workers > rt->share.cores);
    return code;
}

static int instance_start_workers(duite *rt, const duite_options *options, int code)
{
    struct work_cores cores = {0};
    struct comm_host host = {.ranks = 1};
    if (!code)
        code = work_cores_find(&cores);
    /* Collective: a failed rank takes part. */
    int asked = instance_share(rt, options, &cores, &host);
    if (!code)
        code = asked;
    bool bind = options->bind && !rt->oversubscribed && !rt->share.limited;
    if (!code)
        code = api_mark_policies(rt, options);
    if (!code && options->trace)
        code = trace_open(&rt->trace, &(struct trace_setup){.file = options->trace,
                                                            .first = options->trace_first,
                                                            .end = options->trace_end,
                                                            .rank = rt->graph.rank,
                                                            .n_ranks = rt->graph.n_ranks,
                                                            .workers = rt->share.workers,
                                                            .graph = &rt->graph});
    if (!code)
        code = api_report_open(rt, options);
    if (!code)
        code = work_start(
            &rt->pool,
            &(struct work_setup){.graph = &rt->graph,
                                 .comm = rt->comm,
                                 .check = rt->check,
                                 .trace = rt->trace,
                                 .scheduler = options->scheduler,
                                 .balancer = options->balance,
                                 .monitor = &rt->monitor,
                                 .marks = rt->marks,
                                 .measures = options->mapping->map_tasks != NULL,
                                 .context = options->context,
                                 .rt = rt,
                                 .threads = rt->share.workers,
                                 .seed = options->seed,
                                 .stuck_seconds = options->stuck_seconds,
                                 .spin_seconds = rt->oversubscribed ? 0 : options->spin_seconds,
                                 .cores = bind ? cores.unit + host.before : NULL});
    work_cores_free(&cores);
    rt->worker = rt->pool ? work_main(rt->pool) : NULL;
    rt->thread = task_thread_mark();
    return code ? code : instance_start_memo(rt, options);
}

/* ---- The end ---- */

bool api_is_broken(const duite *rt)
{
    return rt->graph.broken || comm_is_broken(rt->comm);
}

struct instance_leftovers {
    duite *rt;
    struct work_stillness still;
};

/* True if no task is left; or if nothing moves and a rank is lost, or requests of the program wait
 * for partners whose bodies never ran. Tasks that wait for transfers which MPI cannot finish then
 * stay where they are. */
static bool instance_has_nothing_left(void *context)
{
    struct instance_leftovers *leftovers = context;
    duite *rt = leftovers->rt;
    if (!work_unfinished(rt->pool) && !offload_count(&rt->graph))
        return true;
    return (comm_is_lost(rt->comm) || comm_guests_are_here(&rt->graph.guests)) &&
           !task_events_pending(&rt->graph) && work_stands_still(rt->pool, &leftovers->still);
}

void api_give_up(duite *rt)
{
    if (atomic_exchange(&rt->graph.given_up, 1))
        return;
    api_release_all(rt);
    if (rt->comm && rt->graph.broken)
        comm_break(rt->comm, rt->graph.broken, duite_message());
    if (rt->comm)
        comm_give_up(rt->comm, rt->worker);
    work_drain(rt->pool, instance_has_nothing_left, &(struct instance_leftovers){.rt = rt});
    if (comm_is_lost(rt->comm))
        comm_part(rt->comm, rt->worker);
}

static void instance_end(duite *rt)
{
    if (api_is_broken(rt))
        api_give_up(rt);
    task_events_settle(&rt->graph);
    work_stop(rt->pool);
    base_marks_stop(rt->marks);
    plan_memo_stop(rt->memo);
    api_graphs_stop(rt); /* closes their channels */
    api_gets_stop(rt);
    comm_guests_stop(&rt->graph.guests);
    bool whole = comm_stop(rt->comm);
    trace_free(rt->trace, whole);
    if (whole)
        MPI_Comm_free(&rt->mpi);
    if (whole || !comm_is_lost(rt->comm)) /* else MPI_Finalize would wait for the lost rank */
        atomic_fetch_sub(&alive, 1);
    task_graph_stop(&rt->graph);
    check_stop(rt->check);
    api_report_close(rt);
    base_free(rt);
    base_pool_leave();
}

static int instance_start_parts(duite *rt, MPI_Comm mpi, const duite_options *options)
{
    rt->mpi = mpi;
    base_pool_enter();
    return instance_start_workers(rt, options, instance_start_graph(rt, options));
}

int duite_start(duite **out, const duite_options *given)
{
    duite_options whole;
    const duite_options *options = &whole;
    if (!out)
        return base_error(DUITE_E_ARGUMENT, "duite_start: nowhere to put the runtime");
    *out = NULL;
    int code = api_take_options(given, &whole);
    if (!code)
        code = instance_start_mpi();
    if (code)
        return code;
    MPI_Comm mpi;
    code = instance_dup(options->comm, &mpi);
    if (code)
        return code;
    duite *rt = base_alloc_zero(sizeof *rt);
    code = api_agree_on_code(mpi, rt ? DUITE_OK : base_no_memory("the runtime"));
    if (code) {
        MPI_Comm_free(&mpi);
        base_free(rt);
        return code;
    }
    atomic_fetch_add(&alive, 1);
    /* From here on every rank comes to api_agree_at_start(), even if a part fails. */
    code = api_agree_at_start(rt, options, instance_start_parts(rt, mpi, options));
    if (code) {
        instance_end(rt);
    } else {
        bool moves = options->balance->victim || options->balance->place ||
                     options->balance->migrate || options->mapping->map_tasks;
        if (rt->comm && moves)
            comm_measure(rt->comm);
        api_trace_begin(rt, options);
        rt->report.began = base_seconds();
        comm_open(rt->comm, options->balance->victim != NULL);
        *out = rt;
    }
    return code;
}

/* ---- Stop ---- */

static int instance_not_freed(const duite *rt)
{
    const struct data_table *table = &rt->graph.table;
    for (uint32_t slot = 1; slot < table->n_slots; slot++)
        if (table->object[slot].generation % 2)
            return base_error(
                DUITE_E_NOT_FREED, "%u objects were not freed; the first is %u.%u, %zu bytes",
                table->n_alive, slot, table->object[slot].generation, table->object[slot].bytes);
    const int code = api_graphs_left(rt);
    return code ? code : api_gets_left(rt);
}

int duite_stop(duite **out)
{
    if (!out || !*out)
        return base_error(DUITE_E_ARGUMENT, "duite_stop: no runtime");
    duite *rt = *out;
    if (!work_may_fork(rt->pool))
        return base_error(DUITE_E_STATE, "duite_stop is for the main thread, outside of bodies");
    if (rt->turns && !api_is_broken(rt))
        return api_check_turns(rt, "duite_stop");
    if (rt->building || rt->mpi_held)
        return base_error(DUITE_E_STATE, "duite_stop: not %s",
                          rt->building ? "while a graph is recorded"
                                       : "between duite_mpi_begin and duite_mpi_end");
    const uint64_t from = rt->trace ? base_ticks() : 0;
    int code = api_wait(rt, "duite_stop");
    trace_wait(rt->trace, from);
    if (!code)
        code = instance_not_freed(rt);
    const int traced = api_is_broken(rt) ? DUITE_OK : api_trace_end(rt, "duite_stop");
    if (!code)
        code = traced;
    const int reported = api_report_write(rt, code);
    if (!code)
        code = reported;
    instance_end(rt);
    *out = NULL;
    return code;
}

int duite_abandon(duite **out)
{
    if (!out || !*out)
        return base_error(DUITE_E_ARGUMENT, "duite_abandon: no runtime");
    duite *rt = *out;
    if (!work_may_fork(rt->pool))
        return base_error(DUITE_E_STATE, "duite_abandon is for the main thread, outside of bodies");
    if (!comm_is_lost(rt->comm))
        return base_error(
            DUITE_E_STATE,
            "duite_abandon: no rank is lost and MPI did not fail; duite_stop ends it");
    if (rt->mpi_held)
        duite_mpi_end(rt);
    instance_end(rt);
    *out = NULL;
    return DUITE_OK;
}
