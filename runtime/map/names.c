/* The built-in mappings by name, the default first. */
#include "runtime/map/map.h"

#include "runtime/base/policy.h"
#include "runtime/map/front.h"

static const char *const names[] = {"metis",     "block", "cyclic", "random",
                                    "taskgraph", "list",  NULL};
static const void *const tables[] = {&map_metis,  &map_block,     &map_cyclic,
                                     &map_random, &map_taskgraph, &map_list};

static const struct base_policies all = {"mapping", "duite_own_mapping", names, tables};

const duite_mapping *duite_mapping_find(const char *name)
{
    return base_policy_find(&all, name);
}

const char *const *duite_mapping_names(void)
{
    return names;
}

bool map_is_foreign(const duite_mapping *mapping)
{
    return !base_policy_is_ours(&all, mapping);
}
