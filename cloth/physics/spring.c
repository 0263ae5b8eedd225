/* A spring's values depend on the difference of its ends only, and swapping the ends changes signs
 * but no other bit. */
#include "cloth/physics/spring.h"

#include <math.h>

/* Direction u from a to b and length l of a spring. */
PHYS_INLINE double direction(const phys_vec *xa, const phys_vec *xb, phys_vec *u)
{
    const phys_vec d = *xb - *xa;
    const double l = sqrt(phys_dot(&d, &d));
    *u = l > 0 ? d * (1 / l) : d;
    return l;
}

/* Share t of the stiffness that acts across a spring. */
PHYS_INLINE double transverse(const struct phys_springs *s, size_t i, double l)
{
    const double rest = s->length[i];
    return l > rest || (s->full && l > 0) ? 1 - rest / l : 0;
}

/* The pull on a of spring i. */
PHYS_INLINE void pull(const struct phys_springs *s, size_t i, const phys_vec *xa,
                      const phys_vec *xb, const phys_vec *va, const phys_vec *vb, phys_vec *f)
{
    phys_vec u;
    const double l = direction(xa, xb, &u);
    const phys_vec dv = *vb - *va;
    *f = (s->stiffness[i] * (l - s->length[i]) + s->damping[i] * phys_dot(&u, &dv)) * u;
}

void phys_springs_force(const struct phys_springs *springs, const phys_vec *x, const phys_vec *v,
                        phys_vec *f)
{
    for (size_t i = 0; i < springs->n; i++) {
        const uint32_t a = springs->end[i][0], b = springs->end[i][1];
        phys_vec t;
        pull(springs, i, x + a, x + b, v + a, v + b, &t);
        f[a] += t;
        f[b] -= t;
    }
}

void phys_springs_force_cut(const struct phys_springs *springs, const phys_vec *x,
                            const phys_vec *v, const phys_vec *x_other, const phys_vec *v_other,
                            phys_vec *f)
{
    for (size_t i = 0; i < springs->n; i++) {
        const uint32_t a = springs->end[i][0], b = springs->end[i][1];
        phys_vec t;
        pull(springs, i, x + a, x_other + b, v + a, v_other + b, &t);
        f[a] += t;
    }
}

/* scale K d of spring i, K = k t I + k (1 - t) u u'. */
PHYS_INLINE void stiff(const struct phys_springs *s, size_t i, double scale, const phys_vec *xa,
                       const phys_vec *xb, const phys_vec *d, phys_vec *y)
{
    phys_vec u;
    const double t = transverse(s, i, direction(xa, xb, &u));
    const double k = scale * s->stiffness[i];
    *y = k * t * *d + k * (1 - t) * phys_dot(&u, d) * u;
}

void phys_springs_stiffness(const struct phys_springs *springs, double scale, const phys_vec *x,
                            const phys_vec *v, phys_vec *y)
{
    for (size_t i = 0; i < springs->n; i++) {
        const uint32_t a = springs->end[i][0], b = springs->end[i][1];
        const phys_vec d = v[a] - v[b];
        phys_vec t;
        stiff(springs, i, scale, x + a, x + b, &d, &t);
        y[a] -= t;
        y[b] += t;
    }
}

void phys_springs_stiffness_cut(const struct phys_springs *springs, double scale, const phys_vec *x,
                                const phys_vec *v, const phys_vec *x_other, const phys_vec *v_other,
                                phys_vec *y)
{
    for (size_t i = 0; i < springs->n; i++) {
        const uint32_t a = springs->end[i][0], b = springs->end[i][1];
        const phys_vec d = v[a] - v_other[b];
        phys_vec t;
        stiff(springs, i, scale, x + a, x_other + b, &d, &t);
        y[a] -= t;
    }
}

void phys_springs_matrix(const struct phys_springs *springs, double h, const phys_vec *x,
                         const phys_vec *x_other, phys_vec *value)
{
    for (size_t i = 0; i < springs->n; i++) {
        phys_vec u;
        const double l = direction(x + springs->end[i][0], x_other + springs->end[i][1], &u);
        const double t = transverse(springs, i, l);
        const double k = h * h * springs->stiffness[i];
        value[i] = sqrt(k * (1 - t) + h * springs->damping[i]) * u; /* w w' */
        value[i][3] = k * t;                                        /* alpha */
    }
}

void phys_springs_range(const struct phys_springs *springs, const unsigned char *chosen,
                        const phys_vec *x, const phys_vec *x_other, double range[2])
{
    for (size_t i = 0; i < springs->n; i++) {
        phys_vec u;
        const double l = direction(x + springs->end[i][0], x_other + springs->end[i][1], &u);
        const double stretch = l / springs->length[i];
        if (chosen[i] && stretch < range[0])
            range[0] = stretch;
        if (chosen[i] && stretch > range[1])
            range[1] = stretch;
    }
}

double phys_springs_stretch(const struct phys_springs *springs, const unsigned char *chosen,
                            const phys_vec *x, const phys_vec *x_other)
{
    double range[2] = {0};
    phys_springs_range(springs, chosen, x, x_other, range);
    return range[1];
}
