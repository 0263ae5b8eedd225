/* The dot product of two vectors in blocks: one task a block fills its part of x and y, one adds
 * its share to the sum. x[i] = i + 1 and y[i] = 2 make n (n + 1), exactly. */

#include <duite.h>

#include <stdio.h>

enum { BLOCKS = 13, LENGTH = 1000 };

struct fill_args {
    double first;
    double step;
};

static int fill(const duite_call *call)
{
    const struct fill_args *args = call->args;
    double *x = duite_out(call, 0, double);

    for (size_t i = 0; i < duite_count(call, 0); i++)
        x[i] = args->first + args->step * (double)i;
    return 0;
}

static int dot(const duite_call *call)
{
    const double *x = duite_in(call, 0, double);
    const double *y = duite_in(call, 1, double);
    double sum = 0;

    for (size_t i = 0; i < duite_count(call, 0); i++)
        sum += x[i] * y[i];
    duite_out(call, 2, double)[0] += sum;
    return 0;
}

static const duite_kernel FILL = {
    .name = "fill", .body = fill, .access = {DUITE_W}, .args_size = sizeof(struct fill_args)};
static const duite_kernel DOT = {
    .name = "dot", .body = dot, .access = {DUITE_R, DUITE_R, DUITE_CW}};

int main(void)
{
    const duite_kernel *kernels[] = {&FILL, &DOT, NULL};
    duite_options options = duite_options_default();
    duite_object x[BLOCKS], y[BLOCKS], sum;
    double result = 0;
    duite *rt;

    options.kernels = kernels;
    if (duite_start(&rt, &options)) {
        fprintf(stderr, "dot: %s\n", duite_message());
        return 1;
    }
    duite_new(rt, DUITE_F64, 1, &sum);
    for (int b = 0; b < BLOCKS; b++) {
        duite_new(rt, DUITE_F64, LENGTH, &x[b]);
        duite_new(rt, DUITE_F64, LENGTH, &y[b]);
        duite_follow(rt, y[b], x[b]);
    }
    for (int b = 0; b < BLOCKS; b++) {
        DUITE_FORK(rt, &FILL, DUITE_ARGS(struct fill_args, 1.0 + (double)b * LENGTH, 1), x[b]);
        DUITE_FORK(rt, &FILL, DUITE_ARGS(struct fill_args, 2, 0), y[b]);
        DUITE_FORK(rt, &DOT, NULL, x[b], y[b], sum);
    }
    int code = duite_get(rt, sum, &result);

    if (code)
        fprintf(stderr, "dot: %s\n", duite_message());
    for (int b = 0; b < BLOCKS; b++) {
        duite_free(rt, x[b]);
        duite_free(rt, y[b]);
    }
    duite_free(rt, sum);

    const double n = (double)BLOCKS * LENGTH;
    const int print = duite_rank(rt) == 0;
    const int right = result == n * (n + 1);

    if (duite_stop(&rt))
        fprintf(stderr, "dot: %s\n", duite_message());
    if (print)
        printf("dot %.17g expected %.17g\n", result, n * (n + 1));
    return code || !right;
}
