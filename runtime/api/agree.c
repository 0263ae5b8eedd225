/* A start succeeds on all ranks or on none, with the same kernels, laws, seed and policies on all.
 * Each rank sends one word of fixed size; all compare all words, so all find the same first
 * difference. A kernel that is added later is part of the fingerprint of calls. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

static uint64_t kernel_hash(const duite_kernel *k, uint64_t hash)
{
    uint64_t args_size = k->args_size;
    hash = XXH64(k->name, strlen(k->name) + 1, hash);
    hash = XXH64(k->access, sizeof k->access, hash);
    hash = XXH64(&k->variadic, sizeof k->variadic, hash);
    uint64_t replicated = k->replicated != 0;
    hash = XXH64(&args_size, sizeof args_size, hash);
    hash = XXH64(&replicated, sizeof replicated, hash);
    uint64_t events = k->events != 0;
    hash = XXH64(&events, sizeof events, hash);
    return data_law_hash_kernel(k, hash);
}

static uint64_t start_hash_kernels(const struct task_graph *graph)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < graph->n_kernels; i++)
        hash = kernel_hash(graph->kernels[i], hash);
    return hash;
}

/* Values that must be the same on all ranks, and more that they report to one another. */
struct start_word {
    uint64_t kernels, laws, seed, scheduler, mapping, balance;
    uint64_t traced, first, end; /* hash of the trace's name, 0: there is none; its steps */
    double lost_seconds;         /* rank 0's counts, as does: */
    uint64_t reported;
    unsigned workers;
    char host[64];
};

#define EITHER(field, variable) ": options." field ", or " variable " in the environment"

static const char *start_difference(const struct start_word *a, const struct start_word *b)
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

static int start_compare(const struct start_word *all, int n, int rank)
{
    for (int i = 1; i < n; i++)
        if (start_difference(&all[0], &all[i]))
            return base_error(DUITE_E_DIFFERENT,
                              "ranks 0 and %d start with different %s (seen on rank %d)", i,
                              start_difference(&all[0], &all[i]), rank);
    return DUITE_OK;
}

int api_agree_on_code(MPI_Comm mpi, int code)
{
    struct {
        int code, rank;
    } own = {.code = code > 0 ? 0 : code}, worst = {0};
    char why[1024] = "";
    if (COMM_MPI(MPI_Comm_rank, mpi, &own.rank) ||
        COMM_MPI(MPI_Allreduce, &own, &worst, 1, MPI_2INT, MPI_MINLOC, mpi))
        return DUITE_E_MPI;
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

static struct start_word start_own(const duite *rt, const duite_options *options)
{
    struct start_word own = {
        .seed = options->seed,
        .kernels = start_hash_kernels(&rt->graph),
        .laws = data_laws_hash(options->laws, 0),
        .scheduler = XXH64(options->scheduler->name, strlen(options->scheduler->name), 0),
        .mapping = XXH64(options->mapping->name, strlen(options->mapping->name), 0),
        .balance = XXH64(options->balance->name, strlen(options->balance->name), 0),
        .traced = options->trace ? XXH64(options->trace, strlen(options->trace), 1) : 0,
        .first = options->trace ? options->trace_first : 0,
        .end = options->trace ? options->trace_end : 0,
        .lost_seconds = options->lost_seconds,
        .reported = options->report != NULL,
        .workers = rt->share.workers};
    if (gethostname(own.host, sizeof own.host - 1))
        strcpy(own.host, "(without a name)");
    return own;
}

int api_agree_at_start(duite *rt, const duite_options *options, int code)
{
    size_t n = (size_t)rt->graph.n_ranks;
    struct start_word *all = code ? NULL : base_alloc(n * sizeof *all);
    if (!code && !all)
        code = base_no_memory("the ranks");
    code = api_agree_on_code(rt->mpi, code);
    if (!code) {
        const struct start_word own = start_own(rt, options);
        code =
            COMM_MPI(MPI_Allgather, &own, sizeof own, MPI_BYTE, all, sizeof own, MPI_BYTE, rt->mpi);
        if (!code)
            code = start_compare(all, (int)n, rt->graph.rank);
    }
    rt->report.wanted = !code && all[0].reported;
    for (size_t r = 0; r < n && !code; r++)
        rt->report.workers += all[r].workers;
    if (!code)
        comm_ring(rt->comm, all[0].lost_seconds, all[((size_t)rt->graph.rank + n - 1) % n].host);
    base_free(all);
    return code;
}

/* ---- Kernels that are added ---- */

/* Readers of kernels that have no task are kept away: reports, and sentences about ranks that
 * differ. */
static int kernel_add(duite *rt, const duite_kernel *kernel)
{
    struct task_graph *graph = &rt->graph;
    work_hold_reports(rt->pool);
    comm_guests_hold(&graph->guests, rt);
    int code = task_kernel_add(graph, kernel);
    if (!code && rt->comm)
        comm_set_kernels(rt->comm, graph->kernels, graph->n_kernels);
    comm_guests_let_go(&graph->guests);
    work_let_reports_go(rt->pool);
    if (!code)
        code = work_kernel_added(rt->pool);
    if (!code)
        trace_kernels(rt->trace);
    return code;
}

/* No task is left on any rank while a rank adds it, and none is forked before all ranks have it:
 * the task might be delegated to one that has not. */
int duite_kernel_add(duite *rt, const duite_kernel *kernel)
{
    const struct work_why why = {"duite_kernel_add", "the other ranks to add the kernel", NULL};
    struct comm_word own = {0};
    int code = api_enter(rt, why.call);
    if (code)
        return code;
    if (!kernel)
        return api_remember(rt,
                            base_error(DUITE_E_ARGUMENT, "duite_kernel_add: the kernel is NULL"));
    const int wrong = task_kernel_check(&rt->graph, kernel);
    if (wrong == DUITE_E_MEMORY)
        return api_remember(rt, wrong);
    task_mix(&rt->graph, wrong ? (uint64_t)wrong : kernel_hash(kernel, 0));
    code = api_meet(rt, why.call, NULL);
    if (code)
        return code;
    code = wrong ? task_kernel_check(&rt->graph, kernel) : kernel_add(rt, kernel);
    if (code)
        return api_remember(rt, code);
    return rt->comm ? api_collective(rt, &why, COMM_AGREES, &own) : DUITE_OK;
}
