/* The programs of this bench are ours and the twin, both duite-bench under mpirun; which one a
 * process is its kind says. */
#include "bench/ranks/ranks.h"

#include <mpi.h>
#include <stdio.h>
#include <string.h>

static const struct bench_case *const CASES[] = {
    &ranks_cg,       &ranks_stencil, &ranks_loaded,  &ranks_forks, &ranks_memory,
    &ranks_delegate, &ranks_tree,    &ranks_migrate, &ranks_await, NULL};

/* For two ranks, or hosts, and the full sizes. */
static const struct measure_target TARGETS[] = {{"cg_r2_vs_twin", 1.1, false},
                                                {"cg_hosts2_vs_twin", 1.1, false},
                                                {"loaded_r2_vs_twin", 1.2, false},
                                                {"cg_bytes_vs_twin", 1.03, false},
                                                {"cg_messages_vs_twin", 1, false},
                                                {"stencil_step_vs_twin", 2, false},
                                                {"record_us_per_task", 0.6, false},
                                                {"prune_ns_per_task", 20, false},
                                                {"delegate_speedup_r2", 1.7, true},
                                                {"tree_speedup_r2", 1.5, true},
                                                {"memory_r4_vs_r1", 0.35, false},
                                                {"migrate_vs_balanced", 1.15, false},
                                                {"migrate_steps", 20, false},
                                                {"await_mpi_vs_twin", 1.1, false},
                                                {0}};
enum { TARGET_THREADS = 2 };

struct subject_shape ranks_ours(unsigned ranks, unsigned threads)
{
    return (struct subject_shape){"duite", ranks, threads};
}

struct subject_shape ranks_twin(unsigned ranks)
{
    return (struct subject_shape){"twin", ranks, 1};
}

struct subject_shape ranks_ours_on_hosts(unsigned hosts)
{
    return (struct subject_shape){"duite_hosts", hosts, 1};
}

struct subject_shape ranks_twin_on_hosts(unsigned hosts)
{
    return (struct subject_shape){"twin_hosts", hosts, 1};
}

bool ranks_on_hosts(void)
{
    return strstr(serve_kind(), "_hosts") != NULL;
}

/* Those of the cloth, and the one that waves the sheet. */
static const duite_kernel *const *kernels(void)
{
    static const duite_kernel *all[1 + FLOW_KERNELS_LISTED + 1] = {&sheet_wave_kernel};
    memcpy(all + 1, flow_kernels(), FLOW_KERNELS_LISTED * sizeof *all);
    return all;
}

int ranks_start(struct ranks_session *session, struct serve_request *request,
                duite_options *options, duite **rt)
{
    char scheduler[40];
    const int code = ranks_stop(&session->tasks.rt, 0);
    if (code)
        return code;
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    options->threads = (unsigned)serve_number(request, "threads");
    options->scheduler = duite_scheduler_find(scheduler);
    return tasks_code(duite_start(rt, options));
}

int ranks_start_cloth(struct ranks_session *session, struct serve_request *request, duite **rt)
{
    duite_options options = duite_options_default();
    options.kernels = kernels();
    options.context = session->sheet.flow;
    options.bind = !ranks_on_hosts(); /* hosts on one machine know nothing of each other's cores */
    return ranks_start(session, request, &options, rt);
}

int ranks_stop(duite **rt, int code)
{
    const int failed = *rt ? duite_stop(rt) : 0;
    return code ? code : tasks_code(failed);
}

int ranks_time_sum(duite *rt, const duite_kernel *kernel, const void *args, int64_t expected,
                   double *value)
{
    duite_object sum;
    int64_t got = 0;
    if (duite_new(rt, DUITE_I64, 1, &sum))
        return tasks_code(1);
    int code = duite_wait(rt);
    const double start = serve_seconds();
    if (!code)
        code = duite_fork(rt, kernel, args, 1, &sum);
    if (!code)
        code = duite_wait(rt);
    *value = serve_seconds() - start;
    if (!code)
        code = duite_get(rt, sum, &got);
    duite_free(rt, sum);
    if (code)
        return tasks_code(code);
    return got == expected ? 0 : serve_fail("wrong answer");
}

/* ---- Serving ---- */

static int serve_ours(const struct bench *bench)
{
    static struct ranks_session session;
    const struct serve_run *runs[sizeof CASES / sizeof *CASES] = {NULL};
    for (size_t i = 0; bench->cases[i]; i++)
        runs[i] = bench->cases[i]->runs;
    int status = serve("duite_options_default() but for threads and scheduler; on hosts of one "
                       "machine nobody is bound",
                       runs, &session);
    if (session.tasks.rt && duite_stop(&session.tasks.rt)) {
        fprintf(stderr, "duite-bench: %s\n", duite_message());
        status = 1;
    }
    sheet_free(&session.sheet);
    return status;
}

static int serve_twin(void)
{
    static struct ranks_session session;
    const struct serve_run *const runs[] = {ranks_cg.runs, ranks_await.runs, NULL};
    int rank;
    if (MPI_Init(NULL, NULL) || MPI_Comm_rank(MPI_COMM_WORLD, &rank)) {
        fprintf(stderr, "duite-bench: MPI does not start\n");
        return 1;
    }
    if (!ranks_on_hosts())
        serve_bind(rank);
    const int status = serve("MPI_Isend, MPI_Irecv and MPI_Allreduce by hand, the same kernels; "
                             "blocks at the border first",
                             runs, &session);
    sheet_free(&session.sheet);
    return MPI_Finalize() || status;
}

static int serve_ranks(const struct bench *bench)
{
    return strncmp(serve_kind(), "twin", 4) ? serve_ours(bench) : serve_twin();
}

const struct bench bench_ranks = {"ranks",
                                  "what a second rank or host costs and brings: CG, stencil, "
                                  "recording, memory, delegation, migration, requests of MPI",
                                  CASES,
                                  TARGETS,
                                  TARGET_THREADS,
                                  serve_ranks,
                                  NULL,
                                  NULL};
