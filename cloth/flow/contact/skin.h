#ifndef CLOTH_FLOW_CONTACT_SKIN_H
#define CLOTH_FLOW_CONTACT_SKIN_H

#include "cloth/contact/skin.h"
#include "cloth/flow/state/tables.h"

/* The kin of the points of a skin (struct flow_kin): numbers `joined`, ascending. */
struct flow_skin_kin {
    uint32_t n;          /* of all points; 0: no point has any, and the rest is undefined */
    const uint32_t *end; /* n_points: where those of a point end and those of the next one begin */
    const uint32_t *of;
    const double *clear; /* n_points: m, as of struct flow_kin */
};

/* The skin of a block, the field `skin`: its contact_skin, with which the object begins, and the
 * places of its points. A triangle of the whole cloth belongs to the block of its corner with the
 * lowest place; ids are places. Points are in the order of their places, so the block's own rows
 * come first; others are in the halo of a neighbour. */
struct flow_skin {
    struct contact_skin skin;
    const uint32_t
        *from;          /* n_points: the number of the neighbour; n_neighbours: the block itself */
    const uint32_t *at; /* n_points: place in its halo; row */
    const uint32_t *attached; /* n_points: the obstacle, from 1, that its pin follows, or 0 */
    const double *area;       /* n_points: of the cloth there at rest, m^2 */
    struct flow_skin_kin kin;
};

/* True if all of n numbers `joined` are kin of a point. Local. */
bool flow_kin_has(const struct flow_skin_kin *kin, uint32_t point, uint32_t n,
                  const uint32_t *joined);

/* Bytes of the object, which follow of the block's shape. */
size_t flow_skin_bytes(const struct flow_table *table);

/* memory: aligned to 64 bytes. */
struct flow_skin flow_skin_open(const void *memory);

/* Arrays that do not change in a run, to be written. from, at: as above. */
struct flow_skin_arrays {
    uint32_t *from, *at, *attached, *kin_end, *kin;
    double *area, *clear;
};
struct flow_skin_arrays flow_skin_places(const struct flow_table *table, void *memory);

/* A block's skin by its shape, with counts alone, to measure by. */
struct contact_skin flow_skin_counts(const struct flow_table *table);

/* The skins of all blocks in a step, of runs that find contacts. Functions of the main program.
 * Collective; they return what the runtime does. */
struct flow_state;

/* Forks the keeping of the halos of x, beside flow_keep: kept_halo_x becomes halo_x. */
int flow_skins_keep(struct flow_state *state);

/* Forks the tasks that make `skin_x`, the present x of the points, twice, and `skin_boxes` of
 * them. */
int flow_skins_place(struct flow_state *state);

/* Forks the tasks that make `skin_x`, first kept_x and then x of each block's skin points, and
 * `skin_boxes`, the boxes of the way between (contact_refit). again: skin_x is that of the last
 * look at the same step; points that have other bits since then are marked as moved. */
int flow_skins_refit(struct flow_state *state, bool again);

#endif
