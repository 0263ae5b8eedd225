/* The first difference is the earliest call that differs from the reference's. Ranks that did the
 * same at that call are a group; the sentence names the groups and the call of each. */

#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

enum { SHOWN_GROUPS = 4, SHOWN_RANGES = 4 };

/* ---- Sentences ---- */

__attribute__((format(printf, 2, 3))) static void text_add(struct comm_verdict *text,
                                                           const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int n =
        vsnprintf(text->text + text->length, sizeof text->text - text->length, format, arguments);
    va_end(arguments);
    text->length += n > 0 ? (size_t)n : 0;
    if (text->length >= sizeof text->text)
        text->length = sizeof text->text - 1;
}

/* "rank 3", "ranks 0-2 and 5", "ranks 0, 2, 4, 6 and 12 more". */
static void text_add_ranks(struct comm_verdict *text, const int *group, int n_ranks, int which)
{
    int ranges = 0, ranks = 0, shown = 0, left = 0;
    for (int r = 0; r < n_ranks; r++) {
        ranks += group[r] == which;
        ranges += group[r] == which && (!r || group[r - 1] != which);
    }
    text_add(text, ranks == 1 ? "rank " : "ranks ");
    for (int r = 0, end; r < n_ranks; r = end) {
        for (end = r + 1; end < n_ranks && group[end] == group[r]; end++)
            ;
        if (group[r] != which)
            continue;
        if (shown == SHOWN_RANGES) {
            left += end - r;
            continue;
        }
        text_add(text, "%s%d", !shown ? "" : shown == ranges - 1 ? " and " : ", ", r);
        if (end > r + 1)
            text_add(text, end == r + 2 ? (shown == ranges - 1 ? " and %d" : ", %d") : "-%d",
                     end - 1);
        shown++;
    }
    if (left)
        text_add(text, " and %d more", left);
}

static void text_add_call(struct comm_verdict *text, const struct comm_setup *setup, uint64_t call,
                          bool again)
{
    const uint32_t which = comm_call_which(call);
    const bool forked = comm_call_kind(call) != COMM_CALLED;
    if (forked)
        text_add(text, " %s \"%.60s\"", comm_call_kind(call) == COMM_FORKED ? "forked" : "recorded",
                 which < setup->n_kernels ? setup->kernels[which]->name : "another kernel");
    else
        text_add(text, " called %s", comm_function_name(which));
    if (again)
        text_add(text, forked ? " with other objects or on another rank" : " with other arguments");
}

/* ---- Groups of ranks ---- */

/* Ranks grouped by their call `at`. */
struct difference_groups {
    int n, *of; /* of each rank, or -1: unknown */
    uint64_t fingerprint[SHOWN_GROUPS], call[SHOWN_GROUPS];
};

static int groups_find(struct difference_groups *groups, uint64_t fingerprint, uint64_t call)
{
    int i = 0;
    while (i < groups->n && (groups->fingerprint[i] != fingerprint || groups->call[i] != call))
        i++;
    if (i == SHOWN_GROUPS)
        return -1;
    groups->fingerprint[i] = fingerprint;
    groups->call[i] = call;
    groups->n += i == groups->n;
    return i;
}

/* The first call that is known to differ, by some rank; NULL: none is. A call with no compared call
 * before it counts only if there is no other. */
static const struct difference_rank *difference_first(const struct comm *comm)
{
    const struct difference_inquiry *inquiry = comm->difference.inquiry;
    const struct difference_rank *first = NULL;
    for (int r = 0; r < comm->n_ranks; r++) {
        const struct difference_rank *rank = &inquiry->rank[r];
        if (rank->at && (!first || rank->older < first->older ||
                         (rank->older == first->older && rank->at < first->at)))
            first = rank;
    }
    return first;
}

static void difference_group(const struct comm *comm, const struct difference_rank *first,
                             struct difference_groups *groups)
{
    const struct difference_inquiry *inquiry = comm->difference.inquiry;
    for (int r = 0; r < comm->n_ranks; r++) {
        const struct difference_rank *rank = &inquiry->rank[r];
        groups->of[r] = -1;
        if (rank->at == first->at && rank->older == first->older)
            groups->of[r] = groups_find(groups, rank->fingerprint, rank->call);
        else if (rank->compared && rank->last >= first->at && (!rank->at || rank->at > first->at))
            groups->of[r] = groups_find(groups, first->other_fingerprint, first->other_call);
    }
}

/* "ranks differ: rank 3 made other calls than ranks 0-2; the first difference lies before ..." */
static void difference_say_older(const struct comm *comm, const struct difference_groups *groups,
                                 uint64_t before, struct comm_verdict *text)
{
    text_add(text, "ranks differ: ");
    text_add_ranks(text, groups->of, comm->n_ranks, 1);
    text_add(text, " made other calls than ");
    text_add_ranks(text, groups->of, comm->n_ranks, 0);
    text_add(text, "; the first difference lies before call %" PRIu64, before);
}

static void difference_say_groups(const struct comm *comm, const struct difference_groups *groups,
                                  struct comm_verdict *text)
{
    for (int i = 0; i < groups->n; i++) {
        bool again = false;
        for (int k = 0; k < i; k++)
            again |= groups->call[k] == groups->call[i];
        text_add(text, i ? ", " : " ");
        text_add_ranks(text, groups->of, comm->n_ranks, i);
        text_add_call(text, &comm->setup, groups->call[i], again);
    }
}

/* "ranks differ at fork 21: ...", or between two forks "after fork 20". */
static void difference_say(const struct comm *comm, const struct difference_rank *first,
                           struct difference_groups *groups, struct comm_verdict *text)
{
    uint64_t forks = 0, forked = 0;
    difference_group(comm, first, groups);
    for (int i = 0; i < groups->n; i++) {
        forks = comm_call_forks(groups->call[i]);
        if (comm_call_kind(groups->call[i]) == COMM_FORKED)
            forked = forks;
    }
    if (first->older) {
        difference_say_older(comm, groups, first->at + 1, text);
        return;
    }
    if (forked)
        text_add(text, "ranks differ at fork %" PRIu64 ":", forked);
    else if (forks)
        text_add(text, "ranks differ after fork %" PRIu64 ":", forks);
    else
        text_add(text, "ranks differ before the first fork:");
    difference_say_groups(comm, groups, text);
}

/* True if homes differ; the text says so then. */
static bool difference_say_homes(const struct comm *comm, struct difference_groups *groups,
                                 struct comm_verdict *text)
{
    const struct difference_inquiry *inquiry = comm->difference.inquiry;
    for (int r = 0; r < comm->n_ranks; r++)
        groups->of[r] =
            inquiry->rank[r].has_homes ? groups_find(groups, inquiry->rank[r].homes, 0) : -1;
    if (groups->n < 2)
        return false;
    text_add(text, "the mapping gave objects other homes on ");
    text_add_ranks(text, groups->of, comm->n_ranks, 1);
    text_add(text, " than on ");
    text_add_ranks(text, groups->of, comm->n_ranks, 0);
    text_add(text, ": its function `map` must write the same homes on every rank, and may not look "
                   "at the rank, the time or the machine");
    return true;
}

void comm_verdict_find(const struct comm *comm, struct comm_verdict *verdict)
{
    struct difference_groups groups = {
        .of = comm->difference.inquiry ? base_alloc((size_t)comm->n_ranks * sizeof *groups.of)
                                       : NULL};
    const struct difference_rank *first = groups.of ? difference_first(comm) : NULL;
    if (first)
        difference_say(comm, first, &groups, verdict);
    else if (!groups.of || !difference_say_homes(comm, &groups, verdict))
        text_add(verdict, "%s", comm->difference.message);
    base_free(groups.of);
}
