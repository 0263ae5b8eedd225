#ifndef CLOTH_PHYSICS_DETAIL_HINGE_H
#define CLOTH_PHYSICS_DETAIL_HINGE_H

#include "cloth/physics/bending.h"
#include "cloth/physics/detail/lanes.h"

/* Four hinges at once. Everything is inlined and written for registers. */

/* A triangle at the edge: its normal N = e x r or r x e, r from corner 0 to its third corner. */
struct phys_hinge_face {
    struct phys_wide r, normal; /* m; of length 1 */
    struct phys_wide slope;     /* normal / height: theta's slope for the third corner, 1/m */
    phys_vec inverse;           /* 1 / |N| */
    phys_vec foot;              /* where the height stands on the edge: 0 at corner 0, 1 at 1 */
};

struct phys_hinge {
    struct phys_wide e, along; /* the edge from corner 0 to 1, of length 1 */
    phys_vec length, square;   /* of the edge, and 1 / length^2 */
    struct phys_hinge_face hinge_face[2];
    phys_vec s, cosine;        /* 2 sin(theta / 2), cos(theta / 2) */
    struct phys_wide slope[4]; /* of theta, 1/m */
};

PHYS_INLINE void phys_hinge_face_make(const struct phys_hinge *h, int second,
                                      struct phys_hinge_face *hinge_face)
{
    phys_vec square, size, along;
    struct phys_wide across;
    if (second)
        phys_wide_cross(&hinge_face->r, &h->e, &across);
    else
        phys_wide_cross(&h->e, &hinge_face->r, &across);
    phys_wide_dot(&across, &across, &square);
    phys_sqrt(&square, &size);
    phys_inverse(&size, &hinge_face->inverse);
    phys_wide_scale(&hinge_face->inverse, &across, &hinge_face->normal);
    const phys_vec height = h->length * hinge_face->inverse; /* 1 / height */
    phys_wide_scale(&height, &hinge_face->normal, &hinge_face->slope);
    phys_wide_dot(&hinge_face->r, &h->e, &along);
    hinge_face->foot = along * h->square;
}

/* s and cos(theta / 2) of the two normals. */
PHYS_INLINE void phys_hinge_angle(struct phys_hinge *h)
{
    const struct phys_wide *a = &h->hinge_face[0].normal, *b = &h->hinge_face[1].normal;
    struct phys_wide less, more, across;
    phys_vec square, turned, minus;
    const phys_vec zero = {0};
    phys_wide_from(a, b, &less);
    phys_wide_dot(&less, &less, &square);
    phys_sqrt(&square, &h->s);
    for (int i = 0; i < 3; i++)
        more.c[i] = a->c[i] + b->c[i];
    phys_wide_dot(&more, &more, &square);
    phys_sqrt(&square, &h->cosine);
    h->cosine *= 0.5;
    phys_wide_cross(a, b, &across);
    phys_wide_dot(&across, &h->along, &turned);
    const phys_mask negative = turned < zero;
    minus = -h->s;
    phys_choose(&negative, &minus, &h->s, &h->s);
}

/* From rows of the corners. */
PHYS_INLINE void phys_hinge_make(const struct phys_four *four, uint32_t (*corner)[4],
                                 const struct phys_sight *sight, struct phys_hinge *h)
{
    struct phys_wide x[4];
    phys_vec inverse, square;
    for (int k = 0; k < 4; k++)
        phys_gather(four, corner, k, sight->n, sight->x, sight->x_ghost, x + k);
    phys_wide_from(x + 1, x, &h->e);
    phys_wide_from(x + 2, x, &h->hinge_face[0].r);
    phys_wide_from(x + 3, x, &h->hinge_face[1].r);
    phys_wide_dot(&h->e, &h->e, &square);
    phys_sqrt(&square, &h->length);
    phys_inverse(&h->length, &inverse);
    phys_inverse(&square, &h->square);
    phys_wide_scale(&inverse, &h->e, &h->along);
    phys_hinge_face_make(h, 0, h->hinge_face);
    phys_hinge_face_make(h, 1, h->hinge_face + 1);
    phys_hinge_angle(h);
    const struct phys_wide *a = &h->hinge_face[0].slope, *b = &h->hinge_face[1].slope;
    const phys_vec fa = h->hinge_face[0].foot, fb = h->hinge_face[1].foot;
    for (int i = 0; i < 3; i++) {
        h->slope[2].c[i] = -a->c[i];
        h->slope[3].c[i] = -b->c[i];
        h->slope[1].c[i] = fa * a->c[i] + fb * b->c[i];
        h->slope[0].c[i] = a->c[i] + b->c[i] - h->slope[1].c[i];
    }
}

/* The change of a hinge face's slope and foot by moves de of the edge and dr of its third corner,
 * both from corner 0. */
PHYS_INLINE void phys_hinge_face_change(const struct phys_hinge *h, int second,
                                        const struct phys_hinge_face *hinge_face,
                                        const struct phys_wide *de, const struct phys_wide *dr,
                                        struct phys_wide *slope, phys_vec *foot)
{
    struct phys_wide one, two;
    phys_vec part, longer, a, b, c;
    if (second) {
        phys_wide_cross(dr, &h->e, &one);
        phys_wide_cross(&hinge_face->r, de, &two);
    } else {
        phys_wide_cross(de, &hinge_face->r, &one);
        phys_wide_cross(&h->e, dr, &two);
    }
    for (int i = 0; i < 3; i++)
        one.c[i] += two.c[i];
    phys_wide_dot(&hinge_face->normal, &one, &part);
    phys_wide_dot(&h->along, de, &longer);
    const phys_vec scale = h->length * hinge_face->inverse * hinge_face->inverse;
    const phys_vec along = longer * hinge_face->inverse - 2 * part * scale;
    phys_wide_mix(&scale, &one, &along, &hinge_face->normal, slope);
    phys_wide_dot(dr, &h->e, &a);
    phys_wide_dot(&hinge_face->r, de, &b);
    phys_wide_dot(&h->e, de, &c);
    *foot = (a + b - 2 * hinge_face->foot * c) * h->square;
}

/* The change of the slopes of theta by moves d of the corners. */
PHYS_INLINE void phys_hinge_change(const struct phys_hinge *h, const struct phys_wide d[4],
                                   struct phys_wide change[4])
{
    struct phys_wide de, dr, a, b;
    phys_vec fa, fb;
    const struct phys_hinge_face *one = h->hinge_face, *two = h->hinge_face + 1;
    phys_wide_from(d + 1, d, &de);
    phys_wide_from(d + 2, d, &dr);
    phys_hinge_face_change(h, 0, one, &de, &dr, &a, &fa);
    phys_wide_from(d + 3, d, &dr);
    phys_hinge_face_change(h, 1, two, &de, &dr, &b, &fb);
    for (int i = 0; i < 3; i++) {
        change[2].c[i] = -a.c[i];
        change[3].c[i] = -b.c[i];
        change[1].c[i] =
            fa * one->slope.c[i] + one->foot * a.c[i] + fb * two->slope.c[i] + two->foot * b.c[i];
        change[0].c[i] = a.c[i] + b.c[i] - change[1].c[i];
    }
}

#endif
