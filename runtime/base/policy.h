#ifndef DUITE_BASE_POLICY_H
#define DUITE_BASE_POLICY_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes of private state that a policy may want for each worker. */
#define BASE_MOST_STATE ((size_t)1 << 30)

/* The policies of one kind: the built-in ones, in the same order in both lists. */
struct base_policies {
    const char *kind;         /* "scheduler" */
    const char *symbol;       /* what a shared library calls its own */
    const char *const *names; /* ended by NULL */
    const void *const *tables;
};

/* The built-in policy of that name; or, if there is a / in it, that of the shared library in the
 * file, which stays loaded. NULL, and a sentence for duite_message, if there is none. Local. */
const void *base_policy_find(const struct base_policies *policies, const char *name);

/* Whether the table is one of the built-in ones. */
bool base_policy_is_ours(const struct base_policies *policies, const void *table);

#endif
