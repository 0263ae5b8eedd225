/* The tests' output: a line of TAP a case, with the number of executions. */
#include "tests/model/search.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static struct {
    bool deep, show;
    char **names; /* of the cases to run alone, ended by NULL */
    int cases, failed;
} report;

void explore_begin(int argc, char **argv)
{
    (void)argc;
#ifdef __SANITIZE_THREAD__
    printf("1..0 # SKIP ThreadSanitizer does not follow coroutines\n");
    exit(77);
#endif
    for (argv++; *argv && argv[0][0] == '-'; argv++) {
        report.deep = report.deep || !strcmp(*argv, "--deep");
        report.show = report.show || !strcmp(*argv, "--show");
    }
    report.names = argv;
}

int explore_end(void)
{
    printf("1..%d\n", report.cases);
    return report.failed ? EXIT_FAILURE : EXIT_SUCCESS;
}

static bool wanted(const char *name)
{
    bool found = !*report.names;
    for (char **each = report.names; *each; each++)
        found = found || !strcmp(*each, name);
    return found;
}

static uint64_t max(const struct explore_case *small)
{
    return report.deep ? small->max_deep : small->max;
}

void explore_line(bool fine, const char *name, const char *text)
{
    report.cases++;
    report.failed += !fine;
    printf("%s %d - %s: %s\n", fine ? "ok" : "not ok", report.cases, name, text);
    fflush(stdout);
}

bool explore_deep(void)
{
    return report.deep;
}

const char *explore_run(const struct explore_case *small)
{
    return search_all(small, (struct explore_plant){0}, 0).wrong;
}

static void show(const struct search_result *result)
{
    if (result->wrong) {
        printf("# %s after these steps:\n", result->wrong);
        search_print();
    }
}

void explore_passes(const struct explore_case *small)
{
    char text[160];
    if (!wanted(small->name))
        return;
    struct timespec began, ended;
    clock_gettime(CLOCK_MONOTONIC, &began);
    struct search_result result = search_all(small, (struct explore_plant){0}, max(small));
    clock_gettime(CLOCK_MONOTONIC, &ended);
    snprintf(text, sizeof text, "%s %llu executions of up to %d steps",
             result.all ? "all" : "first", (unsigned long long)result.executions, result.longest);
    explore_line(!result.wrong, small->name, text);
    printf("#   %llu given up, %.2f s\n", (unsigned long long)result.cut,
           (double)(ended.tv_sec - began.tv_sec) + 1e-9 * (double)(ended.tv_nsec - began.tv_nsec));
    show(&result);
}

void explore_finds(const struct explore_case *small, struct explore_plant plant)
{
    char text[240];
    if (!wanted(small->name))
        return;
    struct search_result result = search_all(small, plant, max(small));
    snprintf(text, sizeof text, "with %s %s in %s: %s (%llu executions)", plant.what,
             plant.change == EXPLORE_DROP ? "left out" : "relaxed", plant.function,
             result.wrong     ? result.wrong
             : result.planted ? "nothing is found"
                              : "there is no such operation",
             (unsigned long long)result.executions);
    explore_line(result.wrong != NULL, small->name, text);
    if (report.show)
        show(&result);
}
