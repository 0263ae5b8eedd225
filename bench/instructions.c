/* One command after the other, under cachegrind, whose last words are the count. */
#include "bench/instructions.h"

#include "bench/serve.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#define COUNT                                                                                      \
    "DUITE_SIMD=none valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null"

int instructions_count(const char *command, double *number)
{
    char line[4 * PATH_MAX];
    const int length = snprintf(line, sizeof line, "%s %s 2>&1", COUNT, command);
    FILE *said = (size_t)length < sizeof line ? popen(line, "r") : NULL;
    if (!said)
        return serve_fail("valgrind does not start");
    *number = 0;
    while (fgets(line, sizeof line, said)) { /* "I refs: 1,234,567" */
        const char *refs = strstr(line, " refs:");
        for (const char *c = refs ? refs : ""; *c; c++)
            if (*c >= '0' && *c <= '9')
                *number = 10 * *number + (*c - '0');
    }
    return pclose(said) || !(*number > 0) ? serve_fail("valgrind counts nothing") : 0;
}
