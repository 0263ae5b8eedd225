#ifndef CLOTH_FLOW_STATE_ROOM_H
#define CLOTH_FLOW_STATE_ROOM_H

#include <stddef.h>

/* Arrays that lie one after the other in one piece of memory, each on a line of its own: so a table
 * travels between ranks as it is. */
enum { FLOW_LINE = 64 };

/* The place of the next array: base NULL only counts. */
struct flow_room {
    char *base;
    size_t used;
};

/* The next array, of so many bytes. */
static inline void *flow_room_next(struct flow_room *room, size_t bytes)
{
    char *here = room->base ? room->base + room->used : NULL;
    room->used += (bytes + FLOW_LINE - 1) / FLOW_LINE * FLOW_LINE;
    return here;
}

#endif
