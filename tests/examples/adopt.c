/* A program with an array of its own on each rank, in blocks: duite works in it, without a copy,
 * and gives it back. Each block in turn becomes the mean of itself and the next one; then block 0
 * is changed by hand; and so on. */

#include <duite.h>

#include <stdio.h>
#include <stdlib.h>

enum { PER_RANK = 4, LENGTH = 1000, STEPS = 10, MOST = 64 };

static int mean(const duite_call *call)
{
    double *x = duite_out(call, 0, double);
    const double *next = duite_in(call, 1, double);
    for (size_t i = 0; i < duite_count(call, 0); i++)
        x[i] = (x[i] + next[i]) / 2;
    return 0;
}

static const duite_kernel MEAN = {.name = "mean", .body = mean, .access = {DUITE_RW, DUITE_R}};

/* The program's own turn on an object, on the rank where its memory is. */
static void cool(duite *rt, duite_object block)
{
    void *data;
    duite_acquire(rt, block, DUITE_RW, &data);
    for (int i = 0; data && i < LENGTH; i++)
        ((double *)data)[i] -= 1;
    duite_release(rt, block);
}

static int work(duite *rt, int n, double *mine)
{
    duite_object block[MOST];
    for (int b = 0; b < n; b++) { /* each rank gives its own blocks */
        const int rank = b / PER_RANK, here = rank == duite_rank(rt);
        duite_adopt(rt, rank, DUITE_F64, LENGTH, here ? mine + b % PER_RANK * LENGTH : NULL, NULL,
                    NULL, &block[b]);
    }
    for (int step = 0; step < STEPS; step++) {
        for (int b = 0; b < n; b++)
            DUITE_FORK(rt, &MEAN, NULL, block[b], block[(b + 1) % n]);
        cool(rt, block[0]);
    }
    for (int b = 0; b < n; b++)
        duite_free(rt, block[b]);
    return duite_wait(rt); /* the array is the program's again */
}

/* The same without duite; all elements of a block are alike. */
static void plain(int n, double *block)
{
    for (int step = 0; step < STEPS; step++) {
        for (int b = 0; b < n; b++)
            block[b] = (block[b] + block[(b + 1) % n]) / 2;
        block[0] -= 1;
    }
}

static int run(duite *rt) /* returns 0 if the array is right */
{
    const int n = duite_ranks(rt) * PER_RANK, first = duite_rank(rt) * PER_RANK;
    double *mine = malloc(PER_RANK * LENGTH * sizeof *mine), block[MOST];
    if (!mine || n > MOST)
        return fprintf(stderr, "adopt: no memory, or too many ranks\n"), free(mine), 1;
    for (int i = 0; i < PER_RANK * LENGTH; i++)
        mine[i] = first + i / LENGTH;
    for (int b = 0; b < n; b++)
        block[b] = b;
    int wrong = work(rt, n, mine);
    if (wrong)
        fprintf(stderr, "adopt: %s\n", duite_message());
    plain(n, block);
    for (int i = 0; i < PER_RANK * LENGTH; i++)
        wrong |= mine[i] != block[first + i / LENGTH];
    if (first == 0)
        printf("adopt: %s\n", wrong ? "wrong" : "right");
    free(mine);
    return wrong;
}

int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&MEAN, NULL};
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "adopt: %s\n", duite_message()), 1;
    int wrong = run(rt);
    if (duite_stop(&rt))
        return fprintf(stderr, "adopt: %s\n", duite_message()), 1;
    return wrong;
}
