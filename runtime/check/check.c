/* A frame is one call of a body on one thread: its regions, and a place to jump to when it faults.
 * Frames of a thread nest. Regions of finished calls stay in a ring for a while, and the fault
 * handler searches the ring, too. */
#include "runtime/check/check.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/law.h"
#include "runtime/data/sum.h"
#include "runtime/task/body.h"

#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#define VIOLATION(call, ...) duite_fail(call, DUITE_E_CHECK, __VA_ARGS__)

/* ---- Frames ---- */

enum { RETIRED = 4096 }; /* regions whose address space stays taken */
/* The bytes in place of values that a body overwrites, and around all values: others when it runs
 * again. */
static const unsigned char FILL[2] = {0xa5, 0x5a}, REST[2] = {0xc3, 0x3c};
static const size_t NONE = SIZE_MAX;

struct check {
    pthread_mutex_t lock; /* the ring */
    struct check_region retired[RETIRED];
    unsigned next;
    struct sigaction segv, bus; /* before */
};

struct frame {
    struct frame *outer;
    const struct check_task *task;
    const duite_call *call;      /* with the originals */
    struct check_region *region; /* n_params, and the arguments */
    duite_param *param;          /* n_params, of the copies */
    unsigned again;              /* 1: the body ran before */
    size_t odd;                  /* the region with other bytes around it; or NONE */
    sigjmp_buf jump;
    struct check_region hit; /* the region of the fault */
    const char *at;          /* its address */
};

static _Atomic(struct check *) installed;
static _Thread_local struct frame *volatile current;

static size_t frame_param_bytes(const duite_param *param)
{
    return param->count * data_type_size(param->type);
}

/* The bytes that the body may touch: under w and rw an object that changes size may grow. */
static size_t frame_param_room(const duite_param *param, duite_mode mode)
{
    size_t n = mode == DUITE_R || param->max < param->count ? param->count : param->max;
    return n * data_type_size(param->type);
}

static bool mode_writes(duite_mode mode)
{
    return mode == DUITE_W || mode == DUITE_RW || mode == DUITE_CW;
}

/* ---- Faults ---- */

/* The region an address belongs to: of this call, if any, or an earlier one. Called by the handler:
 * the ring is read without its lock, which at worst misses a region that another thread retires
 * right now. */
static const struct check_region *frame_region_at(const struct check *check,
                                                  const struct frame *frame, const void *address)
{
    for (size_t i = 0; frame && i <= frame->call->n_params; i++)
        if (check_region_has(&frame->region[i], address))
            return &frame->region[i];
    for (unsigned i = 0; i < RETIRED; i++)
        if (check_region_has(&check->retired[i], address))
            return &check->retired[i];
    return NULL;
}

#define USES_RELEASED "uses data of object %u.%u after duite_release"

/* The program itself does: nobody can end that but the handler before. */
static void fault_tell(const struct check_region *region)
{
    char text[100];
    if (region->param != CHECK_TURN)
        return;
    snprintf(text, sizeof text, "duite: the program " USES_RELEASED "\n", region->object.slot,
             region->object.generation);
    base_report(text);
}

static void fault_handle(int signal, siginfo_t *info, void *context)
{
    struct check *check = atomic_load(&installed);
    struct frame *frame = current;
    const struct check_region *region = check ? frame_region_at(check, frame, info->si_addr) : NULL;
    if (region && frame) {
        frame->hit = *region;
        frame->at = info->si_addr;
        siglongjmp(frame->jump, 1);
    }
    if (region)
        fault_tell(region);
    const struct sigaction *before = check && signal == SIGBUS ? &check->bus : &check->segv;
    if (check && before->sa_flags & SA_SIGINFO && before->sa_sigaction)
        before->sa_sigaction(signal, info, context);
    else /* the instruction faults again, and the process ends as it would have without us */
        sigaction(signal, check ? before : &(struct sigaction){.sa_handler = SIG_DFL}, NULL);
}

int check_start(struct check **out)
{
    struct check *none = NULL, *check = *out = base_alloc_zero(sizeof *check);
    if (!check)
        return base_no_memory("checking mode");
    pthread_mutex_init(&check->lock, NULL);
    if (!atomic_compare_exchange_strong(&installed, &none, check)) {
        base_free(check);
        *out = NULL;
        return base_error(DUITE_E_STATE, "two runtimes at a time in checking mode");
    }
    struct sigaction action = {.sa_sigaction = fault_handle, .sa_flags = SA_SIGINFO | SA_NODEFER};
    sigemptyset(&action.sa_mask);
    sigaction(SIGSEGV, &action, &check->segv);
    sigaction(SIGBUS, &action, &check->bus);
    return DUITE_OK;
}

void check_stop(struct check *check)
{
    if (!check)
        return;
    sigaction(SIGSEGV, &check->segv, NULL);
    sigaction(SIGBUS, &check->bus, NULL);
    atomic_store(&installed, NULL);
    for (unsigned i = 0; i < RETIRED; i++)
        check_region_unmap(&check->retired[i]);
    pthread_mutex_destroy(&check->lock);
    base_free(check);
}

static int fault_report(const struct frame *frame)
{
    const struct check_region *hit = &frame->hit;
    const duite_call *call = frame->call;
    bool own = false;
    for (size_t i = 0; i <= call->n_params; i++)
        own = own || check_region_has(&frame->region[i], frame->at);
    if (hit->param == CHECK_TURN)
        return VIOLATION(call, USES_RELEASED, hit->object.slot, hit->object.generation);
    if (!own)
        return VIOLATION(call,
                         "uses what was parameter %zu of task %llu (kernel %s), which is over",
                         hit->param, (unsigned long long)hit->number, hit->kernel);
    long long offset = (long long)(frame->at - hit->data);
    if (hit->param == CHECK_ARGS)
        return VIOLATION(call, "writes to its arguments or beyond (byte %lld of %zu)", offset,
                         hit->bytes);
    if (offset < 0 || offset >= (long long)hit->bytes)
        return VIOLATION(call, "goes beyond parameter %zu: to byte %lld of %zu", hit->param, offset,
                         hit->bytes);
    return VIOLATION(call, "writes to parameter %zu, which it only reads: byte %lld", hit->param,
                     offset);
}

/* ---- Copies ---- */

static unsigned char frame_rest(const struct frame *frame, size_t i)
{
    return REST[i == frame->odd ? 1 - frame->again : frame->again];
}

static bool frame_map_param(struct frame *frame, size_t i)
{
    const duite_param *param = &frame->call->param[i];
    struct check_region *region = &frame->region[i];
    duite_mode mode = data_mode_of(frame->task->kernel, i);
    region->number = frame->task->number;
    region->kernel = frame->task->kernel->name;
    region->param = i;
    if (!param->data)
        return true;
    if (!check_region_map(region, frame_param_room(param, mode), frame_rest(frame, i)))
        return false;
    if (mode == DUITE_W)
        memset(region->data, FILL[frame->again], region->bytes);
    else
        memcpy(region->data, param->data, frame_param_bytes(param));
    return mode != DUITE_R || check_region_protect(region);
}

static bool frame_map_args(struct frame *frame)
{
    const duite_kernel *kernel = frame->task->kernel;
    struct check_region *region = &frame->region[frame->call->n_params];
    region->number = frame->task->number;
    region->kernel = kernel->name;
    region->param = CHECK_ARGS;
    if (!kernel->args_size)
        return true;
    if (!check_region_map(region, kernel->args_size, frame_rest(frame, frame->call->n_params)))
        return false;
    memcpy(region->data, frame->call->args, region->bytes);
    return check_region_protect(region);
}

static void region_retire(struct check *check, struct check_region *region)
{
    if (!region->base)
        return;
    check_region_forbid(region);
    pthread_mutex_lock(&check->lock);
    struct check_region *oldest = &check->retired[check->next++ % RETIRED];
    struct check_region gone = *oldest;
    *oldest = *region;
    pthread_mutex_unlock(&check->lock);
    check_region_unmap(&gone);
    region->base = NULL;
}

/* ---- One run ---- */

/* Runs the body on copies; frame->param gets the results. Returns its code, or that of the fault.
 */
static int frame_run(struct frame *frame)
{
    const duite_call *original = frame->call;
    duite_param *param = frame->param;
    size_t n = original->n_params;
    for (size_t i = 0; i < n; i++)
        if (!frame_map_param(frame, i))
            return duite_fail(original, DUITE_E_MEMORY, "no memory to check parameter %zu", i);
    if (!frame_map_args(frame))
        return duite_fail(original, DUITE_E_MEMORY, "no memory to check the arguments");
    duite_call call = *original;
    for (size_t i = 0; i < n; i++) {
        param[i] = original->param[i];
        param[i].data = frame->region[i].base ? frame->region[i].data : NULL;
    }
    call.param = param;
    call.args = frame->region[n].base ? frame->region[n].data : NULL;
    volatile int code;
    if (sigsetjmp(frame->jump, 1)) {
        code = fault_report(frame);
    } else {
        current = frame;
        code = frame->task->kernel->body(&call);
    }
    current = frame->outer;
    for (size_t i = 0; i < n && !code; i++)
        if (frame->region[i].base && !check_region_whole(&frame->region[i]))
            code = VIOLATION(original, "writes beyond an end of parameter %zu (%zu bytes)", i,
                             frame->region[i].bytes);
    return code;
}

/* ---- More runs ---- */

static bool kernel_is_repeatable(const duite_kernel *kernel, size_t n)
{
    bool plain = !kernel->side_effects;
    for (size_t i = 0; i < n && plain; i++)
        plain = data_mode_of(kernel, i) <= DUITE_CW;
    return plain;
}

/* Compares the values that two runs wrote, byte by byte. */
static int frames_compare(const struct frame *first, const struct frame *second)
{
    const duite_call *call = first->call;
    const duite_kernel *kernel = first->task->kernel;
    for (size_t i = 0; i < call->n_params; i++) {
        duite_mode mode = data_mode_of(kernel, i);
        if (!mode_writes(mode))
            continue;
        if (first->param[i].count != second->param[i].count)
            return VIOLATION(
                call, "is not deterministic: two runs differ in the size of parameter %zu", i);
        const unsigned char *a = first->param[i].data, *b = second->param[i].data;
        for (size_t k = 0; k < frame_param_bytes(&first->param[i]); k++) {
            if (a[k] == b[k])
                continue;
            if (mode == DUITE_W && a[k] == FILL[0] && b[k] == FILL[1])
                return VIOLATION(
                    call, "leaves parameter %zu, which it overwrites, unwritten at byte %zu", i, k);
            return VIOLATION(
                call, "is not deterministic: two runs differ in parameter %zu at byte %zu", i, k);
        }
    }
    return DUITE_OK;
}

/* The same, and the code that the second run returned. */
static int frames_differ(const struct frame *first, const struct frame *second, int again)
{
    if (again > 0)
        return VIOLATION(first->call, "is not deterministic: it returns 0 and then %d", again);
    return again ? again : frames_compare(first, second);
}

/* Finds the region around which other bytes alone change the outcome of the second run, which
 * returned `again`; NONE if even a run with the same bytes differs. A run that fails is no
 * evidence. The run in `third` is made and given up several times. */
static size_t frames_blame(struct check *check, const struct frame *second, int again,
                           struct frame *third)
{
    const size_t n = second->call->n_params;
    third->odd = NONE;
    for (size_t next = 0; next <= n + 1; next++) {
        const int code = frame_run(third);
        const bool same = code < 0 || (code == again && (code || !frames_compare(second, third)));
        for (size_t i = 0; i <= n; i++)
            region_retire(check, &third->region[i]);
        if (!same)
            return third->odd;
        third->odd = next;
    }
    return NONE;
}

static int fault_reads(const struct frame *frame, size_t region)
{
    const duite_call *call = frame->call;
    if (region < call->n_params)
        return VIOLATION(call, "goes beyond parameter %zu: it reads before or behind its %zu bytes",
                         region, frame_param_bytes(&call->param[region]));
    return VIOLATION(call, "goes beyond its arguments: it reads before or behind their %zu bytes",
                     frame->task->kernel->args_size);
}

/* Runs the body a second time, in memory for that and for a third run. */
static int check_again(struct check *check, const struct frame *first, struct check_region *region,
                       duite_param *param)
{
    const size_t n = first->call->n_params + 1;
    struct frame second = *first;
    second.again = 1;
    second.region = region;
    second.param = param;
    const int again = frame_run(&second);
    const int code = frames_differ(first, &second, again);
    if (!code || again < 0)
        return code;
    struct frame third = second;
    third.region = region + n;
    third.param = param + n;
    const size_t beyond = frames_blame(check, &second, again, &third);
    return beyond == NONE ? frames_differ(first, &second, again) : fault_reads(first, beyond);
}

static void frame_copy_back(const struct frame *frame)
{
    duite_param *param = (duite_param *)frame->call->param; /* the runtime's own */
    for (size_t i = 0; i < frame->call->n_params; i++) {
        if (!mode_writes(data_mode_of(frame->task->kernel, i)))
            continue;
        param[i].count = frame->param[i].count;
        memcpy(param[i].data, frame->param[i].data, frame_param_bytes(&param[i]));
    }
}

int check_call(struct check *check, const struct check_task *task, duite_call *call)
{
    enum { RUNS = 3 };
    const size_t n = call->n_params + 1;
    if (task->kernel->events) /* others may still write when the body is over */
        return task->kernel->body(call);
    struct check_region *region = base_alloc_zero(RUNS * n * sizeof *region);
    duite_param *param = base_alloc(RUNS * n * sizeof *param);
    if (!region || !param) {
        base_free(region);
        base_free(param);
        return duite_fail(call, DUITE_E_MEMORY, "no memory to check it");
    }
    struct frame first = {.outer = current,
                          .task = task,
                          .call = call,
                          .region = region,
                          .param = param,
                          .odd = NONE};
    int code = frame_run(&first);
    if (!code && kernel_is_repeatable(task->kernel, call->n_params) && !task_body_forked(call))
        code = check_again(check, &first, region + n, param + n);
    if (!code)
        frame_copy_back(&first);
    for (size_t i = 0; i < RUNS * n; i++)
        region_retire(check, &region[i]);
    base_free(param);
    base_free(region);
    return code;
}

/* ---- Turns of the main program ---- */

void *check_lend(struct check_region *region, duite_object object, const void *values, size_t bytes)
{
    *region = (struct check_region){.param = CHECK_TURN, .object = object};
    if (check_region_map(region, bytes, REST[0]))
        return memcpy(region->data, values, bytes);
    check_region_unmap(region);
    return NULL;
}

void check_take_back(struct check *check, struct check_region *region, void *values)
{
    if (values)
        memcpy(values, region->data, region->bytes);
    region_retire(check, region);
}
