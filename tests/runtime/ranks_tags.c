/* Recorded graphs on several ranks where MPI has hardly any tags: they are handed out again, the
 * same on all ranks, though a graph that was freed still runs on one of them. Run under mpirun. */

#include "runtime/comm/internal.h"
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <unistd.h>

enum { FEW_TAGS = COMM_CHANNELS + 8 };

static int tags; /* 0: MPI's own */

int MPI_Comm_get_attr(MPI_Comm comm, int key, void *value, int *known)
{
    const int code = PMPI_Comm_get_attr(comm, key, value, known);
    if (tags && key == MPI_TAG_UB)
        *(int **)value = &tags;
    return code;
}

KERNEL(SLOW, "slow", .access = {DUITE_RW})
{
    usleep(300000);
    duite_out(call, 0, int32_t)[0]++;
    return 0;
}

/* On the first rank, and copied to the last one. */
struct pair {
    duite_object from, to;
    int slow;
};

static int build(duite *rt, void *context)
{
    const struct pair *pair = context;
    duite_fork_at(rt, 0, &SET, &(int32_t){7}, 1, &pair->from);
    duite_fork_at(rt, ranks - 1, &COPY, NULL, 2, (duite_object[]){pair->from, pair->to});
    return pair->slow ? duite_fork_at(rt, ranks - 1, &SLOW, NULL, 1, &pair->to) : 0;
}

/* A graph that is recorded, replayed once and freed. */
static int replay_once(duite *rt, struct pair *pair)
{
    duite_graph graph;
    int code = duite_graph_new(rt, build, pair, &graph);
    if (code)
        return code;
    code = duite_replay(rt, graph, 1);
    duite_graph_free(rt, graph);
    return code;
}

static duite *start(struct pair *pair, int n)
{
    static const duite_kernel *const LIST[] = {&SET, &COPY, &SLOW, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = LIST;
    duite *rt = misuse_start_with(&options);
    for (int i = 0; i < n; i++)
        pair[i] = (struct pair){misuse_new(rt, 1), misuse_new(rt, 1), i == 0};
    return rt;
}

static int stop(duite *rt, const struct pair *pair, int n)
{
    for (int i = 0; i < n; i++) {
        duite_free(rt, pair[i].from);
        duite_free(rt, pair[i].to);
    }
    return duite_stop(&rt);
}

/* A graph that is held throughout, a slow one that is freed while it runs, and many short ones. */
static int many(void)
{
    struct pair pair[3];
    duite *rt = start(pair, 3);
    int32_t slow = 0, value = 0;
    duite_graph held;
    int code = !rt || duite_graph_new(rt, build, &pair[2], &held) || duite_replay(rt, held, 1);
    for (int i = 0; i < 40 && !code; i++)
        code = replay_once(rt, &pair[i % 20 != 0]) || duite_replay(rt, held, 1);
    code = code || duite_get(rt, pair[0].to, &slow) || duite_get(rt, pair[1].to, &value);
    code = code || duite_graph_free(rt, held);
    return !code && slow == 9 && value == 8 && !stop(rt, pair, 3);
}

/* More graphs at once than there are tags for. */
static int too_many(void)
{
    struct pair pair;
    duite *rt = start(&pair, 1);
    duite_graph graph[8];
    int32_t value = 0;
    int code = !rt, refused = 0;
    pair.slow = 0;
    for (int i = 0; i < 8 && !code; i++) {
        code = duite_graph_new(rt, build, &pair, &graph[i]);
        refused += !code && duite_replay(rt, graph[i], 1) == DUITE_E_MPI;
    }
    const int told = code ? 0 : duite_get(rt, pair.to, &value);
    for (int i = 0; i < 8 && !code; i++)
        code = duite_graph_free(rt, graph[i]);
    const int some = ranks > 1 ? refused > 0 && refused < 8 && told == DUITE_E_MPI
                               : !refused && !told && value == 8;
    return !code && some && !stop(rt, &pair, 1);
}

RANKS_CASE(tags)
{
    misuse_mpi();
    for (tags = FEW_TAGS; tags < FEW_TAGS + 30; tags += 9)
        tap_case(many(), "tags are handed out again");
    tags = FEW_TAGS;
    tap_case(too_many(), "graphs that have no tags are refused on all ranks");
    return tap_done();
}
