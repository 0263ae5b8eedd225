/* Most leaves whose boxes meet are apart as seen along the normals of one of them: boxes of slanted
 * triangles are large. Heights along one direction change evenly, so both ends of a step bound the
 * whole step. Only heights at the same end are compared, so no frame is needed. */
#include "cloth/contact/direction.h"
#include "cloth/contact/skin_table.h"

#include <math.h>

/* Margins: m; part of the reach; part of coordinates. They cover distances computed otherwise, and
 * the rounding of two heights. Each height, of three products and two sums, is off by less than 12
 * u of the largest coordinate. */
static const double MARGIN = 1e-9, PART = 1e-6, ROUNDING = 0x1p-48;
/* Squares of the sum of the least and the largest normal: beyond these there is no middle. */
static const double LEAST = 0.04, MOST = 5;

/* The middle of the normals of a leaf, of length 1; false: there is none. */
PHYS_INLINE bool find_normal(const struct contact_boxes *normal, uint32_t lane, phys_vec *n)
{
    for (int c = 0; c < 3; c++)
        (*n)[c] = (double)normal->low[c][lane] + (double)normal->high[c][lane];
    (*n)[3] = 0;
    const double square = phys_dot(n, n);
    if (!(square > LEAST && square < MOST))
        return false;
    *n /= sqrt(square);
    return true;
}

/* Heights of a point at the begin and at the end of the step, and both again. */
PHYS_INLINE void find_height(const struct contact_side *side, const phys_vec *n, uint32_t point,
                             phys_vec *height)
{
    const phys_vec x = *n * side->x[point], y = *n * side->y[point];
    const phys_vec sum = CONTACT_PICK(x, y, 0, 4, 2, 6) + CONTACT_PICK(x, y, 1, 5, 3, 7);
    *height = sum + CONTACT_PICK(sum, sum, 2, 3, 0, 1);
}

/* The heights of the corners of a leaf. */
PHYS_INLINE void find_heights(const struct contact_side *side, const struct contact_leaf *leaf,
                              const phys_vec *n, struct contact_heights *to)
{
    const uint32_t *corner = side->skin->corner[leaf->triangle];
    phys_vec low = {INFINITY, INFINITY, INFINITY, INFINITY}, high = -low;
    for (uint32_t i = 0; i < 3 * leaf->n_triangles; i++) {
        phys_vec height;
        find_height(side, n, corner[i], &height);
        const contact_mask is_low = height<low, is_high = height> high;
        contact_choose(&is_low, &height, &low, &low);
        contact_choose(&is_high, &height, &high, &high);
    }
    *to = (struct contact_heights){{low[0], low[1]}, {high[0], high[1]}};
}

PHYS_INLINE double least_between(const double a[2], const double b[2])
{
    const double begin = a[0] - b[0], end = a[1] - b[1];
    return begin < end ? begin : end;
}

static double largest_coordinate(const void *boxes)
{
    double low[3], high[3], most = 0;
    contact_boxes_root(boxes, low, high);
    for (int c = 0; c < 3; c++)
        most = fmax(most, fmax(fabs(low[c]), fabs(high[c])));
    return most;
}

double contact_slab_most(const struct contact_side *a, const struct contact_side *b, double reach)
{
    const double size = fmax(largest_coordinate(a->boxes), largest_coordinate(b->boxes));
    return reach * (1 + PART) + MARGIN + ROUNDING * size;
}

PHYS_KERNEL(contact_slab_begin,
            (const struct contact_side *side, uint32_t node, uint32_t lane,
             struct contact_slab *slab),
            (side, node, lane, slab))
{
    const struct contact_skin *skin = side->skin;
    const struct contact_leaf *leaf = skin->leaf + (skin->child[node][lane] & ~CONTACT_IS_LEAF);
    slab->node = node;
    slab->lane = lane;
    slab->is = find_normal(&contact_boxes_slopes(side->boxes)[node].normal, lane, &slab->n);
    if (slab->is)
        find_heights(side, leaf, &slab->n, &slab->of[0]);
}

PHYS_KERNEL_OF(bool, contact_slab_parts,
               (const struct contact_side *side, const struct contact_leaf *leaf,
                struct contact_slab *slab),
               (side, leaf, slab))
{
    if (!slab->is)
        return false;
    find_heights(side, leaf, &slab->n, &slab->of[1]);
    const double above = least_between(slab->of[0].low, slab->of[1].high);
    const double below = least_between(slab->of[1].low, slab->of[0].high);
    slab->above = above > below;
    return above > slab->most || below > slab->most;
}

/* The bits of features, of n points each, that come near to the end of the other leaf. */
PHYS_INLINE uint32_t near_bits(const struct contact_slab *slab, const phys_vec *end, double sign,
                               const struct contact_side *side, uint32_t bits, uint32_t n,
                               const uint32_t *point)
{
    uint32_t near = 0;
    for (uint32_t left = bits; left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        contact_mask far = {-1, -1, -1, -1};
        PHYS_UNROLL
        for (uint32_t k = 0; k < n; k++) {
            phys_vec height;
            find_height(side, &slab->n, point[(size_t)n * i + k], &height);
            far &= sign * (height - *end) > slab->most;
        }
        near |= (uint32_t) !(far[0] & far[1]) << i;
    }
    return near;
}

PHYS_KERNEL(contact_slab_keep,
            (const struct contact_slab *slab, int k, const struct contact_side *side,
             const struct contact_leaf *leaf, struct contact_features *bits),
            (slab, k, side, leaf, bits))
{
    const struct contact_skin *skin = side->skin;
    const bool is_above = slab->above != (k == 1); /* this leaf */
    const struct contact_heights *other = slab->of + !k;
    const double *at = is_above ? other->high : other->low, sign = is_above ? 1 : -1;
    const phys_vec ends = {at[0], at[1], at[0], at[1]}, *end = &ends;
    bits->vertices =
        near_bits(slab, end, sign, side, bits->vertices, 1, skin->vertex + leaf->vertex);
    bits->triangles =
        near_bits(slab, end, sign, side, bits->triangles, 3, skin->corner[leaf->triangle]);
    bits->edges = near_bits(slab, end, sign, side, bits->edges, 2, skin->edge[leaf->edge]);
}
