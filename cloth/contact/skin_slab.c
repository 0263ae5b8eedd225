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

/* The heights of the points of a leaf. */
PHYS_INLINE void find_heights(const struct contact_side *side, const struct contact_leaf *leaf,
                              const phys_vec *n, struct contact_heights *to)
{
    const uint32_t *point = side->skin->around + leaf->point;
    phys_vec low = {INFINITY, INFINITY, INFINITY, INFINITY}, high = -low;
    for (uint32_t i = 0; i < leaf->n_points; i++) {
        phys_vec height;
        find_height(side, n, point[i], &height);
        const contact_mask is_low = height<low, is_high = height> high;
        contact_choose(&is_low, &height, &low, &low);
        contact_choose(&is_high, &height, &high, &high);
        to->at[i][0] = height[0];
        to->at[i][1] = height[1];
    }
    for (int end = 0; end < 2; end++) {
        to->low[end] = low[end];
        to->high[end] = high[end];
    }
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

/* The points of leaf k that come near to the end of the other leaf, a bit each. */
PHYS_INLINE uint32_t near_points(const struct contact_slab *slab, int k, uint32_t n)
{
    const struct contact_heights *of = slab->of + k, *other = slab->of + !k;
    const bool is_above = slab->above != (k == 1); /* this leaf */
    const double *end = is_above ? other->high : other->low, sign = is_above ? 1 : -1;
    uint32_t near = 0;
    for (uint32_t i = 0; i < n; i++) {
        const bool begins_far = sign * (of->at[i][0] - end[0]) > slab->most;
        const bool ends_far = sign * (of->at[i][1] - end[1]) > slab->most;
        near |= (uint32_t) !(begins_far & ends_far) << i;
    }
    return near;
}

/* Those of some features that have a near point. of: the points of each, a bit each. */
PHYS_INLINE uint32_t near_bits(uint32_t bits, const uint32_t *of, uint32_t near)
{
    uint32_t is = 0;
    for (uint32_t left = bits; left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        is |= (uint32_t)((of[i] & near) != 0) << i;
    }
    return is;
}

PHYS_KERNEL(contact_slab_keep,
            (const struct contact_slab *slab, int k, const struct contact_side *side,
             const struct contact_leaf *leaf, struct contact_features *bits),
            (slab, k, side, leaf, bits))
{
    const struct contact_skin *skin = side->skin;
    const uint32_t near = near_points(slab, k, leaf->n_points);
    bits->vertices = near_bits(bits->vertices, skin->vertex_bits + leaf->vertex, near);
    bits->triangles = near_bits(bits->triangles, skin->triangle_bits + leaf->triangle, near);
    bits->edges = near_bits(bits->edges, skin->edge_bits + leaf->edge, near);
}
