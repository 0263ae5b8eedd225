/* Boxes of a step, from the points up: each is of all positions between x and y, as seen from a
 * frame that moves by `way` meanwhile. A point moves straight in it, too, so its box is that of its
 * two ends. Rounding to floats outwards takes more than the roundings of a query may take back. */
#include "cloth/contact/skin_table.h"

#include <math.h>
#include <string.h>

typedef int64_t lane_mask __attribute__((vector_size(32)));
typedef int32_t float_mask __attribute__((vector_size(16)));

static const contact_lanes NOTHING = {INFINITY, INFINITY, INFINITY, INFINITY};

PHYS_INLINE void lower(const phys_vec *a, phys_vec *least)
{
    const lane_mask is = *a < *least;
    *least = (phys_vec)(((lane_mask)*a & is) | ((lane_mask)*least & ~is));
}

PHYS_INLINE void upper(const phys_vec *a, phys_vec *most)
{
    const lane_mask is = *a > *most;
    *most = (phys_vec)(((lane_mask)*a & is) | ((lane_mask)*most & ~is));
}

PHYS_INLINE void join(const struct contact_point_box *a, struct contact_point_box *whole)
{
    const float_mask below = a->low<whole->low, above = a->high> whole->high;
    whole->low = (contact_lanes)(((float_mask)a->low & below) | ((float_mask)whole->low & ~below));
    whole->high =
        (contact_lanes)(((float_mask)a->high & above) | ((float_mask)whole->high & ~above));
}

/* Takes two to four units in the last place more than rounding to the nearest may. */
PHYS_INLINE void round_out(const phys_vec *low, const phys_vec *high, struct contact_point_box *box)
{
    const contact_lanes near_low = __builtin_convertvector(*low, contact_lanes);
    const contact_lanes near_high = __builtin_convertvector(*high, contact_lanes);
    const float_mask size = {INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX};
    box->low = near_low - (contact_lanes)((float_mask)near_low & size) * 0x1p-22f;
    box->high = near_high + (contact_lanes)((float_mask)near_high & size) * 0x1p-22f;
}

/* Puts four boxes, one after the other, into the lanes of as many as there are; n <= 4. */
PHYS_INLINE void put_lanes(const struct contact_point_box box[4], struct contact_boxes *to)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        to->low[c] = (contact_lanes){box[0].low[c], box[1].low[c], box[2].low[c], box[3].low[c]};
        to->high[c] =
            (contact_lanes){box[0].high[c], box[1].high[c], box[2].high[c], box[3].high[c]};
    }
}

/* Groups of the boxes of n features, each of so many points. */
PHYS_INLINE void put_features(uint32_t n, uint32_t points, const uint32_t *point,
                              const struct contact_point_box *of, struct contact_boxes *to,
                              struct contact_point_box *whole)
{
    for (uint32_t i = 0; i < n; i += 4) {
        struct contact_point_box box[4];
        for (uint32_t k = 0; k < 4; k++) {
            box[k] = (struct contact_point_box){NOTHING, -NOTHING};
            for (uint32_t j = 0; j < points && i + k < n; j++)
                join(of + point[points * (i + k) + j], box + k);
            join(box + k, whole);
        }
        put_lanes(box, to + i / 4);
    }
}

PHYS_INLINE void refit_leaf(const struct contact_skin *skin, const struct contact_leaf *leaf,
                            const struct contact_point_box *of, struct contact_boxes *groups,
                            struct contact_point_box *whole)
{
    *whole = (struct contact_point_box){NOTHING, -NOTHING};
    put_features(leaf->n_triangles, 3, skin->corner[leaf->triangle], of, groups + leaf->group,
                 whole);
    put_features(leaf->n_vertices, 1, skin->vertex + leaf->vertex, of,
                 groups + contact_vertex_group(leaf), whole);
    put_features(leaf->n_edges, 2, skin->edge[leaf->edge], of, groups + contact_edge_group(leaf),
                 whole);
}

/* The box around the four of a node. */
PHYS_INLINE void node_whole(const struct contact_boxes *node, struct contact_point_box *whole)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const contact_lanes low = node->low[c], high = node->high[c];
        const float low01 = low[0] < low[1] ? low[0] : low[1];
        const float low23 = low[2] < low[3] ? low[2] : low[3];
        const float high01 = high[0] > high[1] ? high[0] : high[1];
        const float high23 = high[2] > high[3] ? high[2] : high[3];
        whole->low[c] = low01 < low23 ? low01 : low23;
        whole->high[c] = high01 > high23 ? high01 : high23;
    }
    whole->low[3] = whole->high[3] = 0;
}

/* Children have higher numbers than their node. */
PHYS_INLINE void refit_nodes(const struct contact_skin *skin, const struct contact_point_box *of,
                             struct contact_boxes *groups, struct contact_boxes *nodes)
{
    for (uint32_t i = skin->n_nodes; i-- > 0;) {
        struct contact_point_box box[4];
        for (int k = 0; k < 4; k++) {
            const uint32_t child = skin->child[i][k];
            if (child & CONTACT_IS_LEAF)
                refit_leaf(skin, skin->leaf + (child & ~CONTACT_IS_LEAF), of, groups, box + k);
            else
                node_whole(nodes + child, box + k);
        }
        put_lanes(box, nodes + i);
    }
}

PHYS_INLINE void refit_points(const struct contact_skin *skin, const phys_vec *x, const phys_vec *y,
                              const phys_vec *way, struct contact_boxes_head *head,
                              struct contact_point_box *of)
{
    const double far = (double)INFINITY;
    phys_vec least = {far, far, far, far}, most = {-far, -far, -far, -far};
    for (uint32_t i = 0; i < skin->n_points; i++) {
        const phys_vec end = y[i] - *way;
        phys_vec low = x[i], high = x[i];
        lower(y + i, &least);
        upper(y + i, &most);
        lower(x + i, &least);
        upper(x + i, &most);
        lower(&end, &low);
        upper(&end, &high);
        round_out(&low, &high, of + i);
    }
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        head->low[c] = least[c];
        head->high[c] = most[c];
        head->way[c] = (*way)[c];
    }
}

/* There is room for more groups than there are, and behind the points. */
PHYS_INLINE void clear_rest(const struct contact_skin *skin, const struct contact_boxes_head *head,
                            char *at)
{
    const struct contact_leaf *last = skin->leaf + skin->n_leaves - 1;
    const uint64_t n_groups = contact_edge_group(last) + contact_groups(last->n_edges);
    const uint64_t end = head->groups + n_groups * sizeof(struct contact_boxes);
    const uint64_t of_points = head->points + skin->n_points * sizeof(struct contact_point_box);
    memset(at + end, 0, head->points - end);
    memset(at + of_points, 0, head->bytes - of_points);
}

PHYS_KERNEL(contact_refit,
            (const struct contact_skin *skin, const phys_vec *x, const phys_vec *y,
             const phys_vec *way, void *boxes),
            (skin, x, y, way, boxes))
{
    struct contact_boxes_head head;
    char *at = boxes;
    contact_boxes_lay(skin, &head);
    struct contact_point_box *of = (void *)(at + head.points);
    refit_points(skin, x, y, way, &head, of);
    memset(boxes, 0, head.nodes);
    memcpy(boxes, &head, sizeof head);
    refit_nodes(skin, of, (void *)(at + head.groups), (void *)(at + head.nodes));
    clear_rest(skin, &head, at);
}

void contact_boxes_root(const void *boxes, double low[3], double high[3])
{
    const struct contact_boxes_head *head = boxes;
    memcpy(low, head->low, sizeof head->low);
    memcpy(high, head->high, sizeof head->high);
}
