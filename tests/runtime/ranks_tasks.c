/* Mappings that see the tasks of recorded graphs: what they are shown and when, their answers that
 * are refused, and the answers of `taskgraph` and `list` to graphs that were made for them. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <duite_policy.h>
#include <stdio.h>
#include <string.h>

enum { CHAINS = 12, LENGTH = 6, WIDTH = 100 };

/* ---- What is shown ---- */

static struct {
    int calls, right, wrong; /* wrong: answer with a rank that there is not */
    int code;                /* to return */
    double cost[3];
} seen;

static int map_first(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = (int)(i % (size_t)n_ranks);
    return 0;
}

/* Three forks: a writes x, b reads x and writes y, c adds to y; y is y's block, z follows x. */
static int look(const duite_task_graph *graph, int *home)
{
    const size_t *start = graph->start;

    seen.calls++;
    seen.right = graph->n == 3 && graph->n_blocks == 2 && graph->n_ranks == ranks &&
                 graph->block[0] == 0 && graph->block[1] == 1 && graph->block[2] == 1 &&
                 start[0] == 0 && start[1] == 0 && start[2] == 1 && start[3] == 2 &&
                 graph->from[0] == 0 && graph->bytes[0] == 4 * WIDTH && graph->from[1] == 1 &&
                 graph->bytes[1] == 4 * 3 && !graph->fixed[0] && graph->workers[ranks - 1] == 1 &&
                 graph->byte_seconds >= 0 && graph->message_seconds > 0;
    for (int i = 0; i < 3; i++)
        seen.cost[i] = graph->cost[i];
    home[1] = seen.wrong ? ranks : ranks - 1;
    return seen.code;
}

static const duite_mapping TOLD = {.size = sizeof(duite_mapping),
                                   .name = "told",
                                   .summary = "for tests",
                                   .map = map_first,
                                   .map_tasks = look};

KERNEL(ADD_UP, "add_up", .access = {DUITE_RW})
{
    duite_out(call, 0, int32_t)[0] += duite_in(call, 0, int32_t)[0] + 1;
    return 0;
}

KERNEL(LINK, "link", .access = {DUITE_W, DUITE_R})
{
    duite_out(call, 0, int32_t)[0] = duite_in(call, 1, int32_t)[0] + 1;
    return 0;
}

static duite *start(const duite_mapping *mapping)
{
    static const duite_kernel *const KERNELS[] = {&SET, &ADD_UP, &LINK, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.mapping = mapping;
    options.threads = 1;
    duite *rt = misuse_start_with(&options);
    tap_case(rt != NULL, mapping->name);
    return rt;
}

struct three {
    duite_object x, y, z;
    double cost; /* of the last fork; 0: it does not say */
};

static int build_three(duite *rt, void *context)
{
    const struct three *t = context;
    const int32_t seven = 7;

    duite_fork_with(rt, &(duite_task_options){.cost = 2}, &SET, &seven, 1, &t->x);
    duite_fork_with(rt, &(duite_task_options){.cost = 3}, &LINK, NULL, 2,
                    (duite_object[]){t->y, t->x});
    return duite_fork_with(rt, &(duite_task_options){.cost = t->cost}, &ADD_UP, NULL, 1, &t->y);
}

/* Replays three times; how often is the mapping asked, and is the answer followed? */
static void shown(double cost, int calls, const char *name)
{
    duite *rt = start(&TOLD);
    struct three t = {.x = misuse_new(rt, WIDTH), .y = misuse_new(rt, 3), .cost = cost};
    duite_graph graph;
    int32_t value[3];

    t.z = misuse_new(rt, 1);
    duite_colocate(rt, t.z, t.x);
    seen.calls = 0;
    duite_graph_new(rt, build_three, &t, &graph);
    for (int i = 0; i < 3; i++)
        duite_replay(rt, graph, 2);
    tap_case(rank || ranks == 1 || seen.calls == calls, name);
    tap_case(rank || ranks == 1 || (seen.right && seen.cost[0] == 2 && seen.cost[1] == 3),
             "it sees the round");
    tap_case(rank || ranks == 1 || (cost > 0 ? seen.cost[2] == cost : seen.cost[2] > 0),
             "with what it costs");
    tap_case(duite_home(rt, t.y) == ranks - 1, "what it says is done");
    tap_case(duite_get(rt, t.y, value) == DUITE_OK && value[0] == 17, "and changes no result");
    duite_free(rt, t.x);
    duite_free(rt, t.y);
    duite_free(rt, t.z);
    duite_graph_free(rt, graph);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
}

/* All ranks hear the same. */
static void refused(int wrong, int code, const char *sentence)
{
    duite *rt = start(&TOLD);
    struct three t = {.x = misuse_new(rt, WIDTH), .y = misuse_new(rt, 3), .cost = 1};
    duite_graph graph;

    seen.wrong = wrong;
    seen.code = code;
    duite_graph_new(rt, build_three, &t, &graph);
    const int told = duite_replay(rt, graph, 1);

    tap_case(ranks == 1 ? told == DUITE_OK
                        : told == (code ? code : DUITE_E_ARGUMENT) &&
                              strstr(duite_message(), sentence) != NULL,
             sentence);
    seen.wrong = seen.code = 0;
    tap_case(duite_wait(rt) == told, "it is told again");
    duite_free(rt, t.x);
    duite_free(rt, t.y);
    duite_graph_free(rt, graph);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
}

/* ---- What is made of it ---- */

/* Chains of tasks, each on an object of its own and reading the one before; chain c costs c + 1 a
 * task. They are made step after step, so that neighbours in order are of different chains. */
static int build_chains(duite *rt, void *context)
{
    const duite_object *object = context;

    for (int s = 0; s < LENGTH; s++)
        for (int c = 0; c < CHAINS; c++) {
            const duite_task_options how = {.cost = 1e-3 * (c + 1)};

            if (s)
                duite_fork_with(
                    rt, &how, &LINK, NULL, 2,
                    (duite_object[]){object[s * CHAINS + c], object[(s - 1) * CHAINS + c]});
            else
                duite_fork_with(rt, &how, &SET, &c, 1, &object[c]);
        }
    return 0;
}

/* The load of the rank that has most over the mean; and the chains' links that leave a rank. */
static void judge(const char *mapping, double *uneven, int *cut)
{
    duite *rt = start(duite_mapping_find(mapping));
    duite_object object[CHAINS * LENGTH];
    double load[16] = {0}, max = 0, all = 0;
    duite_graph graph;
    int32_t value[WIDTH];

    for (int i = 0; i < CHAINS * LENGTH; i++)
        object[i] = misuse_new(rt, WIDTH);
    duite_graph_new(rt, build_chains, object, &graph);
    duite_replay(rt, graph, 1);
    *cut = 0;
    for (int i = 0; i < CHAINS * LENGTH; i++) {
        const int home = duite_home(rt, object[i]);

        load[home] += i % CHAINS + 1;
        all += i % CHAINS + 1;
        *cut += i >= CHAINS && duite_home(rt, object[i - CHAINS]) != home;
    }
    for (int r = 0; r < ranks; r++)
        max = load[r] > max ? load[r] : max;
    *uneven = max * ranks / all;
    tap_case(duite_get(rt, object[CHAINS * LENGTH - 1], value) == DUITE_OK &&
                 value[0] == CHAINS - 1 + LENGTH - 1,
             "results are right");
    for (int i = 0; i < CHAINS * LENGTH; i++)
        duite_free(rt, object[i]);
    duite_graph_free(rt, graph);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
}

/* The chains do not depend on one another: whoever knows them cuts none, and evens out what they
 * cost; `block` cuts them all. */
static void chains(void)
{
    double by_block, by_list, by_taskgraph;
    int cut_by_block, cut_by_list, cut_by_taskgraph;

    judge("block", &by_block, &cut_by_block);
    judge("list", &by_list, &cut_by_list);
    judge("taskgraph", &by_taskgraph, &cut_by_taskgraph);
    if (!rank)
        printf("# uneven, cut: block %.3f %d, list %.3f %d, taskgraph %.3f %d\n", by_block,
               cut_by_block, by_list, cut_by_list, by_taskgraph, cut_by_taskgraph);
    tap_case(ranks == 1 || cut_by_block >= CHAINS * (ranks - 1), "block cuts the chains");
    tap_case(cut_by_taskgraph == 0 && by_taskgraph < 1.15, "taskgraph cuts none and is even");
    tap_case(by_list < 1.1, "list is even");
}

RANKS_CASE(tasks)
{
    misuse_mpi();
    shown(5, 1, "with all costs it is asked once");
    shown(0, 2, "else twice");
    refused(1, 0,
            "mapping told moves a block to a rank that does not exist, or moves a fixed block");
    refused(0, 3, "mapping told failed on rank 0 with code 3");
    chains();
    return tap_done();
}
