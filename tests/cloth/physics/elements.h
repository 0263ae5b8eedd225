#ifndef TESTS_CLOTH_PHYSICS_ELEMENTS_H
#define TESTS_CLOTH_PHYSICS_ELEMENTS_H

#include "cloth/physics/element.h"

/* Properties of any model of elements, checked by differences. A model is told by its functions;
 * `of` are its elements. */
struct elements {
    const void *of;
    size_t n, n_pairs;           /* elements; pairs each */
    const uint32_t (*corner)[4]; /* n */
    const int (*pair)[2];        /* n_pairs: corners i < j */
    double (*energy)(const void *of, const struct phys_sight *sight);
    void (*force)(const void *of, const struct phys_sight *sight, phys_vec *f);
    void (*stiffness)(const void *of, int full, double scale, const struct phys_sight *sight,
                      phys_vec *y);
    void (*matrix)(const void *of, const struct phys_step *step, const struct phys_sight *sight,
                   struct phys_pair *pair);
};

enum { ELEMENTS_MAX = 32 }; /* vertices, and elements */

/* A state of n vertices that elements with damping, if any, are looked at in. */
struct elements_state {
    uint32_t n;
    phys_vec x[ELEMENTS_MAX], v[ELEMENTS_MAX];
};

/* Vertices off their places by up to `size` along each axis, and speeds of up to 1: the same for
 * the same seed. */
void elements_shake(struct elements_state *state, double size, unsigned seed);

/* Forces (without speeds) are minus the slope of the energy: central differences over 2e-5 m miss
 * them by no more than `most`. */
void elements_check_gradient(const struct elements *model, const struct elements_state *state,
                             double max);

/* The full matrix is the slope of forces against positions and speeds, by differences to within
 * `most`; K v is that of the same matrix; both of the reduced one agree, which is nowhere negative.
 */
void elements_check_matrix(const struct elements *model, const struct elements_state *state,
                           double max);

/* Forces, with those of speeds, and K v sum to nothing, and forces have no torque. */
void elements_check_momentum(const struct elements *model, const struct elements_state *state,
                             double max);

/* No forces at the rest places `rest`, turned and moved anyhow, at a speed that belongs to a turn:
 * `most` N. */
void elements_check_rigid(const struct elements *model, const struct elements_state *rest,
                          double max);

/* Vertices split in two blocks, from `split` on: each finds the rows of the whole, bit for bit. */
void elements_check_split(const struct elements *model, const struct elements_state *state,
                          uint32_t split);

#endif
