/* The sphere's sheet at some time of its run, kept with its runtime while the same is asked for:
 * what a look at a step takes, and the solve of the next step with contacts and without. A bench
 * looks into the cloth's own folders, as a test does. */
#include "bench/contact/contact.h"

#include "bench/cg/cg.h"
#include "bench/tasks/tasks.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/solve/cg.h"

#include <stdio.h>
#include <string.h>

static struct {
    struct model model;
    struct flow *flow;
    duite *rt;
    struct flow_state run;
    struct flow_report report;
    struct cloth_error error;
    char settings[80]; /* that it is ready for; empty: for none */
    bool begun;
    uint64_t contacts;    /* that a look finds */
    double iterations[2]; /* without contacts, and with them; 0: not known */
} session;

static int end(int code)
{
    code = cg_stop(&session.run, session.begun, &session.rt, &session.flow, code);
    model_free(&session.model);
    memset(&session, 0, sizeof session);
    return code;
}

int contact_state_end(void)
{
    return end(0);
}

/* All steps, as flow_run makes them; what is under way is the step that would follow. */
static int move(struct flow_state *run)
{
    int code = flow_ties_choose(run);
    if (!code)
        code = flow_cg_record(run);
    if (!code)
        code = flow_initialise(run);
    if (!code)
        code = flow_contact_start(run);
    if (!code)
        code = flow_steps(run);
    run->attempt = (struct flow_attempt){.begin = run->grid.now, .length = FLOW_TICKS};
    return code ? code : duite_wait(run->rt);
}

static int read_sphere(struct model *model, struct serve_request *request)
{
    return contact_scene_read(model, "sphere", "", serve_number(request, "quick") != 0);
}

static int make(struct serve_request *request, contact_state_reader *read)
{
    const double seconds = 1e-3 * (double)serve_number(request, "ms");
    struct flow_state *run = &session.run;
    int code = read(&session.model, request);
    if (code)
        return code;
    session.model.end = seconds;
    code = cg_make_flow(&session.model, &session.flow);
    if (!code)
        code = cg_start_runtime(request, session.flow, &session.rt);
    if (code)
        return code;
    *run = (struct flow_state){
        .flow = session.flow, .rt = session.rt, .report = &session.report, .error = &session.error};
    session.begun = true;
    code = flow_run_begin(run);
    code = code ? code : move(run);
    return code && *session.error.text ? serve_fail("%s", session.error.text) : tasks_code(code);
}

static int ready(struct serve_request *request, contact_state_reader *read)
{
    char settings[sizeof session.settings], scheduler[40], of[20];
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    serve_word(request, "of", of, sizeof of);
    snprintf(settings, sizeof settings, "%u %u %s %s", (unsigned)serve_number(request, "ms"),
             (unsigned)serve_number(request, "threads"), scheduler, of);
    if (!strcmp(settings, session.settings))
        return 0;
    int code = end(0);
    if (!code)
        code = make(request, read);
    if (!code)
        snprintf(session.settings, sizeof session.settings, "%s", settings);
    return code;
}

/* Seconds of a look at the last step, the best of times=: its boxes, certificates, what is near;
 * and of the rows that the next one has of its contacts. */
int contact_state_look(struct serve_request *request, contact_state_reader *read, bool rows,
                       double *value, uint64_t *n)
{
    const uint64_t times = serve_number(request, "times");
    int code = ready(request, read);
    for (uint64_t i = 0; i < times && !code; i++) {
        struct flow_seen seen = {0};
        const double begin = serve_seconds();
        code = flow_contact_look(&session.run, false, false, &seen);
        if (!code && rows)
            code = flow_contact_tie(&session.run);
        code = tasks_code(code ? code : duite_wait(session.rt));
        const double seconds = serve_seconds() - begin;
        *value = i && *value < seconds ? *value : seconds;
        if (!code && session.contacts && seen.contacts != session.contacts)
            code = serve_fail("wrong answer: %ju contacts, not %ju as before",
                              (uintmax_t)seen.contacts, (uintmax_t)session.contacts);
        session.contacts = seen.contacts;
    }
    *n = session.contacts;
    return code;
}

static int look(void *context, struct serve_request *request, double *value)
{
    uint64_t n = 0;
    (void)context;
    const int code = contact_state_look(request, read_sphere, true, value, &n);
    return !code && !n ? serve_fail("wrong answer: there are no contacts") : code;
}

/* Solves the system of the next step from zero, to the scene's stop. */
static int solve(double *iterations)
{
    struct solve_scalars scalars;
    struct flow_state *run = &session.run;
    int code = flow_contact_tie(run);
    if (!code)
        code = flow_assemble(run);
    if (!code)
        code = flow_cg(run);
    if (!code)
        code = duite_get(session.rt, run->run.scalars[0], &scalars);
    if (!code && scalars.outcome != SOLVE_OK)
        return serve_fail("wrong answer: the solve fails");
    *iterations = solve_scalars_iterations(&scalars);
    return tasks_code(code);
}

/* Iterations of that solve: contacts=1; contacts=0: without the contacts' rows and forces. Both are
 * found at once, that without contacts last, for it drops them. */
static int iterations(void *context, struct serve_request *request, double *value)
{
    const bool with = serve_number(request, "contacts") != 0;
    int code = ready(request, read_sphere);
    (void)context;
    if (!code && !(session.iterations[0] > 0)) {
        code = solve(session.iterations + 1);
        if (!code)
            code = tasks_code(flow_contact_none(&session.run));
        if (!code)
            code = solve(session.iterations);
    }
    *value = session.iterations[with];
    return code;
}

const struct serve_run contact_state_runs[] = {{"look", look}, {"iterations", iterations}, {0}};
