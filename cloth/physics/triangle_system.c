/* Triangles in implicit steps: the matrix, and the right side with it, from one frame of each.
 * Triangles are worked on in order, four at a time (detail/lanes.h). */
#include "cloth/physics/triangle.h"

#include "cloth/physics/detail/membrane.h"

/* ---- Slopes ---- */

/* Parts of the slope of the forces besides the frame. */
struct slope {
    struct phys_plane2 t, q, n; /* T; T - c J of the strain; S^-1 q, of which reduced the positive
                                   part */
    phys_vec c, spin;           /* reduced: max(T : S, 0) */
    phys_vec rise[2];           /* of curved ones: the moduli beyond knees, less C */
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
    struct phys_plane2 e, s;
    const struct phys_plane2 *t = &slope->t, *q = &slope->q;
    slope->rise[0] = slope->rise[1] = (phys_vec){0};
    phys_frame_strain(f, &e);
    phys_frame_stress(f, &e, &slope->t);
    phys_frame_stiffen(f, &slope->t, slope->rise);
    phys_frame_s(f, &s);
    phys_frame_twist(f, t, &s, &slope->c);
    phys_frame_untwist(t, &slope->c, &slope->q);
    slope->spin = (t->uu * s.uu + t->vv * s.vv) + 2 * t->uv * s.uv;
    slope->n.uu = (s.vv * q->uu - s.uv * q->vu) * f->across;
    slope->n.vv = (s.uu * q->vv - s.uv * q->uv) * f->across;
    slope->n.uv = slope->n.vu = (s.vv * q->uv - s.uv * q->vv) * f->across;
    if (full)
        return;
    phys_positive(&slope->spin, &slope->spin);
    keep_positive(&slope->n);
}

/* The change of q by D = R' dF: a times that of the stiffness, b times that of the damping. */
PHYS_INLINE void slope_reduced(const struct phys_frame *f, const struct slope *slope, double a,
                               double b, const struct phys_plane2 *d, struct phys_plane2 *dq)
{
    const phys_vec shear = 0.5 * (d->uv + d->vu);
    const struct phys_plane2 e = {d->uu, shear, shear, d->vv};
    const phys_vec share = a + b * f->of->damping;
    struct phys_plane2 t;
    phys_frame_stress(f, &e, &t);
    const phys_vec c = -a * slope->spin * (d->vu - d->uv) * f->turn * f->turn;
    *dq = (struct phys_plane2){share * t.uu, share * t.uv + c, share * t.vu - c, share * t.vv};
    if (f->of->curved) {
        dq->uu += a * slope->rise[0] * e.uu;
        dq->vv += a * slope->rise[1] * e.vv;
    }
}

PHYS_INLINE void slope_full(const struct phys_frame *f, const struct slope *slope, double a,
                            double b, const struct phys_plane2 *d, struct phys_plane2 *dq)
{
    const struct phys_plane2 *q = &slope->q;
    struct phys_plane2 s, ds, dt;
    phys_vec w, damped, one, two;
    phys_frame_s(f, &s);
    phys_frame_change(f, d, &w, &ds);
    phys_frame_stress(f, &ds, &dt);
    phys_frame_twist(f, &dt, &s, &damped);
    phys_frame_twist(f, &slope->t, &ds, &one);
    two = slope->c * (ds.uu + ds.vv) * f->turn;
    const phys_vec share = a + b * f->of->damping;
    const phys_vec dc = share * damped + a * (one - two);
    dq->uu = share * dt.uu - a * w * q->vu;
    dq->uv = share * dt.uv - a * w * q->vv + dc;
    dq->vu = share * dt.vu + a * w * q->uu - dc;
    dq->vv = share * dt.vv + a * w * q->uv;
    if (f->of->curved) {
        dt = (struct phys_plane2){slope->rise[0] * ds.uu, {0}, {0}, slope->rise[1] * ds.vv};
        phys_frame_twist(f, &dt, &s, &damped);
        dq->uu += a * dt.uu;
        dq->uv += a * damped;
        dq->vu -= a * damped;
        dq->vv += a * dt.vv;
    }
}

PHYS_INLINE void slope_of(const struct phys_frame *f, const struct slope *slope, int full, double a,
                          double b, const struct phys_plane2 *d, struct phys_plane2 *dq)
{
    if (full)
        slope_full(f, slope, a, b, d, dq);
    else
        slope_reduced(f, slope, a, b, d, dq);
}

/* ---- Right side ---- */

/* T - c J of strain and damping, which phys_triangles_force pushes with. */
PHYS_INLINE void force_of(const struct phys_frame *f, const struct slope *slope,
                          const struct phys_plane2 *d, struct phys_plane2 *q)
{
    struct phys_plane2 ds, t, s;
    phys_vec w, c;
    phys_frame_change(f, d, &w, &ds);
    ds.uu *= f->of->damping;
    ds.uv *= f->of->damping;
    ds.vv *= f->of->damping;
    phys_frame_stress(f, &ds, &t);
    t.uu += slope->t.uu;
    t.uv += slope->t.uv;
    t.vv += slope->t.vv;
    t.vu = t.uv;
    phys_frame_s(f, &s);
    phys_frame_twist(f, &t, &s, &c);
    c *= f->of->corrected;
    phys_frame_untwist(&t, &c, q);
}

/* b += push f - a K v. */
PHYS_INLINE void add_right_side(const struct phys_elements *t, const struct phys_four *four,
                                const struct phys_frame *f, const struct slope *slope, int full,
                                double a, double push, const struct phys_sight *sight, phys_vec *b)
{
    struct phys_wide fu, fv;
    struct phys_plane2 d, q, dq;
    phys_vec nu, nv;
    phys_frame_slope(t, four, f, sight->n, sight->v, sight->v_ghost, &fu, &fv);
    phys_frame_inside(f, &fu, &fv, &d);
    force_of(f, slope, &d, &q);
    slope_of(f, slope, full, a, 0, &d, &dq);
    dq.uu += push * q.uu;
    dq.uv += push * q.uv;
    dq.vu += push * q.vu;
    dq.vv += push * q.vv;
    phys_wide_dot(&f->normal, &fu, &nu);
    phys_wide_dot(&f->normal, &fv, &nv);
    const phys_vec along[2] = {a * (nu * slope->n.uu + nv * slope->n.uv),
                               a * (nu * slope->n.uv + nv * slope->n.vv)};
    phys_frame_push(t, four, f, &dq, along, sight->n, b);
}

/* ---- Matrix ---- */

/* A block of the matrix in the frame, -area times the slope of q g_i for D = . g_j, as
 *
 *     uu ru ru' + vv rv rv' + symmetric (ru rv' + rv ru') + antisymmetric (ru rv' - rv ru') + along
 * n n'
 */
struct block {
    phys_vec uu, vv, symmetric, antisymmetric, along;
};

/* -area times the change of q by D, h^2 times that of the stiffness plus h times that of the
 * damping:
 *
 *     du: q = (c11 gu, p gv, m gv, c12 gu),   dv: q = (c12 gv, m gu, p gu, c22 gv) */
struct stiff {
    phys_vec c11, c12, c22, p, m, nuu, nuv, nvv;
};

PHYS_INLINE void stiff_make(const struct phys_frame *f, const struct slope *slope, double h,
                            struct stiff *stiff)
{
    const struct phys_moduli *c = f->of;
    const double a = h * h;
    const phys_vec area = -f->area, share = area * (a + h * c->damping);
    const phys_vec shear = share * c->c33, spin = a * area * slope->spin * f->turn * f->turn;
    *stiff = (struct stiff){.c11 = share * c->c11,
                            .c12 = share * c->c12,
                            .c22 = share * c->c22,
                            .p = shear + spin,
                            .m = shear - spin,
                            .nuu = a * area * slope->n.uu,
                            .nuv = a * area * slope->n.uv,
                            .nvv = a * area * slope->n.vv};
    if (c->curved) {
        stiff->c11 += a * area * slope->rise[0];
        stiff->c22 += a * area * slope->rise[1];
    }
}

PHYS_INLINE void block_reduced(const struct phys_frame *f, const struct stiff *stiff, int i, int j,
                               struct block *block)
{
    const phys_vec uu = f->gu[i] * f->gu[j], vv = f->gv[i] * f->gv[j];
    const phys_vec uv = f->gu[i] * f->gv[j], vu = f->gv[i] * f->gu[j];
    block->uu = stiff->c11 * uu + stiff->p * vv;
    block->vv = stiff->p * uu + stiff->c22 * vv;
    block->symmetric = 0.5 * (stiff->c12 + stiff->m) * (uv + vu);
    block->antisymmetric = 0.5 * (stiff->c12 - stiff->m) * (uv - vu);
    block->along = stiff->nuu * uu + stiff->nvv * vv + stiff->nuv * (uv + vu);
}

PHYS_INLINE void block_full(const struct phys_frame *f, const struct slope *slope,
                            const struct stiff *stiff, double h, int i, int j, struct block *block)
{
    const struct phys_plane2 du = {f->gu[j], f->gv[j], {0}, {0}},
                             dv = {{0}, {0}, f->gu[j], f->gv[j]};
    const phys_vec gu = -f->area * f->gu[i], gv = -f->area * f->gv[i];
    struct phys_plane2 qu, qv;
    block_reduced(f, stiff, i, j, block); /* the part along the normal stays */
    slope_full(f, slope, h * h, h, &du, &qu);
    slope_full(f, slope, h * h, h, &dv, &qv);
    const phys_vec uv = qv.uu * gu + qv.uv * gv, vu = qu.vu * gu + qu.vv * gv;
    block->uu = qu.uu * gu + qu.uv * gv;
    block->vv = qv.vu * gu + qv.vv * gv;
    block->symmetric = 0.5 * (uv + vu);
    block->antisymmetric = 0.5 * (uv - vu);
}

/* Rotates blocks into the world: components 00 11 22, 01 12 20 of ru ru', rv rv', ru rv' + rv ru'.
 * The matrix n n' is the unit matrix minus the first two; without a normal nothing is along it. The
 * matrix ru rv' - rv ru' has the normal's components. */
struct world {
    phys_vec uu[6], vv[6], uv[6];
};

PHYS_INLINE void world_make(const struct phys_frame *f, struct world *world)
{
    const phys_vec *u = f->ru.c, *v = f->rv.c;
    PHYS_UNROLL
    for (int r = 0; r < 3; r++) {
        const int c = (r + 1) % 3;
        world->uu[r] = u[r] * u[r];
        world->uu[3 + r] = u[r] * u[c];
        world->vv[r] = v[r] * v[r];
        world->vv[3 + r] = v[r] * v[c];
        world->uv[r] = 2 * (u[r] * v[r]);
        world->uv[3 + r] = u[r] * v[c] + v[r] * u[c];
    }
}

/* Writes a block as that of one pair of the corners, transposed where at says so. */
PHYS_INLINE void write_block(const struct phys_four *four, const struct phys_frame *f,
                             const struct world *world, const struct block *block,
                             const uint32_t *at, struct phys_pair *pair)
{
    const phys_vec uu = block->uu - block->along, vv = block->vv - block->along;
    phys_vec antisymmetric = block->antisymmetric, cyclic[3][3], symmetric[6];
    phys_mask transposed;
    phys_transposed(four, at, 3, &transposed);
    phys_negate(&transposed, &antisymmetric);
    PHYS_UNROLL
    for (int k = 0; k < 6; k++)
        symmetric[k] = uu * world->uu[k] + vv * world->vv[k] + block->symmetric * world->uv[k];
    PHYS_UNROLL
    for (int r = 0; r < 3; r++) {
        cyclic[0][r] = symmetric[r] + block->along;
        cyclic[1][r] = symmetric[3 + r] + antisymmetric * f->normal.c[(r + 2) % 3];
        cyclic[2][r] = symmetric[3 + (r + 2) % 3] - antisymmetric * f->normal.c[(r + 1) % 3];
    }
    phys_write_pairs(four, cyclic, 3, pair);
}

PHYS_INLINE void write_blocks(const struct phys_four *four, const struct phys_frame *f,
                              const struct slope *slope, double h, int full, const uint32_t *at,
                              struct phys_pair *pair)
{
    static const int corner[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    struct stiff stiff;
    struct world world;
    stiff_make(f, slope, h, &stiff);
    world_make(f, &world);
    PHYS_UNROLL
    for (int k = 0; k < 3; k++) {
        struct block block;
        if (full)
            block_full(f, slope, &stiff, h, corner[k][0], corner[k][1], &block);
        else
            block_reduced(f, &stiff, corner[k][0], corner[k][1], &block);
        write_block(four, f, &world, &block, at ? at + k : NULL, pair + k);
    }
}

/* ---- Both ---- */

/* The results wanted: b may be NULL. stiffest: as if each thread were where it is stiffest. */
struct wanted {
    double h, push;
    int full, stiffest;
    const struct phys_sight *sight;
    phys_vec *b;
};

/* Beyond all knees that stiffen. */
PHYS_INLINE void slope_rise(const struct phys_moduli *moduli, struct slope *slope)
{
    for (int d = 0; d < 2; d++) {
        slope->rise[d] = (phys_vec){0};
        for (int k = 0; moduli->curved && k < PHYS_KNEES; k++) {
            phys_vec more;
            phys_positive(&moduli->more[d][k], &more);
            slope->rise[d] += more;
        }
    }
}

PHYS_INLINE void work(const struct phys_elements *t, size_t first, size_t end,
                      const struct wanted *wanted, struct phys_moduli *moduli, const uint32_t *at,
                      struct phys_pair *pair)
{
    const double h = wanted->h;
    struct phys_four four;
    struct phys_frame frame;
    struct slope slope;
    phys_four_from(first, end, &four);
    phys_frame_make(t, &four, wanted->sight, moduli, &frame);
    slope_make(&frame, wanted->full, &slope);
    if (wanted->stiffest)
        slope_rise(moduli, &slope);
    if (wanted->b)
        add_right_side(t, &four, &frame, &slope, wanted->full, h * h, wanted->push, wanted->sight,
                       wanted->b);
    write_blocks(&four, &frame, &slope, h, wanted->full, at, pair);
}

PHYS_INLINE void work_all(const struct phys_elements *t, size_t from, size_t to,
                          const struct wanted *wanted, const uint32_t *at, struct phys_pair *pair)
{
    struct phys_moduli moduli = PHYS_NO_MODULI;
    size_t i = from;
    for (; to - i >= PHYS_WIDE; i += PHYS_WIDE)
        work(t, i, i + PHYS_WIDE, wanted, &moduli, at ? at + 3 * (i - from) : NULL,
             pair + 3 * (i - from));
    if (i < to)
        work(t, i, to, wanted, &moduli, at ? at + 3 * (i - from) : NULL, pair + 3 * (i - from));
}

PHYS_KERNEL(phys_triangles_matrix,
            (const struct phys_elements *triangles, size_t from, size_t to,
             const struct phys_step *step, const struct phys_sight *sight, const uint32_t *at,
             struct phys_pair *pair),
            (triangles, from, to, step, sight, at, pair))
{
    const struct wanted reduced = {step->h, 0, 0, 0, sight, NULL},
                        full = {step->h, 0, 1, 0, sight, NULL};
    if (step->full)
        work_all(triangles, from, to, &full, at, pair);
    else
        work_all(triangles, from, to, &reduced, at, pair);
}

void phys_triangles_stiffest(const struct phys_elements *triangles, size_t from, size_t to,
                             const struct phys_step *step, const struct phys_sight *sight,
                             const uint32_t *at, struct phys_pair *pair)
{
    const struct wanted stiffest = {step->h, 0, 0, 1, sight, NULL};
    work_all(triangles, from, to, &stiffest, at, pair);
}

PHYS_KERNEL(phys_triangles_system,
            (const struct phys_elements *triangles, size_t from, size_t to,
             const struct phys_step *step, double push, const struct phys_sight *sight,
             const uint32_t *at, phys_vec *b, struct phys_pair *pair),
            (triangles, from, to, step, push, sight, at, b, pair))
{
    const struct wanted reduced = {step->h, push, 0, 0, sight, b},
                        full = {step->h, push, 1, 0, sight, b};
    if (step->full)
        work_all(triangles, from, to, &full, at, pair);
    else
        work_all(triangles, from, to, &reduced, at, pair);
}
