/* The ring is read while the main thread writes it: the copy leaves out entries that may have been
 * overwritten meanwhile. */
#include "runtime/comm/history.h"

#include <string.h>

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
