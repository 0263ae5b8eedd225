/* The built-in mappings by name: the rows of map.h. */
#include "runtime/map/map.h"

#include "runtime/base/policy.h"
#include "runtime/map/front.h"

#define MAP_TABLE(name) &map_##name,

/* None is for tests. */
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
