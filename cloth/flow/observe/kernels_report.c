/* Kernels that look at a run and change nothing of it. Frames are written by rank 0, one after the
 * other: each frame's task holds the token. */
#include "cloth/flow/bodies.h"

static int frame(const duite_call *call)
{
    struct flow *flow = flow_of(call);
    const struct flow_args *args = flow_args_of(call);
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        const phys_vec *x = duite_in(call, 1 + b, phys_vec);
        const struct flow_table *t = flow->tables.block + b;
        for (uint32_t i = 0; i < t->n; i++)
            for (int c = 0; c < 3; c++)
                flow->room[3 * (size_t)flow->vertex[t->first + i] + (size_t)c] = x[i][c];
    }
    if (flow->output->frame(flow->output->context, args->frame, args->time, flow->room,
                            &flow->trouble))
        return duite_fail(call, FLOW_NOT_WRITTEN, "%s", flow->trouble.text);
    flow->frames = args->frame + 1;
    return 0;
}
FLOW_TIMED(frame, FLOW_OUTPUT)
const duite_kernel flow_frame = {.name = "frame",
                                 .body = frame_timed,
                                 .access = {DUITE_RW},
                                 .variadic = DUITE_R,
                                 .args_size = sizeof(struct flow_args),
                                 .side_effects = 1};

static int collect(const duite_call *call)
{
    const struct flow_table *t = flow_shape_of(call);
    const phys_vec *y = duite_in(call, 0, phys_vec);
    unsigned char *to = duite_out(call, 1, unsigned char);
    const int code = duite_resize(call, 1, FLOW_VERTEX_BYTES * (size_t)t->n);
    for (uint32_t i = 0; i < t->n && !code; i++)
        for (int c = 0; c < 3; c++, to += 8)
            flow_put_double(to, y[i][c]);
    return code;
}
const duite_kernel flow_collect = {.name = "collect",
                                   .body = collect,
                                   .access = {DUITE_R, DUITE_W},
                                   .args_size = sizeof(struct flow_args)};

static int stretch(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *x = duite_in(call, 1, phys_vec);
    struct phys_springs springs = flow_table_inner(t);
    double most = phys_springs_stretch(&springs, t->stretch, x, x);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        springs = flow_table_cut(t, s);
        const double there = phys_springs_stretch(&springs, t->stretch + t->n_inner + t->cut[s], x,
                                                  duite_in(call, 3 + s, phys_vec));
        most = there > most ? there : most;
    }
    *duite_out(call, 2, double) = most;
    return 0;
}
const duite_kernel flow_stretch = {.name = "stretch",
                                   .body = stretch,
                                   .access = {DUITE_R, DUITE_R, DUITE_CW},
                                   .law = {NULL, NULL, &duite_max},
                                   .variadic = DUITE_R,
                                   .args_size = sizeof(struct flow_args)};

/* Runs when nothing else does. */
static int seconds(const duite_call *call)
{
    const struct flow *flow = flow_of(call);
    double *sum = duite_out(call, 0, double);
    for (unsigned w = 0; w < flow->n_clocks; w++)
        for (int part = 0; part < FLOW_PARTS; part++)
            sum[part] += flow->clock[w].seconds[part];
    return 0;
}
const duite_kernel flow_seconds = {.name = "seconds",
                                   .body = seconds,
                                   .access = {DUITE_CW},
                                   .args_size = sizeof(struct flow_args)};

static int tell(const duite_call *call)
{
    uint64_t *told = duite_out(call, 0, uint64_t);
    told[FLOW_TELL_FRAMES] = flow_of(call)->frames;
    told[FLOW_TELL_HASH] = flow_of(call)->hash;
    return 0;
}
const duite_kernel flow_tell = {
    .name = "tell", .body = tell, .access = {DUITE_W}, .args_size = sizeof(struct flow_args)};
