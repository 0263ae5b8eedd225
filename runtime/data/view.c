/* The view's object is one like any other, but for its `view`; it counts in its parent's `n_views`
 * until it is dropped. */
#include "runtime/data/view.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

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
