/* The built-in mappings by name, the default first. */
#include "runtime/map/map.h"

#include <string.h>

static const duite_mapping *const mappings[] = {&map_metis, &map_cyclic};
enum { N_MAPPINGS = sizeof mappings / sizeof mappings[0] };

const duite_mapping *duite_mapping_find(const char *name)
{
    for (int i = 0; i < N_MAPPINGS; i++)
        if (name && !strcmp(mappings[i]->name, name))
            return mappings[i];
    return NULL;
}

const char *const *duite_mapping_names(void)
{
    static const char *const names[N_MAPPINGS + 1] = {"metis", "cyclic"};
    return names;
}
