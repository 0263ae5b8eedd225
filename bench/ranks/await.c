/* A halo exchange by the program's own requests of MPI, in tasks, against the same by hand. Each
 * rank has a ring of cells in blocks. In a step it sends the cells at its two ends to its
 * neighbours and receives theirs (one task, which ends with its requests; by hand MPI_Waitall);
 * then each block becomes a mean of neighbouring cells. The blocks inside need no message. Ours
 * replays two recorded steps, or forks each. */
#include "bench/ranks/ranks.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCKS = 8, WIDTH = 2048 /* cells of a block, */, HALO = 64 /* and at each of its ends */ };
enum { MOST = 16 /* ranks */, TO_LEFT, TO_RIGHT };

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned ranks = options->threads, steps = options->quick ? 20 : 4000;
    const char *const command = "%s steps=%u threads=1 scheduler=%s";
    const struct measure_series *ours =
        measure_series(measure, ranks_ours(ranks, 1), command, "await", steps, options->scheduler);
    const struct measure_series *forks = measure_series(measure, ranks_ours(ranks, 1), command,
                                                        "await_forks", steps, options->scheduler);
    const struct measure_series *twin = measure_series(measure, ranks_twin(ranks), command,
                                                       "twin_await", steps, options->scheduler);
    measure_value(measure, ours, 1e6 / steps, "us", "await_mpi_us");
    measure_value(measure, forks, 1e6 / steps, "us", "await_mpi_forks_us");
    measure_value(measure, twin, 1e6 / steps, "us", "await_mpi_twin_us");
    measure_ratio(measure, ours, twin, "await_mpi_vs_twin");
    measure_ratio(measure, forks, twin, "await_mpi_forks_vs_twin");
}

/* ---- The arithmetic ---- */

/* A block of the new cells; left and right: HALO cells on each side of the old ones. */
static void smooth(double *new, const double *old, const double *left, const double *right)
{
    double line[WIDTH + 2 * HALO];
    memcpy(line, left, HALO * sizeof *line);
    memcpy(line + HALO, old, WIDTH * sizeof *line);
    memcpy(line + HALO + WIDTH, right, HALO * sizeof *line);
    for (int i = 0; i < WIDTH; i++)
        new[i] = 0.5 * line[HALO + i] + 0.25 * (line[i] + line[i + 2 * HALO]);
}

static double begin_cell(int rank, int block, int i)
{
    return (double)((rank * 7919 + block * 104729 + i) % 1000) / 1000;
}

/* MPI's four requests of a step; in and out: the left end, then the right one. */
static int exchange(int rank, int ranks, double *in, const double *left, const double *right,
                    MPI_Request *request)
{
    const int before = (rank + ranks - 1) % ranks, after = (rank + 1) % ranks;
    return MPI_Irecv(in, HALO, MPI_DOUBLE, before, TO_RIGHT, MPI_COMM_WORLD, &request[0]) |
           MPI_Irecv(in + HALO, HALO, MPI_DOUBLE, after, TO_LEFT, MPI_COMM_WORLD, &request[1]) |
           MPI_Isend(left, HALO, MPI_DOUBLE, before, TO_LEFT, MPI_COMM_WORLD, &request[2]) |
           MPI_Isend(right, HALO, MPI_DOUBLE, after, TO_RIGHT, MPI_COMM_WORLD, &request[3]);
}

/* ---- By hand ---- */

struct cells {
    double at[2][BLOCKS][WIDTH], in[2 * HALO];
};

static void hand_block(struct cells *cells, int now, int b)
{
    double(*old)[WIDTH] = cells->at[now];
    const double *left = b ? old[b - 1] + WIDTH - HALO : cells->in;
    const double *right = b < BLOCKS - 1 ? old[b + 1] : cells->in + HALO;
    smooth(cells->at[!now][b], old[b], left, right);
}

static int hand_steps(struct cells *cells, int rank, int ranks, unsigned steps)
{
    int code = 0;
    for (int b = 0; b < BLOCKS; b++)
        for (int i = 0; i < WIDTH; i++)
            cells->at[0][b][i] = begin_cell(rank, b, i);
    for (unsigned step = 0; step < steps && !code; step++) {
        const int now = (int)(step % 2);
        MPI_Request request[4];
        code = exchange(rank, ranks, cells->in, cells->at[now][0],
                        cells->at[now][BLOCKS - 1] + WIDTH - HALO, request);
        for (int b = 1; b < BLOCKS - 1; b++)
            hand_block(cells, now, b);
        code |= MPI_Waitall(4, request, MPI_STATUSES_IGNORE);
        hand_block(cells, now, 0);
        hand_block(cells, now, BLOCKS - 1);
    }
    return code;
}

static int run_twin(void *context, struct serve_request *request, double *value)
{
    const unsigned steps = (unsigned)serve_number(request, "steps");
    struct cells *cells = calloc(1, sizeof *cells);
    int rank = 0, ranks = 1;
    (void)context;
    int code = cells ? MPI_Comm_rank(MPI_COMM_WORLD, &rank) | MPI_Comm_size(MPI_COMM_WORLD, &ranks)
                     : serve_no_memory();
    if (!code)
        code = hand_steps(cells, rank, ranks, steps / 10) || MPI_Barrier(MPI_COMM_WORLD);
    const double start = serve_seconds();
    if (!code)
        code = hand_steps(cells, rank, ranks, steps);
    *value = serve_seconds() - start;
    free(cells);
    return code ? serve_fail("MPI failed") : 0;
}

/* ---- As tasks ---- */

/* Parameters: the first block, the last one, what comes from both sides. */
static int pass(const duite_call *call)
{
    MPI_Request request[4];
    int code = duite_mpi_begin(call->rt);
    if (code)
        return code;
    code = exchange(call->rank, duite_ranks(call->rt), duite_out(call, 2, double),
                    duite_in(call, 0, double), duite_in(call, 1, double) + WIDTH - HALO, request);
    code |= duite_mpi_end(call->rt);
    return code ? code : duite_await_mpi(call, 4, request);
}

/* Parameters: the new block, the old one, and those that have its left and right side; args: where
 * in these. */
struct sides {
    int left, right;
};

static int step_block(const duite_call *call)
{
    const struct sides *at = call->args;
    smooth(duite_out(call, 0, double), duite_in(call, 1, double),
           duite_in(call, 2, double) + at->left, duite_in(call, 3, double) + at->right);
    return 0;
}

static const duite_kernel PASS = {
    .name = "await_pass", .body = pass, .access = {DUITE_R, DUITE_R, DUITE_W}, .events = 1};
static const duite_kernel STEP = {.name = "await_step",
                                  .body = step_block,
                                  .access = {DUITE_W, DUITE_R, DUITE_R, DUITE_R},
                                  .args_size = sizeof(struct sides)};

struct line {
    duite_object cells[2][BLOCKS], in;
};

static int fork_block(duite *rt, const struct line *line, int rank, int now, int b)
{
    const duite_object *old = line->cells[now];
    const bool first = !b, last = b == BLOCKS - 1;
    const struct sides at = {first ? 0 : WIDTH - HALO, last ? HALO : 0};
    return duite_fork_at(rt, rank, &STEP, &at, 4,
                         (duite_object[]){line->cells[!now][b], old[b],
                                          first ? line->in : old[b - 1],
                                          last ? line->in : old[b + 1]});
}

/* The newest of what is ready runs first: the exchange is forked after the blocks that need
 * nothing of it. */
static int fork_step(duite *rt, const struct line *line, int rank, int now)
{
    const duite_object *old = line->cells[now];
    int code = 0;
    for (int b = 1; b < BLOCKS - 1; b++)
        code |= fork_block(rt, line, rank, now, b);
    code |= duite_fork_at(rt, rank, &PASS, NULL, 3,
                          (duite_object[]){old[0], old[BLOCKS - 1], line->in});
    code |= fork_block(rt, line, rank, now, 0);
    return code | fork_block(rt, line, rank, now, BLOCKS - 1);
}

static int set_blocks(duite *rt, struct line *line, int rank)
{
    double cells[WIDTH];
    int code = 0;
    for (int b = 0; b < BLOCKS; b++) {
        for (int i = 0; i < WIDTH; i++)
            cells[i] = begin_cell(rank, b, i);
        code |= duite_set(rt, line->cells[0][b], cells);
    }
    return code;
}

/* All ranks' steps from the old cells to the new ones and back. */
static int fork_two_steps(duite *rt, void *context)
{
    const struct line *line = context;
    int code = 0;
    for (int now = 0; now < 2; now++)
        for (int r = 0; r < duite_ranks(rt); r++)
            code |= fork_step(rt, &line[r], r, now);
    return code;
}

/* steps: an even number. */
static int run_steps(duite *rt, struct line *line, const duite_graph *graph, unsigned steps,
                     double *value)
{
    int code = 0;
    for (int r = 0; r < duite_ranks(rt); r++)
        code |= set_blocks(rt, &line[r], r);
    code |= duite_wait(rt);
    const double start = serve_seconds();
    if (graph)
        code |= duite_replay(rt, *graph, steps / 2);
    for (unsigned step = 0; step < steps && !graph && !code; step += 2)
        code |= fork_two_steps(rt, line);
    code |= duite_wait(rt);
    *value = serve_seconds() - start;
    return tasks_code(code);
}

static int line_new(duite *rt, struct line *line)
{
    int code = duite_new(rt, DUITE_F64, 2 * HALO, &line->in);
    for (int k = 0; k < 2 * BLOCKS; k++)
        code |= duite_new(rt, DUITE_F64, WIDTH, &line->cells[k / BLOCKS][k % BLOCKS]);
    for (int k = 1; k < 2 * BLOCKS; k++)
        code |= duite_colocate(rt, line->cells[k / BLOCKS][k % BLOCKS], line->cells[0][0]);
    return code | duite_colocate(rt, line->in, line->cells[0][0]);
}

static void line_free(duite *rt, struct line *line)
{
    duite_free(rt, line->in);
    for (int k = 0; k < 2 * BLOCKS; k++)
        duite_free(rt, line->cells[k / BLOCKS][k % BLOCKS]);
}

/* This rank's blocks are those of the same steps by hand. */
static int check(duite *rt, const struct line *line, unsigned steps)
{
    struct cells *cells = calloc(1, sizeof *cells);
    double got[WIDTH];
    int wrong = 0, code = cells ? duite_mpi_begin(rt) : serve_no_memory();
    if (!code) {
        code = hand_steps(cells, duite_rank(rt), duite_ranks(rt), steps);
        code |= duite_mpi_end(rt);
    }
    for (int r = 0; r < duite_ranks(rt) && !code; r++)
        for (int b = 0; b < BLOCKS; b++) {
            code |= duite_get(rt, line[r].cells[steps % 2][b], got);
            wrong |= r == duite_rank(rt) && memcmp(got, cells->at[steps % 2][b], sizeof got) != 0;
        }
    free(cells);
    return code ? tasks_code(code) : wrong ? serve_fail("wrong answer") : 0;
}

static int run_lines(duite *rt, struct line *line, bool replays, unsigned steps, double *value)
{
    duite_graph graph;
    const duite_graph *const replayed = replays ? &graph : NULL;
    int code = replays ? tasks_code(duite_graph_new(rt, fork_two_steps, line, &graph)) : 0;
    if (!code)
        code = run_steps(rt, line, replayed, steps / 10, value);
    if (!code)
        code = run_steps(rt, line, replayed, steps, value);
    if (!code)
        code = check(rt, line, steps);
    if (!code && replays)
        duite_graph_free(rt, graph);
    return code;
}

static int run_ours(void *context, struct serve_request *request, bool replays, double *value)
{
    static const duite_kernel *const kernels[] = {&PASS, &STEP, NULL};
    const unsigned steps = (unsigned)serve_number(request, "steps");
    struct line line[MOST];
    duite_options options = duite_options_default();
    duite *rt = NULL;
    options.kernels = kernels;
    options.window = 200; /* some steps ahead are enough */
    options.mapping = duite_mapping_find("block");
    int code = ranks_start(context, request, &options, &rt);
    if (!code && duite_ranks(rt) > MOST)
        code = serve_fail("too many ranks");
    for (int r = 0; !code && r < duite_ranks(rt); r++)
        code = tasks_code(line_new(rt, &line[r]));
    if (!code)
        code = run_lines(rt, line, replays, steps, value);
    for (int r = 0; !code && r < duite_ranks(rt); r++)
        line_free(rt, &line[r]);
    return ranks_stop(&rt, code);
}

static int run_replays(void *context, struct serve_request *request, double *value)
{
    return run_ours(context, request, true, value);
}

static int run_forks(void *context, struct serve_request *request, double *value)
{
    return run_ours(context, request, false, value);
}

static const struct serve_run RUNS[] = {
    {"await", run_replays}, {"await_forks", run_forks}, {"twin_await", run_twin}, {0}};

const struct bench_case ranks_await = {
    "await", "a halo exchange by requests of the program, as tasks and by hand", plan, RUNS, 0};
