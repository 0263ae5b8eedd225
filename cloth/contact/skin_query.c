/* A query walks two trees at once, or one with itself, and compares a box with four. Boxes of the
 * second skin are used as they are. Those of the first are widened by the reach, the motion of the
 * first frame against the second, and a bound on rounding. For at a part s of the step, x of a and
 * b differ by their difference within the frames, and s (way of a - way of b). */
#include "cloth/contact/skin_table.h"

#include <math.h>
#include <string.h>

/* m: the most that positions in a moving frame lose by rounding. */
static const double ROUNDING = 1e-9;
/* The part of a length that sums of floats may lose. */
static const double FLOATS = 1e-6;

typedef int32_t float_mask __attribute__((vector_size(16)));

struct query {
    const struct contact_side *side[2];
    const struct contact_skin *skin[2];
    double reach;
    const struct contact_boxes *node[2], *group[2];
    contact_lanes below[3], above[3]; /* m: the widening of boxes of the first */
    bool self;
    bool again;                    /* only pairs of parts of which one moved */
    const unsigned char *moved[2]; /* then by node: bit k: child k did; NULL: none did */
    struct contact_slab slab;      /* of the first leaf that was met last */
    contact_visit *visit;
    void *to;
    uint32_t n;
    struct contact_candidate candidate[CONTACT_BATCH];
};

/* A child of a node; of node ALL, all triangles. */
enum { ALL = INT32_MAX };
struct part {
    uint32_t node, lane;
};

/* ---- Boxes ---- */

/* Bit k: lane k is true. */
PHYS_INLINE unsigned bits_of(const float_mask *is)
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

/* One of four boxes of the first skin, widened, in all lanes. */
PHYS_INLINE void widen(const struct query *query, const struct contact_boxes *boxes, uint32_t lane,
                       struct contact_boxes *wide)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const float low = boxes->low[c][lane], high = boxes->high[c][lane];
        wide->low[c] = (contact_lanes){low, low, low, low} - query->below[c];
        wide->high[c] = (contact_lanes){high, high, high, high} + query->above[c];
    }
}

/* The same of the second skin, to meet boxes of the first. */
PHYS_INLINE void widen_other(const struct query *query, const struct contact_boxes *boxes,
                             uint32_t lane, struct contact_boxes *wide)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const float low = boxes->low[c][lane], high = boxes->high[c][lane];
        wide->low[c] = (contact_lanes){low, low, low, low} - query->above[c];
        wide->high[c] = (contact_lanes){high, high, high, high} + query->below[c];
    }
}

/* Which of four boxes meet a wide one. */
PHYS_INLINE unsigned meeting(const struct contact_boxes *wide, const struct contact_boxes *boxes)
{
    float_mask is = (wide->low[0] <= boxes->high[0]) & (wide->high[0] >= boxes->low[0]);
    is &= (wide->low[1] <= boxes->high[1]) & (wide->high[1] >= boxes->low[1]);
    is &= (wide->low[2] <= boxes->high[2]) & (wide->high[2] >= boxes->low[2]);
    return bits_of(&is);
}

/* True if one of two parts has a feature that moved. */
PHYS_INLINE bool has_moved(const struct query *query, struct part a, struct part b)
{
    const unsigned char *const *moved = query->moved;
    return !query->again || (moved[0][a.node] >> a.lane & 1) ||
           (moved[1] && (moved[1][b.node] >> b.lane & 1));
}

/* ---- Flat parts ---- */

static void find_patch(const struct query *query, int k, struct part part,
                       struct contact_patch *patch)
{
    const struct contact_skin *skin = query->skin[k];
    const bool all = part.node == ALL;
    const struct contact_slopes *slopes =
        contact_boxes_slopes(query->side[k]->boxes) + (all ? 0 : part.node);
    *patch =
        (struct contact_patch){.side = query->side[k],
                               .loop = skin->loop + contact_loop_at(skin, part.node, part.lane),
                               .altitude = slopes->altitude[all ? 0 : part.lane]};
    for (int c = 0; c < 3; c++) {
        const contact_lanes low = slopes->normal.low[c], high = slopes->normal.high[c];
        patch->normal.low[c] = low[all ? 0 : part.lane];
        patch->normal.high[c] = high[all ? 0 : part.lane];
        for (int i = 1; i < 4 && all; i++) {
            patch->normal.low[c] = low[i] < patch->normal.low[c] ? low[i] : patch->normal.low[c];
            patch->normal.high[c] =
                high[i] > patch->normal.high[c] ? high[i] : patch->normal.high[c];
        }
    }
    for (int i = 1; i < 4 && all; i++)
        patch->altitude =
            slopes->altitude[i] < patch->altitude ? slopes->altitude[i] : patch->altitude;
}

static bool part_is_flat(const struct query *query, struct part part)
{
    struct contact_patch patch;
    find_patch(query, 0, part, &patch);
    return contact_patches_flat(&patch, NULL, query->reach);
}

/* Both as one. */
static bool parts_are_flat(const struct query *query, struct part a, struct part b)
{
    struct contact_patch of_a, of_b;
    find_patch(query, 0, a, &of_a);
    find_patch(query, 1, b, &of_b);
    return contact_patches_flat(&of_a, &of_b, query->reach);
}

/* ---- Features ---- */

static void skin_query_add(struct query *query, uint32_t kind, uint32_t a, uint32_t b)
{
    if (query->n == CONTACT_BATCH) {
        query->visit(query->to, query->n, query->candidate);
        query->n = 0;
    }
    query->candidate[query->n++] = (struct contact_candidate){kind, {a, b}};
}

/* A vertex of skin k with a triangle of the other. */
static void add_vertex(struct query *query, int k, uint32_t vertex, uint32_t triangle)
{
    const struct contact_skin *of = query->skin[k], *other = query->skin[!k];
    const uint32_t is = of->joined[of->vertex[vertex]];
    const uint32_t *with = other->joined, *corner = other->corner[triangle];
    if (is == with[corner[0]] || is == with[corner[1]] || is == with[corner[2]])
        return;
    if (k && !query->self)
        skin_query_add(query, CONTACT_TV, triangle, vertex);
    else
        skin_query_add(query, CONTACT_VT, vertex, triangle);
}

static void skin_query_add_edges(struct query *query, uint32_t a, uint32_t b)
{
    const uint32_t *first = query->skin[0]->joined, *second = query->skin[1]->joined;
    const uint32_t *of = query->skin[0]->edge[a], *with = query->skin[1]->edge[b];
    const uint32_t a0 = first[of[0]], a1 = first[of[1]];
    const uint32_t b0 = second[with[0]], b1 = second[with[1]];
    if (a0 != b0 && a0 != b1 && a1 != b0 && a1 != b1)
        skin_query_add(query, CONTACT_EE, a, b);
}

/* A leaf of skin k, and which of its features may be near to the other leaf: a bit each. */
struct leaf_near {
    const struct contact_leaf *leaf;
    const struct contact_boxes *group;
    struct contact_features is;
};

/* Which of n boxes meet a wide one. */
static uint32_t meeting_all(const struct contact_boxes *wide, const struct contact_boxes *boxes,
                            uint32_t n)
{
    uint32_t bits = 0;
    for (uint32_t k = 0; k < n; k += 4)
        bits |= (uint32_t)meeting(wide, boxes + k / 4) << k;
    return bits;
}

static void look_at_leaf(const struct query *query, int k, const struct contact_leaf *leaf,
                         const struct contact_boxes *wide, struct leaf_near *near)
{
    const struct contact_boxes *group = query->group[k];
    *near = (struct leaf_near){leaf, group, {UINT32_MAX, UINT32_MAX, UINT32_MAX}};
    if (!wide)
        return;
    near->is = (struct contact_features){
        meeting_all(wide, group + contact_vertex_group(leaf), leaf->n_vertices),
        meeting_all(wide, group + leaf->group, leaf->n_triangles),
        meeting_all(wide, group + contact_edge_group(leaf), leaf->n_edges)};
}

/* The first n bits. */
PHYS_INLINE uint32_t bits_below(uint32_t bits, uint32_t n)
{
    return n < 32 ? bits & ((UINT32_C(1) << n) - 1) : bits;
}

/* Vertices of the first leaf with the triangles of the second. */
static void meet_vertices(struct query *query, const struct leaf_near *a, const struct leaf_near *b)
{
    const struct contact_leaf *of = a->leaf, *other = b->leaf;
    for (uint32_t left = bits_below(a->is.vertices, of->n_vertices); left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        struct contact_boxes wide;
        widen(query, a->group + contact_vertex_group(of) + i / 4, i % 4, &wide);
        for (uint32_t k = 0; k < other->n_triangles; k += 4) {
            unsigned bits = meeting(&wide, b->group + other->group + k / 4) & b->is.triangles >> k;
            for (; bits; bits &= bits - 1)
                add_vertex(query, 0, of->vertex + i,
                           other->triangle + k + (uint32_t)__builtin_ctz(bits));
        }
    }
}

/* Triangles of the first leaf with the vertices of the second. */
static void meet_triangles(struct query *query, const struct leaf_near *a,
                           const struct leaf_near *b)
{
    const struct contact_leaf *of = a->leaf, *other = b->leaf;
    for (uint32_t left = bits_below(a->is.triangles, of->n_triangles); left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        struct contact_boxes wide;
        widen(query, a->group + of->group + i / 4, i % 4, &wide);
        for (uint32_t k = 0; k < other->n_vertices; k += 4) {
            unsigned bits = meeting(&wide, b->group + contact_vertex_group(other) + k / 4) &
                            b->is.vertices >> k;
            for (; bits; bits &= bits - 1)
                add_vertex(query, 1, other->vertex + k + (uint32_t)__builtin_ctz(bits),
                           of->triangle + i);
        }
    }
}

/* Edges of two leaves; of one with itself, each pair once. */
static void meet_edges(struct query *query, const struct leaf_near *a, const struct leaf_near *b)
{
    const struct contact_leaf *of = a->leaf, *other = b->leaf;
    for (uint32_t left = bits_below(a->is.edges, of->n_edges); left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        const bool self = a == b;
        struct contact_boxes wide;
        widen(query, a->group + contact_edge_group(of) + i / 4, i % 4, &wide);
        for (uint32_t k = self ? i / 4 * 4 : 0; k < other->n_edges; k += 4) {
            unsigned bits =
                meeting(&wide, b->group + contact_edge_group(other) + k / 4) & b->is.edges >> k;
            if (self && k <= i)
                bits &= ~1u << i % 4;
            for (; bits; bits &= bits - 1)
                skin_query_add_edges(query, of->edge + i,
                                     other->edge + k + (uint32_t)__builtin_ctz(bits));
        }
    }
}

/* ---- Trees ---- */

static bool is_leaf(uint32_t child)
{
    return child & CONTACT_IS_LEAF;
}

static const struct contact_leaf *leaf_of(const struct query *query, int k, struct part part)
{
    const uint32_t child = query->skin[k]->child[part.node][part.lane];
    return query->skin[k]->leaf + (child & ~CONTACT_IS_LEAF);
}

/* True if two leaves are out of reach, as seen along the normals of the first. Leaves of one skin
 * that meet mostly share a border: testing them costs more than it saves. */
static bool leaves_part(struct query *query, struct part a, const struct contact_leaf *other)
{
    struct contact_slab *slab = &query->slab;
    if (query->self)
        return false;
    if (slab->node != a.node || slab->lane != a.lane)
        contact_slab_begin(query->side[0], a.node, a.lane, slab);
    return contact_slab_parts(query->side[1], other, slab);
}

/* Compares only features near the other leaf's box and within reach along the normals. */
static void meet_leaves(struct query *query, struct part a, struct part b)
{
    const struct contact_leaf *of = leaf_of(query, 0, a), *other = leaf_of(query, 1, b);
    struct contact_boxes wide[2];
    struct leaf_near near[2];
    if (leaves_part(query, a, other))
        return;
    widen(query, query->node[0] + a.node, a.lane, wide);
    widen_other(query, query->node[1] + b.node, b.lane, wide + 1);
    look_at_leaf(query, 0, of, wide + 1, near);
    look_at_leaf(query, 1, other, wide, near + 1);
    if (query->slab.is) {
        contact_slab_keep(&query->slab, 0, query->side[0], of, &near[0].is);
        contact_slab_keep(&query->slab, 1, query->side[1], other, &near[1].is);
    }
    meet_vertices(query, near, near + 1);
    meet_triangles(query, near, near + 1);
    meet_edges(query, near, near + 1);
}

static void meet_leaf_self(struct query *query, struct part part)
{
    struct leaf_near near;
    look_at_leaf(query, 0, leaf_of(query, 0, part), NULL, &near);
    meet_vertices(query, &near, &near);
    meet_edges(query, &near, &near);
}

/* Two parts whose boxes meet. */
static void meet(struct query *query, struct part a, struct part b)
{
    const uint32_t of_a = query->skin[0]->child[a.node][a.lane];
    const uint32_t of_b = query->skin[1]->child[b.node][b.lane];
    const bool descend_a = !is_leaf(of_a), descend_b = !is_leaf(of_b);
    if (!has_moved(query, a, b))
        return;
    if (!descend_a && !descend_b) {
        meet_leaves(query, a, b);
        return;
    }
    if (descend_a && descend_b && parts_are_flat(query, a, b))
        return;
    for (uint32_t i = descend_a ? 0 : a.lane; i < (descend_a ? 4 : a.lane + 1); i++) {
        const struct part down_a = {descend_a ? of_a : a.node, i};
        const uint32_t node_b = descend_b ? of_b : b.node;
        struct contact_boxes wide;
        widen(query, query->node[0] + down_a.node, i, &wide);
        unsigned bits = meeting(&wide, query->node[1] + node_b) & (descend_b ? 15 : 1u << b.lane);
        for (; bits; bits &= bits - 1)
            meet(query, down_a, (struct part){node_b, (uint32_t)__builtin_ctz(bits)});
    }
}

static void meet_self(struct query *query, uint32_t node)
{
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t child = query->skin[0]->child[node][i];
        const struct part part = {node, i};
        struct contact_boxes wide;
        if (has_moved(query, part, part)) {
            if (is_leaf(child))
                meet_leaf_self(query, part);
            else if (!part_is_flat(query, part))
                meet_self(query, child);
        }
        widen(query, query->node[0] + node, i, &wide);
        unsigned bits = meeting(&wide, query->node[0] + node) & ~1u << i;
        for (; bits; bits &= bits - 1)
            meet(query, part, (struct part){node, (uint32_t)__builtin_ctz(bits)});
    }
}

static void meet_roots(struct query *query)
{
    for (uint32_t i = 0; i < 4; i++) {
        struct contact_boxes wide;
        widen(query, query->node[0], i, &wide);
        unsigned bits = meeting(&wide, query->node[1]);
        for (; bits; bits &= bits - 1)
            meet(query, (struct part){0, i}, (struct part){0, (uint32_t)__builtin_ctz(bits)});
    }
}

/* ---- The query ---- */

static void set_reach(struct query *query, const struct contact_side *a,
                      const struct contact_side *b, double reach)
{
    const struct contact_boxes_head *of = a->boxes, *other = b->boxes;
    for (int c = 0; c < 3; c++) {
        const double more = of->way[c] - other->way[c];
        const double out = (reach + fabs(more)) * FLOATS + ROUNDING + reach;
        const float below = (float)(out - fmin(more, 0)), above = (float)(out + fmax(more, 0));
        query->below[c] = (contact_lanes){below, below, below, below};
        query->above[c] = (contact_lanes){above, above, above, above};
    }
}

static const unsigned char *moved_of(const struct contact_side *side)
{
    const struct contact_boxes_head *head = side->boxes;
    return (const unsigned char *)side->boxes + head->moved;
}

static void query_run(struct query *query, const struct contact_side *a,
                      const struct contact_side *b, double reach, contact_visit *visit, void *to)
{
    const struct part whole = {ALL, 0};
    query->side[0] = a;
    query->side[1] = b;
    query->reach = reach;
    query->skin[0] = a->skin;
    query->skin[1] = b->skin;
    query->node[0] = contact_boxes_nodes(a->boxes);
    query->node[1] = contact_boxes_nodes(b->boxes);
    query->group[0] = contact_boxes_groups(a->boxes);
    query->group[1] = contact_boxes_groups(b->boxes);
    query->self = a->skin == b->skin;
    query->visit = visit;
    query->to = to;
    query->n = 0;
    query->slab.node = ALL;
    query->slab.is = false;
    query->slab.most = contact_slab_most(a, b, reach);
    set_reach(query, a, b, reach);
    if (query->self && !part_is_flat(query, whole))
        meet_self(query, 0);
    if (!query->self && !parts_are_flat(query, whole, whole))
        meet_roots(query);
    if (query->n)
        visit(to, query->n, query->candidate);
}

void contact_query(const struct contact_side *a, const struct contact_side *b, double reach,
                   contact_visit *visit, void *to)
{
    struct query query;
    query.again = false;
    query_run(&query, a, b, reach, visit, to);
}

void contact_query_moved(const struct contact_side *a, const struct contact_side *b, bool rests,
                         double reach, contact_visit *visit, void *to)
{
    struct query query;
    query.again = true;
    query.moved[0] = moved_of(a);
    query.moved[1] = rests ? NULL : moved_of(b);
    query_run(&query, a, b, reach, visit, to);
}

enum contact_pair contact_candidate_corners(const struct contact_skin *a,
                                            const struct contact_skin *b,
                                            const struct contact_candidate *candidate,
                                            uint32_t point[4], unsigned char side[4])
{
    static const unsigned char SIDE[3][4] = {
        [CONTACT_VT] = {0, 1, 1, 1}, [CONTACT_EE] = {0, 0, 1, 1}, [CONTACT_TV] = {1, 0, 0, 0}};
    memcpy(side, SIDE[candidate->kind], sizeof SIDE[0]);
    if (candidate->kind == CONTACT_EE) {
        memcpy(point, a->edge[candidate->of[0]], sizeof *a->edge);
        memcpy(point + 2, b->edge[candidate->of[1]], sizeof *b->edge);
        return CONTACT_EE;
    }
    const bool swapped = candidate->kind == CONTACT_TV;
    point[0] = (swapped ? b : a)->vertex[candidate->of[swapped]];
    memcpy(point + 1, (swapped ? a : b)->corner[candidate->of[!swapped]], sizeof *a->corner);
    return CONTACT_VT;
}
