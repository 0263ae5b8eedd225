#ifndef DUITE_DATA_VIEW_H
#define DUITE_DATA_VIEW_H

#include "runtime/data/object.h"

/* Views: an index list of an object, and the object of its own that has the listed elements. That
 * one is written by nobody but the task that gathers them (task/objects.c). The list is shared by
 * the view, tasks that gather, and plans; it never changes. */
struct data_view {
    _Atomic uint32_t refs;
    /* Main thread only. */
    uint32_t parent; /* slot; alive as long as the view is */
    uint64_t seen;   /* version of the parent that was gathered last, plus 1 */
    /* Anybody who holds it. */
    size_t n;
    size_t index[];
};

/* Makes a view of the object, which has the object's home. Errors: DUITE_E_OBJECT, DUITE_E_VIEW,
 * DUITE_E_ARGUMENT, memory. */
int data_view_new(struct data_table *table, duite_object object, size_t n, const size_t *indices,
                  duite_object *name);

/* DUITE_E_VIEW, with the sentence set, if the object is a view. */
int data_view_refuse(const struct data_table *table, const struct data_object *object,
                     const char *call);

/* Writes the listed elements, of so many bytes each. */
void data_view_gather(const struct data_view *view, size_t element, const void *from, void *to);

static inline struct data_view *data_view_hold(struct data_view *view)
{
    atomic_fetch_add_explicit(&view->refs, 1, memory_order_relaxed);
    return view;
}

void data_view_release(struct data_view *view); /* NULL is fine */

#endif
