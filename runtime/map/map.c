/* The built-in mappings by name (the rows of map.h), the calls of any mapping, and the mappings
 * that look at no graph. */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/policy.h"

#define MAP_TABLE(name) &map_##name,

/* No mapping is for tests only. */
static const char *const map_names[] = {MAP_ROWS(BASE_POLICY_NAME) NULL, NULL};
static const void *const map_tables[] = {MAP_ROWS(MAP_TABLE) NULL, NULL};
const struct base_policies map_policies = {.kind = "mapping",
                                           .type = "duite_mapping",
                                           .symbol = "duite_own_mapping",
                                           .size = sizeof(duite_mapping),
                                           .names = map_names,
                                           .tables = map_tables};

const duite_mapping *duite_mapping_find(const char *name)
{
    return base_policy_find(&map_policies, name);
}

const char *const *duite_mapping_names(void)
{
    return map_names;
}

/* A mapping that is not built in has no message of its own. */
static int map_failed(const duite_mapping *own, int code)
{
    return code && !base_policy_is_ours(&map_policies, own)
               ? base_error(code, "mapping %s failed with code %d (%s)", own->name, code,
                            duite_code_text(code))
               : code;
}

int map_ask(const struct map_policy *mapping, const duite_object_graph *graph, int n_ranks,
            uint64_t seed, int *home)
{
    base_mark_begin(mapping->mark, BASE_MAPPING_MAP);
    const int code = mapping->own->map(graph, n_ranks, seed, home);
    base_mark_end(mapping->mark);
    return map_failed(mapping->own, code);
}

int map_ask_tasks(const struct map_policy *mapping, const duite_task_graph *graph, int *home)
{
    base_mark_begin(mapping->mark, BASE_MAPPING_MAP_TASKS);
    const int code = mapping->own->map_tasks(graph, home);
    base_mark_end(mapping->mark);
    return code;
}

/* ---- Mappings ---- */

/* block: contiguous ranges of objects, in the order they were made, of equal weight. Ignores hints;
 * few messages if neighbours are made one after another. */

/* Object i goes to the rank where the middle of its weight falls; fewer objects than ranks go
 * round. */
static int block_map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    double sum = 0, before = 0;
    for (size_t i = 0; i < graph->n; i++)
        sum += graph->weight[i];
    for (size_t i = 0; i < graph->n; i++) {
        double middle = sum > 0 ? (before + 0.5 * graph->weight[i]) / sum : 0;
        int rank = (int)(middle * n_ranks);
        if (graph->n < (size_t)n_ranks)
            rank = (int)((graph->before + i) % (uint64_t)n_ranks);
        home[i] = rank < n_ranks ? rank : n_ranks - 1;
        before += graph->weight[i];
    }
    return 0;
}

const duite_mapping map_block = {
    .size = sizeof(duite_mapping),
    .name = "block",
    .summary = "contiguous ranges of equal weight, in the order the objects were made",
    .map = block_map,
};

/* cyclic: object after object to rank after rank. Balances numbers but separates all neighbours:
 * the worst sensible case. */

static int cyclic_map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = (int)((graph->before + i) % (uint64_t)n_ranks);
    return 0;
}

const duite_mapping map_cyclic = {
    .size = sizeof(duite_mapping),
    .name = "cyclic",
    .summary = "object after object to rank after rank",
    .map = cyclic_map,
};

/* random: a random rank for each object, as by hashing. The least that a mapping with knowledge has
 * to beat. */

static int random_map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    for (size_t i = 0; i < graph->n; i++) {
        uint64_t state = (seed << 40) ^ (graph->before + i);
        home[i] = (int)(duite_random(&state) % (uint64_t)n_ranks);
    }
    return 0;
}

const duite_mapping map_random = {
    .size = sizeof(duite_mapping),
    .name = "random",
    .summary = "each object to a random rank, from the seed",
    .map = random_map,
};
