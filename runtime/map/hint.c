/* What the program tells about objects that have no home yet. Every rank is told the same. */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/data/view.h"

#include <stdlib.h>

/* It exists and is no view, whose home is its object's. */
static int check_object(struct data_table *table, duite_object name, const char *call)
{
    const struct data_object *object = data_object_find(table, name);
    return object ? data_view_refuse(table, object, call) : DUITE_E_OBJECT;
}

static int check_weight(const char *what, double weight)
{
    if (weight >= 0 && weight <= 1e300)
        return DUITE_OK;
    return base_error(DUITE_E_ARGUMENT, "duite_hint: %s %g is not a finite number >= 0", what,
                      weight);
}

static int check_edges(struct data_table *table, size_t n, const duite_object *neighbours,
                       const double *edge_weights)
{
    if (n && !neighbours)
        return base_error(DUITE_E_ARGUMENT, "duite_hint: no neighbours given");
    for (size_t i = 0; i < n; i++) {
        int code = check_object(table, neighbours[i], "duite_hint");
        if (!code)
            code = check_weight("edge weight", edge_weights ? edge_weights[i] : 1);
        if (code)
            return code;
    }
    return DUITE_OK;
}

static int add_edges(struct data_hint *hint, size_t n, const duite_object *neighbours,
                     const double *edge_weights)
{
    uint32_t *neighbour = realloc(hint->neighbour, (hint->n + n) * sizeof *neighbour);
    if (neighbour)
        hint->neighbour = neighbour;
    double *edge = realloc(hint->edge_weight, (hint->n + n) * sizeof *edge);
    if (edge)
        hint->edge_weight = edge;
    if (!neighbour || !edge)
        return base_no_memory("a hint");
    for (size_t i = 0; i < n; i++) {
        neighbour[hint->n] = neighbours[i].slot;
        edge[hint->n++] = edge_weights ? edge_weights[i] : 1;
    }
    return DUITE_OK;
}

int map_hint(struct data_table *table, duite_object object, double weight, size_t n,
             const duite_object *neighbours, const double *edge_weights)
{
    int code = check_object(table, object, "duite_hint");
    if (!code)
        code = check_weight("weight", weight);
    if (!code)
        code = check_edges(table, n, neighbours, edge_weights);
    struct data_hint *hint = code ? NULL : data_hint_find(table, object.slot);
    if (!hint)
        return code;
    hint->weight = weight;
    return n ? add_edges(hint, n, neighbours, edge_weights) : DUITE_OK;
}

/* Is `object` on the chain of leaders that begins with `slot`? */
static bool follows(struct data_table *table, uint32_t slot, uint32_t object)
{
    while (slot != object) {
        const struct data_hint *hint = data_hint_find(table, slot);
        if (!hint || hint->leader == slot)
            return false;
        slot = hint->leader;
    }
    return true;
}

int map_follow(struct data_table *table, duite_object object, duite_object leader)
{
    int code = check_object(table, object, "duite_follow");
    if (!code)
        code = check_object(table, leader, "duite_follow");
    if (code)
        return code;
    struct data_hint *hint = data_hint_find(table, object.slot);
    if (follows(table, leader.slot, object.slot))
        return base_error(DUITE_E_ARGUMENT, "duite_follow: object %u.%u would follow itself",
                          object.slot, object.generation);
    if (hint)
        hint->leader = leader.slot;
    return DUITE_OK;
}
