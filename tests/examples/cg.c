/* Conjugate gradients on -u'' = 1, u(0) = u(1) = 0, in blocks; second differences make the exact
 * u = s (1 - s) / 2 at the nodes. The main program sees one residual an iteration, and nothing
 * else. */

#include <duite.h>

#include <math.h>
#include <stdio.h>

enum { BLOCKS = 6, LENGTH = 50, N = BLOCKS * LENGTH, LIMIT = 2 * N };

/* q = A p, and p.q. Parameters: p to the left, p, p to the right, q, sum. */
static int matvec(const duite_call *call)
{
    const double *left = duite_in(call, 0, double), *p = duite_in(call, 1, double),
                 *right = duite_in(call, 2, double);
    double *q = duite_out(call, 3, double), share = 0;

    for (int i = 0; i < LENGTH; i++) {
        q[i] =
            2 * p[i] - (i ? p[i - 1] : left[LENGTH - 1]) - (i < LENGTH - 1 ? p[i + 1] : right[0]);
        share += p[i] * q[i];
    }
    *duite_out(call, 4, double) += share;
    return 0;
}

/* x += alpha p, r -= alpha q, and r.r. Parameters: old r.r, p.q, p, q, x, r, new r.r. */
static int update(const duite_call *call)
{
    const double alpha = *duite_in(call, 0, double) / *duite_in(call, 1, double);
    const double *p = duite_in(call, 2, double), *q = duite_in(call, 3, double);
    double *x = duite_out(call, 4, double), *r = duite_out(call, 5, double), share = 0;

    for (int i = 0; i < LENGTH; i++) {
        x[i] += alpha * p[i];
        r[i] -= alpha * q[i];
        share += r[i] * r[i];
    }
    *duite_out(call, 6, double) += share;
    return 0;
}

/* p = r + beta p. Parameters: new r.r, old r.r, r, p. */
static int direction(const duite_call *call)
{
    const double beta = *duite_in(call, 0, double) / *duite_in(call, 1, double);

    for (int i = 0; i < LENGTH; i++)
        duite_out(call, 3, double)[i] =
            duite_in(call, 2, double)[i] + beta * duite_in(call, 3, double)[i];
    return 0;
}

#define R DUITE_R
static const duite_kernel MATVEC = {
    .name = "matvec", .body = matvec, .access = {R, R, R, DUITE_W, DUITE_CW}};
static const duite_kernel UPDATE = {
    .name = "update", .body = update, .access = {R, R, R, R, DUITE_RW, DUITE_RW, DUITE_CW}};
static const duite_kernel DIRECTION = {
    .name = "direction", .body = direction, .access = {R, R, R, DUITE_RW}};

/* Vectors in blocks; zeros beyond both ends; r.r of now and before, and p.q. */
static duite_object r[BLOCKS], p[BLOCKS], x[BLOCKS], q[BLOCKS], zeros, sum[3];
static duite_object *const VECTORS[] = {r, p, x, q};

static void make(duite *rt, double h)
{
    double b[LENGTH];

    for (int i = 0; i < LENGTH; i++)
        b[i] = h * h;
    for (int i = 0; i < 3; i++)
        duite_new(rt, DUITE_F64, 1, &sum[i]);
    duite_new(rt, DUITE_F64, LENGTH, &zeros);
    for (int k = 0; k < 4 * BLOCKS; k++) {
        duite_object *block = &VECTORS[k % 4][k / 4];

        duite_new(rt, DUITE_F64, LENGTH, block);
        if (k % 4 > 0)
            duite_follow(rt, *block, r[k / 4]);
        if (k % 4 < 2) /* x = 0, so r = p = b */
            duite_set(rt, *block, b);
    }
    duite_set(rt, sum[0], &(double){N * h * h * h * h});
}

static void iterate(duite *rt, duite_object old, duite_object new, duite_object pq)
{
    duite_set(rt, pq, NULL);
    duite_set(rt, new, NULL);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &MATVEC, NULL, b ? p[b - 1] : zeros, p[b], b < BLOCKS - 1 ? p[b + 1] : zeros,
                   q[b], pq);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &UPDATE, NULL, old, pq, p[b], q[b], x[b], r[b], new);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &DIRECTION, NULL, new, old, r[b], p[b]);
}

int main(void)
{
    duite_options options = duite_options_default();
    double norm = 1, worst = 0, u[LENGTH], h = 1.0 / (N + 1);
    int n = 0, code = 0;
    duite *rt;

    options.kernels = (const duite_kernel *[]){&MATVEC, &UPDATE, &DIRECTION, NULL};
    if (duite_start(&rt, &options))
        return fprintf(stderr, "cg: %s\n", duite_message()), 1;
    make(rt, h);
    for (; n < LIMIT && norm > 1e-26 && !code; n++) {
        iterate(rt, sum[n % 2], sum[1 - n % 2], sum[2]);
        code = duite_get(rt, sum[1 - n % 2], &norm);
    }
    for (int i = 0; i < N; i++) {
        if (i % LENGTH == 0)
            duite_get(rt, x[i / LENGTH], u);
        worst = fmax(worst, fabs(u[i % LENGTH] - (i + 1) * h * (1 - (i + 1) * h) / 2));
    }
    for (int k = 0; k < 4 * BLOCKS; k++)
        duite_free(rt, VECTORS[k % 4][k / 4]);
    duite_free(rt, zeros);
    for (int i = 0; i < 3; i++)
        duite_free(rt, sum[i]);
    printf("cg: rank %d, %d iterations, largest error %.3g\n", duite_rank(rt), n, worst);
    return duite_stop(&rt) || code || n == LIMIT || !(worst < 1e-11);
}
