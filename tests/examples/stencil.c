/* A stencil on a ring of blocks whose neighbours are known only at run time: every step a block
 * becomes the mean of the blocks at the offsets given on the command line (default: -1 0 1).
 * Compared with a plain loop, to the last bit. */

#include <duite.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCKS = 9, LENGTH = 100, STEPS = 40, MOST = BLOCKS };

struct ring {
    int n, offset[MOST];
    duite_object now[BLOCKS], next[BLOCKS];
};

static int neighbour(const struct ring *ring, int block, int j)
{
    return ((block + ring->offset[j]) % BLOCKS + BLOCKS) % BLOCKS;
}

/* Parameter 0 is written; how many others are read, the fork decides. */
static int mean(const duite_call *call)
{
    double *out = duite_out(call, 0, double);
    for (size_t i = 0; i < duite_count(call, 0); i++) {
        double sum = 0;
        for (size_t j = 1; j < call->n_params; j++)
            sum += duite_in(call, j, double)[i];
        out[i] = sum / (double)(call->n_params - 1);
    }
    return 0;
}

static const duite_kernel MEAN = {
    .name = "mean", .body = mean, .access = {DUITE_W}, .variadic = DUITE_R};

static void step(duite *rt, const struct ring *ring, const duite_object *from,
                 const duite_object *to)
{
    for (int b = 0; b < BLOCKS; b++) {
        duite_object objects[1 + MOST] = {to[b]};
        for (int j = 0; j < ring->n; j++)
            objects[1 + j] = from[neighbour(ring, b, j)];
        duite_fork(rt, &MEAN, NULL, 1 + (size_t)ring->n, objects);
    }
}

/* One round of the graph: there and back. */
static int two_steps(duite *rt, void *context)
{
    const struct ring *ring = context;
    step(rt, ring, ring->now, ring->next);
    step(rt, ring, ring->next, ring->now);
    return 0;
}

static void plain(const struct ring *ring, double x[2][BLOCKS][LENGTH])
{
    for (int s = 0; s < STEPS; s++)
        for (int k = 0; k < BLOCKS * LENGTH; k++) {
            double sum = 0;
            for (int j = 0; j < ring->n; j++)
                sum += x[s % 2][neighbour(ring, k / LENGTH, j)][k % LENGTH];
            x[1 - s % 2][k / LENGTH][k % LENGTH] = sum / ring->n;
        }
}

static int run(duite *rt, struct ring *ring)
{
    double x[2][BLOCKS][LENGTH], got[LENGTH] = {0};
    duite_graph graph;
    int wrong = 0;
    for (int b = 0; b < BLOCKS; b++) {
        duite_new(rt, DUITE_F64, LENGTH, &ring->now[b]);
        duite_new(rt, DUITE_F64, LENGTH, &ring->next[b]);
        duite_colocate(rt, ring->next[b], ring->now[b]);
    }
    for (int b = 0; b < BLOCKS; b++)
        for (int j = 0; j < ring->n; j++) /* so that neighbours share a rank */
            duite_hint(rt, ring->now[b], 1, 1, &ring->now[neighbour(ring, b, j)], NULL);
    for (int b = 0; b < BLOCKS; b++) {
        for (int i = 0; i < LENGTH; i++)
            x[0][b][i] = (b * LENGTH + i) * 7919 % 1000 / 37.0;
        duite_set(rt, ring->now[b], x[0][b]);
    }
    duite_graph_new(rt, two_steps, ring, &graph);
    duite_replay(rt, graph, STEPS / 2);
    plain(ring, x);
    if (duite_wait(rt)) /* tells what is wrong so far */
        fprintf(stderr, "stencil: %s\n", duite_message());
    for (int b = 0; b < BLOCKS; b++) {
        duite_get(rt, ring->now[b], got);
        wrong |= memcmp(x[0][b], got, sizeof got) != 0;
        duite_free(rt, ring->now[b]);
        duite_free(rt, ring->next[b]);
    }
    duite_graph_free(rt, graph);
    return wrong;
}

int main(int argc, char **argv) /* stencil [SCHEDULER [OFFSET...]] */
{
    duite_options options = duite_options_default();
    struct ring ring = {.n = 3, .offset = {-1, 0, 1}};
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&MEAN, NULL};
    if (argc > 2)
        ring.n = 0;
    for (int i = 2; i < argc && ring.n < MOST; i++)
        ring.offset[ring.n++] = atoi(argv[i]);
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "stencil: %s\n", duite_message()), 1;
    int wrong = run(rt, &ring);
    if (duite_stop(&rt)) /* tells the errors that nobody asked for */
        return fprintf(stderr, "stencil: %s\n", duite_message()), 1;
    return wrong;
}
