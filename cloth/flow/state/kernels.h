#ifndef CLOTH_FLOW_STATE_KERNELS_H
#define CLOTH_FLOW_STATE_KERNELS_H

#include "cloth/flow/state/kernel.h"

/* All kernels (state/kernel.h), in the order of a run: set-up, state,
 * forces and pins, contact, integrators, the solver, observation of a run. */
/* clang-format off */
#define FLOW_KERNELS(X)                                                                            \
    X(broadcast_head) X(broadcast_shared) X(ready) X(table_make) X(table_keep)                                          \
    X(initial) X(resume_main) X(resume_load) X(resume) X(keep) X(restore) X(status) X(resize) X(tie) X(tie_show)                                     \
    X(force) X(force_free) X(prescribe_velocity) X(prescribe_position)                             \
    X(keep_halo) X(skin_refit) X(skin_place) X(root) X(roots) X(meet) X(meet_self) X(meet_figure) X(meet_shape) X(touch) X(push) X(cut)                \
    X(tie_count) X(tie_contacts) X(tie_say) X(filter) X(constrain) X(collide)        \
    X(body_skin) X(body_refit) X(map_draw) X(map_draw_again)                                                                    \
    X(euler) X(euler_next) X(verlet_first) X(verlet_second) X(runge)                               \
    X(edge_start) X(edge_begin) X(edge_round) X(edge_next) X(edge_end)                             \
    X(implicit) X(implicit_next) X(predict) X(correct) X(shift) X(residual)                    \
    X(system) X(system_of_forces) X(matrix) X(factor)                                              \
    X(basis) X(basis_ghosts) X(patch_frame) X(lift) X(couple) X(factor_coarse)                     \
    X(cg_begin) X(cg_motion) X(cg_start) X(cg_guess) X(cg_pass)                              \
    X(tie_pack) X(tie_pack_pass) X(tie_show_basis)            \
    X(cg_pack) X(group_factor) X(group_solve)                \
    X(cg_scalars) X(piece_sums) X(piece_shift)         \
    X(stretch) X(energy) X(level) X(watch) X(seams) X(contact_force) X(probe) X(row)                         \
    X(frame) X(collect) X(seconds) X(broadcast) X(system_save) X(save)
/* clang-format on */

/* Those of them that are two to the runtime. */
#define FLOW_KERNELS_IF(X) X(table_make) X(table_keep) X(cg_start) X(cg_pass) X(cg_scalars)

#define FLOW_KERNEL_NUMBER(name) FLOW_KERNEL_##name,
#define FLOW_KERNEL_EXTERN(name) extern const struct flow_kernel flow_kernel_##name;
enum { FLOW_KERNELS(FLOW_KERNEL_NUMBER) FLOW_KERNELS_OF_ALL };
FLOW_KERNELS(FLOW_KERNEL_EXTERN)
#define FLOW_KERNEL_EXTERN_LESS(name) extern const duite_kernel flow_kernel_##name##_less;
FLOW_KERNELS_IF(FLOW_KERNEL_EXTERN_LESS)

/* How many flow_kernels (run.h) lists. */
#define FLOW_KERNEL_ONE_MORE(name) +1
enum { FLOW_KERNELS_LISTED = FLOW_KERNELS_OF_ALL FLOW_KERNELS_IF(FLOW_KERNEL_ONE_MORE) };

#endif
