/* Maps of rigid bodies are drawn once, in the body's own axes. Maps of a body with frames are drawn
 * again in each step until its last frame is over. */
#include "cloth/flow/contact/image.h"

#include "cloth/flow/contact/mode.h"

#include <math.h>

static uint32_t most_strips(const struct flow *flow)
{
    const uint32_t n = flow->tables.n_blocks;
    return n < CONTACT_STRIPS ? n : CONTACT_STRIPS;
}

/* height 0: the obstacle has no maps. */
static struct contact_view map_view(const struct flow *flow, uint32_t obstacle)
{
    struct contact_view view = flow->model->obstacles[obstacle].view;
    if (view.height)
        contact_view_cut(&view, most_strips(flow));
    return view;
}

static const struct contact_body *map_body(const struct flow *flow, uint32_t obstacle)
{
    const struct model *model = flow->model;
    return contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
}

/* Bytes of an obstacle's part of a block's strips; 0: it has none there. */
static size_t part_bytes(const struct flow *flow, uint32_t obstacle, uint32_t block)
{
    const struct contact_view view = map_view(flow, obstacle);
    if (!view.height || block >= contact_view_strips(&view))
        return 0;
    const size_t bytes = contact_strip_bytes(map_body(flow, obstacle), &view, block);
    return (bytes + CONTACT_ALIGN - 1) / CONTACT_ALIGN * CONTACT_ALIGN;
}

/* The begin of an obstacle's part; for n_obstacles, the end of the last one. */
static size_t part_at(const struct flow *flow, uint32_t obstacle, uint32_t block)
{
    size_t at = 0;
    for (uint32_t i = 0; i < obstacle; i++)
        at += part_bytes(flow, i, block);
    return at;
}

uint32_t flow_map_strips(const struct flow *flow)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < flow->model->n_obstacles; i++) {
        const struct contact_view view = map_view(flow, i);
        const uint32_t n = view.height ? contact_view_strips(&view) : 0;
        most = n > most ? n : most;
    }
    return most;
}

size_t flow_map_bytes(const struct flow *flow, uint32_t block)
{
    return part_at(flow, flow->model->n_obstacles, block);
}

void flow_map_open(const struct flow *flow, uint32_t obstacle, const duite_param *maps,
                   struct contact_image *image)
{
    const struct contact_view view = map_view(flow, obstacle);
    *image = (struct contact_image){0};
    if (!view.height)
        return;
    image->body = map_body(flow, obstacle);
    image->view = view;
    for (uint32_t strip = 0; strip < contact_view_strips(&view); strip++)
        image->strip[strip] = (const char *)maps[strip].data + part_at(flow, obstacle, strip);
}

/* ---- Drawing ---- */

static bool changes(const struct contact_shape *shape, const struct contact_bodies *bodies,
                    double after)
{
    return shape->view.height &&
           contact_body_moves_after(contact_bodies_at(bodies, shape->body), after);
}

static bool change_after(const struct model *model, double time)
{
    bool change = false;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        change = change || changes(model->obstacles + i, &model->bodies, time);
    return change;
}

/* A block's strip of an obstacle. maps: of the block. */
static void draw_part(const struct flow *flow, uint32_t obstacle, uint32_t block,
                      unsigned char *maps)
{
    const struct contact_view view = map_view(flow, obstacle);
    const struct contact_body *body = map_body(flow, obstacle);
    unsigned char *part = maps + part_at(flow, obstacle, block);
    const size_t bytes = contact_strip_bytes(body, &view, block);
    contact_strip_draw(body, &view, block, part);
    memset(part + bytes, 0, part_bytes(flow, obstacle, block) - bytes);
}

FLOW_KERNEL_WITH(map_draw, FLOW_COLLIDE, struct flow_block_args, (W(maps)), .replicated = 1)
{
    const struct flow *flow = flow_of(call);
    for (uint32_t i = 0; i < flow->model->n_obstacles; i++)
        if (part_bytes(flow, i, on->args->block))
            draw_part(flow, i, on->args->block, on->maps);
    return 0;
}

/* Redraws only bodies that change their shape. */
FLOW_KERNEL_WITH(map_draw_again, FLOW_COLLIDE, struct flow_block_args, (RW(maps)), .replicated = 1)
{
    const struct flow *flow = flow_of(call);
    const struct model *model = flow->model;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        if (part_bytes(flow, i, on->args->block) &&
            changes(model->obstacles + i, &model->bodies, -INFINITY))
            draw_part(flow, i, on->args->block, on->maps);
    return 0;
}

/* Draws the maps, if bodies have changed. from: s, the begin of the step that ends now. */
static int draw_maps(struct flow_state *state, double from)
{
    struct flow_maps_now *now = &state->maps;
    struct flow_block_args args;
    int code = DUITE_OK;
    if (now->drawn && !change_after(state->flow->model, now->from))
        return DUITE_OK;
    const struct flow_kernel *kernel =
        now->drawn ? &flow_kernel_map_draw_again : &flow_kernel_map_draw;
    *now = (struct flow_maps_now){true, from};
    for (args.block = 0; args.block < flow_map_strips(state->flow) && !code; args.block++)
        code = flow_fork_one(state, kernel, &args);
    return code;
}

static int settle_image(struct flow_state *state)
{
    const int code = draw_maps(state, flow_project_move(state));
    return code ? code : flow_project(state);
}

const struct flow_contact_mode flow_contact_image = {.is = model_has_maps, .settle = settle_image};
