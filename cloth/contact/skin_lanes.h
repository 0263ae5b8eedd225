#ifndef CLOTH_CONTACT_SKIN_LANES_H
#define CLOTH_CONTACT_SKIN_LANES_H

#include "cloth/contact/skin_table.h"

/* A box against four, shared by the files of queries. */

typedef int32_t contact_float_mask __attribute__((vector_size(16)));

/* Bit k: lane k is true. */
PHYS_INLINE unsigned contact_bits_of(const contact_float_mask *is)
{
#if defined(__SSE__)
    return (unsigned)__builtin_ia32_movmskps((contact_lanes)*is);
#else
    unsigned bits = 0;
    PHYS_UNROLL
    for (int k = 0; k < 4; k++)
        bits |= (*is)[k] ? 1u << k : 0;
    return bits;
#endif
}

/* One of four boxes, widened, in all lanes. */
PHYS_INLINE void contact_boxes_widen(const struct contact_widening *by,
                                     const struct contact_boxes *boxes, uint32_t lane,
                                     struct contact_boxes *wide)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const float low = boxes->low[c][lane], high = boxes->high[c][lane];
        wide->low[c] = (contact_lanes){low, low, low, low} - by->below[c];
        wide->high[c] = (contact_lanes){high, high, high, high} + by->above[c];
    }
}

/* Which of four boxes meet a wide one. */
PHYS_INLINE unsigned contact_boxes_meeting(const struct contact_boxes *wide,
                                           const struct contact_boxes *boxes)
{
    contact_float_mask is = (wide->low[0] <= boxes->high[0]) & (wide->high[0] >= boxes->low[0]);
    is &= (wide->low[1] <= boxes->high[1]) & (wide->high[1] >= boxes->low[1]);
    is &= (wide->low[2] <= boxes->high[2]) & (wide->high[2] >= boxes->low[2]);
    return contact_bits_of(&is);
}

#endif
