/* Joints are springs between vertices of any cloths, as the scene names them. Those that are there
 * in all steps come after the springs of all cloths, in the scene's order; those that come or go
 * are ties (cloth/flow/state/ties.h). */
#include "cloth/flow/setup/source.h"
#include "cloth/flow/step/grid.h"

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
    if (joint->pairs.seam && !particles->free[a] && !particles->free[b])
        return flow_pair_fail(model, pair, "a joint",
                              "both of which pins hold: nothing can bring them together", error);
    *spring = (struct flow_spring){.a = a < b ? a : b,
                                   .b = a < b ? b : a,
                                   .stiffness = joint->stiffness,
                                   .damping = joint->damping,
                                   .length = length > 0 ? length : NO_LENGTH};
    return CLOTH_OK;
}

/* The tick that is nearest to a time, s. */
static uint64_t tick_of(const struct model *model, double time)
{
    const double tick = round(time / model->h * FLOW_TICKS);
    return tick < 0x1p62 ? (uint64_t)tick : UINT64_C(1) << 62;
}

static int make_timed(struct flow_springs *springs, const struct flow_particles *particles,
                      const struct model_joint *joint, const struct flow_pair *pair,
                      struct cloth_error *error)
{
    struct flow_timed *timed = springs->timed + springs->n_timed++;
    timed->begin = tick_of(springs->model, joint->begin);
    timed->end = joint->end > 0 ? tick_of(springs->model, joint->end) : UINT64_MAX;
    return make_joint(&timed->spring, particles, springs->model, joint, pair, error);
}

/* seam: as of the spring. */
static int make_one(struct flow_springs *springs, const struct flow_particles *particles,
                    const struct model_joint *joint, uint32_t seam, const struct flow_pair *pair,
                    struct cloth_error *error)
{
    if (model_is_timed(joint))
        return make_timed(springs, particles, joint, pair, error);
    struct flow_spring *spring = springs->joint + springs->n_joints++;
    const int code = make_joint(spring, particles, springs->model, joint, pair, error);
    spring->seam = joint->pairs.seam ? seam : 0;
    return code;
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
    springs->timed = cloth_alloc(list->n, sizeof *springs->timed, error);
    if (!springs->joint || !springs->timed)
        return CLOTH_E_MEMORY;
    struct flow_pair *pair = list->items;
    for (uint32_t j = 0, k = 0, seam = 0; j < model->n_joints; j++) {
        seam += model->joints[j].pairs.seam != 0;
        for (uint32_t i = 0; i < model->joints[j].pairs.end[0].n && !code; i++, k++) {
            code = make_one(springs, particles, model->joints + j, seam, pair + k, error);
            if (!model_is_timed(model->joints + j)) /* of timed ones two may have several */
                pair[springs->n_joints - 1] = pair[k];
        }
    }
    list->n = springs->n_joints;
    for (size_t i = 0; i < list->n; i++) /* whichever names stand for them, vertices are the same */
        for (int end = 0; end < 2; end++)
            pair[i].vertex[end] = flow_root(&particles->welds, pair[i].vertex[end]);
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

bool flow_joints_act(const struct model *model, const struct flow_timed *timed)
{
    const uint64_t first = (timed->begin + FLOW_TICKS - 1) / FLOW_TICKS * FLOW_TICKS;
    return first < timed->end && first < tick_of(model, model->end);
}

struct flow_tie flow_joints_tie(const struct flow_source *source, const struct flow_timed *timed)
{
    const struct mesh_blocks *blocks = &source->blocks;
    const struct flow_particles *particles = &source->particles;
    const struct flow_spring *spring = &timed->spring;
    const uint32_t vertex[2] = {spring->a, spring->b};
    struct flow_tie tie = {.at = {.n = 2, .weight = {1, -1}},
                           .stiffness = spring->stiffness,
                           .damping = spring->damping,
                           .length = spring->length,
                           .begin = timed->begin,
                           .end = timed->end};
    for (int end = 0; end < 2; end++) {
        const uint32_t place = blocks->place[vertex[end]];
        tie.at.block[end] = flow_source_block(blocks, place, 0);
        tie.at.row[end] = place - blocks->start[tie.at.block[end]];
        const uint32_t root = flow_root(&particles->welds, vertex[end]);
        if (!particles->free[root])
            tie.at.held |= (unsigned char)(1 << end);
        tie.piece[end] = particles->piece ? particles->piece[root] : 0;
    }
    return tie;
}
