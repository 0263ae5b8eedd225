#ifndef CLOTH_PHYSICS_ELEMENT_H
#define CLOTH_PHYSICS_ELEMENT_H

#include "cloth/physics/vec.h"

#include <stddef.h>
#include <stdint.h>

/* Shared by triangles and hinges. An element joins three or four vertices of a block and of its
 * neighbours: corners 0 .. n - 1 are the block's own rows, corner n + i is row i of its ghosts.
 * Every block that owns a corner works on the element and writes its own rows only. All find the
 * same bits: an element's numbers depend only on its corners in their order. */
struct phys_sight {
    uint32_t n;                        /* rows of the block */
    const phys_vec *x, *v;             /* n: m, m/s */
    const phys_vec *x_ghost, *v_ghost; /* as many as corners name; NULL if none are */
};

/* A corner that an element has not got. */
static const uint32_t PHYS_NO_CORNER = UINT32_MAX;

/* The matrix of an element. An implicit step of h seconds has M + h C + h^2 K, where C and K are
 * the slopes of the forces against velocities and positions, taken with a minus. */
struct phys_step {
    double h; /* s */
    int full; /* K is the exact slope; else parts that can make it indefinite are left out, as each
               * model says. The slope of damping forces against positions is left out in both. */
};

/* The block of a matrix that belongs to two corners i < j of an element, with a minus: N = -A_ij,
 * kg. cyclic[k] has N_rc of r = 0, 1, 2 with c = r + k, or r + k - 3; its fourth lane is zero. The
 * matrix is symmetric, and its rows sum to nothing: A p of corner i is the sum over j of N_ij (p_i
 * - p_j), with N_ji = N_ij'. */
struct phys_pair {
    phys_vec cyclic[3];
};

#endif
