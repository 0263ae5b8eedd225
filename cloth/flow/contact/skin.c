/* The arrays of a block's skin lie one after the other, each on a line of its own. */
#include "cloth/flow/contact/skin.h"

#include "cloth/flow/state/room.h"

struct contact_skin flow_skin_counts(const struct flow_table *table)
{
    return (struct contact_skin){.n_points = table->skin.n_points,
                                 .n_triangles = table->skin.n_triangles,
                                 .n_edges = table->skin.n_edges,
                                 .n_vertices = table->skin.n_vertices};
}

static size_t lay(const struct contact_skin *skin, void *memory, struct flow_skin_arrays *arrays)
{
    struct flow_room room = {.base = memory};
    flow_room_next(&room, contact_skin_bytes(skin));
    arrays->from = flow_room_next(&room, skin->n_points * sizeof *arrays->from);
    arrays->at = flow_room_next(&room, skin->n_points * sizeof *arrays->at);
    arrays->attached = flow_room_next(&room, skin->n_points * sizeof *arrays->attached);
    return room.used;
}

size_t flow_skin_bytes(const struct flow_table *table)
{
    const struct contact_skin skin = flow_skin_counts(table);
    struct flow_skin_arrays arrays;
    return lay(&skin, NULL, &arrays);
}

struct flow_skin_arrays flow_skin_places(const struct flow_table *table, void *memory)
{
    const struct contact_skin skin = flow_skin_counts(table);
    struct flow_skin_arrays arrays;
    lay(&skin, memory, &arrays);
    return arrays;
}

struct flow_skin flow_skin_open(const void *memory)
{
    struct flow_skin skin = {.skin = contact_skin_open(memory)};
    struct flow_skin_arrays arrays;
    lay(&skin.skin, (void *)memory, &arrays); /* it is only read */
    skin.from = arrays.from;
    skin.at = arrays.at;
    skin.attached = arrays.attached;
    return skin;
}
