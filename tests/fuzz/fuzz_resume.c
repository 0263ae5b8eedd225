/* Checkpoints of a flow whose hash is right and whose state is not: a run makes one checkpoint of a
 * small pile with certified contact and timed joints, once a process. An input is a list of changes
 * of it (struct change), so a corpus stays of use when the layout of checkpoints changes. A changed
 * one is refused by a sentence, or the run goes on from it for a step; it never crashes or hangs.
 */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/scene/scene.h"
#include "tests/fuzz/fuzz.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char SCENE[] =
    "schema: 1\n"
    "cloths:\n"
    "  - {name: low, material: m, mesh: {grid: {width: 0.1, height: 0.1, nx: 4, ny: 4}},\n"
    "     pins: [{vertices: [0, 3]}]}\n"
    "  - {name: high, material: m, mesh: {grid: {width: 0.1, height: 0.1, nx: 3, ny: 3}},\n"
    "     transform: {translate: [0.01, 0.0025, 0.01]}, velocity: [0, -0.4, 0]}\n"
    "joints:\n"
    "  - {from: {cloth: high, vertices: [0]}, to: {cloth: low, vertex: 0}, stiffness: 1, length: "
    "0.01, begin: 0.001}\n"
    "materials: {m: {density: 0.2, stretch: 500, damping: {stiffness: 0.004}}}\n"
    "contact: {mode: certified, self: on, thickness: 0.002, friction: 0.3}\n"
    "obstacles: [{sphere: {centre: [0, -0.031, 0], radius: 0.03}}]\n"
    "time: {h: 0.002, end: 0.02, fps: 100}\n"
    "grain: 5\n";

/* A change of the checkpoint, without padding: 16 bytes of an input. */
struct change {
    uint16_t kind; /* what is done; with FROM_MAIN `at` is within what the main program knew */
    uint16_t n;    /* bytes */
    uint32_t at;   /* counted from the beginning, modulo the size */
    uint64_t value;
};
enum { PUT_BYTE, PUT_U32, PUT_U64, ADD_U32, CUT, COPY, KINDS };
#define FROM_MAIN 0x8000u
enum { CHANGES = 8, TAKEN = 6 /* which checkpoint of the run is kept */ };

struct made {
    struct model model;
    struct flow_checkpoint checkpoint;
    int count;
};

static void fail(const char *what)
{
    fprintf(stderr, "fuzz_resume: %s\n", what);
    _exit(99);
}

/* Memory that MPI and its libraries keep until the process ends is no leak of ours. Weak: only
 * builds with AddressSanitizer have these functions. */
void __lsan_disable(void) __attribute__((weak));
void __lsan_enable(void) __attribute__((weak));

static void start_mpi(void)
{
    int provided;
    if (__lsan_disable)
        __lsan_disable();
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided))
        fail("MPI does not start");
    if (__lsan_enable)
        __lsan_enable();
}

/* ---- Runs ---- */

static void keep(void *context, struct flow_checkpoint state)
{
    struct made *made = context;
    if (made->count++ == TAKEN)
        made->checkpoint = state;
    else
        free(state.bytes);
}

static void drop(void *context, struct flow_checkpoint state)
{
    (void)context;
    free(state.bytes);
}

static int always(void *context)
{
    (void)context;
    return 1;
}

static int run(struct flow *flow, const struct flow_output *output,
               const struct flow_progress *progress, struct cloth_error *error)
{
    struct flow_report report;
    duite_options options = duite_options_default();
    duite *rt = NULL;
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = 1;
    options.bind = 0;
    if (duite_start(&rt, &options))
        fail(duite_message());
    const int code = flow_run(flow, rt, output, progress, &report, error);
    if (duite_stop(&rt) && !code)
        fail(duite_message());
    return code;
}

/* Goes on from a checkpoint up to the end of the step that is begun first. */
static int resume(const struct made *made, struct flow_checkpoint from, struct cloth_error *error)
{
    struct flow_resumed at;
    struct flow *flow = NULL;
    const struct flow_output output = {.save = drop};
    const struct flow_progress progress = {.stop = always};
    if (flow_prepare(&flow, &made->model, 1, error))
        fail(error->text);
    int code = flow_resume(flow, from, &at, error);
    code = code ? code : run(flow, &output, &progress, error);
    flow_free(flow);
    if (code && !*error->text)
        fail("a failure without a sentence");
    return code;
}

/* A checkpoint that was not changed goes on. */
static void make(struct made *made)
{
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    start_mpi();
    const char *path = fuzz_file("scene.yaml", SCENE, sizeof SCENE - 1);
    if (scene_read(&made->model, path, 0, NULL, &error) ||
        flow_prepare(&flow, &made->model, 1, &error))
        fail(error.text);
    const struct flow_output output = {.context = made, .save = keep};
    const struct flow_progress progress = {.context = made, .due = always};
    if (run(flow, &output, &progress, &error))
        fail(error.text);
    flow_free(flow);
    if (!made->checkpoint.bytes)
        fail("the run made no checkpoint");
    if (resume(made, made->checkpoint, &error))
        fail(error.text);
}

/* ---- Changes ---- */

static void add_u32(unsigned char *at, uint64_t value)
{
    uint32_t number;
    memcpy(&number, at, sizeof number);
    number += (uint32_t)value;
    memcpy(at, &number, sizeof number);
}

static void change(struct flow_checkpoint *of, size_t main_bytes, const struct change *by)
{
    const size_t room = by->kind & FROM_MAIN && main_bytes < of->n ? main_bytes : of->n;
    const size_t kind = (by->kind & ~FROM_MAIN) % KINDS;
    size_t at = room ? by->at % room : 0, from;
    if (of->n < 2 * sizeof by->value)
        return;
    if (kind != PUT_BYTE)
        at -= at % (kind == PUT_U64 ? 8 : 4);
    const size_t left = of->n - at;
    if (kind == PUT_BYTE)
        of->bytes[at] = (unsigned char)by->value;
    else if (kind == PUT_U32 && left >= 4)
        memcpy(of->bytes + at, &by->value, 4);
    else if (kind == PUT_U64 && left >= 8)
        memcpy(of->bytes + at, &by->value, 8);
    else if (kind == ADD_U32 && left >= 4)
        add_u32(of->bytes + at, by->value);
    else if (kind == CUT)
        of->n = at;
    else if (kind == COPY) {
        from = by->value % of->n;
        const size_t n = left < of->n - from ? left : of->n - from;
        memmove(of->bytes + at, of->bytes + from, by->n < n ? by->n : n);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct made made;
    struct flow_saved saved;
    struct change by;
    struct cloth_error error = {0};
    if (!made.count)
        make(&made);
    memcpy(&saved, made.checkpoint.bytes, sizeof saved);
    struct flow_checkpoint changed = {malloc(made.checkpoint.n), made.checkpoint.n};
    if (!changed.bytes)
        return 0;
    memcpy(changed.bytes, made.checkpoint.bytes, changed.n);
    for (size_t i = 0; i < CHANGES && size - i * sizeof by >= sizeof by && i * sizeof by < size;
         i++) {
        memcpy(&by, data + i * sizeof by, sizeof by);
        change(&changed, saved.main_bytes, &by);
    }
    /* exactly so many bytes: AddressSanitizer sees their end */
    unsigned char *exact = realloc(changed.bytes, changed.n ? changed.n : 1);
    changed.bytes = exact ? exact : changed.bytes;
    resume(&made, changed, &error);
    free(changed.bytes);
    return 0;
}
