#ifndef CLOTH_FLOW_CHECKPOINT_CHECKPOINT_H
#define CLOTH_FLOW_CHECKPOINT_CHECKPOINT_H

#include "cloth/flow/state/state.h"

/* Checkpoints of a run: save.c makes them, resume.c goes on from one. Rank 0 has the bytes:
 *
 *   struct flow_saved     the main program's state
 *   arrays of it          of ties: rooms, first, other, place; of meetings: struct flow_saved_side;
 *                         of each block how many contacts it keeps at most
 *   of each block         its fields that are state, in the order of their table: a uint64_t with
 *                         how many bytes, then these, up to a multiple of 8
 *   at last               those of the run, alike
 *
 * Blocks do not depend on ranks, so a checkpoint does not either. */
struct flow_saved {
    uint64_t layout;     /* of these bytes: flow_saved_layout */
    uint64_t main_bytes; /* this, and the arrays */
    uint64_t partition_hash;
    uint32_t n_vertices, n_blocks;
    uint32_t n_others;   /* pairs of blocks that share ties; without any room there are no arrays */
    uint32_t has_ties;   /* whether there are */
    uint32_t n_meetings; /* of sides */
    uint32_t n_kept;     /* of numbers of contacts: of each block, or none */
    uint32_t attempt, accepted; /* of certified contact */
    uint32_t finished;          /* the run had come to its end: the report is whole */
    uint32_t spare;
    uint64_t end; /* ticks: of the run */
    struct flow_lasting lasting;
    struct flow_report report;
};
struct flow_saved_side {
    uint32_t side[2], room;
};
/* Where the arrays are in the bytes of a main program. */
struct flow_saved_arrays {
    struct flow_tied_blocks tied; /* all NULL: there are none */
    struct flow_saved_side *side;
    uint32_t *kept;
};

/* Bytes of main program of a checkpoint; its arrays, in bytes that are aligned to 8. Pure. */
size_t flow_saved_main_bytes(const struct flow_saved *saved);
struct flow_saved_arrays flow_saved_arrays(const struct flow_saved *saved,
                                           const unsigned char *bytes);

/* The fault of the saved main program's state, as the end of a sentence; NULL: it fits a run of
 * this flow, which is prepared. bytes: all of main_bytes, aligned to 8. Pure. (check.c) */
const char *flow_saved_wrong(const struct flow *flow, const unsigned char *bytes);
/* True if n numbers are rows of places or speeds that a run may reach. Pure. (check.c) */
bool flow_saved_is_place(const double *numbers, size_t n);
/* True if n bytes begin as a list of contacts that a block may keep (contact.h); the index is not
 * checked. On any rank of a run. Pure. (check.c) */
bool flow_saved_are_contacts(const struct flow *flow, uint32_t block, const unsigned char *bytes,
                             size_t n);

/* Identifies the contents of a model's checkpoint: fields, types and structures. It differs between
 * versions. Pure. */
uint64_t flow_saved_layout(const struct model *model);

/* Puts the objects of a block that a checkpoint has into `refs`, in their order; block n_blocks:
 * those of the run. Returns how many. There is room for FLOW_FIELDS_OF_ALL. Local. */
size_t flow_saved_objects(const struct flow_state *state, uint32_t block, duite_object *refs);

/* Bytes of a number of an object. */
size_t flow_saved_width(duite_type type);

/* Collective; they return what the runtime does. The first forks the tasks that hand a checkpoint
 * to the program, if it wants any; finished: the run is over, and its report whole. The others
 * resume a run: the second takes the main program's state, before ties are chosen; the third
 * restores the blocks. */
int flow_save(struct flow_state *state, bool finished);
int flow_resume_main(struct flow_state *state);
int flow_resume_blocks(struct flow_state *state);

#endif
