/* The fastest vibration of a model where it starts. For one spring between a and b, |u.(xa - xb)|^2
 * <= 2 |u.xa|^2 + 2 |u.xb|^2; so K is at most the sum over all vertices of twice the 3 x 3 blocks
 * that springs put on their diagonal (once, for a spring to a held end), and the largest eigenvalue
 * of M^-1 K is at most the largest of these blocks over their masses. That is Gershgorin's bound by
 * blocks, but for 2 |Kaa| in place of |Kaa| + sum of |Kab|, which does not feel that springs have
 * directions. A chain of equal springs and masses reaches it as it gets longer. Of an element with
 * n corners that are free, K is at most n times its blocks on the diagonal, likewise. */
#include "cloth/flow/setup/source.h"

#include "cloth/base/memory.h"
#include "cloth/physics/limit.h"

#include <math.h>
#include <stdlib.h>

/* Of a vertex: twice its block, xx yy zz xy yz zx, N/m; and twice the damping of its springs. */
struct block {
    double stiff[6], damping;
};

struct visitor {
    const struct flow_source *source;
    struct flow_cloths at;
    struct block *block;
};

static void particle_of(struct visitor *visitor, uint32_t vertex, struct flow_particle *particle)
{
    const struct model *model = visitor->source->model;
    flow_source_cloth(&visitor->at, model, vertex);
    flow_particle_of(&visitor->source->particles, model, model->cloths + visitor->at.cloth,
                     visitor->at.first, vertex, particle);
}

static void add(struct block *block, double times, const struct flow_spring *s, const phys_vec *u,
                double across)
{
    static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    for (int i = 0; i < 6; i++)
        block->stiff[i] += times * s->stiffness *
                           ((1 - across) * (*u)[row[i]] * (*u)[column[i]] + (i < 3 ? across : 0));
    block->damping += times * s->damping;
}

static void visit(void *to, const struct flow_spring *s)
{
    struct visitor *visitor = to;
    struct flow_particle a, b;
    particle_of(visitor, s->a, &a);
    particle_of(visitor, s->b, &b);
    const phys_vec d = b.position - a.position;
    const double length = sqrt(phys_dot(&d, &d));
    const phys_vec u = length > 0 ? d / length : d;
    const double across = length > s->length ? 1 - s->length / length : 0;
    if (a.free > 0)
        add(visitor->block + s->a, 1 + b.free, s, &u, across);
    if (b.free > 0)
        add(visitor->block + s->b, 1 + a.free, s, &u, across);
}

/* The pairs of an element by itself, in a step of 1 s without damping: of K at the start. Returns
 * whether it has any stiffness. */
static bool pairs_of(const struct flow_source *source, const struct flow_element *element,
                     const phys_vec x[4], const struct flow_rest_of *rest,
                     struct phys_pair pair[PHYS_BEND_PAIRS])
{
    const uint32_t corner[1][4] = {{0, 1, 2, element->kind == FLOW_TRIANGLES ? 0 : 3}};
    const struct model_material *m = source->model->materials + rest->material;
    const struct phys_sight sight = {.n = 4, .x = x};
    const struct phys_step step = {1, 0};
    const double none = 0;
    struct phys_membrane membrane;
    const phys_vec vector =
        element->kind == FLOW_TRIANGLES
            ? (phys_vec){rest->gradient[0], rest->gradient[1], rest->gradient[2], rest->gradient[3]}
            : (phys_vec){rest->weight[0], rest->weight[1], rest->weight[2], rest->weight[3]};
    if (element->kind == FLOW_TRIANGLES &&
        !phys_membrane_make(m->stretch, model_weft(m), m->shear, m->poisson, 0, &membrane)) {
        const struct phys_triangles one = {1, corner, &vector, &rest->area, &membrane};
        phys_triangles_matrix(&one, 0, 1, &step, &sight, NULL, pair);
    } else if (element->kind == FLOW_HINGES) {
        const struct phys_hinges one = {1, corner, &rest->stiffness, &none, &rest->s};
        phys_hinges_matrix(&one, 0, 1, &step, &sight, NULL, pair);
    } else {
        const struct phys_folds one = {1, corner, &vector};
        phys_folds_matrix(&one, 0, 1, 1, pair);
    }
    return element->kind != FLOW_HINGES || rest->stiffness > 0;
}

/* Adds `times` a pair to the block of one of its corners: N, or as good N', since their sum is
 * symmetric. */
static void add_pair(struct block *block, double times, double damping,
                     const struct phys_pair *pair)
{
    const phys_vec *n = pair->cyclic; /* n01 n12 n20; n02 n10 n21 */
    for (int i = 0; i < 3; i++) {
        block->stiff[i] += times * n[0][i];
        block->stiff[3 + i] += times * 0.5 * (n[1][i] + n[2][(i + 1) % 3]);
        block->damping += times * damping * n[0][i];
    }
}

static void visit_element(void *to, const struct flow_element *element)
{
    struct visitor *visitor = to;
    struct flow_particle particle[4];
    struct phys_pair pair[PHYS_BEND_PAIRS];
    phys_vec x[4] = {{0}};
    double times = 0;
    if (element->kind == FLOW_SAILS)
        return;
    for (uint32_t i = 0; i < element->corners; i++) {
        particle_of(visitor, element->corner[i], particle + i);
        x[i] = particle[i].position;
        times += particle[i].free;
    }
    struct flow_rest_of rest;
    flow_element_rest(&visitor->source->elements, element, &rest);
    if (!pairs_of(visitor->source, element, x, &rest, pair))
        return;
    const struct model_material *material = visitor->source->model->materials + rest.material;
    const double damping = element->kind == FLOW_TRIANGLES ? material->damping_stiffness
                                                           : model_damping_bending(material);
    for (uint32_t j = 1, k = 0; j < element->corners; j++)
        for (uint32_t i = 0; i < j; i++, k++) {
            if (particle[i].free > 0)
                add_pair(visitor->block + element->corner[i], times, damping, pair + k);
            if (particle[j].free > 0)
                add_pair(visitor->block + element->corner[j], times, damping, pair + k);
        }
}

/* The vertex whose block over its mass is largest. */
static void find(struct visitor *visitor, struct flow_limit *limit)
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

int flow_limit_find(const struct flow_source *source, struct flow_limit *limit,
                    struct cloth_error *error)
{
    struct visitor visitor = {.source = source};
    *limit = (struct flow_limit){0};
    visitor.block = cloth_alloc(source->particles.n, sizeof *visitor.block, error);
    if (!visitor.block)
        return CLOTH_E_MEMORY;
    flow_springs_each(&source->springs, visit, &visitor);
    flow_elements_each(&source->elements, visit_element, &visitor);
    find(&visitor, limit);
    free(visitor.block);
    return CLOTH_OK;
}

double flow_limit_of(const struct flow_limit *limit, enum model_integrator integrator)
{
    if (!(limit->omega > 0) || integrator >= MODEL_IMPLICIT_EULER)
        return INFINITY;
    switch (integrator) {
    case MODEL_EXPLICIT_EULER:
        return phys_limit_euler(limit->omega, limit->drag + limit->along);
    case MODEL_SYMPLECTIC_EULER:
        return phys_limit_symplectic(limit->omega, limit->drag + limit->along);
    case MODEL_VERLET:
        return phys_limit_verlet(limit->omega, limit->along);
    default:
        return phys_limit_rk4(limit->omega, limit->drag + limit->along);
    }
}
