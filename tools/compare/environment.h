#ifndef DUITE_TOOLS_COMPARE_ENVIRONMENT_H
#define DUITE_TOOLS_COMPARE_ENVIRONMENT_H

#include <stdlib.h>

/* Removes what a user chose for programs in general: what is measured says what it runs with. */
static inline void environment_forget(void)
{
    static const char *const names[] = {"DUITE_SCHEDULER", "DUITE_MAPPING", "DUITE_BALANCE",
                                        "DUITE_THREADS",   "DUITE_SEED",    "DUITE_TRACE",
                                        "DUITE_REPORT",    "DUITE_CHECK",   "DUITE_MEMO"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unsetenv(names[i]);
}

#endif
