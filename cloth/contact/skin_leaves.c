/* Two leaves whose boxes meet. Most of them are apart as seen along the normals of one of them:
 * boxes of slanted triangles are large. Heights along one direction change evenly, so both ends of
 * a step bound the whole step. Only heights at the same end are compared, so no frame is needed.
 * Features of leaves that are not apart are compared by their boxes, where they are near to the box
 * of the other leaf and within reach along the normals. No pair of leaves that a plane across the
 * normals parts by enough needs a certificate of its own. */
#include "cloth/contact/direction.h"
#include "cloth/contact/skin_lanes.h"

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
        to->at[0][i] = height[0];
        to->at[1][i] = height[1];
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

PHYS_INLINE void slab_begin(const struct contact_side *side, struct contact_part part,
                            struct contact_slab *slab)
{
    const uint32_t node = part.node, lane = part.lane;
    const struct contact_skin *skin = side->skin;
    const struct contact_leaf *leaf = skin->leaf + (skin->child[node][lane] & ~CONTACT_IS_LEAF);
    slab->node = node;
    slab->lane = lane;
    slab->is = find_normal(&contact_boxes_slopes(side->boxes)[node].normal, lane, &slab->n);
    if (slab->is)
        find_heights(side, leaf, &slab->n, &slab->of[0]);
}

/* Finds how far a second leaf is from the first in the whole step. */
PHYS_INLINE void slab_measure(const struct contact_side *side, const struct contact_leaf *leaf,
                              struct contact_slab *slab)
{
    slab->apart = slab->begin = -INFINITY;
    if (!slab->is)
        return;
    find_heights(side, leaf, &slab->n, &slab->of[1]);
    const double above = least_between(slab->of[0].low, slab->of[1].high);
    const double below = least_between(slab->of[1].low, slab->of[0].high);
    slab->above = above > below;
    slab->apart = above > below ? above : below;
    slab->begin =
        fmax(slab->of[0].low[0] - slab->of[1].high[0], slab->of[1].low[0] - slab->of[0].high[0]);
}

/* The points of leaf k that come near to the end of the other leaf, a bit each; lanes behind them
 * have any bit. */
PHYS_INLINE uint32_t near_points(const struct contact_slab *slab, int k, uint32_t n)
{
    const contact_mask bit = {1, 2, 4, 8};
    const struct contact_heights *of = slab->of + k, *other = slab->of + !k;
    const bool is_above = slab->above != (k == 1); /* this leaf */
    const double *end = is_above ? other->high : other->low, sign = is_above ? 1 : -1;
    uint32_t near = 0;
    for (uint32_t i = 0; i < n; i += 4) {
        const phys_vec *begins = (const phys_vec *)(of->at[0] + i);
        const phys_vec *ends = (const phys_vec *)(of->at[1] + i);
        const contact_mask far =
            (sign * (*begins - end[0]) > slab->most) & (sign * (*ends - end[1]) > slab->most);
        const contact_mask is = ~far & bit, pair = is | CONTACT_PICK(is, is, 2, 3, 0, 1);
        near |= (uint32_t)(pair[0] | pair[1]) << i;
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

/* Clears the bits of features of leaf k, 0 or 1, that are out of reach of all of the other one.
 * There are normals (slab->is). */
PHYS_INLINE void slab_keep(const struct contact_slab *slab, int k, const struct contact_side *side,
                           const struct contact_leaf *leaf, struct contact_features *bits)
{
    const struct contact_skin *skin = side->skin;
    const uint32_t near = near_points(slab, k, leaf->n_points);
    bits->vertices = near_bits(bits->vertices, skin->vertex_bits + leaf->vertex, near);
    bits->triangles = near_bits(bits->triangles, skin->triangle_bits + leaf->triangle, near);
    bits->edges = near_bits(bits->edges, skin->edge_bits + leaf->edge, near);
}

/* ---- Boxes ---- */

/* A leaf of skin k, and which of its features may be near to the other leaf. */
struct leaf_near {
    const struct contact_leaf *leaf;
    const struct contact_boxes *triangles, *vertices, *edges;
    struct contact_features is;
};

/* The first n bits, n < 32. */
PHYS_INLINE uint32_t first_bits(uint32_t n)
{
    return (UINT32_C(1) << n) - 1;
}

PHYS_INLINE void open_leaf(const struct contact_leaves *leaves, int k,
                           const struct contact_leaf *leaf, struct leaf_near *near)
{
    const struct contact_boxes *group = leaves->group[k];
    *near = (struct leaf_near){
        leaf,
        group + leaf->group,
        group + contact_vertex_group(leaf),
        group + contact_edge_group(leaf),
        {first_bits(leaf->n_vertices), first_bits(leaf->n_triangles), first_bits(leaf->n_edges)}};
}

/* Those of some boxes, a bit each, that meet a wide one. */
PHYS_INLINE uint32_t meeting_of(const struct contact_boxes *wide, const struct contact_boxes *boxes,
                                uint32_t bits)
{
    uint32_t is = 0;
    for (uint32_t k = 0; k < CONTACT_SKIN_POINTS && bits >> k; k += 4)
        if (bits >> k & 15)
            is |= (uint32_t)contact_boxes_meeting(wide, boxes + k / 4) << k;
    return is & bits;
}

PHYS_INLINE void near_to_box(const struct contact_boxes *wide, struct leaf_near *near)
{
    near->is.vertices = meeting_of(wide, near->vertices, near->is.vertices);
    near->is.triangles = meeting_of(wide, near->triangles, near->is.triangles);
    near->is.edges = meeting_of(wide, near->edges, near->is.edges);
}

/* Finds, for each of some features of the first leaf, the features of the second that meet it. */
PHYS_INLINE void meet_features(const struct contact_leaves *leaves, const struct contact_boxes *a,
                               uint32_t is_a, const struct contact_boxes *b, uint32_t is_b,
                               struct contact_met *to)
{
    to->is = 0;
    for (uint32_t left = is_b ? is_a : 0; left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        struct contact_boxes wide;
        contact_boxes_widen(&leaves->by, a + i / 4, i % 4, &wide);
        to->bits[i] = meeting_of(&wide, b, is_b);
        to->is |= (uint32_t)(to->bits[i] != 0) << i;
    }
}

/* The most, m, that a point of one leaf goes otherwise than one of the other. */
PHYS_INLINE double way_between(const struct contact_leaves *leaves, const struct contact_leaf *a,
                               const struct contact_leaf *b)
{
    const struct contact_point_box *own =
        contact_boxes_ways(leaves->side[0]->boxes) + (a - leaves->side[0]->skin->leaf);
    const struct contact_point_box *other =
        contact_boxes_ways(leaves->side[1]->boxes) + (b - leaves->side[1]->skin->leaf);
    double square = 0;
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const double more = (double)own->high[c] - (double)other->low[c];
        const double less = (double)other->high[c] - (double)own->low[c];
        const double most = more > less ? more : less;
        square += most * most;
    }
    return sqrt(square);
}

/* True if a plane parts the leaves when the step begins, by so much that no pair of them comes too
 * near. For their gap is at least that, and along the direction in which they are closest then it
 * shrinks by no more than the ways differ: so their certificates hold, which try that direction. */
PHYS_INLINE bool leaves_are_parted(const struct contact_leaves *leaves,
                                   const struct contact_leaf *a, const struct contact_leaf *b)
{
    return leaves->parts == -INFINITY ||
           (leaves->slab.begin > leaves->parts &&
            leaves->slab.begin - way_between(leaves, a, b) > leaves->parts);
}

PHYS_INLINE const struct contact_leaf *leaf_at(const struct contact_side *side,
                                               struct contact_part part)
{
    return side->skin->leaf + (side->skin->child[part.node][part.lane] & ~CONTACT_IS_LEAF);
}

/* True if the leaves are out of reach. Those of one skin that meet mostly share a border: heights
 * cost more than they save there. */
PHYS_INLINE bool leaves_part(struct contact_leaves *leaves, struct contact_part a,
                             const struct contact_leaf *other)
{
    struct contact_slab *slab = &leaves->slab;
    if (leaves->self)
        return false;
    if (slab->node != a.node || slab->lane != a.lane)
        slab_begin(leaves->side[0], a, slab);
    slab_measure(leaves->side[1], other, slab);
    return slab->apart > slab->most;
}

/* Finds the edges of two leaves that may have a ridge, of those that are near. Leaves out all
 * others where the leaves are parted. A leaf meets many others, one after the other. */
PHYS_INLINE void find_ridges(struct contact_leaves *leaves, struct leaf_near near[2],
                             struct contact_met_leaf *to)
{
    const struct contact_side *const *side = leaves->side;
    to->ridges[0] = to->ridges[1] = UINT32_MAX;
    if (!side[0]->ridges || !near[0].is.edges || !near[1].is.edges)
        return;
    if (leaves->ridged != near[0].leaf) {
        leaves->ridged = near[0].leaf;
        leaves->ridges = contact_ridges_of(side[0]->skin, near[0].leaf, side[0]->y, UINT32_MAX);
    }
    to->ridges[0] = near[0].is.edges & leaves->ridges;
    to->ridges[1] =
        to->ridges[0] ? contact_ridges_of(side[1]->skin, near[1].leaf, side[1]->y, near[1].is.edges)
                      : 0;
    for (int k = 0; k < 2 && to->parted; k++)
        near[k].is.edges = to->ridges[k];
}

PHYS_KERNEL_OF(bool, contact_leaves_meet,
               (struct contact_leaves * leaves, struct contact_part a, struct contact_part b,
                struct contact_met_leaf *to),
               (leaves, a, b, to))
{
    const struct contact_leaf *of = leaf_at(leaves->side[0], a);
    const struct contact_leaf *other = leaf_at(leaves->side[1], b);
    struct contact_boxes wide[2];
    struct leaf_near near[2];
    if (leaves_part(leaves, a, other))
        return false;
    contact_boxes_widen(&leaves->by, leaves->node[0] + a.node, a.lane, wide);
    contact_boxes_widen(&leaves->back, leaves->node[1] + b.node, b.lane, wide + 1);
    open_leaf(leaves, 0, of, near);
    open_leaf(leaves, 1, other, near + 1);
    to->parted = leaves_are_parted(leaves, of, other);
    near_to_box(wide + 1, near);
    near_to_box(wide, near + 1);
    for (int k = 0; k < 2 && leaves->slab.is; k++)
        slab_keep(&leaves->slab, k, leaves->side[k], near[k].leaf, &near[k].is);
    find_ridges(leaves, near, to);
    meet_features(leaves, near[0].vertices, near[0].is.vertices, near[1].triangles,
                  near[1].is.triangles, &to->vertices);
    meet_features(leaves, near[0].triangles, near[0].is.triangles, near[1].vertices,
                  near[1].is.vertices, &to->triangles);
    meet_features(leaves, near[0].edges, near[0].is.edges, near[1].edges, near[1].is.edges,
                  &to->edges);
    return true;
}

PHYS_KERNEL(contact_leaf_meets_itself,
            (struct contact_leaves * leaves, struct contact_part part, struct contact_met_leaf *to),
            (leaves, part, to))
{
    struct leaf_near near[2];
    open_leaf(leaves, 0, leaf_at(leaves->side[0], part), near);
    near[1] = near[0];
    to->triangles.is = 0;
    to->parted = leaves->parts == -INFINITY;
    find_ridges(leaves, near, to);
    meet_features(leaves, near->vertices, near->is.vertices, near->triangles, near->is.triangles,
                  &to->vertices);
    meet_features(leaves, near->edges, near->is.edges, near->edges, near->is.edges, &to->edges);
    for (uint32_t i = 0; i < near->leaf->n_edges; i++)
        to->edges.bits[i] &= ~first_bits(i + 1);
}
