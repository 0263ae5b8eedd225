/* Views on several ranks: every rank finds the elements as the forks so far leave them, and
 * messages have these elements only. Run under mpirun. */
#include "tests/negative/misuse.h"

#include <stdint.h>

enum { MOST = 100000, N = 5, ROUNDS = 40 };

/* Element i of round r. */
static int64_t value_of(int r, size_t i)
{
    return 1000000 * (int64_t)r + (int64_t)i;
}

static int fill(const duite_call *call)
{
    const int r = *(const int *)call->args;

    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int64_t)[i] = value_of(r, i);
    return 0;
}

static int copy(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 1, int64_t)[i] = duite_in(call, 0, int64_t)[i];
    return duite_count(call, 0) == N ? 0 : 1;
}

static const duite_kernel FILL = {
    .name = "fill", .body = fill, .access = {DUITE_W}, .args_size = sizeof(int)};
static const duite_kernel COPY_ALL = {
    .name = "copy all", .body = copy, .access = {DUITE_R, DUITE_W}};

static int is_right(const int64_t *values, const size_t *index, int r)
{
    for (size_t i = 0; i < N; i++)
        if (values[i] != value_of(r, index[i]))
            return 0;
    return 1;
}

/* The object goes round the ranks, and its view ahead of it. */
static int go_round(duite *rt, duite_object a, duite_object view, duite_object copied,
                    const size_t *index)
{
    const int ranks = duite_ranks(rt);
    int64_t values[N];
    int right = 1;

    for (int r = 0; r < ROUNDS; r++) {
        duite_fork_at(rt, r % ranks, &FILL, &r, 1, &a);
        duite_fork_at(rt, (r + r / 2 + 1) % ranks, &COPY_ALL, NULL, 2,
                      (duite_object[]){view, copied});
        if (duite_get(rt, copied, values))
            return 0;
        right &= is_right(values, index, r);
        if (r % 3)
            continue;
        right &= !duite_get(rt, view, values) && is_right(values, index, r);
    }
    return right;
}

static int build(duite *rt, void *context)
{
    const duite_object *objects = context; /* the object, the view, the copy */
    const int r = 7;

    duite_fork_at(rt, 0, &FILL, &r, 1, objects);
    duite_fork_at(rt, duite_ranks(rt) - 1, &COPY_ALL, NULL, 2, objects + 1);
    return 0;
}

static int replays(duite *rt, duite_object *objects, const size_t *index)
{
    int64_t values[N];
    duite_graph graph;
    int right = !duite_graph_new(rt, build, objects, &graph);

    right &= !duite_replay(rt, graph, 3) && !duite_get(rt, objects[2], values);
    right &= is_right(values, index, 7);
    return right & !duite_graph_free(rt, graph);
}

int main(void)
{
    static const duite_kernel *const KERNELS[] = {&FILL, &COPY_ALL, NULL};
    static const size_t INDEX[N] = {MOST - 1, 0, 17, 40000, 17};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_object made[3];
    duite_counters counters;
    duite *rt;

    misuse_mpi();
    options.kernels = KERNELS;
    tap_case(duite_start(&rt, &options) == DUITE_OK, "starts");
    duite_new(rt, DUITE_I64, MOST, &made[0]);
    duite_view(rt, made[0], N, INDEX, &made[1]);
    duite_new(rt, DUITE_I64, N, &made[2]);
    tap_case(go_round(rt, made[0], made[1], made[2], INDEX), "every rank finds the elements");
    tap_case(replays(rt, made, INDEX), "and finds them in replays");
    tap_case(duite_wait(rt) == DUITE_OK, "no body found anything wrong");
    tap_case(duite_count_all(rt, &counters) == DUITE_OK && counters.bytes < MOST,
             "messages have these elements only");
    tap_case(duite_home(rt, made[0]) == duite_home(rt, made[1]), "a view lives with its object");
    for (int i = 2; i >= 0; i--)
        duite_free(rt, made[i]);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
    return tap_done();
}
