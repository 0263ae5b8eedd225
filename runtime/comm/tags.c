/* A plan's tags must be the same on all ranks, though plans end at other moments on each of them.
 * So tags depend on the main program's calls alone, which are the same everywhere. They are handed
 * out upwards. Tags below the next one are handed out again only after all ranks met and closed the
 * plans that the program dropped. */
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

static const struct comm_tag_range *range_over(const struct comm_tags *tags, int first, int n)
{
    for (size_t i = 0; i < tags->n; i++)
        if (tags->range[i].first < first + n && first < tags->range[i].first + tags->range[i].n)
            return &tags->range[i];
    return NULL;
}

int comm_tags_take(struct comm_tags *tags, int n, int *first)
{
    const struct comm_tag_range *taken;
    *first = tags->next;
    while (*first <= tags->last - n && (taken = range_over(tags, *first, n)))
        *first = taken->first + taken->n;
    if (*first > tags->last - n)
        return COMM_NEEDS_TAGS;
    if (!BASE_GROW(tags->range, tags->capacity, tags->n + 1))
        return base_no_memory("the tags of a recorded graph");
    tags->range[tags->n++] = (struct comm_tag_range){*first, n, false};
    tags->next = *first + n;
    return DUITE_OK;
}

static void range_remove(struct comm_tags *tags, size_t i)
{
    tags->range[i] = tags->range[--tags->n];
}

void comm_tags_drop(struct comm_tags *tags, int first)
{
    size_t i = 0;
    while (tags->range[i].first != first)
        i++;
    if (first < tags->next)
        range_remove(tags, i);
    else
        tags->range[i].dropped = true;
}

void comm_channels_met(struct comm *comm)
{
    struct comm_tags *tags = &comm->channels.tags;
    for (size_t i = tags->n; i-- > 0;)
        if (tags->range[i].dropped)
            range_remove(tags, i);
    tags->next = COMM_CHANNELS;
}

size_t comm_tags_held(const struct comm_tags *tags)
{
    size_t held = 0;
    for (size_t i = 0; i < tags->n; i++)
        held += !tags->range[i].dropped;
    return held;
}
