/* The first difference between ranks, found when a difference is already certain. Rank 0 alone asks
 * all ranks for their histories, once, and breaks with one sentence, which its abort message takes
 * to all. Whoever finds a difference tells rank 0. If rank 0 is not heard in time, that rank breaks
 * with what it knows; so does rank 0 for ranks that do not answer.
 *
 * The reference is a history that grows: rank 0's, and beyond its end the calls of ranks that have
 * the same up to there. The fingerprint of a call depends on all calls before it, so two histories
 * are the same up to their first difference and nowhere after it. */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"
#include "runtime/comm/internal.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define ANSWER_SECONDS  1.0 /* rank 0 waits so long for histories */
#define VERDICT_SECONDS 3.0 /* and all others for rank 0 */

enum { SHOWN_GROUPS = 4, SHOWN_RANGES = 4 };

/* COMM_DIFFERS: a rank found a difference at its blocking call of that number. COMM_INQUIRY: only
 * the number. */
struct difference_found {
    uint64_t number;
    char message[300];
};

/* COMM_ANSWER */
struct difference_answer {
    uint64_t homes;     /* at the blocking call that is asked about */
    uint64_t has_homes; /* not if this rank has not come to it */
    struct task_history_copy history;
};

/* What rank 0 knows of a rank. */
struct difference_rank {
    bool answered, has_homes;
    bool compared; /* some of its calls, with the reference */
    bool older;    /* the first of these differs already */
    uint64_t homes;
    uint64_t last;              /* its last call */
    uint64_t at;                /* its first call that differs from the reference's, or 0 */
    uint64_t fingerprint, call; /* of this call ... */
    uint64_t other_fingerprint, other_call; /* ... and of the reference's */
};

struct difference_inquiry {
    struct task_history_copy reference;
    int answers;
    struct difference_rank rank[];
};

/* ---- Sentences ---- */

struct difference_text {
    size_t length;
    char text[900];
};

__attribute__((format(printf, 2, 3))) static void text_add(struct difference_text *text,
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
static void text_add_ranks(struct difference_text *text, const int *group, int n_ranks, int which)
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

static void text_add_call(struct difference_text *text, const struct task_graph *graph,
                          uint64_t call, bool again)
{
    const uint32_t which = task_call_which(call);
    const bool forked = task_call_kind(call) != TASK_CALLED;
    if (forked)
        text_add(text, " %s \"%.60s\"", task_call_kind(call) == TASK_FORKED ? "forked" : "recorded",
                 which < graph->n_kernels ? graph->kernels[which]->name : "another kernel");
    else
        text_add(text, " called %s", task_called_name(which));
    if (again)
        text_add(text, forked ? " with other objects or on another rank" : " with other arguments");
}

/* ---- What rank 0 concludes ---- */

/* Ranks by what they did at call `at`. */
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

/* The first call that is known to differ, by some rank; NULL: none is. One before which nothing was
 * compared counts only where there is no other. */
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
                                 uint64_t before, struct difference_text *text)
{
    text_add(text, "ranks differ: ");
    text_add_ranks(text, groups->of, comm->n_ranks, 1);
    text_add(text, " made other calls than ");
    text_add_ranks(text, groups->of, comm->n_ranks, 0);
    text_add(text, "; the first difference lies before call %" PRIu64, before);
}

static void difference_say_groups(const struct comm *comm, const struct difference_groups *groups,
                                  struct difference_text *text)
{
    for (int i = 0; i < groups->n; i++) {
        bool again = false;
        for (int k = 0; k < i; k++)
            again |= groups->call[k] == groups->call[i];
        text_add(text, i ? ", " : " ");
        text_add_ranks(text, groups->of, comm->n_ranks, i);
        text_add_call(text, comm->graph, groups->call[i], again);
    }
}

/* "ranks differ at fork 21: ...", or between two forks "after fork 20". */
static void difference_say(const struct comm *comm, const struct difference_rank *first,
                           struct difference_groups *groups, struct difference_text *text)
{
    uint64_t forks = 0, forked = 0;
    difference_group(comm, first, groups);
    for (int i = 0; i < groups->n; i++) {
        forks = task_call_forks(groups->call[i]);
        if (task_call_kind(groups->call[i]) == TASK_FORKED)
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

/* Whether homes differ, which rank 0 says then. */
static bool difference_say_homes(const struct comm *comm, struct difference_groups *groups,
                                 struct difference_text *text)
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

/* Breaks with the best sentence there is. */
static void difference_conclude(struct comm *comm)
{
    struct comm_difference *difference = &comm->difference;
    struct difference_text text = {0};
    struct difference_groups groups = {
        .of = difference->inquiry ? base_alloc((size_t)comm->n_ranks * sizeof *groups.of) : NULL};
    const struct difference_rank *first = groups.of ? difference_first(comm) : NULL;
    difference->until = 0;
    if (first)
        difference_say(comm, first, &groups, &text);
    else if (!groups.of || !difference_say_homes(comm, &groups, &text))
        text_add(&text, "%s", difference->message);
    base_free(groups.of);
    comm_broke(comm, DUITE_E_DIFFERENT, text.text);
}

/* ---- Answers, on rank 0 ---- */

/* The reference grows by what the rank called beyond its end. */
static void reference_extend(struct task_history_copy *reference,
                             const struct task_history_copy *history)
{
    while (reference->last < history->last) {
        const uint64_t n = ++reference->last % TASK_HISTORY_CALLS;
        reference->entry[n] = history->entry[n];
    }
    if (reference->last - reference->first >= TASK_HISTORY_CALLS)
        reference->first = reference->last - TASK_HISTORY_CALLS + 1;
}

static void reference_compare(struct task_history_copy *reference, struct difference_rank *rank,
                              const struct task_history_copy *history)
{
    const uint64_t first = history->first > reference->first ? history->first : reference->first;
    const uint64_t last = history->last < reference->last ? history->last : reference->last;
    const bool both_new = history->first == 1 && reference->first == 1;
    rank->last = history->last;
    rank->compared = first <= last || both_new;
    for (uint64_t n = first; n <= last; n++) {
        const size_t i = n % TASK_HISTORY_CALLS;
        if (history->entry[i].fingerprint == reference->entry[i].fingerprint)
            continue;
        rank->at = n;
        rank->older = n == first && n > 1;
        rank->fingerprint = history->entry[i].fingerprint;
        rank->call = history->entry[i].call;
        rank->other_fingerprint = reference->entry[i].fingerprint;
        rank->other_call = reference->entry[i].call;
        return;
    }
    if (rank->compared)
        reference_extend(reference, history);
}

static void difference_take(struct comm *comm, int from, const struct difference_answer *answer)
{
    struct difference_inquiry *inquiry = comm->difference.inquiry;
    struct difference_rank *rank = inquiry ? &inquiry->rank[from] : NULL;
    if (!rank || rank->answered)
        return;
    rank->answered = true;
    rank->has_homes = answer->has_homes;
    rank->homes = answer->homes;
    reference_compare(&inquiry->reference, rank, &answer->history);
    if (++inquiry->answers == comm->n_ranks)
        difference_conclude(comm);
}

static void difference_answer(struct comm *comm, uint64_t number, struct difference_answer *answer)
{
    const struct comm_called *call = comm_calls_logged(&comm->calls, number);
    answer->has_homes = call != NULL;
    answer->homes = call ? call->homes : 0;
    task_history_read(comm->graph->history, &answer->history);
}

/* ---- Messages; under the lock ---- */

static struct data_packet *difference_packet(struct comm *comm, enum comm_kind kind, size_t bytes)
{
    struct data_packet *packet = data_packet_new(bytes, true);
    if (packet)
        packet->kind = kind;
    else if (comm->difference.found)
        comm_broke(comm, DUITE_E_DIFFERENT, comm->difference.message);
    else
        comm_broke_memory(comm, "a control message");
    return packet;
}

static void difference_inquire(struct comm *comm)
{
    struct comm_difference *difference = &comm->difference;
    difference->inquiry = base_alloc_zero(
        sizeof *difference->inquiry + (size_t)comm->n_ranks * sizeof difference->inquiry->rank[0]);
    struct difference_answer *own = base_alloc(sizeof *own);
    if (!difference->inquiry || !own) {
        base_free(own);
        difference_conclude(comm);
        return;
    }
    difference->inquiry->reference.first = 1;
    difference_answer(comm, difference->number, own);
    difference->inquiry->reference = own->history;
    difference_take(comm, comm->rank, own);
    base_free(own);
    for (int to = 0; to < comm->n_ranks && !comm_is_broken(comm); to++) {
        struct data_packet *packet =
            to == comm->rank ? NULL : difference_packet(comm, COMM_INQUIRY, sizeof(uint64_t));
        if (!packet)
            continue;
        memcpy(data_payload(packet), &difference->number, sizeof difference->number);
        comm_control_send(comm, to, packet);
    }
}

static void difference_report(struct comm *comm)
{
    struct comm_difference *difference = &comm->difference;
    struct difference_found found = {.number = difference->number};
    struct data_packet *packet = difference_packet(comm, COMM_DIFFERS, sizeof found);
    if (!packet)
        return;
    snprintf(found.message, sizeof found.message, "%s", difference->message);
    memcpy(data_payload(packet), &found, sizeof found);
    comm_control_send(comm, 0, packet);
}

void comm_difference_found(struct comm *comm, uint64_t number, const char *message)
{
    struct comm_difference *difference = &comm->difference;
    if (difference->found || comm_is_broken(comm))
        return;
    difference->found = true;
    difference->number = number;
    snprintf(difference->message, sizeof difference->message, "%s", message);
    difference->until = base_seconds() + (comm->rank ? VERDICT_SECONDS : ANSWER_SECONDS);
    if (comm->rank)
        difference_report(comm);
    else
        difference_inquire(comm);
}

void comm_difference_hear(struct comm *comm, struct data_packet *packet)
{
    if (comm_is_broken(comm))
        return;
    if (packet->kind == COMM_ANSWER) {
        difference_take(comm, (int)packet->key.slot, data_payload(packet));
    } else if (packet->kind == COMM_DIFFERS) {
        const struct difference_found *found = data_payload(packet);
        comm_difference_found(comm, found->number, found->message);
    } else {
        const uint64_t *number = data_payload(packet);
        struct data_packet *answer =
            difference_packet(comm, COMM_ANSWER, sizeof(struct difference_answer));
        if (!answer)
            return;
        difference_answer(comm, *number, data_payload(answer));
        comm_control_send(comm, 0, answer);
    }
}

void comm_difference_pass(struct comm *comm)
{
    if (comm->difference.until > 0 && base_seconds() > comm->difference.until)
        difference_conclude(comm);
}

void comm_difference_stop(struct comm_difference *difference)
{
    base_free(difference->inquiry);
}
