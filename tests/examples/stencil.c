/* A three-point stencil on a rod in blocks: every step reads a block and its two neighbours and
 * overwrites the block's other copy. Compared with a plain loop, to the last bit. */

#include <duite.h>

#include <stdio.h>
#include <string.h>

enum { BLOCKS = 9, LENGTH = 100, N = BLOCKS * LENGTH, STEPS = 40 };

static double start_value(int i)
{
    return (double)(i * 7919 % 1000) / 37.0;
}

static double mean(double left, double middle, double right)
{
    return 0.25 * left + 0.5 * middle + 0.25 * right;
}

/* Parameters: the old block, the new one, then the neighbours (the block's own ends are fixed where
 * none is). */
struct step_args {
    int has_left, has_right;
};

static int step(const duite_call *call)
{
    const struct step_args *args = call->args;
    const double *old = duite_in(call, 0, double);
    const double *left = args->has_left ? duite_in(call, 2, double) : NULL;
    const double *right = args->has_right ? duite_in(call, 2 + args->has_left, double) : NULL;
    double *new = duite_out(call, 1, double);

    for (int i = 0; i < LENGTH; i++) {
        if ((i == 0 && !left) || (i == LENGTH - 1 && !right)) {
            new[i] = old[i];
            continue;
        }
        new[i] =
            mean(i ? old[i - 1] : left[LENGTH - 1], old[i], i < LENGTH - 1 ? old[i + 1] : right[0]);
    }
    return 0;
}

static const duite_kernel STEP = {.name = "step",
                                  .body = step,
                                  .access = {DUITE_R, DUITE_W},
                                  .rest = DUITE_R,
                                  .args_size = sizeof(struct step_args)};

static void plain(double *x)
{
    double next[N];

    for (int s = 0; s < STEPS; s++) {
        memcpy(next, x, sizeof next);
        for (int i = 1; i < N - 1; i++)
            next[i] = mean(x[i - 1], x[i], x[i + 1]);
        memcpy(x, next, sizeof next);
    }
}

static void fork_steps(duite *rt, duite_object block[2][BLOCKS])
{
    for (int s = 0; s < STEPS; s++)
        for (int b = 0; b < BLOCKS; b++) {
            const duite_object *old = block[s % 2];
            const struct step_args args = {b > 0, b < BLOCKS - 1};
            duite_object objects[4] = {old[b], block[1 - s % 2][b]};
            size_t n = 2;

            if (args.has_left)
                objects[n++] = old[b - 1];
            if (args.has_right)
                objects[n++] = old[b + 1];
            duite_fork(rt, &STEP, &args, n, objects);
        }
}

int main(void)
{
    const duite_kernel *kernels[] = {&STEP, NULL};
    duite_options options = duite_options_default();
    duite_object block[2][BLOCKS];
    double x[N], got[N];
    duite *rt;

    options.kernels = kernels;
    if (duite_start(&rt, &options)) {
        fprintf(stderr, "stencil: %s\n", duite_message());
        return 1;
    }
    for (int i = 0; i < N; i++)
        x[i] = start_value(i);
    for (int b = 0; b < BLOCKS; b++) {
        duite_new(rt, DUITE_F64, LENGTH, &block[0][b]);
        duite_new(rt, DUITE_F64, LENGTH, &block[1][b]);
        duite_follow(rt, block[1][b], block[0][b]);
        duite_hint(rt, block[0][b], 1, b > 0, &block[0][b - (b > 0)], NULL);
        duite_set(rt, block[0][b], x + b * LENGTH);
    }
    fork_steps(rt, block);
    for (int b = 0; b < BLOCKS; b++) {
        duite_get(rt, block[STEPS % 2][b], got + b * LENGTH);
        duite_free(rt, block[0][b]);
        duite_free(rt, block[1][b]);
    }
    plain(x);
    const int same = memcmp(x, got, sizeof x) == 0;

    printf("stencil on rank %d: %s\n", duite_rank(rt), same ? "same bits" : "DIFFERENT");
    if (duite_stop(&rt)) {
        fprintf(stderr, "stencil: %s\n", duite_message());
        return 1;
    }
    return !same;
}
