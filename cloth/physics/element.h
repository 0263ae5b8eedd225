#ifndef CLOTH_PHYSICS_ELEMENT_H
#define CLOTH_PHYSICS_ELEMENT_H

#include "cloth/physics/vec.h"

#include <stddef.h>
#include <stdint.h>

/* An element joins two to four vertices of a block and of its
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

struct phys_air; /* as it blows (cloth/physics/air.h) */

/* The elements of one kind in a block, in order. A function on lists works on elements in order,
 * and an element's numbers depend on its corners alone. Each kind says which vectors, numbers and
 * data it has. */
enum { PHYS_NUMBERS = 3 };
struct phys_elements {
    uint32_t n;
    uint32_t (*corner)[4]; /* n: of corners that it lacks see element_kind.pack */
    uint32_t *at;          /* n x pairs: the entry of each, as solve_assemble_pairs wants it */
    phys_vec *vector;      /* n, or none */
    double *number[PHYS_NUMBERS]; /* n each; those of the kind come first */
    void *material;               /* the elements' data of a material; or none */
};

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

/* The functions of a kind on a list. Force: adds the forces (N) to f, the block's rows, in the air
 * as it blows then. Stiffness: y -= scale K v. Matrix: makes the pairs of elements from .. to - 1;
 * at, of each pair: with bit 0 set where N' is wanted in place of N; NULL: nowhere. System: the
 * same, and the right side of that step: b += push f - h^2 K v, with push h (s), or 0 where the
 * forces are in b. Energy (J) and torque (N m, added): of the elements that count here, those whose
 * corner 0 is one of the block's rows. */
typedef void phys_force(const struct phys_elements *list, const struct phys_air *air,
                        const struct phys_sight *sight, phys_vec *f);
typedef void phys_stiffness(const struct phys_elements *list, int full, double scale,
                            const struct phys_sight *sight, phys_vec *y);
typedef void phys_matrix(const struct phys_elements *list, size_t from, size_t to,
                         const struct phys_step *step, const struct phys_sight *sight,
                         const uint32_t *at, struct phys_pair *pair);
typedef void phys_system(const struct phys_elements *list, size_t from, size_t to,
                         const struct phys_step *step, double push, const struct phys_sight *sight,
                         const uint32_t *at, phys_vec *b, struct phys_pair *pair);
typedef double phys_energy(const struct phys_elements *list, const struct phys_sight *sight);
typedef void phys_torque(const struct phys_elements *list, const struct phys_sight *sight,
                         double torque[3]);

#endif
