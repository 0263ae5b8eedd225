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
