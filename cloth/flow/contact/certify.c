/* A step with certified contact. Its solve knows the contacts that the step begins with. Then all
 * pairs of features are certified on their way through the step. Those that fail become contacts,
 * and the step is solved again from where it began. What still fails after a few solves is cut. So
 * no state is ever accepted in which a pair is not certified. Every decision follows from counts
 * that all ranks get alike. */
#include "cloth/flow/contact/certify.h"
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/skins.h"
#include "cloth/flow/step/step.h"

#include <stdio.h>

enum { MAX_SOLVES = 5, MAX_CUTS = 8 };

double flow_contact_stiffness(const struct flow *flow, double h)
{
    const double inertia = 4 * flow->vertex_mass / (h * h);
    return flow->contact_stiffness > inertia ? flow->contact_stiffness : inertia;
}

/* ---- What a step begins with ---- */

int flow_contact_start(struct flow_state *state)
{
    struct flow_seen seen;
    int code = flow_keep(state);
    if (!code)
        code = flow_skins_keep(state);
    if (!code)
        code = flow_bodies_make(state);
    if (!code)
        code = flow_contact_none(state);
    if (!code)
        code = flow_contact_look(state, &seen);
    if (!code && seen.fails) {
        snprintf(state->reason, sizeof state->reason,
                 "%llu pairs of vertices and triangles, or of edges, touch where the run starts; "
                 "move the cloths apart",
                 (unsigned long long)seen.fails);
        return FLOW_TANGLED;
    }
    if (!code)
        code = flow_contact_accept(state);
    state->contact.begin = state->contact.now;
    return code;
}

int flow_contact_begin(struct flow_state *state)
{
    state->contact.now = state->contact.begin;
    state->contact.failed = false;
    state->contact.cut = 0;
    state->contact.iterations = state->contact.restarts = 0;
    const int code = flow_skins_keep(state);
    return code ? code : flow_contact_tie(state);
}

/* ---- The step ---- */

/* Goes back to where the step began and makes it once more, with the contacts as they are now. What
 * its solves took is added up. */
static int again(struct flow_state *state, const double status[FLOW_STATUS])
{
    const double nothing[FLOW_STATUS] = {0};
    state->contact.iterations += status[FLOW_ITERATIONS];
    state->contact.restarts += status[FLOW_RESTARTS];
    state->smooth = 0; /* a step by BDF2 has changed what it goes on from */
    state->report->contact_solves++;
    int code = flow_contact_again(state);
    if (!code)
        code = duite_set(state->rt, flow_field_object(state, FLOW_FIELD_status, 0), nothing);
    if (!code)
        code = flow_contact_tie(state);
    if (!code)
        code = flow_restore(state);
    return code ? code : flow_step_again(state);
}

/* Cuts until nothing fails. */
static int cut(struct flow_state *state, struct flow_seen *seen)
{
    struct flow_report *report = state->report;
    int code = DUITE_OK;
    for (int round = 0; round < MAX_CUTS && seen->fails && !code; round++) {
        struct flow_cut cut;
        code = flow_contact_cut(state, &cut);
        report->contact_cuts += cut.rows;
        state->contact.cut += cut.rows;
        state->contact.failed =
            state->contact.failed || (double)cut.halved > 0.01 * (double)seen->contacts;
        if (!code)
            code = flow_contact_look(state, seen);
    }
    state->contact.failed = state->contact.failed || seen->fails;
    return code;
}

/* Whether the step as it was solved is of any use. */
static bool is_solved(const double status[FLOW_STATUS])
{
    return !(status[FLOW_FAILED] + status[FLOW_BEYOND] > 0);
}

int flow_contact_settle(struct flow_state *state)
{
    const unsigned parity = state->attempt.parity;
    double status[FLOW_STATUS];
    struct flow_seen seen = {0};
    int code = DUITE_OK;
    for (int solve = 1; !code; solve++) {
        code = duite_get(state->rt, state->run.status[parity], status);
        if (code || !is_solved(status))
            return code;
        code = flow_contact_look(state, &seen);
        if (code || !seen.fails || solve == MAX_SOLVES)
            break;
        code = again(state, status);
    }
    if (!code && seen.fails)
        code = cut(state, &seen);
    if (seen.contacts > state->report->contacts)
        state->report->contacts = seen.contacts;
    state->contact.touched = seen.contacts > 0;
    return code || state->contact.failed ? code : flow_contact_accept(state);
}

void flow_contact_status(const struct flow_state *state, double status[FLOW_STATUS])
{
    status[FLOW_ITERATIONS] += state->contact.iterations;
    status[FLOW_RESTARTS] += state->contact.restarts;
    status[FLOW_TOUCHED] += (double)state->contact.cut;
}

void flow_contact_settled(struct flow_state *state, bool accepted)
{
    if (accepted)
        state->contact.begin = state->contact.now;
}
