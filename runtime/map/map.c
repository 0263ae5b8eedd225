/* The built-in mappings by name (the rows of map.h), and the calls of any mapping. */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/policy.h"

#define MAP_TABLE(name) &map_##name,

/* No mapping is for tests only. */
static const char *const map_names[] = {MAP_ROWS(BASE_POLICY_NAME) NULL, NULL};
static const void *const map_tables[] = {MAP_ROWS(MAP_TABLE) NULL, NULL};
static const struct base_policies mappings = {"mapping", "duite_own_mapping", map_names,
                                              map_tables};

const duite_mapping *duite_mapping_find(const char *name)
{
    return base_policy_find(&mappings, name);
}

const char *const *duite_mapping_names(void)
{
    return map_names;
}

bool map_is_foreign(const duite_mapping *mapping)
{
    return !base_policy_is_ours(&mappings, mapping);
}

/* A mapping that is not built in has no message of its own. */
static int map_failed(const duite_mapping *own, int code)
{
    return code && map_is_foreign(own) ? base_error(code, "mapping %s failed with code %d (%s)",
                                                    own->name, code, duite_code_text(code))
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
