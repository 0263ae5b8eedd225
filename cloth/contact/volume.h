#ifndef CLOTH_CONTACT_VOLUME_H
#define CLOTH_CONTACT_VOLUME_H

#include "cloth/contact/direction.h"

/* The proof of certificate.h by volumes, for four pairs at once, a lane each. a, b: corners 1 to 3
 * against corner 0 where the step begins, and where it ends, m. A verdict is sure in spite of
 * rounding, and false for what is not finite. */

/* The rounding of three times a coefficient, in parts of S^3 (certificate.h). */
#define CONTACT_VOLUME_ROUNDING 0x1p-52

/* The volume that the corners span, a cubic in the part of the step, in Bernstein's basis: its
 * first and last coefficient, and three times the two between them. */
PHYS_INLINE void contact_volume(const struct contact_lanes *a, const struct contact_lanes *b,
                                phys_vec volume[4])
{
    struct contact_lanes begin, mixed, part, end;
    phys_vec more[2];
    contact_lanes_product(a + 1, a + 2, &begin);
    contact_lanes_product(a + 1, b + 2, &mixed);
    contact_lanes_product(b + 1, a + 2, &part);
    contact_lanes_product(b + 1, b + 2, &end);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        mixed.c[c] += part.c[c];
    contact_lanes_dot(a, &begin, volume);
    contact_lanes_dot(a, &mixed, volume + 1);
    contact_lanes_dot(b, &begin, more);
    contact_lanes_dot(b, &mixed, volume + 2);
    contact_lanes_dot(a, &end, more + 1);
    contact_lanes_dot(b, &end, volume + 3);
    volume[1] += more[0];
    volume[2] += more[1];
}

/* The lanes whose corners never lie in a plane. size: S of certificate.h. */
PHYS_INLINE void contact_spans(const struct contact_lanes *a, const struct contact_lanes *b,
                               const phys_vec *size, contact_mask *spans)
{
    const phys_vec off = CONTACT_VOLUME_ROUNDING * *size * *size * *size;
    phys_vec volume[4];
    contact_volume(a, b, volume);
    contact_mask above = volume[0] > off, below = volume[0] < -off;
    PHYS_UNROLL
    for (int k = 1; k < 4; k++) {
        above &= volume[k] > off;
        below &= volume[k] < -off;
    }
    *spans = above | below;
}

#endif
