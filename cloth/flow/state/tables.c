/* A table is one piece of memory, so that it travels between ranks as it is: its shape alone
 * decides which arrays it has and where they lie. */
#include "cloth/flow/state/tables.h"

#include "cloth/flow/state/room.h"

#include <string.h>

static void lay_list(const struct flow_table *t, int i, struct flow_room *room,
                     struct element_list *list)
{
    const struct element_kind *kind = element_kinds[i];
    const size_t n = t->n_elements[i];
    *list = (struct element_list){.n = t->n_elements[i]};
    if (!n)
        return;
    list->corner = flow_room_next(room, n * sizeof *list->corner);
    list->at = flow_room_next(room, kind->pairs * n * sizeof *list->at);
    list->vector = flow_room_next(room, kind->vectors * n * sizeof *list->vector);
    for (uint32_t k = 0; k < ELEMENT_NUMBERS; k++)
        list->number[k] = flow_room_next(room, k < kind->numbers ? n * sizeof(double) : 0);
    list->material = flow_room_next(room, t->n_materials * kind->material_bytes);
}

static void lay(const struct flow_table *t, struct flow_room *room, struct flow_layout *layout)
{
    const size_t n = t->n, sides = (size_t)t->n_inner + t->n_cut;
    const size_t neighbours = (size_t)t->n_neighbours + 1;
    layout->load = flow_room_next(room, n * sizeof *layout->load);
    layout->position = flow_room_next(room, n * sizeof *layout->position);
    layout->velocity = flow_room_next(room, n * sizeof *layout->velocity);
    layout->mass = flow_room_next(room, n * sizeof *layout->mass);
    layout->drag = flow_room_next(room, n * sizeof *layout->drag);
    layout->free = flow_room_next(room, n * sizeof *layout->free);
    layout->stiffness = flow_room_next(room, sides * sizeof *layout->stiffness);
    layout->damping = flow_room_next(room, sides * sizeof *layout->damping);
    layout->length = flow_room_next(room, sides * sizeof *layout->length);
    layout->end = flow_room_next(room, sides * sizeof *layout->end);
    layout->ghost_end = flow_room_next(room, t->n_cut_entries * sizeof *layout->ghost_end);
    layout->held = flow_room_next(room, t->n_held * sizeof *layout->held);
    layout->vertex = flow_room_next(room, n * sizeof *layout->vertex);
    layout->row = flow_room_next(room, (n + 1) * sizeof *layout->row);
    layout->column = flow_room_next(room, t->n_entries * sizeof *layout->column);
    layout->halo = flow_room_next(room, t->n_halo * sizeof *layout->halo);
    layout->cut = flow_room_next(room, neighbours * sizeof *layout->cut);
    layout->cut_entry = flow_room_next(room, neighbours * sizeof *layout->cut_entry);
    layout->at = flow_room_next(room, t->format == SOLVE_SPRINGS ? 0 : sides * sizeof *layout->at);
    layout->n_held = flow_room_next(room, sizeof *layout->n_held);
    layout->moved = flow_room_next(room, t->n_moved * sizeof *layout->moved);
    layout->sliding = flow_room_next(room, t->n_sliding * sizeof *layout->sliding);
    layout->loose = flow_room_next(room, t->n_loose * sizeof *layout->loose);
    layout->varying = flow_room_next(room, t->n_varying * sizeof *layout->varying);
    layout->varying_force = flow_room_next(room, t->n_varying * sizeof *layout->varying_force);
    layout->watched = flow_room_next(room, t->n_watched * sizeof *layout->watched);
    layout->stretch = flow_room_next(room, sides);
    layout->pulled = flow_room_next(room, t->n_pulled * sizeof *layout->pulled);
    layout->corrected = flow_room_next(room, t->n_corrected * sizeof *layout->corrected);
    layout->corrected_cut =
        flow_room_next(room, t->n_corrected_cut * sizeof *layout->corrected_cut);
    for (int i = 0; i < ELEMENT_KINDS; i++)
        lay_list(t, i, room, layout->list + i);
}

size_t flow_table_bytes(const struct flow_table *table)
{
    struct flow_room room = {0};
    struct flow_layout layout;
    lay(table, &room, &layout);
    return room.used;
}

struct flow_layout flow_table_layout(const struct flow_table *table, void *memory)
{
    struct flow_room room = {.base = memory};
    struct flow_layout arrays;
    lay(table, &room, &arrays);
    return arrays;
}

void flow_table_open(struct flow_table *t, const void *memory)
{
    const struct flow_layout arrays = flow_table_layout(t, (void *)memory); /* it is only read */
    t->vertex = arrays.vertex;
    t->cut = arrays.cut;
    t->halo = arrays.halo;
    t->watched = arrays.watched;
    t->moved = (const uint32_t(*)[2])arrays.moved;
    t->sliding = (const uint32_t(*)[2])arrays.sliding;
    t->loose = (const uint32_t(*)[2])arrays.loose;
    t->varying = (const uint32_t(*)[2])arrays.varying;
    t->varying_force = arrays.varying_force;
    t->end = (const uint32_t(*)[2])arrays.end;
    t->ghost_end = (const uint32_t(*)[2])arrays.ghost_end;
    t->stiffness = arrays.stiffness;
    t->damping = arrays.damping;
    t->length = arrays.length;
    t->stretch = arrays.stretch;
    t->pulled = (const uint32_t(*)[2])arrays.pulled;
    t->corrected = arrays.corrected;
    t->corrected_cut = arrays.corrected_cut;
    t->cut_entry = arrays.cut_entry;
    t->at = arrays.at;
    t->matrix =
        (struct solve_block){t->n, NULL, arrays.free, arrays.row, arrays.column, t->format, NULL};
    t->held = (struct solve_held){*arrays.n_held, (const uint32_t(*)[2])arrays.held};
    t->mass = arrays.mass;
    t->drag = arrays.drag;
    t->free = arrays.free;
    t->load = arrays.load;
    t->position = arrays.position;
    t->velocity = arrays.velocity;
    memcpy(t->list, arrays.list, sizeof t->list);
}

uint32_t flow_table_ghost(const struct flow_table *t, uint32_t s, uint32_t row)
{
    uint32_t low = t->ghost_start[s], high = t->ghost_start[s + 1];
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (t->ghost[middle] <= row)
            low = middle;
        else
            high = middle;
    }
    return low;
}
