/* The dot product of two vectors in blocks: each task adds its block's share to one sum. With
 * x[i] = i + 1 and y[i] = 2 it is n (n + 1), exactly. */

#include <duite.h>

#include <stdio.h>

enum { BLOCKS = 13, LENGTH = 1000, N = BLOCKS * LENGTH };

struct fill {
    double first, step;
};

static int fill(const duite_call *call) /* x[i] = first + step i */
{
    const struct fill *args = call->args;
    double *x = duite_out(call, 0, double);
    for (size_t i = 0; i < duite_count(call, 0); i++)
        x[i] = args->first + args->step * (double)i;
    return 0;
}

static int dot(const duite_call *call) /* sum += x . y */
{
    const double *x = duite_in(call, 0, double), *y = duite_in(call, 1, double);
    double *sum = duite_out(call, 2, double);
    for (size_t i = 0; i < duite_count(call, 0); i++)
        *sum += x[i] * y[i];
    return 0;
}

static const duite_kernel FILL = {
    .name = "fill", .body = fill, .access = {DUITE_W}, .args_size = sizeof(struct fill)};
static const duite_kernel DOT = {
    .name = "dot", .body = dot, .access = {DUITE_R, DUITE_R, DUITE_CW}};

static int run(duite *rt) /* returns 0 if the sum is right */
{
    duite_object x, y, sum;
    double result = 0;
    duite_new(rt, DUITE_F64, 1, &sum);
    for (int b = 0; b < BLOCKS; b++) {
        duite_new(rt, DUITE_F64, LENGTH, &x);
        duite_new(rt, DUITE_F64, LENGTH, &y);
        duite_colocate(rt, y, x); /* on the same rank */
        DUITE_FORK(rt, &FILL, DUITE_ARGS(struct fill, .first = b * LENGTH + 1, .step = 1), x);
        DUITE_FORK(rt, &FILL, DUITE_ARGS(struct fill, .first = 2), y);
        DUITE_FORK(rt, &DOT, NULL, x, y, sum);
        duite_free(rt, x); /* after its last use */
        duite_free(rt, y);
    }
    if (duite_get(rt, sum, &result)) /* tells the errors of all calls above, too */
        fprintf(stderr, "dot: %s\n", duite_message());
    duite_free(rt, sum);
    if (duite_rank(rt) == 0)
        printf("dot: %.0f\n", result);
    return result != (double)N * (N + 1);
}

int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&FILL, &DOT, NULL};
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "dot: %s\n", duite_message()), 1;
    int wrong = run(rt);
    if (duite_stop(&rt)) /* tells the errors that nobody asked for */
        return fprintf(stderr, "dot: %s\n", duite_message()), 1;
    return wrong;
}
