/* The arrays of a block's skin lie one after the other, each on a line of its own. Its points are
 * rows of the block and of halos. Begin and end of a step are kept_x and x. The frame of the boxes
 * moves as the mean of the points does, added up in their order. */
#include "cloth/flow/contact/skin.h"

#include "cloth/base/order.h"
#include "cloth/flow/state/bodies.h"
#include "cloth/flow/state/room.h"

struct contact_skin flow_skin_counts(const struct flow_table *table)
{
    return (struct contact_skin){.n_points = table->skin.n_points,
                                 .n_triangles = table->skin.n_triangles,
                                 .n_edges = table->skin.n_edges,
                                 .n_vertices = table->skin.n_vertices};
}

static size_t lay_skin(const struct contact_skin *skin, uint32_t n_kin, void *memory,
                       struct flow_skin_arrays *arrays)
{
    struct flow_room room = {.base = memory};
    flow_room_next(&room, contact_skin_bytes(skin));
    arrays->from = flow_room_next(&room, skin->n_points * sizeof *arrays->from);
    arrays->at = flow_room_next(&room, skin->n_points * sizeof *arrays->at);
    arrays->attached = flow_room_next(&room, skin->n_points * sizeof *arrays->attached);
    arrays->area = flow_room_next(&room, skin->n_points * sizeof *arrays->area);
    arrays->clear = flow_room_next(&room, skin->n_points * sizeof *arrays->clear);
    arrays->kin_end = flow_room_next(&room, skin->n_points * sizeof *arrays->kin_end);
    arrays->kin = flow_room_next(&room, n_kin * sizeof *arrays->kin);
    return room.used;
}

size_t flow_skin_bytes(const struct flow_table *table)
{
    const struct contact_skin skin = flow_skin_counts(table);
    struct flow_skin_arrays arrays;
    return lay_skin(&skin, table->skin.n_kin, NULL, &arrays);
}

struct flow_skin_arrays flow_skin_places(const struct flow_table *table, void *memory)
{
    const struct contact_skin skin = flow_skin_counts(table);
    struct flow_skin_arrays arrays;
    lay_skin(&skin, table->skin.n_kin, memory, &arrays);
    return arrays;
}

struct flow_skin flow_skin_open(const void *memory)
{
    struct flow_skin skin = {.skin = contact_skin_open(memory)};
    struct flow_skin_arrays arrays;
    lay_skin(&skin.skin, 0, (void *)memory, &arrays); /* it is only read; kin are the last */
    skin.from = arrays.from;
    skin.at = arrays.at;
    skin.attached = arrays.attached;
    skin.area = arrays.area;
    skin.kin =
        (struct flow_skin_kin){.end = arrays.kin_end, .of = arrays.kin, .clear = arrays.clear};
    skin.kin.n = skin.skin.n_points ? skin.kin.end[skin.skin.n_points - 1] : 0;
    return skin;
}

bool flow_kin_has(const struct flow_skin_kin *kin, uint32_t point, uint32_t n,
                  const uint32_t *joined)
{
    const uint32_t first = kin->n && point ? kin->end[point - 1] : 0;
    const uint32_t some = kin->n ? kin->end[point] - first : 0;
    bool has = some > 0;
    for (uint32_t k = 0; k < n && has; k++) {
        const uint32_t at = cloth_first_from(kin->of + first, 1, some, joined[k]);
        has = at < some && kin->of[first + at] == joined[k];
    }
    return has;
}

/* ---- In a step ---- */

FLOW_KERNEL(keep_halo, FLOW_COLLIDE, struct flow_block_args, (R(halo_x), W(kept_halo_x)))
{
    const size_t bytes = duite_count(call, FLOW_INDEX_OF(keep_halo, halo_x)) * sizeof(double);
    memcpy(on->kept_halo_x, on->halo_x, bytes);
    return 0;
}

int flow_skins_keep(struct flow_state *state)
{
    return flow_fork_each(state, &flow_kernel_keep_halo, NULL);
}

/* Gathers the rows of the points. moved, by point: they have other bits now; NULL: nobody asks. */
static void gather_points(const struct flow_skin *skin, uint32_t n_neighbours, const phys_vec *own,
                          const duite_param *halo, phys_vec *to, unsigned char *moved)
{
    for (uint32_t i = 0; i < skin->skin.n_points; i++) {
        const uint32_t s = skin->from[i];
        const phys_vec *from = s == n_neighbours ? own : flow_rows_of(halo, s);
        if (moved)
            moved[i] = memcmp(to + i, from + skin->at[i], sizeof *to) != 0;
        to[i] = from[skin->at[i]];
    }
}

static void mean_way(uint32_t n, const phys_vec *x, const phys_vec *y, phys_vec *way)
{
    phys_vec sum = {0};
    for (uint32_t i = 0; i < n; i++)
        sum += y[i] - x[i];
    *way = n ? sum / n : sum;
}

struct refit_args {
    uint32_t block;
    bool again;
};

FLOW_KERNEL(skin_refit, FLOW_COLLIDE, struct refit_args,
            (R(skin), R(kept_x), R(x), RW(skin_x), W(skin_boxes), NEIGHBOURS(kept_halo_x),
             NEIGHBOURS(halo_x)))
{
    const uint32_t n_neighbours = flow_shape_of(call)->n_neighbours;
    const struct flow_skin skin = flow_skin_open(on->skin);
    const uint32_t n = skin.skin.n_points;
    unsigned char *moved = contact_moved_points(&skin.skin, on->skin_boxes);
    phys_vec *y = on->skin_x + n, way;
    gather_points(&skin, n_neighbours, on->kept_x, on->kept_halo_x, on->skin_x, NULL);
    gather_points(&skin, n_neighbours, on->x, on->halo_x, y, on->args->again ? moved : NULL);
    if (!on->args->again)
        memset(moved, 1, n);
    mean_way(n, on->skin_x, y, &way);
    contact_refit(&skin.skin, on->skin_x, y, &way, on->skin_boxes);
    contact_moved_mark(&skin.skin, on->skin_boxes);
    return 0;
}

/* Points that stand still. */
FLOW_KERNEL(skin_place, FLOW_COLLIDE, struct flow_block_args,
            (R(skin), R(x), W(skin_x), W(skin_boxes), NEIGHBOURS(halo_x)))
{
    const struct flow_skin skin = flow_skin_open(on->skin);
    const uint32_t n = skin.skin.n_points;
    const phys_vec nowhere = {0};
    gather_points(&skin, flow_shape_of(call)->n_neighbours, on->x, on->halo_x, on->skin_x, NULL);
    memcpy(on->skin_x + n, on->skin_x, n * sizeof *on->skin_x);
    memset(contact_moved_points(&skin.skin, on->skin_boxes), 1, n);
    contact_refit(&skin.skin, on->skin_x, on->skin_x, &nowhere, on->skin_boxes);
    contact_moved_mark(&skin.skin, on->skin_boxes);
    return 0;
}

int flow_skins_place(struct flow_state *state)
{
    return flow_fork_each(state, &flow_kernel_skin_place, NULL);
}

int flow_skins_refit(struct flow_state *state, bool again)
{
    struct refit_args args = {.again = again};
    return flow_fork_each(state, &flow_kernel_skin_refit, &args);
}
