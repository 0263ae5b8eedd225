#ifndef DUITE_BASE_POLICY_H
#define DUITE_BASE_POLICY_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes of private state that a policy may want for each worker. */
#define BASE_MAX_STATE ((size_t)1 << 30)

/* The policies of one kind. The built-in ones stand twice, in the same order: those for programs,
 * NULL, those for tests, NULL. The latter are adversaries: found by name, but in no list of all. */
struct base_policies {
    const char *kind;   /* "scheduler" */
    const char *symbol; /* what a shared library calls its own */
    const char *const *names;
    const void *const *tables;
};

/* The names of a list of rows, each of which is ROW(name). */
#define BASE_POLICY_NAME(name) #name,

/* The built-in policy of that name; or, if there is a / in it, that of the shared library in the
 * file, which stays loaded. NULL, and a sentence for duite_message, if there is none. Local. */
const void *base_policy_find(const struct base_policies *policies, const char *name);

/* The names of those for tests, ended by NULL. */
const char *const *base_policy_test_names(const struct base_policies *policies);

/* Whether the table is one of the built-in ones, those for tests among them. */
bool base_policy_is_ours(const struct base_policies *policies, const void *table);

#endif
