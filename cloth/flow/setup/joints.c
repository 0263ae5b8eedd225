/* Joints are springs between vertices of any cloths, as the scene names them. They come after the
 * springs of all cloths, in the scene's order. */
#include "cloth/flow/setup/source.h"

#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Stored for a length of 0: at one place, too, the spring is then longer than at rest, and
 * stretches in all directions alike. To every other length it is as 0. */
static const double NO_LENGTH = -1e-300;

int flow_joints_use(const struct model *model, unsigned char *used, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t j = 0; j < model->n_joints && !code; j++) {
        struct cloth_list list = {0};
        code = flow_pairs_list(&list, model, &model->joints[j].pairs, "a joint", error);
        const struct flow_pair *pair = list.items;
        for (size_t i = 0; i < list.n && !code; i++)
            used[pair[i].vertex[0]] = used[pair[i].vertex[1]] = 1;
        free(list.items);
    }
    return code;
}

static double distance_of(const struct flow_particles *particles, const struct model *model,
                          const struct flow_pair *pair)
{
    struct flow_particle at[2];
    for (int end = 0; end < 2; end++) {
        struct flow_cloths cloth = {0};
        flow_source_cloth(&cloth, model, pair->vertex[end]);
        flow_particle_of(particles, model, model->cloths + cloth.cloth, cloth.first,
                         pair->vertex[end], at + end);
    }
    const phys_vec d = at[1].position - at[0].position;
    return sqrt(phys_dot(&d, &d));
}

static int make_joint(struct flow_spring *spring, const struct flow_particles *particles,
                      const struct model *model, const struct model_joint *joint,
                      const struct flow_pair *pair, struct cloth_error *error)
{
    const uint32_t a = pair->vertex[0], b = pair->vertex[1];
    const double length = joint->length < 0 ? distance_of(particles, model, pair) : joint->length;
    if (flow_root(&particles->welds, a) == flow_root(&particles->welds, b))
        return flow_pair_fail(model, pair, "a joint", "which welds make one", error);
    *spring = (struct flow_spring){.a = a < b ? a : b,
                                   .b = a < b ? b : a,
                                   .stiffness = joint->stiffness,
                                   .damping = joint->damping,
                                   .length = length > 0 ? length : NO_LENGTH};
    return CLOTH_OK;
}

static int make_all(struct flow_springs *springs, const struct flow_particles *particles,
                    struct cloth_list *list, struct cloth_error *error)
{
    const struct model *model = springs->model;
    int code = CLOTH_OK;
    for (uint32_t j = 0; j < model->n_joints && !code; j++)
        code = flow_pairs_list(list, model, &model->joints[j].pairs, "a joint", error);
    if (code)
        return code;
    springs->joint = cloth_alloc(list->n, sizeof *springs->joint, error);
    if (!springs->joint)
        return CLOTH_E_MEMORY;
    struct flow_pair *pair = list->items;
    for (uint32_t j = 0, k = 0; j < model->n_joints; j++)
        for (uint32_t i = 0; i < model->joints[j].pairs.end[0].n && !code; i++, k++)
            code = make_joint(springs->joint + k, particles, model, model->joints + j, pair + k,
                              error);
    for (size_t i = 0; i < list->n; i++) /* whichever names stand for them, vertices are the same */
        for (int end = 0; end < 2; end++)
            pair[i].vertex[end] = flow_root(&particles->welds, pair[i].vertex[end]);
    springs->n_joints = (uint32_t)list->n;
    return code ? code : flow_pairs_once(list, model, "a joint", error);
}

int flow_joints_make(struct flow_springs *springs, const struct flow_particles *particles,
                     struct cloth_error *error)
{
    struct cloth_list list = {0};
    if (!springs->model->n_joints)
        return CLOTH_OK;
    const int code = make_all(springs, particles, &list, error);
    free(list.items);
    return code;
}
