/* Start and stop: the parts are started from the bottom up and stopped from the top down; what
 * failed half-way is stopped by the same path. All ranks agree on whether a start succeeded. */
#include "runtime/api/instance.h"

#include "runtime/balance/balance.h"
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/pool.h"
#include "runtime/comm/host.h"
#include "runtime/map/map.h"
#include "runtime/offload/away.h"
#include "runtime/sched/sched.h"
#include "runtime/workers/topology.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

/* ---- MPI ---- */

static _Atomic int alive; /* runtimes that are not stopped, or were cut off from other ranks */

/* MPI cannot be initialised twice: what start initialised stays until the process ends, so that
 * start and stop may repeat. A process that ends without a stop leaves MPI as it is: workers still
 * call it, and other ranks wait for what does not come any more. */
static void finalise_at_exit(void)
{
    int over = 1;
    if (!atomic_load(&alive) && !MPI_Finalized(&over) && !over)
        MPI_Finalize();
}

static int start_mpi(void)
{
    int running = 0, over = 0, level = 0;
    if (MPI_Initialized(&running) || MPI_Finalized(&over))
        return base_error(DUITE_E_MPI, "MPI_Initialized failed");
    if (over)
        return base_error(DUITE_E_MPI, "MPI was finalised before duite_start");
    if (!running) {
        if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &level))
            return base_error(DUITE_E_MPI, "MPI_Init_thread failed");
        atexit(finalise_at_exit);
    }
    if (MPI_Query_thread(&level) || level < MPI_THREAD_SERIALIZED)
        return base_error(DUITE_E_MPI,
                          "MPI gives thread support %d, less than MPI_THREAD_SERIALIZED: "
                          "initialise it by MPI_Init_thread, or leave it to duite_start",
                          level);
    return DUITE_OK;
}

/* ---- Start ---- */

static uint64_t hash_kernels(const struct task_graph *graph)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < graph->n_kernels; i++) {
        const duite_kernel *k = graph->kernels[i];
        uint64_t args_size = k->args_size;
        hash = XXH64(k->name, strlen(k->name) + 1, hash);
        hash = XXH64(k->access, sizeof k->access, hash);
        hash = XXH64(&k->rest, sizeof k->rest, hash);
        uint64_t replicated = k->replicated != 0;
        hash = XXH64(&args_size, sizeof args_size, hash);
        hash = XXH64(&replicated, sizeof replicated, hash);
        hash = data_law_hash_kernel(k, hash);
    }
    return hash;
}

/* What must be the same on all ranks, and what they tell one another besides. */
struct started {
    uint64_t kernels, laws, seed, scheduler, mapping, balance;
    uint64_t traced, first, end; /* the name of the trace, 0: there is none; and of which steps */
    double lost_seconds;         /* that of rank 0 counts */
    char host[64];
};

#define EITHER(field, variable) ": options." field ", or " variable " in the environment"

static const char *difference(const struct started *a, const struct started *b)
{
    if (a->kernels != b->kernels)
        return "kernels";
    if (a->laws != b->laws)
        return "laws";
    if (a->seed != b->seed)
        return "seeds" EITHER("seed", "DUITE_SEED");
    if (a->scheduler != b->scheduler)
        return "schedulers" EITHER("scheduler", "DUITE_SCHEDULER");
    if (a->mapping != b->mapping)
        return "mappings" EITHER("mapping", "DUITE_MAPPING");
    if (a->traced != b->traced)
        return "traces" EITHER("trace", "DUITE_TRACE");
    if (a->first != b->first || a->end != b->end)
        return "traced steps: options.trace_first and options.trace_end";
    return a->balance != b->balance ? "balancers" EITHER("balance", "DUITE_BALANCE") : NULL;
}

static int compare(const struct started *all, int n, int rank)
{
    for (int i = 1; i < n; i++)
        if (difference(&all[0], &all[i]))
            return base_error(DUITE_E_DIFFERENT,
                              "ranks 0 and %d start with different %s (seen on rank %d)", i,
                              difference(&all[0], &all[i]), rank);
    return DUITE_OK;
}

/* Did all ranks come so far? If not, the first of the ranks that failed worst says why. */
static int agree_on_code(MPI_Comm mpi, int code)
{
    struct {
        int code, rank;
    } own = {.code = code > 0 ? 0 : code}, worst = {0};
    char why[1024] = "";
    MPI_Comm_rank(mpi, &own.rank);
    if (MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MINLOC, mpi))
        return base_error(DUITE_E_MPI, "MPI_Allreduce failed");
    if (!worst.code)
        return code;
    if (own.rank == worst.rank)
        snprintf(why, sizeof why, "%s", duite_message());
    if (MPI_Bcast(why, sizeof why, MPI_CHAR, worst.rank, mpi))
        snprintf(why, sizeof why, "%s", duite_code_text(worst.code));
    if (code)
        return code;
    return base_error(worst.code == DUITE_E_MEMORY ? DUITE_E_MEMORY : DUITE_E_DIFFERENT,
                      "duite_start failed on rank %d: %s", worst.rank, why);
}

static struct started own_start(const duite *rt, const duite_options *options)
{
    struct started own = {
        .seed = options->seed,
        .kernels = hash_kernels(&rt->graph),
        .laws = data_laws_hash(options->laws, 0),
        .scheduler = XXH64(options->scheduler->name, strlen(options->scheduler->name), 0),
        .mapping = XXH64(options->mapping->name, strlen(options->mapping->name), 0),
        .balance = XXH64(options->balance->name, strlen(options->balance->name), 0),
        .traced = options->trace ? XXH64(options->trace, strlen(options->trace), 1) : 0,
        .first = options->trace ? options->trace_first : 0,
        .end = options->trace ? options->trace_end : 0,
        .lost_seconds = options->lost_seconds};
    if (gethostname(own.host, sizeof own.host - 1))
        strcpy(own.host, "(without a name)");
    return own;
}

/* All ranks succeed or all fail. */
static int agree(duite *rt, const duite_options *options, int code)
{
    size_t n = (size_t)rt->graph.n_ranks;
    struct started *all = code ? NULL : base_alloc(n * sizeof *all);
    if (!code && !all)
        code = base_no_memory("the ranks");
    code = agree_on_code(rt->mpi, code);
    if (!code) {
        const struct started own = own_start(rt, options);
        code = MPI_Allgather(&own, sizeof own, MPI_BYTE, all, sizeof own, MPI_BYTE, rt->mpi)
                   ? base_error(DUITE_E_MPI, "MPI_Allgather failed")
                   : compare(all, (int)n, rt->graph.rank);
    }
    if (!code)
        comm_ring(rt->comm, all[0].lost_seconds, all[((size_t)rt->graph.rank + n - 1) % n].host);
    base_free(all);
    return code;
}

static int start_graph(duite *rt, const duite_options *options)
{
    int rank, n;
    if (MPI_Comm_rank(rt->mpi, &rank) || MPI_Comm_size(rt->mpi, &n))
        return base_error(DUITE_E_MPI, "MPI_Comm_rank failed");
    rt->mapping.own = options->mapping;
    rt->balance = options->balance;
    rt->migration.due = 1;
    rt->seed = options->seed;
    rt->window = options->window;
    static const duite_kernel *const none[] = {NULL};
    int code = options_check_rest(options);
    int started = task_graph_start(&rt->graph, rank, n, code ? none : options->kernels,
                                   code ? NULL : options->laws);
    if (!code)
        code = started;
    rt->graph.rename_most = options->rename_bytes;
    if (!code && options->check)
        code = check_start(&rt->check);
    if (!code && n > 1)
        code = comm_start(&rt->comm, rt->mpi, &rt->graph, &rt->monitor);
    return code;
}

static int start_workers(duite *rt, const duite_options *options, int code)
{
    struct work_cores cores = {0};
    struct comm_host host = {.ranks = 1};
    unsigned threads = options->threads;
    if (!code)
        code = work_cores_find(&cores);
    /* Collective: a rank that failed takes part. */
    int asked = comm_host_find(&host, rt->mpi, cores.hash, cores.n, &threads);
    if (!code)
        code = asked;
    rt->threads = threads;
    rt->oversubscribed = host.total > cores.n;
    bool bind = options->bind && !rt->oversubscribed;
    if (!code)
        code = policies_watch(rt, options);
    if (!code && options->trace)
        code = traced_open(rt, options);
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
                                 .watchdog = rt->watchdog,
                                 .measures = options->mapping->map_tasks != NULL,
                                 .context = options->context,
                                 .rt = rt,
                                 .threads = threads,
                                 .seed = options->seed,
                                 .stuck_seconds = options->stuck_seconds,
                                 .spin_seconds = rt->oversubscribed ? 0 : options->spin_seconds,
                                 .cores = bind ? cores.unit + host.before : NULL});
    work_cores_free(&cores);
    return code;
}

/* ---- The end ---- */

bool instance_is_broken(const duite *rt)
{
    return rt->graph.broken || (rt->comm && comm_broken(rt->comm));
}

static bool nothing_left(void *context)
{
    duite *rt = context;
    uint64_t left = work_unfinished(rt->pool) + offload_guests(&rt->graph);
    return !left || (rt->comm && left == comm_stuck(rt->comm));
}

void instance_give_up(duite *rt)
{
    if (atomic_exchange(&rt->graph.given_up, 1))
        return;
    if (rt->comm && rt->graph.broken)
        comm_broke(rt->comm, rt->graph.broken, duite_message());
    if (rt->comm)
        comm_give_up(rt->comm, work_main(rt->pool));
    work_drain(rt->pool, nothing_left, rt);
    if (rt->comm && comm_is_cut(rt->comm))
        comm_part(rt->comm, work_main(rt->pool));
}

static void end(duite *rt)
{
    if (instance_is_broken(rt))
        instance_give_up(rt);
    work_stop(rt->pool);
    base_watchdog_stop(rt->watchdog);
    recorded_stop(rt); /* closes their channels */
    bool whole = comm_stop(rt->comm);
    trace_free(rt->trace, whole);
    if (whole)
        MPI_Comm_free(&rt->mpi);
    if (whole || !comm_is_cut(rt->comm)) /* else MPI would wait for the lost when it is finalised */
        atomic_fetch_sub(&alive, 1);
    task_graph_stop(&rt->graph);
    check_stop(rt->check);
    base_free(rt);
    base_pool_leave();
}

static int start_parts(duite *rt, MPI_Comm mpi, const duite_options *options)
{
    rt->mpi = mpi;
    base_pool_enter();
    return start_workers(rt, options, start_graph(rt, options));
}

int duite_start(duite **out, const duite_options *options)
{
    if (!out)
        return base_error(DUITE_E_ARGUMENT, "duite_start: nowhere to put the runtime");
    *out = NULL;
    int code = options_check(options);
    if (!code)
        code = start_mpi();
    if (code)
        return code;
    MPI_Comm mpi;
    if (MPI_Comm_dup(options->comm, &mpi))
        return base_error(DUITE_E_MPI, "MPI_Comm_dup failed");
    MPI_Comm_set_errhandler(mpi, MPI_ERRORS_RETURN);
    duite *rt = base_alloc_zero(sizeof *rt);
    code = agree_on_code(mpi, rt ? DUITE_OK : base_no_memory("the runtime"));
    if (code) {
        MPI_Comm_free(&mpi);
        base_free(rt);
        return code;
    }
    atomic_fetch_add(&alive, 1);
    /* From here on every rank comes to agree(), whatever fails. */
    code = agree(rt, options, start_parts(rt, mpi, options));
    if (code) {
        end(rt);
    } else {
        bool moves = options->balance->victim || options->balance->place ||
                     options->balance->migrate || options->mapping->map_tasks;
        if (rt->comm && moves)
            comm_measure(rt->comm);
        traced_begin(rt);
        comm_open(rt->comm, options->balance->victim != NULL);
        *out = rt;
    }
    return code;
}

/* ---- Stop ---- */

static int not_freed(const duite *rt)
{
    const struct data_table *table = &rt->graph.table;
    for (uint32_t slot = 1; slot < table->n_slots; slot++)
        if (table->object[slot].generation % 2)
            return base_error(
                DUITE_E_NOT_FREED, "%u objects were not freed; the first is %u.%u, %zu bytes",
                table->n_alive, slot, table->object[slot].generation, table->object[slot].bytes);
    return recorded_left(rt);
}

int duite_stop(duite **out)
{
    if (!out || !*out)
        return base_error(DUITE_E_ARGUMENT, "duite_stop: no runtime");
    duite *rt = *out;
    if (!work_may_fork(rt->pool))
        return base_error(DUITE_E_STATE, "duite_stop is for the main thread, outside of bodies");
    if (rt->building || rt->mpi_held)
        return program_enter(rt, "duite_stop");
    const uint64_t from = rt->trace ? base_ticks() : 0;
    int code = program_wait(rt, "duite_stop");
    trace_wait(rt->trace, from);
    if (!code)
        code = not_freed(rt);
    const int traced = instance_is_broken(rt) ? DUITE_OK : traced_end(rt, "duite_stop");
    if (!code)
        code = traced;
    end(rt);
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
    if (!rt->comm || !comm_is_cut(rt->comm))
        return base_error(
            DUITE_E_STATE,
            "duite_abandon: no rank is lost and MPI did not fail; duite_stop ends it");
    if (rt->mpi_held)
        duite_mpi_end(rt);
    end(rt);
    *out = NULL;
    return DUITE_OK;
}
