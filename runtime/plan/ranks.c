/* A plan of several ranks: each has its own nodes. All agree, without messages, where each object's
 * value must be when a round begins, and where it is after the last one. Objects that are not
 * written stay on their readers. The value of a written object lies on its last writer's ranks
 * before and after each round, and goes from there to its first readers. */
#include "runtime/plan/plan.h"
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

static bool ranks_room(struct plan *plan, size_t words)
{
    const struct base_array arrays[] = {BASE_ZEROS(plan->enter, plan->n_objects * words),
                                        BASE_ZEROS(plan->end, plan->n_objects * words),
                                        BASE_ARRAY(plan->home, plan->n_objects),
                                        {0}};
    plan->words = words;
    return (plan->sets = base_arrays(arrays)) != NULL;
}

static void ranks_take_sets(struct plan *plan, const struct plan_record *record,
                            const struct plan_messages *messages)
{
    const struct plan_assignment *a = messages->assignment;
    size_t bytes = plan->words * sizeof(uint64_t);
    for (uint32_t i = 0; i < plan->n_objects; i++) {
        uint64_t *enter = plan->enter + i * plan->words, *end = plan->end + i * plan->words;
        uint32_t maker = plan_maker(a, i);
        plan->home[i] = a->home[i];
        if (maker == PLAN_NONE) {
            memcpy(enter, plan_needs_set(a, i), bytes);
        } else {
            memcpy(end, plan_runs_set(a, maker), bytes);
            if (record->object[i].reads_old)
                memcpy(enter, end, bytes);
        }
    }
    for (size_t n = 0; n < a->round->n_nodes; n++)
        if ((int)messages->phase[n] >= plan->channels.phases)
            plan->channels.phases = (int)messages->phase[n] + 1;
}

/* The homes of a round's objects; NULL without memory. */
static int *ranks_find_homes(const struct plan *plan, const struct plan_record *record,
                             const duite_object *flag)
{
    int *home = base_alloc((plan->n_objects + 1) * sizeof *home);
    for (size_t i = 0; i < plan->n_objects && home; i++) {
        duite_object name = i < record->n_objects ? record->object[i].bound : *flag;
        home[i] = plan->graph->table.object[name.slot].home;
    }
    return home;
}

bool plan_of_ranks(struct plan *plan, const struct plan_round *round, struct plan_round *part,
                   const struct plan_record *record, const duite_object *flag)
{
    struct plan_assignment assignment = {0};
    struct plan_messages messages = {0};
    int *home = ranks_find_homes(plan, record, flag);
    bool fine = home && plan_assign(&assignment, round, home, plan->graph->n_ranks) &&
                ranks_room(plan, assignment.words) &&
                plan_messages_find(&messages, &assignment, plan->graph->rank) &&
                plan_part(part, &messages);
    if (fine)
        ranks_take_sets(plan, record, &messages);
    base_free(home);
    plan_messages_free(&messages);
    plan_assignment_free(&assignment);
    return fine;
}

int plan_open(struct plan *plan, const struct plan_round *part)
{
    struct comm_channel_set *channels = &plan->channels;
    channels->channel = base_alloc((part->n_channels + 1) * sizeof *channels->channel);
    if (!channels->channel)
        return base_no_memory("the messages of a recorded graph");
    channels->n = part->n_channels;
    for (size_t i = 0; i < part->n_nodes; i++) {
        struct task *task = plan_task(plan, i);
        if (!task_is_channel(task))
            continue;
        const struct plan_round_node *from = &part->node[i];
        struct comm_channel *channel = &channels->channel[from->channel];
        *channel = (struct comm_channel){.node = task,
                                         .peer = from->peer,
                                         .tag = (int)from->phase,
                                         .sends = from->kind == PLAN_SEND,
                                         .bytes = plan_channel_room(plan, task)};
        task->node->channel = channel;
    }
    return comm_channels_open(plan->graph->comm, channels);
}

bool plan_at_home(struct plan *plan, const struct plan_record *record)
{
    const struct data_table *table = &plan->graph->table;
    const uint64_t now = table->changes + 1;
    for (size_t i = 0; plan->words && i < record->n_objects && plan->at_home != now; i++) {
        plan_prefetch(record, i + PLAN_AHEAD);
        if (table->object[record->object[i].bound.slot].home != plan->home[i])
            return false;
    }
    plan->at_home = now;
    return true;
}

static bool ranks_has(const struct plan *plan, const uint64_t *sets, size_t i, int rank)
{
    return base_ranks_has(sets + i * plan->words, rank);
}

/* The first rank of set i that is not below `from`, or -1. */
static int ranks_next(const struct plan *plan, const uint64_t *sets, size_t i, int from)
{
    return base_ranks_next(sets + i * plan->words, plan->words, from);
}

int plan_fetch(const struct plan *plan, struct worker *worker, size_t i, struct data_object *object)
{
    int code = DUITE_OK, rank = -1;
    while (!code && (rank = ranks_next(plan, plan->enter, i, rank + 1)) >= 0)
        code = task_fetch(plan->graph, worker, object, rank);
    return code;
}

/* The home holds the object if it is one of the ranks that have it, else the first of them does. */
bool plan_moves(const struct plan *plan, size_t i, struct data_object *object)
{
    const int first = ranks_next(plan, plan->end, i, 0);
    if (first < 0)
        return false;
    const int holder = ranks_has(plan, plan->end, i, object->home) ? object->home : first;
    object->number++;
    data_object_moved(object, holder);
    for (int rank = first; rank >= 0; rank = ranks_next(plan, plan->end, i, rank + 1))
        if (rank != holder)
            data_object_add_copy(&plan->graph->table, object, rank);
    return true;
}

duite_mode plan_mode(const struct plan *plan, size_t i)
{
    int rank = plan->graph->rank;
    bool enters = ranks_has(plan, plan->enter, i, rank);
    if (ranks_has(plan, plan->end, i, rank))
        return enters ? DUITE_RW : DUITE_W;
    return enters ? DUITE_R : DUITE_NONE;
}
