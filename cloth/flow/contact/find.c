/* A list has room for more than it mostly gets, and room is zeroed where the list grows: so it
 * grows with its items. */
#include "cloth/flow/contact/find.h"

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
    const size_t n = findings->n, most = findings->args->room, more = n + n / 2 + MORE;
    const size_t bytes = findings->call->param[findings->parameter].count;
    if (n >= most)
        return false;
    if (flow_list_bytes(n + 1, sizeof *findings->near) <= bytes)
        return true;
    return !duite_resize(findings->call, findings->parameter,
                         flow_list_bytes(more < most ? more : most, sizeof *findings->near));
}

void flow_findings_add(struct flow_findings *findings, const struct flow_near *near)
{
    const bool first = near->contact.side[0] == findings->args->side[0];
    findings->counts[FLOW_COUNT_FAILS] += near->fails;
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
    if (!code)
        *findings->list = (struct flow_list){.n = n, .side = {args->side[0], args->side[1]}};
    return code;
}
