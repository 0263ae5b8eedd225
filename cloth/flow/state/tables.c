/* A table is one piece of memory, so that it travels between ranks as it is: its shape alone
 * decides which arrays it has and where they lie. */
#include "cloth/flow/state/tables.h"

#include "cloth/base/order.h"
#include "cloth/flow/state/room.h"

#include <string.h>

static void lay_list(const struct flow_table *t, int i, struct flow_room *room,
                     struct phys_elements *list)
{
    const struct element_kind *kind = element_kinds[i];
    const size_t n = t->n_elements[i];
    *list = (struct phys_elements){.n = t->n_elements[i]};
    if (!n)
        return;
    list->corner = flow_room_next(room, n * sizeof *list->corner);
    list->at = flow_room_next(room, kind->pairs * n * sizeof *list->at);
    list->vector = flow_room_next(room, kind->vectors * n * sizeof *list->vector);
    for (uint32_t k = 0; k < PHYS_NUMBERS; k++)
        list->number[k] = flow_room_next(room, k < kind->numbers ? n * sizeof(double) : 0);
    list->material = flow_room_next(room, t->n_materials * kind->material_bytes);
}

static void lay_table(const struct flow_table *t, struct flow_room *room,
                      struct flow_layout *layout)
{
    const size_t sides = (size_t)t->n_inner + t->n_cut;
#define LAY(type, name, rows) layout->name = flow_room_next(room, (rows) * sizeof *layout->name);
#define LAY_PAIRS(name, rows) LAY(, name, rows)
    FLOW_TABLE_ARRAYS(LAY, LAY_PAIRS)
    for (int i = 0; i < ELEMENT_KINDS; i++)
        lay_list(t, i, room, layout->list + i);
}

size_t flow_table_bytes(const struct flow_table *table)
{
    struct flow_room room = {0};
    struct flow_layout layout;
    lay_table(table, &room, &layout);
    return room.used;
}

struct flow_layout flow_table_layout(const struct flow_table *table, void *memory)
{
    struct flow_room room = {.base = memory};
    struct flow_layout arrays;
    lay_table(table, &room, &arrays);
    return arrays;
}

void flow_table_open(struct flow_table *t, const void *memory)
{
    const struct flow_layout arrays = flow_table_layout(t, (void *)memory); /* it is only read */
#define OPEN(type, name, rows) t->name = arrays.name;
#define OPEN_PAIRS(name, rows) t->name = (const uint32_t(*)[2])arrays.name;
    FLOW_TABLE_ARRAYS(OPEN, OPEN_PAIRS)
    t->matrix = (struct solve_block){.n = t->n,
                                     .free = t->free,
                                     .row = t->row,
                                     .column = t->column,
                                     .span = t->span,
                                     .format = t->format};
    t->held = (struct solve_held){*t->held_entries, t->held_at};
    memcpy(t->list, arrays.list, sizeof t->list);
}

uint32_t flow_table_ghost(const struct flow_table *t, uint32_t s, uint32_t row)
{
    const uint32_t first = t->ghost_start[s];
    return first + cloth_first_from(t->ghost + first, 1, t->ghost_start[s + 1] - first, row);
}
