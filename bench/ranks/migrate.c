/* A ring of blocks, of which those that rank 0 has at first take three times as long as the others,
 * which no hint says: the balancer `migrate` moves some. Against the same ring with the costs as
 * hints, so that it is even from the start. A step is a replay: each block reads its neighbours of
 * the step before and multiplies for some time. */
#include "bench/ranks/ranks.h"

#include <string.h>

enum { BLOCKS = 64, CHEAP_US = 50, STEPS_PER_US = 880, ROOM = 4096, FIRST_STEPS = 40 };
#define EVEN 1.15 /* so much more than the mean may the slower rank have, to count as even */

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned steps = options->quick ? 4 : 100, us = options->quick ? 5 : CHEAP_US;
    const struct subject_shape two = ranks_ours(2, 1);
    const char *const text = "migrate_%s steps=%u us=%u threads=1 scheduler=%s";
    const struct measure_series *moved =
        measure_series(measure, two, text, "time", steps, us, options->scheduler);
    const struct measure_series *even =
        measure_series(measure, two, text, "even", steps, us, options->scheduler);
    const struct measure_series *count =
        measure_series(measure, two, text, "steps", steps, us, options->scheduler);
    measure_value(measure, moved, 1e6 / steps, "us", "migrate_us");
    measure_ratio(measure, moved, even, "migrate_vs_balanced");
    measure_value(measure, count, 1, "steps", "migrate_steps");
}

/* ---- The program ---- */

struct ring {
    duite *rt;
    duite_object block[2][BLOCKS]; /* of even and odd steps */
    duite_graph graph;
    uint64_t us[BLOCKS];
};

struct ring_args {
    uint64_t seed, us;
};

static uint64_t multiply(uint64_t x, uint64_t us)
{
    for (uint64_t i = 0; i < us * STEPS_PER_US; i++)
        x = x * 6364136223846793005u + 1442695040888963407u;
    return x;
}

static int step(const duite_call *call)
{
    const struct ring_args *args = call->args;
    const int64_t *left = duite_in(call, 0, int64_t), *own = duite_in(call, 1, int64_t);
    const int64_t *right = duite_in(call, 2, int64_t);
    int64_t *next = duite_out(call, 3, int64_t);
    const int64_t burnt = (int64_t)(multiply(args->seed, args->us) >> 40);
    for (size_t i = 0; i < ROOM; i++)
        next[i] = ((own[i] + 3 * left[i] + 5 * right[i]) & 0xffffff) + burnt;
    return 0;
}
static const duite_kernel STEP = {.name = "ring_step",
                                  .body = step,
                                  .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                  .args_size = sizeof(struct ring_args)};

/* Two steps, there and back. */
static int build(duite *rt, void *context)
{
    const struct ring *ring = context;
    int code = 0;
    for (int odd = 0; odd < 2; odd++)
        for (int i = 0; i < BLOCKS && !code; i++) {
            const duite_object *from = ring->block[odd];
            code = DUITE_FORK(rt, &STEP, DUITE_ARGS(struct ring_args, (uint64_t)i, ring->us[i]),
                              from[(i + BLOCKS - 1) % BLOCKS], from[i], from[(i + 1) % BLOCKS],
                              ring->block[!odd][i]);
        }
    return code;
}

/* The first half is the dear one, which is rank 0's if all blocks weigh the same. */
static void hint(struct ring *ring, bool told)
{
    for (int i = 0; i < BLOCKS; i++) {
        duite_colocate(ring->rt, ring->block[1][i], ring->block[0][i]);
        duite_hint(ring->rt, ring->block[0][i], told && i < BLOCKS / 2 ? 3 : 1, 0, NULL, NULL);
        duite_hint(ring->rt, ring->block[1][i], 0, 0, NULL, NULL);
    }
}

static int make(struct ring *ring, bool told, uint64_t us)
{
    int code = 0;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < BLOCKS && !code; i++)
            code = duite_new(ring->rt, DUITE_I64, ROOM, &ring->block[k][i]);
    hint(ring, told);
    for (int i = 0; i < BLOCKS; i++)
        ring->us[i] = i < BLOCKS / 2 ? 3 * us : us;
    return code ? code : duite_graph_new(ring->rt, build, ring, &ring->graph);
}

static void drop(struct ring *ring)
{
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < BLOCKS; i++)
            duite_free(ring->rt, ring->block[k][i]);
    duite_graph_free(ring->rt, ring->graph);
}

/* True if the blocks, as they lie now, are as much work for one rank as for the other. */
static bool is_even(const struct ring *ring)
{
    double of[2] = {0, 0};
    for (int i = 0; i < BLOCKS; i++)
        of[duite_home(ring->rt, ring->block[0][i]) != 0] += (double)ring->us[i];
    const double most = of[0] > of[1] ? of[0] : of[1];
    return most <= EVEN * (of[0] + of[1]) / 2;
}

/* The same by hand: all elements of a block are alike. */
static int check(const struct ring *ring, unsigned steps)
{
    static int64_t values[ROOM];
    int64_t now[BLOCKS] = {0}, next[BLOCKS], burnt[BLOCKS];
    for (int i = 0; i < BLOCKS; i++)
        burnt[i] = (int64_t)(multiply((uint64_t)i, ring->us[i]) >> 40);
    for (unsigned k = 0; k < 2 * steps; k++) {
        for (int i = 0; i < BLOCKS; i++)
            next[i] = ((now[i] + 3 * now[(i + BLOCKS - 1) % BLOCKS] + 5 * now[(i + 1) % BLOCKS]) &
                       0xffffff) +
                      burnt[i];
        for (int i = 0; i < BLOCKS; i++)
            now[i] = next[i];
    }
    for (int i = 0; i < BLOCKS; i += BLOCKS / 4) {
        const int code = duite_get(ring->rt, ring->block[0][i], values);
        if (code)
            return tasks_code(code);
        if (values[0] != now[i] || values[ROOM - 1] != now[i])
            return serve_fail("wrong answer");
    }
    return 0;
}

/* So many steps, each an own replay, timed; if `even` is not NULL, the number of the one after
 * which the work was even. */
static int replay(const struct ring *ring, unsigned steps, double *seconds, unsigned *even)
{
    int code = duite_wait(ring->rt);
    const double start = serve_seconds();
    for (unsigned k = 1; k <= steps && !code; k++) {
        code = duite_replay(ring->rt, ring->graph, 1);
        if (even && *even > k && is_even(ring))
            *even = k;
    }
    if (!code)
        code = duite_wait(ring->rt);
    *seconds = serve_seconds() - start;
    return tasks_code(code);
}

static int start(struct ranks_session *session, struct serve_request *request, const char *balance,
                 duite **rt)
{
    static const duite_kernel *const kernels[] = {&STEP, NULL};
    duite_options options = duite_options_default();
    options.kernels = kernels;
    options.mapping = duite_mapping_find("block"); /* neighbours together, and a half for each */
    options.balance = duite_balancer_find(balance);
    return ranks_start(session, request, &options, rt);
}

/* The ring moves on for a while, in which blocks may move; then it is timed. */
static int run(void *context, struct serve_request *request, const char *balance, double *seconds,
               unsigned *even)
{
    struct ring ring = {.rt = NULL};
    const unsigned steps = (unsigned)serve_number(request, "steps");
    const uint64_t us = serve_number(request, "us");
    double first;
    int code = start(context, request, balance, &ring.rt);
    if (code)
        return code;
    code = tasks_code(make(&ring, !strcmp(balance, "none"), us));
    if (!code)
        code = replay(&ring, FIRST_STEPS, &first, even);
    if (!code)
        code = replay(&ring, steps, seconds, NULL);
    if (!code)
        code = check(&ring, FIRST_STEPS + steps);
    if (!code)
        drop(&ring);
    return ranks_stop(&ring.rt, code);
}

static int run_time(void *context, struct serve_request *request, double *value)
{
    return run(context, request, "migrate", value, NULL);
}

static int run_even(void *context, struct serve_request *request, double *value)
{
    return run(context, request, "none", value, NULL);
}

/* One more than there were if it never was even. */
static int run_steps(void *context, struct serve_request *request, double *value)
{
    unsigned even = FIRST_STEPS + 1;
    double seconds;
    const int code = run(context, request, "migrate", &seconds, &even);
    *value = even;
    return code;
}

static const struct serve_run RUNS[] = {
    {"migrate_time", run_time}, {"migrate_even", run_even}, {"migrate_steps", run_steps}, {0}};

const struct bench_case ranks_migrate = {
    "migrate", "blocks three times as dear on one of two ranks, until they have moved", plan, RUNS,
    0};
