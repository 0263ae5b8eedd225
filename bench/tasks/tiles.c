/* Factorisations of a dense matrix by tiles, right-looking, without hints of any kind: the main
 * program forks all tasks in the order of the loop. A tile is an object, made once a run and set
 * before each factorisation. */
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ORDER = 768, QUICK_TILES = 4 };

static void plan_one(struct measure *measure, const struct bench_options *options,
                     struct tiles tiles)
{
    static const char *const variants[] = {"", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", NULL};
    const char *run = tiles.kind == TILES_LU ? "lu" : "cholesky";
    char name[40], size[40];
    snprintf(name, sizeof name, "%s_%zu", run, tiles.size);
    snprintf(size, sizeof size, "tiles=%zu rows=%zu", tiles.n, tiles.size);
    tasks_plan_contest(measure, options,
                       &(struct tasks_contest){.name = name,
                                               .run = run,
                                               .size = size,
                                               .tasks = tiles_tasks(tiles),
                                               .brief = true,
                                               .twice = true,
                                               .variants = variants,
                                               .rivals = rivals});
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const enum tiles_kind kinds[] = {TILES_CHOLESKY, TILES_LU};
    for (size_t i = 0; i < 2; i++)
        for (size_t rows = 16; rows <= 64; rows *= 2)
            plan_one(measure, options,
                     (struct tiles){kinds[i], options->quick ? QUICK_TILES : ORDER / rows, rows});
    measure_worst(measure, "libomp", "tiles_vs_libomp");
    measure_worst(measure, "libgomp", "tiles_vs_libgomp");
}

/* ---- Ours ---- */

struct tiles_args {
    uint32_t routine, rows;
};

static int write_only(const duite_call *call)
{
    const struct tiles_args *args = call->args;
    tiles_routine[args->routine](NULL, NULL, duite_out(call, 0, double), args->rows);
    return 0;
}

static int read_one(const duite_call *call)
{
    const struct tiles_args *args = call->args;
    tiles_routine[args->routine](duite_in(call, 0, double), NULL, duite_out(call, 1, double),
                                 args->rows);
    return 0;
}

static int read_two(const duite_call *call)
{
    const struct tiles_args *args = call->args;
    tiles_routine[args->routine](duite_in(call, 0, double), duite_in(call, 1, double),
                                 duite_out(call, 2, double), args->rows);
    return 0;
}

#define READS_NONE(text)                                                                           \
    {                                                                                              \
        .name = text, .body = write_only, .access = {DUITE_RW},                                    \
        .args_size = sizeof(struct tiles_args)                                                     \
    }
#define READS_ONE(text)                                                                            \
    {                                                                                              \
        .name = text, .body = read_one, .access = {DUITE_R, DUITE_RW},                             \
        .args_size = sizeof(struct tiles_args)                                                     \
    }
#define READS_TWO(text)                                                                            \
    {                                                                                              \
        .name = text, .body = read_two, .access = {DUITE_R, DUITE_R, DUITE_RW},                    \
        .args_size = sizeof(struct tiles_args)                                                     \
    }
const duite_kernel tasks_tiles_kernels[TILES_ROUTINES] = {
    [TILES_POTRF] = READS_NONE("potrf"),     [TILES_TRSM_L] = READS_ONE("trsm_lower"),
    [TILES_SYRK] = READS_ONE("syrk"),        [TILES_GEMM_T] = READS_TWO("gemm_transposed"),
    [TILES_GETRF] = READS_NONE("getrf"),     [TILES_TRSM_U] = READS_ONE("trsm_upper"),
    [TILES_TRSM_1] = READS_ONE("trsm_unit"), [TILES_GEMM] = READS_TWO("gemm")};

struct factorisation {
    duite *rt;
    struct tiles tiles;
    duite_object *object; /* by place; of those kept */
    double *a, *tile;     /* at the start; one of the answer */
    int code;
};

static void fork_task(const struct tiles_task *task, void *context)
{
    struct factorisation *f = context;
    const duite_kernel *kernel = &tasks_tiles_kernels[task->routine];
    const struct tiles_args args = {task->routine, (uint32_t)f->tiles.size};
    const duite_object x = f->object[task->x], y = f->object[task->y], z = f->object[task->z];
    if (tiles_reads[task->routine] == 2)
        f->code |= DUITE_FORK(f->rt, kernel, &args, x, y, z);
    else if (tiles_reads[task->routine] == 1)
        f->code |= DUITE_FORK(f->rt, kernel, &args, x, z);
    else
        f->code |= DUITE_FORK(f->rt, kernel, &args, z);
}

static double *tile_of(const struct factorisation *f, size_t place)
{
    return f->a + place * f->tiles.size * f->tiles.size;
}

static int factorise(struct factorisation *f, double *value)
{
    for (size_t i = 0; i < f->tiles.n * f->tiles.n; i++)
        if (tiles_kept(f->tiles, i))
            f->code |= duite_set(f->rt, f->object[i], tile_of(f, i));
    f->code |= duite_wait(f->rt);
    const double start = serve_seconds();
    tiles_visit(f->tiles, fork_task, f);
    f->code |= duite_wait(f->rt);
    *value = serve_seconds() - start;
    return tasks_code(f->code);
}

static int check(const struct factorisation *f)
{
    int code = 0, wrong = 0;
    for (size_t i = 0; i < f->tiles.n * f->tiles.n && !code; i++)
        if (tiles_kept(f->tiles, i)) {
            code = duite_get(f->rt, f->object[i], f->tile);
            wrong |= tiles_wrong(f->tiles, i, f->tile);
        }
    return code ? tasks_code(code) : wrong ? serve_fail("wrong answer") : 0;
}

static int run_on(struct tasks_session *session, struct factorisation *f, double *value)
{
    const size_t n = f->tiles.n * f->tiles.n;
    double seconds = 0;
    int code = tasks_objects(session, DUITE_F64, f->tiles.size * f->tiles.size, n, f->object);
    if (code)
        return code;
    for (int i = 0; i < TILES_TIMES && !code; i++) {
        code = factorise(f, &seconds);
        *value = tiles_least(*value, i, seconds);
        if (!code)
            code = check(f);
    }
    tasks_free_objects(session, n, f->object);
    return code;
}

static struct tiles wanted(struct serve_request *request, enum tiles_kind kind)
{
    return (struct tiles){kind, serve_number(request, "tiles"), serve_number(request, "rows")};
}

static int run(struct tasks_session *session, struct serve_request *request, enum tiles_kind kind,
               double *value)
{
    struct factorisation f = {.tiles = wanted(request, kind)};
    int code = tasks_ready(session, request);
    if (code)
        return code;
    f.rt = session->rt;
    f.a = tiles_make(f.tiles);
    f.tile = calloc(f.tiles.size * f.tiles.size, sizeof *f.tile);
    f.object = calloc(f.tiles.n * f.tiles.n, sizeof *f.object);
    code = f.a && f.tile && f.object ? run_on(session, &f, value) : serve_no_memory();
    free(f.a);
    free(f.tile);
    free(f.object);
    return code;
}

static int cholesky(void *context, struct serve_request *request, double *value)
{
    return run(context, request, TILES_CHOLESKY, value);
}

static int lu(void *context, struct serve_request *request, double *value)
{
    return run(context, request, TILES_LU, value);
}

/* ---- The sequential twin ---- */

static double time_loop(struct tiles tiles, double *a)
{
    const double start = serve_seconds();
    tiles_factor(tiles, a);
    return serve_seconds() - start;
}

static int sequential(struct serve_request *request, enum tiles_kind kind, double *value)
{
    const struct tiles tiles = wanted(request, kind);
    double *start = tiles_make(tiles), *a = malloc(tiles_bytes(tiles));
    int code = start && a ? 0 : serve_no_memory();
    for (int i = 0; i < TILES_TIMES && !code; i++) {
        memcpy(a, start, tiles_bytes(tiles));
        *value = tiles_least(*value, i, time_loop(tiles, a));
        code = tiles_all_wrong(tiles, a) ? serve_fail("wrong answer") : 0;
    }
    free(a);
    free(start);
    return code;
}

static int cholesky_sequential(void *context, struct serve_request *request, double *value)
{
    (void)context;
    return sequential(request, TILES_CHOLESKY, value);
}

static int lu_sequential(void *context, struct serve_request *request, double *value)
{
    (void)context;
    return sequential(request, TILES_LU, value);
}

static const struct serve_run RUNS[] = {{"cholesky", cholesky},
                                        {"lu", lu},
                                        {"cholesky_sequential", cholesky_sequential},
                                        {"lu_sequential", lu_sequential},
                                        {0}};

const struct bench_case tasks_tiles = {"tiles", "Cholesky and LU by tiles of 16, 32 and 64 rows",
                                       plan, RUNS, 8};
