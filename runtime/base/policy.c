/* A library's policy is found by its symbol, so that a file cannot be taken for one of another
 * kind. What was loaded is never unloaded: a policy may be in use as long as the process lives. */
#include "runtime/base/policy.h"

#include "runtime/base/error.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

static const void *policy_load(const struct base_policies *policies, const char *file)
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

struct policy_names {
    char text[256];
};

static struct policy_names policy_join(const char *const *names)
{
    struct policy_names list = {""};
    size_t length = 0;
    for (size_t i = 0; names[i] && length < sizeof list.text; i++)
        length += (size_t)snprintf(list.text + length, sizeof list.text - length, "%s%s",
                                   i ? ", " : "", names[i]);
    return list;
}

static void policy_refuse(const struct base_policies *policies)
{
    const struct policy_names tests = policy_join(base_policy_test_names(policies));
    base_error(DUITE_E_ARGUMENT,
               "there is no %s of this name; known are %s%s%s, and shared libraries by a name with "
               "a / in it",
               policies->kind, policy_join(policies->names).text,
               tests.text[0] ? ", for tests " : "", tests.text);
}

const char *const *base_policy_test_names(const struct base_policies *policies)
{
    const char *const *names = policies->names;
    while (*names)
        names++;
    return names + 1;
}

/* Built in, by name or by table, whichever is not NULL; else NULL. */
static const void *policy_built_in(const struct base_policies *policies, const char *name,
                                   const void *table)
{
    unsigned parts = 0;
    for (size_t i = 0; parts < 2; i++)
        if (!policies->names[i])
            parts++;
        else if (name ? !strcmp(policies->names[i], name) : policies->tables[i] == table)
            return policies->tables[i];
    return NULL;
}

const void *base_policy_find(const struct base_policies *policies, const char *name)
{
    const void *found = name ? policy_built_in(policies, name, NULL) : NULL;
    if (found)
        return found;
    if (name && strchr(name, '/'))
        return policy_load(policies, name);
    policy_refuse(policies);
    return NULL;
}

bool base_policy_is_ours(const struct base_policies *policies, const void *table)
{
    return policy_built_in(policies, NULL, table) != NULL;
}
