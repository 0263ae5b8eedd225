/* Boxes of a step, from the points up: each is of all positions between x and y, as seen from a
 * frame that moves by `way` meanwhile. A point moves straight in it, too, so its box is that of its
 * two ends. Rounding to floats outwards takes more than the roundings of a query may take back.
 *
 * Twice the area vector of a triangle that moves so is a polynomial of the time with three
 * coefficients in Bernstein's form: at x, at y, and between. So its direction is always in the hull
 * of theirs, and along any direction it is at least as long as the shortest of them. */
#include "cloth/contact/skin_table.h"

#include <math.h>
#include <string.h>

typedef int32_t float_mask __attribute__((vector_size(16)));

/* The least sine between edges of a triangle whose normal, in floats, is a normal. */
static const float SHARP = 1e-3f;

static const contact_lanes NOTHING = {INFINITY, INFINITY, INFINITY, INFINITY};

/* ---- Lanes ---- */

PHYS_INLINE void choose(const float_mask *is, const contact_lanes *a, contact_lanes *b)
{
    *b = (contact_lanes)(((float_mask)*a & *is) | ((float_mask)*b & ~*is));
}

PHYS_INLINE void lower(const contact_lanes *a, contact_lanes *least)
{
#if defined(__SSE__)
    *least = __builtin_ia32_minps(*a, *least);
#else
    const float_mask is = *a < *least;
    choose(&is, a, least);
#endif
}

PHYS_INLINE void upper(const contact_lanes *a, contact_lanes *most)
{
#if defined(__SSE__)
    *most = __builtin_ia32_maxps(*a, *most);
#else
    const float_mask is = *a > *most;
    choose(&is, a, most);
#endif
}

PHYS_INLINE void root_lanes(const contact_lanes *of, contact_lanes *to)
{
#if defined(__SSE__)
    *to = __builtin_ia32_sqrtps(*of);
#else
    for (int k = 0; k < 4; k++)
        (*to)[k] = sqrtf((*of)[k]);
#endif
}

PHYS_INLINE void join(const struct contact_point_box *a, struct contact_point_box *whole)
{
    lower(&a->low, &whole->low);
    upper(&a->high, &whole->high);
}

#if defined(__clang__)
#define SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define SHUFFLE(a, b, i, j, k, l) __builtin_shuffle(a, b, (float_mask){i, j, k, l})
#endif

/* Components 0 to 2 of four vectors, a lane each. */
PHYS_INLINE void turn(const contact_lanes from[4], contact_lanes to[3])
{
    const contact_lanes xy01 = SHUFFLE(from[0], from[1], 0, 4, 1, 5);
    const contact_lanes xy23 = SHUFFLE(from[2], from[3], 0, 4, 1, 5);
    const contact_lanes z01 = SHUFFLE(from[0], from[1], 2, 6, 3, 7);
    const contact_lanes z23 = SHUFFLE(from[2], from[3], 2, 6, 3, 7);
    to[0] = SHUFFLE(xy01, xy23, 0, 1, 4, 5);
    to[1] = SHUFFLE(xy01, xy23, 2, 3, 6, 7);
    to[2] = SHUFFLE(z01, z23, 0, 1, 4, 5);
}

/* Four boxes, one after the other, into lanes. */
PHYS_INLINE void put_lanes(const struct contact_point_box box[4], struct contact_boxes *to)
{
    const contact_lanes low[4] = {box[0].low, box[1].low, box[2].low, box[3].low};
    const contact_lanes high[4] = {box[0].high, box[1].high, box[2].high, box[3].high};
    turn(low, to->low);
    turn(high, to->high);
}

/* The same back. */
PHYS_INLINE void turn_each(const contact_lanes from[3], contact_lanes to[4])
{
    const contact_lanes z = from[2];
    const contact_lanes xy01 = SHUFFLE(from[0], from[1], 0, 4, 1, 5);
    const contact_lanes xy23 = SHUFFLE(from[0], from[1], 2, 6, 3, 7);
    to[0] = SHUFFLE(xy01, z, 0, 1, 4, 4);
    to[1] = SHUFFLE(xy01, z, 2, 3, 5, 5);
    to[2] = SHUFFLE(xy23, z, 0, 1, 6, 6);
    to[3] = SHUFFLE(xy23, z, 2, 3, 7, 7);
}

/* The box around four; its last lane is unused. */
PHYS_INLINE void lanes_whole(const struct contact_boxes *boxes, struct contact_point_box *whole)
{
    contact_lanes low[4], high[4];
    turn_each(boxes->low, low);
    turn_each(boxes->high, high);
    *whole = (struct contact_point_box){low[0], high[0]};
    PHYS_UNROLL
    for (int k = 1; k < 4; k++) {
        lower(low + k, &whole->low);
        upper(high + k, &whole->high);
    }
}

/* ---- Boxes ---- */

/* Takes two to four units in the last place more than rounding to the nearest may. */
PHYS_INLINE void round_out(struct contact_point_box *box)
{
    const float_mask size = {INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX};
    box->low -= (contact_lanes)((float_mask)box->low & size) * 0x1p-22f;
    box->high += (contact_lanes)((float_mask)box->high & size) * 0x1p-22f;
}

/* Fills groups of the boxes of n features, each of `points` points; lanes behind them are empty. */
PHYS_INLINE void put_features(uint32_t n, uint32_t points, const uint32_t *point,
                              const struct contact_point_box *of, struct contact_boxes *to)
{
    for (uint32_t i = 0; i < n; i += 4) {
        struct contact_point_box box[4];
        PHYS_UNROLL
        for (uint32_t k = 0; k < 4; k++) {
            const uint32_t *at = point + (size_t)points * (i + k < n ? i + k : i);
            box[k] = of[at[0]];
            PHYS_UNROLL
            for (uint32_t j = 1; j < points; j++)
                join(of + at[j], box + k);
            if (i + k >= n)
                box[k] = (struct contact_point_box){NOTHING, -NOTHING};
        }
        put_lanes(box, to + i / 4);
    }
}

/* ---- Slopes ---- */

/* The edges of four triangles: from corner 0 to corner k + 1. */
struct edges {
    contact_lanes e[2][3];
};

PHYS_INLINE void put_edges(const uint32_t *const corner[4], const phys_vec *x, struct edges *to)
{
    PHYS_UNROLL
    for (int i = 0; i < 2; i++) {
        contact_lanes along[4];
        PHYS_UNROLL
        for (int k = 0; k < 4; k++) {
            const phys_vec edge = x[corner[k][i + 1]] - x[corner[k][0]];
            along[k] = __builtin_convertvector(edge, contact_lanes);
        }
        turn(along, to->e[i]);
    }
}

PHYS_INLINE void square(const contact_lanes of[3], contact_lanes *to)
{
    *to = of[0] * of[0] + of[1] * of[1] + of[2] * of[2];
}

/* The square of the longest edge becomes at least that of these. */
PHYS_INLINE void longest_edge(const struct edges *edges, contact_lanes *most)
{
    contact_lanes third[3], length;
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        third[c] = edges->e[1][c] - edges->e[0][c];
    square(edges->e[0], &length);
    upper(&length, most);
    square(edges->e[1], &length);
    upper(&length, most);
    square(third, &length);
    upper(&length, most);
}

PHYS_INLINE void cross(const contact_lanes a[3], const contact_lanes b[3], contact_lanes to[3])
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        to[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

/* Adds the direction of a coefficient to the hull, its square to the least. */
PHYS_INLINE void add_normal(const contact_lanes area[3], struct contact_boxes *hull,
                            contact_lanes *least)
{
    contact_lanes size, root;
    square(area, &size);
    root_lanes(&size, &root);
    lower(&size, least);
    const contact_lanes part = 1 / root;
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const contact_lanes normal = area[c] * part;
        lower(&normal, hull->low + c);
        upper(&normal, hull->high + c);
    }
}

/* The slopes of four triangles. */
PHYS_INLINE void find_slopes(const uint32_t *const corner[4], const phys_vec *x, const phys_vec *y,
                             struct contact_slopes *to)
{
    struct edges begin, end;
    contact_lanes area[3], other[3], least = NOTHING, most = {0}, altitude;
    *to =
        (struct contact_slopes){{{NOTHING, NOTHING, NOTHING}, {-NOTHING, -NOTHING, -NOTHING}}, {0}};
    put_edges(corner, x, &begin);
    put_edges(corner, y, &end);
    longest_edge(&begin, &most);
    longest_edge(&end, &most);
    cross(begin.e[0], begin.e[1], area);
    add_normal(area, &to->normal, &least);
    cross(end.e[0], end.e[1], area);
    add_normal(area, &to->normal, &least);
    cross(begin.e[0], end.e[1], area);
    cross(end.e[0], begin.e[1], other);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        area[c] = 0.5f * (area[c] + other[c]);
    add_normal(area, &to->normal, &least);
    const float_mask known = least > SHARP * SHARP * most * most;
    const contact_lanes ratio = least / most;
    root_lanes(&ratio, &altitude);
    choose(&known, &altitude, &to->altitude);
}

/* The slopes of a leaf, as one part of a node. */
PHYS_INLINE void leaf_slopes(const struct contact_skin *skin, const struct contact_leaf *leaf,
                             const phys_vec *x, const phys_vec *y, struct contact_point_box *normal,
                             float *altitude)
{
    *normal = (struct contact_point_box){NOTHING, -NOTHING};
    *altitude = INFINITY;
    for (uint32_t i = 0; i < leaf->n_triangles; i += 4) {
        const uint32_t *corner[4];
        struct contact_slopes slopes;
        struct contact_point_box hull;
        PHYS_UNROLL
        for (uint32_t k = 0; k < 4; k++)
            corner[k] = skin->corner[leaf->triangle + (i + k < leaf->n_triangles ? i + k : i)];
        find_slopes(corner, x, y, &slopes);
        lanes_whole(&slopes.normal, &hull);
        join(&hull, normal);
        for (int k = 0; k < 4; k++)
            *altitude = slopes.altitude[k] < *altitude ? slopes.altitude[k] : *altitude;
    }
}

/* ---- The tree ---- */

struct refit {
    const struct contact_skin *skin;
    const phys_vec *x, *y;
    const struct contact_point_box *of; /* points */
    struct contact_boxes *nodes, *groups;
    struct contact_point_box *ways; /* by leaf */
    struct contact_slopes *slopes;
};

/* The box around the ways of a leaf's points. */
PHYS_INLINE void refit_ways(const struct refit *refit, const struct contact_leaf *leaf,
                            struct contact_point_box *to)
{
    const uint32_t *point = refit->skin->around + leaf->point;
    *to = (struct contact_point_box){NOTHING, -NOTHING};
    for (uint32_t i = 0; i < leaf->n_points; i++) {
        const phys_vec way = refit->y[point[i]] - refit->x[point[i]];
        const contact_lanes at = __builtin_convertvector(way, contact_lanes);
        lower(&at, &to->low);
        upper(&at, &to->high);
    }
    round_out(to);
}

PHYS_INLINE void refit_leaf(const struct refit *refit, const struct contact_leaf *leaf,
                            struct contact_point_box *whole)
{
    const struct contact_skin *skin = refit->skin;
    struct contact_boxes *groups = refit->groups;
    *whole = (struct contact_point_box){NOTHING, -NOTHING};
    refit_ways(refit, leaf, refit->ways + (leaf - skin->leaf));
    put_features(leaf->n_triangles, 3, skin->corner[leaf->triangle], refit->of,
                 groups + leaf->group);
    put_features(leaf->n_vertices, 1, skin->vertex + leaf->vertex, refit->of,
                 groups + contact_vertex_group(leaf));
    put_features(leaf->n_edges, 2, skin->edge[leaf->edge], refit->of,
                 groups + contact_edge_group(leaf));
    for (uint32_t i = 0; i < contact_groups(leaf->n_triangles); i++) {
        struct contact_point_box part;
        lanes_whole(groups + leaf->group + i, &part);
        join(&part, whole);
    }
}

PHYS_INLINE void refit_node(const struct refit *refit, uint32_t node)
{
    struct contact_point_box box[4], normal[4];
    contact_lanes altitude;
    for (int k = 0; k < 4; k++) {
        const uint32_t child = refit->skin->child[node][k];
        float least;
        if (child & CONTACT_IS_LEAF) {
            const struct contact_leaf *leaf = refit->skin->leaf + (child & ~CONTACT_IS_LEAF);
            refit_leaf(refit, leaf, box + k);
            leaf_slopes(refit->skin, leaf, refit->x, refit->y, normal + k, &least);
        } else {
            const struct contact_slopes *slopes = refit->slopes + child;
            const contact_lanes of = slopes->altitude;
            lanes_whole(refit->nodes + child, box + k);
            lanes_whole(&slopes->normal, normal + k);
            least = of[0] < of[1] ? of[0] : of[1];
            least = of[2] < least ? of[2] : least;
            least = of[3] < least ? of[3] : least;
        }
        altitude[k] = least;
    }
    put_lanes(box, refit->nodes + node);
    put_lanes(normal, &refit->slopes[node].normal);
    refit->slopes[node].altitude = altitude;
}

PHYS_INLINE void refit_points(const struct refit *refit, const phys_vec *way,
                              struct contact_boxes_head *head, struct contact_point_box *of)
{
    const double far = (double)INFINITY;
    double least[3] = {far, far, far}, most[3] = {-far, -far, -far};
    for (uint32_t i = 0; i < refit->skin->n_points; i++) {
        const phys_vec x = refit->x[i], y = refit->y[i], end = y - *way;
        const contact_lanes near = __builtin_convertvector(end, contact_lanes);
        of[i].low = of[i].high = __builtin_convertvector(x, contact_lanes);
        lower(&near, &of[i].low);
        upper(&near, &of[i].high);
        round_out(of + i);
        PHYS_UNROLL
        for (int c = 0; c < 3; c++) {
            const double low = x[c] < y[c] ? x[c] : y[c], high = x[c] > y[c] ? x[c] : y[c];
            least[c] = low < least[c] ? low : least[c];
            most[c] = high > most[c] ? high : most[c];
        }
    }
    memcpy(head->low, least, sizeof least);
    memcpy(head->high, most, sizeof most);
    for (int c = 0; c < 3; c++)
        head->way[c] = (*way)[c];
}

/* There is room for more groups than there are, and behind all. */
PHYS_INLINE void clear_rest(const struct contact_skin *skin, const struct contact_boxes_head *head,
                            char *at)
{
    const struct contact_leaf *last = skin->leaf + skin->n_leaves - 1;
    const uint64_t n_groups = contact_edge_group(last) + contact_groups(last->n_edges);
    const uint64_t end = head->groups + n_groups * sizeof(struct contact_boxes);
    const uint64_t behind = head->moved + skin->n_nodes + skin->n_points;
    memset(at + end, 0, head->points - end);
    memset(at + behind, 0, head->bytes - behind);
}

/* Children have higher numbers than their node. */
PHYS_KERNEL(contact_refit,
            (const struct contact_skin *skin, const phys_vec *x, const phys_vec *y,
             const phys_vec *way, void *boxes),
            (skin, x, y, way, boxes))
{
    struct contact_boxes_head head;
    char *at = boxes;
    contact_boxes_lay(skin, &head);
    struct contact_point_box *of = (void *)(at + head.points);
    const struct refit refit = {.skin = skin,
                                .x = x,
                                .y = y,
                                .of = of,
                                .nodes = (void *)(at + head.nodes),
                                .groups = (void *)(at + head.groups),
                                .ways = (void *)(at + head.ways),
                                .slopes = (void *)(at + head.slopes)};
    refit_points(&refit, way, &head, of);
    memset(boxes, 0, head.nodes);
    memcpy(boxes, &head, sizeof head);
    for (uint32_t i = skin->n_nodes; i-- > 0;)
        refit_node(&refit, i);
    clear_rest(skin, &head, at);
}

void contact_boxes_root(const void *boxes, double low[3], double high[3])
{
    const struct contact_boxes_head *head = boxes;
    memcpy(low, head->low, sizeof head->low);
    memcpy(high, head->high, sizeof head->high);
}
