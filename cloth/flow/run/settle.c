/* The steps of a run: each begins while the one before it is settled, that is, accepted or refused
 * by the notes of all blocks in its status. Decisions use only values that are equal on all
 * ranks. */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/state.h"

#include <math.h>
#include <stdio.h>

/* A step of at most this length that gains energy is not halved. */
enum { LEAST_GUARDED = FLOW_TICKS / 16 };
/* Steps do not grow back for this many ticks after one was halved for energy. Longer steps strain
 * the edges more, and the first long one would regain the energy that the short ones released. */
enum { CALM_AFTER_GAIN = 8 * FLOW_TICKS };

/* Shows a finished step to the program; on rank 0. */
static void report_progress(struct flow_state *state, uint64_t iterations)
{
    const struct flow_progress *progress = state->flow->progress;
    if (!progress || !progress->step || duite_rank(state->rt))
        return;
    const uint64_t step = (state->grid.now + FLOW_TICKS - 1) / FLOW_TICKS;
    progress->step(progress->context, step, state->flow->n_steps, iterations);
}

/* Adds an accepted step to the report. */
static void note_step(struct flow_state *state, const double status[FLOW_STATUS])
{
    struct flow_report *report = state->report;
    const double *lost = status + FLOW_LOST;
    const double momentum = sqrt(lost[0] * lost[0] + lost[1] * lost[1] + lost[2] * lost[2]);
    const uint64_t iterations = (uint64_t)status[FLOW_ITERATIONS];
    report->steps++;
    report->cg_iterations_total += iterations;
    if (iterations > report->cg_iterations_max)
        report->cg_iterations_max = iterations;
    if (momentum > report->momentum_lost)
        report->momentum_lost = momentum;
    const double error = sqrt(fmin(status[FLOW_ERROR], status[FLOW_RESIDUAL]) / status[FLOW_SIZE]);
    if (status[FLOW_SIZE] > 0 && error > report->mass_norm_error)
        report->mass_norm_error = error;
    report->correction_rounds += (uint64_t)status[FLOW_CORRECTED];
    report->corrections_unmet += status[FLOW_CORRECTION_UNMET] > 0;
    if (status[FLOW_CORRECTION_EXCESS] > report->correction_excess)
        report->correction_excess = status[FLOW_CORRECTION_EXCESS];
    if (state->flow->model->energy_steps)
        report->energy_corrected += status[FLOW_CORRECTION_ENERGY];
    report->cg_restarts += (uint64_t)status[FLOW_RESTARTS];
    report->factors_shifted += (uint64_t)status[FLOW_SHIFTED];
    state->stopping = state->stopping || status[FLOW_STOP] > 0;
    report_progress(state, iterations);
}

/* Ends the run: no step is short enough. */
static int give_up_step(struct flow_state *state, const struct flow_verdict *verdict)
{
    const struct flow_step_args args = flow_attempt_args(state);
    if (state->contact.failed && flow_attempt_is_last(state))
        return FLOW_PINCHED; /* contact said why */
    const bool above = verdict->max > 0 && verdict->after > verdict->max;
    snprintf(state->reason, sizeof state->reason,
             "step %llu: in %g s the largest stretch of an edge grows from %g to %g times its "
             "length at rest, %s %g is allowed at most (%s)",
             (unsigned long long)(state->attempt.begin / FLOW_TICKS + 1), args.h, verdict->before,
             verdict->after, above ? "up to" : "by", above ? verdict->max : verdict->growth,
             above ? "time.stretch_limit" : "time.stretch_growth");
    return FLOW_STRETCHED;
}

/* The next step has half the length. Returns false if that is less than a tick. */
static bool halve_step(struct flow_state *state, enum flow_cause cause)
{
    const bool halved = flow_grid_halve(&state->grid, cause == FLOW_CAUSE_CONTACT);
    state->report->halved_by[cause] += halved;
    return halved;
}

/* Why a verdict refuses a step. */
static enum flow_cause cause_of(const struct flow_state *state, const double status[FLOW_STATUS],
                                const struct flow_verdict *verdict)
{
    if (status[FLOW_FAILED] > 0)
        return FLOW_CAUSE_SOLVE;
    if (state->contact.failed)
        return FLOW_CAUSE_CONTACT;
    return verdict->failed || !isfinite(verdict->after) ? FLOW_CAUSE_BOUNDS : FLOW_CAUSE_STRETCH;
}

/* Takes the step back: it is to be made again with half the length. */
static int refuse_step(struct flow_state *state, const double status[FLOW_STATUS],
                       const struct flow_verdict *verdict)
{
    if (!state->flow->model->halving || !halve_step(state, cause_of(state, status, verdict)))
        return give_up_step(state, verdict);
    return flow_restore(state);
}

/* True if a step that gained too much energy can be made again with less. A BDF2 step is made again
 * by implicit Euler, which needs only the restored state. Others are made again with half the
 * length. */
static bool can_lose(const struct flow_state *state)
{
    return flow_implicit_is_second(state) ||
           (state->flow->model->halving && state->attempt.length > LEAST_GUARDED);
}

static int retake_step(struct flow_state *state, bool second)
{
    if (second) {
        state->report->steps_retaken++;
    } else {
        halve_step(state, FLOW_CAUSE_ENERGY);
        state->guard.calm = state->attempt.begin + CALM_AFTER_GAIN;
    }
    return flow_restore(state);
}

/* Waits for the status and verdict of the step that was forked whole. */
static int await_step(struct flow_state *state, double status[FLOW_STATUS],
                      struct flow_verdict *verdict)
{
    const struct model *model = state->flow->model;
    *verdict = (struct flow_verdict){.before = state->longest,
                                     .after = state->longest,
                                     .max = model->stretch_limit,
                                     .growth = model->stretch_growth};
    if (flow_get(state, FLOW_FIELD_status, status))
        return state->code;
    state->saving = state->saving || status[FLOW_DUE] > 0;
    if (flow_is_judged(model))
        flow_stretch_get(state, &verdict->after);
    if (flow_energy_wait(state))
        return state->code;
    flow_implicit_status(state, status);
    flow_contact_status(state, status);
    verdict->failed = status[FLOW_FAILED] + status[FLOW_BEYOND] > 0 || state->contact.failed;
    return state->code;
}

/* True if contact moved a vertex beyond the solve, or a tie came or went: then a step may gain
 * energy. */
static bool is_disturbed(const struct flow_state *state, const double status[FLOW_STATUS])
{
    return status[FLOW_TOUCHED] > 0 || flow_ties_changed(state);
}

/* Accepts a step and forks its frames. */
static int accept_step(struct flow_state *state, const double status[FLOW_STATUS],
                       const struct flow_verdict *verdict)
{
    const struct flow_attempt attempt = state->attempt;
    state->length_before = state->length;
    state->length = attempt.length;
    state->longest = verdict->after;
    if (state->longest > state->report->stretch_highest)
        state->report->stretch_highest = state->longest;
    flow_grid_accept(&state->grid, flow_verdict_calm(verdict) &&
                                       attempt.begin + attempt.length >= state->guard.calm);
    note_step(state, status);
    flow_energy_note(state, is_disturbed(state, status));
    flow_watched(state);
    return flow_frames(state, attempt.begin);
}

/* A stop gives the step up: the last one accepted is the last of the run. */
static int stop_step(struct flow_state *state, const double status[FLOW_STATUS])
{
    state->attempt.forked = false;
    state->stopping = true;
    flow_noted(state, flow_contact_settled(state, status, false));
    return flow_noted(state, flow_contact_stop_restore(state));
}

/* Waits for the step that was forked whole and accepts or refuses it. */
static int settle_step(struct flow_state *state)
{
    struct flow_verdict verdict;
    double status[FLOW_STATUS];
    if (await_step(state, status, &verdict))
        return state->code;
    if (state->contact.stopped)
        return stop_step(state, status);
    const bool refused = flow_verdict_refuses(&verdict), second = flow_implicit_is_second(state);
    const bool gained =
        !refused && flow_energy_gained(state, is_disturbed(state, status)) && can_lose(state);
    flow_implicit_settle(state, !refused && !gained, status);
    state->attempt.forked = false;
    if (flow_noted(state, flow_contact_settled(state, status, !refused && !gained)))
        return state->code;
    if (!refused && !gained)
        return accept_step(state, status, &verdict);
    state->stopping = state->stopping || status[FLOW_STOP] > 0;
    state->settled_forces = false;
    state->guessed = 0; /* dv is of a step that is not made */
    return refused ? refuse_step(state, status, &verdict) : retake_step(state, second);
}

/* The step that follows the one under way, if that is accepted. */
static struct flow_attempt next_attempt(const struct flow_state *state)
{
    const struct flow_attempt *attempt = &state->attempt;
    return (struct flow_attempt){.begin = state->grid.now + (attempt->forked ? attempt->length : 0),
                                 .length = state->grid.length};
}

/* Settles the step under way while `next` begins. A step waits for the one before if that is
 * shorter, as its own length is not known then, or if its ties or shapes at rest differ, as the
 * report needs those of the step before. *begun: next has begun and follows an accepted step. */
static int settle_overlapped(struct flow_state *state, bool *begun)
{
    const struct flow_attempt before = state->attempt;
    const struct flow_attempt next = next_attempt(state);
    *begun = !before.forked ||
             (before.length == FLOW_TICKS && !state->stopping && !state->saving &&
              !state->resting && !state->sewn && !flow_step_is_driven(state->flow->model) &&
              !state->flow->model->sizes && flow_ties_stay(state, next.begin));
    *begun = *begun && next.begin < state->grid.end;
    if (*begun) {
        state->attempt = next;
        flow_step_begin(state);
    }
    if (!state->code && before.forked) {
        state->attempt = before;
        flow_noted(state, settle_step(state));
        *begun = *begun && state->grid.now == next.begin;
    }
    if (*begun)
        state->attempt = next;
    return state->code;
}

static int first_stretch(struct flow_state *state)
{
    state->report->stretch_highest = NAN;
    if (!flow_is_judged(state->flow->model))
        return DUITE_OK;
    flow_stretch_fork(state);
    flow_stretch_get(state, &state->longest);
    state->report->stretch_highest = state->longest;
    return state->code;
}

/* Ends the run early, on request. */
static int stop_early(struct flow_state *state)
{
    flow_save(state, false);
    state->report->stopped = true;
    return flow_frame_last(state);
}

static int begin_steps(struct flow_state *state)
{
    flow_grid_begin(&state->grid, state->flow->n_steps);
    state->next_frame = flow_before(state).frames;
    flow_watch(state);
    flow_watched(state);
    flow_energy_begin(state);
    flow_frames(state, 0);
    return first_stretch(state);
}

/* The work between two steps. frame: the next one before the last step. */
static int pause_between(struct flow_state *state, uint64_t frame)
{
    state->over = (state->resting || state->sewn) && state->next_frame > frame;
    if (state->over || !state->saving)
        return DUITE_OK;
    state->saving = false;
    return flow_save(state, false);
}

int flow_steps(struct flow_state *state)
{
    if (!state->head.resumed_bytes)
        begin_steps(state);
    while (!state->code && !state->over && state->grid.now < state->grid.end) {
        const uint64_t frame = state->next_frame;
        bool begun;
        if (settle_overlapped(state, &begun))
            break;
        if (begun)
            flow_step_end(state);
        else if (state->grid.now < state->grid.end) {
            if (state->stopping)
                return stop_early(state);
            pause_between(state, frame);
        }
    }
    if (!state->code && state->flow->model->sewn > 0 && !state->sewn)
        flow_noted(state, flow_seams_fail(state));
    return state->code;
}
