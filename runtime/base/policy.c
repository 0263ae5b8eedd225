/* A library's policy is found by its symbol, so that a file cannot be taken for one of another
 * kind. What was loaded is never unloaded: a policy may be in use as long as the process lives. */
#include "runtime/base/policy.h"

#include "runtime/base/error.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

static const void *load(const struct base_policies *policies, const char *file)
{
    void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    const void *policy = library ? dlsym(library, policies->symbol) : NULL;
    if (!library)
        base_error(DUITE_E_ARGUMENT, "the %s cannot be loaded: %s", policies->kind, dlerror());
    else if (!policy)
        base_error(DUITE_E_ARGUMENT, "the library defines no %s (duite_policy.h)",
                   policies->symbol);
    return policy;
}

static void unknown(const struct base_policies *policies)
{
    char known[256] = "";
    size_t length = 0;
    for (size_t i = 0; policies->names[i] && length < sizeof known; i++)
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s", i ? ", " : "",
                                   policies->names[i]);
    base_error(DUITE_E_ARGUMENT,
               "there is no %s of this name; known are %s, and shared libraries by a name with a / "
               "in it",
               policies->kind, known);
}

const void *base_policy_find(const struct base_policies *policies, const char *name)
{
    for (size_t i = 0; name && policies->names[i]; i++)
        if (!strcmp(policies->names[i], name))
            return policies->tables[i];
    if (name && strchr(name, '/'))
        return load(policies, name);
    unknown(policies);
    return NULL;
}

bool base_policy_is_ours(const struct base_policies *policies, const void *table)
{
    for (size_t i = 0; policies->names[i]; i++)
        if (policies->tables[i] == table)
            return true;
    return false;
}
