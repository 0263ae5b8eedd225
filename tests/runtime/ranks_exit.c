/* Ends in the middle of its work, without a stop, with the status given: rank 0 at once, or all
 * ranks with --all. Messages are on their way meanwhile, and workers poll. */
#include <duite.h>

#include <stdlib.h>
#include <string.h>

enum { TASKS = 20000, CHAINS = 4 };

static int step(const duite_call *call)
{
    duite_out(call, 0, int64_t)[0]++;
    return 0;
}

static const duite_kernel STEP = {.name = "step", .body = step, .access = {DUITE_RW}};
static const duite_kernel *const KERNELS[] = {&STEP, NULL};

int main(int argc, char **argv)
{
    duite *rt;
    duite_object chain[CHAINS];
    duite_options options = duite_options_default();
    if (argc < 2)
        return 99;
    options.kernels = KERNELS;
    options.threads = 2;
    if (duite_start(&rt, &options))
        return 98;
    for (int i = 0; i < CHAINS; i++)
        duite_new(rt, DUITE_I64, 1, &chain[i]);
    for (int i = 0; i < TASKS; i++)
        duite_fork_at(rt, (i / CHAINS) % duite_ranks(rt), &STEP, NULL, 1, &chain[i % CHAINS]);
    if (duite_rank(rt) == 0 || (argc > 2 && !strcmp(argv[2], "--all")))
        exit(atoi(argv[1]));
    duite_wait(rt);
    return 97;
}
