/* Traffic that is known beforehand: rank 0 overwrites an object some times, and rank 1 reads it
 * each time. Prints what the runtime counted. */
#include <duite.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Takes its time, so that no two messages share a packet of the network. */
static int make(const duite_call *call)
{
    const double until = seconds() + 200e-6;
    memset(duite_out(call, 0, char), 1, duite_count(call, 0));
    while (seconds() < until)
        ;
    return 0;
}

static int use(const duite_call *call)
{
    return duite_in(call, 0, char)[duite_count(call, 0) - 1] != 1;
}

static const duite_kernel MAKE = {.name = "make", .body = make, .access = {DUITE_W}};
static const duite_kernel USE = {.name = "use", .body = use, .access = {DUITE_R}};

/* ranks_traffic MESSAGES BYTES */
int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite_counters counters = {0};
    duite_object object;
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&MAKE, &USE, NULL};
    options.threads = 1;
    if (argc != 3 || duite_start(&rt, &options))
        return fprintf(stderr, "%s\n", duite_message()), 2;
    duite_new(rt, DUITE_BYTE, (size_t)atol(argv[2]), &object);
    for (long i = 0; i < atol(argv[1]); i++) {
        duite_fork_at(rt, 0, &MAKE, NULL, 1, &object);
        duite_fork_at(rt, 1, &USE, NULL, 1, &object);
    }
    duite_free(rt, object);
    int code = duite_wait(rt);
    if (!code)
        code = duite_count_all(rt, &counters);
    if (!code && duite_rank(rt) == 0)
        printf("%llu %llu\n", (unsigned long long)counters.messages,
               (unsigned long long)counters.bytes);
    if (code)
        fprintf(stderr, "%s\n", duite_message());
    return duite_stop(&rt) || code;
}
