/* Joints are springs between vertices of any cloths, as the scene names them. Joints that act in
 * all steps come after the springs of all cloths, in the scene's order. Timed joints, and those
 * that end on edges, are ties (cloth/flow/joints/ties.h). */
#include "cloth/flow/run/grid.h"
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"

#include <math.h>

/* Stands for a length of 0: a spring whose ends are at one place is then longer than at rest, too,
 * and stretches in all directions alike. Beside every other length it is as 0. */
static const double NO_LENGTH = -1e-300;

int flow_joints_use(struct flow_particles *particles, const struct model *model,
                    struct cloth_error *error)
{
    struct cloth_list *list = &particles->joints;
    unsigned char *used = particles->used;
    int code = CLOTH_OK;
    for (uint32_t j = 0; j < model->n_joints && !code; j++)
        code = flow_pairs_list(list, model, &model->joints[j].pairs, "a joint", error);
    const struct flow_pair *pair = list->items;
    for (size_t i = 0; i < list->n && !code; i++) {
        used[pair[i].vertex[0]] = used[pair[i].vertex[1]] = 1;
        if (pair[i].second != UINT32_MAX)
            used[pair[i].second] = 1;
    }
    return code;
}

/* Finds the vertices of a pair and their weights; the lower one of two comes first. In this order
 * the weights sum to 0 without rounding. Returns how many. */
static uint32_t joints_weigh(const struct flow_pair *pair, uint32_t vertex[3], double weight[3])
{
    const uint32_t a = pair->vertex[0], b = pair->vertex[1];
    const bool edge = pair->second != UINT32_MAX, swap = !edge && b < a;
    const double near = edge ? 1 - pair->at : 1;
    vertex[0] = swap ? b : a;
    vertex[1] = swap ? a : b;
    vertex[2] = pair->second;
    weight[0] = 1;
    weight[1] = -near;
    weight[2] = -(1 - near);
    return edge ? 3 : 2;
}

static double distance_of(const struct flow_particles *particles, const struct model *model,
                          const struct flow_pair *pair)
{
    uint32_t vertex[3];
    double weight[3];
    phys_vec d = {0};
    const uint32_t n = joints_weigh(pair, vertex, weight);
    for (uint32_t i = 0; i < n; i++) {
        struct flow_cloths cloth = {0};
        struct flow_particle at;
        flow_particle_at(particles, model, &cloth, vertex[i], &at);
        d += weight[i] * at.position;
    }
    return sqrt(phys_dot(&d, &d));
}

static int make_joint(struct flow_spring *spring, const struct flow_particles *particles,
                      const struct model *model, const struct model_joint *joint,
                      const struct flow_pair *pair, struct cloth_error *error)
{
    const struct flow_welds *welds = &particles->welds;
    const uint32_t a = pair->vertex[0], b = pair->vertex[1];
    const double length = joint->length < 0 ? distance_of(particles, model, pair) : joint->length;
    if (flow_root(welds, a) == flow_root(welds, b) ||
        (pair->second != UINT32_MAX && flow_root(welds, a) == flow_root(welds, pair->second)))
        return flow_pair_fail(model, pair, "a joint", "which welds make one", error);
    if (joint->pairs.seam && !particles->free[a] && !particles->free[b])
        return flow_pair_fail(model, pair, "a joint",
                              "both of which pins hold: nothing can bring them together", error);
    *spring = (struct flow_spring){.a = a < b ? a : b,
                                   .b = a < b ? b : a,
                                   .stiffness = joint->stiffness,
                                   .damping = joint->damping,
                                   .length = length > 0 ? length : NO_LENGTH,
                                   .size = {.curve = {joint->size, 0}, .along = 1}};
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
    timed->n = joints_weigh(pair, timed->vertex, timed->weight);
    return make_joint(&timed->spring, particles, springs->model, joint, pair, error);
}

/* seam: as of the spring. */
static int joints_make_one(struct flow_springs *springs, const struct flow_particles *particles,
                           const struct model_joint *joint, uint32_t seam,
                           const struct flow_pair *pair, struct cloth_error *error)
{
    if (model_is_tied(joint))
        return make_timed(springs, particles, joint, pair, error);
    struct flow_spring *spring = springs->joint + springs->n_joints++;
    const int code = make_joint(spring, particles, springs->model, joint, pair, error);
    spring->seam = joint->pairs.seam ? seam : 0;
    return code;
}

int flow_joints_make(struct flow_springs *springs, struct flow_particles *particles,
                     struct cloth_error *error)
{
    const struct model *model = springs->model;
    struct cloth_list *list = &particles->joints;
    struct flow_pair *pair = list->items;
    int code = CLOTH_OK;
    if (!model->n_joints)
        return CLOTH_OK;
    springs->joint = cloth_take(&springs->memory, list->n, sizeof *springs->joint, error);
    springs->timed = cloth_take(&springs->memory, list->n, sizeof *springs->timed, error);
    if (springs->memory.lacks)
        return CLOTH_E_MEMORY;
    for (uint32_t j = 0, k = 0, seam = 0; j < model->n_joints; j++) {
        seam += model->joints[j].pairs.seam != 0;
        for (uint32_t i = 0; i < model->joints[j].pairs.end[0].n && !code; i++, k++) {
            code = joints_make_one(springs, particles, model->joints + j, seam, pair + k, error);
            if (!model_is_tied(model->joints + j)) /* of tied ones two may have several */
                pair[springs->n_joints - 1] = pair[k];
        }
    }
    list->n = springs->n_joints;
    for (size_t i = 0; i < list->n; i++) /* whichever names stand for them, vertices are the same */
        for (int end = 0; end < 2; end++)
            pair[i].vertex[end] = flow_root(&particles->welds, pair[i].vertex[end]);
    return code ? code : flow_pairs_once(list, model, "a joint", error);
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
    struct flow_tie tie = {.at.n = timed->n,
                           .stiffness = timed->spring.stiffness,
                           .damping = timed->spring.damping,
                           .length = timed->spring.length,
                           .begin = timed->begin,
                           .end = timed->end};
    for (uint32_t k = 0; k < timed->n; k++) {
        const uint32_t place = blocks->place[timed->vertex[k]];
        tie.at.weight[k] = timed->weight[k];
        tie.at.block[k] = flow_source_block(blocks, place, 0);
        tie.at.row[k] = place - blocks->start[tie.at.block[k]];
        const uint32_t root = flow_root(&particles->welds, timed->vertex[k]);
        if (!particles->free[root])
            tie.at.held |= (unsigned char)(1 << k);
        tie.piece[k] = particles->piece ? particles->piece[root] : 0;
    }
    return tie;
}
