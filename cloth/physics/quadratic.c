/* Elements are worked on in order. The force on corner 0 is minus the sum of the others, so that
 * the forces of an element sum to zero but for rounding. */
#include "cloth/physics/bending.h"

#include "cloth/physics/detail/lanes.h"

/* The sum of w_i y_i of element e: differences, so that a uniform motion gives zero. */
PHYS_INLINE void bent(const struct phys_elements *quadratic, size_t e, uint32_t n,
                      const phys_vec *own, const phys_vec *ghost, phys_vec *sum)
{
    const uint32_t *corner = quadratic->corner[e];
    const phys_vec first = *phys_at(n, own, ghost, corner[0]);
    *sum = (phys_vec){0};
    for (int i = 1; i < 4; i++)
        *sum += quadratic->vector[e][i] * (*phys_at(n, own, ghost, corner[i]) - first);
}

/* Adds -w_i b to the corners. */
PHYS_INLINE void add_forces(const struct phys_elements *quadratic, size_t e, uint32_t n,
                            const phys_vec *b, phys_vec *y)
{
    const uint32_t *corner = quadratic->corner[e];
    phys_vec first = {0};
    for (int i = 1; i < 4; i++) {
        const phys_vec add = -quadratic->vector[e][i] * *b;
        first -= add;
        if (corner[i] < n)
            y[corner[i]] += add;
    }
    if (corner[0] < n)
        y[corner[0]] += first;
}

PHYS_KERNEL(phys_quadratic_force,
            (const struct phys_elements *quadratic, const struct phys_air *air,
             const struct phys_sight *sight, phys_vec *f),
            (quadratic, air, sight, f))
{
    (void)air;
    for (size_t e = 0; e < quadratic->n; e++) {
        phys_vec x;
        bent(quadratic, e, sight->n, sight->x, sight->x_ghost, &x);
        add_forces(quadratic, e, sight->n, &x, f);
    }
}

PHYS_KERNEL(phys_quadratic_stiffness,
            (const struct phys_elements *quadratic, int full, double scale,
             const struct phys_sight *sight, phys_vec *y),
            (quadratic, full, scale, sight, y))
{
    (void)full;
    for (size_t e = 0; e < quadratic->n; e++) {
        phys_vec v;
        bent(quadratic, e, sight->n, sight->v, sight->v_ghost, &v);
        v *= scale;
        add_forces(quadratic, e, sight->n, &v, y);
    }
}

/* Blocks are symmetric, and constant. */
void phys_quadratic_matrix(const struct phys_elements *quadratic, size_t from, size_t to,
                           const struct phys_step *step, const struct phys_sight *sight,
                           const uint32_t *at, struct phys_pair *pair)
{
    const double h = step->h;
    (void)sight, (void)at;
    for (size_t e = from; e < to; e++) {
        double w[4] = {0};
        for (int i = 1; i < 4; i++) {
            w[i] = quadratic->vector[e][i];
            w[0] -= w[i];
        }
        for (int j = 1; j < 4; j++)
            for (int i = 0; i < j; i++, pair++) {
                const double b = -h * h * w[i] * w[j];
                *pair = (struct phys_pair){{{b, b, b, 0}}};
            }
    }
}

PHYS_KERNEL_OF(double, phys_quadratic_energy,
               (const struct phys_elements *quadratic, const struct phys_sight *sight),
               (quadratic, sight))
{
    double sum = 0;
    for (size_t e = 0; e < quadratic->n; e++) {
        phys_vec x;
        bent(quadratic, e, sight->n, sight->x, sight->x_ghost, &x);
        if (quadratic->corner[e][0] < sight->n)
            sum += 0.5 * phys_dot(&x, &x);
    }
    return sum;
}
