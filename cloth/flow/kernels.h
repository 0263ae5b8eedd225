#ifndef CLOTH_FLOW_KERNELS_H
#define CLOTH_FLOW_KERNELS_H

#include "cloth/flow/state/kernel.h"

/* All kernels that declare their fields (state/kernel.h), in the order of a run: set-up, state,
 * forces and pins, contact, integrators, what is seen of a run. */
/* clang-format off */
#define FLOW_KERNELS(X)                                                                            \
    X(table_make) X(table_keep)                                                                    \
    X(initial) X(keep) X(restore) X(status)                                                        \
    X(force) X(force_free) X(drive) X(place)                                                       \
    X(touch) X(contact) X(hold) X(collide)                                                         \
    X(euler) X(euler_beside) X(verlet_first) X(verlet_second) X(runge)                             \
    X(velocity_implicit) X(position) X(predict) X(correct) X(shift) X(residual)                    \
    X(stretch) X(energy) X(level) X(watch) X(probe) X(row) X(frame)                                \
    X(collect) X(seconds) X(tell) X(system_part) X(system_save)
/* clang-format on */

#define FLOW_KERNEL_NUMBER(name) FLOW_KERNEL_##name,
#define FLOW_KERNEL_EXTERN(name) extern const struct flow_kernel flow_kernel_##name;
enum { FLOW_KERNELS(FLOW_KERNEL_NUMBER) FLOW_KERNELS_OF_ALL };
FLOW_KERNELS(FLOW_KERNEL_EXTERN)

/* Kernels. Objects in order; "table" (r) is that of the task's block, "rims" are one of each
 * neighbour, in slot order. Vectors are rows of four doubles. */
extern const duite_kernel flow_tell_head; /* w head: on rank 0 */
extern const duite_kernel
    flow_tell_shared; /* w shared: obstacles, motions, shapes, neighbours; on rank 0 */
extern const duite_kernel flow_ready; /* cw ready: fails if this rank cannot begin */
extern const duite_kernel
    flow_system_all; /* table, r x, r v, w f: right-hand side, w a; rims of x, rims of v */
extern const duite_kernel flow_system_rest; /* the same where f has the forces: rw f */
extern const duite_kernel flow_matrix;      /* table, r x, w a; rims of x. a: flow_open_matrix */
extern const duite_kernel flow_begin;       /* w scalars */
extern const duite_kernel flow_start; /* table, r b, w dv, w r, w p, w q, w copies, w rim of q */
extern const duite_kernel flow_guess; /* table, r b, r a, rw dv, w r, w p, w q, w rim of q */
extern const duite_kernel
    flow_pass; /* table, r scalars, r a, r b, rw dv, rw r, rw p, rw q, rw copies,
                  rw   rim of q, cw sums; the other rims of q, or far ones */
extern const duite_kernel flow_pack;    /* r rim of q, w far rim */
extern const duite_kernel flow_scalars; /* w next scalars, r scalars; sums, or all parts */
/* The same with a preconditioner; s takes the place of q. "coarse": only with a coarse part. */
extern const duite_kernel flow_basis; /* table, w basis, w rim of it; with contact r filter */
extern const duite_kernel flow_basis_copies; /* table, w basis of the copies; rims of basis */
extern const duite_kernel flow_couple; /* table, r a, r basis, r that of the copies, w coupling */
extern const duite_kernel flow_factor_coarse;        /* w coarse factor; coupling of all blocks */
extern const duite_kernel flow_factor;               /* table, r a, w factor, cw status */
extern const duite_kernel flow_start_preconditioned; /* as flow_start; w part, w z, w s, r factor;
                                                        coarse: basis */
extern const duite_kernel flow_begin_coarse; /* w scalars, w motion, r coarse factor; all parts */
extern const duite_kernel flow_pass_preconditioned; /* as flow_pass, rw part for sums; rw z, rw s, r
                                                       factor; the other rims of s, or far ones;
                                                       coarse: basis, that of the copies, motion */
extern const duite_kernel flow_scalars_coarse; /* w next scalars, r scalars, w next motion, r coarse
                                                  factor; all parts */
/* After a solve, where there are free pieces (kernels_pieces.c). */
extern const duite_kernel flow_piece_sums;  /* table, r b, r a, r dv, cw sums */
extern const duite_kernel flow_piece_shift; /* table, r a, r sums, rw dv, rw r */

#endif
