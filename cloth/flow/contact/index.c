/* An index behind the contacts of a block lists them by the blocks of their corners, so that no
 * block searches all contacts of others. It has n + 2 numbers for n blocks: number b is the begin
 * of block b's contacts, number b + 1 their end. The places of contacts in the list follow,
 * ascending for each block. */
#include "cloth/flow/contact/contact.h"

static uint32_t *index_of(const struct flow_list *list)
{
    const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
    return (uint32_t *)(void *)(contact + list->n); /* readers do not write */
}

size_t flow_contact_index_room(size_t n, uint32_t n_blocks)
{
    return flow_list_bytes(n, sizeof(struct flow_contact)) +
           (n_blocks + 2 + SOLVE_TIE_CORNERS * n) * sizeof(uint32_t);
}

/* True if no earlier corner is in the block of corner k. */
static bool contact_index_is_first(const struct flow_tie_corners *at, uint32_t k)
{
    bool first = true;
    for (uint32_t j = 0; j < k; j++)
        first = first && at->block[j] != at->block[k];
    return first;
}

size_t flow_contact_index(struct flow_list *list, uint32_t n_blocks)
{
    const struct flow_contact *contact = (const struct flow_contact *)(list + 1);
    uint32_t *start = index_of(list), *place = start + n_blocks + 2;
    memset(start, 0, (n_blocks + 2) * sizeof *start);
    for (uint32_t i = 0; i < list->n; i++)
        for (uint32_t k = 0; k < contact[i].at.n; k++)
            start[contact[i].at.block[k] + 2] += contact_index_is_first(&contact[i].at, k);
    for (uint32_t b = 0; b < n_blocks; b++)
        start[b + 2] += start[b + 1];
    for (uint32_t i = 0; i < list->n; i++)
        for (uint32_t k = 0; k < contact[i].at.n; k++)
            if (contact_index_is_first(&contact[i].at, k))
                place[start[contact[i].at.block[k] + 1]++] = i;
    return (size_t)((char *)(place + start[n_blocks]) - (char *)list);
}

const uint32_t *flow_contact_of(const struct flow_list *list, uint32_t block, uint32_t n_blocks,
                                size_t *n)
{
    const uint32_t *start = index_of(list);
    *n = list->n ? start[block + 1] - start[block] : 0;
    return *n ? start + n_blocks + 2 + start[block] : NULL;
}
