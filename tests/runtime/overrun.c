/* A body that writes one number beyond its object, whose bytes fill their place in memory: what
 * lies behind is duite's own. Tasks take as much memory as the bytes of an object here. So the
 * first task lies behind the last object, and runs for it: it forgets what it has to publish. The
 * program then stands still for ever. */
#include <duite.h>

#include <stdio.h>

enum { NUMBERS = 8, OBJECTS = 7, ROUNDS = 20, ARGS = 48 /* bytes */ };

static int step(const duite_call *call)
{
    double *volatile out = duite_out(call, 0, double);
    for (int i = 0; i <= NUMBERS; i++)
        out[i] = 0;
    return 0;
}

int main(void)
{
    static const duite_kernel STEP = {
        .name = "step", .body = step, .access = {DUITE_RW}, .args_size = ARGS};
    static const char args[ARGS];
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
        for (int i = OBJECTS; i-- > 0;)
            duite_fork(rt, &STEP, args, 1, &object[i]);
    const int code = duite_wait(rt);
    if (code)
        fprintf(stderr, "%s\n", duite_message());
    for (int i = 0; i < OBJECTS; i++)
        duite_free(rt, object[i]);
    duite_stop(&rt);
    return code ? 1 : 0;
}
