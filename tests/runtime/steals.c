/* A tree of tasks on the workers of one rank; prints how many of them were stolen, and how many of
 * these between workers that others are nearer to.
 *
 *   steals SCHEDULER THREADS
 */
#include "tests/support/kernel.h"

#include <duite.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { DEPTH = 11 };

KERNEL(GROW, "grow", .access = {DUITE_RWP}, .args_size = sizeof(int))
{
    const int depth = *(const int *)call->args - 1;

    nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL); /* so that all workers get on */
    for (int k = 0; k < 2 && depth >= 0; k++) {
        duite_object child;

        if (duite_new(call->rt, DUITE_BYTE, 1, &child) ||
            DUITE_FORK(call->rt, &GROW, &depth, child))
            return 1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    static const duite_kernel *const KERNELS[] = {&GROW, NULL};
    duite_options options = duite_options_default();
    duite_counters counters;
    duite_object root;
    duite *rt;

    if (argc != 3)
        return 2;
    options.kernels = KERNELS;
    options.scheduler = duite_scheduler_find(argv[1]);
    options.threads = (unsigned)atoi(argv[2]);
    if (!options.scheduler || duite_start(&rt, &options)) {
        fprintf(stderr, "steals: %s\n", duite_message());
        return 1;
    }
    duite_new(rt, DUITE_BYTE, 1, &root);
    DUITE_FORK(rt, &GROW, &(int){DEPTH}, root);
    duite_wait(rt);
    duite_count_all(rt, &counters);
    duite_free(rt, root);
    if (duite_stop(&rt)) {
        fprintf(stderr, "steals: %s\n", duite_message());
        return 1;
    }
    printf("%llu %llu\n", (unsigned long long)counters.stolen,
           (unsigned long long)counters.stolen_far);
    return 0;
}
