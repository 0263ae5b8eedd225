#ifndef DUITE_DATA_OBJECT_H
#define DUITE_DATA_OBJECT_H

#include "runtime/base/memory.h"
#include "runtime/data/sum.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Shared objects as every rank knows them. Only the main thread reads and writes this table. Its
 * knowledge of other ranks follows from the forks, which are the same everywhere: no rank is ever
 * asked. */
struct data_object {
    /* One cache line holds all that a replay, or a fork of another rank's task, reads and
     * writes. */
    uint32_t generation; /* even: the slot is free */
    int home;            /* -1: not decided yet */
    int holder;          /* the rank that has the current version for certain */
    bool copied;         /* some rank beside the holder has a copy: `copies` says which */
    bool sized;          /* its versions differ in size */
    bool fixed;          /* a task of a fixed kernel ran for it, or its memory is the program's:
                            its home does not change */
    bool adopted;        /* its memory is the program's, or another object's */
    uint64_t number;     /* of the current version: writes so far */
    struct data_version *current; /* this rank's copy of the current version, or NULL */
    uint64_t leaves;              /* contributions forked since the last other access;
                                     DATA_VACANT */
    uint64_t mark;                /* the last fork that named it: one task names an object once */
    uint32_t block;               /* its place among the leaders with its home, in the order they
                                     were made; followers share their leader's */
    uint32_t hint;                /* while home is -1: its place in `unsettled` */
    const duite_law *law;         /* of the contributions */
    /* The second line. */
    struct data_sum *sum; /* those that concern this rank, or NULL */
    duite_type type;
    bool part;                   /* it is one of another object (task/parts.c) */
    size_t count, bytes;         /* at first, when all elements are zero */
    size_t max, room;            /* elements and bytes of the largest version */
    struct data_adopted *memory; /* at home, of an adopted one, or of a part */
    struct task_split *split;    /* into its parts; NULL: it is whole */
};
_Static_assert(sizeof(struct data_object) == 2 * BASE_LINE,
               "in the table, which begins at a cache line, each object does");

/* `leaves` of a free slot: a slot without leaves is thus in use, and needs no other check. */
#define DATA_VACANT UINT64_C(1)

/* The program's hints about an object, kept until its home is settled. */
struct data_hint {
    uint32_t slot, leader;
    double weight;
    size_t n;
    uint32_t *neighbour; /* slots */
    double *edge_weight;
};

struct data_table {
    int n_ranks;
    struct data_object *object; /* by slot; slot 0 stays free, so that {0, 0} names nothing */
    uint64_t *copies; /* a set of ranks a slot: those with a copy of the current version */
    size_t words, capacity, copies_capacity;
    uint32_t n_slots, n_alive;
    uint32_t *vacant; /* freed slots */
    size_t n_vacant, vacant_capacity;
    struct data_hint *unsettled; /* objects without a home, in the order they were made */
    size_t n_unsettled, unsettled_capacity;
    uint32_t *blocks; /* by rank: how many leaders got their home there so far */
    uint64_t changes; /* of names and homes so far: objects freed, homes given. Results of lookups
                         by name hold until the next change */
    uint64_t settled; /* objects that got a home by the mapping so far */
    uint64_t homes;   /* a hash of these homes: the same on every rank */
};

int data_table_start(struct data_table *table, int n_ranks);
void data_table_stop(struct data_table *table);

/* Checks an object's type and counts. Errors: type, count. data_object_refuse is the whole check,
 * and names the call; data_object_check accepts clear cases at once. */
int data_object_refuse(const char *call, duite_type type, size_t count, size_t max);
static inline int data_object_check(duite_type type, size_t count, size_t max)
{
    enum { LARGEST_TYPE = 16 };
    const bool fits = data_type_size(type) && max && max <= DATA_MAX_BYTES / LARGEST_TYPE;
    return fits && count <= max ? 0 : data_object_refuse("duite_new", type, count, max);
}

/* Makes an object without a home, of `count` zeros. sized: its versions have 0 to `max` elements;
 * else max is count. Errors: type, count, memory. */
int data_object_new(struct data_table *table, duite_type type, size_t count, size_t max, bool sized,
                    duite_object *name);
/* Makes an object of a fixed size whose home is settled: `home`, or that of a leader, whose block
 * it joins. Errors: as above. */
int data_object_new_at(struct data_table *table, duite_type type, size_t count, int home,
                       const uint32_t *leader, duite_object *name);

/* Zeroes the object in two parts: for all its bytes at once gcc uses a string instruction, which
 * starts more slowly than these few words are written. */
static inline void data_object_clear(struct data_object *object)
{
    enum { HALF = sizeof *object / 2 };
    memset(object, 0, HALF);
    memset((char *)object + HALF, 0, sizeof *object - HALF);
}

/* Sets the error message for a name without an object. Returns NULL. */
struct data_object *data_object_missing(const struct data_table *table, duite_object name);

/* The object of that name in a table of n_slots, or NULL; `closed`: also if it has contributions.
 * data_object_find also sets the error's message. */
static inline struct data_object *data_object_used(struct data_object *first, uint32_t n_slots,
                                                   duite_object name, bool closed)
{
    struct data_object *object = &first[name.slot];
    const bool used = name.slot < n_slots && object->generation == name.generation &&
                      (closed ? !object->leaves : name.generation % 2);
    return used ? object : NULL;
}
static inline struct data_object *data_object_here(struct data_table *table, duite_object name)
{
    return data_object_used(table->object, table->n_slots, name, false);
}
static inline struct data_object *data_object_find(struct data_table *table, duite_object name)
{
    struct data_object *object = data_object_here(table, name);
    return object ? object : data_object_missing(table, name);
}

/* Takes the name out of use. The caller has released `current`. */
void data_object_drop(struct data_table *table, duite_object name);

/* Copies of the current version. The functions tell whether a rank has one, note that a rank has
 * one, and note that only the new holder has one. */
bool data_object_has_copy(const struct data_table *table, const struct data_object *object,
                          int rank);
void data_object_add_copy(struct data_table *table, struct data_object *object, int rank);
static inline void data_object_moved(struct data_object *object, int holder)
{
    object->holder = holder;
    object->copied = false;
}

/* The holder hands its copy on to rank `to`, which has one, and keeps none. */
void data_object_hand_on(const struct data_table *table, struct data_object *object, int to);

/* A version of the object, as of data_version_new. */
static inline struct data_version *data_object_version(const struct data_object *object)
{
    return data_version_new(object->type, object->max, object->sized, object->adopted);
}

/* The hint of the object in a slot, or NULL if its home is settled. The slot is not free. */
struct data_hint *data_hint_find(const struct data_table *table, uint32_t slot);

/* Gives an object a home: settle gives it `home`, join the home of its leader, which has one. Its
 * hint no longer counts. */
void data_object_settle(struct data_table *table, uint32_t slot, int home);
void data_object_join(struct data_table *table, uint32_t slot, uint32_t leader);

/* All objects have homes: forgets their hints. */
void data_hints_forget(struct data_table *table);

#pragma GCC visibility pop

#endif
