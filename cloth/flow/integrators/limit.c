/* The fastest vibration of a model where it starts. For one spring between a and b, |u.(xa - xb)|^2
 * <= 2 |u.xa|^2 + 2 |u.xb|^2. So K is at most the sum over all vertices of twice the 3 x 3 blocks
 * that springs put on their diagonal (once, for a spring to a held end). The largest eigenvalue of
 * M^-1 K is at most the largest of these blocks over their masses. That is Gershgorin's bound by
 * blocks, with 2 |Kaa| in place of |Kaa| + sum of |Kab|, which ignores the directions of springs. A
 * chain of equal springs and masses reaches it as it gets longer. For an element with n free
 * corners, K is likewise at most n times its blocks on the diagonal. For a joint with weights w,
 * |sum of w u.x|^2 <= sum of |w| times sum of |w| |u.x|^2. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/physics/limit.h"

#include <math.h>

/* Twice the block of a vertex, xx yy zz xy yz zx, N/m; and twice the damping of its springs. */
struct block {
    double stiff[6], damping;
};

struct visitor {
    const struct flow_source *source;
    struct flow_cloths at;
    struct block *block;
    void *material[ELEMENT_KINDS]; /* as element_materials fills them */
    struct cloth_pool memory;
};

static void particle_of(struct visitor *visitor, uint32_t vertex, struct flow_particle *particle)
{
    const struct flow_source *source = visitor->source;
    flow_particle_at(&source->particles, source->model, &visitor->at, vertex, particle);
}

static void add_spring_block(struct block *block, double times, const struct flow_spring *s,
                             const phys_vec *u, double across)
{
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    for (int i = 0; i < 6; i++)
        block->stiff[i] += times * s->stiffness *
                           ((1 - across) * (*u)[row[i]] * (*u)[column[i]] + (i < 3 ? across : 0));
    block->damping += times * s->damping;
}

/* Visits a spring between the points that n vertices make by their weights, whose sum is 0. */
static void visit_weighted(struct visitor *visitor, const struct flow_spring *s, uint32_t n,
                           const uint32_t *vertex, const double *weight)
{
    const struct flow_welds *welds = &visitor->source->particles.welds;
    struct flow_particle particle[SOLVE_TIE_CORNERS];
    double free = 0;
    phys_vec d = {0};
    for (uint32_t k = 0; k < n; k++) {
        particle_of(visitor, flow_root(welds, vertex[k]), particle + k);
        d += weight[k] * particle[k].position;
        free += fabs(weight[k]) * particle[k].free;
    }
    const double length = sqrt(phys_dot(&d, &d));
    const phys_vec u = length > 0 ? d / length : d;
    const double longer = length > 0 ? 1 - s->length / length : 1;
    const double across = length > s->length ? longer : 0;
    for (uint32_t k = 0; k < n; k++)
        if (particle[k].free > 0)
            add_spring_block(visitor->block + flow_root(welds, vertex[k]), fabs(weight[k]) * free,
                             s, &u, across);
}

static void limit_visit_spring(void *to, const struct flow_spring *s)
{
    const uint32_t vertex[2] = {s->a, s->b};
    const double weight[2] = {1, -1};
    visit_weighted(to, s, 2, vertex, weight);
}

/* Adds `times` a pair to the block of one of its corners: N, or as good N', since their sum is
 * symmetric. one, two: the pair in steps of 1 and 2 s, h^2 K + h C each. */
static void integrators_limit_add_pair(struct block *block, double times,
                                       const struct phys_pair *one, const struct phys_pair *two)
{
    phys_vec n[3]; /* of K: n00 n11 n22; n01 n12 n20; n02 n10 n21 */
    for (int k = 0; k < 3; k++)
        n[k] = 0.5 * two->cyclic[k] - one->cyclic[k];
    for (int i = 0; i < 3; i++) {
        block->stiff[i] += times * n[0][i];
        block->stiff[3 + i] += times * 0.5 * (n[1][i] + n[2][(i + 1) % 3]);
        block->damping += times * (one->cyclic[0][i] - n[0][i]);
    }
}

/* The pairs of an element by itself where it starts, in a step of h. */
static void pairs_of_element(const struct element_kind *kind, const struct element_one *one,
                             const phys_vec x[ELEMENT_CORNERS], double h,
                             struct phys_pair pair[ELEMENT_PAIRS])
{
    const struct phys_sight sight = {.n = kind->corners, .x = x};
    const struct phys_step step = {h, 0};
    (kind->stiffest ? kind->stiffest : kind->matrix)(&one->list, 0, 1, &step, &sight, NULL, pair);
}

static void visit_element(void *to, const struct element *element)
{
    struct visitor *visitor = to;
    const struct element_kind *kind = element_kinds[element->kind];
    struct flow_particle particle[ELEMENT_CORNERS];
    struct phys_pair pair[2][ELEMENT_PAIRS];
    struct element_one one;
    phys_vec x[ELEMENT_CORNERS] = {{0}};
    uint32_t at[ELEMENT_CORNERS];
    double times = 0;
    if (!kind->pairs)
        return;
    for (uint32_t i = 0; i < element->corners; i++) {
        at[i] = flow_root(&visitor->source->particles.welds, element->first + element->corner[i]);
        particle_of(visitor, at[i], particle + i);
        x[i] = particle[i].position;
        times += particle[i].free;
    }
    element_alone(&visitor->source->elements, element, visitor->material[element->kind], &one);
    for (int i = 0; i < 2; i++)
        pairs_of_element(kind, &one, x, 1 + i, pair[i]);
    for (uint32_t j = 1, k = 0; j < element->corners; j++)
        for (uint32_t i = 0; i < j; i++, k++) {
            if (particle[i].free > 0)
                integrators_limit_add_pair(visitor->block + at[i], times, pair[0] + k, pair[1] + k);
            if (particle[j].free > 0)
                integrators_limit_add_pair(visitor->block + at[j], times, pair[0] + k, pair[1] + k);
        }
}

/* A soft pin is alike in all directions, and its other end is held. */
static void visit_soft(const struct visitor *visitor, const struct flow_soft *soft)
{
    const struct flow_source *source = visitor->source;
    const double most = model_curve_max(source->model, soft->curve);
    struct block *block = visitor->block + source->blocks.vertex[soft->at];
    for (int i = 0; i < 3; i++)
        block->stiff[i] += most * soft->stiffness;
    block->damping += 3 * most * soft->damping; /* over the trace, which has three stiffnesses */
}

/* Finds the vertex whose block over its mass is largest. */
static void find_fastest(struct visitor *visitor, struct flow_limit *limit)
{
    double best = 0;
    for (uint32_t v = 0; v < visitor->source->particles.n; v++) {
        const struct block *block = visitor->block + v;
        const double trace = block->stiff[0] + block->stiff[1] + block->stiff[2];
        struct flow_particle p;
        if (!(trace > 0))
            continue;
        particle_of(visitor, v, &p);
        if (!(trace / p.mass > best))
            continue; /* no eigenvalue is above the trace */
        const double square = phys_largest(block->stiff) / p.mass;
        if (!(square > best))
            continue;
        best = square;
        *limit = (struct flow_limit){.omega = sqrt(square),
                                     .drag = p.drag / p.mass,
                                     .along = square * block->damping / trace,
                                     .vertex = v - visitor->at.first,
                                     .cloth = visitor->source->model->cloths + visitor->at.cloth};
    }
}

/* Makes the elements' data of materials. */
static void make_materials(struct visitor *visitor, struct cloth_error *error)
{
    const struct model *model = visitor->source->model;
    for (int i = 0; i < ELEMENT_KINDS; i++) {
        const size_t bytes = element_kinds[i]->material_bytes * model->n_materials;
        visitor->material[i] = cloth_take(&visitor->memory, bytes, 1, error);
        if (visitor->material[i])
            element_materials(element_kinds[i], model, visitor->material[i]);
    }
}

int flow_limit_find(const struct flow_source *source, struct flow_limit *limit,
                    struct cloth_error *error)
{
    struct visitor visitor = {.source = source};
    *limit = (struct flow_limit){0};
    visitor.block = cloth_take(&visitor.memory, source->particles.n, sizeof *visitor.block, error);
    make_materials(&visitor, error);
    const int code = visitor.memory.lacks ? CLOTH_E_MEMORY : CLOTH_OK;
    if (!code) {
        flow_springs_each(&source->springs, limit_visit_spring, &visitor);
        for (uint32_t i = 0; i < source->springs.n_timed; i++)
            if (flow_joints_act(source->model, source->springs.timed + i))
                visit_weighted(&visitor, &source->springs.timed[i].spring,
                               source->springs.timed[i].n, source->springs.timed[i].vertex,
                               source->springs.timed[i].weight);
        element_each(&source->elements, visit_element, &visitor);
        const struct flow_soft *soft = source->particles.soft.items;
        for (size_t i = 0; i < source->particles.soft.n; i++)
            visit_soft(&visitor, soft + i);
        find_fastest(&visitor, limit);
    }
    cloth_pool_free(&visitor.memory);
    return code;
}

double flow_limit_of(const struct flow_limit *limit, enum model_integrator integrator)
{
    const struct model_scheme *scheme = model_schemes + integrator;
    const double drag = scheme->drag_free ? 0 : limit->drag;
    return limit->omega > 0 && scheme->limit ? scheme->limit(limit->omega, drag + limit->along)
                                             : INFINITY;
}
