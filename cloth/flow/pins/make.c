/* Pins become the vertices that they hold, move, leave to a slider, or pull. A vertex is held one
 * way only, by whatever number of pins; those that pull it add up. */
#include "cloth/flow/run/source.h"

#include <stdlib.h>

/* True if two sliders, by number, hold alike; both may be none. */
static bool alike(const struct model_slider *sliders, uint32_t a, uint32_t b)
{
    if (a == b || !a || !b)
        return a == b;
    const struct model_slider *one = sliders + a - 1, *other = sliders + b - 1;
    bool same = one->kind == other->kind && one->motion == other->motion;
    for (int i = 0; i < 3; i++)
        same = same && one->direction[i] - other->direction[i] == 0;
    return same;
}

static void note_unused(struct flow_particles *p, const struct model_pin *pin,
                        const struct flow_picking *picking, uint32_t vertex)
{
    if (!p->used[flow_root(&p->welds, vertex)])
        flow_unusual_note(&p->pinned, picking->cloth, vertex - picking->first, pin->pick.place);
}

/* Returns false if another pin moves the vertex, of all cloths, in another way, or holds it. */
static bool hold(struct flow_particles *p, const struct model *model, const struct model_pin *pin,
                 const struct flow_picking *picking, uint32_t vertex)
{
    const uint32_t v = flow_root(&p->welds, vertex);
    const uint32_t sliding = p->slider ? p->slider[v] : 0;
    const bool held = p->free[v] == 0 || sliding;
    if (!held)
        note_unused(p, pin, picking, vertex);
    const bool torn = held && ((p->motion && p->motion[v] != pin->motion) ||
                               !alike(model->sliders, sliding, pin->slider));
    if (p->motion)
        p->motion[v] = pin->motion;
    if (p->slider)
        p->slider[v] = pin->slider;
    p->free[v] = pin->slider ? 1 : 0;
    return !torn;
}

/* Adds a soft pin of each vertex that was picked. */
static int soften(struct flow_particles *p, const struct model_pin *pin,
                  const struct flow_picking *picking, struct cloth_error *error)
{
    const uint32_t *vertex = picking->list.items;
    int code = CLOTH_OK;
    for (size_t k = 0; k < picking->list.n && !code; k++) {
        const double weight = pin->weight ? pin->weight[k] : 1;
        const struct flow_soft soft = {.at = flow_root(&p->welds, vertex[k]),
                                       .number = (uint32_t)p->soft.n,
                                       .motion = pin->motion,
                                       .curve = pin->curve,
                                       .stiffness = weight * pin->stiffness,
                                       .damping = weight * pin->damping};
        note_unused(p, pin, picking, vertex[k]);
        code = cloth_list_put(&p->soft, &soft, sizeof soft, error);
    }
    return code;
}

/* Holds each vertex that was picked. */
static int harden(struct flow_particles *p, const struct model *model, const struct model_pin *pin,
                  const struct flow_picking *picking, struct cloth_error *error)
{
    const uint32_t *vertex = picking->list.items;
    uint32_t torn = UINT32_MAX;
    for (size_t k = 0; k < picking->list.n; k++)
        if (!hold(p, model, pin, picking, vertex[k]))
            torn = vertex[k] - picking->first;
    if (torn == UINT32_MAX)
        return CLOTH_OK;
    return model_fail(pin->pick.place, error,
                      "vertex %u of cloth '%.60s' is held by two pins that do not hold and move "
                      "alike; one is expected (vertices count from 1)",
                      torn + 1, picking->cloth->name);
}

int flow_pins_make(struct flow_particles *p, uint32_t first, const struct model *model,
                   const struct model_cloth *cloth, struct cloth_error *error)
{
    struct flow_picking picking = {cloth, first, p->used, "a pin", {0}};
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_pins && !code; i++, picking.list.n = 0) {
        const struct model_pin *pin = cloth->pins + i;
        code = flow_pick(&pin->pick, &picking, error);
        if (!code)
            code = pin->stiffness > 0 ? soften(p, pin, &picking, error)
                                      : harden(p, model, pin, &picking, error);
    }
    free(picking.list.items);
    return code;
}
