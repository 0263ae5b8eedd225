#include "tests/cloth/flow/session.h"

#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/state/kernels.h"
#include "tests/support/unit.h"

static int take_row(void *context, uint64_t step, double time, size_t n, const double *values,
                    struct cloth_error *error)
{
    (void)context, (void)step, (void)time, (void)n, (void)values, (void)error;
    return CLOTH_OK;
}
static const struct flow_output output = {.row = take_row};

void session_start(struct session *s)
{
    duite_options options = duite_options_default();
    int rank, ranks;
    record_mpi(&rank, &ranks);
    ck_assert_int_eq(flow_prepare(&s->flow, &s->setup.model, 1, &s->error), 0);
    options.kernels = flow_kernels();
    options.context = s->flow;
    options.threads = 1;
    options.bind = 0;
    ck_assert_int_eq(duite_start(&s->rt, &options), 0);
    s->state = (struct flow_state){
        .flow = s->flow, .rt = s->rt, .output = &output, .report = &s->report, .error = &s->error};
    ck_assert_int_eq(flow_run_begin(&s->state), 0);
}

void session_end(struct session *s)
{
    ck_assert_int_eq(duite_wait(s->rt), 0);
    ck_assert_int_eq(flow_objects_free(&s->state), 0);
    flow_memory_free(&s->state);
    ck_assert_int_eq(duite_stop(&s->rt), 0);
    flow_free(s->flow);
    setup_free(&s->setup);
}
