#ifndef DUITE_OFFLOAD_NAMES_H
#define DUITE_OFFLOAD_NAMES_H

#include <stddef.h>
#include <stdint.h>

/* Names of tasks that run on another rank: a number, never an address, travels with a task and
 * comes back with its result. A name is a slot and its generation, which grows whenever the slot is
 * given back. So a name that came twice, or was never given, names no task. Callers lock. */

struct offload_pending;

struct offload_name {
    struct offload_pending *pending; /* NULL: the slot is free */
    uint32_t generation;             /* of the task that has the slot, or will have it next */
    uint32_t next;                   /* of the free ones: index + 1, or 0 */
};

/* Empty: all zero. */
struct offload_names {
    struct offload_name *slot;
    size_t capacity;
    uint32_t n;       /* slots that were ever used */
    uint64_t refused; /* names that came and named no task */
    uint32_t free;    /* index + 1 of the first free one, or 0 */
};

/* Gives the task a name, which is never 0. 0: no memory. */
uint64_t offload_name_give(struct offload_names *names, struct offload_pending *pending);

/* Gives up the name and returns its task; NULL: it names none, which `refused` counts. */
struct offload_pending *offload_name_take(struct offload_names *names, uint64_t name);

void offload_names_free(struct offload_names *names);

#endif
