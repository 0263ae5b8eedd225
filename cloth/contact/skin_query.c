/* A query walks two trees at once, or one with itself, and compares a box with four. Boxes of the
 * second skin are used as they are. Those of the first are widened by the reach, the motion of the
 * first frame against the second, and a bound on rounding. For at a part s of the step, x of a and
 * b differ by their difference within the frames, and s (way of a - way of b). */
#include "cloth/contact/skin_lanes.h"

#include <math.h>
#include <string.h>

/* m: the most that positions in a moving frame lose by rounding. */
static const double ROUNDING = 1e-9;
/* The part of a length that sums of floats may lose. */
static const double FLOATS = 1e-6;

struct query {
    struct contact_leaves leaves;
    const struct contact_skin *skin[2];
    double reach, flat;            /* m: of all; of what lies in one flat part */
    bool shares;                   /* the skins may have points in common */
    bool again;                    /* only pairs of parts of which one moved */
    const unsigned char *moved[2]; /* then by node: bit k: child k did; NULL: none did */
    bool parted;                   /* the leaves that are met */
    contact_visit *visit;
    void *to;
    uint32_t n;
    struct contact_candidate candidate[CONTACT_BATCH];
};

/* ---- Boxes ---- */

/* True if one of two parts has a feature that moved. */
PHYS_INLINE bool has_moved(const struct query *query, struct contact_part a, struct contact_part b)
{
    const unsigned char *const *moved = query->moved;
    return !query->again || (moved[0][a.node] >> a.lane & 1) ||
           (moved[1] && (moved[1][b.node] >> b.lane & 1));
}

/* ---- Flat parts ---- */

static void find_patch(const struct query *query, int k, struct contact_part part,
                       struct contact_patch *patch)
{
    const struct contact_skin *skin = query->skin[k];
    const bool all = part.node == CONTACT_ALL;
    const struct contact_slopes *slopes =
        contact_boxes_slopes(query->leaves.side[k]->boxes) + (all ? 0 : part.node);
    *patch =
        (struct contact_patch){.side = query->leaves.side[k],
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

static bool part_is_flat(const struct query *query, struct contact_part part)
{
    struct contact_patch patch;
    find_patch(query, 0, part, &patch);
    return contact_patches_flat(&patch, NULL, query->flat);
}

/* Both as one, which they can only be by points in common. */
static bool parts_are_flat(const struct query *query, struct contact_part a, struct contact_part b)
{
    struct contact_patch of_a, of_b;
    if (!query->shares)
        return false;
    find_patch(query, 0, a, &of_a);
    find_patch(query, 1, b, &of_b);
    return contact_patches_flat(&of_a, &of_b, query->flat);
}

/* ---- Features ---- */

static void skin_query_add(struct query *query, uint32_t kind, bool presses, uint32_t a, uint32_t b)
{
    if (query->n == CONTACT_BATCH) {
        query->visit(query->to, query->n, query->candidate);
        query->n = 0;
    }
    query->candidate[query->n++] = (struct contact_candidate){kind, {a, b}, query->parted, presses};
}

/* A vertex of skin k with a triangle of the other. */
static void add_vertex(struct query *query, int k, uint32_t vertex, uint32_t triangle)
{
    const struct contact_skin *of = query->skin[k], *other = query->skin[!k];
    const uint32_t is = of->joined[of->vertex[vertex]];
    const uint32_t *with = other->joined, *corner = other->corner[triangle];
    if (query->shares && (is == with[corner[0]] || is == with[corner[1]] || is == with[corner[2]]))
        return;
    if (k && !query->leaves.self)
        skin_query_add(query, CONTACT_TV, true, triangle, vertex);
    else
        skin_query_add(query, CONTACT_VT, true, vertex, triangle);
}

static void skin_query_add_edges(struct query *query, bool press, uint32_t a, uint32_t b)
{
    const uint32_t *first = query->skin[0]->joined, *second = query->skin[1]->joined;
    const uint32_t *of = query->skin[0]->edge[a], *with = query->skin[1]->edge[b];
    const uint32_t a0 = first[of[0]], a1 = first[of[1]];
    const uint32_t b0 = second[with[0]], b1 = second[with[1]];
    if (!query->shares || (a0 != b0 && a0 != b1 && a1 != b0 && a1 != b1))
        skin_query_add(query, CONTACT_EE, press, a, b);
}

/* Adds what met of two leaves: vertices of the first, its triangles, and edges. */
static void meet_vertices(struct query *query, const struct contact_met *met,
                          const struct contact_leaf *of, const struct contact_leaf *other)
{
    for (uint32_t left = met->is; left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        for (uint32_t bits = met->bits[i]; bits; bits &= bits - 1)
            add_vertex(query, 0, of->vertex + i, other->triangle + (uint32_t)__builtin_ctz(bits));
    }
}

static void meet_triangles(struct query *query, const struct contact_met *met,
                           const struct contact_leaf *of, const struct contact_leaf *other)
{
    for (uint32_t left = met->is; left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        for (uint32_t bits = met->bits[i]; bits; bits &= bits - 1)
            add_vertex(query, 1, other->vertex + (uint32_t)__builtin_ctz(bits), of->triangle + i);
    }
}

static void meet_edges(struct query *query, const struct contact_met_leaf *leaves,
                       const struct contact_leaf *of, const struct contact_leaf *other)
{
    const struct contact_met *met = &leaves->edges;
    for (uint32_t left = met->is; left; left &= left - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(left);
        const uint32_t press = leaves->ridges[0] >> i & 1 ? leaves->ridges[1] : 0;
        for (uint32_t bits = met->bits[i]; bits; bits &= bits - 1) {
            const uint32_t k = (uint32_t)__builtin_ctz(bits);
            skin_query_add_edges(query, press >> k & 1, of->edge + i, other->edge + k);
        }
    }
}

/* ---- Trees ---- */

static bool is_leaf(uint32_t child)
{
    return child & CONTACT_IS_LEAF;
}

static const struct contact_leaf *leaf_of(const struct query *query, int k,
                                          struct contact_part part)
{
    const uint32_t child = query->skin[k]->child[part.node][part.lane];
    return query->skin[k]->leaf + (child & ~CONTACT_IS_LEAF);
}

static void meet_leaves(struct query *query, struct contact_part a, struct contact_part b)
{
    const struct contact_leaf *of = leaf_of(query, 0, a), *other = leaf_of(query, 1, b);
    struct contact_met_leaf met;
    if (!contact_leaves_meet(&query->leaves, a, b, &met))
        return;
    query->parted = met.parted;
    meet_vertices(query, &met.vertices, of, other);
    meet_triangles(query, &met.triangles, of, other);
    meet_edges(query, &met, of, other);
}

static void meet_leaf_self(struct query *query, struct contact_part part)
{
    const struct contact_leaf *leaf = leaf_of(query, 0, part);
    struct contact_met_leaf met;
    contact_leaf_meets_itself(&query->leaves, part, &met);
    query->parted = met.parted;
    meet_vertices(query, &met.vertices, leaf, leaf);
    meet_edges(query, &met, leaf, leaf);
}

/* Two parts whose boxes meet. */
static void meet(struct query *query, struct contact_part a, struct contact_part b)
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
        const struct contact_part down_a = {descend_a ? of_a : a.node, i};
        const uint32_t node_b = descend_b ? of_b : b.node;
        struct contact_boxes wide;
        contact_boxes_widen(&query->leaves.by, query->leaves.node[0] + down_a.node, i, &wide);
        unsigned bits = contact_boxes_meeting(&wide, query->leaves.node[1] + node_b) &
                        (descend_b ? 15 : 1u << b.lane);
        for (; bits; bits &= bits - 1)
            meet(query, down_a, (struct contact_part){node_b, (uint32_t)__builtin_ctz(bits)});
    }
}

static void meet_self(struct query *query, uint32_t node)
{
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t child = query->skin[0]->child[node][i];
        const struct contact_part part = {node, i};
        struct contact_boxes wide;
        if (has_moved(query, part, part)) {
            if (is_leaf(child))
                meet_leaf_self(query, part);
            else if (!part_is_flat(query, part))
                meet_self(query, child);
        }
        contact_boxes_widen(&query->leaves.by, query->leaves.node[0] + node, i, &wide);
        unsigned bits = contact_boxes_meeting(&wide, query->leaves.node[0] + node) & ~1u << i;
        for (; bits; bits &= bits - 1)
            meet(query, part, (struct contact_part){node, (uint32_t)__builtin_ctz(bits)});
    }
}

static void meet_roots(struct query *query)
{
    for (uint32_t i = 0; i < 4; i++) {
        struct contact_boxes wide;
        contact_boxes_widen(&query->leaves.by, query->leaves.node[0], i, &wide);
        unsigned bits = contact_boxes_meeting(&wide, query->leaves.node[1]);
        for (; bits; bits &= bits - 1)
            meet(query, (struct contact_part){0, i},
                 (struct contact_part){0, (uint32_t)__builtin_ctz(bits)});
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
        const contact_lanes belows = {below, below, below, below};
        const contact_lanes aboves = {above, above, above, above};
        query->leaves.by.below[c] = query->leaves.back.above[c] = belows;
        query->leaves.by.above[c] = query->leaves.back.below[c] = aboves;
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
    const struct contact_part whole = {CONTACT_ALL, 0};
    query->leaves.side[0] = a;
    query->leaves.side[1] = b;
    query->reach = reach;
    query->skin[0] = a->skin;
    query->skin[1] = b->skin;
    query->leaves.node[0] = contact_boxes_nodes(a->boxes);
    query->leaves.node[1] = contact_boxes_nodes(b->boxes);
    query->leaves.group[0] = contact_boxes_groups(a->boxes);
    query->leaves.group[1] = contact_boxes_groups(b->boxes);
    query->leaves.self = a->skin == b->skin;
    query->flat = a->flat > 0 && a->flat < reach ? a->flat : reach;
    query->shares = a->skin->ids[0] <= b->skin->ids[1] && b->skin->ids[0] <= a->skin->ids[1];
    query->visit = visit;
    query->to = to;
    query->n = 0;
    query->leaves.ridged = NULL;
    query->leaves.slab.node = CONTACT_ALL;
    query->leaves.slab.is = false;
    query->leaves.slab.apart = query->leaves.slab.begin = -INFINITY;
    query->leaves.slab.most = contact_slab_most(a, b, reach);
    query->leaves.parts =
        a->parts > 0 || a->parts < 0 ? contact_slab_most(a, b, a->parts) : INFINITY;
    set_reach(query, a, b, reach);
    if (query->leaves.self && !part_is_flat(query, whole))
        meet_self(query, 0);
    if (!query->leaves.self && !parts_are_flat(query, whole, whole))
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
