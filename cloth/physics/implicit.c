/* Sums go in the order of the rows. */
#include "cloth/physics/implicit.h"

void phys_bdf2_bases(size_t n, double t, const double *free, const struct phys_states *s)
{
    for (size_t i = 0; i < n; i++) {
        s->base_x[i] =
            free[i] > 0 ? s->x[i] + (s->x[i] - s->last_x[i]) / 3 : s->x[i] + t / 2 * s->v[i];
        s->base_v[i] = s->v[i] + (s->v[i] - s->last_v[i]) / 3;
        s->last_x[i] = s->x[i];
        s->last_v[i] = s->v[i];
    }
}

void phys_place(size_t n, double t, const phys_vec *base_x, const phys_vec *v, phys_vec *x)
{
    for (size_t i = 0; i < n; i++)
        x[i] = base_x[i] + t * v[i];
}

void phys_residual(size_t n, double t, const double *mass, const phys_vec *base_v,
                   const phys_vec *v, phys_vec *f)
{
    for (size_t i = 0; i < n; i++)
        f[i] = t * f[i] - mass[i] * (v[i] - base_v[i]);
}

double phys_slope(size_t n, const double *free, const phys_vec *a, const phys_vec *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += free[i] * phys_dot(a + i, b + i);
    return sum;
}

double phys_distance(size_t n, const double *mass, const phys_vec *a, const phys_vec *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const phys_vec d = b ? a[i] - b[i] : a[i];
        sum += mass[i] * phys_dot(&d, &d);
    }
    return sum;
}
