#ifndef TESTS_SUPPORT_POLICIES_H
#define TESTS_SUPPORT_POLICIES_H

#include <stddef.h>

/* Built-in policies as the tests draw them: those for programs, by `names`, then the adversaries
 * for tests. Both lists are ended by NULL. */
static inline size_t policies_count(const char *const *names, const char *const *adversaries)
{
    size_t n = 0;
    while (*names++)
        n++;
    while (*adversaries++)
        n++;
    return n;
}

/* The one at place i, which is below the count. */
static inline const char *policies_at(const char *const *names, const char *const *adversaries,
                                      size_t i)
{
    for (; *names; names++)
        if (!i--)
            return *names;
    return adversaries[i];
}

#endif
