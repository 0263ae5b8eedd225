#ifndef CLOTH_PHYSICS_DETAIL_MEMBRANE_H
#define CLOTH_PHYSICS_DETAIL_MEMBRANE_H

#include "cloth/physics/detail/lanes.h"
#include "cloth/physics/triangle.h"

/* Four triangles at once, in the frame of each: R's columns and the normal. Everything is inlined
 * and written for registers. */

/* A 2 x 2 matrix, first index down. */
struct phys_plane2 {
    phys_vec uu, uv, vu, vv;
};

/* A membrane a lane; four triangles in a row nearly always have that of the four before. */
struct phys_moduli {
    uint32_t of[PHYS_WIDE];               /* number of the membrane; at first none's */
    phys_vec c11, c12, c22, c33, damping; /* N/m; s */
    phys_vec corrected;                   /* 1; or 0 of uncorrected forces */
    int curved;                           /* one of the four has knees: */
    phys_vec at[2][PHYS_KNEES], more[2][PHYS_KNEES];
};
#define PHYS_NO_MODULI                                                                             \
    {                                                                                              \
        .of = { UINT32_MAX }                                                                       \
    }

struct phys_frame {
    struct phys_wide ru, rv, normal;
    phys_vec suu, suv, svv;       /* S */
    phys_vec det, across;         /* of S; 1 / det, 0 where that is 0 */
    phys_vec trace, turn;         /* of S; 1 / trace, or 0 */
    phys_vec gu[3], gv[3], area;  /* gradients of the corners */
    const struct phys_moduli *of; /* of the membranes */
};

PHYS_INLINE void phys_moduli_take_knees(struct phys_moduli *moduli, int lane,
                                        const struct phys_stiffening *stiffening)
{
    for (int d = 0; d < 2; d++)
        for (int k = 0; k < PHYS_KNEES; k++) {
            moduli->at[d][k][lane] = stiffening->at[d][k];
            moduli->more[d][k][lane] = stiffening->more[d][k];
        }
}

PHYS_INLINE void phys_moduli_take(const struct phys_elements *t, const struct phys_four *four,
                                  struct phys_moduli *moduli)
{
    uint32_t of[PHYS_WIDE], others = 0;
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++) {
        of[i] = t->corner[four->at[i]][3];
        others |= of[i] ^ moduli->of[i];
    }
    if (!others)
        return;
    phys_vec row[PHYS_WIDE], column[PHYS_WIDE];
    moduli->curved = 0;
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++) {
        const struct phys_membrane *membrane = (const struct phys_membrane *)t->material + of[i];
        moduli->of[i] = of[i];
        moduli->curved |= membrane->curved;
        phys_moduli_take_knees(moduli, i, &membrane->stiffening);
        row[i] = membrane->modulus;
        moduli->damping[i] = membrane->damping;
        moduli->corrected[i] = membrane->uncorrected ? 0 : 1;
    }
    phys_turn(row, column);
    moduli->c11 = column[0];
    moduli->c12 = column[1];
    moduli->c22 = column[2];
    moduli->c33 = column[3];
}

/* F_u and F_v of rows of the corners: of positions, velocities or anything else. */
PHYS_INLINE void phys_frame_slope(const struct phys_elements *t, const struct phys_four *four,
                                  const struct phys_frame *frame, uint32_t n, const phys_vec *own,
                                  const phys_vec *ghost, struct phys_wide *fu, struct phys_wide *fv)
{
    struct phys_wide a, b, c;
    phys_gather(four, t->corner, 0, n, own, ghost, &a);
    phys_gather(four, t->corner, 1, n, own, ghost, &b);
    phys_gather(four, t->corner, 2, n, own, ghost, &c);
    phys_wide_from(&b, &a, &b);
    phys_wide_from(&c, &a, &c);
    phys_wide_mix(frame->gu + 1, &b, frame->gu + 2, &c, fu);
    phys_wide_mix(frame->gv + 1, &b, frame->gv + 2, &c, fv);
}

/* R and S of F (triangle.h). */
PHYS_INLINE void phys_frame_polar(const struct phys_wide *fu, const struct phys_wide *fv,
                                  struct phys_frame *frame)
{
    phys_vec uu, uv, vv, square;
    struct phys_wide across, turned;
    phys_wide_dot(fu, fu, &uu);
    phys_wide_dot(fu, fv, &uv);
    phys_wide_dot(fv, fv, &vv);
    phys_wide_cross(fu, fv, &across);
    phys_wide_dot(&across, &across, &square);
    phys_sqrt(&square, &frame->det);
    phys_inverse(&frame->det, &frame->across);
    phys_wide_scale(&frame->across, &across, &frame->normal);
    square = uu + vv + 2 * frame->det;
    phys_sqrt(&square, &frame->trace);
    phys_inverse(&frame->trace, &frame->turn);
    frame->suu = (uu + frame->det) * frame->turn;
    frame->suv = uv * frame->turn;
    frame->svv = (vv + frame->det) * frame->turn;
    phys_wide_cross(fv, &frame->normal, &turned); /* R = (F + cof F) / tr S */
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        frame->ru.c[i] = (fu->c[i] + turned.c[i]) * frame->turn;
    phys_wide_cross(&frame->normal, fu, &turned);
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        frame->rv.c[i] = (fv->c[i] + turned.c[i]) * frame->turn;
}

PHYS_INLINE void phys_frame_make(const struct phys_elements *t, const struct phys_four *four,
                                 const struct phys_sight *sight, struct phys_moduli *moduli,
                                 struct phys_frame *frame)
{
    phys_vec g[PHYS_WIDE];
    struct phys_wide fu, fv;
    phys_gather_rows(four, t->vector, g);
    PHYS_UNROLL
    for (int i = 1; i < 3; i++) {
        frame->gu[i] = g[2 * i - 2];
        frame->gv[i] = g[2 * i - 1];
    }
    frame->gu[0] = -frame->gu[1] - frame->gu[2];
    frame->gv[0] = -frame->gv[1] - frame->gv[2];
    phys_take_numbers(four, t->number[PHYS_TRIANGLE_AREA], &frame->area);
    phys_moduli_take(t, four, moduli);
    frame->of = moduli;
    phys_frame_slope(t, four, frame, sight->n, sight->x, sight->x_ghost, &fu, &fv);
    phys_frame_polar(&fu, &fv, frame);
}

/* T = C : e; the strain's uv and the stress's alike stand for vu too. */
PHYS_INLINE void phys_frame_stress(const struct phys_frame *f, const struct phys_plane2 *e,
                                   struct phys_plane2 *t)
{
    const struct phys_moduli *c = f->of;
    t->uu = c->c11 * e->uu + c->c12 * e->vv;
    t->vv = c->c12 * e->uu + c->c22 * e->vv;
    t->uv = t->vu = 2 * c->c33 * e->uv;
}

/* S - I. */
PHYS_INLINE void phys_frame_strain(const struct phys_frame *f, struct phys_plane2 *e)
{
    const phys_vec one = {1, 1, 1, 1};
    *e = (struct phys_plane2){f->suu - one, f->suv, f->suv, f->svv - one};
}

/* Strain along warp (0) or weft (1) beyond a knee, or 0. */
PHYS_INLINE void phys_frame_beyond(const struct phys_frame *f, int d, int k, phys_vec *over)
{
    const phys_vec one = {1, 1, 1, 1}, beyond = (d ? f->svv : f->suu) - one - f->of->at[d][k];
    phys_positive(&beyond, over);
}

/* Adds the stress of the strain beyond knees. rise: NULL, or gets the moduli (N/m) that K has more
 * of along warp and weft. */
PHYS_INLINE void phys_frame_stiffen(const struct phys_frame *f, struct phys_plane2 *t,
                                    phys_vec rise[2])
{
    const phys_vec zero = {0};
    if (!f->of->curved)
        return;
    for (int d = 0; d < 2; d++)
        for (int k = 0; k < PHYS_KNEES; k++) {
            phys_vec over, more;
            phys_frame_beyond(f, d, k, &over);
            *(d ? &t->vv : &t->uu) += f->of->more[d][k] * over;
            if (!rise)
                continue;
            const phys_mask is_over = over > zero;
            phys_choose(&is_over, &f->of->more[d][k], &zero, &more);
            rise[d] += more;
        }
}

/* Adds the energy of the strain beyond knees. */
PHYS_INLINE void phys_frame_stiffening_energy(const struct phys_frame *f, phys_vec *energy)
{
    for (int d = 0; f->of->curved && d < 2; d++)
        for (int k = 0; k < PHYS_KNEES; k++) {
            phys_vec over;
            phys_frame_beyond(f, d, k, &over);
            *energy += 0.5 * f->area * f->of->more[d][k] * over * over;
        }
}

/* Without the normal: R' F of a slope. */
PHYS_INLINE void phys_frame_inside(const struct phys_frame *f, const struct phys_wide *fu,
                                   const struct phys_wide *fv, struct phys_plane2 *d)
{
    phys_wide_dot(&f->ru, fu, &d->uu);
    phys_wide_dot(&f->ru, fv, &d->uv);
    phys_wide_dot(&f->rv, fu, &d->vu);
    phys_wide_dot(&f->rv, fv, &d->vv);
}

/* The turn w and the change of S that belong to D = R' dF: dS = D - w J S. */
PHYS_INLINE void phys_frame_change(const struct phys_frame *f, const struct phys_plane2 *d,
                                   phys_vec *w, struct phys_plane2 *ds)
{
    *w = (d->vu - d->uv) * f->turn;
    ds->uu = d->uu + *w * f->suv;
    ds->uv = ds->vu = d->uv + *w * f->svv;
    ds->vv = d->vv - *w * f->suv;
}

/* c of a stress, or of any T and S: T : J S / tr S. */
PHYS_INLINE void phys_frame_twist(const struct phys_frame *f, const struct phys_plane2 *t,
                                  const struct phys_plane2 *s, phys_vec *c)
{
    *c = ((t->vv - t->uu) * s->uv + t->uv * (s->uu - s->vv)) * f->turn;
}

/* S as a matrix of the plane. */
PHYS_INLINE void phys_frame_s(const struct phys_frame *f, struct phys_plane2 *s)
{
    *s = (struct phys_plane2){f->suu, f->suv, f->suv, f->svv};
}

/* q = t - c J. */
PHYS_INLINE void phys_frame_untwist(const struct phys_plane2 *t, const phys_vec *c,
                                    struct phys_plane2 *q)
{
    *q = (struct phys_plane2){t->uu, t->uv + *c, t->vu - *c, t->vv};
}

/* Adds -area (P_u g_u + P_v g_v), P = R q + normal k, k the pull along the normal or NULL, to the
 * rows of the corners. */
PHYS_INLINE void phys_frame_push(const struct phys_elements *t, const struct phys_four *four,
                                 const struct phys_frame *f, const struct phys_plane2 *q,
                                 const phys_vec *along, uint32_t n, phys_vec *y)
{
    struct phys_wide pu, pv, first = {{{0}}};
    phys_wide_mix(&q->uu, &f->ru, &q->vu, &f->rv, &pu);
    phys_wide_mix(&q->uv, &f->ru, &q->vv, &f->rv, &pv);
    PHYS_UNROLL
    for (int i = 0; along && i < 3; i++) {
        pu.c[i] += along[0] * f->normal.c[i];
        pv.c[i] += along[1] * f->normal.c[i];
    }
    PHYS_UNROLL
    for (int k = 1; k < 3; k++) {
        const phys_vec gu = -f->area * f->gu[k], gv = -f->area * f->gv[k];
        struct phys_wide add;
        phys_wide_mix(&gu, &pu, &gv, &pv, &add);
        phys_wide_from(&first, &add, &first);
        phys_scatter(four, t->corner, k, n, &add, y);
    }
    phys_scatter(four, t->corner, 0, n, &first, y);
}

#endif
