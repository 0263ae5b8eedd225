/* Conjugate gradients as a plain loop with OpenMP, with the kernels of the cloth and without tasks:
 * each thread has a range of the parts and goes to and fro over them; a pass ends at one barrier,
 * after which every thread adds up the dots of all parts in the same order. And the triad, for what
 * memory allows. */
#include "bench/cg/parts.h"

#include <omp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct twin {
    struct state state;
    struct parts parts;
    uint32_t size; /* vertices of a part, as asked for */
    int threads;
};

static int ready(struct twin *twin, struct serve_request *request)
{
    char before[sizeof twin->state.name];
    const uint32_t size = (uint32_t)serve_number(request, "size");
    snprintf(before, sizeof before, "%s", twin->state.name);
    twin->threads = (int)serve_number(request, "threads");
    int code = state_ready(&twin->state, request);
    if (code || (twin->parts.n && twin->size == size && !strcmp(before, twin->state.name)))
        return code;
    parts_free(&twin->parts);
    twin->size = size;
    return parts_make(&twin->parts, &twin->state, size, (uint32_t)twin->threads);
}

/* ---- Solving ---- */

static const double ONE = 1;

struct solve {
    const struct twin *twin;
    double (*dots[2])[SOLVE_DOTS]; /* of each part, of even and odd passes */
    struct solve_stop stop;
};

static void start(const struct part *part)
{
    const size_t n = part->matrix.row[part->matrix.n] + part->cut.n;
    for (size_t i = 0; i < n; i++) /* as a step writes its matrix before it solves */
        part->value[i] *= *(const volatile double *)&ONE;
    const struct solve_rows *y = &part->rows;
    solve_start(part->matrix.n, part->matrix.free, part->b, y->dv, y->r, y->p, y->q);
    memset(part->ghost_r, 0, part->n_ghosts * sizeof *part->ghost_r);
    memset(part->ghost_p, 0, part->n_ghosts * sizeof *part->ghost_p);
    solve_pack(part->cut.n_halo, part->cut.halo, y->q, part->halo[0]);
}

static void pass(const struct parts *parts, const struct part *part,
                 const struct solve_scalars *now, int from, double dots[SOLVE_DOTS])
{
    const struct solve_rows *y = &part->rows;
    memset(dots, 0, SOLVE_DOTS * sizeof *dots);
    if (now->phase == SOLVE_LAST) {
        dots[SOLVE_RR] = solve_finish(part->matrix.n, now->alpha, y->q, y->p, y->dv, y->r);
        return;
    }
    for (uint32_t p = 0; p < parts->n; p++) {
        const uint32_t first = part->ghosts[p], n = part->ghosts[p + 1] - first;
        if (n)
            solve_advance_ghosts(n, now->alpha, now->beta, parts->part[p].halo[from],
                                 part->at + first, part->ghost_r + first, part->ghost_p + first);
    }
    solve_pass(&part->matrix, &part->cut, part->value, part->ghost_p, now->alpha, now->beta, y,
               dots);
    solve_pack(part->cut.n_halo, part->cut.halo, y->q, part->halo[1 - from]);
}

/* The work of one thread. Everyone works out the same factors. */
static int solve_part(const struct solve *s, uint32_t thread, uint32_t threads)
{
    const struct parts *parts = &s->twin->parts;
    const uint32_t first = parts->n * thread / threads, end = parts->n * (thread + 1) / threads;
    struct solve_scalars now = solve_scalars_start(0, SOLVE_ON), next;
    int code = SOLVE_OK;
    for (uint32_t p = first; p < end; p++)
        start(parts->part + p);
#pragma omp barrier
    for (int from = 0; now.phase != SOLVE_DONE; from = 1 - from) {
        double sum[SOLVE_DOTS] = {0};
        for (uint32_t i = first; i < end; i++) {
            const uint32_t p = from ? first + end - 1 - i : i;
            pass(parts, parts->part + p, &now, from, s->dots[from][p]);
        }
#pragma omp barrier
        for (uint32_t p = 0; p < parts->n; p++)
            for (int k = 0; k < SOLVE_DOTS; k++)
                sum[k] += s->dots[from][p][k];
        code = solve_scalars_next(&s->stop, sum, &now, &next);
        if (code)
            break;
        now = next;
    }
    return code;
}

static int solve(const struct twin *twin, uint32_t count)
{
    struct solve s = {.twin = twin, .stop = {.count = true, .max = count}};
    const uint32_t n = twin->parts.n;
    int failed = 0;
    s.dots[0] = calloc(2 * (size_t)n, sizeof *s.dots[0]);
    if (!s.dots[0])
        return serve_no_memory();
    s.dots[1] = s.dots[0] + n;
#pragma omp parallel num_threads(twin->threads) reduction(| : failed)
    failed |= solve_part(&s, (uint32_t)omp_get_thread_num(), (uint32_t)omp_get_num_threads());
    free(s.dots[0]);
    return failed ? serve_fail("the solve breaks down") : 0;
}

static int check(const struct twin *twin, uint32_t count)
{
    double *dv = calloc((size_t)twin->state.system.n + 1, 3 * sizeof *dv);
    if (!dv)
        return serve_no_memory();
    parts_answer(&twin->parts, &twin->state, dv);
    const int code = state_check(&twin->state, count, dv);
    free(dv);
    return code;
}

static int cg(void *context, struct serve_request *request, double *value)
{
    struct twin *twin = context;
    const uint32_t count = (uint32_t)serve_number(request, "count");
    int code = ready(twin, request);
    if (!code)
        code = solve(twin, count / 10 + 1);
    const double begin = serve_seconds();
    if (!code)
        code = solve(twin, count);
    *value = serve_seconds() - begin;
    return code ? code : check(twin, count);
}

/* ---- What memory allows ---- */

enum { SWEEPS = 20 };

/* Seconds of a sweep a = b + 3 c over n numbers each. */
static double sweep(long n, int threads, double *a, double *b, double *c)
{
    double begin = 0;
#pragma omp parallel num_threads(threads)
    for (int k = -1; k < SWEEPS; k++) { /* the first one touches the pages */
#pragma omp single
        if (k == 0)
            begin = serve_seconds();
#pragma omp for schedule(static)
        for (long i = 0; i < n; i++) {
            if (k < 0)
                a[i] = b[i] = c[i] = 1;
            else
                a[i] = b[i] + 3 * c[i];
        }
    }
    return (serve_seconds() - begin) / SWEEPS;
}

/* A triad over so many bytes=, or those of an iteration on a state=. */
static int triad(void *context, struct serve_request *request, double *value)
{
    struct twin *twin = context;
    char bytes[20];
    serve_word(request, "bytes", bytes, sizeof bytes);
    const int code = *bytes ? 0 : state_ready(&twin->state, request);
    if (code)
        return code;
    const double size = *bytes ? strtod(bytes, NULL) : state_bytes(&twin->state);
    const long n = (long)(size / (3 * sizeof(double)));
    double *a = aligned_alloc(64, ((size_t)n + 8) / 8 * 64 * 3);
    if (!a)
        return serve_no_memory();
    double *b = a + (n + 8) / 8 * 8, *c = b + (n + 8) / 8 * 8;
    *value = sweep(n, (int)serve_number(request, "threads"), a, b, c);
    const bool right = a[0] == 4 && a[n - 1] == 4;
    free(a);
    return right ? 0 : serve_fail("wrong answer");
}

int main(void)
{
    static const struct serve_run runs[] = {{"cg", cg}, {"triad", triad}, {0}};
    const struct serve_run *const all[] = {runs, NULL};
    static struct twin twin;
    const int status = serve("a plain loop with OpenMP, the same kernels; triad of the bytes of an "
                             "iteration, " STATE_BYTES_FORMULA,
                             all, &twin);
    parts_free(&twin.parts);
    state_free(&twin.state);
    return status;
}
