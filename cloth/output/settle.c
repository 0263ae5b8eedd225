/* Under the lock is how far each member is. The thread takes all frames that are there at once, so
 * a slow disk is asked less often. After a failure it settles nothing more. */
#include "cloth/output/settle.h"

#include "cloth/base/thread.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { BEHIND = 3 }; /* frames that the disk may be behind */

struct output_settler {
    pthread_t thread;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t change;
    uint32_t n;
    struct output_member member[OUTPUT_MEMBERS];
    uint32_t written[OUTPUT_MEMBERS], settled[OUTPUT_MEMBERS];
    uint64_t given, done; /* frames that members wrote; that the thread has settled, in turn */
    struct cloth_error trouble; /* the first */
    bool ends;
};

static bool is_idle(const struct output_settler *settler)
{
    return settler->done == settler->given || settler->trouble.code;
}

/* ---- The thread ---- */

/* Call with the lock, which it frees meanwhile. It counts only frames written before it began, so
 * no member gets ahead of one before it. */
static void settle_all(struct output_settler *settler)
{
    const uint64_t goal = settler->given;
    uint32_t written[OUTPUT_MEMBERS];
    struct cloth_error why = {0};
    memcpy(written, settler->written, sizeof written);
    for (uint32_t i = 0; i < settler->n && !why.code; i++) {
        const struct output_member member = settler->member[i];
        if (settler->settled[i] == written[i])
            continue;
        pthread_mutex_unlock(&settler->lock);
        member.settle(member.context, written[i], &why);
        pthread_mutex_lock(&settler->lock);
        if (!why.code)
            settler->settled[i] = written[i];
        pthread_cond_broadcast(&settler->change);
    }
    settler->done = goal;
    settler->trouble = why;
    pthread_cond_broadcast(&settler->change);
}

static void *output_settle_run(void *context)
{
    struct output_settler *settler = context;
    pthread_mutex_lock(&settler->lock);
    while (!(settler->ends && is_idle(settler)))
        if (is_idle(settler))
            pthread_cond_wait(&settler->change, &settler->lock);
        else
            settle_all(settler);
    pthread_mutex_unlock(&settler->lock);
    return NULL;
}

static void output_settle_drop(struct output_settler *settler)
{
    pthread_cond_destroy(&settler->change);
    pthread_mutex_destroy(&settler->lock);
    free(settler);
}

/* ---- For the run ---- */

int output_settler_open(struct output_settler **settler, struct cloth_error *error)
{
    *settler = NULL;
    struct output_settler *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for frames");
    pthread_mutex_init(&made->lock, NULL);
    pthread_cond_init(&made->change, NULL);
    const int failed = cloth_thread_start(&made->thread, output_settle_run, made);
    if (failed) {
        output_settle_drop(made);
        return cloth_fail(error, CLOTH_E_LIBRARY, "no thread to bring frames to the disk: %s",
                          strerror(failed));
    }
    *settler = made;
    return CLOTH_OK;
}

/* Call with the lock. */
static int tell(const struct output_settler *settler, struct cloth_error *error)
{
    const struct cloth_error *trouble = &settler->trouble;
    return trouble->code ? cloth_fail(error, trouble->code, "%s", trouble->text) : CLOTH_OK;
}

int output_settler_wait(struct output_settler *settler, struct cloth_error *error)
{
    if (!settler)
        return CLOTH_OK;
    pthread_mutex_lock(&settler->lock);
    const uint64_t goal = settler->given; /* of now: on a slow disk there are always newer frames */
    while (settler->done < goal && !settler->trouble.code)
        pthread_cond_wait(&settler->change, &settler->lock);
    const int code = tell(settler, error);
    pthread_mutex_unlock(&settler->lock);
    return code;
}

int output_settler_close(struct output_settler **settler, struct cloth_error *error)
{
    struct output_settler *gone = *settler;
    *settler = NULL;
    if (!gone)
        return CLOTH_OK;
    pthread_mutex_lock(&gone->lock);
    gone->ends = true;
    pthread_cond_broadcast(&gone->change);
    pthread_mutex_unlock(&gone->lock);
    pthread_join(gone->thread, NULL);
    const int code = tell(gone, error);
    output_settle_drop(gone);
    return code;
}

/* ---- Members ---- */

void output_member_add(struct output_member *member, struct output_settler *settler, uint32_t n)
{
    member->settler = settler;
    if (!settler)
        return;
    pthread_mutex_lock(&settler->lock);
    member->place = settler->n++;
    settler->member[member->place] = *member;
    settler->written[member->place] = settler->settled[member->place] = n;
    pthread_mutex_unlock(&settler->lock);
}

bool output_member_wait(const struct output_member *member, uint32_t n)
{
    struct output_settler *settler = member->settler;
    if (!settler)
        return true;
    pthread_mutex_lock(&settler->lock);
    while (settler->settled[member->place] < n && !settler->trouble.code)
        pthread_cond_wait(&settler->change, &settler->lock);
    const bool is_settled = settler->settled[member->place] >= n;
    pthread_mutex_unlock(&settler->lock);
    return is_settled;
}

int output_member_wrote(const struct output_member *member, uint32_t n, struct cloth_error *error)
{
    struct output_settler *settler = member->settler;
    if (!settler)
        return member->settle(member->context, n, error);
    pthread_mutex_lock(&settler->lock);
    settler->written[member->place] = n;
    settler->given++;
    pthread_cond_broadcast(&settler->change);
    while (n - settler->settled[member->place] > BEHIND && !settler->trouble.code)
        pthread_cond_wait(&settler->change, &settler->lock);
    const int code = tell(settler, error);
    pthread_mutex_unlock(&settler->lock);
    return code;
}
