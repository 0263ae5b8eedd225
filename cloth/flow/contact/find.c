/* A list has room for more than it mostly gets, and room is zeroed where the list grows: so it
 * grows with its items. */
#include "cloth/flow/contact/find.h"

#include <stdlib.h>

void flow_findings_open(const duite_call *call, size_t i, struct flow_list *list,
                        const struct flow_meet_args *args, double *counts, struct flow_findings *to)
{
    *to = (struct flow_findings){.call = call,
                                 .parameter = i,
                                 .list = list,
                                 .near = (struct flow_near *)(list + 1),
                                 .before = args->again ? list->n : 0,
                                 .args = args,
                                 .counts =
                                     counts + FLOW_COUNTS * (args->number % FLOW_MEETING_GROUP)};
}

static bool find_make_room(const struct flow_findings *findings)
{
    enum { MORE = 32 };
    const size_t n = findings->n, most = findings->args->room, more = n + MORE;
    const size_t bytes = findings->call->param[findings->parameter].count;
    if (n >= most)
        return false;
    if (flow_list_bytes(n + 1, sizeof *findings->near) <= bytes)
        return true;
    return !duite_resize(findings->call, findings->parameter,
                         flow_list_bytes(more < most ? more : most, sizeof *findings->near));
}

/* Counts the corners that no failing pair had before. */
static void find_mark_failing(struct flow_findings *findings, const struct flow_contact *contact)
{
    const size_t n_points = (size_t)findings->n_points[0] + findings->n_points[1];
    const uint32_t n = contact->kind == FLOW_CONTACT_SHAPE ? contact->at.n : 4;
    if (!findings->failing)
        findings->failing = calloc(n_points + 1, 1);
    findings->no_memory = !findings->failing;
    for (uint32_t k = 0; k < n && !findings->no_memory; k++) {
        const bool second = contact->side[k >= contact->first] != findings->args->side[0];
        unsigned char *mark =
            findings->failing + (second ? findings->n_points[0] : 0) + contact->point[k];
        findings->counts[FLOW_COUNT_FAILING] += !*mark;
        *mark = 1;
    }
}

void flow_findings_add(struct flow_findings *findings, const struct flow_near *near)
{
    const bool first = near->contact.side[0] == findings->args->side[0];
    findings->counts[FLOW_COUNT_FAILS] += near->fails;
    if (near->fails)
        find_mark_failing(findings, &near->contact);
    findings->counts[first ? FLOW_COUNT_FIRST : FLOW_COUNT_SECOND]++;
    if (find_make_room(findings))
        findings->near[findings->n] = *near;
    findings->n++;
}

int flow_findings_close(const struct flow_findings *findings, size_t passes)
{
    const struct flow_meet_args *args = findings->args;
    const size_t n = findings->n < args->room ? findings->n : args->room;
    const int code = duite_resize(findings->call, findings->parameter,
                                  flow_list_bytes(n, sizeof *findings->near));
    findings->counts[FLOW_COUNT_ALL] = (double)findings->n;
    findings->counts[FLOW_COUNT_PASSES] = (double)passes;
    free(findings->failing);
    if (findings->no_memory)
        return duite_fail(findings->call, FLOW_NO_MEMORY, "out of memory for pairs that fail");
    if (!code)
        *findings->list = (struct flow_list){.n = n, .side = {args->side[0], args->side[1]}};
    return code;
}
