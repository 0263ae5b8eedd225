/* Conjugate gradients on a ring of blocks, 3 x[b] - x[b-1] - x[b+1] = f[b], where f is 1 in block
 * 0 and 0 elsewhere. The iteration is recorded once and replayed until the residual is small. */

#include <duite.h>

#include <math.h>
#include <stdio.h>

enum { BLOCKS = 24, LENGTH = 50, LIMIT = 100 };
enum { P, Q, R, X, VECTORS };
enum { PQ, RR, NEXT, MORE, SCALARS }; /* p.q; r.r before and after; whether to go on */

struct system {
    duite_object v[VECTORS][BLOCKS], s[SCALARS];
};

static int multiply(const duite_call *call) /* q = A p, pq += p.q */
{
    const double *before = duite_in(call, 0, double), *p = duite_in(call, 1, double);
    const double *after = duite_in(call, 2, double);
    double *q = duite_out(call, 3, double), *pq = duite_out(call, 4, double);
    for (int i = 0; i < LENGTH; i++) {
        q[i] = 3 * p[i] - before[i] - after[i];
        *pq += p[i] * q[i];
    }
    return 0;
}

static int advance(const duite_call *call) /* x += alpha p, r -= alpha q, next += r.r */
{
    const double alpha = *duite_in(call, 0, double) / *duite_in(call, 1, double);
    const double *p = duite_in(call, 2, double), *q = duite_in(call, 3, double);
    double *x = duite_out(call, 4, double), *r = duite_out(call, 5, double);
    for (int i = 0; i < LENGTH; i++) {
        x[i] += alpha * p[i];
        r[i] -= alpha * q[i];
        *duite_out(call, 6, double) += r[i] * r[i];
    }
    return 0;
}

static int turn(const duite_call *call) /* p = r + beta p */
{
    const double beta = *duite_in(call, 1, double) / *duite_in(call, 0, double);
    const double *r = duite_in(call, 2, double);
    double *p = duite_out(call, 3, double);
    for (int i = 0; i < LENGTH; i++)
        p[i] = r[i] + beta * p[i];
    return 0;
}

static int judge(const duite_call *call) /* rr = next; more = next > 1e-24 */
{
    *duite_out(call, 1, double) = *duite_in(call, 0, double);
    *duite_out(call, 2, double) = *duite_in(call, 0, double) > 1e-24;
    return 0;
}

static const duite_kernel MULTIPLY = {
    .name = "multiply", .body = multiply, .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W, DUITE_CW}};
static const duite_kernel ADVANCE = {
    .name = "advance",
    .body = advance,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_RW, DUITE_CW}};
static const duite_kernel TURN = {
    .name = "turn", .body = turn, .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_RW}};
static const duite_kernel JUDGE = {
    .name = "judge", .body = judge, .access = {DUITE_R, DUITE_W, DUITE_W}};

static int iteration(duite *rt, void *context)
{
    const struct system *system = context;
    const duite_object *s = system->s, *p = system->v[P], *q = system->v[Q], *r = system->v[R];
    duite_set(rt, s[PQ], NULL); /* zero */
    duite_set(rt, s[NEXT], NULL);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &MULTIPLY, NULL, p[(b + BLOCKS - 1) % BLOCKS], p[b], p[(b + 1) % BLOCKS],
                   q[b], s[PQ]);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &ADVANCE, NULL, s[RR], s[PQ], p[b], q[b], system->v[X][b], r[b], s[NEXT]);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &TURN, NULL, s[RR], s[NEXT], r[b], p[b]);
    return DUITE_FORK(rt, &JUDGE, NULL, s[NEXT], s[RR], s[MORE]);
}

static void make(duite *rt, struct system *system) /* x = 0, so p = r = f */
{
    double ones[LENGTH];
    for (int k = 0; k < SCALARS; k++)
        duite_new(rt, DUITE_F64, 1, &system->s[k]);
    for (int k = 0; k < VECTORS; k++)
        for (int b = 0; b < BLOCKS; b++) {
            duite_new(rt, DUITE_F64, LENGTH, &system->v[k][b]);
            if (k > 0)
                duite_colocate(rt, system->v[k][b], system->v[0][b]); /* on the same rank */
        }
    for (int i = 0; i < LENGTH; i++)
        ones[i] = 1;
    duite_set(rt, system->v[P][0], ones);
    duite_set(rt, system->v[R][0], ones);
    duite_set(rt, system->s[RR], &(double){LENGTH});
}

static int run(duite *rt)
{
    struct system system;
    double x[BLOCKS][LENGTH] = {{0}}, worst = 0;
    uint64_t rounds = 0;
    duite_graph graph;
    make(rt, &system);
    duite_graph_new(rt, iteration, &system, &graph);
    duite_replay_while(rt, graph, system.s[MORE], LIMIT);
    duite_graph_rounds(rt, graph, &rounds);
    if (duite_wait(rt)) /* tells what is wrong so far */
        fprintf(stderr, "cg: %s\n", duite_message());
    duite_graph_free(rt, graph);
    for (int b = 0; b < BLOCKS; b++) {
        duite_get(rt, system.v[X][b], x[b]);
        for (int k = 0; k < VECTORS; k++)
            duite_free(rt, system.v[k][b]);
    }
    for (int k = 0; k < SCALARS; k++)
        duite_free(rt, system.s[k]);
    for (int i = 0; i < BLOCKS * LENGTH; i++) {
        int b = i / LENGTH, before = (b + BLOCKS - 1) % BLOCKS, after = (b + 1) % BLOCKS;
        double f = 3 * x[b][i % LENGTH] - x[before][i % LENGTH] - x[after][i % LENGTH];
        worst = fmax(worst, fabs(f - (b == 0)));
    }
    if (duite_rank(rt) == 0)
        printf("cg: residual %.1e after %d rounds\n", worst, (int)rounds);
    return !(worst < 1e-11);
}

int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&MULTIPLY, &ADVANCE, &TURN, &JUDGE, NULL};
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "cg: %s\n", duite_message()), 1;
    int wrong = run(rt);
    if (duite_stop(&rt)) /* tells the errors that nobody asked for */
        return fprintf(stderr, "cg: %s\n", duite_message()), 1;
    return wrong;
}
