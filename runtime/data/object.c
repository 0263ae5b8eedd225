/* A slot's generation is odd while an object lives in it. It grows by one at birth and at death, so
 * a stale name never fits again (until 2^31 objects have lived in one slot). */
#include "runtime/data/object.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"

#include <stdlib.h>
#include <string.h>

int data_table_start(struct data_table *table, int n_ranks)
{
    memset(table, 0, sizeof *table);
    table->n_ranks = n_ranks;
    table->words = base_ranks_words(n_ranks);
    table->n_slots = 1;
    struct data_object *object =
        base_grow_lines(NULL, &table->capacity, table->n_slots, sizeof *table->object);
    table->object = object;
    table->blocks = calloc((size_t)n_ranks, sizeof *table->blocks);
    if (!object || !table->blocks ||
        !BASE_GROW(table->copies, table->copies_capacity, table->words))
        return base_no_memory("the table of objects");
    object[0] = (struct data_object){.leaves = DATA_VACANT};
    return DUITE_OK;
}

static void hint_clear(struct data_hint *hint)
{
    free(hint->neighbour);
    free(hint->edge_weight);
    memset(hint, 0, sizeof *hint);
}

void data_table_stop(struct data_table *table)
{
    data_hints_forget(table);
    free(table->unsettled);
    free(table->vacant);
    free(table->blocks);
    free(table->copies);
    base_free(table->object);
    memset(table, 0, sizeof *table);
}

/* Room for one more slot and its bookkeeping. */
static int table_reserve(struct data_table *table)
{
    const size_t slots = (size_t)table->n_slots + 1;
    void *moved = base_grow_lines(table->object, &table->capacity, slots, sizeof *table->object);
    if (!moved)
        return base_no_memory("the table of objects");
    table->object = moved;
    return BASE_GROW(table->copies, table->copies_capacity, slots * table->words) &&
                   BASE_GROW(table->vacant, table->vacant_capacity, slots) &&
                   BASE_GROW(table->unsettled, table->unsettled_capacity, table->n_unsettled + 1)
               ? DUITE_OK
               : base_no_memory("the table of objects");
}

int data_object_refuse(const char *call, duite_type type, size_t count, size_t max)
{
    size_t size = data_type_size(type);
    if (!size)
        return base_error(DUITE_E_ARGUMENT, "%s: %d is no element type", call, (int)type);
    if (!max)
        return base_error(DUITE_E_ARGUMENT, "%s: an object has at least one element", call);
    if (max > SIZE_MAX / 2)
        return base_error(DUITE_E_ARGUMENT, "%s: the number of elements is negative: %td", call,
                          (ptrdiff_t)max);
    if (max > DATA_MAX_BYTES / size)
        return base_error(DUITE_E_ARGUMENT, "%s: %zu elements of %zu bytes are more than %zu bytes",
                          call, max, size, DATA_MAX_BYTES);
    if (count > max)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_new_sized: %zu elements are more than %zu at most", count, max);
    return DUITE_OK;
}

int data_object_new(struct data_table *table, duite_type type, size_t count, size_t max, bool sized,
                    duite_object *name)
{
    const size_t size = data_type_size(type);
    *name = (duite_object){0, 0};
    int code = data_object_check(type, count, max);
    if (!code)
        code = table_reserve(table);
    if (code)
        return code;
    uint32_t slot = table->n_vacant ? table->vacant[--table->n_vacant] : table->n_slots;
    struct data_object *object = &table->object[slot];
    if (slot == table->n_slots) {
        table->n_slots++;
        memset(object, 0, sizeof *object);
    }
    uint32_t generation = object->generation + 1;
    *object = (struct data_object){.generation = generation,
                                   .type = type,
                                   .sized = sized,
                                   .count = count,
                                   .bytes = count * size,
                                   .max = max,
                                   .room = max * size,
                                   .home = -1,
                                   .hint = (uint32_t)table->n_unsettled,
                                   .holder = -1};
    table->unsettled[table->n_unsettled++] =
        (struct data_hint){.slot = slot, .leader = slot, .weight = 1};
    table->n_alive++;
    *name = (duite_object){slot, generation};
    return DUITE_OK;
}

int data_object_new_at(struct data_table *table, duite_type type, size_t count, int home,
                       const uint32_t *leader, duite_object *name)
{
    const int code = data_object_new(table, type, count, count, false, name);
    if (code)
        return code;
    table->n_unsettled--; /* the last of these */
    if (leader)
        data_object_join(table, name->slot, *leader);
    else
        data_object_settle(table, name->slot, home);
    return DUITE_OK;
}

struct data_object *data_object_missing(const struct data_table *table, duite_object name)
{
    const struct data_object *object =
        name.slot < table->n_slots ? &table->object[name.slot] : NULL;
    if (!name.slot)
        base_error(DUITE_E_OBJECT, "the object names nothing: was it made?");
    else if (object && object->split && name.generation + 1 == object->generation)
        base_error(DUITE_E_OBJECT,
                   "object %u.%u is split: until duite_join only its parts may be named", name.slot,
                   name.generation);
    else if (object && name.generation < object->generation)
        base_error(DUITE_E_OBJECT, "object %u.%u was freed", name.slot, name.generation);
    else
        base_error(DUITE_E_OBJECT, "object %u.%u was never made", name.slot, name.generation);
    return NULL;
}

struct data_hint *data_hint_find(const struct data_table *table, uint32_t slot)
{
    const struct data_object *object = &table->object[slot];
    return object->home < 0 ? &table->unsettled[object->hint] : NULL;
}

void data_object_settle(struct data_table *table, uint32_t slot, int home)
{
    struct data_object *object = &table->object[slot];
    object->home = object->holder = home;
    table->changes++;
    object->block = table->blocks[home]++;
}

void data_object_join(struct data_table *table, uint32_t slot, uint32_t leader)
{
    struct data_object *object = &table->object[slot];
    object->home = object->holder = table->object[leader].home;
    object->block = table->object[leader].block;
    table->changes++;
}

void data_hints_forget(struct data_table *table)
{
    for (size_t i = 0; i < table->n_unsettled; i++)
        hint_clear(&table->unsettled[i]);
    table->n_unsettled = 0;
}

void data_object_drop(struct data_table *table, duite_object name)
{
    struct data_object *object = &table->object[name.slot];
    object->generation++;
    table->changes++;
    object->leaves = DATA_VACANT;
    object->current = NULL;
    table->vacant[table->n_vacant++] = name.slot;
    table->n_alive--;
}

static uint64_t *object_copies(const struct data_table *table, const struct data_object *object)
{
    return table->copies + (size_t)(object - table->object) * table->words;
}

bool data_object_has_copy(const struct data_table *table, const struct data_object *object,
                          int rank)
{
    if (rank == object->holder || !object->copied)
        return rank == object->holder;
    return base_ranks_has(object_copies(table, object), rank);
}

void data_object_hand_on(const struct data_table *table, struct data_object *object, int to)
{
    int from = object->holder;
    if (object->copied)
        base_ranks_remove(object_copies(table, object), from);
    object->holder = to;
}

void data_object_add_copy(struct data_table *table, struct data_object *object, int rank)
{
    uint64_t *copies = object_copies(table, object);
    if (!object->copied)
        base_ranks_clear(copies, table->words);
    object->copied = true;
    base_ranks_add(copies, rank);
}
