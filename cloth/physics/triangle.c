/* Triangles are worked on in order, four at a time (detail/lanes.h). Corner 0 has what the two
 * others have with a minus, so that a triangle's forces sum to nothing but rounding. */
#include "cloth/physics/triangle.h"

#include "cloth/physics/detail/membrane.h"

#include <math.h>

int phys_membrane_make(double warp, double weft, double shear, double poisson, double damping,
                       struct phys_membrane *membrane)
{
    const double product = poisson != 0 ? poisson * poisson * weft / warp : 0; /* nu12 nu21 */
    if (!(warp >= 0) || !(weft >= 0) || !(shear >= 0) || !(product < 1) || !isfinite(poisson) ||
        !isfinite(warp + weft + shear) || !(damping >= 0) || !isfinite(damping))
        return -1;
    const double c11 = warp / (1 - product), c22 = weft / (1 - product);
    *membrane = (struct phys_membrane){{c11, poisson * c22, c22, shear}, damping, 0};
    return 0;
}

int phys_triangle_rest(const double uv[6], double gradient[4], double *area)
{
    const double au = uv[2] - uv[0], av = uv[3] - uv[1];
    const double bu = uv[4] - uv[0], bv = uv[5] - uv[1];
    const double det = au * bv - av * bu;
    gradient[0] = bv / det;
    gradient[1] = -bu / det;
    gradient[2] = -av / det;
    gradient[3] = au / det;
    *area = 0.5 * fabs(det);
    for (int i = 0; i < 4; i++)
        if (!isfinite(gradient[i]))
            return -1;
    return *area > 0 && isfinite(*area) ? 0 : -1;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* R of the map from uv to x, as phys_frame_polar finds it; 0 if it has none. */
static int directions(const double e[2][3], const double uv[6], double ru[3], double rv[3])
{
    double g[4], area, f[2][3], normal[3], turned[2][3];
    if (phys_triangle_rest(uv, g, &area))
        return 0;
    for (int i = 0; i < 3; i++) {
        f[0][i] = e[0][i] * g[0] + e[1][i] * g[2];
        f[1][i] = e[0][i] * g[1] + e[1][i] * g[3];
    }
    cross(f[0], f[1], normal);
    const double det = sqrt(dot(normal, normal));
    for (int i = 0; i < 3; i++)
        normal[i] /= det;
    const double trace = sqrt(dot(f[0], f[0]) + dot(f[1], f[1]) + 2 * det);
    cross(f[1], normal, turned[0]);
    cross(normal, f[0], turned[1]);
    for (int i = 0; i < 3; i++) {
        ru[i] = (f[0][i] + turned[0][i]) / trace;
        rv[i] = (f[1][i] + turned[1][i]) / trace;
    }
    return det > 0 && isfinite(trace);
}

void phys_triangle_local(const double x[9], const double uv[6], double local[6])
{
    double e[2][3], ru[3], rv[3], normal[3];
    for (int i = 0; i < 3; i++) {
        e[0][i] = x[3 + i] - x[i];
        e[1][i] = x[6 + i] - x[i];
    }
    if (!directions((const double(*)[3])e, uv, ru, rv)) {
        const double length = sqrt(dot(e[0], e[0]));
        cross(e[0], e[1], normal);
        const double area = sqrt(dot(normal, normal));
        for (int i = 0; i < 3; i++)
            ru[i] = length > 0 ? e[0][i] / length : 0;
        cross(normal, ru, rv);
        for (int i = 0; i < 3; i++)
            rv[i] = area > 0 ? rv[i] / area : 0;
    }
    local[0] = local[1] = 0;
    for (int i = 0; i < 2; i++) {
        local[2 + 2 * i] = dot(e[i], ru);
        local[3 + 2 * i] = dot(e[i], rv);
    }
}

/* Adds -area (P_u g_u + P_v g_v), P = R q + normal k, k the pull along the normal or NULL, to the
 * rows of the corners. */
PHYS_INLINE void add_forces(const struct phys_triangles *t, const struct phys_four *four,
                            const struct phys_frame *f, const struct phys_plane2 *q,
                            const phys_vec *along, uint32_t n, phys_vec *y)
{
    struct phys_wide pu, pv, first = {{{0}}};
    phys_wide_mix(&q->uu, &f->ru, &q->vu, &f->rv, &pu);
    phys_wide_mix(&q->uv, &f->ru, &q->vv, &f->rv, &pv);
    for (int i = 0; along && i < 3; i++) {
        pu.c[i] += along[0] * f->normal.c[i];
        pv.c[i] += along[1] * f->normal.c[i];
    }
    for (int k = 1; k < 3; k++) {
        const phys_vec gu = -f->area * f->gu[k], gv = -f->area * f->gv[k];
        struct phys_wide add;
        phys_wide_mix(&gu, &pu, &gv, &pv, &add);
        phys_wide_from(&first, &add, &first);
        phys_scatter(four, t->corner, k, n, &add, y);
    }
    phys_scatter(four, t->corner, 0, n, &first, y);
}

PHYS_KERNEL(phys_triangles_force,
            (const struct phys_triangles *t, const struct phys_sight *sight, phys_vec *f),
            (t, sight, f))
{
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_wide vu, vv;
        struct phys_plane2 e, d, ds, s, stress, q;
        phys_vec w, c;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &frame);
        phys_frame_slope(t, &four, &frame, sight->n, sight->v, sight->v_copy, &vu, &vv);
        phys_frame_inside(&frame, &vu, &vv, &d);
        phys_frame_change(&frame, &d, &w, &ds);
        phys_frame_strain(&frame, &e);
        e.uu += frame.damping * ds.uu;
        e.uv += frame.damping * ds.uv;
        e.vv += frame.damping * ds.vv;
        phys_frame_stress(&frame, &e, &stress);
        phys_frame_s(&frame, &s);
        phys_frame_twist(&frame, &stress, &s, &c);
        c *= frame.corrected;
        phys_frame_untwist(&stress, &c, &q);
        add_forces(t, &four, &frame, &q, NULL, sight->n, f);
    }
}

/* ---- Slopes ---- */

/* What the slope of the forces is made of besides the frame. */
struct slope {
    struct phys_plane2 q, n; /* T - c J of the strain; S^-1 q, of which reduced the positive part */
    phys_vec c, spin;        /* reduced: max(T : S, 0) */
};

/* n -> its part with eigenvalues above 0; n is symmetric. */
PHYS_INLINE void keep_positive(struct phys_plane2 *n)
{
    const phys_vec mean = 0.5 * (n->uu + n->vv), half = 0.5 * (n->uu - n->vv);
    const phys_vec square = half * half + n->uv * n->uv;
    phys_vec radius, inverse, high, low;
    phys_sqrt(&square, &radius);
    high = mean + radius;
    low = mean - radius;
    phys_positive(&high, &high);
    phys_positive(&low, &low);
    radius *= 2;
    phys_inverse(&radius, &inverse);
    /* low I + (high - low) (n - (mean - radius) I) / (2 radius): equal ones have no direction. */
    const phys_vec share = (high - low) * inverse;
    const phys_vec base = 0.5 * (high + low);
    n->uu = base + share * half;
    n->vv = base - share * half;
    n->uv = n->vu = share * n->uv;
}

PHYS_INLINE void slope_make(const struct phys_frame *f, int full, struct slope *slope)
{
    struct phys_plane2 e, t, s;
    phys_vec inverse;
    phys_frame_strain(f, &e);
    phys_frame_stress(f, &e, &t);
    phys_frame_s(f, &s);
    phys_frame_twist(f, &t, &s, &slope->c);
    phys_frame_untwist(&t, &slope->c, &slope->q);
    slope->spin = (t.uu * s.uu + t.vv * s.vv) + 2 * t.uv * s.uv;
    phys_inverse(&f->det, &inverse);
    const struct phys_plane2 *q = &slope->q;
    slope->n.uu = (s.vv * q->uu - s.uv * q->vu) * inverse;
    slope->n.vv = (s.uu * q->vv - s.uv * q->uv) * inverse;
    slope->n.uv = slope->n.vu = (s.vv * q->uv - s.uv * q->vv) * inverse;
    if (full)
        return;
    phys_positive(&slope->spin, &slope->spin);
    keep_positive(&slope->n);
}

/* What the change D = R' dF makes of q: a times that of the stiffness, b times that of the damping.
 */
PHYS_INLINE void slope_reduced(const struct phys_frame *f, const struct slope *slope, double a,
                               double b, const struct phys_plane2 *d, struct phys_plane2 *dq)
{
    const phys_vec shear = 0.5 * (d->uv + d->vu);
    const struct phys_plane2 e = {d->uu, shear, shear, d->vv};
    const phys_vec share = a + b * f->damping;
    struct phys_plane2 t;
    phys_frame_stress(f, &e, &t);
    const phys_vec c = -a * slope->spin * (d->vu - d->uv) * f->turn * f->turn;
    *dq = (struct phys_plane2){share * t.uu, share * t.uv + c, share * t.vu - c, share * t.vv};
}

PHYS_INLINE void slope_full(const struct phys_frame *f, const struct slope *slope, double a,
                            double b, const struct phys_plane2 *d, struct phys_plane2 *dq)
{
    const struct phys_plane2 *q = &slope->q;
    struct phys_plane2 s, ds, dt, t;
    phys_vec w, damped, one, two;
    phys_frame_s(f, &s);
    phys_frame_change(f, d, &w, &ds);
    phys_frame_stress(f, &ds, &dt);
    phys_frame_twist(f, &dt, &s, &damped);
    t = (struct phys_plane2){q->uu, q->uv - slope->c, q->uv - slope->c, q->vv};
    phys_frame_twist(f, &t, &ds, &one);
    two = slope->c * (ds.uu + ds.vv) * f->turn;
    const phys_vec share = a + b * f->damping;
    const phys_vec dc = share * damped + a * (one - two);
    dq->uu = share * dt.uu - a * w * q->vu;
    dq->uv = share * dt.uv - a * w * q->vv + dc;
    dq->vu = share * dt.vu + a * w * q->uu - dc;
    dq->vv = share * dt.vv + a * w * q->uv;
}

PHYS_INLINE void slope_of(const struct phys_frame *f, const struct slope *slope, int full, double a,
                          double b, const struct phys_plane2 *d, struct phys_plane2 *dq)
{
    if (full)
        slope_full(f, slope, a, b, d, dq);
    else
        slope_reduced(f, slope, a, b, d, dq);
}

PHYS_INLINE void stiffness(const struct phys_triangles *t, int full, double scale,
                           const struct phys_sight *sight, phys_vec *y)
{
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct slope slope;
        struct phys_wide fu, fv;
        struct phys_plane2 d, dq;
        phys_vec nu, nv;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &frame);
        slope_make(&frame, full, &slope);
        phys_frame_slope(t, &four, &frame, sight->n, sight->v, sight->v_copy, &fu, &fv);
        phys_frame_inside(&frame, &fu, &fv, &d);
        slope_of(&frame, &slope, full, scale, 0, &d, &dq);
        phys_wide_dot(&frame.normal, &fu, &nu);
        phys_wide_dot(&frame.normal, &fv, &nv);
        const phys_vec along[2] = {scale * (nu * slope.n.uu + nv * slope.n.uv),
                                   scale * (nu * slope.n.uv + nv * slope.n.vv)};
        add_forces(t, &four, &frame, &dq, along, sight->n, y);
    }
}

PHYS_KERNEL(phys_triangles_stiffness,
            (const struct phys_triangles *triangles, int full, double scale,
             const struct phys_sight *sight, phys_vec *y),
            (triangles, full, scale, sight, y))
{
    if (full)
        stiffness(triangles, 1, scale, sight, y);
    else
        stiffness(triangles, 0, scale, sight, y);
}

/* ---- Matrix ---- */

/* A block of the matrix in the frame: 2 x 2 in the plane and one number along the normal. */
struct block {
    struct phys_plane2 in;
    phys_vec along;
};

/* area times: the slope of corner i's force against corner j, i.e. of q g_i for D = . g_j. */
PHYS_INLINE void block_of(const struct phys_frame *f, const struct slope *slope, int full, double a,
                          double b, int i, int j, struct block *block)
{
    const struct phys_plane2 du = {f->gu[j], f->gv[j], {0}, {0}},
                             dv = {{0}, {0}, f->gu[j], f->gv[j]};
    const phys_vec gu = f->area * f->gu[i], gv = f->area * f->gv[i];
    struct phys_plane2 qu, qv;
    slope_of(f, slope, full, a, b, &du, &qu);
    slope_of(f, slope, full, a, b, &dv, &qv);
    block->in.uu = qu.uu * gu + qu.uv * gv;
    block->in.vu = qu.vu * gu + qu.vv * gv;
    block->in.uv = qv.uu * gu + qv.uv * gv;
    block->in.vv = qv.vu * gu + qv.vv * gv;
    block->along = a * ((f->gu[j] * slope->n.uu + f->gv[j] * slope->n.uv) * gu +
                        (f->gu[j] * slope->n.uv + f->gv[j] * slope->n.vv) * gv);
}

/* Turns a block into the world and writes it as that of one pair of the corners, with a minus. */
PHYS_INLINE void write_block(const struct phys_four *four, const struct phys_frame *f,
                             const struct block *block, struct phys_pair *pair)
{
    phys_vec n[3][3];
    for (int c = 0; c < 3; c++) {
        const phys_vec u = -(block->in.uu * f->ru.c[c] + block->in.uv * f->rv.c[c]);
        const phys_vec v = -(block->in.vu * f->ru.c[c] + block->in.vv * f->rv.c[c]);
        const phys_vec along = -(block->along * f->normal.c[c]);
        for (int r = 0; r < 3; r++)
            n[r][c] = u * f->ru.c[r] + v * f->rv.c[r] + along * f->normal.c[r];
    }
    phys_write_pairs(four, n, 3, pair);
}

/* -(first + second), or with the second turned over. */
PHYS_INLINE void block_rest(const struct block *first, const struct block *second, int turned,
                            struct block *rest)
{
    rest->in.uu = -first->in.uu - second->in.uu;
    rest->in.uv = -first->in.uv - (turned ? second->in.vu : second->in.uv);
    rest->in.vu = -first->in.vu - (turned ? second->in.uv : second->in.vu);
    rest->in.vv = -first->in.vv - second->in.vv;
    rest->along = -first->along - second->along;
}

PHYS_INLINE void matrix(const struct phys_triangles *t, size_t from, size_t to, double h, int full,
                        const struct phys_sight *sight, struct phys_pair *pair)
{
    for (size_t first = from; first < to; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct slope slope;
        struct block b11, b12, b22, b01, b02;
        phys_four_from(first, to, &four);
        phys_frame_make(t, &four, sight, &frame);
        slope_make(&frame, full, &slope);
        block_of(&frame, &slope, full, h * h, h, 1, 1, &b11);
        block_of(&frame, &slope, full, h * h, h, 1, 2, &b12);
        block_of(&frame, &slope, full, h * h, h, 2, 2, &b22);
        block_rest(&b11, &b12, 1, &b01); /* row 0 is minus the sum of rows 1 and 2 */
        block_rest(&b22, &b12, 0, &b02);
        write_block(&four, &frame, &b01, pair + 3 * (first - from));
        write_block(&four, &frame, &b02, pair + 3 * (first - from) + 1);
        write_block(&four, &frame, &b12, pair + 3 * (first - from) + 2);
    }
}

PHYS_KERNEL(phys_triangles_matrix,
            (const struct phys_triangles *triangles, size_t from, size_t to,
             const struct phys_step *step, const struct phys_sight *sight, struct phys_pair *pair),
            (triangles, from, to, step, sight, pair))
{
    if (step->full)
        matrix(triangles, from, to, step->h, 1, sight, pair);
    else
        matrix(triangles, from, to, step->h, 0, sight, pair);
}

/* ---- What a state says of itself ---- */

PHYS_KERNEL_OF(double, phys_triangles_energy,
               (const struct phys_triangles *t, const struct phys_sight *sight), (t, sight))
{
    double sum = 0;
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_plane2 e, s;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &frame);
        phys_frame_strain(&frame, &e);
        phys_frame_stress(&frame, &e, &s);
        const phys_vec energy = 0.5 * frame.area * (s.uu * e.uu + s.vv * e.vv + 2 * s.uv * e.uv);
        sum = phys_sum_own(&four, t->corner, sight->n, &energy, sum);
    }
    return sum;
}

PHYS_KERNEL_OF(double, phys_triangles_stretch,
               (const struct phys_triangles *t, const struct phys_sight *sight), (t, sight))
{
    double most = 0;
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        phys_vec radius;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &frame);
        const phys_vec half = 0.5 * (frame.suu - frame.svv);
        const phys_vec square = half * half + frame.suv * frame.suv;
        phys_sqrt(&square, &radius);
        radius += 0.5 * frame.trace;
        for (size_t i = 0; i < four.valid; i++)
            if (radius[i] > most)
                most = radius[i];
    }
    return most;
}

PHYS_KERNEL(phys_triangles_torque,
            (const struct phys_triangles *t, const struct phys_sight *sight, double torque[3]),
            (t, sight, torque))
{
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_plane2 e, stress, s;
        phys_vec c;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &frame);
        phys_frame_strain(&frame, &e);
        phys_frame_stress(&frame, &e, &stress);
        phys_frame_s(&frame, &s);
        phys_frame_twist(&frame, &stress, &s, &c);
        c *= -frame.area * frame.trace;
        for (int k = 0; k < 3; k++) {
            const phys_vec part = c * frame.normal.c[k];
            torque[k] = phys_sum_own(&four, t->corner, sight->n, &part, torque[k]);
        }
    }
}
