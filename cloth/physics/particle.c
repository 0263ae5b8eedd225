/* Each row is computed from itself alone, so that no order of rows matters but in sums. A held row
 * has zero acceleration and velocity, so it does not move. */
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

/* ---- Energies ---- */

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

double phys_energy_weight(size_t n, const double *mass, const double gravity[3], const phys_vec *x)
{
    const phys_vec g = PHYS_VEC(gravity);
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum -= mass[i] * phys_dot(&g, x + i);
    return sum;
}

double phys_energy_load(size_t n, const double *mass, const double gravity[3], const phys_vec *load,
                        const phys_vec *x)
{
    const phys_vec g = PHYS_VEC(gravity);
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const phys_vec rest = load[i] - mass[i] * g;
        sum -= phys_dot(&rest, x + i);
    }
    return sum;
}

/* ---- Explicit steps ---- */

PHYS_KERNEL_OF(int, phys_euler,
               (size_t n, double h, int ahead, double bound, const double *mass, const double *free,
                const phys_vec *f, const phys_vec *x, const phys_vec *v, phys_vec *x_next,
                phys_vec *v_next),
               (n, h, ahead, bound, mass, free, f, x, v, x_next, v_next))
{
    typedef int64_t mask __attribute__((vector_size(32)));
    const phys_vec max = {bound, bound, bound, bound};
    mask well = {-1, -1, -1, -1};
    for (size_t i = 0; i < n; i++) {
        phys_fetch(mass + i, PHYS_FETCH, 0);
        phys_fetch(free + i, PHYS_FETCH, 0);
        const phys_vec a = free[i] * (f[i] / mass[i]), before = v[i], after = before + h * a;
        const phys_vec place = x[i] + h * (ahead ? after : before);
        well &= (place < max) & (place > -max) & (after < max) & (after > -max);
        x_next[i] = place;
        v_next[i] = after;
    }
    return (well[0] & well[1] & well[2] & well[3]) != 0;
}

void phys_kick(size_t n, double t, double ahead, const double *mass, const double *drag,
               const double *free, const phys_vec *f, const phys_vec *v, phys_vec *w)
{
    for (size_t i = 0; i < n; i++)
        w[i] = v[i] + free[i] * t / (mass[i] + ahead * t * drag[i]) * (f[i] - drag[i] * v[i]);
}

const struct phys_runge_row phys_runge_rows[PHYS_RUNGE_STAGES] = {
    {.at = 0, .weight = 1, .ahead = 0.5},
    {.at = 0.5, .weight = 2, .ahead = 0.5},
    {.at = 0.5, .weight = 2, .ahead = 1},
    {.at = 1, .weight = 1}};

void phys_runge_stage(size_t n, double h, int stage, const phys_vec *a, const struct phys_runge *r,
                      phys_vec *x, phys_vec *v)
{
    const struct phys_runge_row *row = phys_runge_rows + stage;
    const double ahead = row->ahead * h, sixth = h / 6;
    for (size_t i = 0; i < n; i++) {
        const phys_vec dx = v[i], dv = a[i];
        if (stage == 0) {
            r->x0[i] = x[i];
            r->v0[i] = v[i];
        }
        r->sum_x[i] = stage == 0 ? dx : r->sum_x[i] + row->weight * dx;
        r->sum_v[i] = stage == 0 ? dv : r->sum_v[i] + row->weight * dv;
        x[i] = r->x0[i] + (row->ahead > 0 ? ahead * dx : sixth * r->sum_x[i]);
        v[i] = r->v0[i] + (row->ahead > 0 ? ahead * dv : sixth * r->sum_v[i]);
    }
}

/* ---- Implicit steps ---- */

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
