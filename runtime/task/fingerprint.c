/* The ring is read while the main thread writes it: the copy leaves out entries that may have been
 * overwritten meanwhile. */
#include "runtime/task/fingerprint.h"

#include <string.h>

static const char *const CALLED_NAMES[TASK_N_CALLED] = {
    [TASK_CALLED_OTHER] = "a function of duite",
    [TASK_CALLED_NEW] = "duite_new",
    [TASK_CALLED_NEW_SIZED] = "duite_new_sized",
    [TASK_CALLED_HINT] = "duite_hint",
    [TASK_CALLED_COLOCATE] = "duite_colocate",
    [TASK_CALLED_SET] = "duite_set",
    [TASK_CALLED_FREE] = "duite_free",
    [TASK_CALLED_GRAPH_BIND] = "duite_graph_bind",
    [TASK_CALLED_GRAPH_FREE] = "duite_graph_free",
    [TASK_CALLED_REPLAY] = "duite_replay",
    [TASK_CALLED_REPLAY_WHILE] = "duite_replay_while",
    [TASK_CALLED_GET] = "duite_get",
    [TASK_CALLED_GET_AT] = "duite_get_at",
    [TASK_CALLED_GET_COUNT] = "duite_get_count",
    [TASK_CALLED_WAIT] = "duite_wait",
    [TASK_CALLED_STOP] = "duite_stop",
    [TASK_CALLED_COUNT_ALL] = "duite_count_all",
};

enum task_called task_called_find(const char *name)
{
    for (int i = 0; i < TASK_N_CALLED; i++)
        if (!strcmp(CALLED_NAMES[i], name))
            return (enum task_called)i;
    return TASK_CALLED_OTHER;
}

const char *task_called_name(uint32_t called)
{
    return CALLED_NAMES[called < TASK_N_CALLED ? called : TASK_CALLED_OTHER];
}

void task_history_read(struct task_history *history, struct task_history_copy *copy)
{
    copy->last = atomic_load_explicit(&history->calls, memory_order_acquire);
    for (size_t i = 0; i < TASK_HISTORY_CALLS; i++) {
        struct task_history_entry *entry = &history->entry[i];
        copy->entry[i].fingerprint =
            atomic_load_explicit(&entry->fingerprint, memory_order_acquire);
        copy->entry[i].call = atomic_load_explicit(&entry->call, memory_order_acquire);
    }
    /* The call after the last one counted may be in the middle of being written. */
    const uint64_t begun = atomic_load_explicit(&history->calls, memory_order_acquire) + 1;
    copy->first = begun >= TASK_HISTORY_CALLS ? begun - TASK_HISTORY_CALLS + 1 : 1;
}
