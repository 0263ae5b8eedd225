#ifndef BENCH_CONTACT_SHAPES_H
#define BENCH_CONTACT_SHAPES_H

#include "cloth/physics/vec.h"

#include <stdint.h>

/* A number within `reach` of 0, drawn. */
static inline double contact_draw(uint64_t *seed, double reach)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return reach * ((double)(*seed >> 11) * 0x1p-52 - 1);
}

/* The sheets in which features are looked for that are near each other, by us and by rivals:
 * square, u and v from 0 to 1; nearer than SHAPES_REACH, while they go down by SHAPES_DOWN and each
 * vertex by up to half of SHAPES_OWN along each axis, m. */
#define SHAPES_REACH 2e-3
#define SHAPES_DOWN  4e-3
#define SHAPES_OWN   1e-4
enum { SHAPES_SIDE = 187, SHAPES_QUICK_SIDE = 40 };

typedef void shapes_place(double u, double v, phys_vec *x);

/* waves, draped, six_layers; NULL: there is no such shape. */
shapes_place *shapes_find(const char *name);

/* Where a vertex at x comes to. */
void shapes_move(uint64_t *seed, const phys_vec *x, phys_vec *y);

#endif
