/* Finds the first difference between ranks when a difference is already certain. The rank that
 * finds a difference tells rank 0. Rank 0 alone asks all ranks for their histories, once, and
 * breaks with one sentence, which its abort message takes to all. Rank 0 waits as long as answers
 * come. If none comes for so long that a silent rank would be lost, it breaks with what it knows.
 * The rank that told rank 0 does the same after twice that time.
 *
 * The reference is a history that grows: rank 0's, and beyond its end the calls of ranks that have
 * the same up to there. The fingerprint of a call depends on all calls before it, so two histories
 * are the same up to their first difference and nowhere after it. */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- The history ---- */

#define FUNCTION_NAME(value, name) name,
static const char *const CALLED_NAMES[COMM_N_CALLED] = {COMM_FUNCTIONS(FUNCTION_NAME)};

enum comm_function comm_function_find(const char *name)
{
    for (int i = 0; i < COMM_N_CALLED; i++)
        if (!strcmp(CALLED_NAMES[i], name))
            return (enum comm_function)i;
    return COMM_CALLED_OTHER;
}

const char *comm_function_name(uint32_t called)
{
    return CALLED_NAMES[called < COMM_N_CALLED ? called : COMM_CALLED_OTHER];
}

/* The ring is read while the main thread writes it: the copy leaves out entries that may have been
 * overwritten meanwhile. */
void comm_history_read(struct comm_history *history, struct comm_history_copy *copy)
{
    copy->last = atomic_load_explicit(&history->calls, memory_order_acquire);
    for (size_t i = 0; i < COMM_HISTORY_CALLS; i++) {
        struct comm_history_entry *entry = &history->entry[i];
        copy->entry[i].fingerprint =
            atomic_load_explicit(&entry->fingerprint, memory_order_acquire);
        copy->entry[i].call = atomic_load_explicit(&entry->call, memory_order_acquire);
    }
    /* The call after the last one counted may be in the middle of being written. */
    const uint64_t begun = atomic_load_explicit(&history->calls, memory_order_acquire) + 1;
    copy->first = begun >= COMM_HISTORY_CALLS ? begun - COMM_HISTORY_CALLS + 1 : 1;
}

/* ---- Waiting for answers ---- */

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
    struct comm_history_copy history;
};

/* Breaks with the best sentence there is. */
static void difference_conclude(struct comm *comm)
{
    struct comm_verdict verdict = {0};
    comm->difference.until = 0;
    comm_verdict_find(comm, &verdict);
    comm_break(comm, DUITE_E_DIFFERENT, verdict.text);
}

/* From now on it waits for as long as a rank may be silent; other ranks than 0 twice as long. */
static void difference_wait(struct comm *comm)
{
    const double seconds = comm->heartbeat.seconds;
    comm->difference.until =
        seconds > 0 ? base_seconds() + (comm->rank ? 2 : 1) * seconds : (double)INFINITY;
}

/* ---- Answers, on rank 0 ---- */

/* Appends the rank's calls beyond the end of the reference. */
static void reference_extend(struct comm_history_copy *reference,
                             const struct comm_history_copy *history)
{
    while (reference->last < history->last) {
        const uint64_t n = ++reference->last % COMM_HISTORY_CALLS;
        reference->entry[n] = history->entry[n];
    }
    if (reference->last - reference->first >= COMM_HISTORY_CALLS)
        reference->first = reference->last - COMM_HISTORY_CALLS + 1;
}

static void reference_compare(struct comm_history_copy *reference, struct difference_rank *rank,
                              const struct comm_history_copy *history)
{
    const uint64_t first = history->first > reference->first ? history->first : reference->first;
    const uint64_t last = history->last < reference->last ? history->last : reference->last;
    const bool both_new = history->first == 1 && reference->first == 1;
    rank->last = history->last;
    rank->compared = first <= last || both_new;
    for (uint64_t n = first; n <= last; n++) {
        const size_t i = n % COMM_HISTORY_CALLS;
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
    difference_wait(comm);
    if (++inquiry->answers == comm->n_ranks)
        difference_conclude(comm);
}

static void difference_answer(struct comm *comm, uint64_t number, struct difference_answer *answer)
{
    const struct comm_called *call = comm_calls_logged(&comm->calls, number);
    answer->has_homes = call != NULL;
    answer->homes = call ? call->homes : 0;
    comm_history_read(comm->setup.history, &answer->history);
}

/* ---- Messages; under the lock ---- */

static void difference_break(struct comm *comm)
{
    if (comm->difference.found)
        comm_break(comm, DUITE_E_DIFFERENT, comm->difference.message);
    else
        comm_break_memory(comm, "a control message");
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
    for (int to = 0; to < comm->n_ranks && !comm_is_broken(comm); to++)
        if (to != comm->rank && !comm_control_tell(comm, to, COMM_INQUIRY, &difference->number,
                                                   sizeof difference->number))
            difference_break(comm);
}

static void difference_report(struct comm *comm)
{
    struct difference_found found = {.number = comm->difference.number};
    snprintf(found.message, sizeof found.message, "%s", comm->difference.message);
    if (!comm_control_tell(comm, 0, COMM_DIFFERS, &found, sizeof found))
        difference_break(comm);
}

void comm_difference_found(struct comm *comm, uint64_t number, const char *message)
{
    struct comm_difference *difference = &comm->difference;
    if (difference->found || comm_is_broken(comm))
        return;
    difference->found = true;
    difference->number = number;
    snprintf(difference->message, sizeof difference->message, "%s", message);
    difference_wait(comm);
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
        struct data_packet *answer = data_packet_new(sizeof(struct difference_answer), true);
        if (!answer) {
            difference_break(comm);
            return;
        }
        answer->kind = COMM_ANSWER;
        difference_answer(comm, *number, data_payload(answer));
        comm_control_send(comm, 0, answer);
    }
}

void comm_difference_pass(struct comm *comm)
{
    if (comm->difference.until > 0 && base_seconds() > comm->difference.until)
        difference_conclude(comm);
}
