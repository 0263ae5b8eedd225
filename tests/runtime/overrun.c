/* A body that writes one number beyond its object, whose bytes fill their place in memory: what
 * lies behind is duite's own. The program then stands still for ever. */
#include <duite.h>

#include <stdio.h>

enum { NUMBERS = 8, OBJECTS = 8, ROUNDS = 20 };

static int step(const duite_call *call)
{
    double *volatile out = duite_out(call, 0, double);
    for (int i = 0; i <= NUMBERS; i++)
        out[i] = 0;
    return 0;
}

int main(void)
{
    static const duite_kernel STEP = {.name = "step", .body = step, .access = {DUITE_RW}};
    static const duite_kernel *const KERNELS[] = {&STEP, NULL};
    duite_options options = duite_options_default();
    duite_object object[OBJECTS];
    duite *rt;
    options.kernels = KERNELS;
    options.threads = 1;
    if (duite_start(&rt, &options))
        return 3;
    for (int i = 0; i < OBJECTS; i++) {
        duite_new(rt, DUITE_F64, NUMBERS, &object[i]);
        duite_set(rt, object[i], NULL);
    }
    for (int r = 0; r < ROUNDS; r++)
        for (int i = 0; i < OBJECTS; i++)
            duite_fork(rt, &STEP, NULL, 1, &object[i]);
    const int code = duite_wait(rt);
    if (code)
        fprintf(stderr, "%s\n", duite_message());
    for (int i = 0; i < OBJECTS; i++)
        duite_free(rt, object[i]);
    duite_stop(&rt);
    return code ? 1 : 0;
}
