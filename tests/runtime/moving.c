/* A test's wish is the same on all ranks; rank 0's balancer does it. */

#include "tests/runtime/moving.h"

#include "tests/runtime/delegation.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

int wanted;
atomic_int ran;
struct moving_seen seen;

static void note(const duite_blocks *blocks, const int *home)
{
    seen.calls++;
    seen.blocks = *blocks;
    memset(seen.edge, 0, sizeof seen.edge);
    for (int r = 0; r < ranks; r++)
        seen.other[r] = blocks->other[r];
    for (size_t i = 0; i < blocks->graph.n; i++) {
        seen.weight[i] = blocks->graph.weight[i];
        seen.bytes[i] = blocks->bytes[i];
        seen.fixed[i] = blocks->fixed[i];
        seen.home[i] = home[i];
        for (size_t e = blocks->graph.start[i]; e < blocks->graph.start[i + 1]; e++)
            seen.edge[i][blocks->graph.neighbour[e]] += blocks->graph.edge_weight[e];
    }
}

static uint64_t migrate(void *state, const duite_blocks *blocks, int *home)
{
    (void)state;
    note(blocks, home);
    for (size_t i = 0; i < blocks->graph.n; i++)
        if (wanted == WRONG)
            home[i] = ranks;
        else if (wanted == FORCED || (wanted != STAY && !blocks->fixed[i]))
            home[i] = wanted < 0 ? (home[i] + 1) % ranks : wanted;
    return 1;
}

const duite_balancer TOLD = {.size = sizeof(duite_balancer),
                             .name = "told",
                             .summary = "what the test wants",
                             .migrate = migrate};

KERNEL_SHARED(STEP, "step", .access = {DUITE_RW, DUITE_R})
{
    atomic_fetch_add(&ran, 1);
    duite_out(call, 0, int32_t)[0] += duite_in(call, 1, int32_t)[0] + 1;
    return 0;
}
const duite_kernel STAYS = {
    .name = "stays", .body = STEP_body, .access = {DUITE_RW, DUITE_R}, .fixed = 1};

KERNEL_SHARED(DOZE, "doze", .access = {DUITE_RW}, .variadic = DUITE_R)
{
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

/* The child runs for whom its parent runs, whatever it writes. */
KERNEL_SHARED(PARENT, "parent", .access = {DUITE_RW, DUITE_RWP})
{
    DUITE_FORK(call->rt, &DOZE, NULL, call->param[1].object);
    return 0;
}

KERNEL_SHARED(THIRD, "third", .access = {DUITE_CW}, .args_size = sizeof(int32_t))
{
    duite_out(call, 0, float)[0] = 1.0f / (float)*(const int32_t *)call->args;
    return 0;
}

KERNEL_SHARED(COUNTDOWN, "countdown", .access = {DUITE_RW}, .replicated = 1)
{
    duite_out(call, 0, int32_t)[0]--;
    return 0;
}

static const duite_kernel *const LIST[] = {&STEP, &STAYS, &DOZE, &PARENT,    &THIRD,
                                           &GROW, &SET,   &FAIL, &COUNTDOWN, NULL};

duite *moving_start(const duite_balancer *balancer)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = LIST;
    options.mapping = duite_mapping_find("cyclic");
    options.balance = balancer;
    wanted = STAY;
    atomic_store(&ran, 0);
    return misuse_start_with(&options);
}

/* ---- Graphs ---- */

static int build(duite *rt, void *context)
{
    const struct things *things = context;

    for (int i = 0; i < things->tasks; i++)
        duite_fork_with(rt, &(duite_task_options){.at = things->at < 0 ? NULL : &things->at},
                        things->kernel, NULL, (size_t)things->n, things->object);
    return 0;
}

duite_graph moving_record(duite *rt, struct things things)
{
    duite_graph graph = DUITE_NO_GRAPH;

    if (duite_graph_new(rt, build, &things, &graph))
        printf("# %s\n", duite_message());
    return graph;
}

/* A replay of nothing: the first of all asks nobody, the others move what is wanted. */
int moving(duite *rt, duite_graph nothing, int where)
{
    wanted = where;
    const int code = duite_replay(rt, nothing, 1);

    wanted = STAY;
    return code;
}

duite_graph moving_begin(duite *rt)
{
    const duite_graph nothing = moving_record(rt, (struct things){.at = -1});

    duite_replay(rt, nothing, 1);
    return nothing;
}

int value_of(duite *rt, duite_object object)
{
    int32_t value = -1;

    return duite_get(rt, object, &value) ? -2 : value;
}

uint64_t migrated(duite *rt)
{
    duite_counters counters;

    return duite_count_all(rt, &counters) ? 0 : counters.migrated;
}

void moving_end(duite *rt, duite_graph nothing, const char *name)
{
    duite_graph_free(rt, nothing);
    tap_case(duite_stop(&rt) == DUITE_OK, name);
}
