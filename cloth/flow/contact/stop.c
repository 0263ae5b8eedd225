/* A step in which a stop is asked for is given up before another solve or cut. It leaves no trace:
 * a run that goes on from there makes it with the same bits. So all is kept that its solves change
 * beside x and v: dv, with which the next solve may begin, and the last step of BDF2. */
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/run/step.h"

/* True if a field is kept: copies exist where a step may need them. */
static bool stop_keeps(const struct flow_state *state, enum flow_field_id field)
{
    return flow_fields[field].exists(state, 0);
}

int flow_contact_stop_keep(struct flow_state *state)
{
    int code = DUITE_OK;
    state->contact.stopped = false;
    state->contact.guessed = state->guessed;
    state->contact.smooth = state->smooth;
    if (stop_keeps(state, FLOW_FIELD_kept_dv))
        code = flow_keep_as(state, FLOW_AS(FLOW_FOR(x, dv), FLOW_FOR(kept_x, kept_dv)));
    if (!code && stop_keeps(state, FLOW_FIELD_kept_last_x))
        code = flow_keep_as(state,
                            FLOW_AS(FLOW_FOR(x, last_x), FLOW_FOR(v, last_v),
                                    FLOW_FOR(kept_x, kept_last_x), FLOW_FOR(kept_v, kept_last_v)));
    return code;
}

int flow_contact_stop_restore(struct flow_state *state)
{
    int code = flow_restore(state);
    state->guessed = state->contact.guessed;
    state->smooth = state->contact.smooth;
    if (!code && stop_keeps(state, FLOW_FIELD_kept_dv))
        code = flow_keep_as(state, FLOW_AS(FLOW_FOR(x, kept_dv), FLOW_FOR(kept_x, dv)));
    if (!code && stop_keeps(state, FLOW_FIELD_kept_last_x))
        code = flow_keep_as(state, FLOW_AS(FLOW_FOR(x, kept_last_x), FLOW_FOR(v, kept_last_v),
                                           FLOW_FOR(kept_x, last_x), FLOW_FOR(kept_v, last_v)));
    return code;
}
