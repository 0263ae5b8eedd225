/* Instructions a task by valgrind: those of a run of so many tasks, taken from one of twice as many
 * (of fib: from one with a larger n). One thread; a figure of the code alone, which no machine's
 * mood changes. */
#include "bench/tasks/tasks.h"

#include "bench/instructions.h"
#include "bench/program.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const COUNTED[] = {"stencil", "chain", "independent", "fib", "replay"};

static void plan(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape shape = {"duite_valgrind", 0, 1};
    measure->cold = true;
    for (size_t i = 0; i < sizeof COUNTED / sizeof *COUNTED; i++) {
        const bool fib = !strcmp(COUNTED[i], "fib");
        const unsigned size = options->quick ? 640 : 12800, n = options->quick ? 8 : 16;
        const struct measure_series *count =
            measure_series(measure, shape, "instructions what=%s few=%u many=%u", COUNTED[i],
                           fib ? n - 2 : size, fib ? n : 2 * size);
        measure_value(measure, count, 1, "instructions", "instructions_per_task_%s", COUNTED[i]);
    }
}

static int count(const char *what, uint64_t tasks, double *number)
{
    char command[2 * PATH_MAX], folder[PATH_MAX];
    program_folder(folder, sizeof folder);
    snprintf(command, sizeof command, "'%s/tasks/counted' %s %llu", folder, what,
             (unsigned long long)tasks);
    return instructions_count(command, number);
}

/* what=CASE of bench/tasks/counted.c; few=, many=: its sizes. */
static int instructions(void *context, struct serve_request *request, double *value)
{
    const uint64_t few = serve_number(request, "few"), many = serve_number(request, "many");
    char what[20];
    double less, more;
    (void)context;
    serve_word(request, "what", what, sizeof what);
    setenv("DUITE_MEMO", "0", 1); /* of each fork and its task, not of rounds of them */
    int code = count(what, few, &less);
    if (!code)
        code = count(what, many, &more);
    if (code)
        return code;
    const bool fib = !strcmp(what, "fib");
    const uint64_t tasks =
        fib ? problem_fib_calls((unsigned)many) - problem_fib_calls((unsigned)few) : many - few;
    *value = (more - less) / (double)tasks;
    return 0;
}

static const struct serve_run RUNS[] = {{"instructions", instructions}, {0}};

const struct bench_case tasks_instructions = {
    "instructions", "instructions a task, by valgrind; one thread, the shared library", plan, RUNS,
    1};
