/* A step with certified contact. Its solve knows the contacts that the step begins with. Then all
 * pairs of features are certified on their way through the step. Those that fail become contacts,
 * and the step is solved again from where it began. Pairs that still fail after a few solves are
 * pushed apart or cut, so every pair of an accepted state is certified. Decisions use only counts
 * that are equal on all ranks. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/room.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Solves of a step, and rounds of pushes and of cuts after them. Cuts shorten ways only, so rounds
 * end; where eight do not, halves of the step need fewer. */
enum { MAX_SOLVES = 5, MAX_PUSHES = 4, MAX_CUTS = 8 };
/* Halve the step if more rows than this share of the contacts, and than this number, lose half of
 * their way: what is left shows then. A ring that cloth is pulled through has few contacts. */
static const double TOO_MANY = 0.01;
enum { NOT_MANY = 4 };
/* Solve no more if failing pairs are at most this share of the contacts. Ten times as many bring no
 * fewer solves beside the culling of pairs. Each further solve must be worth four times as many:
 * the last few pairs fail again and again, and pushes part them as well. */
static const double FEW = 0.001;
enum { IMPATIENCE = 2 }; /* doublings of this share a solve */

/* Thicknesses: rows that hardly open (row.h) are contacts, too. */
static const double REACH = 1.3;

static double reach_of_rows(const struct model *model)
{
    (void)model;
    return REACH;
}

double flow_contact_stiffness(const struct flow *flow, double h)
{
    const double inertia = 4 * flow->vertex_mass / (h * h);
    return flow->contact_stiffness > inertia ? flow->contact_stiffness : inertia;
}

/* ---- Pairs that cannot be kept apart ---- */

/* The cloth of a vertex that counts over all cloths. */
static uint32_t certified_cloth_of(const struct flow *flow, uint32_t vertex)
{
    uint32_t c = flow->model->n_cloths - 1;
    while (flow->cloth_first[c] > vertex)
        c--;
    return c;
}

/* Writes the parts of a pair: vertices as their meshes count them, from 1, and the obstacle. Only
 * rank 0 knows them. */
static void certified_describe_pair(const struct flow_state *state,
                                    const struct flow_contact *contact, size_t size, char *text)
{
    const struct flow *flow = state->flow;
    const struct flow_tie_corners *at = &contact->at;
    const uint32_t n_blocks = flow->tables.n_blocks, other = contact->side[1];
    uint32_t last = flow->model->n_cloths;
    text[0] = 0;
    if (!flow->vertex)
        return;
    cloth_text_add(text, size, "vertices");
    for (uint32_t k = 0; k < at->n; k++) {
        const uint32_t place = flow->tables.block[at->block[k]].first + at->row[k];
        const uint32_t vertex = flow->vertex[place], c = certified_cloth_of(flow, vertex);
        if (k && c != last)
            cloth_text_add(text, size, " of '%.40s' and", flow->model->cloths[last].name);
        cloth_text_add(text, size, " %" PRIu32 "%s", vertex - flow->cloth_first[c] + 1,
                       at->held >> k & 1 ? " (pinned)" : "");
        last = c;
    }
    if (at->n)
        cloth_text_add(text, size, " of '%.40s'", flow->model->cloths[last].name);
    if (other >= n_blocks)
        cloth_text_add(text, size, " and obstacles[%" PRIu32 "], a %s", other - n_blocks,
                       contact_kinds[flow->model->obstacles[other - n_blocks].kind]->name);
}

/* Gets a list that tasks made, on every rank; the caller frees it. */
static int get_list(struct flow_state *state, duite_object object, struct flow_list **list)
{
    size_t bytes;
    *list = NULL;
    int code = duite_get_count(state->rt, object, &bytes);
    if (code)
        return code;
    *list = aligned_alloc(FLOW_LINE, (bytes / FLOW_LINE + 1) * FLOW_LINE);
    if (!*list)
        cloth_fail(&state->flow->trouble, CLOTH_E_MEMORY, "out of memory for a list of pairs");
    code = flow_memory_agree(state);
    return code ? code : duite_get(state->rt, object, *list);
}

/* Finds the first pair of a list that fails, and describes it. */
static int describe_first_of(struct flow_state *state, const struct flow_meeting *meeting,
                             size_t size, char *text)
{
    struct flow_list *list;
    const int code = get_list(state, meeting->near, &list);
    const struct flow_near *near = (const struct flow_near *)(list + 1);
    uint64_t i = 0;
    while (!code && i < list->n && !near[i].fails)
        i++;
    if (!code && i < list->n)
        certified_describe_pair(state, &near[i].contact, size, text);
    free(list);
    return code;
}

/* Describes the first failing pair of the last look; on rank 0 only. */
static int describe_failing(struct flow_state *state, size_t size, char *text)
{
    const struct flow_meetings *meetings = &state->contact.meetings;
    uint32_t i = 0;
    text[0] = 0;
    while (i < meetings->n && !(meetings->count[FLOW_COUNTS * (size_t)i + FLOW_COUNT_FAILS] > 0))
        i++;
    return i < meetings->n ? describe_first_of(state, meetings->all + i, size, text) : DUITE_OK;
}

/* Contacts from a pinched one to the nearest solid; else UINT32_MAX. */
static uint32_t certified_length_of(const struct flow_contact *contact)
{
    const uint32_t *chain = contact->chain;
    if (!(contact->row.pinched > 0))
        return UINT32_MAX;
    return chain[0] < chain[1] ? chain[0] : chain[1];
}

/* Describes the pinched contact of the accepted state that is nearest to a solid, the first of
 * those; on rank 0 only. */
static int describe_pinched(struct flow_state *state, size_t size, char *text)
{
    int code = DUITE_OK;
    uint32_t least = UINT32_MAX;
    text[0] = 0;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !code && least > 1; b++) {
        struct flow_list *list;
        code = get_list(state, state->block[b].contacts, &list);
        const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
        for (uint64_t i = 0; !code && i < list->n; i++) {
            const uint32_t length = certified_length_of(contact + i);
            if (length < least)
                certified_describe_pair(state, contact + i, size, text);
            least = length < least ? length : least;
        }
        free(list);
    }
    return code;
}

/* The reason of a failure. what: the fault of n pairs; cure: its remedy. */
static int say_why(struct flow_state *state, uint64_t n, const char *what, const char *cure)
{
    char first[200];
    const int code = describe_failing(state, sizeof first, first);
    snprintf(state->reason, sizeof state->reason, "%" PRIu64 " %s%s%s%s%s", n, what,
             first[0] ? ", the first of them at " : "", first,
             first[0] ? " (vertices count from 1)" : "", cure);
    return code;
}

/* Adds n pinches to the report, with the first of all. */
static int note_pinches(struct flow_state *state, uint64_t n)
{
    struct flow_report *report = state->report;
    const bool first = !report->contact_pinches && n;
    char pair[200] = "";
    report->contact_pinches += n;
    const int code = first ? describe_pinched(state, sizeof pair, pair) : DUITE_OK;
    if (pair[0])
        snprintf(report->contact_pinch, sizeof report->contact_pinch, "%s, at %g s", pair,
                 flow_attempt_args(state).time);
    return code;
}

/* Pairs fail that cannot be cut further: the step is halved, or the run ends. */
static int note_failing(struct flow_state *state, uint64_t fails)
{
    return flow_attempt_is_last(state)
               ? say_why(state, fails,
                         "pairs of features cannot be kept apart: obstacles or pins pinch the "
                         "cloth, or are too fast",
                         model_contact_cure(state->flow->model))
               : DUITE_OK;
}

/* ---- The begin of a step ---- */

/* again: this step was looked at before. shorter: as in flow_contact_look. */
static int look_at_step(struct flow_state *state, bool again, bool shorter, struct flow_seen *seen)
{
    struct flow_report *report = state->report;
    const int code = flow_contact_look(state, again, shorter, seen);
    report->contact_pairs += seen->passes;
    report->contact_queries += seen->queries;
    report->contact_queries_again += again ? seen->queries : 0;
    return code;
}

static int start_certified(struct flow_state *state)
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
        code = flow_contact_cut_none(state);
    if (!code)
        code = look_at_step(state, false, false, &seen);
    if (!code && seen.fails) {
        char cure[128];
        snprintf(cure, sizeof cure, ": %s", model_start_cure(state->flow->model));
        code = say_why(state, seen.fails,
                       "pairs of features touch where the run starts, cloths or a cloth and an "
                       "obstacle",
                       cure);
        return code ? code : FLOW_TANGLED;
    }
    if (!code)
        code = flow_contact_accept(state);
    state->contact.kept_begin = false;
    return code;
}

static int begin_certified(struct flow_state *state)
{
    flow_contact_return(state);
    state->contact.failed = false;
    state->contact.cut = state->contact.cut_run = 0;
    state->contact.attempt++;
    state->contact.cut_momentum = 0;
    state->contact.iterations = state->contact.restarts = 0;
    int code = flow_contact_stop_keep(state);
    if (!code)
        code = flow_skins_keep(state);
    return code ? code : flow_contact_tie(state);
}

/* ---- The step ---- */

/* Returns to the step's begin and makes it again with the present contacts. Adds up the cost of its
 * solves. */
static int make_again(struct flow_state *state, const double status[FLOW_STATUS])
{
    state->contact.iterations += status[FLOW_ITERATIONS];
    state->contact.restarts += status[FLOW_RESTARTS];
    state->smooth = 0; /* a BDF2 step has changed the state that it goes on from */
    state->report->contact_solves++;
    int code = flow_contact_again(state);
    if (!code)
        code = flow_contact_tie(state);
    if (!code)
        code = flow_restore(state);
    return code ? code : flow_step_again(state);
}

/* Notes rows that were moved. Returns false if too many lost half of their way: the step is given
 * up. */
static bool note_cut(struct flow_state *state, bool push, const struct flow_cut *cut,
                     uint64_t contacts)
{
    struct flow_contact_state *now = &state->contact;
    *(push ? &state->report->contact_pushes : &state->report->contact_cuts) += cut->rows;
    now->cut_momentum += cut->momentum;
    now->cut += cut->rows;
    if (cut->run > now->cut_run)
        now->cut_run = cut->run;
    const double most = fmax(TOO_MANY * (double)contacts, NOT_MANY);
    now->failed = !flow_attempt_is_last(state) && (double)cut->halved > most;
    return !now->failed;
}

/* Pushes pairs apart, then cuts until no pair fails, or no row can be cut: another look would then
 * find the same. */
static int cut_failing(struct flow_state *state, struct flow_seen *seen)
{
    for (int round = 0; round < MAX_PUSHES + MAX_CUTS && seen->fails; round++) {
        const bool push = round < MAX_PUSHES;
        struct flow_cut cut;
        int code = flow_contact_cut(state, push, &cut);
        state->contact.stopped = cut.stops;
        if (!code && !cut.rows && push && !cut.stops)
            continue;
        if (!code && (!cut.rows || cut.stops))
            break;
        if (!code && !note_cut(state, push, &cut, seen->contacts))
            return DUITE_OK;
        code = code ? code : look_at_step(state, true, false, seen);
        if (code)
            return code;
    }
    state->contact.failed = seen->fails;
    return seen->fails && !state->contact.stopped ? note_failing(state, seen->fails) : DUITE_OK;
}

/* True if the pairs that fail after so many solves are worth another one. */
static bool is_worth_solving(const struct flow_seen *seen, int solves)
{
    const double few = ldexp(FEW, IMPATIENCE * (solves - 1));
    return solves < MAX_SOLVES && (double)seen->fails > few * (double)seen->contacts;
}

/* True if the step's solve succeeded. */
static bool is_solved(const double status[FLOW_STATUS])
{
    return !(status[FLOW_FAILED] + status[FLOW_BEYOND] > 0);
}

static int settle_certified(struct flow_state *state)
{
    double status[FLOW_STATUS];
    struct flow_seen seen = {0};
    int code = DUITE_OK;
    for (int solve = 1; !code; solve++) {
        code = duite_get(state->rt, state->run.status, status);
        flow_implicit_status(state, status);
        if (code || !is_solved(status))
            return code;
        code = look_at_step(state, solve > 1, !flow_attempt_is_last(state), &seen);
        if (!code && seen.hopeless) {
            state->contact.failed = true;
            return DUITE_OK;
        }
        if (code || !is_worth_solving(&seen, solve))
            break;
        state->contact.stopped = status[FLOW_STOP] > 0;
        if (state->contact.stopped)
            return DUITE_OK;
        code = make_again(state, status);
    }
    if (!code && seen.fails)
        code = cut_failing(state, &seen);
    if (seen.contacts > state->report->contacts)
        state->report->contacts = seen.contacts;
    state->contact.near = seen.contacts;
    return code || state->contact.failed || state->contact.stopped ? code
                                                                   : flow_contact_accept(state);
}

static void add_solves(const struct flow_state *state, double status[FLOW_STATUS])
{
    status[FLOW_ITERATIONS] += state->contact.iterations;
    status[FLOW_RESTARTS] += state->contact.restarts;
    status[FLOW_TOUCHED] += (double)state->contact.cut;
}

static int note_settled(struct flow_state *state, const double status[FLOW_STATUS], bool accepted)
{
    if (!accepted) {
        flow_contact_return(state);
        return DUITE_OK;
    }
    state->contact.kept_begin = false;
    state->contact.accepted = state->contact.attempt;
    state->report->contacts_now = state->contact.near;
    if (state->contact.cut_run > state->report->contact_cut_run)
        state->report->contact_cut_run = state->contact.cut_run;
    state->report->contact_cut_momentum += state->contact.cut_momentum;
    return note_pinches(state, (uint64_t)status[FLOW_PINCHES]);
}

/* ---- In tasks ---- */

static bool certified_is(const struct model *model)
{
    return model_promise(model).apart;
}

static void make_row(const struct flow *flow, const struct flow_step_args *step,
                     const struct flow_contact *contact, struct contact_row *row)
{
    contact_row_begin(row, flow_contact_stiffness(flow, step->h), step->h / flow->model->h);
    flow_contact_ahead(flow, step->time - step->h, step->time, contact, row);
}

static void press_row(const struct contact_spring *spring, const struct flow_ties *ties,
                      const struct flow_view *view, double h, double left, uint32_t i,
                      const phys_vec *point, struct flow_pressed *to)
{
    (void)spring, (void)ties, (void)h, (void)left;
    contact_row_linearise(view->contact_rows + i, point, &to->force, &to->value);
    to->against = to->value;
}

const struct flow_contact_mode flow_contact_certified = {.is = certified_is,
                                                         .start = start_certified,
                                                         .resume = flow_bodies_make,
                                                         .begin = begin_certified,
                                                         .settle = settle_certified,
                                                         .status = add_solves,
                                                         .settled = note_settled,
                                                         .reach = reach_of_rows,
                                                         .sweeps = true,
                                                         .carries = true,
                                                         .row = make_row,
                                                         .press = press_row};
