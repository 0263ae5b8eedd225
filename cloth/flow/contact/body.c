/* Every rank makes the same bytes of the bodies that all have, so bodies are never sent. Points and
 * boxes of bodies that stand still are made once. */
#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/mode.h"

#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

static const struct contact_body *contact_body_of(const struct model *model, uint32_t obstacle)
{
    return contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
}

/* ---- Places in the fields ---- */

static size_t contact_body_whole_lines(size_t bytes)
{
    return (bytes + CONTACT_ALIGN - 1) / CONTACT_ALIGN * CONTACT_ALIGN;
}

struct flow_body_place flow_body_place(const struct model *model, uint32_t obstacle)
{
    struct flow_body_place place = {0};
    for (uint32_t i = 0; i < obstacle; i++) {
        const struct contact_body *body = contact_body_of(model, i);
        if (!body)
            continue;
        place.skin += contact_body_whole_lines(contact_body_skin_bytes(body));
        place.vertex += body->n_vertices;
        place.point += 2 * (size_t)body->n_vertices;
        place.boxes += contact_body_whole_lines(contact_body_boxes_bytes(body));
    }
    return place;
}

bool flow_bodies_are_met(const struct model *model)
{
    bool are = false;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        are = are || model->obstacles[i].body;
    return are && flow_contact_mode(model)->sweeps;
}

bool flow_bodies_move(const struct model *model)
{
    bool move = false;
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        const struct contact_body *body = contact_body_of(model, i);
        move = move || (body && (model->obstacles[i].n || body->n_frames));
    }
    return move;
}

void flow_body_open(const struct model *model, uint32_t obstacle, const unsigned char *skins,
                    const phys_vec *points, const unsigned char *boxes, struct contact_skin *skin,
                    struct contact_side *side)
{
    const struct flow_body_place place = flow_body_place(model, obstacle);
    *skin = contact_skin_open(skins + place.skin);
    *side = (struct contact_side){.skin = skin,
                                  .boxes = boxes + place.boxes,
                                  .x = points + place.point,
                                  .y = points + place.point + skin->n_points};
}

/* ---- Skins ---- */

/* Makes ids behind those of the cloth, so that none is also a vertex of it. */
FLOW_KERNEL_WITH(body_skin, FLOW_COLLIDE, struct flow_block_args, (W(body_skins), W(body_fans)),
                 .replicated = 1)
{
    const struct flow *flow = flow_of(call);
    const struct model *model = flow->model;
    struct cloth_error error = {0};
    memset(on->body_skins, 0, flow_body_place(model, model->n_obstacles).skin);
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        const struct contact_body *body = contact_body_of(model, i);
        const struct flow_body_place place = flow_body_place(model, i);
        if (!body)
            continue;
        contact_body_fans(body, on->body_fans + place.vertex);
        if (contact_body_skin_make(body, flow->n_vertices, on->body_skins + place.skin, &error))
            return duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, error.text);
    }
    return 0;
}

int flow_bodies_make(struct flow_state *state)
{
    const struct flow_block_args args = {0};
    if (!flow_bodies_are_met(state->flow->model))
        return DUITE_OK;
    state->contact.bodies.made = false;
    return flow_fork_one(state, &flow_kernel_body_skin, &args);
}

/* ---- A step ---- */

struct follow_args {
    uint32_t block;
    double from, to; /* s: of the step */
};

FLOW_KERNEL_WITH(body_refit, FLOW_COLLIDE, struct follow_args,
                 (R(body_skins), W(body_points), W(body_boxes)), .replicated = 1)
{
    const struct model *model = flow_of(call)->model;
    memset(on->body_boxes, 0, flow_body_place(model, model->n_obstacles).boxes);
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        const struct contact_body *body = contact_body_of(model, i);
        const struct flow_body_place place = flow_body_place(model, i);
        struct contact_pose pose;
        phys_vec way;
        if (!body)
            continue;
        const struct contact_skin skin = contact_skin_open(on->body_skins + place.skin);
        phys_vec *x = on->body_points + place.point, *y = x + skin.n_points;
        contact_pose_over(model->obstacles + i, model->keys, &model->bodies, on->args->from,
                          on->args->to, &pose);
        contact_body_ends(body, &pose, x, y, &way);
        contact_refit(&skin, x, y, &way, on->body_boxes + place.boxes);
    }
    return 0;
}

int flow_bodies_follow(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_attempt *attempt = &state->attempt;
    struct flow_bodies_now *now = &state->contact.bodies;
    const bool same = now->begin == attempt->begin && now->length == attempt->length;
    const struct flow_step_args step = flow_attempt_args(state);
    const struct follow_args args = {.from = step.time - step.h, .to = step.time};
    if (!flow_bodies_are_met(model) || (now->made && (same || !flow_bodies_move(model))))
        return DUITE_OK;
    *now = (struct flow_bodies_now){true, attempt->begin, attempt->length};
    return flow_fork_one(state, &flow_kernel_body_refit, &args);
}

/* ---- A contact in the next step ---- */

/* The body carries its corners, and so its point, straight through the step. */
void flow_body_ahead(const struct flow *flow, double from, double to,
                     const struct flow_contact *contact, struct contact_row *row)
{
    const struct model *model = flow->model;
    const struct contact_shape *shape =
        model->obstacles + (contact->side[1] - flow->tables.n_blocks);
    struct contact_pose pose;
    phys_vec carried = {0};
    contact_pose_over(shape, model->keys, &model->bodies, from, to, &pose);
    for (uint32_t k = contact->at.n; k < SOLVE_TIE_CORNERS; k++) {
        phys_vec x, y;
        contact_body_vertex_ends(pose.body, &pose, contact->point[k], &x, &y);
        carried -= contact->at.weight[k] * (y - x);
    }
    row->gap -= phys_dot(&row->normal, &carried);
    row->slip -= carried;
}
