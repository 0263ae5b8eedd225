/* Each row is computed from itself alone: no order of rows matters. */
#include "cloth/physics/particle.h"

PHYS_KERNEL(phys_outside,
            (size_t n, const phys_vec *load, const double *drag, const phys_vec *v, phys_vec *f),
            (n, load, drag, v, f))
{
    for (size_t i = 0; i < n; i++) {
        phys_fetch(load + i, PHYS_FETCH, 0);
        phys_fetch(v + i, PHYS_FETCH, 0);
        phys_fetch(drag + i, PHYS_FETCH, 0);
        f[i] = load[i] - drag[i] * v[i];
    }
}

void phys_accelerate(size_t n, const double *mass, const double *free, phys_vec *f)
{
    for (size_t i = 0; i < n; i++)
        f[i] = free[i] * (f[i] / mass[i]);
}

PHYS_KERNEL(phys_advance, (size_t n, double scale, const phys_vec *d, phys_vec *y),
            (n, scale, d, y))
{
    for (size_t i = 0; i < n; i++)
        y[i] += scale * d[i];
}

double phys_kinetic(size_t n, const double *mass, const phys_vec *v, double *max)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const double square = phys_dot(v + i, v + i);
        sum += 0.5 * mass[i] * square;
        *max = square > *max ? square : *max;
    }
    return sum;
}

PHYS_KERNEL_OF(size_t, phys_diverged, (size_t n, double bound, const phys_vec *y), (n, bound, y))
{
    typedef int64_t mask __attribute__((vector_size(32)));
    const phys_vec max = {bound, bound, bound, bound};
    mask well = {-1, -1, -1, -1};
    for (size_t i = 0; i < n; i++)
        well &= (y[i] < max) & (y[i] > -max); /* NaN is neither */
    if (well[0] & well[1] & well[2] & well[3])
        return n;
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            if (!(y[i][c] < bound && y[i][c] > -bound))
                return i;
    return n;
}
