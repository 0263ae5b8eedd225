/* A slot's generation is odd while an object lives in it and grows by one at birth and at death, so
 * that a stale name never fits again (until 2^31 objects have lived in one slot). */
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
    uint64_t *copies = base_grow(NULL, &table->copies_capacity, table->words, sizeof *copies);
    table->object = object;
    table->copies = copies;
    table->blocks = calloc((size_t)n_ranks, sizeof *table->blocks);
    if (!object || !copies || !table->blocks)
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
    for (uint32_t slot = 1; slot < table->n_slots; slot++)
        data_view_release(table->object[slot].view);
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
    void *moved = base_grow_lines(table->object, &table->capacity, (size_t)table->n_slots + 1,
                                  sizeof *table->object);
    if (!moved)
        return base_no_memory("the table of objects");
    table->object = moved;
    moved = base_grow(table->copies, &table->copies_capacity,
                      ((size_t)table->n_slots + 1) * table->words, sizeof *table->copies);
    if (!moved)
        return base_no_memory("the table of objects");
    table->copies = moved;
    moved = base_grow(table->vacant, &table->vacant_capacity, (size_t)table->n_slots + 1,
                      sizeof *table->vacant);
    if (!moved)
        return base_no_memory("the table of objects");
    table->vacant = moved;
    moved = base_grow(table->unsettled, &table->unsettled_capacity, table->n_unsettled + 1,
                      sizeof *table->unsettled);
    if (!moved)
        return base_no_memory("the table of objects");
    table->unsettled = moved;
    return DUITE_OK;
}

int data_object_refuse(duite_type type, size_t count, size_t max)
{
    size_t size = data_type_size(type);
    if (!size)
        return base_error(DUITE_E_ARGUMENT, "duite_new: %d is no element type", (int)type);
    if (!max)
        return base_error(DUITE_E_ARGUMENT, "duite_new: an object has at least one element");
    if (max > DATA_MAX_BYTES / size)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_new: %zu elements of %zu bytes are more than %zu bytes", max, size,
                          DATA_MAX_BYTES);
    if (count > max)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_new_sized: %zu elements are more than %zu at most", count, max);
    return DUITE_OK;
}

int data_object_new(struct data_table *table, duite_type type, size_t count, duite_object *name)
{
    *name = (duite_object){0, 0};
    int code = data_object_check(type, count, count);
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
                                   .count = count,
                                   .bytes = count * data_type_size(type),
                                   .max = count,
                                   .room = count * data_type_size(type),
                                   .home = -1,
                                   .hint = (uint32_t)table->n_unsettled,
                                   .holder = -1};
    table->unsettled[table->n_unsettled++] =
        (struct data_hint){.slot = slot, .leader = slot, .weight = 1};
    table->n_alive++;
    *name = (duite_object){slot, generation};
    return DUITE_OK;
}

int data_object_new_sized(struct data_table *table, duite_type type, size_t count, size_t max,
                          duite_object *name)
{
    *name = (duite_object){0, 0};
    int code = data_object_check(type, count, max);
    if (!code)
        code = data_object_new(table, type, max, name);
    if (code)
        return code;
    struct data_object *object = &table->object[name->slot];
    object->sized = true;
    object->count = count;
    object->bytes = count * data_type_size(type);
    return DUITE_OK;
}

struct data_object *data_object_missing(const struct data_table *table, duite_object name)
{
    const struct data_object *object =
        name.slot < table->n_slots ? &table->object[name.slot] : NULL;
    if (!name.slot)
        base_error(DUITE_E_OBJECT, "the object names nothing: was it made?");
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
    if (object->view)
        table->object[object->view->parent].n_views--;
    data_view_release(object->view);
    object->view = NULL;
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

/* ---- Views ---- */

/* The view's object is one like any other, but for its `view`; it counts in its parent's `n_views`
 * until it is dropped. */

static int view_check_indices(const struct data_object *parent, duite_object name, size_t n,
                              const size_t *indices)
{
    if (!n || !indices)
        return base_error(DUITE_E_ARGUMENT, "duite_view: %s",
                          n ? "no indices given" : "a view has at least one element");
    for (size_t i = 0; i < n; i++)
        if (indices[i] >= parent->count)
            return base_error(DUITE_E_VIEW,
                              "duite_view: index %zu of the list is %zu, and object %u.%u has %zu "
                              "elements",
                              i, indices[i], name.slot, name.generation, parent->count);
    return DUITE_OK;
}

static struct data_view *view_alloc(uint32_t parent, size_t n, const size_t *indices)
{
    if (n > (SIZE_MAX - sizeof(struct data_view)) / sizeof *indices)
        return NULL;
    struct data_view *view = base_alloc(sizeof *view + n * sizeof *indices);
    if (!view)
        return NULL;
    atomic_init(&view->refs, 1);
    view->parent = parent;
    view->seen = 0;
    view->n = n;
    memcpy(view->index, indices, n * sizeof *indices);
    return view;
}

int data_view_new(struct data_table *table, duite_object object, size_t n, const size_t *indices,
                  duite_object *name)
{
    *name = (duite_object){0, 0};
    const struct data_object *parent = data_object_find(table, object);
    if (!parent)
        return DUITE_E_OBJECT;
    int code = data_view_refuse(table, parent, "duite_view");
    if (code)
        return code;
    if (parent->sized)
        return base_error(DUITE_E_VIEW,
                          "duite_view: object %u.%u changes its size and cannot have views",
                          object.slot, object.generation);
    code = view_check_indices(parent, object, n, indices);
    struct data_view *view = code ? NULL : view_alloc(object.slot, n, indices);
    if (!view)
        return code ? code : base_no_memory("a view");
    code = data_object_new(table, parent->type, n, name);
    if (code) {
        data_view_release(view);
        return code;
    }
    table->object[name->slot].view = view;
    table->object[object.slot].n_views++;
    struct data_hint *hint = data_hint_find(table, name->slot);
    hint->leader = object.slot;
    hint->weight = 0;
    return DUITE_OK;
}

int data_view_refuse(const struct data_table *table, const struct data_object *object,
                     const char *call)
{
    if (!object->view)
        return DUITE_OK;
    duite_object name = data_object_name(table, object);
    duite_object parent = data_object_name(table, &table->object[object->view->parent]);
    return base_error(DUITE_E_VIEW,
                      "%s: object %u.%u is a view (of object %u.%u), which can only be read", call,
                      name.slot, name.generation, parent.slot, parent.generation);
}

/* The loops have constant sizes of elements. */
void data_view_gather(const struct data_view *view, size_t element, const void *from, void *to)
{
    const char *source = from;
    char *target = to;
    if (element == 8)
        for (size_t i = 0; i < view->n; i++)
            memcpy(target + 8 * i, source + 8 * view->index[i], 8);
    else if (element == 4)
        for (size_t i = 0; i < view->n; i++)
            memcpy(target + 4 * i, source + 4 * view->index[i], 4);
    else
        for (size_t i = 0; i < view->n; i++)
            memcpy(target + element * i, source + element * view->index[i], element);
}

void data_view_release(struct data_view *view)
{
    if (view && atomic_fetch_sub_explicit(&view->refs, 1, memory_order_acq_rel) == 1)
        base_free(view);
}
