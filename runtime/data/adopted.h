#ifndef DUITE_DATA_ADOPTED_H
#define DUITE_DATA_ADOPTED_H

#include "runtime/data/packet.h"

#include <duite.h>

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Memory in which an object's value lies and that is not the runtime's to free: the program's own,
 * or a part of another object's. Its packet passes from version to version like any other, so tasks
 * that write the object in turn work in place. Some values come in packets of the runtime's own:
 * those of a set, of another rank, after a failure. Then the memory rests, and gets a value back
 * when the program acquires or frees the object.
 *
 * The object holds it, and so does a version that has its packet, or a turn of the program that
 * reads there. The last of them to let go copies the last value to it and gives it back. */
struct data_adopted {
    struct data_packet packet;                  /* first: the bytes, and where they are */
    void (*back)(struct data_adopted *adopted); /* of a part: its end; NULL: it is the program's */
    duite_done *done;                           /* the program's, or NULL */
    void *user;                                 /* for these two */
    void (*rested)(void *context);              /* called when one lets go and it is not the last */
    void *context;
    struct data_packet *last; /* the last value, if it does not lie here; or NULL */
    _Atomic uint32_t holds;
};

/* The place of a part's memory until there is one: no value lies there. */
extern char data_nowhere[];

/* Adopts the bytes of `like`, elements of `size` bytes, for an object to hold. Errors:
 * DUITE_E_ARGUMENT (nothing there, not aligned to its elements, adopted already), memory. */
int data_adopted_new(const struct data_adopted *like, size_t size, struct data_adopted **adopted);

/* Its packet, for a version or a turn to hold. */
static inline struct data_packet *data_adopted_take(struct data_adopted *adopted)
{
    atomic_fetch_add_explicit(&adopted->holds, 1, memory_order_relaxed);
    return &adopted->packet;
}

/* One that holds it lets go: data_packet_free of its packet. Any thread. */
void data_adopted_rest(struct data_adopted *adopted);

/* True if the object alone holds it. Then its bytes may be written; all accesses are seen. */
static inline bool data_adopted_rests(const struct data_adopted *adopted)
{
    return atomic_load_explicit(&adopted->holds, memory_order_acquire) == 1;
}

/* The object lets go; it leaves this value, or none (NULL), and its hold on it. */
void data_adopted_leave(struct data_adopted *adopted, struct data_packet *last);

#pragma GCC visibility pop

#endif
