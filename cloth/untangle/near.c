/* Features that are too near go apart, along the way between them. If one of them is of a body or
 * an inner cloth, the other goes to the outer side of it. */
#include "cloth/untangle/state.h"

#include "cloth/base/order.h"

#include <stdlib.h>
#include <string.h>

struct looking {
    struct untangle *all;
    const struct contact_skin *skin[2];
};

struct corners {
    enum contact_pair pair;
    uint32_t point[4], first; /* corners before `first` are of the first feature */
};

/* The feature whose normals say where the other one must be: the inner one of two layers, the body
 * if one is of a body, the cloth of lower number if the two touch. -1: neither. */
static int base_of(const struct untangle *all, const struct corners *c, double gap)
{
    const uint32_t n = all->n_cloths;
    const uint32_t a = all->cloth[c->point[0]], b = all->cloth[c->point[3]];
    if (a >= n || b >= n)
        return a >= n ? 0 : 1;
    if (untangle_layered(all, a, b))
        return all->of->layer[a] < all->of->layer[b] ? 0 : 1;
    if (a == b || gap > 1e-6 * all->of->thickness)
        return -1;
    return a < b ? 0 : 1;
}

static void push_apart(struct untangle *all, const struct corners *c,
                       const struct contact_nearest *at)
{
    const int base = base_of(all, c, at->gap);
    struct untangle_push push = {.n = 4, .want = all->room, .normal = at->normal};
    phys_vec normal = {0};
    for (uint32_t k = 0; k < 4; k++) {
        const bool is_base = base == (k >= c->first);
        push.point[k] = c->point[k];
        push.weight[k] = at->weight[k];
        push.still |= (uint32_t)is_base << k;
        if (is_base)
            normal += fabs(at->weight[k]) * all->normal[c->point[k]];
    }
    if (base == 0)
        normal = -normal;
    if (phys_dot(&normal, &push.normal) < 0)
        push.normal = -push.normal;
    untangle_add(all, &push);
}

/* Edges are in the order of their ends. */
static int near_compare_ends(const void *ends, const void *edge)
{
    return cloth_compare_numbers(ends, ((const struct untangle_edge *)edge)->end, 2);
}

static bool near_pair_meets(const struct untangle *all, const struct corners *c)
{
    const uint32_t a = all->cloth[c->point[0]], b = all->cloth[c->point[3]];
    return untangle_meets(all, a, b) && !untangle_attached(all, 4, c->point, a > b ? a : b);
}

/* True if an edge joins the two features: the mesh has them near each other. */
static bool near_are_joined(const struct untangle *all, const struct corners *c)
{
    bool joined = false;
    for (uint32_t k = 0; k < 4 * c->first && !joined; k++) {
        const uint32_t a = c->point[k / 4], b = c->point[k % 4];
        const uint32_t ends[2] = {a < b ? a : b, a < b ? b : a};
        joined = k % 4 >= c->first &&
                 bsearch(ends, all->edge, all->n_edges, sizeof *all->edge, near_compare_ends);
    }
    return joined;
}

static void near_look_at(struct untangle *all, const struct corners *c)
{
    struct contact_nearest nearest;
    phys_vec x[4];
    bool tangled = false;
    for (int k = 0; k < 4; k++) {
        x[k] = all->x[c->point[k]];
        tangled = tangled || all->tangled[c->point[k]];
    }
    contact_nearest_of(c->pair, x, &nearest);
    if (tangled || nearest.gap >= all->open || !near_pair_meets(all, c) || near_are_joined(all, c))
        return;
    if (!all->count.near++)
        memcpy(all->near, c->point, sizeof all->near);
    push_apart(all, c, &nearest);
}

static void near_visit(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    const struct looking *looking = to;
    for (uint32_t i = 0; i < n && !looking->all->error->code; i++) {
        struct corners c;
        uint32_t point[4];
        unsigned char side[4];
        c.pair = contact_candidate_corners(looking->skin[0], looking->skin[1], candidate + i, point,
                                           side);
        c.first = c.pair == CONTACT_VT ? 1 : 2;
        for (int k = 0; k < 4; k++)
            c.point[k] = looking->skin[side[k]]->id[point[k]];
        near_look_at(looking->all, &c);
    }
}

int untangle_near(struct untangle *all)
{
    const struct contact_side cloth = {
        .skin = &all->skin, .boxes = all->boxes, .x = all->x, .y = all->x};
    struct looking looking = {all, {&all->skin, &all->skin}};
    all->count.near = 0;
    contact_query(&cloth, &cloth, all->open, near_visit, &looking);
    for (size_t i = 0; i < all->n_obstacles; i++) {
        const struct untangle_body *at = all->body + i;
        if (!at->body)
            continue;
        const phys_vec *x = all->x + at->first.point;
        const struct contact_side body = {.skin = &at->skin, .boxes = at->boxes, .x = x, .y = x};
        looking.skin[1] = &at->skin;
        contact_query(&cloth, &body, all->open, near_visit, &looking);
    }
    return all->error->code;
}
