/* Stands in for a rival in the test of duite-bench. Its behaviour is in its environment, LIAR:
 * "count" answers 1, 2, 3, ... milliseconds, "slow" 1000 seconds, "log" appends its name to the
 * file LIAR_LOG, "wrong" fails its check, "die" ends in the middle, anything else before it says
 * hello. */
#include "bench/serve.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int write_log(void)
{
    const char *path = getenv("LIAR_LOG");
    FILE *file = path ? fopen(path, "a") : NULL;
    if (!file)
        return serve_fail("no log");
    fprintf(file, "%s\n", program_invocation_short_name);
    return fclose(file) ? serve_fail("no log") : 0;
}

static int answer(void *context, struct serve_request *request, double *value)
{
    static int times;
    const char *role = context;
    if (!strcmp(role, "wrong"))
        return serve_fail("wrong answer");
    if (!strcmp(role, "die"))
        exit(0);
    if (!strcmp(role, "log") && write_log())
        return 1;
    *value = strcmp(role, "slow") ? 1e-3 * ++times : 1000;
    return serve_number(request, "threads") == 0;
}

int main(void)
{
    static const struct serve_run runs[] = {{"cg", answer},
                                            {"stencil", answer},
                                            {"chain", answer},
                                            {"independent", answer},
                                            {"line", answer},
                                            {"triad", answer},
                                            {0}};
    const struct serve_run *const all[] = {runs, NULL};
    char *role = getenv("LIAR");
    if (!role || !*role)
        return 3;
    int status = serve("a liar, \"quoted\"", all, role);
    return strcmp(role, "end") ? status : 5;
}
