/* Leaves that follow each other are near each other, so one box around some of them mostly tells
 * that all are out of reach of a shape. Each point is looked at once a leaf. */
#include "cloth/contact/direction.h"
#include "cloth/contact/skin_table.h"

enum { LEAVES = 4 };

uint32_t contact_bunches(const struct contact_skin *skin)
{
    return (skin->n_leaves + LEAVES - 1) / LEAVES;
}

void contact_bunch_of(const struct contact_skin *skin, uint32_t number, struct contact_bunch *to)
{
    const uint32_t begin = LEAVES * number, left = skin->n_leaves - begin;
    const struct contact_leaf *first = skin->leaf + begin;
    const struct contact_leaf *last = first + (left < LEAVES ? left : LEAVES) - 1;
    *to =
        (struct contact_bunch){.triangle = first->triangle,
                               .vertex = first->vertex,
                               .n_triangles = last->triangle + last->n_triangles - first->triangle,
                               .n_vertices = last->vertex + last->n_vertices - first->vertex,
                               .n_points = last->point + last->n_points - first->point,
                               .point = skin->around + first->point};
}

/* y lies between the other two, but for rounding. */
PHYS_KERNEL(contact_bunch_box,
            (const struct contact_bunch *bunch, const phys_vec *x, const phys_vec *y, double low[3],
             double high[3]),
            (bunch, x, y, low, high))
{
    phys_vec least = x[bunch->point[0]], most = least;
    for (uint32_t i = 0; i < bunch->n_points; i++) {
        const phys_vec from = x[bunch->point[i]], to = y[bunch->point[i]], ahead = to + (to - from);
        const contact_mask rises = from < ahead;
        phys_vec lower, upper;
        contact_choose(&rises, &from, &ahead, &lower);
        contact_choose(&rises, &ahead, &from, &upper);
        const contact_mask is_low = lower<least, is_high = upper> most;
        contact_choose(&is_low, &lower, &least, &least);
        contact_choose(&is_high, &upper, &most, &most);
    }
    for (int c = 0; c < 3; c++) {
        low[c] = least[c];
        high[c] = most[c];
    }
}
