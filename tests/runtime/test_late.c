/* A program that loads libduite late, as interpreters and plug-ins do: what the library wants of
 * the memory of threads must fit into what such programs have left. */
#include "tests/support/kernel.h"
#include "tests/support/unit.h"

#include <dlfcn.h>
#include <duite.h>
#include <stdbool.h>
#include <string.h>

enum { TASKS = 1000 };

KERNEL(ADD, "add", .access = {DUITE_RW}, .args_size = sizeof(int64_t))
{
    *(int64_t *)call->param[0].data += *(const int64_t *)call->args;
    return 0;
}

/* The functions that it calls. `found` is cleared by what is missing. */
struct late {
    bool found;
    __typeof__(&duite_options_set) options_set;
    __typeof__(&duite_start) start;
    __typeof__(&duite_new) new;
    __typeof__(&duite_fork) fork;
    __typeof__(&duite_get) get;
    __typeof__(&duite_free) free;
    __typeof__(&duite_stop) stop;
};

/* function: the address of a member. ISO C has no conversion to it, POSIX has these bytes. */
static void late_find(struct late *late, void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    late->found &= found != NULL;
    memcpy(function, &found, sizeof found);
}

static struct late late_load(void *library)
{
    struct late late = {.found = true};
    late_find(&late, library, "duite_options_set", &late.options_set);
    late_find(&late, library, "duite_start", &late.start);
    late_find(&late, library, "duite_new", &late.new);
    late_find(&late, library, "duite_fork", &late.fork);
    late_find(&late, library, "duite_get", &late.get);
    late_find(&late, library, "duite_free", &late.free);
    late_find(&late, library, "duite_stop", &late.stop);
    return late;
}

UNIT_TEST(runs)
{
    static const duite_kernel *const kernels[] = {&ADD, NULL};
    void *library = dlopen(".libs/libduite.so", RTLD_NOW | RTLD_LOCAL);
    ck_assert_msg(library != NULL, "%s", library ? "" : dlerror());
    const struct late late = late_load(library);
    ck_assert(late.found);
    duite_options options;
    ck_assert_int_eq(late.options_set(&options, sizeof options), DUITE_OK);
    options.kernels = kernels;
    options.threads = 2;
    duite *rt;
    duite_object sum;
    int64_t got = 0;
    ck_assert_int_eq(late.start(&rt, &options), DUITE_OK);
    late.new(rt, DUITE_I64, 1, &sum);
    for (int64_t i = 0; i < TASKS; i++)
        late.fork(rt, &ADD, &i, 1, &sum);
    ck_assert_int_eq(late.get(rt, sum, &got), DUITE_OK);
    ck_assert_int_eq(got, TASKS * (TASKS - 1) / 2);
    late.free(rt, sum);
    ck_assert_int_eq(late.stop(&rt), DUITE_OK);
}
