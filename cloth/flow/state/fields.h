#ifndef CLOTH_FLOW_STATE_FIELDS_H
#define CLOTH_FLOW_STATE_FIELDS_H

#include "cloth/contact/row.h"
#include "cloth/physics/vec.h"
#include "cloth/solve/cg.h"
#include "cloth/solve/correction.h"
#include "cloth/solve/frame.h"

#include <duite.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The fields of a run: every shared object that lives as long as the run, in one list. A row
 * has a field's name, the number of its objects, the type of its numbers in C, numbers a row, and
 * the number of rows (at least one is made). Then it says when the field exists, and its use
 * between two steps (enum flow_life). The words in the last three columns are functions of
 * fields.c. Loops over the list make, free and colocate objects (objects.c); kernels name them
 * (kernel.h). A checkpoint must have the fields that the last column says; test_fields.c holds runs
 * to it. A new field is one row.
 *
 * ONE: one object. SIZED: one that changes its size, up to this many rows. BY_PASS: two objects
 * that take turns, name and name_next; `name` is that of the pass under way (flow_state.pass). */

/* Fields of each block; they live where its x lives. */
/* Numbers of a row of a contact; of a frame; of the place of a node in its group. */
enum {
    FLOW_ROW_NUMBERS = sizeof(struct contact_row) / sizeof(double),
    FLOW_FRAME = sizeof(struct solve_frame) / sizeof(double),
    FLOW_LIFT = 9
};

/* clang-format off */
#define FLOW_BLOCK_FIELDS(X)                                                                       \
    /* the state, and its rows for neighbours */                                                   \
    X(x,            ONE,     phys_vec,      4, rows,          always,       state_field)           \
    X(v,            ONE,     phys_vec,      4, rows,          always,       state_field)           \
    X(f,            ONE,     phys_vec,      4, rows,          always,       state_of_ends)         \
    X(halo_x,       ONE,     phys_vec,      4, halo,          always,       derived)               \
    X(halo_v,       ONE,     phys_vec,      4, halo,          always,       derived)               \
    X(table,        ONE,     unsigned char, 1, table_bytes,   always,       derived)               \
    /* its ties (ties.h). tie_links: the number of blocks that it shares ties with, then each with \
     * the place of its ghosts there. x, then v of the rows shown; the coarse motions there */     \
    X(tie_links,    ONE,     uint32_t,      2, tie_links,     may_be_tied,  derived)               \
    X(tie_table,    ONE,     unsigned char, 1, tie_bytes,     may_be_tied,  derived)               \
    X(tie_halo,     ONE,     phys_vec,      8, tie_rows,      may_be_tied,  work)                  \
    X(tie_basis,    ONE,     phys_vec,      4, tie_rows,      coarse_tied,  work)                  \
    /* before a step that may be given up */                                                       \
    X(kept_x,       ONE,     phys_vec,      4, rows,          kept,         work)                  \
    X(kept_v,       ONE,     phys_vec,      4, rows,          kept,         work)                  \
    /* the same, for a stop inside the step (contact/stop.c) */                                    \
    X(kept_dv,      ONE,     phys_vec,      4, rows,          keeps_guess,  work)                  \
    X(kept_last_x,  ONE,     phys_vec,      4, rows,          keeps_last,   work)                  \
    X(kept_last_v,  ONE,     phys_vec,      4, rows,          keeps_last,   work)                  \
    /* contact: skins (skin.h); before a step, and x of skins before and after                     \
     * it, and their boxes */                                                                      \
    X(skin,         ONE,     unsigned char, 1, skin_bytes,    meets,        derived)               \
    X(kept_halo_x,  ONE,     phys_vec,      4, halo,          sweeps,       work)                  \
    X(skin_x,       ONE,     phys_vec,      4, skin_points,   meets,        work)                  \
    X(skin_boxes,   ONE,     unsigned char, 1, skin_boxes,    meets,        work)                  \
    /* of each row: struct flow_cut_run (contact/cut.c) */                                         \
    X(cut_runs,     ONE,     uint32_t,      4, rows,          sweeps,       state_field)           \
    /* its strip of the maps of bodies (contact/image.h) */                                        \
    X(maps,         ONE,     unsigned char, 1, map_bytes,     mapped,       derived)               \
    /* velocity correction (springs/correct.c). X with 1 / m in the fourth lane; moves of x since the \
     * solve of the step. Rows that others need: X and 1 / m, x at the step's begin, S; x as it is. \
     * 1 if no inner edge needs a correction, and the largest excess of these */                   \
    X(edge_base,    ONE,     phys_vec,      4, rows,          corrected,    work)                  \
    X(edge_moved,   ONE,     phys_vec,      4, rows,          corrected,    work)                  \
    X(edge_ends,    ONE,     phys_vec,      12, halo,         corrected,    work)                  \
    X(edge_x,       BY_PASS, phys_vec,      4, halo,          corrected,    work)                  \
    X(edge_calm,    ONE,     double,        2, one,           corrected,    work)                  \
    /* explicit integrators (explicit.c); x0, v0: where a step began, or Verlet's half step */     \
    X(spare_halo_x, ONE,     phys_vec,      4, halo,          explicit_run, work)                  \
    X(spare_halo_v, ONE,     phys_vec,      4, halo,          explicit_run, work)                  \
    X(v0,           ONE,     phys_vec,      4, rows,          staged,       work)                  \
    X(x0,           ONE,     phys_vec,      4, rows,          in_stages,    work)                  \
    X(sum_x,        ONE,     phys_vec,      4, rows,          in_stages,    work)                  \
    X(sum_v,        ONE,     phys_vec,      4, rows,          in_stages,    work)                  \
    /* implicit integrators: struct phys_states */                                                 \
    X(base_x,       ONE,     phys_vec,      4, rows,          based,        work)                  \
    X(base_v,       ONE,     phys_vec,      4, rows,          based,        work)                  \
    X(last_x,       ONE,     phys_vec,      4, rows,          two_steps,    state_field)           \
    X(last_v,       ONE,     phys_vec,      4, rows,          two_steps,    state_field)           \
    /* contact: the box around the skin of the block over the step (pairs.c); the record of its    \
     * ties; its contacts in the step under way: struct contact_row (rows.c) */                    \
    X(root,         ONE,     double,        FLOW_ROOT, one,       meets,        work)              \
    X(tie_record,   SIZED,   unsigned char, 1, record_bytes,  meets,        work)                  \
    X(contact_rows, ONE,     struct contact_row, FLOW_ROW_NUMBERS, tie_count, meets,     work)     \
    /* of each of these the obstacle that it is with, from 1; 0: none */                           \
    X(contact_obstacles, ONE, uint32_t,     1, tie_count,     meets,        work)                  \
    /* where it is asked for: the force of contact on each row in the last step, N */              \
    X(contact_force, ONE,    phys_vec,      4, rows,          feels,        state_of_frames)       \
    X(kept_contact_force, ONE, phys_vec,    4, rows,          shows_force,  work)                  \
    /* the system of a step: matrix (flow_matrix_in), its filter if any; its solve */              \
    X(a,            ONE,     phys_vec,      1, matrix,        implicit_run, work)                  \
    X(filter,       ONE,     phys_vec,      4, rows,          filtered,     work)                  \
    X(dv,           ONE,     phys_vec,      4, rows,          implicit_run, state_of_guess)        \
    X(r,            ONE,     phys_vec,      4, rows,          implicit_run, work)                  \
    X(p,            ONE,     phys_vec,      4, rows,          implicit_run, work)                  \
    X(q,            ONE,     phys_vec,      4, rows,          implicit_run, work)                  \
    /* r (with a preconditioner z) of the ghosts, then p, then both of the ghosts of ties.         \
     * Rows of q (of s) for neighbours; for others that ties join */                               \
    X(ghosts,       ONE,     phys_vec,      8, ghosts_tied,   implicit_run, work)                  \
    X(halo_q,       BY_PASS, double,        3, halo,          implicit_run, work)                  \
    X(tie_q,        BY_PASS, double,        3, tie_rows,      solves_tied,  work)                  \
    /* a preconditioner; part: sums of a pass and the coarse right side */                         \
    X(z,            ONE,     phys_vec,      4, rows,          conditioned,  work)                  \
    X(s,            ONE,     phys_vec,      4, rows,          conditioned,  work)                  \
    X(factor,       ONE,     double,        1, factor,        conditioned,  work)                  \
    X(part,         ONE,     double,        1, part,          conditioned,  work)                  \
    /* its coarse part */                                                                          \
    X(basis,        ONE,     phys_vec,      4, rows,          coarse_run,   derived_once)          \
    X(halo_basis,   ONE,     phys_vec,      4, halo,          coarse_run,   derived_once)          \
    X(basis_ghosts, ONE,     phys_vec,      4, ghosts,        coarse_run,   derived_once)          \
    X(coupling,     ONE,     double,        1, couplings,     coarse_run,   work)                  \
    X(patch_frame,  ONE,     struct solve_frame, FLOW_FRAME, patches, by_levels, derived)          \
    /* at probes: the force on each row; the values that they report */                            \
    X(probe_force,  ONE,     phys_vec,      4, rows,          probed,       work)                  \
    X(probe_values, ONE,     double,        FLOW_PROBE_VALUES, watched,       probed,       work)  \
    /* what travels to rank 0 on its own, empty in between */                                      \
    X(gathered,     SIZED,   unsigned char, FLOW_VERTEX_BYTES, rows,          always,       work)  \
    /* its contacts (contact/contact.h), behind all that a checkpoint has besides; where the step   \
     * began, if others were made since; as they are made */                                       \
    X(contacts,     SIZED,   struct flow_list, 1, contacts_bytes,      meets, state_of_carried)    \
    X(kept_contacts, SIZED,  struct flow_list, 1, kept_contacts_bytes, meets, work)                \
    X(contacts_next, SIZED,  struct flow_list, 1, contacts_next_bytes, meets, work)

/* Fields of the whole run; they live where the first block lives. */
#define FLOW_RUN_FIELDS(X)                                                                         \
    /* sums of a step; trial, slope: of a Newton step */                                           \
    X(status,       ONE,     double,        FLOW_STATUS, one,           always,       work)        \
    X(stretch,      ONE,     double,        1, one,           always,       work)                  \
    X(peaks,        ONE,     double,        FLOW_PEAKS, one,           always,       work)         \
    /* of each pulled seam the square of the largest distance of partners, m^2 */                  \
    X(seam_peaks,   ONE,     double,        1, pulled_seams,  always,       work)                  \
    X(energies,     ONE,     double,        FLOW_SUMS, one,           always,       work)          \
    X(trial,        ONE,     double,        FLOW_STATUS, one,           implicit_run, work)        \
    X(slope,        ONE,     double,        1, one,           implicit_run, work)                  \
    X(roots,        ONE,     double,        FLOW_ROOT, sides,     meets,        work)              \
    X(tie_said,     SIZED,   unsigned char, 1, records_bytes, meets,        work)                  \
    X(cut_counts,   ONE,     double,        FLOW_CUT_COUNTS, one, sweeps,       work)              \
    X(cut_longest,  ONE,     double,        1, one,           sweeps,       work)                  \
    X(obstacle_force, ONE,   phys_vec,      4, obstacles,     feels,        work)                  \
    X(contact_energy, ONE,   double,        FLOW_HELD, one, meets,        work)                    \
    /* bodies by their skins (contact/body.h) */                                                   \
    X(body_skins,   ONE,     unsigned char, 1, body_skins,   meets_bodies, derived)                \
    X(body_fans,    ONE,     uint32_t,      1, body_fans,    meets_bodies, derived)                \
    X(body_points,  ONE,     phys_vec,      4, body_points,  meets_bodies, derived_of_bodies)      \
    X(body_boxes,   ONE,     unsigned char, 1, body_boxes,   meets_bodies, derived_of_bodies)      \
    /* its rounds, and the result of the last one */                                               \
    X(edge_rounds,  BY_PASS, struct solve_rounds, SOLVE_ROUNDS_NUMBERS, one, corrected, work)      \
    X(edge_excess,  BY_PASS, double,        2, one,           corrected,    work)                  \
    /* a solve. Coarse, motion: factor, and its part of s. Lift: places of patches in groups, and  \
     * of these in those of the level above. Pieces: what it left of free pieces */                \
    X(sums,         BY_PASS, double,        1, dots,          plain_solve,  work)                  \
    X(scalars,      BY_PASS, struct solve_scalars, SOLVE_SCALARS, one,           implicit_run, work) \
    X(coarse,       ONE,     double,        1, coarse_factor, coarse_run,   work)                  \
    X(motion,       BY_PASS, double,        1, motion,        coarse_run,   work)                  \
    X(lift,         ONE,     double,        FLOW_LIFT, lifted, by_levels,   derived)               \
    X(pieces,       ONE,     double,        FLOW_PIECE_SUMS, pieces,        in_pieces,    work)    \
    /* a piece: the lowest one that ties join it with, counted from 1; 0: they join it with what a \
     * pin holds */                                                                                \
    X(groups,       ONE,     uint64_t,      1, pieces,        tied_pieces,  derived)               \
    /* reports; the holder of the token writes a frame or a row */                                 \
    X(token,        ONE,     int64_t,       1, one,           always,       work)                  \
    X(seconds,      ONE,     double,        FLOW_PARTS, one,           always,       work)         \
    X(energy,       ONE,     double,        FLOW_SUMS, one,           always,       work)          \
    X(broadcast,    ONE,     uint64_t,      FLOW_BROADCAST, one,           always,       work)
/* clang-format on */

#define FLOW_FIELDS(X) FLOW_BLOCK_FIELDS(X) FLOW_RUN_FIELDS(X)

/* Objects that are no fields: their number follows from the run, or they live for a moment. */
#define FLOW_OBJECTS(X)                                                                            \
    /* set-up: of rank 0 for all; what a rank lacks; a checkpoint's objects */                     \
    X(sent, unsigned char)                                                                         \
    X(lacks, int32_t)                                                                              \
    X(saved_objects, unsigned char)                                                                \
    /* the fields of all blocks that make the system of a step (observe/system.c) */               \
    X(system_objects, unsigned char)                                                               \
    /* contact (contact.h): a meeting's list, counts; of its second side; a block's lists */       \
    X(near, struct flow_list)                                                                      \
    X(meeting_counts, double)                                                                      \
    X(other_skin, unsigned char)                                                                   \
    X(other_x, phys_vec)                                                                           \
    X(other_boxes, unsigned char)                                                                  \
    X(meetings, struct flow_list)                                                                  \
    /* the solver: rows of s that another rank reads (halo.c); a group, what it covers (groups.c)  \
     */                                                                                            \
    X(whole_halo, double)                                                                          \
    X(packed_halo, double)                                                                         \
    X(group_factor, double)                                                                        \
    X(group_coupling, double)                                                                      \
    X(group_motion, double)                                                                        \
    X(group_part, double)                                                                          \
    X(covered, double)

/* FLOW_FIELD_name, and FLOW_FIELD_name_next behind it; the objects that are no fields last. */
#define FLOW_OBJECT_ID(name, type)     FLOW_FIELD_##name,
#define FLOW_FIELD_ID(name, many, ...) FLOW_FIELD_ID_##many(name)
#define FLOW_FIELD_ID_ONE(name)        FLOW_FIELD_##name,
#define FLOW_FIELD_ID_SIZED(name)      FLOW_FIELD_##name,
#define FLOW_FIELD_ID_BY_PASS(name)    FLOW_FIELD_##name, FLOW_FIELD_##name##_next,
enum flow_field_id {
    FLOW_BLOCK_FIELDS(FLOW_FIELD_ID) FLOW_FIELDS_OF_BLOCK,
    FLOW_FIELD_BEFORE_RUN = FLOW_FIELDS_OF_BLOCK - 1,
    FLOW_RUN_FIELDS(FLOW_FIELD_ID) FLOW_FIELDS_OF_ALL,
    FLOW_FIELD_BEFORE_OBJECTS = FLOW_FIELDS_OF_ALL - 1,
    FLOW_OBJECTS(FLOW_OBJECT_ID) FLOW_FIELDS_AND_OBJECTS
};
enum {
    FLOW_FIELDS_OF_RUN = FLOW_FIELDS_OF_ALL - FLOW_FIELDS_OF_BLOCK,
    FLOW_NO_FIELDS = FLOW_FIELDS_AND_OBJECTS - FLOW_FIELDS_OF_ALL
};

#define FLOW_FIELD_MEMBER(name, many, ...) FLOW_FIELD_MEMBER_##many(name)
#define FLOW_FIELD_MEMBER_ONE(name)        duite_object name;
#define FLOW_FIELD_MEMBER_SIZED(name)      duite_object name;
#define FLOW_FIELD_MEMBER_BY_PASS(name)    duite_object name[2];

/* The objects of a block, by name or by number; the zero object where a field does not exist. */
struct flow_objects {
    union {
        duite_object of[FLOW_FIELDS_OF_BLOCK];
        struct {
            FLOW_BLOCK_FIELDS(FLOW_FIELD_MEMBER)
        };
    };
};

/* The objects of the run; by number from FLOW_FIELDS_OF_BLOCK on. */
struct flow_run_objects {
    union {
        duite_object of[FLOW_FIELDS_OF_RUN];
        struct {
            FLOW_RUN_FIELDS(FLOW_FIELD_MEMBER)
        };
    };
};

/* The use of a field between two steps. */
enum flow_life {
    FLOW_STATE_FIELD, /* the next step reads it */
    FLOW_DERIVED, /* the next step reads it, and a restart can make it from the state and model */
    FLOW_WORK     /* the next step writes it before it reads it */
};

enum flow_turns { FLOW_ONE, FLOW_SIZED, FLOW_BY_PASS };

struct flow_state;
struct model;

struct flow_field {
    const char *name;
    enum flow_turns turns;
    unsigned place;  /* 1: it is the other of two, name_next */
    duite_type type; /* of its numbers */
    size_t width;    /* numbers a row */
    size_t (*rows)(const struct flow_state *state, uint32_t block);
    bool (*exists)(const struct flow_state *state, uint32_t block);
    enum flow_life (*life)(const struct model *model);
};

/* All fields by number; one that takes turns is there twice. */
extern const struct flow_field flow_fields[FLOW_FIELDS_OF_ALL];

/* Numbers of a field in a block; of one of the run in all, whatever the block. Local. */
size_t flow_field_numbers(const struct flow_state *state, enum flow_field_id field, uint32_t block);

/* The object of a field, of a block or of the run; of two, the one whose turn it is. */
duite_object flow_field_object(const struct flow_state *state, enum flow_field_id field,
                               uint32_t block);

/* The index of that among the objects of its block, or, from FLOW_FIELDS_OF_BLOCK on, of the run.
 */
size_t flow_field_place(const struct flow_state *state, enum flow_field_id field);

/* Swaps the objects of two fields in all blocks. Both exist, alike. */
void flow_fields_swap(struct flow_state *state, enum flow_field_id a, enum flow_field_id b);

/* All objects that exist. The second makes one again, of the size that the table says now. A
 * failure is returned by the next get. */
void flow_objects_make(struct flow_state *state);
void flow_object_again(struct flow_state *state, enum flow_field_id field, uint32_t block);
struct flow_tie_room;
/* Gives a block room for ties: makes those of its objects again that get another size. */
void flow_objects_fit(struct flow_state *state, uint32_t block, const struct flow_tie_room *room);
/* Frees those that were made, packed halos and the recorded solve as well. */
int flow_objects_free(struct flow_state *state);

#endif
