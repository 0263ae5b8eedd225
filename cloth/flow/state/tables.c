/* A table is one piece of memory, so that it travels between ranks as it is: what its arrays are
 * and where they lie follows from the shape alone. */
#include "cloth/flow/state/tables.h"

#include <string.h>

enum { LINE = 64 };

/* Where arrays go: base NULL only counts. */
struct room {
    char *base;
    size_t used;
};

/* The next array of `bytes`; each begins on a line of its own. */
static void *next(struct room *room, size_t bytes)
{
    char *here = room->base ? room->base + room->used : NULL;
    room->used += (bytes + LINE - 1) / LINE * LINE;
    return here;
}

static void lay_list(const struct flow_table *t, int i, struct room *room,
                     struct element_list *list)
{
    const struct element_kind *kind = element_kinds[i];
    const size_t n = t->n_elements[i], n_materials = n ? t->n_materials : 0;
    list->n = t->n_elements[i];
    list->corner = next(room, n * sizeof *list->corner);
    list->at = next(room, kind->pairs * n * sizeof *list->at);
    list->vector = next(room, kind->vectors * n * sizeof *list->vector);
    for (uint32_t k = 0; k < ELEMENT_NUMBERS; k++)
        list->number[k] = next(room, k < kind->numbers ? n * sizeof(double) : 0);
    list->material = next(room, n_materials * kind->material_bytes);
}

static void lay(const struct flow_table *t, struct room *room, struct flow_image *image)
{
    const size_t n = t->n, sides = (size_t)t->n_inner + t->n_cut;
    const size_t slots = (size_t)t->n_slots + 1;
    image->load = next(room, n * sizeof *image->load);
    image->position = next(room, n * sizeof *image->position);
    image->velocity = next(room, n * sizeof *image->velocity);
    image->mass = next(room, n * sizeof *image->mass);
    image->drag = next(room, n * sizeof *image->drag);
    image->free = next(room, n * sizeof *image->free);
    image->stiffness = next(room, sides * sizeof *image->stiffness);
    image->damping = next(room, sides * sizeof *image->damping);
    image->length = next(room, sides * sizeof *image->length);
    image->end = next(room, sides * sizeof *image->end);
    image->copy_end = next(room, t->n_cut_entries * sizeof *image->copy_end);
    image->held = next(room, t->n_held * sizeof *image->held);
    image->vertex = next(room, n * sizeof *image->vertex);
    image->row = next(room, (n + 1) * sizeof *image->row);
    image->column = next(room, t->n_entries * sizeof *image->column);
    image->rim = next(room, t->n_rim * sizeof *image->rim);
    image->cut = next(room, slots * sizeof *image->cut);
    image->cut_entry = next(room, slots * sizeof *image->cut_entry);
    image->at = next(room, t->format == SOLVE_SPRINGS ? 0 : sides * sizeof *image->at);
    image->n_held = next(room, sizeof *image->n_held);
    image->moved = next(room, t->n_moved * sizeof *image->moved);
    image->guided = next(room, t->n_guided * sizeof *image->guided);
    image->loose = next(room, t->n_loose * sizeof *image->loose);
    image->varying = next(room, t->n_varying * sizeof *image->varying);
    image->varying_force = next(room, t->n_varying * sizeof *image->varying_force);
    image->watched = next(room, t->n_watched * sizeof *image->watched);
    image->stretch = next(room, sides);
    for (int i = 0; i < ELEMENT_KINDS; i++)
        lay_list(t, i, room, image->list + i);
}

size_t flow_table_bytes(const struct flow_table *table)
{
    struct room room = {0};
    struct flow_image image;
    lay(table, &room, &image);
    return room.used;
}

struct flow_image flow_table_image(const struct flow_table *table, void *image)
{
    struct room room = {.base = image};
    struct flow_image arrays;
    lay(table, &room, &arrays);
    return arrays;
}

void flow_table_open(struct flow_table *t, const void *image)
{
    const struct flow_image arrays = flow_table_image(t, (void *)image); /* it is only read */
    t->vertex = arrays.vertex;
    t->cut = arrays.cut;
    t->rim = arrays.rim;
    t->watched = arrays.watched;
    t->moved = (const uint32_t(*)[2])arrays.moved;
    t->guided = (const uint32_t(*)[2])arrays.guided;
    t->loose = (const uint32_t(*)[2])arrays.loose;
    t->varying = (const uint32_t(*)[2])arrays.varying;
    t->varying_force = arrays.varying_force;
    t->end = (const uint32_t(*)[2])arrays.end;
    t->copy_end = (const uint32_t(*)[2])arrays.copy_end;
    t->stiffness = arrays.stiffness;
    t->damping = arrays.damping;
    t->length = arrays.length;
    t->stretch = arrays.stretch;
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

uint32_t flow_table_copy(const struct flow_table *t, uint32_t s, uint32_t row)
{
    uint32_t low = t->copies[s], high = t->copies[s + 1];
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (t->copy[middle] <= row)
            low = middle;
        else
            high = middle;
    }
    return low;
}
