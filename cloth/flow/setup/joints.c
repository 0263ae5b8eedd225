/* Joints are springs between vertices of any cloths, as the scene names them. They come after the
 * springs of all cloths, in the scene's order. */
#include "cloth/flow/setup/source.h"

#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Stored for a length of 0: at one place, too, the spring is then longer than at rest, and
 * stretches in all directions alike. To every other length it is as 0. */
static const double NO_LENGTH = -1e-300;

static uint32_t first_of(const struct model *model, uint32_t cloth)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < cloth; c++)
        first += model->cloths[c].mesh.n_vertices;
    return first;
}

int flow_pairs_check(const struct model *model, const struct model_pairs *pairs, const char *what,
                     struct cloth_error *error)
{
    for (int end = 0; end < 2; end++) {
        const struct model_cloth *cloth = model->cloths + pairs->end[end].cloth;
        for (uint32_t i = 0; i < pairs->end[0].n; i++)
            if (pairs->end[end].vertices[i] >= cloth->mesh.n_vertices)
                return flow_no_vertex(cloth, what, pairs->end[end].vertices[i], pairs->place,
                                      error);
    }
    return CLOTH_OK;
}

int flow_joints_use(const struct model *model, unsigned char *used, struct cloth_error *error)
{
    for (uint32_t j = 0; j < model->n_joints; j++) {
        const struct model_pairs *pairs = &model->joints[j].pairs;
        const int code = flow_pairs_check(model, pairs, "a joint", error);
        if (code)
            return code;
        for (int end = 0; end < 2; end++)
            for (uint32_t i = 0, first = first_of(model, pairs->end[end].cloth);
                 i < pairs->end[0].n; i++)
                used[first + pairs->end[end].vertices[i]] = 1;
    }
    return CLOTH_OK;
}

/* ---- Making ---- */

static double distance_of(const struct flow_particles *particles, const struct model *model,
                          const struct model_pairs *pairs, const uint32_t end[2])
{
    struct flow_particle at[2];
    for (int k = 0; k < 2; k++)
        flow_particle_of(particles, model, model->cloths + pairs->end[k].cloth,
                         first_of(model, pairs->end[k].cloth), end[k], at + k);
    const phys_vec d = at[1].position - at[0].position;
    return sqrt(phys_dot(&d, &d));
}

static int make_pair(struct flow_spring *spring, const struct flow_particles *particles,
                     const struct model *model, const struct model_joint *joint, uint32_t i,
                     struct cloth_error *error)
{
    const struct model_pairs *pairs = &joint->pairs;
    uint32_t end[2];
    for (int k = 0; k < 2; k++)
        end[k] = first_of(model, pairs->end[k].cloth) + pairs->end[k].vertices[i];
    if (end[0] == end[1])
        return model_fail(pairs->place, error,
                          "a joint is between vertex %u of cloth '%.60s' and itself; two vertices "
                          "are expected",
                          pairs->end[0].vertices[i], model->cloths[pairs->end[0].cloth].name);
    const double length =
        joint->length < 0 ? distance_of(particles, model, pairs, end) : joint->length;
    *spring = (struct flow_spring){.a = end[0] < end[1] ? end[0] : end[1],
                                   .b = end[0] < end[1] ? end[1] : end[0],
                                   .stiffness = joint->stiffness,
                                   .damping = joint->damping,
                                   .length = length > 0 ? length : NO_LENGTH};
    return CLOTH_OK;
}

/* A joint as one of all, to find the second one between the same vertices. */
struct named {
    uint32_t a, b, joint, pair;
};

static int compare(const void *va, const void *vb)
{
    const struct named *a = va, *b = vb;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    if (a->b != b->b)
        return a->b < b->b ? -1 : 1;
    if (a->joint != b->joint)
        return a->joint < b->joint ? -1 : 1;
    return (a->pair > b->pair) - (a->pair < b->pair);
}

static int check_once(const struct model *model, const struct flow_spring *spring, uint32_t n,
                      struct cloth_error *error)
{
    struct named *all = cloth_alloc(n, sizeof *all, error);
    if (!all)
        return CLOTH_E_MEMORY;
    for (uint32_t j = 0, k = 0; j < model->n_joints; j++)
        for (uint32_t i = 0; i < model->joints[j].pairs.end[0].n; i++, k++)
            all[k] = (struct named){spring[k].a, spring[k].b, j, i};
    qsort(all, n, sizeof *all, compare);
    int code = CLOTH_OK;
    for (uint32_t k = 1; k < n && !code; k++) {
        if (all[k].a != all[k - 1].a || all[k].b != all[k - 1].b)
            continue;
        const struct model_pairs *pairs = &model->joints[all[k].joint].pairs;
        code = model_fail(
            pairs->place, error,
            "a second joint is between vertex %u of cloth '%.60s' and vertex %u of "
            "cloth '%.60s'; one is expected, with the sum of stiffness and damping",
            pairs->end[0].vertices[all[k].pair], model->cloths[pairs->end[0].cloth].name,
            pairs->end[1].vertices[all[k].pair], model->cloths[pairs->end[1].cloth].name);
    }
    free(all);
    return code;
}

int flow_joints_make(struct flow_springs *springs, const struct flow_particles *particles,
                     struct cloth_error *error)
{
    const struct model *model = springs->model;
    size_t n = 0;
    for (uint32_t j = 0; j < model->n_joints; j++)
        n += model->joints[j].pairs.end[0].n;
    if (n > UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT, "%zu joints are too many; at most %u are possible",
                          n, UINT32_MAX);
    if (!n)
        return CLOTH_OK;
    springs->joint = cloth_alloc(n, sizeof *springs->joint, error);
    if (!springs->joint)
        return CLOTH_E_MEMORY;
    int code = CLOTH_OK;
    for (uint32_t j = 0; j < model->n_joints; j++)
        for (uint32_t i = 0; i < model->joints[j].pairs.end[0].n && !code; i++)
            code = make_pair(springs->joint + springs->n_joints++, particles, model,
                             model->joints + j, i, error);
    return code ? code : check_once(model, springs->joint, springs->n_joints, error);
}
