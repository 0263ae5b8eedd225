/* A held row has zero acceleration and velocity, so it does not move. */
#include "cloth/physics/stage.h"

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

static void first(size_t n, double h, const phys_vec *a, const struct phys_runge *r, phys_vec *x,
                  phys_vec *v)
{
    for (size_t i = 0; i < n; i++) {
        r->x0[i] = x[i];
        r->v0[i] = v[i];
        r->sum_x[i] = v[i];
        r->sum_v[i] = a[i];
        x[i] += 0.5 * h * v[i];
        v[i] += 0.5 * h * a[i];
    }
}

static void middle(size_t n, double h, const phys_vec *a, const struct phys_runge *r, phys_vec *x,
                   phys_vec *v)
{
    for (size_t i = 0; i < n; i++) {
        r->sum_x[i] += 2 * v[i];
        r->sum_v[i] += 2 * a[i];
        x[i] = r->x0[i] + h * v[i];
        v[i] = r->v0[i] + h * a[i];
    }
}

static void last(size_t n, double h, const phys_vec *a, const struct phys_runge *r, phys_vec *x,
                 phys_vec *v)
{
    for (size_t i = 0; i < n; i++) {
        x[i] = r->x0[i] + h / 6 * (r->sum_x[i] + v[i]);
        v[i] = r->v0[i] + h / 6 * (r->sum_v[i] + a[i]);
    }
}

void phys_runge_stage(size_t n, double h, int stage, const phys_vec *a,
                      const struct phys_runge *runge, phys_vec *x, phys_vec *v)
{
    if (stage == 0)
        first(n, h, a, runge, x, v);
    else if (stage == PHYS_RUNGE_STAGES - 1)
        last(n, h, a, runge, x, v);
    else
        middle(n, stage == 1 ? 0.5 * h : h, a, runge, x, v);
}
